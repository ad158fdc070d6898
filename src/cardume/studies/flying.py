"""Fly many missions and keep their numbers only, in portions small enough to watch, to stop and to hold in memory."""

import math
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from cardume.compiler import WIDTH
from cardume.missions.available import catalog
from cardume.missions.catalog import Catalog
from cardume.missions.drawing import draw, draw_told
from cardume.missions.flying import failure_of
from cardume.missions.mission import Mission
from cardume.missions.planning import make_plan
from cardume.missions.summary import judge
from cardume.simulation.flight import Metrics
from cardume.simulation.fly import Flown, fly_batch
from cardume.simulation.plan import Plan
from cardume.simulation.results import metrics_of
from cardume.simulation.warming import warm_up
from cardume.studies.run_table import Numbers, RunTable, tabulate

__all__ = ["LANES_FROM", "Progress", "Run", "RunTable", "fly_all", "fly_seeds", "num_processors"]

Progress = Callable[[str, int, int], None]

# Vehicle-ticks from which flying eight missions in one register saves more than compiling the engine for it
# takes, where that was never done: about a minute on two processors.
LANES_FROM = 100_000_000


@dataclass(frozen=True)
class Run:
    """The numbers of one mission.

    Attributes:
        metrics: of its flight; none of one that failed.
        met: whether it is what its mission requires; None where nothing is required.
        failure: why it failed, if it did.
    """

    metrics: Metrics
    met: bool | None = None
    failure: str | None = None


def fly_all(
    missions: Sequence[Mission],
    seeds: Sequence[int],
    *,
    progress: Progress = lambda stage, done, total: None,
    should_stop: Callable[[], bool] = lambda: False,
    allow_code: Iterable[str | Path] = (),
    threads: int | None = None,
) -> list[list[Run]]:
    """Fly every mission with every seed; the numbers do not depend on how the work was cut.

    Args:
        missions: without sweeps.
        seeds: by which distributions and noise are drawn, at least one.
        progress: called with "compile" or "compare", how much is done, and how much there is.
        should_stop: asked every few milliseconds.
        allow_code: folders from which laws may be imported.
        threads: how many at once; None for as many as there are processors.

    Returns:
        For each mission its runs, equally many for all: of the first seeds, as far as it came.

    Raises:
        InputError: a mission that cannot be flown.
    """
    known, threads = catalog(allow_code), threads or num_processors()
    plans = [_plan(mission, seeds[0], known) for mission in missions]  # what is wrong is told before any flies
    _warm_up(plans, progress)
    steps = sum(plan.num_ticks * len(plan.vehicles) for plan in plans) * len(seeds)
    with_lanes = steps >= LANES_FROM
    portion = WIDTH * threads if with_lanes else max(1, math.ceil(2 * threads / len(missions)))
    found: list[list[Run]] = [[] for _ in missions]
    total = len(missions) * len(seeds)
    progress("compare", 0, total)
    for start in range(0, len(seeds), portion):
        some = seeds[start : start + portion]
        flown = _fly_portion(missions, some, known, threads, with_lanes, should_stop)
        if should_stop():
            break  # what a stopped mission leaves is no number of a whole one
        for runs, more in zip(found, flown, strict=True):
            runs += more
        progress("compare", len(missions) * len(found[0]), total)
    return found


def fly_seeds(
    mission: Mission,
    seeds: Sequence[int] | np.ndarray,
    *,
    chances: Mapping[str, np.ndarray] | None = None,
    allow_code: Iterable[str | Path] = (),
    threads: int | None = None,
    lanes: bool | None = None,
    should_stop: Callable[[], bool] = lambda: False,
    progress: Progress = lambda stage, done, total: None,
) -> RunTable:
    """Fly one mission with many seeds, for its numbers only; these do not depend on how the work was cut.

    Args:
        mission: without sweeps.
        seeds: (n,) by which distributions and noise are drawn.
        chances: for keys of distributions (n,) numbers in (0, 1) from which their values are made, in the place of
            those that the seed gives: a Latin hypercube, say.
        allow_code: folders from which laws may be imported.
        threads: how many at once; None for as many as there are processors.
        lanes: whether eight missions share a register; None where that saves time.
        should_stop: asked every few milliseconds.
        progress: called with "compile" or "fly", how much is done, and how much there is.

    Returns:
        A row for each seed; after a stop for the first of them only, those that were flown.

    Raises:
        InputError: a mission that cannot be flown.
    """
    known, threads, chances = catalog(allow_code), threads or num_processors(), chances or {}
    if len(seeds) == 0:
        return tabulate(mission, [])
    given = [{key: float(values[k]) for key, values in chances.items()} for k in range(len(seeds))]
    first = _drawn_plan(mission, int(seeds[0]), given[0], known)[0]
    warm_up(first, lambda done, total: progress("compile", done, total))
    if lanes is None:
        lanes = first.num_ticks * len(first.vehicles) * len(seeds) >= LANES_FROM
    found: list[Numbers] = []
    portion = (WIDTH if lanes else 4) * threads
    progress("fly", 0, len(seeds))
    for start in range(0, len(seeds), portion):
        some = range(start, min(start + portion, len(seeds)))
        pairs = [_drawn_plan(mission, int(seeds[k]), given[k], known) for k in some]
        plans = [plan for plan, _ in pairs]
        if lanes:
            flown = _fly_together(plans, threads, should_stop)
        else:
            flown = fly_batch(plans, threads, should_stop=should_stop)
        if should_stop():
            break  # what a stopped mission leaves is no number of a whole one
        found += [_numbers(one, told) for one, (_, told) in zip(flown, pairs, strict=True)]
        progress("fly", len(found), len(seeds))
    return tabulate(mission, found)


def _drawn_plan(
    mission: Mission, seed: int, chances: Mapping[str, float], known: Catalog
) -> tuple[Plan, dict[str, object]]:
    drawn, told = draw_told(mission, seed, chances)
    return replace(make_plan(drawn, known).plan, log_period=0.0), told


def _numbers(flown: Flown, drawn: Mapping[str, object]) -> Numbers:
    if (trouble := flown.trouble) is not None:
        return Numbers(flown.plan.seed, drawn, Metrics(), failure_of(trouble), trouble.time)
    return Numbers(flown.plan.seed, drawn, metrics_of(flown), "", math.nan)


def num_processors() -> int:
    """How many threads this process may run at once."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _warm_up(plans: Sequence[Plan], progress: Progress) -> None:
    """Compile what all plans need, shown as one piece of work."""
    for number, plan in enumerate(plans):

        def note(done: int, total: int, before: int = number) -> None:
            progress("compile", before * total + done, len(plans) * total)

        warm_up(plan, note)


def _plan(mission: Mission, seed: int, known: Catalog) -> Plan:
    """The plan of a drawn mission, without a log."""
    return replace(make_plan(draw(mission, seed), known).plan, log_period=0.0)


def _plans(mission: Mission, seeds: Sequence[int], known: Catalog) -> list[Plan]:
    if mission.is_fixed:
        first = _plan(mission, seeds[0], known)
        return [replace(first, seed=seed) for seed in seeds]
    return [_plan(mission, seed, known) for seed in seeds]


def _fly_portion(
    missions: Sequence[Mission],
    seeds: Sequence[int],
    known: Catalog,
    threads: int,
    with_lanes: bool,
    should_stop: Callable[[], bool],
) -> list[list[Run]]:
    plans = [_plans(mission, seeds, known) for mission in missions]
    if with_lanes:
        flown = [_fly_together(some, threads, should_stop) for some in plans]
    else:
        everything = fly_batch([plan for some in plans for plan in some], threads, should_stop=should_stop)
        flown = [everything[k * len(seeds) : (k + 1) * len(seeds)] for k in range(len(missions))]
    return [[_run(mission, one) for one in some] for mission, some in zip(missions, flown, strict=True)]


def _fly_together(plans: Sequence[Plan], threads: int, should_stop: Callable[[], bool]) -> list[Flown]:
    """In lanes where the missions can share them; a drawn duration or path may be a reason why not."""
    try:
        return fly_batch(plans, threads, lanes=True, should_stop=should_stop)
    except ValueError:
        return fly_batch(plans, threads, should_stop=should_stop)


def _run(mission: Mission, flown: Flown) -> Run:
    if flown.trouble is not None:
        return Run(Metrics(), met=False if mission.require else None, failure=failure_of(flown.trouble))
    metrics = metrics_of(flown)
    verdicts = judge(mission.require, metrics)
    return Run(metrics, met=all(verdict.met for verdict in verdicts) if verdicts else None)
