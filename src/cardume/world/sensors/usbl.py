"""Ultra-short baseline: range and two angles of a transponder, as the head hears it."""

from cardume.compiler import some, where
from cardume.laws import Meters, NotNegative, Positive, Probability, Radians
from cardume.maths import exp, to_spherical
from cardume.signals import NOTHING, Baseline, Noise, UsblReading
from cardume.world.sensors.base import usbl_sensor

DEGREE = 0.017453292519943295  # [rad]


@usbl_sensor(period=1.0, latency=0.1)
def usbl(
    baseline: Baseline,
    noise: Noise,
    range_sigma: NotNegative[Meters] = 0.1,
    angle_sigma: NotNegative[Radians] = 1.0 * DEGREE,
    misalignment: Radians = 0.0,
    max_range: Positive[Meters] = 1000.0,
    bearing_loss: Probability = 0.0,
) -> UsblReading:
    """True range, azimuth and elevation plus white noise; the head may be mounted with a twist.

    range = r + sigma_r n_1,   azimuth = atan2(starboard, ahead) - m + sigma_a n_2,
    elevation = atan2(down, sqrt(ahead^2 + starboard^2)) + sigma_a n_3

    A target at a level range r is placed r sigma_a beside the truth RMS: 0.87 m at 50 m for 1 deg.  Azimuth is measured
    about the vertical, so for a target straight below its noise moves the position little.  1 deg and 0.1 m are values
    of a small modem with a built-in array; better heads have 0.1 deg, and then the twist that calibration leaves,
    0.5 to 1 deg, is the larger error.  The latency is the answer's way back over some 15 m and 0.09 s in the modem.

    Args:
        baseline: from the head to the target, true body axes.
        noise: a for range, b for azimuth, c for elevation.
        range_sigma: [m] white noise of the range.
        angle_sigma: [rad] white noise of azimuth and of elevation.
        misalignment: [rad] m, how far the head is turned to starboard about the vertical; what it says is believed to
            be in body axes, so m > 0 places targets too far to port.
        max_range: [m] beyond which nothing is heard: all three are NaN.
        bearing_loss: [-] share of readings that are a range only, azimuth and elevation NaN; decided by n_4, of which
            the normal probability is taken to be 1 / (1 + exp(-1.5976 n - 0.07056 n^3)), right to 2e-4.

    Returns:
        Range [m], never negative, azimuth [rad] positive to starboard and elevation [rad] positive down, in the axes of
        the head; angles are not wrapped.  A target within the head itself has azimuth and elevation 0.

    Source: white noise on range, bearing and elevation as in LSTS DUNE, Simulators/USBL; ours are the defaults.  That
    a reading may be a range only is seen in transcripts of EvoLogics S2C heads, where integrity is below 100.
    """
    distance, azimuth, elevation = to_spherical(baseline.ahead, baseline.starboard, baseline.down)
    measured = distance + range_sigma * noise.a
    heard = distance <= max_range
    by_angle = heard
    if some(bearing_loss > 0.0):
        share = 1.0 / (1.0 + exp(-noise.d * (1.5976 + 0.07056 * noise.d * noise.d)))
        by_angle = heard & (share >= bearing_loss)
    return UsblReading(
        where(heard, where(measured > 0.0, measured, 0.0), NOTHING),
        where(by_angle, azimuth - misalignment + angle_sigma * noise.b, NOTHING),
        where(by_angle, elevation + angle_sigma * noise.c, NOTHING),
    )
