"""What is being measured, while it is: a moving line on a terminal, plain lines elsewhere."""

from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TaskID, TextColumn, TimeElapsedColumn


class Display:
    """Shows progress on the standard error stream, so that the standard output is the tables."""

    def __init__(self, console: Console) -> None:
        self._console, self._last = console, ""
        self._workload = ""
        columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(20), TimeElapsedColumn())
        self._progress = Progress(*columns, console=console, transient=True, refresh_per_second=2)
        self._task: TaskID | None = None

    def __enter__(self) -> "Display":
        if self._console.is_terminal:
            self._progress.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._progress.stop()

    def begin(self, workload: str, number: int, of: int) -> None:
        """Go on to another workload."""
        self._workload = f"{number}/{of} {workload}"
        if self._task is not None:
            self._progress.remove_task(self._task)
        self._task = self._progress.add_task(self._workload, total=None)
        self("", 0, 0)

    def __call__(self, text: str, done: int, total: int) -> None:
        """Show what is going on, and how far it is where that is known."""
        said = f"{self._workload}: {text}" if text else self._workload
        if self._task is not None and self._console.is_terminal:
            self._progress.update(self._task, description=said, completed=done, total=total or None)
        elif said != self._last:
            self._console.print(said, highlight=False, markup=False)
        self._last = said
