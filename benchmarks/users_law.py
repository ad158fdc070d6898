"""A user's law against the built-in one of the same formula, A B, B A, A B, ... on the same mission."""

import statistics
import tempfile
from collections.abc import Iterator
from pathlib import Path

from benchmarks.row import Row
from benchmarks.timing import Effort, Progress, Sample, Work, take_turns
from benchmarks.workloads import HAS_LANES, compile_lanes, lanes_work, plan_of, scalar_work

TARGET = 10.0  # [%]
SECONDS = 20.0
LANES = "eight missions in lanes"
SOURCE = '''"""A law as a user writes it."""

from cardume.laws import Meters, Positive, Radians
from cardume.maths import atan2
from cardume.onboard.guidance import guidance_law
from cardume.signals import PathError


@guidance_law
def users_line_of_sight(error: PathError, lookahead: Positive[Meters] = 5.0) -> Radians:
    return error.path_course + atan2(-error.cross_track, lookahead)
'''


def measure(effort: Effort, progress: Progress) -> Iterator[Row]:
    """How much slower a mission is with the user's law, for each build of the engine."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "benchmarked_law.py").write_text(SOURCE, encoding="utf-8")
        users = ["guidance={law: 'benchmarked_law:users_line_of_sight', lookahead: 5 m}"]
        plans = {"built-in": plan_of(effort), "user's": plan_of(effort, users, [Path(folder)])}
        works = {name: scalar_work(plan) for name, plan in plans.items()}
        yield _compare("one mission", works, effort, progress)
        if HAS_LANES:
            for plan in plans.values():
                compile_lanes(plan, progress)
            works = {name: lanes_work(plan) for name, plan in plans.items()}
            yield _compare(LANES, works, effort, progress)


def _compare(case: str, works: dict[str, Work], effort: Effort, progress: Progress) -> Row:
    samples = take_turns(works, SECONDS, effort, progress)
    ours, theirs = samples["built-in"], samples["user's"]
    low, middle, high = _quartiles(ours, theirs)
    return Row(
        workload="law",
        case=case,
        value=middle,
        unit="%",
        target=TARGET,
        remark=f"processor time of pairs of runs: a quarter below {low:+.1f} %, a quarter above {high:+.1f} %;"
        f" best runs {100.0 * (theirs.cpu / ours.cpu - 1.0):+.1f} %",
    )


def _quartiles(ours: Sample, theirs: Sample) -> list[float]:
    """[%] by which theirs is slower, run by run, in processor time."""
    slower = [100.0 * (b.cpu / a.cpu - 1.0) for a, b in zip(ours.taken, theirs.taken, strict=True)]
    return statistics.quantiles(slower, n=4)
