import math

import pytest
from hypothesis import given, strategies as st

from cardume.errors import UnitError
from cardume.units import UNITS, format_quantity, nearest, parse_quantity, show_quantity, show_text

EXACT = [
    ("5 m", "m", 5.0),
    ("5m", "m", 5.0),
    ("  5  m ", "m", 5.0),
    ("-1.5e2 km", "m", -150000.0),
    ("1 ft", "m", 0.3048),
    ("2 NM", "m", 3704.0),
    ("36 km/h", "m/s", 10.0),
    ("1 kn", "m/s", 1852.0 / 3600.0),
    ("2 min", "s", 120.0),
    ("1.5 h", "s", 5400.0),
    ("180 deg", "rad", math.pi),
    ("1 rad", "rad", 1.0),
    ("90 deg/s", "rad/s", math.pi / 2.0),
    ("60 rpm", "rad/s", 2.0 * math.pi),
    ("5 Hz", "1/s", 5.0),
    ("0.2 1/s", "1/s", 0.2),
    ("0.01 1/s^2", "1/s^2", 0.01),
    ("3 N m", "N m", 3.0),
    ("7 N", "N", 7.0),
    ("20 %", "", 0.2),
    ("20 %", "%", 20.0),
    ("+.5", "", 0.5),
    ("3 dB", "dB", 3.0),
    (4, "m", 4.0),
    (6.2, "rad", 6.2),
]


@pytest.mark.parametrize(("text", "unit", "value"), EXACT)
def test_a_quantity_is_read_in_si(text: str | float, unit: str, value: float) -> None:
    assert parse_quantity(text, unit) == pytest.approx(value, rel=1e-15)


REFUSED = [
    ("20 deg", "m", "a unit of angle, but one of length is needed"),
    ("5 m", "m/s", "a unit of length, but one of speed is needed"),
    ("5 m", "", "pure number"),
    ("3 dB", "", "pure number"),
    ("5 rpm", "1/s", "rate of turn"),
    ("5 m", "N m", "but one of N m is needed"),
    ("5 meters", "m", "Did you mean 'm'?"),
    ("5 knots", "m/s", "Did you mean 'kn'?"),
    ("5 KM", "m", "Did you mean 'km'?"),
    ("90 °", "rad", "Did you mean 'deg'?"),
    ("5 furlongs", "m", "m, km, ft, NM"),
    ("5 \ue000", "m", r"'\ue000' is not a unit"),
    ("5,5 m", "m", "the decimal sign is a point"),
    ("fast", "m/s", "not a number"),
    ("", "m", "not a number"),
    ("m", "m", "not a number"),
    ("1_000 m", "m", "not a number"),
    ("٣ m", "m", "not a number"),
    ("5 m" + " " * 500, "m", "not a number"),
    ("nan", "m", "not a number"),
    ("inf m", "m", "not a number"),
    ("1e999 m", "m", "finite"),
    (math.nan, "m", "finite"),
    (math.inf, "m", "finite"),
    (10**400, "m", "finite"),
    ("1e308 km", "m", "finite"),
    (90, "rad", "did you mean '90 deg'?"),
    ("90", "rad", "did you mean '90 deg'?"),
    (-6.3, "rad", "did you mean '-6.3 deg'?"),
]


@pytest.mark.parametrize(("given_value", "unit", "words"), REFUSED)
def test_what_is_no_such_quantity_is_refused(given_value: str | float, unit: str, words: str) -> None:
    with pytest.raises(UnitError) as caught:
        parse_quantity(given_value, unit)
    assert words in str(caught.value)


@given(value=st.floats(-1e9, 1e9), unit=st.sampled_from([*UNITS, "N m", "1/s^2", "kg m^2"]))
def test_what_is_written_reads_back_exactly(value: float, unit: str) -> None:
    si = unit if unit not in ("km", "ft", "NM", "kn", "km/h", "min", "h", "deg", "deg/s", "rpm", "%", "Hz") else "m"
    assert parse_quantity(format_quantity(value, si), si) == value


def test_written_and_shown_quantities_look_as_people_write_them() -> None:
    assert format_quantity(parse_quantity("36.80 deg", "rad"), "rad") == "36.8 deg"
    assert format_quantity(0.01, "rad") == "0.01 rad"
    assert format_quantity(0.5, "m/s") == "0.5 m/s"
    assert format_quantity(0.5, "") == 0.5
    assert show_quantity(math.pi, "rad") == "180 deg"
    assert show_quantity(0.123456, "m") == "0.1235 m"
    assert show_quantity(math.nan, "m") == "nan m"
    assert show_quantity(2.0, "") == "2"
    assert (show_quantity(90.0, "%"), format_quantity(90.0, "%")) == ("90 %", "90 %")


def test_what_was_given_is_shown_short_and_printable() -> None:
    assert show_text("a\n\x1b[31m\ud800") == r"'a\n\x1b[31m\ud800'"
    assert len(show_text("x" * 1000)) < 70
    assert show_text(5) == "5"


def test_the_nearest_name_is_found_whatever_its_case() -> None:
    assert nearest("Lookahed", ["law", "lookahead"]) == ". Did you mean 'lookahead'?"
    assert nearest("zzz", ["law", "lookahead"]) == ""
