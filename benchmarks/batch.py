"""Many missions at once, through `fly_batch`, without logs."""

from collections.abc import Iterator

from benchmarks.calibration import VEHICLE_STEPS, Taken, clock
from benchmarks.row import RATE, Row
from benchmarks.timing import Effort, Progress, Sample, Work, take_turns
from benchmarks.workloads import (
    HAS_LANES,
    KINEMATIC,
    SIMPLEST,
    compile_lanes,
    lanes_tables,
    plan_of,
    vehicle_steps,
    with_seeds,
)
from cardume.compiler import WIDTH
from cardume.simulation.fly import fly_batch
from cardume.simulation.plan import Plan
from cardume.simulation.tables import make_tables

SECONDS = 20.0  # for each fleet
SCALAR_MISSIONS, LANES_MISSIONS = 16, 64
FLEETS = {"figure-5": (), "figure-5, kinematic": KINEMATIC, "simplest laws": SIMPLEST}


def measure(effort: Effort, progress: Progress) -> Iterator[Row]:
    """Throughput of both builds on one thread and on two."""
    for fleet, overrides in FLEETS.items():
        plan = plan_of(effort, overrides)
        if HAS_LANES:
            compile_lanes(plan, progress)
        yield from _measure_fleet(fleet, plan, effort, progress)


def _measure_fleet(fleet: str, plan: Plan, effort: Effort, progress: Progress) -> Iterator[Row]:
    builds = {"scalar": SCALAR_MISSIONS, "lanes": LANES_MISSIONS} if HAS_LANES else {"scalar": SCALAR_MISSIONS}
    cases = {
        (build, threads): _work(plan, 2 if effort.is_smoke else count, threads, build == "lanes")
        for build, count in builds.items()
        for threads in (1, 2)
    }
    works = {f"{fleet}, {build}, {threads}": work for (build, threads), (work, _) in cases.items()}
    samples = take_turns(works, SECONDS, effort, progress)
    for (build, threads), (_, steps) in cases.items():
        sample = samples[f"{fleet}, {build}, {threads}"]
        yield _row(fleet, build, threads, sample, steps, _remark(plan, build, sample, steps) if threads == 1 else "")


def _work(plan: Plan, count: int, threads: int, lanes: bool) -> tuple[Work, int]:
    plans = with_seeds(plan, count)
    return Work(lambda _: fly_batch(plans, threads, lanes), threads=threads), count * vehicle_steps(plan)


def _row(fleet: str, build: str, threads: int, sample: Sample, steps: int, remark: str) -> Row:
    return Row(
        workload="batch",
        case=f"{fleet}, {build}, {threads} thread{'s' if threads > 1 else ''}",
        value=steps / sample.best * 1e-6,
        unit=RATE,
        median=steps / sample.median * 1e-6,
        cpu=steps / sample.cpu * threads * 1e-6,
        ratio=sample.ratio * VEHICLE_STEPS / steps,
        remark=remark,
    )


def _remark(plan: Plan, build: str, sample: Sample, steps: int) -> str:
    """How much of the time goes into tables, which Python makes."""
    is_lanes = build == "lanes"
    taken: list[Taken] = []
    for _ in range(5):
        with clock(taken):
            _ = lanes_tables(plan) if is_lanes else make_tables(plan)
    of_all = min(t.cpu for t in taken) * steps / (vehicle_steps(plan) * (WIDTH if is_lanes else 1))
    return f"making tables takes {100.0 * of_all / sample.cpu:.0f} % of the time"
