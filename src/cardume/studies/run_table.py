"""Many runs of one mission as columns: what was drawn, what came out, what was required."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any, NamedTuple

import numpy as np

from cardume.missions.mission import Mission
from cardume.missions.summary import Verdict, judge
from cardume.missions.vehicle import LawChoice
from cardume.simulation.flight import METRICS, Metrics
from cardume.units import show_quantity

FLEET = "fleet_"


@dataclass(frozen=True)
class RunTable:
    """Runs of one mission, in the order of the seeds.

    Attributes:
        seeds: (n,) whole numbers.
        drawn: by the key of each distribution (n,) values, SI; of laws and words (n,) texts, "" where not drawn.
        metrics: as `fleet_<name>` (n,) values of the fleet, the worst vehicle's, and as `<name>` (n, vehicle) values,
            vehicles in the order of the mission; NaN where there is none.
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


class Numbers(NamedTuple):
    """What one run leaves."""

    seed: int
    drawn: Mapping[str, Any]
    metrics: Metrics
    failure: str
    failed_at: float  # [s] NaN: it did not


def tabulate(mission: Mission, runs: Sequence[Numbers]) -> RunTable:
    """Runs as a table.

    Args:
        mission: that was flown, with its distributions.
        runs: in order.
    """
    verdicts = [{_name(v): v for v in judge(mission.require, run.metrics)} if not run.failure else {} for run in runs]
    names = list(dict.fromkeys(name for told in verdicts for name in told))
    names = names or [
        _name(v) for v in judge(mission.require, Metrics(vehicles={v.name: {} for v in mission.vehicles}))
    ]
    shape = len(runs), len(names)
    return RunTable(
        seeds=np.array([run.seed for run in runs], np.int64),
        drawn=_drawn([run.drawn for run in runs]),
        metrics=_metrics([run.metrics for run in runs], [v.name for v in mission.vehicles]),
        requirements=tuple(names),
        got=np.array([[told[n].got if n in told else math.nan for n in names] for told in verdicts]).reshape(shape),
        met=np.array([[n in told and told[n].met for n in names] for told in verdicts], bool).reshape(shape),
        failed_at=np.array([run.failed_at for run in runs], float),
        failure=tuple(run.failure for run in runs),
        violated_at=np.array(
            [[_when(told[n]) if n in told else math.nan for n in names] for told in verdicts], float
        ).reshape(shape),
    )


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


def _name(verdict: Verdict) -> str:
    sign = ">=" if verdict.bound == "at least" else "<="
    of = f"{verdict.vehicle}: " if verdict.vehicle else ""
    return f"{of}{verdict.metric} {sign} {show_quantity(verdict.wanted, verdict.unit, 12)}"


def _when(verdict: Verdict) -> float:
    return math.nan if verdict.first_violated is None else verdict.first_violated


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


def _metrics(metrics: Sequence[Metrics], vehicles: Sequence[str]) -> dict[str, np.ndarray]:
    per_vehicle = {name for m in metrics for found in m.vehicles.values() for name in found}
    of_fleet = per_vehicle | {name for m in metrics for name in m.fleet}
    found = {FLEET + name: np.array([m.worst(name)[0] for m in metrics]) for name in METRICS if name in of_fleet}
    none: Mapping[str, float] = {}
    return found | {
        name: np.array([[m.vehicles.get(v, none).get(name, math.nan) for v in vehicles] for m in metrics])
        for name in METRICS
        if name in per_vehicle
    }
