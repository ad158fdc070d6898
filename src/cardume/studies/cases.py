"""The cases of a study: every combination of the options of the sweeps in its mission."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cardume.errors import InputError
from cardume.missions.distributions import Sweep, units_of_varying
from cardume.missions.drawing import sweeps_of, with_options
from cardume.missions.mission import Mission
from cardume.missions.vehicle import LawChoice
from cardume.studies.arms import option_words
from cardume.studies.run_table import label_of

MOST_CASES = 100_000

Place = tuple[int, ...]


@dataclass(frozen=True)
class Axis:
    """One swept key.

    Attributes:
        key: of the mission file.
        options: what it takes.
        values: (option,) the same as numbers, SI, or as words.
        unit: SI, of the numbers.
    """

    key: str
    options: tuple[Any, ...]
    values: np.ndarray
    unit: str


@dataclass(frozen=True)
class Drawn:
    """One key whose value is drawn.

    Attributes:
        key: of the mission file.
        unit: SI.
        is_number: whether every value that it may take is a number; else it is told in words.
    """

    key: str
    unit: str
    is_number: bool


@dataclass(frozen=True)
class Cases:
    """A mission and what varies in it.

    Attributes:
        mission: with its sweeps and distributions.
        axes: its swept keys, in the order of the file.
        drawn: the keys of its distributions.
    """

    mission: Mission
    axes: tuple[Axis, ...]
    drawn: tuple[Drawn, ...]

    @cached_property
    def shape(self) -> Place:
        """Options of each axis."""
        return tuple(len(axis.options) for axis in self.axes)

    @property
    def size(self) -> int:
        """Number of cases."""
        return math.prod(self.shape)

    def at(self, place: Place) -> Mission:
        """The mission of one case, still with its distributions.

        Args:
            place: of the option of each axis.

        Raises:
            MissionError: the options do not fit one another.
        """
        if not self.axes:
            return self.mission
        return with_options(self.mission, {axis.key: axis.options[k] for axis, k in zip(self.axes, place, strict=True)})

    def each_option_once(self) -> list[Place]:
        """Places in which every option of every axis appears, the others at their first."""
        first = (0,) * len(self.axes)
        found = [first]
        for axis, size in enumerate(self.shape):
            found += [(*first[:axis], k, *first[axis + 1 :]) for k in range(1, size)]
        return found


def cases_of(mission: Mission) -> Cases:
    """What varies in a mission.

    Args:
        mission: as it was read.

    Raises:
        InputError: too many cases, or an option that stands in a sweep twice.
    """
    units = {key: unit for key, _, unit in units_of_varying(mission)}
    axes = tuple(_axis(key, sweep, units[key]) for key, sweep in sweeps_of(mission).items())
    number = math.prod(len(axis.options) for axis in axes)
    if number > MOST_CASES:
        raise InputError(
            f"the sweeps make {number} cases, and a study has at most {MOST_CASES}: sweep fewer values, or draw some of"
            " them, as {uniform: [0 m/s, 0.3 m/s]}, and look at the trend"
        )
    return Cases(mission, axes, _drawn(mission))


def _axis(key: str, sweep: Sweep, unit: str) -> Axis:
    options = sweep.options
    if all(isinstance(option, (int, float)) for option in options):
        values, shown = np.array(options, float), [str(option) for option in options]
    else:
        shown = _labels(key, options)
        values, unit = np.array(shown), ""
    if twice := next((text for text in shown if shown.count(text) > 1), None):
        raise InputError(f"{key}: the option {twice} stands in the sweep twice; give different ones")
    return Axis(key, options, values, unit)


def _labels(key: str, options: Sequence[Any]) -> list[str]:
    laws = [getattr(option, "law", option) for option in options]
    if all(isinstance(law, LawChoice) for law in laws):
        return option_words(key, options)
    words = [label_of(option) for option in options]
    return [f"{word} {k + 1}" if words.count(word) > 1 else word for k, word in enumerate(words)]


def _drawn(mission: Mission) -> tuple[Drawn, ...]:
    found: dict[str, Drawn] = {}
    for key, value, unit in units_of_varying(mission):
        if isinstance(value, Sweep):
            continue
        is_number = all(option is None or isinstance(option, (int, float)) for option in getattr(value, "options", ()))
        before = found.get(key, Drawn(key, unit, True))
        found[key] = Drawn(key, unit, is_number and before.is_number)
    return tuple(found.values())
