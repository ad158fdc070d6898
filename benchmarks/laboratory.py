"""A move of a slider of `cardume lab`, until the new tracks are drawn, in headless Chromium."""

import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from statistics import median

from benchmarks.process import cardume_command
from benchmarks.row import ROOT, Row
from benchmarks.timing import Effort, Progress
from benchmarks.workloads import MISSION

TARGET = 150.0  # [ms]
MOVES, WARMING = 60, 10
KEY = "vehicles.surface.acoustics.loss"
MOVE = """
    const row = [...document.querySelectorAll('.control')].find((one) => one.dataset.key === arguments[0]);
    const slider = row.querySelector('.slider');
    slider.value = arguments[1] * slider.max;
    slider.dispatchEvent(new Event('input', { bubbles: true }));
"""


def measure(effort: Effort, progress: Progress) -> Iterator[Row]:
    """Time from the slider's event to the frame with the new tracks, as the page itself measures it."""
    if effort.is_smoke:
        return  # a browser takes longer than all the rest of a smoke run
    sys.path.insert(0, str(ROOT / "tests"))
    from report.browser import LACKING, browser

    case = f"slider of {MISSION} moved, until drawn"
    if LACKING:
        yield Row(workload="lab", case=case, value=float("nan"), unit="ms", target=TARGET, remark=LACKING)
        return
    with tempfile.TemporaryDirectory() as folder:
        command = [*cardume_command(), "lab", MISSION, "--no-browser", "--quiet", "--folder", folder]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        try:
            assert process.stdout is not None
            address = process.stdout.readline().strip()
            if not re.fullmatch(r"http://\S+", address):
                raise RuntimeError(f"the laboratory did not begin: {address}")
            with browser() as page:
                page.resize(1280, 800)
                page.go(address)
                for number in range(MOVES + WARMING):
                    progress("move", number, MOVES + WARMING)
                    before = page.run("return cardume.latencies.length")
                    page.run(MOVE, KEY, 0.1 + 0.4 * (number % 7) / 7)
                    page.wait(f"cardume.latencies.length > {before}")
                taken = page.run("return cardume.latencies")[WARMING:]
        finally:
            process.terminate()
            process.wait(60)
    yield Row(workload="lab", case=case, value=min(taken), unit="ms", target=TARGET, median=median(taken))
