"""The commands themselves: help, slips, list, new, check, progress."""

import ast
import io
import json
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import click
import pytest

from cardume.cli import progress as progress_module
from cardume.cli.main import cli
from cardume.cli.new import KINDS, template
from cardume.missions.descriptions import describe
from cli.stand_ins import Result, Stage, command

Cardume = Callable[..., Result]
HEAVY = ("numba", "numpy", "matplotlib", "netCDF4", "ruamel", "rich", "pyproj", "cardume.missions", "cardume.laws")


# ---- help ------------------------------------------------------------------------------------------------------------


def test_help_is_quick_and_imports_nothing_heavy() -> None:
    script = f"""
import sys
from cardume.cli.main import main
try:
    main(["run", "--help"])
finally:
    print([name for name in {HEAVY} if name in sys.modules], file=sys.stderr)
"""
    seconds = []
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    assert done.returncode == 0
    assert ast.literal_eval(done.stderr) == []
    assert min(seconds) < 0.25


def test_every_command_and_option_is_explained(cardume: Cardume) -> None:
    assert cardume("--help").code == 0
    for name, one in cli.commands.items():
        code, out, _ = cardume(name, "--help")
        assert code == 0
        assert out.isascii()
        assert max(map(len, out.splitlines())) <= 100
        for option in one.params:
            assert not isinstance(option, click.Option) or option.help, (name, option.name)


def test_the_list_of_commands_says_each_in_a_line(cardume: Cardume) -> None:
    assert "..." not in cardume("--help").out.partition("Commands:")[2]
    assert all(one.short_help for one in cli.commands.values())


def test_everywhere_the_same_options(cardume: Cardume) -> None:
    for one in cli.commands.values():
        assert {"allow_code", "quiet", "as_json"} <= {option.name for option in one.params}


def test_version(cardume: Cardume) -> None:
    code, out, _ = cardume("--version")
    assert code == 0
    assert out.startswith("cardume ")


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["rnu", "paper/figure-5"], "There is no command 'rnu'. Did you mean 'run'? Commands: run, check,"),
        (["RUN"], "Did you mean 'run'?"),
        (["figure-5.yaml"], "Did you mean 'cardume run figure-5.yaml'?"),
        (["paper/figure-5"], "Did you mean 'cardume run paper/figure-5'?"),
        (["xyzzy"], "There is no command 'xyzzy'. Commands: run"),
        (["run"], "Missing argument 'MISSION'"),
        (["run", "a", "b"], "unexpected extra argument (b)"),
        (["run", "a", "--sed", "3"], "--seed"),
        (["run", "a", "--no-figure"], "--no-figures"),
        (["--verson"], "--version"),
        (["run", "a", "--seed", "three"], "'three' is not a valid integer"),
        (["run", "a", "--seed", "-1"], "-1 is not in the range"),
        (["run", "a", "--seed", str(2**63)], "is not in the range"),
        (["run", "a", "--allow-code", "nowhere"], "does not exist"),
        (["new", "a.txt"], "a.txt: a mission file ends in .yaml; write: cardume new a.yaml"),
        (["new", "."], ". is a directory; give a file in it, as mission.yaml"),
        (["new", "a.yaml", "--kind", "flet"], "'flet' is not one of 'single', 'fleet'"),
        (["list", "guidanc"], "There is no family 'guidanc'. Did you mean 'guidance'?"),
    ],
)
def test_a_slip_says_what_was_meant(
    stage: Stage, cardume: Cardume, laws: None, arguments: list[str], complaint: str
) -> None:
    code, out, err = cardume(*arguments)
    assert (code, out) == (2, "")
    assert complaint in " ".join(err.split())
    assert os.listdir() == []


def test_an_odd_name_does_not_break_the_terminal(stage: Stage, cardume: Cardume) -> None:
    code, _, err = cardume("\x1b[31mred")
    assert code == 2
    assert "\x1b" not in err


# ---- list ------------------------------------------------------------------------------------------------------------

DOC = """Steer for the point on the path's tangent
one lookahead ahead of the projection.

chi_d = chi_p + atan(-e / d),
    e > 0 to starboard

Args:
    lookahead: [m] d = 5 by default.

Source: paper eq. (3),
with the starboard e.
"""


def make_law(name: str) -> SimpleNamespace:
    def parameter(name: str, default: float, unit: str, low: float, high: float) -> SimpleNamespace:
        bounds = {"low": low, "high": high, "low_open": True, "high_open": False}
        return SimpleNamespace(name=name, default=default, unit=unit, words=(), **bounds)

    inf = float("inf")
    parameters = (parameter("lookahead", 5.0, "m", 0.0, inf), parameter("limit", 0.5236, "rad", -inf, 1.5707963267949))
    return SimpleNamespace(name=name, doc=DOC, parameters=parameters, __module__="json.decoder")


@pytest.fixture
def laws(monkeypatch: pytest.MonkeyPatch) -> None:
    found = {"guidance": {"line_of_sight": make_law("line_of_sight")}, "gnss": {"gnss": make_law("gnss")}, "dvl": {}}
    monkeypatch.setattr("cardume.cli.list._every_law", lambda: {name: of for name, of in found.items() if of})


def test_list_shows_families_and_where_they_are_chosen(stage: Stage, cardume: Cardume, laws: None) -> None:
    code, out, _ = cardume("list")
    assert code == 0
    assert "guidance\n    JSON (JavaScript Object Notation)" in out  # the room of the law above
    assert "sensors.gnss: gnss" in out
    assert "dvl" not in out


def test_list_of_a_family_shows_laws_with_equation_units_and_bounds(
    stage: Stage, cardume: Cardume, laws: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    out = cardume("list", "guidance").out
    assert "    Steer for the point on the path's tangent one lookahead ahead of the projection.\n" in out
    assert "      chi_d = chi_p + atan(-e / d),\n" in out
    assert "    lookahead            5 m          above 0 m\n" in out
    assert "    limit                30 deg       at most 90 deg\n" in out
    assert "Source: paper eq. (3), with the starboard e.\n" in out
    assert "Args" not in out


def test_a_law_without_equation_or_source_is_described_too() -> None:
    law = SimpleNamespace(name="mine", doc="", parameters=())
    assert describe(law) == {"name": "mine", "summary": "", "equation": "", "parameters": [], "source": ""}


def test_list_of_paths_shows_their_keys(cardume: Cardume) -> None:
    found = {entry["name"]: entry for entry in json.loads(cardume("list", "paths", "--json").out)}
    assert {"line", "arc", "circle", "lawnmower", "waypoints", "spline", "file"} <= set(found)
    keys = {key["name"]: key for key in found["lawnmower"]["keys"]}
    assert keys["leg"]["needed"]
    assert not keys["turn"]["needed"]
    assert "leg: length of a leg; a number, as '1 m', above 0 m" in cardume("list", "paths").out


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_convert_and_leaves_what_was_there(
    number: signal.Signals, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, cardume: Cardume
) -> None:
    from cardume.missions import converting

    def slow(_request: object) -> None:
        os.kill(os.getpid(), number)
        time.sleep(5.0)

    monkeypatch.setattr(converting, "convert", slow)
    target = tmp_path / "there.yaml"
    target.write_text("mine", encoding="utf-8")
    code, _, err = cardume("convert", "paper/figure-5", str(target), "--force")
    assert code == 128 + number
    assert "interrupted; nothing was kept" in err
    assert target.read_text(encoding="utf-8") == "mine"


def test_list_as_json_and_quietly(stage: Stage, cardume: Cardume, laws: None) -> None:
    found = json.loads(cardume("list", "guidance", "--json").out)
    assert found[0]["parameters"][0] == {
        "name": "lookahead",
        "meaning": "d = 5 by default.",
        "default": 5.0,
        "unit": "m",
        "low": 0.0,
        "high": None,
        "low_open": True,
        "high_open": False,
        "words": [],
    }
    assert cardume("list", "guidance", "-q").out == "line_of_sight\n"
    assert {"name", "summary", "unit", "wanted"} == set(json.loads(cardume("list", "metrics", "--json").out)[0])


# ---- new -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_new_writes_a_mission_and_never_overwrites(stage: Stage, cardume: Cardume, kind: str) -> None:
    code, out, err = cardume("new", "my survey.yaml", "--kind", kind)
    assert (code, err) == (0, "")
    assert "cardume run 'my survey.yaml'" in out
    text = Path("my survey.yaml").read_text(encoding="utf-8")
    assert "\nname: my-survey\n" in text
    Path("my survey.yaml").write_text("mine")
    code, _, err = cardume("new", "my survey.yaml")
    assert code == 2
    assert "exists already" in err
    assert Path("my survey.yaml").read_text() == "mine"


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ["survey.yaml", "2024.yaml", "1e5.yaml", "true.yaml", "Água & Sal.yaml", "./---.yaml"])
def test_what_new_writes_can_be_read(stage: Stage, cardume: Cardume, kind: str, name: str) -> None:
    from cardume.missions.source import parse_yaml

    assert cardume("new", name, "--kind", kind, "-q") == Result(0, "", "")
    tree = parse_yaml(Path(name).read_text(encoding="utf-8"), name)
    assert isinstance(tree.value["name"].value, str)
    assert tree.value["name"].value.replace("-", "").replace("_", "").isalnum()


def test_new_where_nothing_can_be_written(stage: Stage, cardume: Cardume) -> None:
    code, _, err = cardume("new", "nowhere/a.yaml")
    assert code == 2
    assert "nowhere/a.yaml cannot be written: No such file or directory" in err


def test_new_on_a_full_disk_leaves_nothing(stage: Stage, cardume: Cardume, monkeypatch: pytest.MonkeyPatch) -> None:
    real = os.fdopen

    def full(*arguments: object, **named: object) -> object:
        file = real(*arguments, **named)  # type: ignore[call-overload]
        file.close()
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fdopen", full)
    assert cardume("new", "a.yaml").code == 3
    monkeypatch.undo()
    assert "a.yaml" not in os.listdir()


def test_templates_explain_themselves() -> None:
    for kind in KINDS:
        text = template(kind, "mine")
        assert text.isascii()
        assert max(map(len, text.splitlines())) <= 110
        assert text.count("#") > 8


# ---- check -----------------------------------------------------------------------------------------------------------


def finding(
    level: str, suggestion: str = "vehicles.port.offset.starboard=11.9 m and path.spacing=30 m"
) -> SimpleNamespace:
    message = "the inner arc vanishes: its radius would be -1 m"
    return SimpleNamespace(level=level, key="vehicles.port.offset", message=message, suggestion=suggestion)


def test_check_shows_errors_first_and_exits_2(stage: Stage, cardume: Cardume) -> None:
    stage.findings = [finding("note", ""), finding("warning"), finding("error"), finding("warning")]
    code, out, err = cardume("check", "paper/figure-5", "--set", "a=1")
    assert (code, err) == (2, "")
    assert out.startswith("error  vehicles.port.offset\n    the inner arc vanishes")
    assert "would pass: --set 'vehicles.port.offset.starboard=11.9 m' --set 'path.spacing=30 m'" in out
    assert out.endswith("1 error, 2 warnings, 1 note\n")
    assert stage.opened == [("paper/figure-5", ["a=1"], None, [])]


def test_check_without_errors_exits_0(stage: Stage, cardume: Cardume) -> None:
    code, out, _ = cardume("check", "paper/figure-5")
    assert (code, out) == (0, "Nothing found: theory has no objection to this mission.\n")
    stage.findings = [finding("warning")]
    assert cardume("check", "paper/figure-5").code == 0
    assert cardume("check", "paper/figure-5", "-q") == Result(0, "", "")


def test_check_as_json(stage: Stage, cardume: Cardume) -> None:
    stage.findings = [finding("error")]
    code, out, _ = cardume("check", "paper/figure-5", "--json")
    assert code == 2
    assert json.loads(out)["findings"][0]["key"] == "vehicles.port.offset"


# ---- progress --------------------------------------------------------------------------------------------------------


class Terminal(io.StringIO):
    """What a person looks at."""

    encoding = "utf-8"

    def isatty(self) -> bool:
        return True


def take_a_while(stage: str, seconds: float = 0.4) -> None:
    with progress_module.Progress() as progress:
        progress(stage, 0, 18)
        progress(stage, 12, 18)
        time.sleep(seconds)
        progress(stage, 18, 18)


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress_module, "PATIENCE", 0.02)


def test_a_slow_compilation_is_shown(monkeypatch: pytest.MonkeyPatch, impatient: None) -> None:
    """Even when a single piece of it takes all the time."""
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "100")
    take_a_while("compile")
    assert "compiling the engine, once per installation" in terminal.getvalue()
    assert "12 of 18" in terminal.getvalue()


def test_what_is_quick_shows_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    take_a_while("fly", 0.0)
    assert terminal.getvalue() == ""


def test_without_a_terminal_there_is_no_bar(capsys: pytest.CaptureFixture[str], impatient: None) -> None:
    take_a_while("fly")
    assert capsys.readouterr().err == ""
    take_a_while("compile")
    assert capsys.readouterr().err == "compiling the engine, once per installation ...\n"


def test_no_color_and_no_bar_where_output_is_no_terminal(stage: Stage, cardume: Cardume) -> None:
    stage.mission.require = ()
    _, out, err = cardume("run", "paper/figure-5", "--no-figures")
    assert "\x1b" not in out + err


def test_a_terminal_that_is_not_utf_8_shows_everything(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONIOENCODING": "cp1252", "PYTHONUTF8": "0"}
    for arguments in (["--help"], ["list", "metrics"], ["new", "São Jacinto ↯.yaml"], ["run", "none ↯.yaml"]):
        done = subprocess.run(command(*arguments), capture_output=True, env=environment, cwd=tmp_path)
        assert done.returncode in (0, 2), done.stderr
        assert b"Traceback" not in done.stderr
