"""Eight missions side by side in the lanes of the same tables."""

from collections.abc import Hashable, Sequence
from typing import Any

import numpy as np

from cardume.compiler import WIDTH
from cardume.simulation.fleet import Tables

SMALL = 64  # numbers, up to which a table that all lanes share is compared by what is in it


def join(tables: Sequence[Tables], into: Tables | None = None) -> Tables:
    """Put up to eight missions of the same shape side by side; missing ones repeat the last.

    Args:
        tables: of missions with the same laws and sizes, made for lanes.
        into: what was joined before, whose arrays are written again where they fit.

    Returns:
        Tables of (n, 8) arrays; whole numbers and the gridded current are the first mission's.

    Raises:
        ValueError: missions that differ in what all lanes share, or in the size of a table.
    """
    full = [*tables, *[tables[-1]] * (WIDTH - len(tables))]
    noisy = max(t.whole.has_weather for t in full)  # a drawn variation of zero does not keep missions apart
    full = [t._replace(whole=t.whole._replace(has_weather=noisy)) for t in full]
    joined = []
    for name in Tables._fields:
        parts = [getattr(t, name) for t in full]
        is_shared = _is_shared(name, parts[0])
        if not all(_fit(part, parts[0], is_shared) for part in parts):
            raise ValueError(f"missions in lanes must have the same laws, sizes and graph; these differ in '{name}'")
        if not is_shared:
            joined.append(_spread(parts, None if into is None else getattr(into, name)))
        else:  # the engine counts messages in whole numbers, and only reads grids
            is_counted = isinstance(parts[0], np.ndarray) and parts[0].dtype == np.int64
            joined.append(parts[0].copy() if is_counted else parts[0])
    return Tables._make(joined)


def _is_shared(name: str, part: Any) -> bool:
    return name in ("field", "seabed", "clocks") or not isinstance(part, np.ndarray) or part.dtype == np.int64


def _fit(part: Any, first: Any, is_shared: bool) -> bool:
    """Whether a mission's part can stand beside the first one's: equal, or of its shape."""
    if part is first:
        return True
    return np.array_equal(part, first, equal_nan=True) if is_shared else bool(part.shape == first.shape)


def _spread(parts: Sequence[np.ndarray], room: np.ndarray | None) -> np.ndarray:
    """(n,) arrays as the columns of one; those that are one array are written once."""
    shape = parts[0].shape[0], WIDTH
    made = np.empty(shape) if room is None or room.shape != shape else room
    if all(part is parts[0] for part in parts):
        made[:] = parts[0][:, None]
    else:
        np.stack(parts, axis=-1, out=made)
    return made


def lane(tables: Tables, which: int) -> Tables:
    """One mission out of eight."""
    parts = [getattr(tables, name) for name in Tables._fields]
    return Tables._make(np.ascontiguousarray(p[:, which]) if np.ndim(p) == 2 else p for p in parts)


def own(tables: Tables) -> Tables:
    """The same tables in arrays of their own, to be flown alone.

    Args:
        tables: of (n,) arrays that others share.
    """
    return Tables._make(part.copy() if isinstance(part, np.ndarray) else part for part in tables)


def shape_of(tables: Tables) -> Hashable:
    """What missions must have in common to share their lanes, equal for those that do while they are in memory.

    Args:
        tables: of one mission, made for lanes.
    """
    alike = tables._replace(whole=tables.whole._replace(has_weather=0))
    return tuple(_common(name, part) for name, part in zip(Tables._fields, alike, strict=True))


def _common(name: str, part: Any) -> Hashable:
    if not _is_shared(name, part):
        return int(part.size)
    if not isinstance(part, np.ndarray):
        return part if isinstance(part, tuple) else float(part)
    is_small = part.dtype == np.int64 or part.size <= SMALL
    return part.tobytes() if is_small else id(part)
