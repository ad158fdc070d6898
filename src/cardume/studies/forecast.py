"""Before a study flies: what its runs will tell, how long they will take, how much disk they need."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from cardume.compiler import WIDTH
from cardume.errors import InputError
from cardume.missions.mission import Mission
from cardume.studies.cases import Cases
from cardume.studies.flying import PORTION, Progress, able_places, fly_seeds, num_processors
from cardume.studies.run_table import RunTable
from cardume.studies.work import expected_steps, expected_ticks, wants_lanes

GLIMPSE = 2.0  # [s] of a mission, in which every metric that it will have appears
MOST_PROBED = 200  # options that are looked at
MOST_COMPARED = 20  # options of which one must give other numbers with another seed
MOST_TRIED = 100  # runs of which one must be such that its values fit one another
SAMPLE_TIME = 1.0  # [s] that missions flown for their rate may take, beyond the first few
SAMPLE_SHARE = 0.05  # of the time of the study, by which that may be longer
LONGEST_SAMPLE = 5.0  # [s]


@dataclass(frozen=True)
class Forecast:
    """What a study is about to do.

    Attributes:
        missions: still to be flown.
        complete: flown already, when it continues.
        seconds: [s] that flying will take.
        slots: missions that are flown at once.
        bytes: on the disk, at most.
        free: bytes there.
        directory: where to.
        notes: worth knowing.
    """

    missions: int
    complete: int
    seconds: float
    slots: int
    bytes: int
    free: int
    directory: Path
    notes: tuple[str, ...] = ()


class Trial:
    """Flies a few missions before a study: what will they tell, does anything vary, how long do they take.

    Args:
        cases: of the study.
        seeds: (run,) of its runs.
        chances: by key (run,) numbers in (0, 1).
        allow_code: folders from which laws may be imported.
        progress: called with "compile", how much is done, and how much there is.
    """

    def __init__(
        self,
        cases: Cases,
        seeds: np.ndarray,
        chances: Mapping[str, np.ndarray],
        allow_code: tuple[str, ...] = (),
        progress: Progress = lambda stage, done, total: None,
    ) -> None:
        self._cases, self._seeds, self._chances = cases, seeds, chances
        self._allow_code, self._progress = allow_code, progress
        self._lanes = wants_lanes(expected_ticks(cases.mission) * cases.size * len(seeds))

    def glimpses(self) -> tuple[RunTable, ...]:
        """The first moments of every option of every sweep: every metric and requirement is in one of them.

        Raises:
            InputError: the mission cannot be flown.
        """
        places = self._cases.each_option_once()
        chosen = np.unique(np.linspace(0, len(places) - 1, MOST_PROBED).astype(int))
        return tuple(self._glimpse(self._cases.at(places[k])) for k in chosen)

    def is_random(self) -> bool:
        """Whether the seed changes anything, in any of a few cases that show the options of every sweep."""
        places = self._cases.each_option_once()
        chosen = np.unique(np.linspace(0, len(places) - 1, MOST_COMPARED).astype(int))
        return any(self._differs(self._cases.at(places[k])) for k in chosen)

    def _differs(self, mission: Mission) -> bool:
        return self._fly(mission, 2).is_varied

    def seconds(self) -> float:
        """How long [s] one processor takes for one mission of the study, in the mean of its cases.

        It is measured as the study flies: on all processors at once, which share a memory and slow one another down,
        and in portions of which the next is planned while one flies.
        """
        threads = num_processors()
        few, many = (WIDTH * threads, 2 * PORTION) if self._lanes else (threads, 16 * threads)
        self._fly(_shortened(self._first), few, self._lanes)  # compiles
        each = self._timed(few, threads)
        if many * each < min(LONGEST_SAMPLE, SAMPLE_TIME + SAMPLE_SHARE * each * self._cases.size * len(self._seeds)):
            each = self._timed(many, threads)
        share = expected_steps(self._cases.mission) / max(expected_steps(self._first), 1.0)
        return each * threads * share

    def _timed(self, count: int, threads: int) -> float:
        """How long [s] each of several missions takes, all of them flown on so many threads."""
        seeds, chances = self._able(self._first, count)
        begin = time.perf_counter()
        fly_seeds(self._first, seeds, chances=chances, threads=threads, lanes=self._lanes, allow_code=self._allow_code)
        return (time.perf_counter() - begin) / count

    @property
    def _first(self) -> Mission:
        return self._cases.at(self._cases.each_option_once()[0])

    def _fly(self, mission: Mission, count: int, lanes: bool = False) -> RunTable:
        def note(stage: str, done: int, total: int) -> None:
            if stage == "compile":
                self._progress(stage, done, total)

        seeds, chances = self._able(mission, count)
        how: dict[str, Any] = {"allow_code": self._allow_code, "threads": 1, "lanes": lanes or None, "progress": note}
        return fly_seeds(mission, seeds, chances=chances, **how)

    def _able(self, mission: Mission, count: int) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """Runs of a mission whose drawn values fit one another: the first of the study that do, then others."""
        # of the study, and beyond its last run with seeds that go on
        tried = np.arange(max(count, MOST_TRIED))
        seeds = int(self._seeds[0]) + tried
        chances = {key: values[tried % len(values)] for key, values in self._chances.items()}
        able = np.resize(able_places(mission, seeds, chances, count, self._allow_code), count)
        return seeds[able], {key: values[able] for key, values in chances.items()}

    def _glimpse(self, mission: Mission) -> RunTable:
        """All of a mission that cannot be so short."""
        try:
            return self._fly(_shortened(mission), 1)
        except InputError:
            return self._fly(mission, 1)


def check_that_something_varies(cases: Cases, runs: int, is_random: Callable[[], bool]) -> tuple[str, ...]:
    """What is worth knowing of what varies in a study.

    Args:
        cases: of the study.
        runs: of each.
        is_random: tells whether the seed changes anything; asked only where no value is drawn, as it costs two flights
            of up to MOST_COMPARED cases.

    Raises:
        InputError: nothing does, so that all runs would be one.
    """
    if cases.drawn:
        return ()
    if is_random():
        return ("no value is drawn: runs differ by noise and lost messages alone",)
    if not cases.axes:
        raise InputError(
            "nothing varies: with any seed the mission gives the same numbers to the last bit. Let a value be drawn, as"
            " --set 'current.speed={uniform: [0 m/s, 0.3 m/s]}', sweep one, as"
            " --set 'guidance.lookahead={sweep: [3 m, 5 m, 8 m]}', or give the sensors noise"
        )
    if runs > 1:
        raise InputError(
            f"the sweeps make {cases.size} cases, but within a case nothing varies: with any seed it gives the same"
            " numbers to the last bit. Fly each once, with --runs 1, or let a value be drawn, as"
            " {uniform: [0 m/s, 0.3 m/s]}"
        )
    return ("no value is drawn and nothing is noisy: one run of each case tells all",)


def _shortened(mission: Mission) -> Mission:
    return replace(mission, duration=GLIMPSE) if _shortest(mission.duration) > GLIMPSE else mission


def _shortest(duration: object) -> float:
    if isinstance(duration, (int, float)):
        return float(duration)
    return min(getattr(duration, "options", (getattr(duration, "low", 0.0),)))
