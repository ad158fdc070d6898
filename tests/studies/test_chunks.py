"""Chunks are written by us and read by zarr; zarr itself writes the same bytes."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zarr

from cardume.studies.chunks import codecs, encoded

NUMBERS = np.random.default_rng(1).standard_normal((5, 7))


@pytest.mark.parametrize(
    ("values", "kind", "fill"),
    [
        (NUMBERS, "float64", np.nan),
        (np.full((5, 7), np.nan), "float64", np.nan),
        (NUMBERS > 0.0, "bool", False),
        ((9 * NUMBERS).astype(np.int8), "int8", 0),
        (np.array([["", "failed at 3 s", "größer\n"] * 2 + ["魚群"]] * 5, object), "str", ""),
    ],
)
@pytest.mark.parametrize("chunk", [(5, 7), (3, 4), (8, 16)])
def test_bytes_are_those_of_zarr(tmp_path: Path, values: np.ndarray, kind: str, fill: Any, chunk: Any) -> None:
    array = zarr.create_array(
        tmp_path / "it",
        shape=values.shape,
        chunks=chunk,
        dtype=str if kind == "str" else kind,
        fill_value=fill,
        compressors=codecs(),
        config={"write_empty_chunks": True},
    )
    array[:] = values
    for i in range(array.cdata_shape[0]):
        for j in range(array.cdata_shape[1]):
            block = values[i * chunk[0] : (i + 1) * chunk[0], j * chunk[1] : (j + 1) * chunk[1]]
            assert encoded(block, chunk, fill) == (tmp_path / "it" / "c" / str(i) / str(j)).read_bytes()
