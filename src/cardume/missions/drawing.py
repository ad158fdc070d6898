"""From a mission with distributions and sweeps to missions with plain values.

A draw depends on the seed and on the key of the value alone: another distribution in the file, or
another vehicle, changes no other draw.
"""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Iterator, Mapping
from statistics import NormalDist
from typing import Any

import numpy as np

from cardume.errors import MissionError, Problem
from cardume.missions.distributions import Choose, Normal, Sweep, Uniform, rebuild, shared_key, varying_values
from cardume.missions.mission import Mission
from cardume.missions.rules import check_rules

MOST_PROBES = 500
NONE: Mapping[str, float] = {}


def draw(mission: Mission, seed: int | None = None, chances: Mapping[str, float] = NONE) -> Mission:
    """The mission that a seed gives: every distribution replaced by a value.

    u = Philox(sha256(seed, key)) in (0, 1); then the inverse of the distribution at u.

    Args:
        mission: without sweeps.
        seed: what to draw with, and the seed of the mission drawn; None for the mission's own.
        chances: u of keys for which another sampling than chance chose it.

    Raises:
        MissionError: the mission holds a sweep, or the values drawn do not fit one another.
    """
    return draw_told(mission, mission.seed if seed is None else seed, chances)[0]


def draw_told(mission: Mission, seed: int, chances: Mapping[str, float] = NONE) -> tuple[Mission, dict[str, Any]]:
    """What `draw` gives, and each value drawn by the key under which it varies.

    Args:
        mission: without sweeps.
        seed: what to draw with, and the seed of the mission drawn.
        chances: u of keys for which another sampling than chance chose it.

    Raises:
        MissionError: the mission holds a sweep, or the values drawn do not fit one another.
    """
    refuse_sweeps(mission)
    told: dict[str, Any] = {}

    def visit(key: str, value: Any) -> Any:
        if isinstance(value, (Uniform, Normal, Choose)):
            name = shared_key(key, value)
            told[name] = value = _at(value, chances[name] if name in chances else _chance(seed, name))
        return value

    drawn: Mission = dataclasses.replace(rebuild(mission, visit), seed=seed)
    check_rules(drawn)
    return drawn, told


def sweeps_of(mission: Mission) -> dict[str, Sweep]:
    """The sweeps of a mission by their keys; one for the whole fleet appears once, under the fleet's key."""
    return {key: value for key, value in varying_values(mission) if isinstance(value, Sweep)}


def with_options(mission: Mission, options: Mapping[str, Any]) -> Mission:
    """The mission with some of its sweeps replaced by one of their options.

    Args:
        mission: with these sweeps.
        options: the option for each key of `sweeps_of`.

    Raises:
        MissionError: no such sweep or option, or the values do not fit one another.
    """
    sweeps = sweeps_of(mission)
    for key, option in options.items():
        if key not in sweeps or option not in sweeps[key].options:
            raise mission.error(
                key, f"is no sweep with the option {option}; the sweeps are {', '.join(sweeps) or 'none'}"
            )

    def visit(key: str, value: Any) -> Any:
        return options.get(shared_key(key, value), value) if isinstance(value, Sweep) else value

    chosen: Mission = rebuild(mission, visit)
    check_rules(chosen)
    return chosen


def refuse_sweeps(mission: Mission) -> None:
    """Check that a mission is a single one, or one to draw from.

    Raises:
        MissionError: where each sweep stands.
    """
    sweeps = sweeps_of(mission)
    if sweeps:
        advice = "a sweep is several missions: 'cardume compare' flies them side by side; or give one value, as --set"
        raise MissionError(Problem(mission.where(key), f"{advice} {key}=...") for key in sweeps)


def probes(mission: Mission) -> Iterator[Mission]:
    """Plain missions in which each option of each varying value appears, the others at their first."""
    varying = dict(varying_values(mission))
    for key, value in varying.items():
        for option in range(len(getattr(value, "options", ()))):
            yield _probe(mission, {key: option})
    if varying:
        yield _probe(mission, {})


def _probe(mission: Mission, options: Mapping[str, int]) -> Mission:
    def visit(key: str, value: Any) -> Any:
        if isinstance(value, (Sweep, Choose)):
            return value.options[options.get(shared_key(key, value), 0)]
        return _at(value, 0.5) if isinstance(value, (Uniform, Normal)) else value

    probe: Mission = rebuild(mission, visit)
    return probe


def _chance(seed: int, key: str) -> float:
    """A number in (0, 1), of the seed and the key alone."""
    digest = hashlib.sha256(f"draw {seed} {key}".encode()).digest()
    raw = int(np.random.Philox(key=int.from_bytes(digest[:16], "little")).random_raw())
    return ((raw >> 11) + 0.5) * 2.0**-53


def _at(value: Uniform | Normal | Choose, chance: float) -> Any:
    """The value below which a distribution lies with this chance."""
    if isinstance(value, Choose):
        return value.options[int(chance * len(value.options))]
    if isinstance(value, Uniform):
        return min(value.low + (value.high - value.low) * chance, value.high)
    if value.deviation == 0.0:
        return value.mean
    normal, bounds = NormalDist(value.mean, value.deviation), value.bounds
    low, high = normal.cdf(bounds.low), normal.cdf(bounds.high)
    drawn = normal.inv_cdf(min(max(low + (high - low) * chance, 2.0**-60), 1.0 - 2.0**-53))
    return drawn if bounds.contain(drawn) else value.mean
