"""Quantities with units, at the edges only: everything inside is SI and radians.

A small strict table: an unknown unit, a wrong dimension and a number that is not finite are errors.
"""

from __future__ import annotations

import difflib
import math
import re
from typing import NamedTuple

from cardume.errors import UnitError


class Unit(NamedTuple):
    """A unit: `factor` turns a number of it into the SI unit of its dimension."""

    factor: float
    dimension: str


KNOT = 1852.0 / 3600.0
DEGREE = math.pi / 180.0
FULL_TURN = 2.0 * math.pi

UNITS = {
    "m": Unit(1.0, "length"),
    "km": Unit(1000.0, "length"),
    "ft": Unit(0.3048, "length"),
    "NM": Unit(1852.0, "length"),
    "m/s": Unit(1.0, "speed"),
    "kn": Unit(KNOT, "speed"),
    "km/h": Unit(1.0 / 3.6, "speed"),
    "s": Unit(1.0, "time"),
    "min": Unit(60.0, "time"),
    "h": Unit(3600.0, "time"),
    "rad": Unit(1.0, "angle"),
    "deg": Unit(DEGREE, "angle"),
    "rad/s": Unit(1.0, "rate of turn"),
    "deg/s": Unit(DEGREE, "rate of turn"),
    "rpm": Unit(FULL_TURN / 60.0, "rate of turn"),
    "1/s": Unit(1.0, "frequency"),
    "Hz": Unit(1.0, "frequency"),
    "N": Unit(1.0, "force"),
    "kg": Unit(1.0, "mass"),
    "dB": Unit(1.0, "level"),
    "": Unit(1.0, "pure number"),
    "%": Unit(0.01, "pure number"),
}
SHOWN_IN = {"rad": "deg", "rad/s": "deg/s"}
SPELLINGS = {
    **dict.fromkeys(("meter", "meters", "metre", "metres", "mt", "mts"), "m"),
    **dict.fromkeys(("nm", "nmi", "Nm"), "NM"),
    **dict.fromkeys(("knot", "knots", "kt", "kts"), "kn"),
    **dict.fromkeys(("sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("mins", "minute", "minutes"), "min"),
    **dict.fromkeys(("hr", "hour", "hours"), "h"),
    **dict.fromkeys(("°", "º", "degree", "degrees"), "deg"),
    **dict.fromkeys(("mps", "ms-1", "m s-1", "m/sec"), "m/s"),
    **dict.fromkeys(("percent", "pct"), "%"),
}
QUANTITY = re.compile(r"\s*([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*(.*?)\s*", re.DOTALL)


def parse_quantity(given: float | str, unit: str) -> float:
    """The SI value of a number, or of a text such as `5 m`, `5m` or `10 deg`.

    A number without a unit is SI. An angle without a unit beyond a full turn is refused: it was
    meant in degrees.

    Args:
        given: what was written.
        unit: the SI unit that is wanted, as `m/s`; empty for a pure number.

    Raises:
        UnitError: no number, not finite, an unknown unit, or another dimension.
    """
    if isinstance(given, str):
        value, given_unit = _split(given, unit)
    else:
        value, given_unit = _finite(given), None
    if not given_unit:
        _refuse_bare_degrees(value, unit)
        return value
    if given_unit == unit:
        return value
    wanted = UNITS.get(unit, Unit(1.0, unit))
    if given_unit not in UNITS:
        raise UnitError(
            f"{show_text(given_unit)} is not a unit{_hint(given_unit, unit) or '.'} Valid here: {_valid(unit)}"
        )
    found = UNITS[given_unit]
    if found.dimension != wanted.dimension:
        what = f"{show_text(given)} is given in a unit of {found.dimension}, but one of {wanted.dimension} is needed"
        raise UnitError(f"{what}; valid here: {_valid(unit)}")
    return _finite(value * found.factor / wanted.factor)


def format_quantity(value: float, unit: str) -> str | float:
    """The shortest text that `parse_quantity` reads back as exactly this value; a number if it has no unit.

    Args:
        value: [unit] finite.
        unit: SI unit, empty for a pure number.
    """
    if not unit:
        return value
    shown = SHOWN_IN.get(unit, unit)
    scaled = value / UNITS[shown].factor if shown != unit else value
    texts = (f"{scaled:.12g} {shown}", f"{value!r} {unit}", f"{value:.12g} {unit}")
    return min((text for text in texts if parse_quantity(text, unit) == value), key=len)


def show_quantity(value: float, unit: str, digits: int = 4) -> str:
    """A value for people, as `0.05 m/s` or `20 deg`.

    Args:
        value: [unit] may be NaN or infinite.
        unit: SI unit, empty for a pure number.
        digits: significant digits.
    """
    shown = SHOWN_IN.get(unit, unit)
    scaled = value / UNITS[shown].factor if shown != unit else value
    return f"{scaled:.{digits}g} {shown}".rstrip()


def show_text(given: object, longest: int = 60) -> str:
    """What was given, short and printable on any terminal, for a message.

    Args:
        given: a text, or anything else that `str` turns into one.
        longest: [characters] what is longer is cut.
    """
    text = str(given)
    text = printable(text if len(text) <= longest else f"{text[:longest]}...")
    return f"'{text}'" if isinstance(given, str) else text


def printable(text: str) -> str:
    """The text with line ends, control characters and broken Unicode written as escapes."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def nearest(word: str, valid: list[str]) -> str:
    """`. Did you mean 'x'?` for the valid word most like `word`, or nothing."""
    lowered = {name.lower(): name for name in reversed(valid)}
    close = difflib.get_close_matches(word.lower()[:80], lowered, n=1, cutoff=0.7)
    return f". Did you mean '{lowered[close[0]]}'?" if close else ""


def units_like(unit: str) -> list[str]:
    """The units in which a quantity of this SI unit may be given."""
    dimension = UNITS[unit].dimension if unit in UNITS else unit
    return [name for name, known in UNITS.items() if known.dimension == dimension and name] or [unit]


def _split(text: str, unit: str) -> tuple[float, str]:
    match = QUANTITY.fullmatch(text) if len(text) <= 200 else None
    if match is None or match[2][:1] in ("_", ","):
        example = f"{show_quantity(1.0, unit)}" if unit else "0.5"
        point = "; the decimal sign is a point" if re.match(r"\s*[-+]?[0-9]+,[0-9]", text) else ""
        raise UnitError(f"{show_text(text)} is not a number{' with a unit' if unit else ''}, as '{example}'{point}")
    return _finite(float(match[1])), match[2]


def _finite(value: float) -> float:
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise UnitError("NaN, infinity and numbers too large to store are not allowed; give a finite number")
    return number


def _refuse_bare_degrees(value: float, unit: str) -> None:
    if unit == "rad" and abs(value) > FULL_TURN:
        raise UnitError(f"{value:g} without a unit is radians, more than a full turn; did you mean '{value:g} deg'?")


def _hint(given: str, wanted: str) -> str:
    if given in SPELLINGS:
        return f". Did you mean '{SPELLINGS[given]}'?"
    return nearest(show_text(given)[1:-1], units_like(wanted))


def _valid(unit: str) -> str:
    names = ", ".join(units_like(unit))
    return f"a number, or one with {names}" if not unit else f"{names}, or a number without a unit, which is {unit}"
