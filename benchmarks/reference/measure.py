"""Time the reference workload."""

from collections.abc import Iterator

from benchmarks.calibration import VEHICLE_STEPS
from benchmarks.reference.workload import kernel_work, reference_plans
from benchmarks.row import RATE, Row
from benchmarks.timing import Effort, Progress, Sample, take_turns
from benchmarks.workloads import HAS_LANES, compile_lanes, vehicle_steps
from cardume.simulation.warming import warm_up

SECONDS = 30.0
TARGET = 8.0  # [ms] one mission alone
MISSIONS = 64
ALONE = "one mission"


def measure(effort: Effort, progress: Progress) -> Iterator[Row]:
    """One mission alone, and many on two threads."""
    plans = reference_plans(2 if effort.is_smoke else MISSIONS, effort)
    warm_up(plans[0])
    works = {ALONE: kernel_work(plans[:1], 1, lanes=False), "scalar": kernel_work(plans[:16], 2, lanes=False)}
    if HAS_LANES:
        compile_lanes(plans[0], progress)
        works["lanes"] = kernel_work(plans, 2, lanes=True)
    samples = take_turns(works, SECONDS, effort, progress)
    yield _one(samples[ALONE], vehicle_steps(plans[0]))
    for build, count in {"scalar": len(plans[:16]), "lanes": len(plans)}.items():
        if build in samples:
            yield _many(build, samples[build], count * vehicle_steps(plans[0]))


def _one(sample: Sample, steps: int) -> Row:
    return Row(
        workload="reference",
        case="cardume, one mission alone",
        value=sample.best * 1e3,
        unit="ms",
        target=TARGET,
        median=sample.median * 1e3,
        cpu=sample.cpu * 1e3,
        ratio=sample.ratio * VEHICLE_STEPS / steps,
    )


def _many(build: str, sample: Sample, steps: int) -> Row:
    return Row(
        workload="reference",
        case=f"cardume, {build}, {sample.threads} threads",
        value=steps / sample.best * 1e-6,
        unit=RATE,
        median=steps / sample.median * 1e-6,
        cpu=steps / sample.cpu * sample.threads * 1e-6,
        ratio=sample.ratio * VEHICLE_STEPS / steps,
    )
