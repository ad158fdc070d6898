"""What happens once per installation: everything to machine code, in an empty cache."""

import json
import sys
import tempfile
from collections.abc import Callable, Iterator

from benchmarks.calibration import Taken, clock
from benchmarks.process import run_process
from benchmarks.row import Row
from benchmarks.timing import Effort, Progress, mean

TARGET = 20.0  # [s]


def measure(effort: Effort, progress: Progress) -> Iterator[Row]:
    """Compile for figure-5 in another process, and then the lanes build."""
    progress("compiling into an empty cache", 0, 0)
    before = effort.calibration.run(10)
    with tempfile.TemporaryDirectory() as cache:
        environment = {"NUMBA_CACHE_DIR": cache, "NUMBA_DISABLE_JIT": "1" if effort.is_smoke else "0"}
        done = run_process([sys.executable, "-m", "benchmarks.first_compilation"], environment)
    calibration = mean(before, effort.calibration.run(10))
    found = json.loads(done.output.splitlines()[-1])
    cases = {"scalar": ("scalar build and laws of figure-5", TARGET), "lanes": ("lanes build after that", None)}
    for build, seconds in found.items():
        (case, target), taken = cases[build], Taken(*seconds)
        yield Row(
            workload="compilation",
            case=case,
            value=taken.wall,
            unit="s",
            target=target,
            cpu=taken.cpu,
            ratio=taken.cpu / calibration.cpu,
        )


def _compile() -> None:
    """Runs in the other process: prints [wall, processor] seconds for each build."""
    from benchmarks.workloads import HAS_LANES, MISSION, compile_lanes
    from cardume.missions.available import catalog
    from cardume.missions.opening import open_mission
    from cardume.missions.planning import make_plan
    from cardume.simulation.warming import warm_up

    plan = make_plan(open_mission(MISSION), catalog()).plan
    builds: dict[str, Callable[[], object]] = {
        "scalar": lambda: warm_up(plan),
        "lanes": lambda: compile_lanes(plan, lambda text, done, total: None),
    }
    taken: list[Taken] = []
    for compile_build in builds.values() if HAS_LANES else [builds["scalar"]]:
        with clock(taken):
            compile_build()
    print(json.dumps(dict(zip(builds, taken, strict=False))))


if __name__ == "__main__":
    _compile()
