"""The missions that are flown: paper/figure-5, and what is left of it as laws are taken away."""

import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from numba import config

from benchmarks.timing import Effort, Progress, Work
from cardume.compiler import WIDTH
from cardume.missions.available import catalog
from cardume.missions.opening import open_mission
from cardume.missions.planning import make_plan
from cardume.simulation.engine import advance
from cardume.simulation.fleet import Tables
from cardume.simulation.plan import Plan
from cardume.simulation.side_by_side import join
from cardume.simulation.tables import make_tables
from cardume.simulation.warming import warm_up

MISSION = "paper/figure-5"
KINEMATIC = ("model=kinematic",)
# Each line gives back what the lines above it left out; with none of them the mission is figure-5.
TAKEN_AWAY = {
    "observer": ("current_observer=none",),
    "crab compensation": ("compensation=none",),
    "coordination, messages": ("coordination=none", "messaging=none"),
    "noisy sensors, reset": ("sensors=ideal", "vehicles.surface.sensors=ideal", "position=direct"),
    "bernoulli channel": ("acoustics=ideal",),
    "medusa (= figure-5)": KINEMATIC,
}
SIMPLEST = tuple(override for overrides in TAKEN_AWAY.values() for override in overrides)
HAS_LANES = not config.DISABLE_JIT


def plan_of(
    effort: Effort,
    overrides: Sequence[str] = (),
    allow_code: Sequence[Path] = (),
    log: bool = False,
    name: str = MISSION,
) -> Plan:
    """A mission for 600 s, figure-5 unless another is named, compiled for float64.

    Args:
        effort: a smoke run flies for less.
        overrides: as for `--set`.
        allow_code: folders with laws that the overrides name.
        log: whether a log is kept, as `cardume run` does.
        name: of a built-in mission.

    Returns:
        The plan.
    """
    seconds = effort.mission_seconds()
    mission = open_mission(name, [f"duration={seconds} s", *overrides], allow_code=allow_code)
    plan = make_plan(mission, catalog(allow_code)).plan
    warm_up(plan)
    return plan if log else replace(plan, log_period=0.0)


def vehicle_steps(plan: Plan) -> int:
    """How many plant steps all vehicles of a mission make together."""
    return plan.num_ticks * round(plan.tick / plan.plant_step) * len(plan.vehicles)


def with_seeds(plan: Plan, count: int) -> list[Plan]:
    """The mission under different noise."""
    return [replace(plan, seed=seed) for seed in range(count)]


def lanes_tables(plan: Plan) -> Tables:
    """Eight missions side by side."""
    return join([make_tables(one, lanes=True) for one in with_seeds(plan, WIDTH)])


def compile_lanes(plan: Plan, progress: Progress) -> float:
    """Bring the lanes build of the engine and of a plan's laws to machine code.

    Args:
        plan: the mission.
        progress: called with a text.

    Returns:
        Seconds that it took, from the cache on disk where that has it.
    """
    progress("compiling the lanes build, unless it is in the cache", 0, 0)
    begin = time.perf_counter()
    advance(lanes_tables(plan), 0, 0)
    return time.perf_counter() - begin


def called_once_per_lane(plan: Plan) -> list[str]:
    """Laws of a plan that do not compile for lanes."""
    laws = {choice.law.name: choice.law for vehicle in plan.vehicles for choice in vehicle.laws.values()}
    return sorted(name for name, law in laws.items() if law.handle(lanes=True) < 0)


def scalar_work(plan: Plan) -> Work:
    """The engine alone on one mission, tables made before."""
    return Work(lambda tables: _all_flown(tables, plan), lambda: make_tables(plan))


def lanes_work(plan: Plan) -> Work:
    """The engine alone on eight missions, tables made before."""
    return Work(lambda tables: _all_flown(tables, plan), lambda: lanes_tables(plan))


def _all_flown(tables: Any, plan: Plan) -> None:
    flown = int(advance(tables, 0, plan.num_ticks))
    if flown != plan.num_ticks:
        raise RuntimeError(f"a mission of the benchmark ended at tick {flown} of {plan.num_ticks}: time means nothing")
