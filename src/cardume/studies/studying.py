"""A study: one mission with distributions and sweeps in it, flown as often as it takes, kept as it goes."""

from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from cardume.errors import InputError
from cardume.missions.results import ResultsError, refusal
from cardume.studies.arms import Given, open_given
from cardume.studies.beginning import Begun, begin
from cardume.studies.distributing import Cluster, Crew, Threads
from cardume.studies.flying import Progress
from cardume.studies.forecast import Forecast
from cardume.studies.layout import block_of
from cardume.studies.resuming import resume_at
from cardume.studies.store import open_study
from cardume.units import printable

if TYPE_CHECKING:
    import xarray

MOST_WORKERS = 1000


def study(
    mission: Given,
    runs: int | None = None,
    *,
    directory: str | Path | None = None,
    sampling: str | None = None,
    seed: int | None = None,
    overrides: Sequence[str] = (),
    allow_code: Iterable[str | Path] = (),
    workers: int | None = None,
    scheduler: str | None = None,
    threads: int | None = None,
    resume: bool = False,
    command: str = "",
    announce: Callable[[Forecast], None] = lambda forecast: None,
    progress: Progress = lambda stage, done, total: None,
    should_stop: Callable[[], bool] = lambda: False,
) -> "xarray.Dataset":
    """Fly every case of a mission's sweeps with many seeds; a killed study continues with `resume`, to the same bits.

        runs = cardume.study("paper/figure-5", 200, overrides=["current.speed={uniform: [0 m/s, 0.3 m/s]}"])
        runs["fleet_cross_track_rms"].quantile(0.95)

    Run k of every case has the seed of the mission plus k, so cases meet the same noise and the same draws.  The number
    of threads or workers, and how the work was cut, change no bit.

    Args:
        mission: file, name of a built-in mission, or what `load` gave; with a distribution, a sweep, or noise in it.
        runs: of each case; what continues knows its own.
        directory: where to keep it: a new one, or that of the study that continues; None keeps it in memory alone.
        sampling: monte_carlo (if None), latin_hypercube or sobol.
        seed: of the first run, and of the sampling, instead of the mission's own.
        overrides: values to change, as `--set` takes them.
        allow_code: folders from which laws may be imported.
        workers: processes of a Dask cluster to be made on this machine.
        scheduler: address of a Dask cluster that runs already, as tcp://192.168.1.7:8786.
        threads: of this process, without Dask; None for as many as there are processors.
        resume: whether to continue the study in the directory.
        command: that was typed, to be kept with the study.
        announce: called once, before the first run flies.
        progress: called with "compile" or "study", how much is done, and how much there is.
        should_stop: asked every few milliseconds; what is complete by then is kept.

    Returns:
        Dimensions are the swept keys, run, vehicle and requirement; `status` is 0 where a stop came before the flight.

    Raises:
        InputError: a mission, or a way to fly it, that cannot be.
        ResultsError: the disk is full, or refused otherwise; what was complete is kept.
    """
    allowed = tuple(str(place) for place in allow_code)
    crew = _crew(workers, scheduler, threads)
    read = open_given(mission, overrides, (), tuple(allow_code))
    read = read if seed is None else replace(read, seed=seed)
    if resume and directory is None:
        raise InputError("--resume continues what is in a directory; say which with -o DIR")
    with ExitStack() as stack:
        if scheduler is not None:
            stack.enter_context(crew)  # a wrong address is told before anything flies
        folder = Path(directory or Path(stack.enter_context(TemporaryDirectory(prefix="cardume-")), "study"))
        if resume:
            begun = resume_at(stack, folder, read, runs, sampling, allowed, progress)
        else:
            begun = begin(folder, read, runs, sampling or "monte_carlo", command, allowed, progress)
        if scheduler is None:
            stack.enter_context(crew)  # only now, as processes take their time to begin
        if not resume:
            _create(begun, stack)
        announce(begun.forecast(crew.slots))
        _fly(begun, crew, progress, should_stop)
        found = open_study(folder)
        return found.load() if directory is None else found


def _create(begun: Begun, stack: ExitStack) -> None:
    try:
        begun.create(stack)
    except OSError as problem:
        raise ResultsError(refusal(begun.directory, problem)) from None


def _fly(begun: Begun, crew: Crew, progress: Progress, should_stop: Callable[[], bool]) -> None:
    """Fly what is left, and keep each portion as soon as it is there."""
    tasks = begun.tasks()
    done, total = 0, sum(task.size for task in tasks)

    def note(more: int) -> None:
        progress("study", min(done + more, total), total)

    if tasks:
        progress("study", 0, total)
    for task, tables in crew.fly(tasks, should_stop, note):
        block = block_of(begun.layout, begun.left[task.number], tables)
        try:
            begun.keep(task.number, block)
        except OSError as problem:
            mended = (
                f"what was flown is kept: mend that, then continue with --resume -o {printable(str(begun.directory))}"
            )
            raise ResultsError(refusal(begun.directory, problem, mended)) from None
        done += task.size
        progress("study", done, total)


def _crew(workers: int | None, scheduler: str | None, threads: int | None) -> Threads | Cluster:
    if workers is not None and scheduler is not None:
        raise InputError("--workers makes a cluster and --scheduler uses one that runs already; give one of them")
    if workers is not None and not 1 <= workers <= MOST_WORKERS:
        raise InputError(f"--workers {workers}: give a whole number from 1 to {MOST_WORKERS}")
    if workers is None and scheduler is None:
        return Threads(threads)
    return Cluster(scheduler, workers or 1)
