"""Tables of all channels of a log, one row per record and vehicle: CSV and Parquet."""

import io
from typing import Any

import numpy as np

from cardume.errors import InputError
from cardume.missions.exports.tracks import degrees_of
from cardume.missions.geodesy import GeoPoint
from cardume.missions.log import VARIABLES
from cardume.simulation.flight import CHANNELS, Flight

PLACES = ("latitude_deg", "longitude_deg")


def columns_of(flight: Flight, origin: GeoPoint | None) -> dict[str, Any]:
    """The columns of the table, in order, records of all vehicles at a time together.

    Args:
        flight: what was flown.
        origin: where its north = east = 0 lies; None: no latitude and longitude.

    Returns:
        Names to (records times vehicles,) arrays; `vehicle` to a list of names.
    """
    size = len(flight.vehicle_names)
    columns: dict[str, Any] = {
        "time": np.repeat(flight.times, size),
        "vehicle": list(flight.vehicle_names) * len(flight.times),
    }
    if origin is not None:
        north, east = (flight.channels[name].ravel() for name in ("north", "east"))
        columns |= dict(zip(PLACES, degrees_of(north, east, origin), strict=True))
    return columns | {name: flight.channels[name].ravel() for name in CHANNELS}


def csv_of(flight: Flight, origin: GeoPoint | None = None) -> bytes:
    """CSV with a line of names, numbers to the last bit, nothing where there is no number.

    Args:
        flight: what was flown.
        origin: where its north = east = 0 lies; None: no latitude and longitude.
    """
    import csv

    columns = columns_of(flight, origin)
    texts = [_texts(values) for values in columns.values()]
    out = io.StringIO(newline="")
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(zip(*texts, strict=True))
    return out.getvalue().encode("utf-8")


def _texts(values: Any) -> list[str]:
    return (
        values if isinstance(values, list) else ["" if x != x else repr(x) for x in np.asarray(values, float).tolist()]
    )


def parquet_of(flight: Flight, origin: GeoPoint | None = None) -> bytes:
    """Parquet, each column with its unit and meaning as metadata.

    Args:
        flight: what was flown.
        origin: where its north = east = 0 lies; None: no latitude and longitude.

    Raises:
        InputError: pyarrow is not installed.
    """
    try:
        import pyarrow
        from pyarrow import parquet
    except ModuleNotFoundError:
        raise InputError("Parquet needs pyarrow: pip install 'cardume[parquet]'") from None
    columns = columns_of(flight, origin)
    arrays = [pyarrow.array(values) for values in columns.values()]
    fields = [
        pyarrow.field(name, array.type, metadata=_about(name)) for name, array in zip(columns, arrays, strict=True)
    ]
    out = io.BytesIO()
    parquet.write_table(pyarrow.Table.from_arrays(arrays, schema=pyarrow.schema(fields)), out)
    return out.getvalue()


def _about(name: str) -> dict[str, str]:
    if name in PLACES:
        return {"units": "deg", "long_name": f"true {name.removesuffix('_deg')}, WGS 84"}
    return {"units": VARIABLES[name].units, "long_name": VARIABLES[name].long_name}
