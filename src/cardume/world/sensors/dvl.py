"""Velocity through the water by Doppler log: water track."""

from cardume.laws import MetersPerSecond, NotNegative, Number, Positive, Probability, Radians, Seconds
from cardume.signals import DvlReading, Noise, Sampling, VesselState
from cardume.world.sensors.base import dvl_sensor
from cardume.world.sensors.doppler import LogErrors, Ping, disturbed, heard


@dvl_sensor(period=0.5)
def dvl(
    truth: VesselState,
    noise: Noise,
    sampling: Sampling,
    memory: Ping,
    sigma: NotNegative[MetersPerSecond] = 0.004,
    scale: Positive[Number] = 1.0,
    bias_surge: MetersPerSecond = 0.0,
    bias_sway: MetersPerSecond = 0.0,
    misalignment: Radians = 0.0,
    invalid: Probability = 0.0,
    hold: NotNegative[Seconds] = 2.0,
) -> tuple[DvlReading, Ping]:
    """True velocity through the water (water track), scaled, turned, with a bias and white noise.

    V_m = R(psi) v + V_d:  reading = scale R(-m) (u, v) + bias + sigma (n_1, n_2),   V_d = R(psi) (reading - (u, v))

    The layer of water that a real log listens to lies a few meters below the vehicle; here it moves with the water
    around the vehicle. With V_d constant, on a straight leg, the observer (33) finds V_c - V_d; a bias is fixed to the
    vehicle, so V_d turns with it.

    Args:
        truth: surge u and sway v through the water, body.
        noise: a for surge, b for sway, c and d for pings that fail.
        sampling: time since the last ping.
        memory: the last good reading.
        sigma: [m/s] white noise of each.
        scale: [-] 1 is exact; a wrong sound speed or beam angle gives 0.1 to 1 %.
        bias_surge: [m/s] what it reads too much of surge.
        bias_sway: [m/s] what it reads too much of sway.
        misalignment: [rad] m, how far the log is turned to starboard about the vertical.
        invalid: [-] share of pings that fail; 0.1 in LSTS DUNE, Simulators/DVL.
        hold: [s] how long the last good reading is repeated; after that there is none, and speed comes from the shafts.

    Returns:
        Surge and sway [m/s] through the water, body.

    Source: paper eq. (32), V_m = R v + V_d; 0.004 m/s is the default of LSTS DUNE, Simulators/DVL, "Standard
    Deviation - Water Velocity".
    """
    reading = disturbed(truth.surge, truth.sway, noise, LogErrors(sigma, scale, bias_surge, bias_sway, misalignment))
    always = memory.silent >= 0.0
    return heard(reading, always, noise, sampling, memory, invalid, hold)
