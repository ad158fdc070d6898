"""A block of numbers as the bytes of a Zarr 3 chunk: little-endian, zstd, and a CRC-32C that every reader checks.

zarr writes the same bytes, and a test compares them; but it takes ten times as long for each of the fifty small files
of a portion, which would be a tenth of a study.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np

from cardume.studies.sampling import needed

LEVEL = 1  # of zstd: numbers of different runs hardly resemble one another


def codecs() -> list[Any]:
    """The same as zarr names them in the description of an array."""
    of_zarr = needed("zarr.codecs", "zarr")
    return [of_zarr.ZstdCodec(level=LEVEL), of_zarr.Crc32cCodec()]


def encoded(block: np.ndarray, shape: tuple[int, ...], fill: Any) -> bytes:
    """The bytes of a chunk.

    Args:
        block: numbers, or texts in an array of objects; at the end of an axis less than a chunk.
        shape: of a chunk.
        fill: beyond the end of an axis.

    Source: Zarr core specification 3.1, codecs bytes, vlen-utf8, zstd and crc32c.
    """
    whole = block
    if block.shape != shape:
        whole = np.full(shape, fill, block.dtype)
        whole[tuple(map(slice, block.shape))] = block
    if whole.dtype == object:
        raw = needed("numcodecs", "numcodecs").VLenUTF8().encode(whole.ravel())
    else:
        raw = np.ascontiguousarray(whole if sys.byteorder == "little" else whole.byteswap())
    packed: bytes = needed("numcodecs", "numcodecs").Zstd(level=LEVEL).encode(raw)
    return packed + int(needed("google_crc32c", "google-crc32c").value(packed)).to_bytes(4, "little")


def write_chunk(file: Path, content: bytes) -> None:
    """Write a file so that it appears complete or not at all; whether it is whole after a power cut, the ledger tells.

    Args:
        file: whose folder is made if it is not there.
        content: [bytes] all of it.
    """
    partial = file.with_name(f"{file.name}.partial")
    try:
        partial.write_bytes(content)
    except FileNotFoundError:
        file.parent.mkdir(parents=True, exist_ok=True)
        partial.write_bytes(content)
    partial.replace(file)
