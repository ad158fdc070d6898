"""Many runs of one mission as columns: what was drawn, what came out, what was required."""

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any, NamedTuple

import numpy as np

from cardume.missions.flying import failure_of
from cardume.missions.mission import Mission
from cardume.missions.vehicle import LawChoice
from cardume.simulation.flight import METRICS
from cardume.simulation.fly import Flown
from cardume.simulation.results import Measured, measure
from cardume.studies.constants import FLEET
from cardume.studies.required import Wanted, judge_runs, wanted_of


@dataclass(frozen=True)
class RunTable:
    """Runs of one mission, in the order of the seeds.

    Attributes:
        seeds: (n,) whole numbers.
        drawn: by the key of each distribution (n,) values, SI; of laws and words (n,) texts, "" where not drawn.
        metrics: as `fleet_<name>` (n,) values of the fleet, the worst vehicle's, and as `<name>` (n, vehicle) values,
            vehicles in the order of the mission; NaN where there is none, as in a mission that failed.
        requirements: what is required, as `port: cross_track_rms <= 0.5 m`.
        got: (n, requirement) values.
        met: (n, requirement) whether it is what is required.
        failed_at: (n,) [s] when the mission failed in flight; NaN: it did not.
        failure: why it failed, or "".
        violated_at: (n, requirement) [s] when first violated, where that is known; else NaN.
    """

    seeds: np.ndarray
    drawn: Mapping[str, np.ndarray]
    metrics: Mapping[str, np.ndarray]
    requirements: tuple[str, ...]
    got: np.ndarray
    met: np.ndarray
    failed_at: np.ndarray
    failure: tuple[str, ...]
    violated_at: np.ndarray

    def __len__(self) -> int:
        return len(self.seeds)

    @property
    def is_refused(self) -> np.ndarray:
        """(n,) whether a run could not be flown."""
        found: np.ndarray = np.array([bool(why) for why in self.failure], bool) & np.isnan(self.failed_at)
        return found

    @property
    def all_met(self) -> np.ndarray:
        """(n,) whether a run is all that is required."""
        return np.asarray(self.met.all(axis=1))

    @property
    def is_varied(self) -> bool:
        """Whether any run differs from the first in a number, in what was drawn, or in when it failed."""
        columns = (*self.metrics.values(), *self.drawn.values(), self.failed_at)
        return any(
            not np.array_equal(c, np.broadcast_to(c[:1], c.shape), equal_nan=c.dtype.kind == "f") for c in columns
        )

    def first(self, count: int) -> "RunTable":
        """The runs of the first seeds.

        Args:
            count: how many.
        """
        return RunTable(
            self.seeds[:count],
            {key: values[:count] for key, values in self.drawn.items()},
            {name: values[:count] for name, values in self.metrics.items()},
            self.requirements,
            self.got[:count],
            self.met[:count],
            self.failed_at[:count],
            self.failure[:count],
            self.violated_at[:count],
        )


class Run(NamedTuple):
    """One mission after its flight, and what was drawn for it by the key of its distribution."""

    drawn: Mapping[str, Any]
    flown: Flown


class Refused(NamedTuple):
    """A run that could not be flown, as the values drawn for it do not fit one another; why, as people read it."""

    seed: int
    why: str


def tabulate(mission: Mission, runs: Sequence[Run | Refused], wanted: Sequence[Wanted] | None = None) -> RunTable:
    """Runs as a table; of those that could not be flown it says why.

    Args:
        mission: that was flown, with its distributions.
        runs: in order.
        wanted: what they are judged by; None: what the mission requires.
    """
    wanted = wanted_of(mission) if wanted is None else wanted
    names = [vehicle.name for vehicle in mission.vehicles]
    parts = [
        _flown([run for run in some if isinstance(run, Run)], names, wanted)
        if kind is Run
        else _refused([run for run in some if isinstance(run, Refused)], wanted)
        for kind, some in itertools.groupby(runs, type)
    ]
    return stack(parts) if parts else _flown([], names, wanted)


def _flown(runs: Sequence[Run], names: Sequence[str], wanted: Sequence[Wanted]) -> RunTable:
    flown = [run.flown for run in runs]
    measured = measure(flown) if runs else Measured({}, {}, {}, {})
    failed = np.array([one.trouble is not None for one in flown], bool)
    metrics = _metrics(measured)
    for values in metrics.values():
        values[failed] = np.nan
    judged = [judge_runs(one, len(runs), metrics, measured, names) for one in wanted]
    shape = len(runs), len(wanted)
    got, met, violated_at = (np.array([j[k] for j in judged]).reshape(shape[::-1]).T for k in range(3))
    return RunTable(
        seeds=np.array([one.plan.seed for one in flown], np.int64),
        drawn=_drawn([run.drawn for run in runs]),
        metrics=metrics,
        requirements=tuple(one.name for one in wanted),
        got=got.astype(float),
        met=met.astype(bool) & ~failed[:, None],
        failed_at=np.array([one.trouble.time if one.trouble else math.nan for one in flown], float),
        failure=tuple(failure_of(one.trouble) if one.trouble else "" for one in flown),
        violated_at=np.where(failed[:, None], np.nan, violated_at.astype(float)),
    )


def _refused(runs: Sequence[Refused], wanted: Sequence[Wanted]) -> RunTable:
    nothing = np.full((len(runs), len(wanted)), np.nan)
    return RunTable(
        seeds=np.array([run.seed for run in runs], np.int64),
        drawn={},
        metrics={},
        requirements=tuple(one.name for one in wanted),
        got=nothing,
        met=np.zeros(nothing.shape, bool),
        failed_at=np.full(len(runs), np.nan),
        failure=tuple(run.why for run in runs),
        violated_at=nothing,
    )


def stack(tables: Sequence[RunTable]) -> RunTable:
    """Tables of the same mission one after the other; what only some have is NaN or "" in the others.

    Args:
        tables: at least one, with the same requirements.
    """
    if len(tables) == 1:
        return tables[0]
    sizes = [len(table) for table in tables]
    return RunTable(
        seeds=np.concatenate([table.seeds for table in tables]),
        drawn=_joined([table.drawn for table in tables], sizes),
        metrics=_joined([table.metrics for table in tables], sizes),
        requirements=tables[0].requirements,
        got=np.concatenate([table.got for table in tables]),
        met=np.concatenate([table.met for table in tables]),
        failed_at=np.concatenate([table.failed_at for table in tables]),
        failure=tuple(why for table in tables for why in table.failure),
        violated_at=np.concatenate([table.violated_at for table in tables]),
    )


def _joined(parts: Sequence[Mapping[str, np.ndarray]], sizes: Sequence[int]) -> dict[str, np.ndarray]:
    found = {}
    for name in dict.fromkeys(name for part in parts for name in part):
        shape = next(part[name] for part in parts if name in part).shape[1:]
        is_text = any(part[name].dtype.kind == "U" for part in parts if name in part)
        none = "" if is_text else math.nan
        columns = [part.get(name, np.full((size, *shape), none)) for part, size in zip(parts, sizes, strict=True)]
        if is_text:  # of an option that is a number in some portions
            columns = [c if c.dtype.kind == "U" else np.where(np.isnan(c), "", c.astype(str)) for c in columns]
        found[name] = np.concatenate(columns)
    return found


def label_of(option: Any) -> str:
    """One of the options of a choice, in a word or a few.

    Args:
        option: a law, a section, a word or a number.
    """
    if isinstance(option, LawChoice):
        return option.name
    if is_dataclass(option) and not isinstance(option, type):
        laws = [value for value in (getattr(option, f.name) for f in fields(option)) if isinstance(value, LawChoice)]
        return laws[0].name if laws else str(getattr(option, "name", type(option).__name__))
    return "none" if option is None else str(option)


def _drawn(told: Sequence[Mapping[str, Any]]) -> dict[str, np.ndarray]:
    """Numbers as numbers, all else as text."""
    found = {}
    for key in dict.fromkeys(key for run in told for key in run):
        values = [run.get(key) for run in told]
        if all(value is None or isinstance(value, (int, float)) for value in values):
            found[key] = np.array([math.nan if value is None else value for value in values], float)
        else:
            found[key] = np.array([label_of(run[key]) if key in run else "" for run in told])
    return found


def _metrics(measured: Measured) -> dict[str, np.ndarray]:
    known = [name for name in METRICS if name in measured.vehicles or name in measured.fleet]
    own = {name: np.where(measured.is_absent(name), np.nan, measured.vehicles[name]) for name in measured.vehicles}
    return {FLEET + name: np.array(measured.worst(name), float) for name in known} | {
        name: np.array(own[name], float) for name in known if name in own
    }
