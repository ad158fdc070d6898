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
DRAG = """
    const [key, count, done] = arguments;
    const row = [...document.querySelectorAll('.control')].find((one) => one.dataset.key === key);
    const slider = row.querySelector('.slider'), first = cardume.latencies.length;
    const move = (number) => {
        if (number === count) return done(cardume.latencies.slice(first));
        slider.value = (0.1 + 0.4 * (number % 7) / 7) * slider.max;
        slider.dispatchEvent(new Event('input', { bubbles: true }));
        const isDrawn = () => cardume.latencies.length > first + number;
        const look = () => isDrawn() ? setTimeout(() => move(number + 1), 50) : setTimeout(look, 5);
        look();
    };
    move(0);
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
                progress("drag", 0, 0)
                taken = page.driver.execute_async_script(DRAG, KEY, MOVES + WARMING)[WARMING:]
        finally:
            process.terminate()
            process.wait(60)
    yield Row(workload="lab", case=case, value=min(taken), unit="ms", target=TARGET, median=median(taken))
