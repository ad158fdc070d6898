"""Velocity over ground by Doppler log: bottom track."""

from cardume.laws import Meters, MetersPerSecond, NotNegative, Number, Positive, Probability, Radians, Seconds
from cardume.maths import to_body
from cardume.signals import DvlReading, Noise, Sampling, Seabed, VesselState, Water
from cardume.world.sensors.base import dvl_sensor
from cardume.world.sensors.doppler import LogErrors, Ping, disturbed, heard


@dvl_sensor(period=0.2)
def bottom_track(
    truth: VesselState,
    water: Water,
    seabed: Seabed,
    noise: Noise,
    sampling: Sampling,
    memory: Ping,
    nearest: NotNegative[Meters] = 0.3,
    range: Positive[Meters] = 30.0,
    sigma: NotNegative[MetersPerSecond] = 0.004,
    scale: Positive[Number] = 1.0,
    bias_surge: MetersPerSecond = 0.0,
    bias_sway: MetersPerSecond = 0.0,
    misalignment: Radians = 0.0,
    invalid: Probability = 0.0,
    hold: NotNegative[Seconds] = 2.0,
) -> tuple[DvlReading, Ping]:
    """True velocity over ground, in body axes, where the seabed is in range; scaled, turned, biased, with white noise.

    V_m = R(psi) v + V_c + V_d:  reading = scale R(-m) ((u, v) + R(-psi) V_c) + bias + sigma (n_1, n_2)
    where nearest <= b - z <= range, else nothing

    In (32) this is a log whose disturbance V_d holds the current. So the whole vehicle thinks as if the water stood
    still and its hull drifted: dead reckoning needs no current, the observer (33) finds none, and `crab` with
    `use_sway: 1` turns the heading by the drift angle that it measures. The autopilot makes the speed over ground
    right.

    Args:
        truth: surge u, sway v through the water, heading psi and depth z.
        water: V_c around the vehicle.
        seabed: its depth b below the vehicle, from the mission's `bathymetry`; without one nothing is ever heard.
        noise: a for surge, b for sway, c and d for pings that fail.
        sampling: time since the last ping.
        memory: the last good reading.
        nearest: [m] below it the echo comes back before the log listens; our estimate, as of `altimeter`.
        range: [m] above it no echo is heard.
        sigma: [m/s] white noise of each.
        scale: [-] 1 is exact; a wrong sound speed or beam angle gives 0.1 to 1 %.
        bias_surge: [m/s] what it reads too much of surge.
        bias_sway: [m/s] what it reads too much of sway.
        misalignment: [rad] m, how far the log is turned to starboard about the vertical.
        invalid: [-] share of pings that fail; 0.1 in LSTS DUNE, Simulators/DVL.
        hold: [s] how long the last good reading is repeated; after that there is none, and speed, through the water
            then, comes from the shafts.

    Returns:
        Surge and sway [m/s] over ground, body.

    Source: paper eq. (32) with V_d = V_c + errors; 5 Hz and 30 m as DVL_BT of dsor-isr/farol, `myellow/sim.yaml`;
    0.004 m/s as `dvl`.
    """
    ahead, starboard = to_body(truth.heading, water.north, water.east)
    errors = LogErrors(sigma, scale, bias_surge, bias_sway, misalignment)
    reading = disturbed(truth.surge + ahead, truth.sway + starboard, noise, errors)
    altitude = seabed.depth - truth.depth
    return heard(reading, (altitude >= nearest) & (altitude <= range), noise, sampling, memory, invalid, hold)
