"""Fly many missions and keep their numbers only, planning some while others fly, so that memory stays what it is.

What every mission costs in Python decides how many fly, as only one of them can be planned at a time. So a mission is
planned once, and of the others only what their seeds change; eight that share laws and sizes fly in one register.
"""

import math
import os
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from cardume.compiler import WIDTH
from cardume.errors import MissionError
from cardume.missions.available import catalog
from cardume.missions.catalog import Catalog
from cardume.missions.drawing import Drawer
from cardume.missions.mission import Mission
from cardume.missions.planning import make_plan
from cardume.simulation.engine import advance
from cardume.simulation.fleet import Tables
from cardume.simulation.fly import Flown, fly_alone, fly_joined
from cardume.simulation.memo import Memo
from cardume.simulation.plan import Plan
from cardume.simulation.side_by_side import join, own, shape_of
from cardume.simulation.tables import make_tables
from cardume.simulation.warming import warm_up
from cardume.studies.required import Wanted, wanted_of
from cardume.studies.run_table import Refused, Run, RunTable, stack, tabulate
from cardume.studies.work import wants_lanes

__all__ = ["PORTION", "Progress", "RunTable", "able_places", "fly_all", "fly_seeds", "num_processors"]

Progress = Callable[[str, int, int], None]
Stop = Callable[[], bool]

PORTION = 128  # missions that are planned before those of them that can share lanes are put together
FEW = 2  # missions that fly faster one by one than in lanes
MEASURED = ("scores", "histograms", "fleet_score", "trouble")


def fly_seeds(
    mission: Mission,
    seeds: Sequence[int] | np.ndarray,
    *,
    chances: Mapping[str, np.ndarray] | None = None,
    allow_code: Iterable[str | Path] = (),
    threads: int | None = None,
    lanes: bool | None = None,
    is_lenient: bool = False,
    should_stop: Stop = lambda: False,
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
        is_lenient: whether a run whose drawn values do not fit one another is a row that says so, and no error.
        should_stop: asked every few milliseconds.
        progress: called with "compile" or "fly", how much is done, and how much there is.

    Returns:
        A row for each seed; after a stop for the first of them only, those that were flown.

    Raises:
        InputError: a mission that cannot be flown.
    """
    (found,) = fly_all(
        [mission],
        seeds,
        chances=chances,
        allow_code=allow_code,
        threads=threads,
        lanes=lanes,
        is_lenient=is_lenient,
        should_stop=should_stop,
        progress=lambda stage, done, total: progress("fly" if stage == "compare" else stage, done, total),
    )
    return found


def fly_all(
    missions: Sequence[Mission],
    seeds: Sequence[int] | np.ndarray,
    *,
    chances: Mapping[str, np.ndarray] | None = None,
    allow_code: Iterable[str | Path] = (),
    threads: int | None = None,
    lanes: bool | None = None,
    wanted: Sequence[Wanted] | None = None,
    is_lenient: bool = False,
    should_stop: Stop = lambda: False,
    progress: Progress = lambda stage, done, total: None,
) -> list[RunTable]:
    """Fly every mission with every seed; see `fly_seeds`.

    Args:
        missions: without sweeps.
        seeds: (n,) the same for all.
        chances: of distributions, for each seed.
        allow_code: folders from which laws may be imported.
        threads: how many at once.
        lanes: whether eight missions share a register.
        wanted: what all are judged by; None: what each requires.
        is_lenient: whether a run whose drawn values do not fit one another is a row that says so, and no error.
        should_stop: asked every few milliseconds.
        progress: called with "compile" or "compare", how much is done, and how much there is.

    Returns:
        For each mission its runs, equally many for all: of the first seeds, as far as it came.

    Raises:
        InputError: a mission that cannot be flown.
    """
    judged_by = [wanted_of(mission) if wanted is None else wanted for mission in missions]
    if not len(seeds):
        return [tabulate(mission, [], some) for mission, some in zip(missions, judged_by, strict=True)]
    known, threads = catalog(allow_code), threads or num_processors()
    given = [{key: float(values[k]) for key, values in (chances or {}).items()} for k in range(len(seeds))]
    makers = [_Maker(mission, known, is_lenient) for mission in missions]
    firsts = (maker.first(seeds, given) for maker in makers)  # what is wrong is told before any flies
    plans = [one.plan for one in firsts if one is not None]
    if lanes is None:
        lanes = wants_lanes(sum(plan.num_ticks * len(plan.vehicles) for plan in plans) * len(seeds))
    _warm_up(plans, lanes, progress)
    portion = PORTION if lanes else max(1, math.ceil(2 * threads / max(1, len(missions))))
    starts = _starts(len(seeds), WIDTH * threads if lanes else portion, portion)
    found: list[list[RunTable]] = [[] for _ in missions]
    done, total = 0, len(missions) * len(seeds)
    progress("compare", 0, total)
    with ThreadPoolExecutor(threads) as pool:

        def begun() -> Iterator[tuple[int, "_Portion"]]:
            for start, end in pairwise([*starts, len(seeds)]):
                for k, maker in enumerate(makers):
                    some = range(start, end)
                    made = [maker.make(int(seeds[j]), given[j], lanes) for j in some]
                    yield k, _Portion(maker, made, lanes, pool, should_stop)

        for k, flying in _ahead(begun(), should_stop):
            runs = flying.wait()
            if any(isinstance(run, Run) and run.flown.stopped for run in runs):
                break  # what a stopped mission leaves is no number of a whole one
            found[k].append(tabulate(missions[k], runs, judged_by[k]))
            done += len(runs)
            progress("compare", done, total)
    tables = [
        stack(parts) if parts else tabulate(mission, [], some)
        for mission, some, parts in zip(missions, judged_by, found, strict=True)
    ]
    return [table.first(min(map(len, tables))) for table in tables]


def _starts(count: int, first: int, largest: int) -> list[int]:
    """Where portions begin; each is as large as all before it, so that who interrupts soon keeps something."""
    starts = [0]
    while (start := starts[-1] + min(largest, max(first, starts[-1]))) < count:
        starts.append(start)
    return starts


def able_places(
    mission: Mission,
    seeds: Sequence[int] | np.ndarray,
    chances: Mapping[str, np.ndarray],
    count: int,
    allow_code: Iterable[str | Path] = (),
) -> list[int]:
    """The places of the first runs that can be flown: whose drawn values fit one another.

    Args:
        mission: without sweeps.
        seeds: (n,) of the runs.
        chances: of distributions, for each seed.
        count: how many are wanted; fewer are given where there are not so many.
        allow_code: folders from which laws may be imported.

    Raises:
        MissionError: none of them can.
    """
    maker = _Maker(mission, catalog(allow_code), is_lenient=True)
    found: list[int] = []
    for place, seed in enumerate(seeds):
        if isinstance(maker.make(int(seed), {key: float(values[place]) for key, values in chances.items()}), _Made):
            found.append(place)
            if len(found) == count:
                break
    if not found:
        first = {key: float(values[0]) for key, values in chances.items()}
        _Maker(mission, catalog(allow_code)).make(int(seeds[0]), first)
    return found


def num_processors() -> int:
    """How many threads this process may run at once."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class _Made(NamedTuple):
    """A mission ready to fly; its tables are shared with others."""

    plan: Plan
    tables: Tables
    drawn: Mapping[str, Any]


class _Maker:
    """Plans one mission for many seeds."""

    def __init__(self, mission: Mission, known: Catalog, is_lenient: bool = False) -> None:
        self._drawer, self._known, self._memo = Drawer(mission), known, Memo()
        self._is_lenient = is_lenient

    def make(self, seed: int, chances: Mapping[str, float], lanes: bool = False) -> _Made | Refused:
        try:
            mission, drawn = self._drawer.draw(seed, chances)
            plan = replace(make_plan(mission, self._known, self._memo).plan, log_period=0.0)
            return _Made(plan, make_tables(plan, lanes, memo=self._memo), drawn)
        except MissionError as problem:
            if not self._is_lenient:
                raise
            return Refused(seed, str(problem))

    def first(self, seeds: Sequence[int] | np.ndarray, chances: Sequence[Mapping[str, float]]) -> _Made | None:
        """The first of the missions that can be flown."""
        made = (self.make(int(seed), some) for seed, some in zip(seeds, chances, strict=True))
        return next((one for one in made if isinstance(one, _Made)), None)

    def alone(self, made: _Made) -> _Made:
        """The same mission, with tables for the engine that flies one."""
        return made._replace(tables=make_tables(made.plan, memo=self._memo))


class _Portion:
    """Missions that fly while others are planned."""

    def __init__(
        self,
        maker: _Maker,
        made: Sequence[_Made | Refused],
        lanes: bool,
        pool: ThreadPoolExecutor,
        should_stop: Stop,
    ) -> None:
        self._made = made
        self._jobs: list[tuple[Sequence[int], Future[list[Flown]]]] = []
        able = {k: one for k, one in enumerate(made) if isinstance(one, _Made)}
        for places in _groups(able) if lanes else [[k] for k in able]:
            some = [able[k] for k in places]
            if lanes and len(some) > FEW:
                self._jobs.append((places, pool.submit(_fly_in_lanes, some, should_stop)))
                continue
            for k, one in zip(places, some, strict=True):
                alone = maker.alone(one) if lanes else one
                self._jobs.append(([k], pool.submit(_fly_alone, alone, should_stop)))

    def wait(self) -> list[Run | Refused]:
        """The missions after their flight, in order."""
        flown: dict[int, Flown] = {}
        for places, job in self._jobs:
            flown |= zip(places, job.result(), strict=True)
        return [one if isinstance(one, Refused) else Run(one.drawn, flown[k]) for k, one in enumerate(self._made)]


def _groups(made: Mapping[int, _Made]) -> Iterator[list[int]]:
    """Places of missions that can share lanes; those that last equally long stand together."""
    alike: dict[Any, list[int]] = {}
    for k, one in made.items():
        alike.setdefault(shape_of(one.tables), []).append(k)
    for places in alike.values():
        places.sort(key=lambda k: made[k].plan.num_ticks)
        yield from (places[start : start + WIDTH] for start in range(0, len(places), WIDTH))


def _ahead(portions: Iterator[tuple[int, _Portion]], should_stop: Stop) -> Iterator[tuple[int, _Portion]]:
    """Portions in order, the next one begun before one is given."""
    waiting: deque[tuple[int, _Portion]] = deque()
    for portion in portions:
        waiting.append(portion)
        if len(waiting) > 1:
            yield waiting.popleft()
        if should_stop():
            break
    yield from waiting


_rooms = threading.local()  # of each thread, the tables that it flew last


def _fly_alone(made: _Made, should_stop: Stop) -> list[Flown]:
    return [fly_alone(made.plan, own(made.tables), should_stop)]


def _fly_in_lanes(made: Sequence[_Made], should_stop: Stop) -> list[Flown]:
    _rooms.tables = joined = join([one.tables for one in made], getattr(_rooms, "tables", None))

    def leave(lane: int) -> Tables:
        numbers = {name: getattr(joined, name)[:, lane].copy() for name in MEASURED}
        return made[lane].tables._replace(**numbers)

    return fly_joined([one.plan for one in made], joined, leave, should_stop)


def _warm_up(plans: Sequence[Plan], lanes: bool, progress: Progress) -> None:
    """Compile what all plans need, shown as one piece of work."""
    pieces = len(plans) + lanes
    for number, plan in enumerate(plans):

        def note(done: int, total: int, before: int = number) -> None:
            progress("compile", before * total + done, pieces * total)

        warm_up(plan, note)
    if lanes:
        for plan in plans:
            advance(join([make_tables(replace(plan, duration=plan.tick), lanes=True)]), 0, 0)
        progress("compile", pieces, pieces)
