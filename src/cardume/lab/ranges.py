"""How far the slider of a number goes: declarations say what is allowed, not what is worth trying."""

import math
from typing import NamedTuple

from cardume.missions.schema import HUGE, Quantity
from cardume.units import DEGREE, SHOWN_IN, UNITS

# What is a good deal of each unit, for numbers that are zero and may be anything.
USUAL = {
    "m": 20.0,
    "m/s": 0.5,
    "s": 10.0,
    "rad": 30.0 * DEGREE,
    "rad/s": 5.0 * DEGREE,
    "": 1.0,
}
MANY = 10.0  # a positive number is tried from a tenth to ten times of what it is
SEVERAL = 4.0  # one that may be zero, up to four times
STEPS = 200


class Range(NamedTuple):
    """Of a slider, in the unit that is shown."""

    start: float
    end: float
    step: float
    is_log: bool


def shown_factor(unit: str) -> float:
    """What a number in the unit that is shown is multiplied with to become SI.

    Args:
        unit: SI unit.
    """
    return UNITS[SHOWN_IN[unit]].factor if unit in SHOWN_IN else 1.0


def slider_range(kind: Quantity, value: float, tick: float, is_small: bool = False) -> Range:
    """The range of a slider, within what is declared.

    Args:
        kind: with unit and bounds, SI.
        value: SI, around which it lies.
        tick: [s] of the mission.
        is_small: an angle that is an error, not a direction.
    """
    factor = shown_factor(kind.unit)
    low, high, is_log = _ends(kind, value, is_small)
    if kind.in_ticks:
        low, high = max(low, tick), max(high, 2.0 * tick)
    start, end = low / factor, high / factor
    if not is_log:
        step = round_step((end - start) / STEPS)
        start, end = math.floor(start / step + 1e-9) * step, math.ceil(end / step - 1e-9) * step
    else:
        step = tick if kind.in_ticks else 0.0
    # a round number may lie just outside of what is allowed
    start, end = (
        max(float(f"{start:.6g}"), kind.bounds.low / factor),
        min(float(f"{end:.6g}"), kind.bounds.high / factor),
    )
    return Range(start, end, step, is_log)


def _ends(kind: Quantity, value: float, is_small: bool) -> tuple[float, float, bool]:
    bounds, usual = kind.bounds, USUAL.get(kind.unit, 1.0)
    low, high = (bounds.low if bounds.low > -HUGE else -math.inf), (bounds.high if bounds.high < HUGE else math.inf)
    if math.isfinite(low) and math.isfinite(high) and not (low > 0.0 and high > 1000.0 * low):
        worth = SEVERAL * value if value > 0.0 else usual
        if low == 0.0 and high > 5.0 * worth:
            return low, worth, False  # as a depth of 10 m where 12 km are allowed
        return (low, high, False) if high > low else (low, low + 1.0, False)
    if low > 0.0 or (low == 0.0 and bounds.low_open):
        around = value if value > 0.0 else usual
        return max(around / MANY, low), min(around * MANY, high, HUGE), True
    if low == 0.0:
        return 0.0, min(SEVERAL * value if value > 0.0 else usual, high), False
    if kind.unit == "rad" and not is_small:
        full = math.pi if abs(value) <= math.pi else 2.0 * math.pi
        return (-full, full, False) if value < 0.0 or full == math.pi else (0.0, full, False)
    span = max(2.0 * abs(value), usual)
    return max(low, -span), min(high, span), False


def round_step(rough: float) -> float:
    """The nearest of 1, 2 and 5 times a power of ten that is not larger, for a slider's step.

    Args:
        rough: > 0.
    """
    power = 10.0 ** math.floor(math.log10(rough))
    share = rough / power
    step = 5.0 if share >= 5.0 else 2.0 if share >= 2.0 else 1.0
    return float(f"{step * power:.3g}")
