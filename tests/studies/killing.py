"""A study in a process of its own, to be killed; flown again until it is done."""

import os
import sys
from pathlib import Path

import cardume
from cardume.missions.available import catalog
from cardume.missions.loading import parse_mission
from cardume.studies import layout
from studies.missions import NOISY

OVERRIDES = [
    "duration=12 s",
    "current.speed={uniform: [0 m/s, 0.2 m/s]}",
    "guidance.lookahead={sweep: [2 m, 4 m]}",
    "require={cross_track_iae: 20 m s}",
]
RUNS, PORTION = 12, 4


def cut_small() -> None:
    """Cut studies into small portions, so that a kill falls on any of the things that are done for each."""
    layout.PORTION_WORK, layout.SMALLEST_PORTION = 1.0, PORTION


def fly(directory: Path | None, resume: bool = False, runs: int = RUNS, **how: object) -> object:
    """The study that all tests fly."""
    cut_small()
    mission = parse_mission(NOISY, catalog(), OVERRIDES)
    return cardume.study(mission, runs, directory=directory, resume=resume, sampling="sobol", **how)


def fly_in_a_fork(directory: Path, resume: bool, runs: int) -> int:
    """Begin or continue the study in a child of this process, whose engine is compiled already; gives its number."""
    child = os.fork()
    if child == 0:
        try:
            fly(directory, resume, runs, threads=1)
        except BaseException as problem:
            print(f"{type(problem).__name__}: {problem}", file=sys.stderr, flush=True)
            os._exit(1)
        os._exit(0)
    return child
