"""Whether a NetCDF-3 file is whole: the NetCDF library reads what is missing at its end as zeros and says nothing."""

from pathlib import Path
from typing import BinaryIO, NamedTuple

STREAMING = 0xFFFFFFFF  # a number of records that was never filled in
SIZES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8, 7: 1, 8: 2, 9: 4, 10: 8, 11: 8}  # nc_type -> bytes
OFFSET_WIDTH = {1: 4, 2: 8, 5: 8}  # version of the format -> bytes of an offset in the file


class ShortFileError(Exception):
    """The header goes on where the file ends, or makes no sense."""


class Variable(NamedTuple):
    """Where the header says that a variable stands."""

    begin: int
    size: int  # bytes, of one record where it has records
    has_records: bool


def promised_size(path: Path) -> int | None:
    """How many bytes a NetCDF-3 file has by its own header.

    Args:
        path: of a file.

    Returns:
        The least size of a whole file; None for a file of another kind, or one whose number of records is not known.

    Raises:
        ShortFileError: the file ends within its header.
    """
    with path.open("rb") as file:
        magic = file.read(4)
        if magic[:3] != b"CDF" or len(magic) < 4 or magic[3] not in OFFSET_WIDTH:
            return None
        return _Header(file, version=magic[3], limit=path.stat().st_size).promised_size()


class _Header:
    """Reads a header number by number; see "NetCDF Classic Format Specification" for its grammar."""

    def __init__(self, file: BinaryIO, *, version: int, limit: int) -> None:
        self.file, self.limit = file, limit
        self.count_width, self.offset_width = 8 if version == 5 else 4, OFFSET_WIDTH[version]

    def promised_size(self) -> int | None:
        num_records = self.number(self.count_width)
        if num_records in (STREAMING, 2**64 - 1):
            return None
        self.number(4)
        lengths = [self.dimension() for _ in range(self.count())]
        self.skip_attributes()
        self.number(4)
        variables = [self.variable(lengths) for _ in range(self.count())]
        in_records = [v.size for v in variables if v.has_records]
        record = in_records[0] if len(in_records) == 1 else sum(_padded(size) for size in in_records)
        ends = [
            v.begin + v.size + (record * (num_records - 1) if v.has_records else 0)
            for v in variables
            if num_records or not v.has_records
        ]
        return max(ends, default=self.file.tell())

    def dimension(self) -> int:
        self.skip(self.count())
        return self.number(self.count_width)

    def variable(self, lengths: list[int]) -> Variable:
        self.skip(self.count())
        shape = []
        for _ in range(self.count()):
            number = self.number(self.count_width)
            if number >= len(lengths):
                raise ShortFileError
            shape.append(lengths[number])
        self.skip_attributes()
        size = SIZES.get(self.number(4), 0)
        self.number(self.count_width)  # its own idea of the size, which cannot hold a large one
        begin = self.number(self.offset_width)
        has_records = bool(shape) and shape[0] == 0
        for length in shape[1:] if has_records else shape:
            size *= length
        return Variable(begin, size, has_records)

    def skip_attributes(self) -> None:
        self.number(4)
        for _ in range(self.count()):
            self.skip(self.count())
            size = SIZES.get(self.number(4), 0)
            self.skip(size * self.count())

    def count(self) -> int:
        """A number of things, each of which takes at least a byte of the file."""
        count = self.number(self.count_width)
        if count > self.limit:
            raise ShortFileError
        return count

    def number(self, width: int) -> int:
        data = self.file.read(width)
        if len(data) < width:
            raise ShortFileError
        return int.from_bytes(data, "big")

    def skip(self, size: int) -> None:
        self.file.seek(_padded(size), 1)
        if self.file.tell() > self.limit:
            raise ShortFileError


def _padded(size: int) -> int:
    return (size + 3) // 4 * 4
