"""Pictures of what was flown: nothing is lost for one that cannot be drawn."""

from collections.abc import Callable
from pathlib import Path

import click

BUG = 4


class Drawing:
    """Draws into a folder, and keeps what went wrong.

    Args:
        draw: into the folder that it is given.
        is_wanted: [-] False draws nothing.
    """

    def __init__(self, draw: Callable[[Path], None], is_wanted: bool) -> None:
        self._draw, self._is_wanted = draw, is_wanted
        self.problem: Exception | None = None

    def __call__(self, folder: Path) -> None:
        if not self._is_wanted:
            return
        try:
            self._draw(folder)
        except OSError:
            raise  # the disk: whoever writes the rest tells it
        except Exception as problem:
            self.problem = problem


def own_up(problem: Exception, what: str) -> int:
    """Say that something could not be drawn, and keep the details.

    Args:
        problem: what was raised.
        what: could not be drawn.

    Returns:
        The exit code of a bug.
    """
    from cardume.cli.bugs import save_traceback

    where = save_traceback(problem)
    click.echo(f"error: {what} could not be drawn, a bug in cardume; the details are in {where}", err=True)
    return BUG
