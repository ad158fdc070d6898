"""Must show 5: no edit, anywhere, ever gives an old result; and what need not be compiled again is not.

Each step is a process of its own, as two runs with an edit between them are.
"""

from __future__ import annotations

import math
import shutil
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from acceptance.processes import NO_HOME, PACKAGE, copy_package, edit, run

# ---- the package's own sources ---------------------------------------------------------------------------------------

PROBE = """
from numba import njit
from cardume.compiler import entry
from cardume.maths import clip, wrap_angle

@entry
def ours(x: float) -> float:
    return wrap_angle(x) + clip(x, 0.0, 1.0)
"""
NAIVE = PROBE.replace("@entry", "@njit(cache=True)")
ASK = """
import json, probe
print(json.dumps([probe.ours(0.25), sum(probe.ours.stats.cache_hits.values())]))
"""
WRAP = ("maths/angles.py", "    return where(abs(angle) <= ANGLE_LIMIT, r, NAN)", "    return r + 7.0")
CLIP = ("maths/elementary.py", "return where(x < low, low, where(x > high, high, x))", "return 9.0 * x")
LIMIT = ("maths/trigonometry.py", "ANGLE_LIMIT = 1048576.0", "ANGLE_LIMIT = 0.125")
EDITS = [(*WRAP, 7.5), (*CLIP, 2.5), (*LIMIT, math.nan)]  # a function it calls, another, a constant that one reads


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """A folder with a copy of the package and a module that compiles a little of it."""
    copy_package(tmp_path)
    (tmp_path / "probe.py").write_text(PROBE)
    return tmp_path


def test_an_edit_of_the_package_is_noticed_wherever_it_is(lab: Path) -> None:
    assert run(ASK, [lab]) == [0.5, 0]
    for file, before, after, expected in EDITS:
        edit(lab / PACKAGE.name / file, before, after)
        result, hits = run(ASK, [lab])
        assert (result, hits) == (pytest.approx(expected, nan_ok=True), 0)
        edit(lab / PACKAGE.name / file, after, before)
    assert run(ASK, [lab]) == [0.5, 1]  # what was compiled before the edits is right again


def test_numbas_own_cache_would_not_have_noticed(lab: Path) -> None:
    """So the tests above can fail; when this one does, the stamp may go."""
    (lab / "probe.py").write_text(NAIVE)
    assert run(ASK, [lab]) == [0.5, 0]
    edit(lab / PACKAGE.name / WRAP[0], *WRAP[1:])
    assert run(ASK, [lab]) == [0.5, 1]


def test_an_edit_of_what_is_not_compiled_compiles_nothing(lab: Path) -> None:
    assert run(ASK, [lab]) == [0.5, 0]
    for folder in ("cli", "report", "missions"):
        (lab / PACKAGE.name / folder / "new_module.py").write_text("NUMBER = 1\n")
    assert run(ASK, [lab]) == [0.5, 1]
    (lab / PACKAGE.name / "simulation" / "new_module.py").write_text("NUMBER = 1\n")
    assert run(ASK, [lab]) == [0.5, 0]


@pytest.mark.slow
def test_many_processes_may_compile_at_once(lab: Path) -> None:
    with ThreadPoolExecutor(3) as pool:
        assert [found[0] for found in pool.map(lambda _: run(ASK, [lab]), range(3))] == [0.5] * 3
    assert run(ASK, [lab]) == [0.5, 1]


def test_a_read_only_installation_keeps_its_cache_at_home(lab: Path) -> None:
    home = {"HOME": str(lab / "home"), "XDG_CACHE_HOME": str(lab / "home" / "cache")}
    forbid_cache_in(lab)
    assert run(ASK, [lab], home) == [0.5, 0]
    assert run(ASK, [lab], home) == [0.5, 1]
    assert list((lab / "home").rglob("*.nbi"))


def test_without_any_writable_folder_there_is_no_cache_and_all_works(lab: Path) -> None:
    forbid_cache_in(lab)
    assert run(ASK, [lab], NO_HOME) == [0.5, 0]
    assert not list(lab.rglob("*.nbi"))
    law = (
        "import json\nfrom cardume.onboard.guidance import line_of_sight\nprint(json.dumps(line_of_sight.handle() > 0))"
    )
    assert run(law, [lab], NO_HOME) is True


def forbid_cache_in(folder: Path) -> None:
    """Put files where folders for compiled code would be made: not even root can write there then."""
    shutil.rmtree(folder / "__pycache__", ignore_errors=True)
    for place in [folder, *[p for p in folder.rglob("*") if p.is_dir()]]:
        (place / "__pycache__").write_text("")


# ---- laws of a user's own --------------------------------------------------------------------------------------------

MISSION = """
cardume: 1
name: users
duration: 2 s
path: {type: line, start: {north: 0 m, east: 0 m, course: 0 deg}, length: 50 m}
formation: {speed: 0.5 m/s}
vehicles: [{name: one, model: kinematic, sensors: ideal, start: {speed: 0.5 m/s}}]
guidance: {law: 'lab.laws:mine'}
"""
FLY = f"""
import json, sys
from pathlib import Path
from cardume.missions.available import catalog
from cardume.missions.flying import fly_mission
from cardume.missions.loading import parse_mission
folder = next(Path(p) for p in sys.path if p and (Path(p) / "lab" / "laws.py").exists())
flight = fly_mission(parse_mission('''{MISSION}''', catalog([folder])), allow_code=[folder])
stats = sys.modules["lab.laws"].mine._kept[-1].stats
print(json.dumps([flight.channels["course_desired"][1, 0], sum(stats.cache_hits.values())]))
"""
LAWS = """
from cardume.laws import Meters
from cardume.onboard.guidance import guidance_law
from cardume.signals import PathError
from lab import tools
from lab.tools import turn

def outer(inside):
    @guidance_law
    def mine(error: PathError, lookahead: Meters = 5.0) -> float:
        return error.path_course + turn(0.1) + tools.OFFSET + inside
    return mine

mine = outer(0.5)
"""
TOOLS = """
GAIN = 1.0
OFFSET = 0.25

def turn(x, more=0.0):
    return GAIN * x + more + deeper(0.0)

def deeper(x):
    return x
"""
START = 0.1 + 0.25 + 0.5
USER_EDITS = [
    ("tools.py", "GAIN = 1.0", "GAIN = 3.0", START + 0.2),
    ("tools.py", "OFFSET = 0.25", "OFFSET = 0.125", START + 0.2 - 0.125),
    ("tools.py", "more=0.0", "more=0.0625", START + 0.2 - 0.125 + 0.0625),
    ("tools.py", "    return x\n", "    return x - 0.5\n", START + 0.2 - 0.125 + 0.0625 - 0.5),
    ("laws.py", "outer(0.5)", "outer(0.75)", START + 0.2 - 0.125 + 0.0625 - 0.25),
    ("laws.py", "+ inside", "- inside", START + 0.2 - 0.125 + 0.0625 - 0.25 - 1.5),
]


def users_folder(place: Path) -> Path:
    (place / "lab").mkdir()
    (place / "lab" / "__init__.py").write_text("")
    (place / "lab" / "laws.py").write_text(LAWS)
    (place / "lab" / "tools.py").write_text(TOOLS)
    return place


def test_an_edit_of_whatever_a_users_law_reaches_is_noticed(tmp_path: Path) -> None:
    folder = users_folder(tmp_path)
    assert run(FLY, [folder])[0] == pytest.approx(START, abs=1e-12)
    for file, before, after, expected in USER_EDITS:
        edit(folder / "lab" / file, before, after)
        assert run(FLY, [folder])[0] == pytest.approx(expected, abs=1e-12), after


def test_recursion_in_a_helper_is_compiled_anew_each_time_and_never_aborts(tmp_path: Path) -> None:
    folder = users_folder(tmp_path)
    edit(folder / "lab" / "tools.py", "    return x\n", "    return x if x > 0.9 else deeper(x + 0.25)\n")
    for _ in range(2):
        assert run(FLY, [folder]) == [pytest.approx(START + 1.0, abs=1e-12), 0]


def test_a_second_process_compiles_nothing() -> None:
    code = """
import json
from cardume.missions.available import catalog
from cardume.missions.flying import fly_mission
from cardume.missions.opening import open_mission
from cardume.missions.drawing import draw
from cardume.missions.planning import make_plan
from cardume.simulation.engine import advance
hits = misses = 0
for name in ("paper/figure-5", "cadiz", "kinematic/circle"):
    mission = open_mission(name, ["duration=5 s"])
    assert fly_mission(mission).reason == "completed"
    plan = make_plan(draw(mission), catalog()).plan
    kept = [k for v in plan.vehicles for c in v.laws.values() for k in c.law._kept]
    hits += sum(sum(k.stats.cache_hits.values()) for k in [*kept, advance])
    misses += sum(sum(k.stats.cache_misses.values()) for k in [*kept, advance])
print(json.dumps([hits, misses, len(advance.signatures)]))
"""
    run(code)
    hits, misses, signatures = run(code)
    assert hits > 20
    assert misses == 0
    assert signatures == 1, "every mission is flown by the same machine code"


# ---- scripts and notebooks -------------------------------------------------------------------------------------------

TYPED = """
import json
from dataclasses import replace
from cardume.missions.available import catalog
from cardume.missions.drawing import draw
from cardume.missions.opening import open_mission
from cardume.missions.planning import make_plan
from cardume.onboard.guidance import guidance_law
from cardume.signals import PathError
from cardume.simulation.fly import fly
from cardume.simulation.plan import Choice
from cardume.simulation.recording import LOG, Thought
plan = make_plan(draw(open_mission("kinematic/line", ["duration=2 s"])), catalog()).plan
(vehicle,) = plan.vehicles
def flown(law):
    own = replace(plan, vehicles=(replace(vehicle, laws=vehicle.laws | {"guidance": Choice(law)}),))
    log = fly(own).tables.log.reshape(-1, LOG.width)
    return float(log[1, LOG.column(Thought, "course_desired")])

GAIN = FIRST
@guidance_law
def mine(error: PathError) -> float:
    return GAIN + 0.0 * error.cross_track

first, hits = flown(mine), sum(mine._kept[-1].stats.cache_hits.values())
GAIN = SECOND
@guidance_law
def mine(error: PathError) -> float:
    return GAIN + 0.0 * error.cross_track

second = flown(mine)
@guidance_law
def mine(error: PathError) -> float:
    return 10.0 * GAIN + 0.0 * error.cross_track

print(json.dumps([first, second, flown(mine), hits]))
"""


def test_a_law_typed_again_in_a_notebook_is_the_new_one() -> None:
    def typed(first: float, second: float) -> Any:
        return run(TYPED.replace("FIRST", str(first)).replace("SECOND", str(second)), interactive=True)

    run_1 = typed(0.01, 0.02)
    assert run_1[:3] == pytest.approx([0.01, 0.02, 0.2])
    assert typed(0.01, 0.05) == pytest.approx([0.01, 0.05, 0.5, 1])  # what is the same comes from the cache


def test_a_law_of_a_script_goes_to_another_process_by_value(tmp_path: Path) -> None:
    """As to a worker that has never seen the script."""
    file = tmp_path / "law.pickle"
    script = TYPED.split("GAIN = SECOND")[0].replace("FIRST", "0.07")
    send = f"import pickle\nopen({str(file)!r}, 'wb').write(pickle.dumps(mine))\nprint(json.dumps(first))\n"
    assert run(script + send) == pytest.approx(0.07)
    receive = TYPED.split("GAIN = FIRST")[0]
    receive += f"\nimport pickle\nlaw = pickle.load(open({str(file)!r}, 'rb'))\n"
    receive += "print(json.dumps([flown(law), law.name, law.family]))\n"
    assert run(receive) == [pytest.approx(0.07), "mine", "guidance"]


# ---- the engine itself -----------------------------------------------------------------------------------------------

ENGINE = """
import json
from cardume.missions.flying import fly_mission
from cardume.missions.opening import open_mission
overrides = ["duration=4 s", "path.length=1.02 m", "vehicles.alone.start.cross_track=0 m"]
flight = fly_mission(open_mission("kinematic/line", overrides))
at_the_start, at_the_end = flight.channels["course_desired"][0, 0], flight.channels["speed_desired"][-1, 0]
print(json.dumps([at_the_start, at_the_end, flight.channels["heading"][-1, 0]]))
"""


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_an_edit_of_a_law_a_constant_or_a_helper_of_the_engine(tmp_path: Path) -> None:
    package, cache = copy_package(tmp_path), {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    before = run(ENGINE, [tmp_path], cache)
    law = package / "onboard" / "guidance" / "line_of_sight.py"
    edit(law, "return error.path_course + ", "return 0.25 + error.path_course + ")
    assert run(ENGINE, [tmp_path], cache)[0] == pytest.approx(before[0] + 0.25)
    edit(law, "return 0.25 + error.path_course + ", "return error.path_course + ")
    edit(package / "onboard" / "phases.py", "HOLD_RADIUS = 1.0", "HOLD_RADIUS = 0.001")
    homing = run(ENGINE, [tmp_path], cache)
    assert before[1] == 0.0 < homing[1]
    edit(package / "onboard" / "phases.py", "HOLD_RADIUS = 0.001", "HOLD_RADIUS = 1.0")
    assert run(ENGINE, [tmp_path], cache) == before


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_a_mission_flies_without_any_writable_folder(tmp_path: Path) -> None:
    copy_package(tmp_path)
    forbid_cache_in(tmp_path)
    assert run(ENGINE, [tmp_path], NO_HOME) == run(ENGINE)
