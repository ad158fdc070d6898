"""Must show 5: one mission and one seed give the same bits, however and wherever they are flown."""

from __future__ import annotations

import hashlib
import json
import os
import platform
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cardume.compiler import where
from cardume.laws import Meters, Positive, Radians
from cardume.maths import atan2
from cardume.onboard.guidance import guidance_law
from cardume.signals import NOTHING, PathError
from cardume.simulation.engine import advance
from cardume.simulation.fly import Flown, fly, fly_batch
from cardume.simulation.plan import Choice, Plan
from cardume.simulation.tables import make_tables
from properties.flown import LOCAL, different_tables, far_tables, kept, plan_of
from properties.test_independence import MEMBERS, mission

TEXT = mission(list(MEMBERS))
SEEDS = range(11)  # two groups of lanes, the second not full


@pytest.fixture(scope="module")
def plans() -> list[Plan]:
    """Missions of one shape and many numbers: seeds, currents, losses, gains."""
    numbers = [(0.02 * k, 0.05 * k, 3.0 + 0.5 * k, 0.1 * k) for k in SEEDS]
    return [
        plan_of(
            TEXT,
            [
                f"current.speed={current} m/s",
                f"acoustics.loss={loss}",
                f"guidance.lookahead={lookahead} m",
                f"vehicles.port.start.cross_track={start} m",
            ],
            seed,
        )
        for seed, (current, loss, lookahead, start) in zip(SEEDS, numbers, strict=True)
    ]


@pytest.fixture(scope="module")
def alone(plans: Sequence[Plan]) -> list[Flown]:
    """Each flown by itself."""
    return [fly(plan) for plan in plans]


def assert_same(one: Sequence[Flown], other: Sequence[Flown]) -> None:
    assert len(one) == len(other)
    for a, b in zip(one, other, strict=True):
        assert (a.plan, a.ticks, a.trouble, a.stopped) == (b.plan, b.ticks, b.trouble, b.stopped)
        assert different_tables(a.tables, b.tables) == []


def test_missions_differ_from_one_another(alone: Sequence[Flown]) -> None:
    assert len({flown.tables.log.tobytes() for flown in alone}) == len(alone)
    assert all(flown.trouble is None and flown.ticks == 600 for flown in alone)


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_a_batch_on_any_number_of_threads(plans: Sequence[Plan], alone: Sequence[Flown], threads: int) -> None:
    assert_same(alone, fly_batch(plans, threads))


@pytest.mark.parametrize("threads", [1, 2])
def test_lanes(plans: Sequence[Plan], alone: Sequence[Flown], threads: int) -> None:
    assert_same(alone, fly_batch(plans, threads, lanes=True))


def test_a_mission_does_not_depend_on_its_lane_nor_on_its_neighbors(
    plans: Sequence[Plan], alone: Sequence[Flown]
) -> None:
    order = [7, 3, 0, 3, 9, 10, 1, 2, 5]
    assert_same([alone[k] for k in order], fly_batch([plans[k] for k in order], lanes=True))


@pytest.mark.parametrize("length", [1, 7, 599])
def test_slices_of_any_length(plans: Sequence[Plan], alone: Sequence[Flown], length: int) -> None:
    tables, now = make_tables(plans[2]), 0
    while now < plans[2].num_ticks:
        now = int(advance(tables, now, min(now + length, plans[2].num_ticks)))
    assert different_tables(alone[2].tables, tables) == []


def test_a_mission_stopped_half_way_is_the_first_half_of_the_whole(plans: Sequence[Plan]) -> None:
    half, whole = fly(replace(plans[1], duration=30.0)), fly(plans[1])
    records = half.tables.log[~np.isnan(half.tables.log)].size // 10 * 10
    assert records > 1000
    width = half.tables.log.size // 31  # thirty seconds and the start
    assert np.array_equal(half.tables.log[: 30 * width], whole.tables.log[: 30 * width], equal_nan=True)


# ---- laws of a user's own --------------------------------------------------------------------------------------------


@guidance_law
def wide(error: PathError, lookahead: Positive[Meters] = 4.0) -> Radians:
    """Compiles for lanes. Source: this test."""
    reach = where(error.cross_track > 1.0, 0.5 * lookahead, lookahead)
    return error.path_course + atan2(-error.cross_track, reach)


@guidance_law
def branching(error: PathError, lookahead: Positive[Meters] = 4.0) -> Radians:
    """The same with an `if`, which no lane can follow. Source: this test."""
    reach = 0.5 * lookahead if error.cross_track > 1.0 else lookahead
    return error.path_course + atan2(-error.cross_track, reach)


def test_a_law_that_does_not_compile_for_lanes_flies_in_lanes_all_the_same(plans: Sequence[Plan]) -> None:
    assert wide.handle(lanes=True) > 0 > branching.handle(lanes=True)
    flights = []
    for law in (wide, branching):
        own = [with_guidance(plan, Choice(law, {"lookahead": 3.0 + 0.1 * k})) for k, plan in enumerate(plans)]
        assert_same(fly_batch(own), fly_batch(own, lanes=True))
        flights.append(fly_batch(own, lanes=True))
    assert [f.tables.log.tobytes() for f in flights[0]] == [f.tables.log.tobytes() for f in flights[1]]


@guidance_law
def failing(error: PathError, state: Meters = 10.0) -> Radians:
    """No number beyond a coordination state. Source: this test."""
    return where(error.path_parameter > state, NOTHING, error.path_course)


def test_a_mission_that_fails_in_a_lane_is_told_from_those_that_do_not(plans: Sequence[Plan]) -> None:
    own = [with_guidance(p, Choice(failing, {"state": 1e6 if k % 2 else 2.0 + k})) for k, p in enumerate(plans[:8])]
    flights, lanes = [fly(plan) for plan in own], fly_batch(own, lanes=True)
    assert [f.trouble is None for f in flights] == [False, True] * 4
    assert_same(flights, lanes)


@pytest.mark.parametrize(
    "override",
    [
        "vehicles.port.guidance.law=arcsine",
        "duration=61 s",
        "acoustics.delay=2.3 s",
        "log_period=2 s",
        "vehicles.zulu.sensors.gnss.latency=1 s",
        "position.law=reset",
    ],
)
def test_missions_that_cannot_share_lanes_are_refused(plans: Sequence[Plan], override: str) -> None:
    with pytest.raises(ValueError, match="in lanes must"):
        fly_batch([plans[0], plan_of(TEXT, [override])], lanes=True)


def with_guidance(plan: Plan, choice: Choice) -> Plan:
    return replace(plan, vehicles=tuple(replace(v, laws=v.laws | {"guidance": choice}) for v in plan.vehicles))


# ---- other processes -------------------------------------------------------------------------------------------------

SCRIPT = """
import json, sys
from acceptance.test_bits import digest
from properties.flown import plan_of
from cardume.simulation.fly import fly, fly_batch
text, seconds = json.load(sys.stdin)
plan = plan_of(text, [f"duration={seconds} s"])
print(json.dumps([digest(fly(plan)), digest(fly_batch([plan], lanes=True)[0]) if "lanes" in sys.argv else None]))
"""


def digest(flown: Flown) -> str:
    """SHA-256 of every table that is not local to a process."""
    found = hashlib.sha256()
    for name, value in kept(flown.tables)._asdict().items():
        if name not in LOCAL:
            found.update(np.asarray(value).tobytes() if isinstance(value, np.ndarray) else repr(value).encode())
    return found.hexdigest()


def elsewhere(seconds: float, variables: Mapping[str, str], *arguments: str) -> list[str | None]:
    """What another process makes of the mission."""
    source = [path for path in sys.path if path]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(source)} | variables
    command = [sys.executable, "-W", "ignore", "-c", SCRIPT, *arguments]
    given = json.dumps([TEXT, seconds])
    done = subprocess.run(command, input=given, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found: list[str | None] = json.loads(done.stdout)
    return found


PLAINLY = """
import json, sys
from pathlib import Path
from properties.flown import plan_of, write_tables
from cardume.simulation.fly import fly
text, override, file = json.load(sys.stdin)
write_tables(Path(file), fly(plan_of(text, [override])).tables)
"""


def fly_plainly(text: str, override: str, folder: Path) -> list[str]:
    """Names of the tables in which plain Python is farther than 1e-12 from compiled code."""
    file = folder / "tables.npz"
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p), "NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-W", "ignore", "-c", PLAINLY]
    given = json.dumps([text, override, str(file)])
    done = subprocess.run(command, input=given, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return far_tables(fly(plan_of(text, [override])).tables, file)


def here(seconds: float) -> str:
    return digest(fly(plan_of(TEXT, [f"duration={seconds} s"])))


def test_another_process() -> None:
    assert elsewhere(60.0, {}, "lanes") == [here(60.0)] * 2


def test_plain_python_agrees_with_compiled_code(tmp_path: Path) -> None:
    """NUMBA_DISABLE_JIT=1 runs the same source to 1e-12: it rounds a product before it adds it."""
    assert fly_plainly(TEXT, "duration=6 s", tmp_path) == []


@pytest.mark.slow
@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="names processors of x86")
@pytest.mark.parametrize("processor", ["x86-64", "haswell"])  # SSE2 alone; AVX2 with FMA, no AVX-512
def test_lesser_instruction_sets(processor: str) -> None:
    assert elsewhere(60.0, {"NUMBA_CPU_NAME": processor, "NUMBA_CPU_FEATURES": ""}, "lanes") == [here(60.0)] * 2
