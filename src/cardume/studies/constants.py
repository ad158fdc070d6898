"""Names and numbers that several parts of studies share; it imports nothing, so that the command line may, too."""

LARGEST_SEED = 2**63 - 1

SAMPLINGS = ("monte_carlo", "latin_hypercube", "sobol")

DEFAULT_COMPARED, MOST_COMPARED = 20, 100_000  # seeds of a comparison
DEFAULT_TUNED, DEFAULT_TRIES, DEFAULT_MET = 24, 60, 0.95  # runs of a try, tries, share of runs in which all is met

# Parts of a study's data set.
RUN, VEHICLE, REQUIREMENT = "run", "vehicle", "requirement"
LIMIT, LIMIT_METRIC, LIMIT_VEHICLE = "limit", "limit_metric", "limit_vehicle"  # coordinates of a requirement
DRAWN, CHANCE = "drawn.", "chance."
FLEET = "fleet_"  # before a metric: the fleet's value, which is its worst vehicle's
STATUS = "status"
NOT_FLOWN, FLOWN, FAILED, REFUSED = range(4)  # its values
MEANINGS = ("not flown", "flown", "failed in flight", "could not be flown")

TRIFLE = 1e-9  # of any metric, in its unit: nothing

# What is shown unless the user asks for others: the first few of these that have numbers.
USUAL = (
    "cross_track_rms",
    "settling_time",
    "position_error_rms",
    "coordination_error_rms",
    "formation_error_rms",
    "yaw_effort",
    "energy",
)
