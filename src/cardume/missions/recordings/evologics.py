"""Transcripts of an EvoLogics S2C modem with USBL: USBLLONG and USBLANGLES, wherever they stand in a line.

USBLLONG,t,t_measurement,remote,X,Y,Z,E,N,U,roll,pitch,yaw,propagation_us,rssi,integrity,accuracy
USBLANGLES,t,t_measurement,remote,lbearing,lelevation,bearing,elevation,roll,pitch,yaw,rssi,integrity,accuracy

Every remote is a vehicle, of which nothing but fixes is known; places are from the head. A measurement is told 0.2 to
0.5 s late: t is when it was told, t_measurement when it was true. An integrity of 100 or less means that the direction
failed: what is left is the slant range by the time of travel. Of a bearing without a range a position is made where the
depth of the remote is known.

Source: the fields as in two open parsers, DUNE's Evologics driver and DESERT's uwevologicss2cmodem.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from cardume.errors import DataError
from cardume.maths.angles import wrap_angle
from cardume.missions.recordings.base import (
    LeftOut,
    Options,
    Recorded,
    Recording,
    Sighted,
    nearest_of,
    read_lines,
    stream_of,
)
from cardume.units import printable

SOUND = 100.0  # [-] integrity above which a direction can be trusted
LATEST = 60.0  # [s] between a measurement and its being told
LEAST_ELEVATION = 0.1  # [rad] below it no position is made of a bearing and a depth
FAR_APART = 0.5  # [rad] mean difference of bearings and of directions to positions that means other axes
FIELDS = {"USBLLONG": 16, "USBLANGLES": 13}


class Bearing(NamedTuple):
    """One USBLANGLES."""

    heard: float  # [s]
    valid: float  # [s]
    bearing: float  # [rad] clockwise from north
    elevation: float  # [rad]
    sigma: float  # [rad]


class Remote:
    """What a transcript says of one remote.

    Attributes:
        sighted: positions and ranges.
        depths: time [s] and depth [m] below the head.
        bearings: directions without a range.
    """

    def __init__(self) -> None:
        self.sighted: list[Sighted] = []
        self.depths: list[tuple[float, ...]] = []
        self.bearings: list[Bearing] = []


def read(path: Path, options: Options) -> Recording:
    """A transcript.

    Args:
        path: of the file.
        options: sound speed, where the head is, and the depth of the remotes below it.

    Raises:
        DataError: there is no USBLLONG or USBLANGLES that can be used.
    """
    remotes: dict[str, Remote] = {}
    left_out = LeftOut()
    for number, line in enumerate(read_lines(path), start=1):
        for kind in FIELDS:
            start = line.find(kind + ",")
            if start >= 0:
                try:
                    _take(remotes, kind, line[start:], options)
                except ValueError as problem:
                    left_out.note(number, str(problem))
    notes = left_out.texts()
    vehicles = [_vehicle(name, remote, options, notes) for name, remote in sorted(remotes.items())]
    found = [vehicle for vehicle in vehicles if vehicle.sighted]
    if not found:
        why = f" ({'; '.join(notes[:3])})" if notes else ""
        raise DataError(f"{printable(str(path))} has no USBLLONG or USBLANGLES that can be used{why}")
    notes.append(
        f"places are from the head, which is taken to lie at north {options.head[0]:g} m, east {options.head[1]:g} m"
    )
    zero = min(s.valid for v in found for s in v.sighted)
    return Recording(kind="evologics", vehicles=tuple(_from(zero, v) for v in found), notes=tuple(notes))


def _take(remotes: dict[str, Remote], kind: str, text: str, options: Options) -> None:
    words = text.strip().split(",")[1:]
    if len(words) != FIELDS[kind]:
        raise ValueError(f"{kind} has {len(words)} values; {FIELDS[kind]} are expected, so it may be cut off")
    try:
        values = [float(word) for word in words]
    except ValueError:
        values = [math.nan]
    if not all(math.isfinite(value) for value in values):
        raise ValueError(f"{kind} holds something that is no number")
    heard, valid = values[0], values[1]
    if not 0.0 <= heard - valid <= LATEST:
        raise ValueError(
            f"{kind} was told {heard - valid:g} s after its measurement; between 0 and {LATEST:g} s make sense"
        )
    remote = remotes.setdefault(f"remote-{int(values[2])}", Remote())
    if kind == "USBLLONG":
        _long(remote, values, options)
    elif values[11] > SOUND:
        remote.bearings.append(Bearing(heard, valid, values[5], values[6], abs(values[12])))
    else:
        raise ValueError(f"USBLANGLES has the integrity {values[11]:g}; directions need more than {SOUND:g}")


def _long(remote: Remote, values: Sequence[float], options: Options) -> None:
    heard, valid, east, north, up = values[0], values[1], values[6], values[7], values[8]
    propagation, integrity, accuracy = values[12], values[14], values[15]
    if integrity > SOUND:
        variance = accuracy**2 if accuracy > 0.0 else math.nan
        place = options.head[0] + north, options.head[1] + east
        remote.sighted.append(Sighted(heard, valid, "USBL", *place, variance, 0.0 * variance, variance))
        remote.depths.append((valid, -up))
        return
    if not propagation > 0.0:
        raise ValueError("USBLLONG has neither direction (integrity 100 or less) nor time of travel")
    slant = propagation * 1e-6 * options.sound_speed
    remote.sighted.append(Sighted(heard, valid, "USBL", *options.head, range=slant, depth=0.0))


def _vehicle(name: str, remote: Remote, options: Options, notes: list[str]) -> Recorded:
    fixes = [s for s in remote.sighted if math.isnan(s.range)]
    if len(fixes) < len(remote.sighted):
        notes.append(
            f"{name}: {len(remote.sighted) - len(fixes)} of {len(remote.sighted)} USBLLONG are ranges only (integrity"
            f" 100 or less), by the time of travel and {options.sound_speed:g} m/s"
        )
    depths = stream_of(remote.depths, 1)
    if math.isfinite(options.depth):
        depths = stream_of([(min((s.valid for s in remote.sighted), default=0.0), options.depth)], 1)
    sighted = remote.sighted + _by_bearing(name, remote, options, notes)
    return Recorded(name=name, sighted=tuple(sorted(sighted)), depth=depths)


def _by_bearing(name: str, remote: Remote, options: Options, notes: list[str]) -> list[Sighted]:
    """Positions from bearing, elevation e and depth z: d = z / tan e, sigma z / sin^2 e along and sigma d across."""
    found, without = [], 0
    fixes = [s for s in remote.sighted if math.isnan(s.range)]
    if _differ(remote.bearings, fixes, options):
        notes.append(
            f"{name}: bearings of USBLANGLES do not fit the positions of USBLLONG beside them; they are left out"
        )
        return []
    depths = _depths_at(remote, np.array([b.valid for b in remote.bearings]), options)
    for b, depth in zip(remote.bearings, depths.tolist(), strict=True):
        elevation = abs(b.elevation)
        if not (depth > 0.0 and elevation > LEAST_ELEVATION):
            without += 1
            continue
        far, cosine, sine = depth / math.tan(elevation), math.cos(b.bearing), math.sin(b.bearing)
        along, across = (depth * b.sigma / math.sin(elevation) ** 2) ** 2, (far * b.sigma) ** 2
        nn, ne, ee = (
            along * cosine**2 + across * sine**2,
            (along - across) * sine * cosine,
            along * sine**2 + across * cosine**2,
        )
        place = options.head[0] + far * cosine, options.head[1] + far * sine
        found.append(Sighted(b.heard, b.valid, "USBL angles", *place, nn, ne, ee))
    if without:
        notes.append(
            f"{name}: {without} USBLANGLES are not used: a position needs the depth of the remote below the head, with"
            f" --depth, and more than {math.degrees(LEAST_ELEVATION):.0f} deg of elevation"
        )
    return found


def _differ(bearings: Sequence[Bearing], fixes: Sequence[Sighted], options: Options) -> bool:
    """Whether bearings point elsewhere than the positions nearest in time."""
    if not bearings or not fixes:
        return False
    ordered = sorted(fixes, key=lambda s: s.valid)
    near = nearest_of(np.array([s.valid for s in ordered]), np.array([b.valid for b in bearings]))
    apart = [
        abs(wrap_angle(b.bearing - math.atan2(s.east - options.head[1], s.north - options.head[0])))
        for b, s in zip(bearings, (ordered[k] for k in near), strict=True)
        if abs(s.valid - b.valid) < LATEST
    ]
    return bool(apart) and sum(apart) / len(apart) > FAR_APART


def _depths_at(remote: Remote, times: np.ndarray, options: Options) -> np.ndarray:
    """(len(times),) [m] depth of a remote, NaN where it is not known."""
    if math.isfinite(options.depth):
        return np.full(len(times), options.depth)
    depths = stream_of(remote.depths, 1)
    if not depths.is_there:
        return np.full(len(times), math.nan)
    near = nearest_of(depths.times, times)
    return np.where(np.abs(depths.times[near] - times) < LATEST, depths.values[near, 0], math.nan)


def _from(zero: float, vehicle: Recorded) -> Recorded:
    """The same with times from another moment on."""
    sighted = tuple(s._replace(heard=s.heard - zero, valid=s.valid - zero) for s in vehicle.sighted)
    return replace(vehicle, sighted=sighted, depth=vehicle.depth._replace(times=vehicle.depth.times - zero))
