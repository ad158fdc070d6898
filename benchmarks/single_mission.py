"""One mission, warm: the time in the engine, tables made before."""

from collections.abc import Iterator

from benchmarks.calibration import VEHICLE_STEPS
from benchmarks.row import Row
from benchmarks.timing import Effort, Progress, take_turns
from benchmarks.workloads import KINEMATIC, plan_of, scalar_work, vehicle_steps

TARGET = 8.0  # [ms]
SECONDS = 15.0


def measure(effort: Effort, progress: Progress) -> Iterator[Row]:
    """Figure-5 for 600 s with its log, as MEDUSAs and as kinematic vehicles."""
    plans = {
        "three MEDUSAs, 600 s": plan_of(effort, log=True),
        "three kinematic vehicles, 600 s": plan_of(effort, KINEMATIC, log=True),
    }
    works = {case: scalar_work(plan) for case, plan in plans.items()}
    for case, sample in take_turns(works, SECONDS, effort, progress).items():
        yield Row(
            workload="mission",
            case=case,
            value=sample.best * 1e3,
            unit="ms",
            target=TARGET,
            median=sample.median * 1e3,
            cpu=sample.cpu * 1e3,
            ratio=sample.ratio * VEHICLE_STEPS / vehicle_steps(plans[case]),
        )
