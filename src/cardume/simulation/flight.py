"""What a flight leaves in memory: the engine fills it in, the log, the figures and the table read it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import numpy as np

Reason = Literal["completed", "interrupted", "failed"]

MOTION = ("north", "east", "depth", "heading", "surge", "sway", "yaw_rate", "course", "speed")
CURRENT = ("current_north", "current_east")
ON_PATH = ("cross_track", "along_track", "path_course", "curvature", "coordination_state")
POSITION_BELIEFS = ("north_estimate", "east_estimate", "current_north_estimate", "current_east_estimate")
PATH_BELIEFS = ("cross_track_estimate", "coordination_state_estimate")
REFERENCES = ("course_desired", "heading_desired", "speed_desired", "speed_correction")
EFFORT = ("thrust", "yaw_moment", "shaft_speed_rpm")
VERTICAL = ("altitude", "depth_desired")
STAGE = ("phase",)
CERTAINTY = ("north_variance", "north_east_covariance", "east_variance")
BELIEFS = (*POSITION_BELIEFS, *PATH_BELIEFS)
CHANNELS = (*MOTION, *CURRENT, *ON_PATH, *BELIEFS, *REFERENCES, *EFFORT, *VERTICAL, *STAGE, *CERTAINTY)

MESSAGE_COLUMNS = ("time_sent", "time_received", "sender", "receiver", "kind", "lost", "time_of_validity")
MESSAGE_KINDS = ("report",)  # the number in the column `kind` is a place in this list


class Metric(NamedTuple):
    """What a metric measures, and whether more of it is better."""

    unit: str
    meaning: str
    wanted: Literal["at most", "at least"] = "at most"
    of_fleet_only: bool = False


METRICS = {
    "cross_track_rms": Metric("m", "true cross-track error, root mean square after the transient"),
    "cross_track_p95": Metric("m", "true cross-track error, exceeded in 5 % of the time after the transient"),
    "cross_track_max": Metric("m", "true cross-track error, largest after the transient"),
    "cross_track_rms_lines": Metric("m", "true cross-track error on lines, root mean square after the transient"),
    "cross_track_rms_arcs": Metric("m", "true cross-track error on arcs, root mean square after the transient"),
    "cross_track_iae": Metric("m s", "integral of |true cross-track error| from the start to the end of the path"),
    "settling_time": Metric("s", "when the transient ended"),
    "position_error_rms": Metric("m", "believed minus true position, horizontal, root mean square"),
    "current_error_rms": Metric("m/s", "believed minus true current, horizontal, root mean square"),
    "formation_error_rms": Metric("m", "distance from its place in the formation, root mean square"),
    "formation_error_p95": Metric("m", "distance from its place in the formation, exceeded in 5 % of the time"),
    "formation_error_rms_relative": Metric("m", "the same less the fleet's common displacement, root mean square"),
    "path_speed_mean": Metric("m/s", "mean rate of the coordination state after the transient", "at least"),
    "messages_sent": Metric("", "messages sent"),
    "messages_delivered": Metric("", "messages that reached the vehicle", "at least"),
    "information_age_mean": Metric("s", "mean age of what a message said when it arrived"),
    "information_age_max": Metric("s", "largest age of what a message said when it arrived"),
    "energy": Metric("J", "integral of the thrusters' power"),
    "yaw_effort": Metric("rad^2/s^3", "integral of the yaw acceleration squared"),
    "swath_coverage": Metric("%", "share of the planned area swept", "at least"),
    "coordination_error_rms": Metric(
        "m", "largest difference of two true coordination states, root mean square", of_fleet_only=True
    ),
    "coordination_error_max": Metric("m", "largest difference of two true coordination states", of_fleet_only=True),
    "depth_max": Metric("m", "largest true depth"),
    "altitude_min": Metric("m", "smallest true height above the seabed", "at least"),
    "geofence_margin_min": Metric("m", "smallest true distance inside the geofence, < 0 outside", "at least"),
    "separation_min": Metric("m", "smallest distance of two vehicles", "at least", of_fleet_only=True),
}


class Limit(NamedTuple):
    """A value that a metric of a vehicle was not to exceed, and when it first did."""

    metric: str
    vehicle: str | None  # None: of the fleet
    limit: float  # [any] in the metric's unit
    first_violated: float = np.nan  # [s] NaN: never
    by: str | None = None  # the vehicles, where the metric is of the fleet


FAULT, DOUBTS = "fault: ", "does not believe"  # how what an event tells begins


class Event(NamedTuple):
    """Something that happened to a vehicle, as it saw it itself or, of a limit, as it truly was."""

    time: float  # [s]
    vehicle: str
    what: str
    until: float = np.nan  # [s] when it ended, of a fault; NaN: it did not last


@dataclass(frozen=True, slots=True, kw_only=True)
class Metrics:
    """Names of `METRICS` to values in their units; NaN where there is none, as before the transient ended."""

    fleet: Mapping[str, float] = field(default_factory=dict)
    vehicles: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    limits: tuple[Limit, ...] = ()

    def worst(self, name: str) -> tuple[float, str | None]:
        """The fleet's value of a metric, which is its worst vehicle's, and that vehicle.

        Args:
            name: one of METRICS.

        Returns:
            The value in the metric's unit, NaN where any vehicle has none, and the vehicle's name,
            None where the metric is the fleet's own.
        """
        values = {vehicle: found[name] for vehicle, found in self.vehicles.items() if name in found}
        if not values:
            return self.fleet.get(name, np.nan), None
        sign = -1.0 if METRICS[name].wanted == "at least" else 1.0
        vehicle = max(values, key=lambda v: np.inf if np.isnan(values[v]) else sign * values[v])
        return values[vehicle], vehicle


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Flight:
    """One mission flown, up to its end, an interruption or a failure; NED, SI, radians.

    Rows are spaced by the mission's log period; messages are in the order of their sending. A lost
    message has NaN as its time of receipt.
    """

    mission_name: str
    seed: int
    vehicle_names: tuple[str, ...]
    times: np.ndarray  # (time,) [s] since the start of the mission
    channels: Mapping[str, np.ndarray]  # each of CHANNELS: (time, vehicle)
    neighbor_state_estimate: np.ndarray  # (time, vehicle, neighbor) [m] NaN of whom it knows nothing
    messages: Mapping[str, np.ndarray]  # each of MESSAGE_COLUMNS: (message,); vehicles by their place in the fleet
    metrics: Metrics
    reason: Reason
    failure: str | None = None  # why it failed: vehicle, signal, time
    flown: float  # [s] of the mission
    wall_seconds: float = np.nan  # [s] that flying took, without compilation; NaN: not known
    reference_path: np.ndarray  # (point, 2) [m] north, east along the formation's reference path
    own_paths: tuple[np.ndarray, ...]  # per vehicle (point, 2) [m] north, east along its own path
    events: tuple[Event, ...] = ()  # in the order of time
