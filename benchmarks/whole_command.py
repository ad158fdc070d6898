"""`cardume run paper/figure-5 --no-figures` as a person waits for it, caches warm."""

import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

from benchmarks.process import Process, cardume_command, run_process
from benchmarks.row import Row
from benchmarks.timing import Effort, Progress, Sample, mean
from benchmarks.workloads import MISSION

TARGET = 1.2  # [s]
RUNS = 5
FLOWN = (0, 1)  # 1: a requirement of the mission was missed


def measure(effort: Effort, progress: Progress) -> Iterator[Row]:
    """Wall time of the whole process, median of five; where imports go when that is too long."""
    runs = 1 if effort.is_smoke else RUNS
    sample = Sample()
    with tempfile.TemporaryDirectory() as folder:
        progress("a first run fills the caches", 0, 0)
        _run(Path(folder), "first", effort)
        for number in range(runs):
            progress("run", number, runs)
            before = effort.calibration.run(10)
            done = _run(Path(folder), f"run-{number}", effort)
            sample.taken.append(done.taken)
            sample.calibrations.append(mean(before, effort.calibration.run(10)))
        remark = _imports(Path(folder), effort) if sample.median > TARGET else ""
    yield Row(
        workload="command",
        case=f"cardume run {MISSION} --no-figures",
        value=sample.best,
        unit="s",
        target=TARGET,
        median=sample.median,
        cpu=sample.cpu,
        ratio=sample.ratio,
        remark=remark,
    )


def _run(folder: Path, name: str, effort: Effort, options: tuple[str, ...] = ()) -> Process:
    python, *cardume = cardume_command()
    command = [python, *options, *cardume, "run", MISSION, "--no-figures", "-o", str(folder / name)]
    if effort.is_smoke:
        command += ["--set", "duration=2 s"]
    return run_process(command, good=FLOWN, folder=folder)


def _imports(folder: Path, effort: Effort) -> str:
    """The five packages that take longest to import, by `python -X importtime`."""
    done = _run(folder, "imports", effort, ("-X", "importtime"))
    taken: dict[str, float] = defaultdict(float)
    for line in done.errors.splitlines():  # import time: own [us] | with what it imports [us] | name
        own, _, rest = line.removeprefix("import time:").partition("|")
        if own.strip().isdecimal():
            package = rest.rpartition("|")[2].strip().partition(".")[0]
            place = "standard library" if package in sys.stdlib_module_names else package
            taken[place] += float(own) * 1e-6
    slowest = sorted(taken, key=lambda package: -taken[package])[:5]
    listed = ", ".join(f"{package} {taken[package]:.2f} s" for package in slowest)
    return f"of {sum(taken.values()):.2f} s of imports: {listed}"
