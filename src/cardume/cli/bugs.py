"""Where the details of a bug are kept, so that the screen need not show them."""

import os
import platform
import sys
import tempfile
import time
import traceback
from pathlib import Path

from cardume.cli.version import version

MOST_KEPT = 20


def save_traceback(problem: BaseException) -> Path | None:
    """Write all there is to know about a bug to a file of the user's.

    Args:
        problem: what was raised.

    Returns:
        The file, or None where none could be written.
    """
    lines = [
        f"cardume {version()}, Python {platform.python_version()}, {platform.platform()}",
        f"command: {sys.argv}",
        *traceback.format_exception(problem),
    ]
    for folder in (_state_folder(), Path(tempfile.gettempdir()) / "cardume"):
        try:
            folder.mkdir(parents=True, exist_ok=True)
            path = folder / f"bug-{time.strftime('%Y%m%d-%H%M%S')}-{os.getpid()}.txt"
            path.write_text("\n".join(lines), encoding="utf-8", errors="backslashreplace")
            _forget_old(folder)
            return path
        except (OSError, RuntimeError):
            continue
    return None


def _state_folder() -> Path:
    """Where programs keep what is neither configuration nor cache."""
    given = os.environ.get("XDG_STATE_HOME") or os.environ.get("LOCALAPPDATA")
    try:
        return (Path(given) if given else Path.home() / ".local" / "state") / "cardume"
    except RuntimeError:  # nobody's home is known
        return Path(tempfile.gettempdir()) / "cardume"


def _forget_old(folder: Path) -> None:
    for path in sorted(folder.glob("bug-*.txt"))[:-MOST_KEPT]:
        path.unlink(missing_ok=True)
