"""What is asked of a replay, and how it is typed."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from cardume.errors import InputError
from cardume.laws import laws_of
from cardume.missions.recordings.base import Options
from cardume.missions.recordings.by_ranges import LAW
from cardume.missions.wording import unknown
from cardume.units import parse_quantity, printable

TICK = 0.1  # [s]


@dataclass(frozen=True, kw_only=True)
class Request:
    """What is to be replayed, and how.

    Attributes:
        path: of the recording.
        kind: its format; empty: by its contents.
        vehicles: only these; none: all.
        position: the position law's name under "law", and its parameters; empty: the flight's own, or a usual one.
        current_observer: the same of the current.
        overrides: of the mission beside these, as `--set` gives them.
        start: [m] north and east, "unknown", or None: what the recording says.
        tick: [s] of a recording that is no flight.
        options: what a person says of the recording.
        looks_back: whether to smooth as well.
        allow_code: folders from which laws may be imported.
    """

    path: Path
    kind: str = ""
    vehicles: tuple[str, ...] = ()
    position: Mapping[str, str] | None = None
    current_observer: Mapping[str, str] | None = None
    overrides: tuple[str, ...] = ()
    start: tuple[float, float] | str | None = None
    tick: float = TICK
    options: Options = Options()
    looks_back: bool = False
    allow_code: tuple[str | Path, ...] = ()


def check_law(family: str, given: Mapping[str, str]) -> None:
    """Refuse the name of a law that there is not, in the words of its option.

    Args:
        family: position or current_observer.
        given: the law and its parameters.

    Raises:
        InputError: there is none of that name.
    """
    names = [*laws_of(family), *((LAW,) if family == "position" else ())]
    name = given.get("law", names[0])
    if name not in names and ":" not in name:
        option = f"--{family.replace('_', '-')}"
        raise InputError(f"{option} law={printable(name)}: {unknown('no such law', name, names)}, or module:function")


def name_of(path: Path) -> str:
    """A name for the results of a recording, safe as that of a folder.

    Args:
        path: of the recording.
    """
    stem = path.absolute().parent.name if path.name == "log.nc" else path.stem
    if stem.isdigit():
        stem = f"{path.absolute().parents[1 if path.name == 'log.nc' else 0].name}-{stem}"
    plain = re.sub(r"[^A-Za-z0-9]+", "-", stem).strip("-").lower()[:40] or "recording"
    return f"replay-{plain}"


def read_position(text: str, option: str) -> dict[str, str]:
    """`law=direct` or `law=kalman_replay,gate=9` as a dictionary; a lone word is the law.

    Args:
        text: what was given.
        option: with which.

    Raises:
        InputError: it is something else.
    """
    found: dict[str, str] = {}
    for part in text.split(","):
        key, equals, value = (word.strip() for word in part.partition("="))
        key, value = (key, value) if equals else ("law", key)
        if not key or not value or key in found:
            raise InputError(
                f"{option} '{printable(text)}' cannot be read; write {option} law=NAME,PARAMETER=VALUE,..."
            )
        found[key] = value
    return found


def read_start(text: str) -> tuple[float, float] | str:
    """`NORTH,EAST` in meters, or `unknown`.

    Args:
        text: what was given.

    Raises:
        InputError: it is something else.
    """
    if text.strip() == "unknown":
        return "unknown"
    parts = text.split(",")
    if len(parts) != 2:
        raise InputError(
            f"--start '{printable(text)}' cannot be read; write NORTH,EAST in meters, as --start 12,-3, or unknown"
        )
    north, east = (parse_quantity(part.strip(), "m") for part in parts)
    return north, east
