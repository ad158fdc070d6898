"""The set-up that every make target does by itself: which Python, what is said when one cannot do, which versions."""

import os
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CONSTRAINTS = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
SHIM = "exit 127\n"  # found on the path, but does not run
BARE = 'case "$2" in *version_info*) echo {version} ;; *ensurepip* | venv) exit 1 ;; esac\n'  # has no venv module
WHOLE = 'case "$2" in *version_info*) echo {version} ;; venv) mkdir -p "$4" ;; esac\n'


def make(folder: Path, *arguments: str, **pythons: str) -> subprocess.CompletedProcess[str]:
    """Make an environment in `folder`, where python3.12 etc. are the given shell scripts."""
    commands = folder / "commands"
    commands.mkdir()
    for name in ("3_14", "3_13", "3_12", "3_11", "3"):
        version = name.replace("_", ".")
        command = commands / f"python{version}"
        command.write_text("#!/bin/sh\n" + pythons.get(f"python{name}", SHIM).format(version=version))
        command.chmod(0o755)
    # the make that may have started this test passes on its own settings
    inherited = ("MAKE", "MFLAGS", "PYTHON", "VENV", "ARGS")
    environment = {name: value for name, value in os.environ.items() if not name.startswith(inherited)}
    environment["PATH"] = f"{commands}:{environment['PATH']}"
    target = f"{folder}/env/made-in"
    command_line = ["make", f"VENV={folder}/env", *arguments, target]
    return subprocess.run(command_line, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=60)


def test_a_python_that_runs_and_can_make_environments_is_taken(tmp_path: Path) -> None:
    result = make(tmp_path, python3_13=BARE, python3_12=WHOLE, python3_11=WHOLE)
    assert result.returncode == 0, result.stderr
    assert "with Python 3.12" in result.stdout
    assert (tmp_path / "env" / "made-in").read_text() == str(ROOT)


def test_a_missing_venv_module_is_named_with_its_package(tmp_path: Path) -> None:
    result = make(tmp_path, python3_12=BARE)
    assert result.returncode != 0
    assert "sudo apt install python3.12-venv" in result.stdout
    assert not (tmp_path / "env").exists()


def test_no_usable_python_is_said(tmp_path: Path) -> None:
    result = make(tmp_path, python3=BARE.replace("{version}", '""'))  # as an unsupported version answers
    assert result.returncode != 0
    assert "no Python 3.11 to 3.14 found" in result.stdout


def test_a_chosen_python_is_not_replaced_by_another(tmp_path: Path) -> None:
    result = make(tmp_path, "PYTHON=python3.13", python3_12=WHOLE)
    assert result.returncode != 0
    assert "PYTHON=python3.13" in result.stdout


def test_constraints_are_versions_only() -> None:
    lines = [line for line in CONSTRAINTS if line and not line.startswith("#")]
    odd = [line for line in lines if not re.fullmatch(r"[A-Za-z0-9._-]+==[0-9][\w.!+]*", line)]
    assert not odd


def test_every_requirement_is_constrained() -> None:
    required = PROJECT["project"]["dependencies"] + PROJECT["build-system"]["requires"]
    required += [one for extra in PROJECT["project"]["optional-dependencies"].values() for one in extra]
    names = {normal(re.match(r"[\w.-]+", requirement)[0]) for requirement in required}
    constrained = {normal(line.partition("==")[0]) for line in CONSTRAINTS}
    assert names <= constrained, f"not in constraints.txt (make constraints): {sorted(names - constrained)}"


@pytest.mark.parametrize("file", ["Makefile", "constraints.txt", "pyproject.toml", ".ci/run"])
def test_no_package_index_is_named(file: str) -> None:
    text = (ROOT / file).read_text(encoding="utf-8")
    assert not re.search(r"index-url|INDEX_URL|find-links|FIND_LINKS|--trusted-host|https?://", text)


def normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def test_what_a_study_imports_when_it_is_needed_is_declared() -> None:
    sources = [path.read_text(encoding="utf-8") for path in (ROOT / "src/cardume/studies").rglob("*.py")]
    modules = {name.partition(".")[0] for text in sources for name in re.findall(r'needed\(\s*"([\w.]+)"', text)}
    assert modules >= {"zarr", "numcodecs"}
    for extra in ("study", "dev"):
        declared = {re.split("[>=<]", line)[0] for line in PROJECT["project"]["optional-dependencies"][extra]}
        assert {name.replace("_", "-") for name in modules} <= declared
