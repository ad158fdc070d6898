"""Which formats of recordings there are, and how one is told from another."""

from collections.abc import Callable, Mapping
from pathlib import Path

from cardume.errors import DataError
from cardume.missions.recordings import bag, evologics, nmea, plaza, table
from cardume.missions.recordings.base import Options, Recording
from cardume.units import printable

Reader = Callable[[Path, Options], Recording]
READERS: Mapping[str, Reader] = {
    "nmea": nmea.read,
    "evologics": evologics.read,
    "plaza": plaza.read,
    "bag": bag.read,
    "csv": table.read,
}
LOG = "log"  # which has a way of its own, recordings/log.py
KINDS = (LOG, *READERS)
MEANINGS = {
    LOG: "the log.nc of a run, or its directory",
    "nmea": "NMEA 0183: GGA, RMC, HDT, GST, VHW, PSIMSSB",
    "evologics": "transcripts of EvoLogics S2C modems: USBLLONG, USBLANGLES",
    "plaza": "the Plaza records of ranges in the package gtsam, .mat",
    "bag": "ROS 1 and ROS 2 bags",
    "csv": "a table, one row for each moment",
}
ENDINGS = {".nc": LOG, ".mat": "plaza", ".bag": "bag", ".mcap": "bag", ".db3": "bag", ".csv": "csv"}
LOOKED_AT = 65_536  # [bytes] of a text


def kind_of(path: Path) -> str:
    """The format of a recording, by its contents, and by its name where these do not say it.

    Args:
        path: of a file or a directory.

    Raises:
        DataError: nothing is there, or it is of no format that is known.
    """
    name = printable(str(path))
    if path.is_dir():
        if (path / "log.nc").exists():
            return LOG
        if (path / "metadata.yaml").exists():
            return "bag"
        raise DataError(f"{name} is a directory without log.nc or metadata.yaml; give that of a run or of a ROS 2 bag")
    try:
        with path.open("rb") as file:
            first = file.read(LOOKED_AT)
    except OSError as problem:
        raise DataError(f"{name} cannot be read: {problem.strerror}; give a recording") from None
    if not first:
        raise DataError(f"{name} is empty; give a recording")
    if first.startswith(b"\x89HDF\r\n"):
        return LOG
    if path.suffix.lower() in ENDINGS:
        return ENDINGS[path.suffix.lower()]
    if b"USBLLONG," in first or b"USBLANGLES," in first:
        return "evologics"
    if any(mark in first for mark in (b"GGA,", b"RMC,", b"$PSIMSSB,")):
        return "nmea"
    if b"time" in first.splitlines()[0].lower().split(b","):
        return "csv"
    raise DataError(f"{name}: it cannot be told what it is; say it with --format: {', '.join(KINDS)}")


def read_recording(path: Path, kind: str, options: Options) -> Recording:
    """A recording.

    Args:
        path: of the file or directory.
        kind: one of READERS.
        options: what a person says beside it.

    Raises:
        InputError: missing, damaged, or without what is needed.
    """
    return READERS[kind](path, options)
