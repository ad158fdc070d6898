"""What a check finds, and the words in which it says what would pass."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal, NamedTuple

from cardume.units import UNITS, format_quantity, show_quantity

Level = Literal["error", "warning", "note"]
LEVELS: tuple[Level, ...] = ("error", "warning", "note")
TINY = 1e-9


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that theory knows about a mission before it flies.

    Attributes:
        level: an error cannot work, a warning may not do what is wanted, a note is worth knowing.
        key: full name of the value in the mission file.
        message: what happens, and by how much.
        suggestion: what would pass, as `key=value` for `--set`; several that belong together are
            joined by ` and `; empty where no single value helps.
    """

    level: Level
    key: str
    message: str
    suggestion: str = ""


class Ranked(NamedTuple):
    """A finding, and how bad it is among those of its level and key."""

    badness: float
    finding: Finding


def worst(candidates: Iterable[Ranked]) -> list[Finding]:
    """The worst finding of each level and key: what a fleet shares is told once.

    Args:
        candidates: such as one for each vehicle.
    """
    found: dict[tuple[str, str], Ranked] = {}
    for candidate in candidates:
        place = (candidate.finding.level, candidate.finding.key)
        if place not in found or candidate.badness > found[place].badness:
            found[place] = candidate
    return [ranked.finding for ranked in found.values()]


def at_most(key: str, value: float, unit: str) -> str:
    """`key=value`, rounded down to three digits.

    Args:
        key: full name.
        value: [unit] the limit; without a positive one there is nothing to suggest.
        unit: SI unit.
    """
    return setting(key, _rounded(value, math.floor), unit)


def at_least(key: str, value: float, unit: str) -> str:
    """`key=value`, rounded up to three digits; see `at_most`."""
    return setting(key, _rounded(value, math.ceil), unit)


def setting(key: str, value: float, unit: str) -> str:
    """`key=value` as `--set` takes it; empty where the value is none.

    Args:
        key: full name.
        value: [unit]
        unit: SI unit.
    """
    if not math.isfinite(value):
        return ""
    text = format_quantity(value, unit) if unit in UNITS else f"{value:.12g} {unit}"
    return f"{key}={text}"


def setting_word(key: str, word: str) -> str:
    """`key=word` as `--set` takes it."""
    return f"{key}={word}"


def show(value: float, unit: str) -> str:
    """A value for people, to three digits, or more to reach the point.

    Args:
        value: [unit]
        unit: SI unit, empty for a pure number.
    """
    size = abs(value)
    return show_quantity(value, unit, max(3, math.floor(math.log10(size)) + 1) if 0.0 < size < math.inf else 3)


def both(*settings: str) -> str:
    """Settings that belong together; empty unless there are all of them."""
    return " and ".join(settings) if all(settings) else ""


def largest(passes: Callable[[float], bool], low: float, high: float) -> float:
    """The largest value that passes, where smaller ones do; NaN if not even the low end does.

    Args:
        passes: whether a value does.
        low: where to begin.
        high: the largest to think of.
    """
    return _edge(passes, low, high)


def smallest(passes: Callable[[float], bool], low: float, high: float) -> float:
    """The smallest value that passes, where larger ones do; NaN if not even the high end does."""
    return _edge(passes, high, low)


def _edge(passes: Callable[[float], bool], good: float, bad: float) -> float:
    if not passes(good):
        return math.nan
    if passes(bad):
        return bad
    for _ in range(60):
        middle = 0.5 * (good + bad)
        good, bad = (middle, bad) if passes(middle) else (good, middle)
    return good


def _rounded(value: float, towards: Callable[[float], int]) -> float:
    if not (math.isfinite(value) and value > TINY):
        return math.nan
    scale = 10.0 ** (2 - math.floor(math.log10(value)))
    slack = -1e-9 if towards is math.ceil else 1e-9  # 0.3 is not 0.301 because of its last bit
    return towards(value * scale + slack) / scale
