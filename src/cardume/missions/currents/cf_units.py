"""The spellings of speeds and lengths that files use."""

import re

WORDS = {
    "meter": "m", "meters": "m", "metre": "m", "metres": "m", "kilometer": "km", "kilometers": "km",
    "kilometre": "km", "kilometres": "km", "centimeter": "cm", "centimeters": "cm", "centimetre": "cm",
    "centimetres": "cm", "second": "s", "seconds": "s", "sec": "s", "hour": "h", "hours": "h", "hr": "h", "per": "/",
    "knot": "kn", "knots": "kn", "kt": "kn",
}  # fmt: skip
LENGTHS = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "km": 1000.0}
TIMES = {"s": 1.0, "h": 3600.0}
KNOT = 1852.0 / 3600.0


def speed_factor(unit: str) -> float | None:
    """What turns a speed into m/s; None for a unit that is no speed.

    Args:
        unit: as a file spells it: m s-1, m/s, cm s**-1, meters per second, knots ...
    """
    match _words(unit):
        case ["kn"]:
            return KNOT
        case [length, "/", time] | [length, time, "-1"] if length in LENGTHS and time in TIMES:
            return LENGTHS[length] / TIMES[time]
    return None


def length_factor(unit: str) -> float | None:
    """What turns a length into meters; None for a unit that is no length.

    Args:
        unit: as a file spells it.
    """
    match _words(unit):
        case [length] if length in LENGTHS:
            return LENGTHS[length]
    return None


def _words(unit: str) -> list[str]:
    return [WORDS.get(word, word) for word in re.findall(r"[a-z]+|/|-?[0-9]+", unit.lower())]
