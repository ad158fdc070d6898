"""Time work on a machine that others use too: in turns, each beside the calibration loop."""

import gc
import statistics
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from benchmarks.calibration import Calibration, Taken, clock

CALIBRATION_SHARE = 0.15  # of a work's own time, before it and after it
MOST_LOOPS = 100


class Work(NamedTuple):
    """Something to time: `run` is on the clock, `prepare` makes what it gets and is not."""

    run: Callable[[Any], Any]
    prepare: Callable[[], Any] = lambda: None
    threads: int = 1


class Effort(NamedTuple):
    """How hard to try."""

    calibration: Calibration
    is_smoke: bool = False

    def rounds(self, seconds: float, of_one: float) -> int:
        """How often to repeat what takes some time, to stay within a budget."""
        return 2 if self.is_smoke else max(5, min(60, int(seconds / max(of_one, 1e-9))))

    def mission_seconds(self) -> float:
        """How long the missions last."""
        return 0.5 if self.is_smoke else 600.0


@dataclass
class Sample:
    """What one work took."""

    taken: list[Taken] = field(default_factory=list)
    calibrations: list[Taken] = field(default_factory=list)  # by the loop, around each of them
    threads: int = 1

    @property
    def best(self) -> float:
        """The least time by the clock [s]: others on the machine only add to it."""
        return min(taken.wall for taken in self.taken)

    @property
    def median(self) -> float:
        """The middle time by the clock [s]."""
        return statistics.median(taken.wall for taken in self.taken)

    @property
    def cpu(self) -> float:
        """The least processor time [s]: waiting for others does not add to it."""
        return min(taken.cpu for taken in self.taken)

    @property
    def median_cpu(self) -> float:
        """The middle processor time [s]."""
        return statistics.median(taken.cpu for taken in self.taken)

    @property
    def ratio(self) -> float:
        """The middle of the ratios to the loop: of processor time, or by the clock where threads share the work."""
        pairs = zip(self.taken, self.calibrations, strict=True)
        return statistics.median(t.cpu / c.cpu if self.threads == 1 else t.wall / c.wall for t, c in pairs)


Progress = Callable[[str, int, int], None]


def take_turns(works: Mapping[str, Work], seconds: float, effort: Effort, progress: Progress) -> dict[str, Sample]:
    """Time several works in turns A B C, C B A, ..., so that what the machine does besides hits all of them.

    Args:
        works: by name.
        seconds: [s] to spend on all of them together, about.
        effort: how hard to try.
        progress: called with a text, the round, and how many there are.

    Returns:
        A sample for each name.
    """
    loop = effort.calibration.run().wall
    loops, of_one_round = {}, 0.0
    for name, work in works.items():  # also brings code and data into the caches
        progress(f"{name}, first run", 0, 0)
        once = _timed(work).wall
        loops[name] = max(1, min(MOST_LOOPS, round(CALIBRATION_SHARE * once * work.threads / loop)))
        of_one_round += once * (1.0 + 2.0 * CALIBRATION_SHARE)
    rounds = effort.rounds(seconds, of_one_round)
    samples = {name: Sample(threads=work.threads) for name, work in works.items()}
    for turn in range(rounds):
        progress("rounds", turn, rounds)
        for name in list(works) if turn % 2 == 0 else reversed(list(works)):
            work = works[name]
            before = effort.calibration.run(loops[name], work.threads)
            samples[name].taken.append(_timed(work))
            after = effort.calibration.run(loops[name], work.threads)
            samples[name].calibrations.append(mean(before, after))
    return samples


def mean(one: Taken, other: Taken) -> Taken:
    """Between two times."""
    return Taken(0.5 * (one.wall + other.wall), 0.5 * (one.cpu + other.cpu))


def _timed(work: Work) -> Taken:
    given = work.prepare()
    taken: list[Taken] = []
    with no_garbage_collection(), clock(taken):
        work.run(given)
    return taken[0]


@contextmanager
def no_garbage_collection() -> Iterator[None]:
    """A collection in one run and not in the next would look like noise."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()
