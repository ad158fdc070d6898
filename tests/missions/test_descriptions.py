"""What is said of laws: every parameter in words, bounds as people say them."""

import re

import pytest

from cardume.missions.available import every_law
from cardume.missions.descriptions import describe, ends_of

LAWS = {f"{family}.{name}": law for family, laws in every_law().items() for name, law in laws.items()}


@pytest.mark.parametrize("name", LAWS)
def test_every_parameter_has_a_meaning_that_is_more_than_a_symbol(name: str) -> None:
    """What a slider of the laboratory shows, and the catalog; "k2." helps nobody."""
    for parameter in describe(LAWS[name])["parameters"]:
        words = re.findall(r"(?<![\w|'])[a-zA-Z]{2,}(?![\w|])", parameter["meaning"])
        assert len(words) >= 2, f"{parameter['name']}: {parameter['meaning']!r}"


@pytest.mark.parametrize(
    ("low", "low_open", "high", "high_open", "said"),
    [
        (None, False, None, False, []),
        (0.0, True, None, False, ["above 0 m"]),
        (0.0, False, 5.0, True, ["at least 0 m", "below 5 m"]),
        (None, False, 5.0, False, ["at most 5 m"]),
    ],
)
def test_bounds_in_words(
    low: float | None, low_open: bool, high: float | None, high_open: bool, said: list[str]
) -> None:
    parameter = {"unit": "m", "low": low, "low_open": low_open, "high": high, "high_open": high_open}
    assert ends_of(parameter) == said
