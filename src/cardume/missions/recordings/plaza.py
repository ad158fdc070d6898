"""The Plaza records of ranges, as in the package `gtsam`: a mower with odometer and gyroscope hears radio beacons.

Tables of a MATLAB file: DR (time, way, turn), TD (time, antenna, beacon, range), TL (beacon, x, y), GT (time, x, y,
theta) and, in some, DRp, the poses of dead reckoning; x is east, y north, theta counter-clockwise from x. Ranges are
level, and some 7 % too long.
Headings of Plaza 2's GT are turned by half a turn against the way made; DRp begins with the right one.

Source: Djugash, Hamner & Roth (2009), "Navigating with ranging radios".
"""

import math
from pathlib import Path
from typing import Any

import numpy as np

from cardume.errors import DataError, InputError
from cardume.missions.recordings.base import Options, Recorded, Recording, Sighted, Stream, Way
from cardume.units import printable

WIDTHS = {"DR": 3, "TD": 4, "TL": 3, "GT": 4}
NAME = "mower"


def read(path: Path, options: Options) -> Recording:
    """A Plaza record.

    Args:
        path: of a .mat file.
        options: not used.

    Raises:
        DataError: damaged, or without these tables.
        InputError: the library that reads it is not installed.
    """
    del options
    tables = _tables(path)
    odometry, ranges, truth = tables["DR"], tables["TD"], tables["GT"]
    beacons = {int(row[0]): (float(row[2]), float(row[1])) for row in tables["TL"]}
    zero = float(truth[0, 0])
    first = tables["DRp"][0, 3] if "DRp" in tables else truth[0, 3]
    times = odometry[:, 0] - zero
    notes = []
    known = [row for row in ranges if int(row[2]) in beacons]
    if len(known) < len(ranges):
        notes.append(f"{len(ranges) - len(known)} ranges are from beacons that stand in no table TL; they are left out")
    sighted = tuple(
        Sighted(
            float(row[0]) - zero,
            float(row[0]) - zero,
            f"beacon-{int(row[2])}",
            *beacons[int(row[2])],
            range=float(row[3]),
        )
        for row in known
    )
    attitude, velocity = _reckoned(odometry, truth[0, 0], math.pi / 2.0 - float(first))
    mower = Recorded(
        name=NAME,
        attitude=attitude,
        velocity=velocity,
        sighted=sighted,
        truth=Stream(*_increasing(truth[:, 0] - zero, truth[:, [2, 1]])),
        start=(float(truth[0, 2]), float(truth[0, 1])),
        start_heading=math.pi / 2.0 - float(first),
        ways=tuple(Way(float(t), float(row[1]), -float(row[2])) for t, row in zip(times, odometry, strict=True)),
    )
    return Recording(kind="plaza", vehicles=(mower,), notes=tuple(notes))


def _tables(path: Path) -> dict[str, np.ndarray]:
    name = printable(str(path))
    try:
        from scipy.io import loadmat
    except ImportError:
        raise InputError("a .mat file is read by scipy; install it with: pip install 'cardume[study]'") from None
    try:
        found: dict[str, Any] = loadmat(path)
    except OSError as problem:
        raise DataError(f"{name} cannot be read: {problem.strerror or problem}; give a .mat file") from None
    except Exception as problem:  # the library tells a damaged file in many ways
        raise DataError(f"{name} is damaged, or no MATLAB file ({printable(str(problem))[:80]})") from None
    tables = {key: np.asarray(value) for key, value in found.items() if not key.startswith("__")}
    for key, width in WIDTHS.items():
        table = tables.get(key)
        if (
            table is None
            or table.ndim != 2
            or table.shape[1] != width
            or not len(table)
            or table.dtype.kind not in "fiu"
        ):
            raise DataError(f"{name} has no table {key} of numbers with {width} columns; it is no Plaza record")
        tables[key] = table.astype(float)
        if not np.isfinite(tables[key]).all():
            raise DataError(f"{name}:{key}: holds numbers that are none, at row {_first_bad(tables[key])}")
    if np.any(np.diff(tables["DR"][:, 0]) <= 0.0):
        raise DataError(
            f"{name}:DR: times must increase, and do not at row {int(np.argmin(np.diff(tables['DR'][:, 0]))) + 2}"
        )
    return tables


def _first_bad(table: np.ndarray) -> int:
    return int(np.flatnonzero(~np.isfinite(table).all(axis=1))[0]) + 1


def _increasing(times: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    order = np.argsort(times, kind="stable")
    keep = np.append(np.diff(times[order]) > 0.0, True)
    return times[order][keep], values[order][keep]


def _reckoned(odometry: np.ndarray, began: float, heading: float) -> tuple[Stream, Stream]:
    """Heading and speed of each step, from its beginning on."""
    starts = np.append(began, odometry[:-1, 0])
    lasts = np.maximum(odometry[:, 0] - starts, 1e-3)
    turned = -odometry[:, 2]
    headings = heading + np.append(0.0, np.cumsum(turned)[:-1])
    attitude = Stream(*_increasing(starts - began, np.column_stack([headings, turned / lasts])))
    speeds = Stream(*_increasing(starts - began, np.column_stack([odometry[:, 1] / lasts, np.zeros(len(starts))])))
    return attitude, speeds
