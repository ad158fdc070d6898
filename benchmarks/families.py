"""What each family of laws costs: processor time of the engine alone, laws added one after the other."""

from collections.abc import Iterator

from benchmarks.calibration import VEHICLE_STEPS
from benchmarks.row import RATE, Row
from benchmarks.timing import Effort, Progress, Sample, Work, take_turns
from benchmarks.workloads import (
    HAS_LANES,
    SIMPLEST,
    TAKEN_AWAY,
    called_once_per_lane,
    compile_lanes,
    lanes_work,
    plan_of,
    scalar_work,
    vehicle_steps,
)
from cardume.compiler import WIDTH

SECONDS = 40.0
START = "kinematic, ideal sensors, line of sight"


def measure(effort: Effort, progress: Progress) -> Iterator[Row]:
    """Throughput of both builds, from the simplest laws to figure-5."""
    plans = {}
    for number, (case, overrides) in enumerate(stages().items(), start=1):
        progress(case, number, len(TAKEN_AWAY) + 1)
        plans[case] = plan_of(effort, overrides)
        if HAS_LANES:
            compile_lanes(plans[case], progress)
    works: dict[str, Work] = {f"{case}, scalar": scalar_work(plan) for case, plan in plans.items()}
    if HAS_LANES:
        works |= {f"{case}, lanes": lanes_work(plan) for case, plan in plans.items()}
    samples = take_turns(works, SECONDS, effort, progress)
    for case, plan in plans.items():
        yield _row(case, "scalar", samples[f"{case}, scalar"], vehicle_steps(plan), "")
        if f"{case}, lanes" in samples:
            fallen_back = called_once_per_lane(plan)
            remark = f"called once per lane: {', '.join(fallen_back)}" if fallen_back else ""
            yield _row(case, "lanes", samples[f"{case}, lanes"], WIDTH * vehicle_steps(plan), remark)


def stages() -> dict[str, tuple[str, ...]]:
    """Overrides of figure-5, from the simplest laws to none."""
    left = list(SIMPLEST)
    found = {START: tuple(left)}
    for family, overrides in TAKEN_AWAY.items():
        left = [override for override in left if override not in overrides]
        found[f"+ {family}"] = tuple(left)
    return found


def _row(case: str, build: str, sample: Sample, steps: int, remark: str) -> Row:
    return Row(
        workload="families",
        case=case,
        build=build,
        value=steps / sample.cpu * 1e-6,
        unit=RATE,
        median=steps / sample.median_cpu * 1e-6,
        cpu=steps / sample.cpu * 1e-6,
        ratio=sample.ratio * VEHICLE_STEPS / steps,
        remark=remark,
    )
