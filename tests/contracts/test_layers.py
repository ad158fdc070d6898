"""The layers of pyproject.toml hold, and the contracts that say so bite."""

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "src" / "cardume"
COMPUTE = ("compiler", "maths", "laws.py", "signals.py", "paths", "vehicles", "onboard", "world", "simulation")
FAMILIES = ("guidance", "compensation", "control", "estimation", "coordination", "messaging")
FOLDERS = (
    "cli",
    "lab",
    "report",
    "missions",
    "simulation",
    "onboard",
    "world",
    "paths",
    "vehicles",
    "maths",
    "compiler",
)


def lint(folder: Path) -> subprocess.CompletedProcess[str]:
    """Run import-linter on the package of that folder, with its contracts."""
    command = [sys.executable, "-c", "from importlinter.cli import lint_imports_command as run; run()", "--no-cache"]
    environment = os.environ | {"PYTHONPATH": str(folder / "src")}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)


def test_imports_go_downwards_only() -> None:
    result = lint(ROOT)
    if result.returncode:
        pytest.fail(result.stdout + result.stderr, pytrace=False)


def test_compute_layers_do_not_import_the_package_root() -> None:
    """The root imports everything, so this would be an import upwards that import-linter does not see."""
    found = []
    for path in (path for top in COMPUTE for path in [PACKAGE / top, *(PACKAGE / top).rglob("*.py")] if path.is_file()):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module == "cardume":
                below = [name.name for name in node.names if not (PACKAGE / name.name).is_dir()]
                found += [f"{path.relative_to(ROOT)}:{node.lineno}: from cardume import {name}" for name in below]
            elif isinstance(node, ast.Import) and any(name.name == "cardume" for name in node.names):
                found.append(f"{path.relative_to(ROOT)}:{node.lineno}: import cardume")
    assert not found, "\n".join(found)


def test_every_folder_is_a_package() -> None:
    """Neither import-linter nor the type checker looks into a folder without __init__.py."""
    folders = {path.parent for path in PACKAGE.rglob("*.py")}
    bare = [str(folder.relative_to(ROOT)) for folder in folders if not (folder / "__init__.py").is_file()]
    assert not bare, f"without __init__.py: {sorted(bare)}"


@pytest.fixture
def skeleton(tmp_path: Path) -> Path:
    """An empty package with every required layer, under the real contracts."""
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    package = tmp_path / "src" / "cardume"
    for folder in ("", *FOLDERS, *(f"onboard/{family}" for family in FAMILIES)):
        (package / folder).mkdir(parents=True)
        (package / folder / "__init__.py").touch()
    for module in ("signals", "laws", "trial", "parameters", "units", "errors", "onboard/agent"):
        (package / f"{module}.py").touch()
    return tmp_path


@pytest.mark.parametrize(
    ("module", "line", "broken"),
    [
        ("maths/angles.py", "import cardume.laws", "Layers"),
        ("paths/line.py", "import cardume.vehicles", "Layers"),
        ("onboard/agent.py", "import cardume.world", "Layers"),
        ("report/page.py", "from cardume.cli import main", "Layers"),
        ("utils.py", "", "Layers"),
        ("onboard/guidance/law.py", "import cardume.onboard.control", "Families"),
        ("simulation/fleet.py", "import matplotlib.pyplot", "compiled"),
        ("world/gridded.py", "from netCDF4 import Dataset", "compiled"),
        ("maths/reader.py", "from ruamel.yaml import YAML", "compiled"),
        ("missions/reader.py", "from ruamel.yaml import YAML", ""),
        ("cli/main.py", "import rich, cardume.missions, cardume.report", ""),
    ],
)
def test_the_contracts_bite(skeleton: Path, module: str, line: str, broken: str) -> None:
    (skeleton / "src" / "cardume" / module).write_text(f"{line}\n")
    result = lint(skeleton)
    verdicts = [row for row in result.stdout.splitlines() if row.endswith("BROKEN")]
    if broken:
        assert len(verdicts) == 1, result.stdout + result.stderr
        assert broken in verdicts[0]
        assert result.returncode == 1
    else:
        assert result.returncode == 0, result.stdout + result.stderr
