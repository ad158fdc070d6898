"""The program `cardume`: its commands, and what becomes of everything that goes wrong in them.

exit code   0  done, and what was required is met
            1  requirements missed
            2  bad input
            3  the mission failed while flying, or its results could not be kept
            4  a bug of ours
    130, 143   interrupted by Ctrl-C or SIGTERM
"""

import errno
import os
import sys
from collections.abc import Sequence
from difflib import get_close_matches
from typing import Any

import click

from cardume.cli.calibrate import calibrate
from cardume.cli.check import check
from cardume.cli.compare import compare
from cardume.cli.convert import convert
from cardume.cli.lab import lab
from cardume.cli.list import list_
from cardume.cli.new import new
from cardume.cli.replay import replay
from cardume.cli.report import report
from cardume.cli.run import run
from cardume.cli.stopping import Stopped
from cardume.cli.study import study
from cardume.cli.tune import tune
from cardume.errors import CardumeError
from cardume.units import printable

BAD_INPUT, FAILED, BUG, INTERRUPTED, BROKEN_PIPE = 2, 3, 4, 130, 141
UNUSABLE = (errno.ENAMETOOLONG, errno.ELOOP, errno.EACCES, errno.EPERM, errno.EROFS)  # names and places of the user's


class Commands(click.Group):
    """A group that lists its commands in their order and knows what a misspelled one was to be."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names in the order in which they were added."""
        return list(self.commands)

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        """The command that the arguments begin with."""
        name = args[0]
        if self.get_command(ctx, name) is None and not name.startswith("-"):
            names = self.list_commands(ctx)
            is_mission = os.path.exists(name) or "/" in name or name.endswith((".yaml", ".yml"))
            close = get_close_matches(name.lower(), names, n=1, cutoff=0.5)
            meant = f"cardume run {name}" if is_mission else close[0] if close else ""
            hint = f" Did you mean '{printable(meant)}'?" if meant else ""
            ctx.fail(f"There is no command '{printable(name)}'.{hint} Commands: {', '.join(names)}")
        return super().resolve_command(ctx, args)


def _show_version(ctx: click.Context, _parameter: click.Parameter, is_wanted: bool) -> None:
    if is_wanted:
        from cardume.cli.version import version

        click.echo(f"cardume {version()}")
        ctx.exit()


@click.group(
    cls=Commands,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Begin with: cardume run paper/figure-5",
)
@click.option("--version", is_flag=True, is_eager=True, expose_value=False, callback=_show_version, help="Its version.")
def cli() -> None:
    """Fly fleets of marine robots along coordinated paths."""


for _command in (run, check, compare, study, tune, report, lab, calibrate, replay, list_, new, convert):
    cli.add_command(_command)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and leave the process with its exit code."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")  # a file name may hold what the terminal cannot show
    code = _run_safely(arguments)
    try:
        sys.stdout.flush()
    except OSError as problem:
        code = _complain_about_output(problem)
    sys.exit(code)


def _run_safely(arguments: Sequence[str] | None) -> int:
    """Run a command; whatever it raises becomes one message and an exit code."""
    try:
        color = False if os.environ.get("NO_COLOR") else None
        return int(cli.main(arguments, prog_name="cardume", standalone_mode=False, color=color) or 0)
    except click.ClickException as problem:
        problem.show()
        return problem.exit_code
    except SystemExit:  # all that click makes of a pipe that nobody reads any more
        return _complain_about_output(BrokenPipeError(errno.EPIPE, "Broken pipe"))
    except (click.Abort, KeyboardInterrupt):
        return _complain("interrupted; nothing was kept", INTERRUPTED)
    except Stopped as stopped:
        return _complain("interrupted; nothing was kept", stopped.exit_code)
    except CardumeError as problem:
        return _complain(str(problem), problem.exit_code)
    except MemoryError:
        return _complain("not enough memory; shorten the mission, lengthen log_period, or fly fewer vehicles", FAILED)
    except OSError as problem:
        if problem.errno in (errno.ENOSPC, errno.EDQUOT):
            return _complain_about_output(problem)
        if problem.errno in UNUSABLE and problem.filename is not None:
            name = printable(str(problem.filename))
            return _complain(f"{name} cannot be used: {problem.strerror}; give another name or place", BAD_INPUT)
        return _own_up(problem)
    except Exception as problem:
        return _own_up(problem)


def _complain(message: str, code: int) -> int:
    try:
        click.secho("error: ", fg="red", bold=True, nl=False, err=True)
        click.echo(message, err=True)
    except OSError:
        pass  # there is nobody left to tell
    return code


def _complain_about_output(problem: OSError) -> int:
    """Whoever read our output is gone, or its disk is full; nothing more can be written there."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    if problem.errno == errno.EPIPE:
        return BROKEN_PIPE
    return _complain(f"cannot write: {problem.strerror}; make room and run again", FAILED)


def _own_up(problem: Exception) -> int:
    from cardume.cli.bugs import save_traceback

    where = save_traceback(problem)
    kept = f"; the details are in {where}" if where else ", and the details could not be saved"
    return _complain(f"this is a bug in cardume{kept}. Please report it with them.", BUG)
