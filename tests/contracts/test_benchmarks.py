"""The benchmarks run, and print a row for every workload; how fast anything is, is not asked here."""

import json
import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.reference.native import vector_programs

ROOT = Path(__file__).parents[2]
WIDTHS = [f"C, side by side, {bits} bits" for bits in vector_programs()]  # of this processor
CASES = {
    "mission": ["three MEDUSAs", "three kinematic vehicles"],
    "command": ["cardume run paper/figure-5 --no-figures"],
    "compilation": ["scalar build"],
    "law": ["one mission"],
    "batch": [
        f"{fleet}, scalar, {threads}"
        for fleet in ("figure-5", "figure-5, kinematic", "simplest laws")
        for threads in ("1 thread", "2 threads")
    ],
    "many": ["preparing a mission", "10,000 missions of figure-5", "memory at most"],
    "reference": [
        "cardume, one mission alone",
        "cardume, scalar, 2 threads",
        *(["C, one mission alone", "C, scalar, 2 threads", *WIDTHS] if shutil.which("gcc") else []),
        "NumPy",
        "PythonVehicleSimulator",
        "beside C, scalar",
        "beside C, side by side",
        "beside NumPy",
    ],
    "sizes": ["3 vehicles", "10 vehicles", "10 vehicles beside 3", "2 missions", "4 missions", "beside 2"],
    "study": ["figure-5, 2 threads", "figure-5, 2 Dask workers", "Dask, beside threads"],
    "through water": ["a fix by kalman_replay", "everything, scalar"],
    "families": ["ideal sensors", "observer", "crab", "coordination", "noisy", "bernoulli", "medusa"],
}


def bench(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run the suite as `make bench` does."""
    command = [sys.executable, "-m", "benchmarks", *arguments]
    return subprocess.run(
        command, cwd=ROOT, env=os.environ | environment, capture_output=True, text=True, timeout=280, check=False
    )


def test_a_smoke_run_prints_and_keeps_a_row_for_every_case(tmp_path: Path) -> None:
    kept = tmp_path / "now.json"
    # Nothing is compiled: seconds. In a table that is too narrow a case takes two lines.
    done = bench("--smoke", "--json", str(kept), NUMBA_DISABLE_JIT="1", COLUMNS="200")
    assert done.returncode == 0, done.stderr
    record = json.loads(kept.read_text(encoding="utf-8"))
    for workload, cases in CASES.items():
        rows = [row for row in record["rows"] if row["workload"] == workload]
        assert len(rows) == len(cases), workload
        for row, case in zip(rows, cases, strict=True):
            assert case in row["case"]
            assert row["case"] in done.stdout
            assert math.isfinite(row["value"] or math.nan) or "not measured" in row["remark"]
        assert workload in done.stderr, "no progress was shown"
    assert "mean nothing" in done.stdout

    again = bench("--smoke", "--only", "mission", "--against", str(kept), NUMBA_DISABLE_JIT="1")
    assert again.returncode == 0, again.stderr
    assert "Against now.json" in again.stdout
    assert "observer" not in again.stdout, "only one workload was asked for"


@pytest.mark.slow
def test_a_compiled_smoke_run_has_rows_of_the_lanes_build(tmp_path: Path) -> None:
    kept = tmp_path / "now.json"
    done = bench("--smoke", "--only", "batch", "--only", "families", "--json", str(kept), NUMBA_DISABLE_JIT="0")
    assert done.returncode == 0, done.stderr
    rows = json.loads(kept.read_text(encoding="utf-8"))["rows"]
    assert sum("lanes" in row["case"] for row in rows) == len(CASES["batch"])
    assert sum(row["build"] == "lanes" for row in rows) == len(CASES["families"])


@pytest.mark.parametrize(
    ("name", "text"), [("broken.json", "{"), ("other.json", '{"rows": [], "format": 99}'), ("empty.json", "{}")]
)
def test_a_file_that_is_no_run_is_refused_before_anything_is_measured(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text, encoding="utf-8")
    done = bench("--against", str(tmp_path / name), NUMBA_DISABLE_JIT="1")
    assert done.returncode == 2
    assert name in done.stderr
    assert "Traceback" not in done.stderr


def test_an_unknown_workload_is_refused_with_those_there_are() -> None:
    done = bench("--only", "nothing")
    assert done.returncode == 2
    assert all(workload in done.stderr for workload in CASES)
