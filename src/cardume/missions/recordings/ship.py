"""A ship and what its USBL hears, from the sentences of a log to vehicles."""

import math
from typing import NamedTuple

import numpy as np

from cardume.errors import InputError
from cardume.missions.geodesy import GeoPoint, GridPoint, geographic_to_utm, to_local, utm_to_geographic
from cardume.missions.recordings.base import (
    LeftOut,
    Options,
    Recorded,
    Recording,
    Sighted,
    Stream,
    nearest_of,
    stream_of,
)
from cardume.missions.recordings.psimssb import CARTESIAN, HEAD_UP, RADIANS, Relative

DEGREE = math.pi / 180.0
DAY = 86_400.0  # [s]
SHIP = "ship"
LATE = 0.5  # [s] between a GST and the position that it is about, at most
STALE = 5.0  # [s] between a PSIMSSB and the ship's own position and heading, at most
STEERING = 0.1  # [m/s] from which a course over ground says anything of a heading


class Place(NamedTuple):
    """Where the ship was."""

    time: float  # [s] of the day, counted on over midnight
    heard: float  # [s]
    latitude: float  # [rad]
    longitude: float  # [rad]
    sigma_north: float  # [m]
    sigma_east: float  # [m]
    is_gga: bool


class ShipLog:
    """What a log says, in the order of its lines.

    Attributes:
        places: of the ship.
        sigmas: time [s], sigma of latitude and of longitude [m].
        headings: time [s] and heading [rad].
        courses: time [s], course [rad] and speed [m/s] over ground.
        speeds: time [s] and speed through the water [m/s].
        relatives: of transponders, with the time [s] at which each was heard.
        left_out: lines that could not be used.
        date: of the first RMC.
    """

    def __init__(self) -> None:
        self.places: list[Place] = []
        self.sigmas: list[tuple[float, float, float]] = []
        self.headings: list[tuple[float, ...]] = []
        self.courses: list[tuple[float, float, float]] = []
        self.speeds: list[tuple[float, ...]] = []
        self.relatives: list[tuple[float, Relative]] = []
        self.left_out = LeftOut()
        self.date = ""


def recording_of(log: ShipLog, options: Options, notes: list[str]) -> Recording:
    """The ship and its transponders as vehicles; what a person must know of them is added to the notes.

    Args:
        log: of the sentences.
        options: the head's place stands in where the ship's own is not recorded.
        notes: of how the log was read.
    """
    places = _places(log)
    zero = min([p.time for p in places] + [r.time for _, r in log.relatives] + [row[0] for row in log.headings])
    origin = GeoPoint(places[0].latitude, places[0].longitude) if places else None
    vehicles = [_ship(log, places, origin, zero)] if origin else []
    if vehicles and not log.speeds and log.courses:
        notes.append(
            "no speed through the water (VHW): speed and course over ground (RMC) stand in for it, so the current that"
            " is found is an error of these"
        )
    vehicles += _targets(log, vehicles[0] if vehicles else None, origin, zero, options, notes)
    began = f"{log.date} {_clock(zero)} UTC".strip()
    return Recording(kind="nmea", vehicles=tuple(vehicles), origin=origin, began=began, notes=tuple(notes))


def _clock(seconds: float) -> str:
    seconds %= DAY
    return f"{int(seconds // 3600):02d}:{int(seconds // 60) % 60:02d}:{seconds % 60:06.3f}"


def _places(log: ShipLog) -> list[Place]:
    """The ship's positions: GGA where there is any, with the errors that GST tells, else RMC."""
    places = sorted([p for p in log.places if p.is_gga] or log.places)
    if not places or not log.sigmas:
        return places
    sigmas = np.array(sorted(log.sigmas))
    nearest = nearest_of(sigmas[:, 0], np.array([place.time for place in places]))
    return [
        place._replace(sigma_north=max(sigmas[k, 1], 1e-3), sigma_east=max(sigmas[k, 2], 1e-3))
        if abs(sigmas[k, 0] - place.time) <= LATE
        else place
        for place, k in zip(places, nearest, strict=True)
    ]


def _ship(log: ShipLog, places: list[Place], origin: GeoPoint, zero: float) -> Recorded:
    sighted = []
    for p in places:
        north, east = to_local(p.latitude, p.longitude, origin)
        heard, valid = max(p.heard, p.time) - zero, p.time - zero
        sighted.append(Sighted(heard, valid, "GNSS", float(north), float(east), p.sigma_north**2, 0.0, p.sigma_east**2))
    headings = log.headings or [(time, course) for time, course, speed in log.courses if speed > STEERING]
    attitude = stream_of([(time - zero, heading, math.nan) for time, heading in headings], 2)
    return Recorded(
        name=SHIP, attitude=attitude, velocity=_velocity(log, attitude, zero), sighted=tuple(sorted(sighted))
    )


def _velocity(log: ShipLog, attitude: Stream, zero: float) -> Stream:
    """Through the water where that was measured, else that over ground, in the axes of the ship."""
    if log.speeds:
        return stream_of([(time - zero, speed, 0.0) for time, speed in log.speeds], 2)
    rows = []
    for time, course, speed in log.courses:
        heading = attitude.held(np.array([time - zero]))[0, 0] if attitude.is_there else course
        rows.append((time - zero, speed * math.cos(course - heading), speed * math.sin(course - heading)))
    return stream_of(rows, 2)


def _targets(
    log: ShipLog, ship: Recorded | None, origin: GeoPoint | None, zero: float, options: Options, notes: list[str]
) -> list[Recorded]:
    """The transponders, each a vehicle of which nothing but fixes and depth is known."""
    found: dict[str, list[Sighted]] = {}
    depths: dict[str, list[tuple[float, ...]]] = {}
    refused: dict[str, int] = {}
    deck = Deck(ship, origin, options)
    for heard, relative in log.relatives:
        valid = relative.time - zero
        place = deck.place_of(relative, valid)
        if isinstance(place, str):
            refused[place] = refused.get(place, 0) + 1
            continue
        variance = relative.accuracy**2 + place[2]
        found.setdefault(relative.name, []).append(
            Sighted(max(heard - zero, valid), valid, "USBL", place[0], place[1], variance, 0.0 * variance, variance)
        )
        if math.isfinite(relative.depth):
            depths.setdefault(relative.name, []).append((valid, relative.depth))
    notes += [f"{count} PSIMSSB could not be used: {why}" for why, count in refused.items()]
    if found:
        notes.append(
            "of a transponder neither heading nor speed is known: a filter takes all of its motion for a current; give"
            " it a current_noise of 1e-3 m^2/s^3 or so"
        )
    return [
        Recorded(name=name, sighted=tuple(sorted(sighted)), depth=stream_of(depths.get(name, []), 1))
        for name, sighted in sorted(found.items())
    ]


class Deck:
    """The ship at any time, from which its USBL looks.

    Args:
        ship: as it was recorded; None: nothing is known of it.
        origin: of the local axes.
        options: where the head lies if there is no ship.
    """

    def __init__(self, ship: Recorded | None, origin: GeoPoint | None, options: Options) -> None:
        self.origin, self.head = origin, options.head
        self.attitude = ship.attitude if ship else Stream()
        own = (
            sorted((s.valid, s.north, s.east, 0.5 * (s.north_variance + s.east_variance)) for s in ship.sighted)
            if ship
            else []
        )
        self.track = stream_of(own, 3)

    def place_of(self, relative: Relative, valid: float) -> tuple[float, float, float] | str:
        """North and east [m] of a transponder and the variance [m^2] that the ship's own place adds; or why not.

        Args:
            relative: as the ship's USBL sees it.
            valid: [s] when.
        """
        if relative.coordinates == RADIANS:
            if self.origin is None:
                return "it is in latitude and longitude, and there is no position of the ship to begin the axes at"
            north, east = to_local(relative.first, relative.second, self.origin)
            return float(north), float(east), 0.0
        if relative.coordinates != CARTESIAN:
            return _of_grid(relative, self.origin)
        heading = 0.0
        if relative.orientation == HEAD_UP:
            if not self.attitude.is_there:
                return "it is head up (H), and there is no heading (HDT)"
            if _is_stale(self.attitude, valid):
                return f"the ship's heading is more than {STALE:g} s away"
            heading = float(self.attitude.held(np.array([valid]))[0, 0])
        north, east = relative.turned(heading)
        if not self.track.is_there:
            return self.head[0] + north, self.head[1] + east, 0.0
        if _is_stale(self.track, valid):
            return f"the ship's position is more than {STALE:g} s away"
        own = [float(np.interp(valid, self.track.times, column)) for column in self.track.values.T]
        return own[0] + north, own[1] + east, own[2]


def _is_stale(stream: Stream, time: float) -> bool:
    """Whether no reading is near a time."""
    near = nearest_of(stream.times, np.array([time]))[0]
    return bool(abs(stream.times[near] - time) > STALE)


def _of_grid(relative: Relative, origin: GeoPoint | None) -> tuple[float, float, float] | str:
    """Of UTM coordinates, whose zone is that of the ship."""
    if origin is None:
        return "it is in UTM, whose zone only a position of the ship (GGA) tells"
    zone = geographic_to_utm(origin)
    northing, easting = relative.north_east
    try:
        place = utm_to_geographic(GridPoint(easting, northing, zone.zone, zone.band))
    except InputError:
        return f"its UTM coordinates lie outside the ship's zone {zone.zone}{zone.band}"
    north, east = to_local(place.latitude, place.longitude, origin)
    return float(north), float(east), 0.0
