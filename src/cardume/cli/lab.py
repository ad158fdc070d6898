"""`cardume lab`: a page on which missions are flown again while sliders move."""

import json
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

import click

from cardume.cli.options import allow_code_option, json_option, quiet_option
from cardume.errors import InputError

FIRST = "paper/figure-5"
DOOR = (
    '<!DOCTYPE html><meta charset="utf-8"><title>cardume lab</title><meta name="referrer" content="no-referrer">'
    '<meta http-equiv="refresh" content="0; url={address}"><p><a href="{address}">To the laboratory</a></p>\n'
)


@click.command(short_help="Move sliders, and see the mission flown again.")
@click.argument("mission", required=False)
@click.option(
    "--folder",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    metavar="DIR",
    help="The only folder that is read and written; else that of MISSION, or the current one.",
)
@click.option("--port", type=click.IntRange(0, 65535), default=0, metavar="N", help="Of this machine; else a free one.")
@click.option("--no-browser", is_flag=True, help="Only print the address.")
@allow_code_option
@quiet_option
@json_option
def lab(
    mission: str | None,
    folder: Path | None,
    port: int,
    no_browser: bool,
    allow_code: tuple[Path, ...],
    quiet: bool,
    as_json: bool,
) -> int:
    """Open the laboratory: a page in the browser, served by this machine to this machine only.

    MISSION is a mission file, a path file, or a built-in mission (cardume list missions); others can be chosen on the
    page. Ctrl-C ends it.
    """
    try:
        from cardume.lab.server import serve
    except ModuleNotFoundError as problem:
        raise InputError(f"the laboratory needs {problem.name}: pip install 'cardume[lab]'") from None
    from cardume.cli.version import version
    from cardume.lab.folder import open_folder
    from cardume.missions import library
    from cardume.missions.opening import nothing_there
    from cardume.report.page.frame import library as plotly

    is_talkative = not quiet and not as_json
    plotly()  # what draws is there, or it is said now
    name, place = mission or FIRST, Path.cwd()
    if name not in library.names() or Path(name).is_file():
        if not Path(name).is_file():
            raise nothing_there(name)
        place = Path(name).parent
    chosen = open_folder(folder or place)
    if Path(name).is_file():
        name = _inside(Path(name), chosen.root)
        chosen.file(name)

    doors = ExitStack()

    def ready(address: str) -> None:
        if as_json:
            click.echo(json.dumps({"address": address, "folder": str(chosen.root)}))
        else:
            click.echo(address if quiet else f"The laboratory is at {address}")
        if is_talkative:
            click.echo(f"It reads and writes {chosen} only. Ctrl-C ends it.")
        sys.stdout.flush()
        if not no_browser:
            with suppress(OSError):  # no room for its file: the address was printed
                _open(doors.enter_context(door(address)))

    with doors:
        serve(chosen, name, version(), port=port, allow_code=tuple(allow_code), ready=ready)
    if is_talkative:
        click.echo("\nThe laboratory has ended.")
    return 0


def _inside(file: Path, folder: Path) -> str:
    try:
        return file.resolve().relative_to(folder).as_posix()
    except ValueError:
        raise InputError(f"{file} lies outside of {folder}; give its folder with --folder, or none") from None


@contextmanager
def door(address: str) -> Iterator[Path]:
    """A file that leads to the laboratory, there while a block runs.

    The browser is started with this file's name: the command lines of a machine are open to all of its users, and the
    address holds the secret. Nobody but its owner can read the file.

    Args:
        address: of the laboratory.
    """
    import os
    import tempfile

    handle, name = tempfile.mkstemp(prefix="cardume-lab-", suffix=".html")  # its mode is 0600
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(DOOR.format(address=address))
        yield Path(name)
    finally:
        Path(name).unlink(missing_ok=True)


def _open(file: Path) -> None:
    import threading
    import webbrowser

    threading.Thread(target=webbrowser.open, args=(file.as_uri(),), daemon=True).start()
