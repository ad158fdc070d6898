"""Missions with plain values in the place of one whose values vary: its middle, and each of its extremes."""

from collections.abc import Iterator, Mapping
from typing import Any

from cardume.missions.distributions import Normal, Uniform, Varying, rebuild, shared_key, varying_values
from cardume.missions.mission import Mission
from cardume.missions.vehicle import LawChoice
from cardume.units import show_quantity

MOST = 80
DEVIATIONS = 2.0  # of a normal distribution


def variants(mission: Mission) -> Iterator[tuple[Mission, str]]:
    """Plain missions, and what is special in each: "" for the one in the middle.

    Args:
        mission: with or without distributions and sweeps.
    """
    varying = dict(varying_values(mission))
    middles = {key: _middle(value) for key, value in varying.items()}
    yield _with_values(mission, middles), ""
    count = 1
    for key, value in varying.items():
        for extreme in _extremes(value):
            if count < MOST and extreme != middles[key]:
                count += 1
                yield _with_values(mission, {**middles, key: extreme}), f" (with {key} = {_words(extreme)})"


def is_too_varied(mission: Mission) -> bool:
    """Whether there are more extremes than `variants` gives."""
    return sum(len(_extremes(value)) for _, value in varying_values(mission)) > MOST


def _with_values(mission: Mission, values: Mapping[str, Any]) -> Mission:
    def visit(key: str, value: Any) -> Any:
        return values[shared_key(key, value)] if isinstance(value, Varying) else value

    plain: Mission = rebuild(mission, visit)
    return plain


def _middle(value: Varying) -> Any:
    if isinstance(value, Uniform):
        return 0.5 * (value.low + value.high)
    return value.mean if isinstance(value, Normal) else value.options[0]


def _extremes(value: Varying) -> tuple[Any, ...]:
    if isinstance(value, Uniform):
        return (value.low, value.high)
    if isinstance(value, Normal):
        ends = (value.mean - DEVIATIONS * value.deviation, value.mean + DEVIATIONS * value.deviation)
        return tuple(end for end in ends if value.bounds.contain(end))
    return value.options


def _words(value: Any) -> str:
    if isinstance(value, float):
        return show_quantity(value, "", 3)
    named = getattr(value, "law", value)
    return str(named.name if isinstance(named, LawChoice) else value)
