"""Studies on Dask: the bits of two threads, whoever flew them and whoever died meanwhile."""

import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import xarray

import cardume
from cardume.errors import InputError
from cardume.studies import distributing, layout
from cardume.studies.distributing import Cluster, ClusterError
from studies import killing

distributed = pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def threads() -> Iterator[xarray.Dataset]:
    """The study on two threads."""
    before = layout.PORTION_WORK, layout.SMALLEST_PORTION
    yield killing.fly(None, threads=2)
    layout.PORTION_WORK, layout.SMALLEST_PORTION = before


@pytest.fixture(scope="module")
def cluster() -> Iterator[object]:
    """A cluster that runs already, with two workers."""
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs="CRITICAL"
    ) as made:
        yield made


def workers_of(address: str) -> list[int]:
    """The process numbers of a cluster's workers."""
    with distributed.Client(address, set_as_default=False) as client:
        return list(client.run(os.getpid).values())


def test_two_workers_of_its_own_give_the_bits_of_two_threads(threads: xarray.Dataset) -> None:
    xarray.testing.assert_identical(killing.fly(None, workers=2), threads)


def test_a_cluster_that_runs_already_gives_them_too(threads: xarray.Dataset, cluster: object) -> None:
    told = []
    found = killing.fly(None, scheduler=cluster.scheduler_address, announce=told.append)
    xarray.testing.assert_identical(found, threads)
    assert told[0].slots == 2
    assert len(workers_of(cluster.scheduler_address)) == 2  # it is left running


def test_a_worker_that_dies_costs_its_portion_only(tmp_path: Path, cluster: object) -> None:
    """Killed while it flies, again and again; what was complete is not flown again."""
    address, runs = cluster.scheduler_address, 120
    killed, written, done = [], [], threading.Event()

    def kill() -> None:
        for _ in range(2):
            while not done.is_set() and len(written) < 3 + 6 * len(killed):
                time.sleep(0.01)
            if not done.is_set():
                victim = workers_of(address)[0]
                os.kill(victim, signal.SIGKILL)
                killed.append(victim)

    def note(stage: str, flown: int, total: int) -> None:
        if stage == "study" and flown:
            written.append(flown)

    killer = threading.Thread(target=kill)
    killer.start()
    try:
        killing.fly(tmp_path / "it", runs=runs, scheduler=address, progress=note)
    finally:
        done.set()
        killer.join()
    assert len(killed) == 2
    ledger = (tmp_path / "it" / "ledger.txt").read_text().splitlines()
    assert len(ledger) == 1 + 2 * runs // killing.PORTION  # each portion was written once
    xarray.testing.assert_identical(cardume.open_study(tmp_path / "it").load(), killing.fly(None, runs=runs))


def test_a_scheduler_that_is_not_there_is_told_before_anything_is_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(distributing, "PATIENCE", 0.5)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{free.getsockname()[1]}"
        with pytest.raises(InputError, match=r"no Dask scheduler answers there.*start one with 'dask scheduler'"):
            killing.fly(tmp_path / "it", scheduler=address)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("address", ["nonsense", "tcp://", "http://127.0.0.1:1", "tcp://no.such.host.invalid:1", ""])
def test_an_address_that_is_none_is_told(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(distributing, "PATIENCE", 0.5)
    with pytest.raises(InputError, match="no Dask scheduler answers there"):
        killing.fly(None, scheduler=address)


def test_a_scheduler_that_goes_away_keeps_what_was_flown(tmp_path: Path) -> None:
    made = distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs="CRITICAL"
    )

    def note(stage: str, flown: int, total: int) -> None:
        if stage == "study" and flown == 2 * killing.PORTION:
            made.close()

    with made, pytest.raises(ClusterError, match="--resume continues"):
        killing.fly(tmp_path / "it", runs=200, scheduler=made.scheduler_address, progress=note)
    kept = int((cardume.open_study(tmp_path / "it")["status"] == layout.FLOWN).sum())
    assert 2 * killing.PORTION <= kept < 400


def test_another_cardume_on_the_workers_is_told(cluster: object, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cardume.studies.beginning.stamp", lambda: "0123")
    with pytest.raises(InputError, match="is not that of the study"):
        killing.fly(None, scheduler=cluster.scheduler_address)


def test_a_stop_ends_the_cluster_at_once(tmp_path: Path, cluster: object) -> None:
    seen = []

    def note(stage: str, flown: int, total: int) -> None:
        if stage == "study":
            seen.append(flown)

    began = time.perf_counter()
    found = killing.fly(
        tmp_path / "it",
        runs=3000,
        scheduler=cluster.scheduler_address,
        progress=note,
        should_stop=lambda: len(seen) > 3,
    )
    flown = int((found["status"] == layout.FLOWN).sum())
    assert 0 < flown < 3000
    assert time.perf_counter() - began < 60.0
    with Cluster(cluster.scheduler_address) as again:
        assert again.slots == 2


LAW = '''
"""A law of the user's."""
from cardume.laws import Meters, Positive, Radians
from cardume.maths import atan
from cardume.onboard.guidance.base import guidance_law
from cardume.signals import PathError


@guidance_law
def mine(error: PathError, far: Positive[Meters] = 3.0) -> Radians:
    """chi_d = chi_p - atan(e / far).

    Args:
        error: path error.
        far: [m] how far ahead to aim.

    Returns:
        Desired course [rad], NED.

    Source: eq. (3).
    """
    return error.path_course - atan(error.cross_track / far)
'''


def test_a_law_of_the_users_is_imported_by_the_workers_where_that_is_allowed(tmp_path: Path, cluster: object) -> None:
    (tmp_path / "my_laws.py").write_text(LAW)
    mission = cardume.load(_written(tmp_path), ["guidance={law: my_laws:mine}"], allow_code=[tmp_path])
    how = {"allow_code": [tmp_path], "scheduler": cluster.scheduler_address}
    there = cardume.study(mission, 8, **how).load()
    here = cardume.study(mission, 8, allow_code=[tmp_path])
    xarray.testing.assert_identical(there, here)
    with pytest.raises(InputError, match="--allow-code"):
        cardume.study(_written(tmp_path), 8, overrides=["guidance={law: my_laws:mine}"])


def _written(folder: Path) -> Path:
    file = folder / "mission.yaml"
    file.write_text(killing.NOISY.replace("40 s", "12 s").replace("0.1 m/s", "{uniform: [0 m/s, 0.1 m/s]}"))
    return file


def test_a_worker_without_cardume_is_told(tmp_path: Path) -> None:
    """As on a cluster where nobody installed it."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    bare = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    block = "import sys; sys.modules['cardume'] = None; from distributed.cli.{0} import main; main({1!r})"
    options = ["--host", "127.0.0.1", "--port", str(port), "--no-dashboard"]
    started = [
        subprocess.Popen(
            [sys.executable, "-c", block.format("dask_scheduler", options)], env=bare, stderr=subprocess.DEVNULL
        ),
        subprocess.Popen(
            [
                sys.executable,
                "-c",
                block.format("dask_worker", [f"tcp://127.0.0.1:{port}", "--no-nanny", "--no-dashboard"]),
            ],
            env=bare,
            stderr=subprocess.DEVNULL,
            cwd=tmp_path,
        ),
    ]
    try:
        with distributed.Client(f"tcp://127.0.0.1:{port}", timeout=60, set_as_default=False) as client:
            client.wait_for_workers(1, timeout=60)
        with pytest.raises(ClusterError, match="install the same cardume there"):
            killing.fly(None, scheduler=f"tcp://127.0.0.1:{port}")
    finally:
        for process in started:
            process.kill()
            process.wait()
