"""From a log to a file for another program: which formats there are, and what each cannot keep."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from cardume.errors import InputError, MissionError
from cardume.missions.converting import Conversion, Request
from cardume.missions.exports.geojson import geojson_of
from cardume.missions.exports.gpx import gpx_of
from cardume.missions.exports.kml import kml_of
from cardume.missions.exports.rerun import rrd_of
from cardume.missions.exports.ros import mcap_of
from cardume.missions.exports.tables import csv_of, parquet_of
from cardume.missions.exports.tracks import Track, tracks_of
from cardume.missions.geodesy import GeoPoint
from cardume.missions.log import Log, read_log
from cardume.missions.source import parse_yaml
from cardume.missions.wording import unknown
from cardume.simulation.flight import Flight
from cardume.units import parse_quantity, printable

TRACKS: dict[str, Callable[[list[Track], str], bytes]] = {"gpx": gpx_of, "geojson": geojson_of, "kml": kml_of}
TABLES: dict[str, Callable[[Flight, GeoPoint | None], bytes]] = {"csv": csv_of, "parquet": parquet_of}
DATED = ("gpx", "kml")


def convert_log(request: Request) -> Conversion:
    """Convert a log.

    Args:
        request: what, and into what.

    Raises:
        InputError: no such log or vehicle, no origin where one is needed, or a library that is not installed.
    """
    source = Path(request.source)
    log = read_log(source / "log.nc" if source.is_dir() else source)
    flight = _of_vehicle(log.flight, request.vehicle)
    origin, kind = request.origin or origin_of(log), request.target_kind
    records = f"{len(flight.times)} records of {len(flight.vehicle_names)} vehicle"
    records += "s" if len(flight.vehicle_names) != 1 else ""
    if kind in TRACKS:
        if origin is None:
            raise InputError(
                f"{printable(request.source)}: its mission has no origin, and tracks need places on the Earth; say"
                " where north = east = 0 lies with --origin LATITUDE,LONGITUDE in degrees"
            )
        tracks = tracks_of(flight, origin)
        lost = ["everything but places and times: cardume convert LOG OUT.csv keeps all channels"]
        lost += ["the date, for a mission has none: times begin in 1970"] if kind in DATED else []
        content, holds = (
            TRACKS[kind](tracks, flight.mission_name),
            f"{len(tracks)} tracks, true and believed; {records}",
        )
    elif kind in TABLES:
        content, holds = TABLES[kind](flight, origin), f"a table of all channels, SI; {records}"
        lost = ["messages, paths, and what vehicles predict of one another"]
    elif kind == "rrd":
        content, holds = (
            rrd_of(flight),
            f"Rerun: tracks, paths, currents, channels, messages; {records}",
        )
        lost = ["what vehicles predict of one another", "the last digits of places in its view: channels keep them"]
    else:
        content, holds = mcap_of(flight), f"ROS 2 poses, paths, transforms, markers, diagnostics; {records}"
        lost = ["what vehicles predict of one another"]
    return Conversion(content=content, holds=holds, lost=tuple(lost), is_flyable=False)


def origin_of(log: Log) -> GeoPoint | None:
    """Where the mission in a log says that north = east = 0 lies; None where it does not say.

    Args:
        log: read back.
    """
    try:
        section = parse_yaml(log.mission, "the log").value["origin"].value
        return GeoPoint(*(parse_quantity(section[name].value, "rad") for name in ("latitude", "longitude")))
    except (MissionError, LookupError, TypeError, AttributeError):
        return None


def _of_vehicle(flight: Flight, vehicle: str) -> Flight:
    """One vehicle's part of a flight; all of it where none is named."""
    if not vehicle:
        return flight
    if vehicle not in flight.vehicle_names:
        wrong = unknown("no such vehicle", vehicle, list(flight.vehicle_names))
        raise InputError(f"--vehicle {printable(vehicle)}: {wrong}")
    k = flight.vehicle_names.index(vehicle)
    return replace(
        flight,
        vehicle_names=(vehicle,),
        channels={name: values[:, k : k + 1] for name, values in flight.channels.items()},
        neighbor_state_estimate=flight.neighbor_state_estimate[:, k : k + 1, k : k + 1],
        messages={name: values[:0] for name, values in flight.messages.items()},
        own_paths=(flight.own_paths[k],),
    )
