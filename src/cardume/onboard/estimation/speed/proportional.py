"""Speed in proportion to what the speed sensor says."""

from cardume.laws import Number, Positive
from cardume.onboard.estimation.speed.base import speed_law
from cardume.signals import ShaftReading


@speed_law
def proportional(reading: ShaftReading, scale: Positive[Number] = 1.0) -> float:
    """Surge as the reading times a factor.

    u = a n

    For `kinematic`, whose "shaft speed" is its surge [m/s]; with a != 1 its calibration is wrong, as in (38).

    Args:
        reading: n, of a vehicle whose reading is its speed; NaN gives NaN.
        scale: [-] a, what the reading is multiplied by; 1 is exact.

    Returns:
        Surge through the water [m/s].

    Source: paper eq. (38) with the factor on the speed, V_m = a R v, as (39) has it.
    """
    return scale * reading.shaft_speed
