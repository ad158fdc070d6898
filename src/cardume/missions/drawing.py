"""From a mission with distributions and sweeps to missions with plain values.

A draw depends on the seed and on the key of the value alone: another distribution in the file, or
another vehicle, changes no other draw.
"""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Callable, Iterator, Mapping
from statistics import NormalDist
from typing import Any

from cardume.errors import MissionError, Problem
from cardume.missions.distributions import (
    Choose,
    Normal,
    Sweep,
    Uniform,
    parts_of,
    rebuild,
    shared_key,
    varying_values,
)
from cardume.missions.mission import Mission
from cardume.missions.rules import check_rules, is_ruled
from cardume.missions.tree import join
from cardume.missions.vehicle import LawChoice, Table

MOST_PROBES = 500
MOST_CHECKED = 10_000  # combinations of drawn values of which it is remembered that they obey the rules
WORD = 2**64 - 1
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
    return Drawer(mission).draw(seed, chances)


class Drawer:
    """A mission to draw from again and again: what varies is found once, and what does not stays the same object."""

    def __init__(self, mission: Mission) -> None:
        """Find what varies.

        Raises:
            MissionError: the mission holds a sweep.
        """
        refuse_sweeps(mission)
        self._mission, self._make = mission, _Makers().maker(mission, "")
        self._checked: set[tuple[Any, ...]] = set()

    def draw(self, seed: int, chances: Mapping[str, float] = NONE) -> tuple[Mission, dict[str, Any]]:
        """What `draw_told` gives.

        Raises:
            MissionError: the values drawn do not fit one another.
        """
        draws = _Draws(seed, chances)
        drawn: Mission = self._make(draws) if self._make else self._mission
        drawn = dataclasses.replace(drawn, seed=seed)
        decisive = tuple(draws.decisive)
        if decisive not in self._checked:
            check_rules(drawn)
            if len(self._checked) < MOST_CHECKED:
                self._checked.add(decisive)
        return drawn, draws.told


class _Draws:
    """The values of one seed."""

    def __init__(self, seed: int, chances: Mapping[str, float]) -> None:
        self.seed, self.chances = seed, chances
        self.told: dict[str, Any] = {}
        self.decisive: list[tuple[str, float]] = []  # those on which the rules depend, an option by its place

        self.made: dict[int, Any] = {}  # what vehicles share, by a number of its own
        self._drawn: dict[str, float] = {}

    def chance(self, name: str) -> float:
        if name not in self._drawn:
            self._drawn[name] = self.chances[name] if name in self.chances else _chance(self.seed, name)
        return self._drawn[name]


Make = Callable[[_Draws], Any]


class _Makers:
    """Writes functions that make a value with all that varies in it drawn."""

    def __init__(self) -> None:
        self._shared: dict[tuple[Any, str], Make] = {}

    def maker(self, value: Any, key: str) -> Make | None:
        """The function for a value; None where nothing in it varies."""
        if isinstance(value, (Uniform, Normal)):
            return _taker(value, key)
        make = self._chooser(value, key) if isinstance(value, Choose) else self._record_maker(value, key)
        words = key.split(".")
        is_own = words[0] != "vehicles" or any(found.per == "vehicle" for _, found in varying_values(value))
        if make is None or len(words) < 3 or is_own:
            return make
        # All vehicles that share a section get the same object, of which planning then makes the same.
        return self._shared.setdefault((value, ".".join(words[2:])), _once(make, len(self._shared)))

    def _record_maker(self, value: Any, key: str) -> Make | None:
        if isinstance(value, LawChoice):
            return self._law_maker(value, key)
        parts = parts_of(value, key)
        makers = {name: maker for name, part, part_key in parts if (maker := self.maker(part, part_key))}
        if not makers:
            return None
        if isinstance(value, tuple):
            return lambda draws: tuple(makers[k](draws) if k in makers else item for k, item in enumerate(value))
        return lambda draws: dataclasses.replace(value, **{name: maker(draws) for name, maker in makers.items()})

    def _law_maker(self, value: LawChoice, key: str) -> Make | None:
        numbers = dict(value.parameters)
        makers = {name: maker for name, item in numbers.items() if (maker := self.maker(item, join(key, name)))}
        if not makers:
            return None
        return lambda draws: dataclasses.replace(
            value, parameters=Table(numbers | {name: maker(draws) for name, maker in makers.items()})
        )

    def _chooser(self, value: Choose, key: str) -> Make:
        name, makers = shared_key(key, value), [self.maker(option, key) for option in value.options]
        is_decisive = is_ruled(key, value)

        def choose(draws: _Draws) -> Any:
            place = int(draws.chance(name) * len(makers))
            draws.told[name], maker = value.options[place], makers[place]
            if is_decisive:
                draws.decisive.append((name, place))
            return maker(draws) if maker else value.options[place]

        return choose


def _once(make: Make, number: int) -> Make:
    """Make it once in a draw."""

    def made(draws: _Draws) -> Any:
        if number not in draws.made:
            draws.made[number] = make(draws)
        return draws.made[number]

    return made


def _taker(value: Uniform | Normal, key: str) -> Make:
    name, is_decisive = shared_key(key, value), is_ruled(key, value)

    def take(draws: _Draws) -> Any:
        draws.told[name] = number = _at(value, draws.chance(name))
        if is_decisive:
            draws.decisive.append((name, number))
        return number

    return take


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
    """A number in (0, 1), of the seed and the key alone: the first word of Philox4x64-10 at counter 1.

    Source: Salmon, Moraes, Dror & Shaw (2011), Parallel random numbers: as easy as 1, 2, 3, SC '11; numpy.random.Philox
    gives the same, and takes seven times as long to begin.
    """
    digest = hashlib.sha256(f"draw {seed} {key}".encode()).digest()
    k0, k1 = int.from_bytes(digest[:8], "little"), int.from_bytes(digest[8:16], "little")
    c0, c1, c2, c3 = 1, 0, 0, 0
    for _ in range(10):
        first, second = 0xD2E7470EE14C6C93 * c0, 0xCA5A826395121157 * c2
        c0, c1, c2, c3 = (second >> 64) ^ c1 ^ k0, second & WORD, (first >> 64) ^ c3 ^ k1, first & WORD
        k0, k1 = (k0 + 0x9E3779B97F4A7C15) & WORD, (k1 + 0xBB67AE8584CAA73B) & WORD
    return ((c0 >> 11) + 0.5) * 2.0**-53


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
