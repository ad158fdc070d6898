"""Attitude and heading reference: noise, a constant bias, and a compass that iron deflects."""

from cardume.laws import NotNegative, Radians, RadiansPerSecond
from cardume.maths import sin
from cardume.signals import AhrsReading, Noise, VesselState
from cardume.world.sensors.base import ahrs_sensor

DEGREE = 0.017453292519943295  # [rad]


@ahrs_sensor(period=0.1)
def ahrs(
    truth: VesselState,
    noise: Noise,
    heading_sigma: NotNegative[Radians] = 0.3 * DEGREE,
    heading_bias: Radians = 0.0,
    deviation: NotNegative[Radians] = 0.0,
    deviation_phase: Radians = 0.0,
    yaw_rate_sigma: NotNegative[RadiansPerSecond] = 0.03 * DEGREE,
    yaw_rate_bias: RadiansPerSecond = 0.0,
    attitude_sigma: NotNegative[Radians] = 0.3 * DEGREE,
) -> AhrsReading:
    """True attitude plus white noise; the heading also has a bias and a deviation that turns with the vehicle.

    heading = psi + bias + A sin(psi + phi) + sigma n

    Vehicles are level here: true roll and pitch are 0.  The heading is counted on through full turns as the true one
    is, so that without errors the reading is the truth to the last bit; wrap it where it is compared.  A calibrated
    MEMS unit stays within 1 deg RMS, an uncalibrated one within 3 to 5 deg: most of that is bias and deviation.

    Args:
        truth: heading psi and yaw rate.
        noise: a for heading, b for yaw rate, c for roll, d for pitch.
        heading_sigma: [rad] white noise of the heading.
        heading_bias: [rad] > 0 reads too far clockwise.
        deviation: [rad] A, what iron that turns with the vehicle adds at worst.
        deviation_phase: [rad] phi, which headings the deviation is largest at.
        yaw_rate_sigma: [rad/s] white noise of the yaw rate.
        yaw_rate_bias: [rad/s] > 0 reads a turn to starboard.
        attitude_sigma: [rad] white noise of roll and of pitch.

    Returns:
        Heading [rad], yaw rate [rad/s], roll and pitch [rad].

    Source: white noise of 0.3 deg and 0.03 deg/s are the defaults of LSTS DUNE, Simulators/IMU; bias and deviation are
    the constant and the once-a-turn term of the magnetic compass.
    """
    deflection = heading_bias + deviation * sin(truth.heading + deviation_phase)
    return AhrsReading(
        truth.heading + deflection + heading_sigma * noise.a,
        truth.yaw_rate + yaw_rate_bias + yaw_rate_sigma * noise.b,
        attitude_sigma * noise.c,
        attitude_sigma * noise.d,
    )
