"""Which portions of a study are on the disk, and a checksum of each: what a killed study continues from.

One line for each portion, `number SHA-256`, appended when all its files are written; of two lines for one portion the
later counts.  A line that was cut short, or that does not fit its files, means that the portion is flown again.
"""

import fcntl
import hashlib
import os
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import TracebackType

from cardume.errors import InputError
from cardume.missions.atomic import write_file
from cardume.units import printable

FILE_NAME = "ledger.txt"
TITLE = "cardume study ledger: "
FIRST_LINE = re.compile(TITLE.encode() + rb"([0-9a-f]{64})")
LINE = re.compile(rb"(\d{1,9}) ([0-9a-f]{64})")
AT_ONCE = 1 << 20  # bytes
NOTHING: Mapping[int, str] = {}


class Ledger:
    """The ledger of a study, held by one process at a time.

    Args:
        directory: of the study.
    """

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        self._held = self._file = -1

    def __enter__(self) -> "Ledger":
        name = printable(str(self.directory))
        try:
            self._held = os.open(self.directory, os.O_RDONLY)
            fcntl.flock(self._held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            self.__exit__(None, None, None)
            raise InputError(f"{name} is being flown by another process; wait for it, or end it first") from None
        except OSError as problem:
            self.__exit__(None, None, None)
            raise InputError(f"{name} cannot be used: {problem.strerror}") from None
        return self

    def __exit__(self, _kind: type | None, _error: BaseException | None, _trace: TracebackType | None) -> None:
        for file in (self._file, self._held):
            if file >= 0:
                os.close(file)
        self._file = self._held = -1

    def note(self, number: int, digest: str) -> None:
        """Write that a portion is complete, and force the line to the disk.

        The portion's own files are not forced there: after a power cut the digest tells whether they arrived.

        Args:
            number: of the portion.
            digest: of its files.
        """
        if self._file < 0:
            self._file = os.open(self.directory / FILE_NAME, os.O_RDWR | os.O_APPEND)
        line = f"{number} {digest}\n".encode()
        if not _ends_a_line(self._file):
            line = b"\n" + line
        while line:
            line = line[os.write(self._file, line) :]
        os.fsync(self._file)


def write_ledger(directory: Path, digest: str, noted: Mapping[int, str] = NOTHING) -> None:
    """Write a ledger whole.

    Args:
        directory: of the study.
        digest: of the files that describe it.
        noted: of each portion that is complete.
    """
    lines = [f"{TITLE}{digest}", *(f"{number} {found}" for number, found in sorted(noted.items()))]
    write_file(directory / FILE_NAME, "".join(f"{line}\n" for line in lines).encode())


def read_ledger(directory: Path) -> tuple[str, dict[int, str]]:
    """The digest of what describes the study, "" where it cannot be read, and that of each portion noted as complete.

    Args:
        directory: of the study.
    """
    try:
        lines = (directory / FILE_NAME).read_bytes().split(b"\n")
    except OSError:
        return "", {}
    first = FIRST_LINE.fullmatch(lines[0])
    entries = [found for line in lines[1:] if (found := LINE.fullmatch(line))]
    return first[1].decode() if first else "", {int(entry[1]): entry[2].decode() for entry in entries}


def digest_of(files: Iterable[Path]) -> str:
    """SHA-256 of files, their names and lengths among it; "" if one is not there.

    Args:
        files: in order.
    """
    digest = hashlib.sha256()
    try:
        for file in files:
            with file.open("rb") as content:
                size = os.fstat(content.fileno()).st_size
                digest.update(f"{file.name} {size}\n".encode())
                while part := content.read(AT_ONCE):
                    digest.update(part)
    except OSError:
        return ""
    return digest.hexdigest()


def _ends_a_line(file: int) -> bool:
    """Whether nothing was cut short at the end of the file."""
    size = os.fstat(file).st_size
    return size == 0 or os.pread(file, 1, size - 1) == b"\n"
