"""A study is of the files that its mission names, too: data, and laws of the user's."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cardume
from cardume.errors import InputError
from cardume.missions.available import catalog
from cardume.missions.opening import open_mission
from cardume.studies import beginning, distributing, files
from cardume.studies.files import digests_of, named_files
from studies.missions import NOISY

LAW = """
from cardume.onboard.guidance import guidance_law
from cardume.signals import PathError
from {module}.numbers import SLANT

@guidance_law
def slanted(error: PathError) -> float:
    '''To one side.

    Source: own.
    '''
    return error.path_course - SLANT * error.cross_track
"""
SHORT = "duration=6 s"


def lay_out(folder: Path, module: str) -> tuple[Path, dict[str, object]]:
    """A mission with a law of its own, which imports a number, and a seabed from a grid."""
    (folder / module).mkdir(parents=True)
    (folder / module / "__init__.py").write_text("")
    (folder / module / "unused.py").write_text("")
    (folder / module / "laws.py").write_text(LAW.format(module=module))
    (folder / module / "numbers.py").write_text("import math\nSLANT = 0.1\n")
    grid = "ncols 2\nnrows 2\nxllcorner -500\nyllcorner -500\ncellsize 1000\nNODATA_value -9999\n-20 -20\n-20 -20\n"
    (folder / "bottom.asc").write_text(grid)
    seabed = "bathymetry: {type: gridded, file: bottom.asc, positive: up, coordinates: local}\n"
    (folder / "mission.yaml").write_text(NOISY + seabed)
    law = f"guidance={{choose: [line_of_sight, {{law: '{module}.laws:slanted'}}]}}"
    return folder / "mission.yaml", {"overrides": [law, SHORT], "allow_code": [folder]}


def test_files_of_laws_and_data_are_found(tmp_path: Path) -> None:
    mission, how = lay_out(tmp_path, "found_laws")
    read = open_mission(mission, how["overrides"], allow_code=[tmp_path])  # type: ignore[arg-type]
    named = named_files(read, [tmp_path])
    assert sorted(named.laws) == ["found_laws/__init__.py", "found_laws/laws.py", "found_laws/numbers.py"]
    assert list(named.data) == [str(tmp_path / "bottom.asc")]
    assert len(set(digests_of(named).values())) == 4


@pytest.fixture
def as_of_a_new_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "_imported", {})


def edit_law(folder: Path, module: str) -> str:
    (folder / module / "numbers.py").write_text("import math\nSLANT = 0.2\n")
    return f"{module}/numbers.py is another than when the study in .* was begun; bring back what it was"


def edit_grid(folder: Path, module: str) -> str:
    (folder / "bottom.asc").write_text((folder / "bottom.asc").read_text().replace("-20 -20\n-20", "-20 -20\n-25"))
    return r"bottom.asc is another than when"


@pytest.mark.parametrize(("module", "edit"), [("laws_edited", edit_law), ("grid_edited", edit_grid)])
def test_a_study_is_not_continued_with_another_file(
    tmp_path: Path, as_of_a_new_process: None, module: str, edit: Callable[[Path, str], str]
) -> None:
    mission, how = lay_out(tmp_path / "here", module)
    cardume.study(mission, 4, directory=tmp_path / "it", should_stop=lambda: True, **how)  # type: ignore[arg-type]
    again = {"directory": tmp_path / "it", "resume": True} | how
    (tmp_path / "here" / module / "unused.py").write_text("NOTHING = 1\n")  # nobody imports it
    said = edit(tmp_path / "here", module)
    with pytest.raises(InputError, match=said):
        cardume.study(mission, **again)  # type: ignore[arg-type]


def test_a_worker_with_another_file_refuses(tmp_path: Path, as_of_a_new_process: None) -> None:
    mission, how = lay_out(tmp_path, "of_worker")
    read = open_mission(mission, how["overrides"], allow_code=[tmp_path])  # type: ignore[arg-type]
    begun = beginning.begin(tmp_path / "it", read, 2, "monte_carlo", "", (str(tmp_path),), lambda *told: None)
    (task,) = begun.tasks()
    assert [len(table) for table in distributing.fly_task(task, 1)] == [2]
    other = {name: "0" * 64 if name.endswith("bottom.asc") else digest for name, digest in task.files.items()}
    with pytest.raises(InputError, match=r"bottom\.asc is another than when the study was begun; copy it"):
        distributing.fly_task(replace(task, files=other), 1)
    edit_law(tmp_path, "of_worker")
    with pytest.raises(InputError, match=r"of_worker/numbers.py is another than when the study was begun"):
        distributing.fly_task(task, 1)


def test_a_law_that_was_edited_after_its_import_is_told(tmp_path: Path, as_of_a_new_process: None) -> None:
    """Python does not import a module twice: what would fly is not what the file says."""
    mission, how = lay_out(tmp_path, "stale_laws")
    assert catalog([tmp_path]).resolve_law("guidance", "stale_laws.laws:slanted")
    first = cardume.study(mission, 2, **how)  # type: ignore[arg-type]
    assert np.isfinite(first["fleet_cross_track_iae"]).all()
    edit_law(tmp_path, "stale_laws")
    with pytest.raises(InputError, match=r"stale_laws/numbers.py was edited after this process imported it"):
        cardume.study(mission, 2, **how)  # type: ignore[arg-type]
