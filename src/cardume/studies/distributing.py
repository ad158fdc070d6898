"""Who flies the portions of a study: threads of this process, or the workers of a Dask cluster.

Only data is sent: the mission's text, places in its sweeps, seeds and chances; numbers come back.  Tables hold machine
addresses, so they are built where they are flown.  A mission's own laws are imported by a worker from the folders that
the user allowed, and only from those.  Dask packs all of it by pickle, so scheduler and workers must be trusted: they
could run anything here, as whoever reaches them could there.
"""

import hashlib
import signal
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path
from queue import Empty, Queue
from types import TracebackType
from typing import Any, Protocol

import numpy as np

from cardume.compiler import source_stamp
from cardume.errors import CardumeError, InputError, MissionError
from cardume.missions.available import catalog
from cardume.missions.loading import parse_mission
from cardume.missions.mission import Mission
from cardume.studies.cases import Cases, Place, cases_of
from cardume.studies.files import Named, digests_of, named_files, refuse_changed, refuse_stale
from cardume.studies.flying import fly_all, num_processors
from cardume.studies.required import Wanted, wanted_of
from cardume.studies.run_table import Refused, RunTable, tabulate
from cardume.studies.sampling import needed
from cardume.units import printable

NETWORKED = ("tcp", "tls", "ws", "wss")  # ways to a scheduler at a host and a port
PATIENCE = 5.0  # [s] for a scheduler to answer
GLANCE = 0.2  # [s] between two looks at whether to stop
AHEAD = 2000  # tasks that a scheduler knows of at a time
RESUME = "what was flown is kept: --resume continues"


class ClusterError(CardumeError):
    """A cluster that stopped working; what was flown is kept."""

    exit_code = 3


@dataclass(frozen=True)
class Task:
    """A portion, as it is sent to whoever flies it.

    Attributes:
        number: of the portion.
        text: the resolved mission of the study.
        places: the cases to fly.
        seeds: (run,) to fly each with.
        chances: by key (run,) numbers in (0, 1).
        allow_code: folders from which laws may be imported.
        engine: the sources that are to fly it.
        files: that the mission's numbers come from, with their digests.
        lanes: whether eight missions share a register.
    """

    number: int
    text: str
    places: tuple[Place, ...]
    seeds: np.ndarray
    chances: Mapping[str, np.ndarray]
    allow_code: tuple[str, ...]
    engine: str
    files: Mapping[str, str]
    lanes: bool

    @property
    def size(self) -> int:
        """Missions in it."""
        return len(self.places) * len(self.seeds)


class Crew(Protocol):
    """Flies tasks while it is entered, and gives what each left as soon as it is there, in whatever order."""

    def __enter__(self) -> "Crew":
        """Make ready."""
        ...

    def __exit__(self, _kind: type | None, _error: BaseException | None, _trace: TracebackType | None) -> None:
        """Let go of what was made ready."""
        ...

    @property
    def slots(self) -> int:
        """How many missions it flies at once."""
        ...

    def fly(
        self, tasks: Sequence[Task], should_stop: Callable[[], bool], progress: Callable[[int], None]
    ) -> Iterator[tuple[Task, list[RunTable]]]:
        """Task by task what it left; after a stop no more come.

        Args:
            tasks: to fly.
            should_stop: asked every few milliseconds.
            progress: called with the missions flown of tasks that are not given yet.
        """
        ...


class Threads:
    """Flies in this process.

    Args:
        threads: how many at once; None for as many as there are processors.
    """

    def __init__(self, threads: int | None = None) -> None:
        self.slots = threads or num_processors()

    def __enter__(self) -> "Threads":
        return self

    def __exit__(self, _kind: type | None, _error: BaseException | None, _trace: TracebackType | None) -> None:
        pass

    def fly(
        self, tasks: Sequence[Task], should_stop: Callable[[], bool], progress: Callable[[int], None]
    ) -> Iterator[tuple[Task, list[RunTable]]]:
        """See `Crew`."""
        for task in tasks:
            tables = fly_task(task, self.slots, should_stop, progress)
            if should_stop():
                return
            yield task, tables


class Cluster:
    """Flies on the workers of a Dask cluster: of one that runs already, or of one made for the study.

    Args:
        address: of the scheduler; None makes a cluster on this machine.
        workers: processes of the latter.
    """

    def __init__(self, address: str | None = None, workers: int = 1) -> None:
        self._address, self._workers = address, workers
        self._stack = ExitStack()
        self._client: Any = None

    def __enter__(self) -> "Cluster":
        distributed = needed("distributed", "dask and distributed")
        needed("dask", "dask and distributed")
        try:
            if self._address is None:
                with _ignoring_interrupts():  # the workers inherit it
                    self._client = self._stack.enter_context(distributed.Client(self._local(distributed)))
            else:
                self._client = self._stack.enter_context(_connected(distributed, self._address))
        except BaseException:
            self._stack.close()
            raise
        return self

    def __exit__(self, _kind: type | None, _error: BaseException | None, _trace: TracebackType | None) -> None:
        self._stack.close()

    @property
    def slots(self) -> int:
        """How many missions it flies at once now."""
        return sum(self._client.nthreads().values())

    def fly(
        self, tasks: Sequence[Task], should_stop: Callable[[], bool], progress: Callable[[int], None]
    ) -> Iterator[tuple[Task, list[RunTable]]]:
        """See `Crew`.

        Raises:
            ClusterError: the scheduler is gone, or one task after another ended the worker that flew it.
        """
        waiting, flying, done = list(reversed(tasks)), dict[str, tuple[Task, Any]](), Queue[Any]()
        try:
            while (waiting or flying) and not should_stop():
                while waiting and len(flying) < AHEAD:
                    task = waiting.pop()
                    future = self._client.submit(fly_remotely, task, pure=False)
                    flying[future.key] = task, future
                    future.add_done_callback(done.put)
                try:
                    future = done.get(timeout=GLANCE)
                except Empty:
                    if self._client.status != "running":
                        raise ClusterError(f"the Dask scheduler is gone; {RESUME}") from None
                    continue
                task, _ = flying.pop(future.key)
                yield task, _result(future)
        finally:
            self._client.cancel([future for _, future in flying.values()], force=True)

    def _local(self, distributed: Any) -> Any:
        return self._stack.enter_context(
            distributed.LocalCluster(
                n_workers=self._workers,
                threads_per_worker=1,
                processes=True,
                dashboard_address="127.0.0.1:0",  # a free port
                silence_logs="CRITICAL",
            )
        )


@contextmanager
def _ignoring_interrupts() -> Iterator[None]:
    """Let processes that begin meanwhile ignore Ctrl-C, which a terminal sends to all: the study ends them itself."""
    if threading.current_thread() is not threading.main_thread():
        yield  # only the main thread may say so
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def fly_task(
    task: Task,
    threads: int,
    should_stop: Callable[[], bool] = lambda: False,
    progress: Callable[[int], None] = lambda done: None,
) -> list[RunTable]:
    """Fly a portion, each case with each seed.

    Args:
        task: what to fly.
        threads: how many at once.
        should_stop: asked every few milliseconds.
        progress: called with the missions flown so far.

    Returns:
        Tables whose rows, one after another, are the seeds of the first case, then of the next; fewer after a stop.

    Raises:
        InputError: the engine here or a file is another one, or the mission cannot be read here.
    """
    if task.engine != stamp():
        raise InputError(
            f"the cardume here ({stamp()}) is not that of the study ({task.engine}); install the same version wherever"
            " it is flown"
        )
    cases, wanted, named = _read(task.text, task.allow_code)
    refuse_changed(task.files, digests_of(named), "the study", "copy it from where the study was begun")
    refuse_stale(named)
    missions: dict[Place, Mission] = {}
    whys: dict[Place, str] = {}
    for place in task.places:
        try:
            missions[place] = cases.at(place)
        except MissionError as problem:  # options that do not fit one another; the other cases are flown
            whys[place] = str(problem)
    refused = {
        place: tabulate(cases.mission, [Refused(int(seed), why) for seed in task.seeds], wanted)
        for place, why in whys.items()
    }

    def note(stage: str, done: int, _total: int) -> None:
        if stage == "compare":
            progress(done)

    flown = fly_all(
        list(missions.values()),
        task.seeds,
        chances=task.chances,
        allow_code=task.allow_code,
        threads=threads,
        lanes=task.lanes or None,
        wanted=wanted,
        is_lenient=True,
        should_stop=should_stop,
        progress=note,
    )
    found = dict(zip(missions, flown, strict=True)) | refused
    return [found[place] for place in task.places]


def fly_remotely(task: Task) -> list[RunTable]:
    """Fly a portion on a worker, one of whose threads this is.

    Args:
        task: what to fly.
    """
    return fly_task(task, 1)


@cache
def stamp() -> str:
    """A hash of every source file that the numbers of a run depend on."""
    package = Path(__file__).parents[1]
    digest = hashlib.blake2s(source_stamp().encode(), digest_size=8)
    files = [package / "studies" / name for name in ("flying.py", "required.py", "run_table.py")]
    for file in sorted([*files, *(package / "missions").rglob("*.py")]):
        digest.update(file.relative_to(package).as_posix().encode() + file.read_bytes())
    return digest.hexdigest()


@lru_cache(maxsize=4)
def _read(text: str, allow_code: tuple[str, ...]) -> tuple[Cases, tuple[Wanted, ...], Named]:
    cases = cases_of(parse_mission(text, catalog(allow_code), source="the mission of the study"))
    return cases, wanted_of(cases.mission), named_files(cases.mission, allow_code)


def _connected(distributed: Any, address: str) -> Any:
    try:
        _check_address(distributed, address)  # a client that cannot read its address never ends well
        return distributed.Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as problem:
        what = printable(str(problem).splitlines()[0] if str(problem) else type(problem).__name__)[:200]
        raise InputError(
            f"--scheduler {printable(address)}: no Dask scheduler answers there ({what}); start one with"
            " 'dask scheduler', and give the address that it prints, as tcp://192.168.1.7:8786"
        ) from None


def _check_address(distributed: Any, address: str) -> None:
    from distributed.comm.addressing import parse_address, parse_host_port

    scheme, place = parse_address(address)
    if scheme not in NETWORKED:
        raise ValueError(f"{scheme}:// is none of {', '.join(f'{known}://' for known in NETWORKED)}")
    parse_host_port(place)
    is_secret = scheme in ("tls", "wss")
    if is_secret and distributed.Security().get_connection_args("client").get("ssl_context") is None:
        raise ValueError("the configuration of Dask names no certificates, distributed.comm.tls")


def _result(future: Any) -> list[RunTable]:
    """What a task left, or why it left nothing."""
    try:
        tables: list[RunTable] = future.result()
        return tables
    except CardumeError:
        raise
    except Exception as problem:
        name, said = type(problem).__name__, printable(str(problem).splitlines()[0] if str(problem) else "")[:200]
        if name in ("KilledWorker", "CancelledError", "FutureCancelledError", "CommClosedError", "TimeoutError"):
            raise ClusterError(f"the cluster gave a portion up ({name}: {said}); {RESUME}") from None
        is_other = isinstance(problem, RuntimeError) and "deserialization" in str(problem)  # by the scheduler
        if is_other or isinstance(problem, (ImportError, AttributeError, OSError)):
            what = f"the scheduler or a worker cannot fly ({name}: {said}); install the same cardume there"
            raise ClusterError(f"{what}; {RESUME}") from None
        raise
