"""What a long run shows while it runs: on a terminal, on stderr, and only when it takes more than a second."""

import sys
import threading
import time
from types import TracebackType
from typing import Any

import click

PATIENCE = 1.0  # [s] before anything is shown
WORDS = {
    "compile": "compiling the engine, once per installation",
    "fly": "flying",
    "compare": "flying missions",
    "study": "flying missions",
    "verify": "checking what was flown",
    "tune": "trying values",
}
PACED = ("compare", "study", "tune")  # stages whose pieces take equally long, so that their rate says when they end


class Progress:
    """Called with a stage, how much of it is done, and how much there is; shows it when it takes long.

    Args:
        is_shown: whether anything may be shown at all.
    """

    def __init__(self, is_shown: bool = True) -> None:
        self._is_terminal = sys.stderr.isatty()
        self._is_shown = is_shown
        self._lock = threading.Lock()
        self._timer: threading.Timer | None = None
        self._bar: Any = None
        self._stage, self._done, self._total = "", 0, 0
        self._began = 0.0

    def __enter__(self) -> "Progress":
        return self

    def __exit__(self, _kind: type | None, _error: BaseException | None, _trace: TracebackType | None) -> None:
        self._end_stage()

    def __call__(self, stage: str, done: int, total: int) -> None:
        if not self._is_shown:
            return
        if stage != self._stage:
            self._end_stage()
            self._stage, self._began = stage, time.monotonic()
            # A timer, for a single piece of the compilation takes longer than the patience.
            self._timer = threading.Timer(PATIENCE, self._show)
            self._timer.daemon = True
            self._timer.start()
        with self._lock:
            self._done, self._total = done, total
            if self._bar is not None:
                self._bar.update(self._bar.task_ids[0], completed=done, total=total, pace=self._pace())
        if done >= total:
            self._end_stage()

    def pause(self) -> None:
        """Make room for something else to be said."""
        self._end_stage()
        self._stage = ""

    def _pace(self) -> str:
        """Rate and time left, where they mean something."""
        seconds = time.monotonic() - self._began
        if self._stage not in PACED or not self._done or not seconds:
            return ""
        return pace(self._done, self._total, seconds)

    def _end_stage(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
        with self._lock:
            self._timer = None
            if self._bar is not None:
                self._bar.stop()
                self._bar = None

    def _show(self) -> None:
        if not self._is_terminal:
            if self._stage == "compile":  # a log that stands still for that long needs a word
                click.echo(f"{WORDS['compile']} ...", err=True)
            return
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

        with self._lock:
            if self._timer is None:
                return
            text, count = TextColumn("{task.description}"), TextColumn("{task.completed:.0f} of {task.total:.0f}")
            columns = [text, BarColumn(24), count, TimeElapsedColumn()]
            if self._stage in PACED:
                columns.append(TextColumn("{task.fields[pace]}"))
            bar = Progress(*columns, console=Console(stderr=True), transient=True)
            words = WORDS.get(self._stage, self._stage)
            bar.add_task(words, completed=self._done, total=self._total, pace=self._pace())
            bar.start()
            self._bar = bar


def pace(done: int, total: int, seconds: float) -> str:
    """How fast it goes, and how long it will still take.

    Args:
        done: pieces.
        total: pieces.
        seconds: [s] that what is done took.
    """
    rate = done / seconds
    fast = f"{rate:.3g} per second" if rate >= 1.0 else f"{60.0 * rate:.2g} per minute"
    left = (total - done) / rate
    return f"{fast}, {time_words(left)} left"


def time_words(seconds: float) -> str:
    """A time for people.

    Args:
        seconds: [s]
    """
    if seconds < 120.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 7200.0 else f"{seconds / 3600.0:.1f} h"
