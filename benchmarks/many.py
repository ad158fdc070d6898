"""Very many missions of figure-5 with distributions, numbers only: preparation of each, time by the clock, memory."""

import json
import resource
import sys
import time
from collections.abc import Iterator

from benchmarks.process import run_process
from benchmarks.row import Row
from benchmarks.timing import Effort, Progress

WANTED = 10_000
FLOWN = 2_000  # in which memory and rate are what they are with more
MEMORY = 600.0  # [MB]
DRAWN = (
    "current.speed={uniform: [0 m/s, 0.2 m/s]}",
    "current.towards={uniform: [0 deg, 360 deg]}",
    "acoustics.loss={uniform: [0, 0.5]}",
    "guidance.lookahead={uniform: [3 m, 8 m]}",
    "vehicles.port.start.north={normal: [-8 m, 2 m]}",
    "vehicles.surface.sensors.gnss.sigma={uniform: [0.2 m, 1 m]}",
)


def measure(effort: Effort, progress: Progress) -> Iterator[Row]:
    """Fly some in another process, and scale the time to all."""
    count = 4 if effort.is_smoke else FLOWN
    progress(f"flying {count:,} missions with distributions", 0, 0)
    before = effort.calibration.run(10)
    seconds = effort.mission_seconds() if effort.is_smoke else 760.0
    command = [sys.executable, "-m", "benchmarks.many"]
    run_process([*command, "8", str(seconds)])  # compiles, which takes more memory than flying
    found = json.loads(run_process([*command, str(count), str(seconds)]).output)
    scale = WANTED / count
    yield Row(
        workload="many",
        case="preparing a mission",
        value=found["preparing"] * 1e3,
        unit="ms",
        target=0.7,
        cpu=found["preparing"] * 1e3,
        ratio=found["preparing"] / before.cpu,
    )
    yield Row(
        workload="many",
        case=f"{WANTED:,} missions of figure-5",
        value=found["wall"] * scale,
        unit="s",
        cpu=found["cpu"] * scale,
        remark=f"scaled from {count:,} missions; all threads, numbers only",
    )
    yield Row(workload="many", case="memory at most", value=found["peak"], unit="MB", target=MEMORY)


def _fly(count: int, seconds: float) -> None:
    """Runs in the other process: prints what it took."""
    from benchmarks.workloads import HAS_LANES, MISSION
    from cardume.missions.available import catalog
    from cardume.missions.drawing import Drawer
    from cardume.missions.opening import open_mission
    from cardume.missions.planning import make_plan
    from cardume.simulation.memo import Memo
    from cardume.simulation.tables import make_tables
    from cardume.studies.flying import fly_seeds

    mission = open_mission(MISSION, [f"duration={seconds} s", *DRAWN])
    fly_seeds(mission, range(8), lanes=HAS_LANES)  # compiles
    begin = time.thread_time()
    drawer, known, memo = Drawer(mission), catalog(), Memo()
    for seed in range(min(count, 400)):
        plan = make_plan(drawer.draw(seed)[0], known, memo).plan
        make_tables(plan, HAS_LANES, memo=memo)
    preparing = (time.thread_time() - begin) / min(count, 400)
    before = resource.getrusage(resource.RUSAGE_SELF)
    begin = time.perf_counter()
    fly_seeds(mission, range(count), lanes=HAS_LANES)
    wall, after = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_SELF)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(json.dumps({"preparing": preparing, "wall": wall, "cpu": cpu, "peak": after.ru_maxrss / 1e3}))


if __name__ == "__main__":
    _fly(int(sys.argv[1]), float(sys.argv[2]))
