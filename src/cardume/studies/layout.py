"""What a study's data set holds: its dimensions and variables, and how it is cut into portions.

Dimensions are the swept keys, then run, vehicle and requirement.  A variable is given by its dimensions after the swept
ones, which all have.  A portion is a block of cases and runs that is flown, kept and, if need be, flown again as one.
"""

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from cardume.errors import InputError
from cardume.simulation.flight import METRICS
from cardume.studies.cases import Axis, Drawn, Place
from cardume.studies.constants import (
    DRAWN,
    FAILED,
    FLEET,
    FLOWN,
    MEANINGS,
    NOT_FLOWN,
    REFUSED,
    REQUIREMENT,
    RUN,
    STATUS,
    VEHICLE,
)
from cardume.studies.required import LIMITED, Wanted
from cardume.studies.run_table import RunTable

LAST = STATUS  # is written after all others: where it says flown, they are there

SMALLEST_PORTION, LARGEST_PORTION = 16, 4096  # missions
PORTION_WORK = 24_000_000  # steps of vehicles: one processor takes a second or a few
MOST_PORTIONS = 20_000  # in a study; each is a file for every variable


class Variable(NamedTuple):
    """One array of the data set."""

    name: str
    dims: tuple[str, ...]  # after the swept ones
    type: str  # float64, bool, int8 or str
    fill: Any  # where nothing was flown
    attrs: Mapping[str, Any]


class Portion(NamedTuple):
    """A block of cases and runs."""

    place: Place  # in the grid of portions
    starts: Place  # of each swept axis, then of the runs
    stops: Place

    @property
    def places(self) -> list[Place]:
        """The cases in it."""
        return list(itertools.product(*map(range, self.starts[:-1], self.stops[:-1])))

    @property
    def runs(self) -> slice:
        """The runs in it."""
        return slice(self.starts[-1], self.stops[-1])

    @property
    def shape(self) -> Place:
        """Its size along each axis."""
        return tuple(stop - start for start, stop in zip(self.starts, self.stops, strict=True))

    @property
    def size(self) -> int:
        """Missions in it."""
        return math.prod(self.shape)


@dataclass(frozen=True)
class Layout:
    """All that is known of a data set before it is flown.

    Attributes:
        axes: swept keys.
        seeds: (run,) whole numbers.
        vehicles: names, in the order of the mission.
        requirements: what every run is judged by.
        variables: by name; the last is LAST.
        chunk: missions of a portion along each swept axis, then along the runs.
        chances: for samplings other than by chance, by key (run,) numbers in (0, 1).
        attrs: of the data set.
    """

    axes: tuple[Axis, ...]
    seeds: np.ndarray
    vehicles: tuple[str, ...]
    requirements: tuple[Wanted, ...]
    variables: Mapping[str, Variable]
    chunk: Place
    chances: Mapping[str, np.ndarray] = field(default_factory=dict)
    attrs: Mapping[str, Any] = field(default_factory=dict)

    @property
    def shape(self) -> Place:
        """Options of each swept key, then runs."""
        return (*(len(axis.options) for axis in self.axes), len(self.seeds))

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the same."""
        return (*(axis.key for axis in self.axes), RUN)

    def sizes_after(self, variable: Variable) -> Place:
        """The size of a variable along its dimensions other than `dims`.

        Args:
            variable: one of them.
        """
        sizes = {VEHICLE: len(self.vehicles), REQUIREMENT: len(self.requirements)}
        return tuple(sizes[dim] for dim in variable.dims if dim != RUN)

    def portions(self) -> Iterator[Portion]:
        """All portions, in order."""
        counts = [math.ceil(size / step) for size, step in zip(self.shape, self.chunk, strict=True)]
        for place in itertools.product(*map(range, counts)):
            starts = tuple(k * step for k, step in zip(place, self.chunk, strict=True))
            stops = tuple(
                min(start + step, size) for start, step, size in zip(starts, self.chunk, self.shape, strict=True)
            )
            yield Portion(place, starts, stops)


def make_variables(drawn: Sequence[Drawn], tables: Sequence[RunTable], wanted: Sequence[Wanted]) -> dict[str, Variable]:
    """The variables of a study.

    Args:
        drawn: keys of its distributions.
        tables: runs in which every metric appears that it can have; what is limited need not be in them.
        wanted: what its runs are judged by.
    """
    found = [_drawn_variable(one) for one in drawn]
    limited = {one.metric for one in wanted}
    limited |= set(LIMITED) if any(one.is_drawn for one in wanted) else set()  # where one has a limit, all are watched
    names = {name for table in tables for name in table.metrics}
    names |= {FLEET + name for name in limited} | {name for name in limited if not METRICS[name].of_fleet_only}
    found += [_metric(name) for name in (*(FLEET + name for name in METRICS), *METRICS) if name in names]
    one, each = (RUN,), (RUN, REQUIREMENT)
    nan = math.nan
    found += [
        Variable("got", each, "float64", nan, {"role": "verdict", "long_name": "value of what is required"}),
        Variable("met", each, "bool", False, {"role": "verdict", "long_name": "whether it is as required"}),
        Variable(
            "violated_at",
            each,
            "float64",
            nan,
            {"role": "verdict", "units": "s", "long_name": "when it first was not as required, where that is known"},
        ),
        Variable(
            "failed_at", one, "float64", nan, {"role": "failure", "units": "s", "long_name": "when the mission failed"}
        ),
        Variable("failure", one, "str", "", {"role": "failure", "long_name": "why the mission failed"}),
        Variable(
            LAST,
            one,
            "int8",
            NOT_FLOWN,
            {
                "role": "status",
                "long_name": "what became of the run",
                "flag_values": list(range(len(MEANINGS))),
                "flag_meanings": " ".join(words.replace(" ", "_") for words in MEANINGS),
            },
        ),
    ]
    return {variable.name: variable for variable in found}


def chunk_shape(shape: Place, steps: float) -> Place:
    """How many options and runs a portion has: whole rows of runs first, then of the last swept key, and so on.

    It depends on the study alone, so it is the same wherever and on however many processors it is flown.

    Args:
        shape: options of each swept key, then runs.
        steps: [-] steps of vehicles in one mission.
    """
    wanted = 1 << max(0, int(math.log2(max(1.0, PORTION_WORK / max(steps, 1.0)))))
    wanted = min(max(wanted, SMALLEST_PORTION), LARGEST_PORTION)
    while math.prod(shape) > wanted * MOST_PORTIONS:
        wanted *= 2
    found = []
    for size in reversed(shape):
        found.append(min(size, wanted))
        wanted = max(1, wanted // size)
    return tuple(reversed(found))


def block_of(layout: Layout, portion: Portion, tables: Sequence[RunTable]) -> dict[str, np.ndarray]:
    """What a portion's runs left, as the block of each variable.

    Args:
        layout: of the study.
        portion: that was flown.
        tables: whose rows are the runs of its first case, then of the next, and so on.

    Raises:
        InputError: a run has a metric that no run was known to have.
    """
    columns = [_columns(table) for table in tables]
    if unknown := {name for some in columns for name in some} - layout.variables.keys():
        raise InputError(f"some runs only have {', '.join(sorted(unknown))}, for which the study made no place")
    found = {}
    for name, variable in layout.variables.items():
        after = layout.sizes_after(variable)
        parts = [_column(variable, some.get(name), (len(some[LAST]), *after)) for some in columns]
        found[name] = np.concatenate(parts).reshape(*portion.shape, *after)
    return found


def _drawn_variable(one: Drawn) -> Variable:
    attrs = {"role": "drawn", "key": one.key, "units": one.unit, "long_name": f"{one.key}, as drawn"}
    name = f"{DRAWN}{one.key}"
    return (
        Variable(name, (RUN,), "float64", math.nan, attrs)
        if one.is_number
        else Variable(name, (RUN,), "str", "", attrs)
    )


def _metric(name: str) -> Variable:
    bare = name.removeprefix(FLEET)
    metric = METRICS[bare]
    of = "" if bare == name or metric.of_fleet_only else ", of the worst vehicle"
    attrs = {"role": "metric", "units": metric.unit, "long_name": metric.meaning + of, "wanted": metric.wanted}
    return Variable(name, (RUN,) if name != bare else (RUN, VEHICLE), "float64", math.nan, attrs)


def _columns(table: RunTable) -> dict[str, Any]:
    """One case's runs by the names of the variables."""
    is_failed = np.isfinite(table.failed_at)
    return {f"{DRAWN}{key}": values for key, values in table.drawn.items()} | {
        **table.metrics,
        "got": table.got,
        "met": table.met,
        "violated_at": table.violated_at,
        "failed_at": table.failed_at,
        "failure": np.array(table.failure, object),
        LAST: np.where(table.is_refused, REFUSED, np.where(is_failed, FAILED, FLOWN)).astype(np.int8),
    }


def _column(variable: Variable, values: Any, size: Place) -> np.ndarray:
    """A variable of one case's runs, filled where they have none."""
    kind: Any = object if variable.type == "str" else variable.type
    if values is None:
        return np.full(size, variable.fill, kind)
    if variable.type == "str":
        return np.array([str(value) for value in values], object)
    return np.asarray(values, kind).reshape(size)
