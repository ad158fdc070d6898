"""Many runs of one mission as columns: what was drawn, what came out, what was required."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any, NamedTuple

import numpy as np

from cardume.missions.flying import failure_of
from cardume.missions.mission import Mission, Requirement
from cardume.missions.summary import all_required
from cardume.missions.vehicle import LawChoice
from cardume.onboard.mind import NEVER
from cardume.simulation.flight import METRICS, Limit
from cardume.simulation.fly import Flown
from cardume.simulation.results import Measured, measure
from cardume.units import show_quantity

FLEET = "fleet_"


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


def tabulate(mission: Mission, runs: Sequence[Run]) -> RunTable:
    """Runs as a table.

    Args:
        mission: that was flown, with its distributions.
        runs: in order.
    """
    flown = [run.flown for run in runs]
    names = [vehicle.name for vehicle in mission.vehicles]
    measured = measure(flown) if runs else Measured({}, {}, {}, {})
    failed = np.array([one.trouble is not None for one in flown], bool)
    metrics = _metrics(measured)
    for values in metrics.values():
        values[failed] = np.nan
    required = _required(mission, measured, names)
    judged = [_judge(wanted, len(runs), metrics, measured, names) for wanted in required]
    shape = len(runs), len(required)
    got, met, violated_at = (np.array([j[k] for j in judged]).reshape(shape[::-1]).T for k in range(3))
    return RunTable(
        seeds=np.array([one.plan.seed for one in flown], np.int64),
        drawn=_drawn([run.drawn for run in runs]),
        metrics=metrics,
        requirements=tuple(r.name for r in required),
        got=got.astype(float),
        met=met.astype(bool),
        failed_at=np.array([one.trouble.time if one.trouble else math.nan for one in flown], float),
        failure=tuple(failure_of(one.trouble) if one.trouble else "" for one in flown),
        violated_at=np.where(failed[:, None], np.nan, violated_at.astype(float)),
    )


def refused(mission: Mission, seed: int, why: str) -> RunTable:
    """The row of a run that could not be flown, as the values drawn for it do not fit one another.

    Args:
        mission: that was to be flown.
        seed: of the run.
        why: as people read it.
    """
    empty = tabulate(mission, [])
    shape = 1, len(empty.requirements)
    nothing = np.full(shape, np.nan)
    return RunTable(
        np.array([seed]),
        {},
        {},
        empty.requirements,
        nothing,
        np.zeros(shape, bool),
        np.array([np.nan]),
        (why,),
        nothing,
    )


def stack(tables: Sequence[RunTable]) -> RunTable:
    """Tables of the same mission one after the other; what only some have is NaN, "" or false in the others.

    Args:
        tables: at least one.
    """
    if len(tables) == 1:
        return tables[0]
    names = list(dict.fromkeys(name for table in tables for name in table.requirements))

    def required(of: Callable[[RunTable], np.ndarray], none: Any) -> np.ndarray:
        parts = [np.full((len(table), len(names)), none) for table in tables]
        for part, table in zip(parts, tables, strict=True):
            part[:, [names.index(name) for name in table.requirements]] = of(table)
        return np.concatenate(parts)

    return RunTable(
        seeds=np.concatenate([table.seeds for table in tables]),
        drawn=_joined([table.drawn for table in tables], [len(table) for table in tables]),
        metrics=_joined([table.metrics for table in tables], [len(table) for table in tables]),
        requirements=tuple(names),
        got=required(lambda table: table.got, math.nan),
        met=required(lambda table: table.met, False),
        failed_at=np.concatenate([table.failed_at for table in tables]),
        failure=tuple(why for table in tables for why in table.failure),
        violated_at=required(lambda table: table.violated_at, math.nan),
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


class _Wanted(NamedTuple):
    name: str
    metric: str
    vehicle: str | None
    limit: np.ndarray | float  # in the metric's unit


def _required(mission: Mission, measured: Measured, names: Sequence[str]) -> list[_Wanted]:
    """What the mission requires, then the limits that vehicles have of their own; those that are drawn one by one."""
    fixed, drawn = [], []
    for metric, (limits, _) in measured.limits.items():
        if (limits != limits[0]).any() and (limits == limits[:, :1]).all():  # one for all, drawn
            drawn.append(_Wanted(f"{metric} {_sign(metric)} its limit", metric, None, limits[:, 0]))
            continue
        for k, name in enumerate(names if limits.shape[1] == len(names) else [None]):
            if (limits[:, k] == limits[0, k]).all():
                fixed += [Limit(metric, name, float(limits[0, k]))] if abs(limits[0, k]) < NEVER else []
            elif name is not None:
                drawn.append(_Wanted(f"{name}: {metric} {_sign(metric)} its limit", metric, name, limits[:, k]))
    return [_wanted(r) for r in all_required(mission.require, fixed, len(names))] + drawn


def _wanted(required: Requirement) -> _Wanted:
    of = f"{required.vehicle}: " if required.vehicle else ""
    limit = show_quantity(required.limit, METRICS[required.metric].unit, 12)
    name = f"{of}{required.metric} {_sign(required.metric)} {limit}"
    return _Wanted(name, required.metric, required.vehicle, required.limit)


def _sign(metric: str) -> str:
    return ">=" if METRICS[metric].wanted == "at least" else "<="


def _judge(
    wanted: _Wanted, count: int, metrics: Mapping[str, np.ndarray], measured: Measured, names: Sequence[str]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of every run the value, whether it is what is wanted, and when that was first violated, if it is known."""
    metric, k = wanted.metric, None if wanted.vehicle is None else names.index(wanted.vehicle)
    none = np.full(count, np.nan)
    if k is None:
        got = metrics.get(FLEET + metric, none)
    else:
        got = metrics[metric][:, k] if metric in metrics else none
    met = got >= wanted.limit if METRICS[metric].wanted == "at least" else got <= wanted.limit
    when = np.full(len(got), np.inf)
    if metric in measured.limits:
        limits, first = measured.limits[metric]
        concerned = range(limits.shape[1]) if k is None or limits.shape[1] == 1 else [k]
        for j in concerned:
            happened = (limits[:, j] == wanted.limit) & np.isfinite(first[:, j])
            when = np.where(happened, np.minimum(when, first[:, j]), when)
    return got, met, np.where(np.isfinite(when), when, np.nan)
