"""A recording as CSV: one line of names, then a row for each moment; what was not measured then is left empty.

time [s] is needed, all else is free: see COLUMNS. `vehicle` makes several vehicles of one file.
"""

import csv
import math
from collections.abc import Sequence
from pathlib import Path

from cardume.errors import DataError
from cardume.missions.geodesy import GeoPoint, to_local
from cardume.missions.recordings.base import Options, Recorded, Recording, Sighted, read_lines, stream_of
from cardume.units import nearest, printable

DEGREE = math.pi / 180.0
COLUMNS = {
    "time": "s, when the row was heard",
    "vehicle": "whose row it is",
    "heading_deg": "deg, clockwise from true north",
    "yaw_rate": "rad/s, positive to starboard",
    "surge": "m/s, through the water, forward",
    "sway": "m/s, through the water, to starboard",
    "depth": "m, below the surface",
    "fix_time": "s, when the fix or range was true, if earlier",
    "fix_source": "who or what measured it",
    "fix_north": "m, measured position",
    "fix_east": "m",
    "fix_latitude_deg": "deg, instead of north and east",
    "fix_longitude_deg": "deg",
    "fix_sigma": "m, standard deviation per axis",
    "fix_north_variance": "m^2, instead of it",
    "fix_covariance": "m^2, of north with east",
    "fix_east_variance": "m^2",
    "range": "m, slant where depths are known, from the source",
    "range_sigma": "m",
    "source_north": "m, where the source of a range was",
    "source_east": "m",
    "source_depth": "m; empty: the range is level",
    "truth_north": "m, true position",
    "truth_east": "m",
}
WANTED = "the columns are " + ", ".join(COLUMNS)
WORDS = ("vehicle", "fix_source")
MOST_ROWS = 5_000_000
Row = dict[str, float]


def read(path: Path, options: Options) -> Recording:
    """A table.

    Args:
        path: of the file.
        options: sigma of fixes that do not tell their own.

    Raises:
        DataError: no table, an unknown column, or something that is no number, with file, line and column.
    """
    name, lines = printable(str(path)), read_lines(path)
    rows = csv.reader(lines)
    try:
        header = [word.strip().lower().removeprefix("\ufeff") for word in next(rows)]
        _check_header(header, name)
        found = [(rows.line_num, row) for row in rows if any(word.strip() for word in row)]
    except csv.Error as problem:
        raise DataError(f"{name} is no CSV ({printable(str(problem))}); {WANTED}") from None
    if not found or len(found) > MOST_ROWS:
        raise DataError(f"{name}: has {len(found):,} rows; at least 1 and at most {MOST_ROWS:,} can be replayed")
    notes = []
    if len(found[-1][1]) < len(header) and len(found) > 1:
        notes.append(f"the last row, line {found[-1][0]}, is cut off; what stands before it was read")
        found.pop()
    vehicles: dict[str, list[tuple[int, dict[str, str]]]] = {}
    for line, row in found:
        if len(row) != len(header):
            raise DataError(f"{name}:{line}: has {len(row)} values, the header {len(header)} columns")
        words = dict(zip(header, (word.strip() for word in row), strict=True))
        vehicles.setdefault(words.get("vehicle") or "vehicle", []).append((line, words))
    origin, zero = _origin(vehicles, name), _first_time(vehicles, name)
    return Recording(
        kind="csv",
        vehicles=tuple(_vehicle(who, rows_of, name, zero, origin, options) for who, rows_of in vehicles.items()),
        origin=origin,
        began=f"at {zero:.3f} s" if zero else "",
        notes=tuple(notes),
    )


def _check_header(header: Sequence[str], name: str) -> None:
    for word in header:
        if word not in COLUMNS:
            raise DataError(
                f"{name}:1: there is no column '{printable(word)}'{nearest(word, list(COLUMNS)) or '.'} {WANTED}"
            )
    if len(set(header)) < len(header):
        raise DataError(f"{name}:1: a column is there twice; {WANTED}")
    if "time" not in header:
        raise DataError(f"{name}:1: has no column time; {WANTED}")


def _number(words: dict[str, str], key: str, place: str) -> float:
    text = words.get(key, "")
    if not text:
        return math.nan
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise DataError(f"{place}:{key}: '{printable(text)[:40]}' is no number; leave empty what is not known")
    return value


def _origin(vehicles: dict[str, list[tuple[int, dict[str, str]]]], name: str) -> GeoPoint | None:
    """The first latitude and longitude of the table."""
    rows = sorted((row for found in vehicles.values() for row in found), key=lambda row: row[0])
    for line, words in rows:
        latitude, longitude = (_number(words, f"fix_{key}_deg", f"{name}:{line}") for key in ("latitude", "longitude"))
        if math.isfinite(latitude) and math.isfinite(longitude):
            return GeoPoint(latitude * DEGREE, longitude * DEGREE)
    return None


def _first_time(vehicles: dict[str, list[tuple[int, dict[str, str]]]], name: str) -> float:
    """[s] the earliest time of the table, which becomes 0."""
    return min(_number(words, "time", f"{name}:{line}") for rows in vehicles.values() for line, words in rows)


def _vehicle(
    who: str,
    rows: Sequence[tuple[int, dict[str, str]]],
    name: str,
    zero: float,
    origin: GeoPoint | None,
    options: Options,
) -> Recorded:
    streams: dict[str, list[tuple[float, ...]]] = {key: [] for key in ("attitude", "velocity", "depth", "truth")}
    sighted: list[Sighted] = []
    before = -math.inf
    for line, words in rows:
        place = f"{name}:{line}"
        row = {key: _number(words, key, place) for key in words if key not in WORDS}
        time = row["time"] - zero
        if math.isnan(time):
            raise DataError(f"{place}:time: is empty; every row needs a time [s]")
        if time < before:
            raise DataError(
                f"{place}:time: is {row['time']:g} s, earlier than the row before; sort the rows of a vehicle"
            )
        before = time

        def has(*keys: str, row: Row = row) -> bool:
            return all(math.isfinite(row.get(key, math.nan)) for key in keys)

        if has("heading_deg"):
            streams["attitude"].append((time, row["heading_deg"] * DEGREE, row.get("yaw_rate", math.nan)))
        if has("surge"):
            streams["velocity"].append((time, row["surge"], row["sway"] if has("sway") else 0.0))
        if has("depth"):
            streams["depth"].append((time, row["depth"]))
        if has("truth_north", "truth_east"):
            streams["truth"].append((time, row["truth_north"], row["truth_east"]))
        sighted += _sighted(row, words.get("fix_source") or "fixes", time, zero, origin, options, place)
    return Recorded(
        name=who,
        attitude=stream_of(streams["attitude"], 2),
        velocity=stream_of(streams["velocity"], 2),
        depth=stream_of(streams["depth"], 1),
        truth=stream_of(streams["truth"], 2),
        sighted=tuple(sighted),
    )


def _sighted(
    row: Row, source: str, time: float, zero: float, origin: GeoPoint | None, options: Options, place: str
) -> list[Sighted]:
    """The fix and the range of a row."""

    def value(key: str) -> float:
        return row.get(key, math.nan)

    valid = value("fix_time") - zero if math.isfinite(value("fix_time")) else time
    if valid > time + 1e-6:
        raise DataError(
            f"{place}:fix_time: is {valid - time:g} s after the row's time; a fix is true before it is heard"
        )
    found = []
    north, east = value("fix_north"), value("fix_east")
    if origin is not None and math.isfinite(value("fix_latitude_deg")):
        local = to_local(value("fix_latitude_deg") * DEGREE, value("fix_longitude_deg") * DEGREE, origin)
        north, east = float(local[0]), float(local[1])
    if math.isfinite(north) and math.isfinite(east):
        sigma = value("fix_sigma") if math.isfinite(value("fix_sigma")) else options.fix_sigma
        nn, ne, ee = value("fix_north_variance"), value("fix_covariance"), value("fix_east_variance")
        if not math.isfinite(nn + ee):
            nn, ne, ee = sigma**2, 0.0 * sigma, sigma**2
        found.append(Sighted(time, valid, source, north, east, nn, 0.0 if math.isnan(ne) and nn == nn else ne, ee))
    if math.isfinite(value("range")):
        if not math.isfinite(value("source_north") + value("source_east")):
            raise DataError(f"{place}:range: needs source_north and source_east, where it was measured from")
        found.append(
            Sighted(
                time,
                valid,
                source if source != "fixes" else f"{value('source_north'):g},{value('source_east'):g}",
                value("source_north"),
                value("source_east"),
                0.0,
                0.0,
                0.0,
                value("range"),
                value("source_depth"),
                value("range_sigma") ** 2,
            )
        )
    return found
