"""The missions of the reference workload: one file, and seeds by which current, loss, lookahead and noise are drawn."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.row import ROOT
from benchmarks.timing import Effort, Work
from cardume.compiler import WIDTH
from cardume.missions.available import catalog
from cardume.missions.drawing import draw
from cardume.missions.opening import open_mission
from cardume.missions.planning import make_plan
from cardume.simulation.engine import advance
from cardume.simulation.fleet import Tables
from cardume.simulation.plan import Plan
from cardume.simulation.side_by_side import join
from cardume.simulation.tables import make_tables

FILE = Path(__file__).with_name("mission.yaml")
FIRST_SEED = 1


def reference_plans(
    count: int, effort: Effort, overrides: Sequence[str] = (), allow_code: Sequence[Path] = ()
) -> list[Plan]:
    """The first missions of the workload, each with what its seed draws.

    Args:
        count: [-] of them.
        effort: a smoke run flies for less.
        overrides: as for `--set`.
        allow_code: more folders with laws that the overrides name.

    Returns:
        Their plans, with logs.
    """
    folders = [ROOT, *allow_code]
    known = catalog(folders)
    mission = open_mission(FILE, [f"duration={effort.mission_seconds()} s", *overrides], allow_code=folders)
    return [make_plan(draw(mission, seed), known).plan for seed in range(FIRST_SEED, FIRST_SEED + count)]


def reference_tables(plans: Sequence[Plan], lanes: bool) -> list[Tables]:
    """The tables of all missions, in lanes eight together.

    Args:
        plans: the missions.
        lanes: [-] for which build of the engine.
    """
    if not lanes:
        return [make_tables(plan) for plan in plans]
    groups = [plans[k : k + WIDTH] for k in range(0, len(plans), WIDTH)]
    return [join([make_tables(plan, lanes=True) for plan in group]) for group in groups]


def kernel_work(plans: Sequence[Plan], threads: int, lanes: bool) -> Work:
    """The engine alone on all missions, tables made before.

    Args:
        plans: the missions, equally long.
        threads: [-] that share them.
        lanes: [-] which build of the engine.
    """
    fresh = reference_tables(plans, lanes)
    pool = ThreadPoolExecutor(threads)
    fly = partial(fly_whole, ticks=plans[0].num_ticks)
    return Work(partial(_fly_all, pool, fly), partial(_copies, fresh), threads)


def _copies(tables: Sequence[Tables]) -> list[Tables]:
    return [Tables._make(part.copy() if isinstance(part, np.ndarray) else part for part in one) for one in tables]


def _fly_all(pool: ThreadPoolExecutor, fly: Callable[[Tables], None], tables: Sequence[Tables]) -> None:
    for _ in pool.map(fly, tables):
        pass


def fly_whole(tables: Tables, ticks: int) -> None:
    """Fly the missions of one set of tables to their end.

    Args:
        tables: changed in place.
        ticks: [-] of the mission.

    Raises:
        RuntimeError: it ended early; then times mean nothing.
    """
    flown = int(advance(tables, 0, ticks))
    if flown != ticks or tables.trouble[0].any():
        raise RuntimeError(f"a mission of the benchmark ended at tick {flown} of {ticks}: time means nothing")
