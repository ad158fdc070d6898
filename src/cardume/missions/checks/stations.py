"""Where along its path a vehicle will be within the mission, and what the water does there."""

import math
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from cardume.compiler import SharedRows
from cardume.paths import table
from cardume.paths.offset import curve_of
from cardume.signals import Noise, Water, Where
from cardume.simulation.plan import Choice, Plan

FINEST_TURN = math.radians(5.0)
LONGEST_STEP = 25.0  # [m]
MOST_IN_SEGMENT = 720  # ten laps of a circle
MOST_LOOKED_UP = 300  # places in a current
MOST_TIMES = 50  # at the end of the path
SILENCE = Noise(0.0, 0.0, 0.0, 0.0)
SIGMAS = 2.0  # of a current's variation that a mission is to withstand


@dataclass(frozen=True, kw_only=True, eq=False)
class Stations:
    """Points along a vehicle's own path, in the order in which it comes there; each (n,).

    Attributes:
        state: [m] the vehicle's coordination state.
        time: [s] at the formation's speed, from the start of the path.
        north, east: [m]
        course: [rad] of the path.
        curvature: [1/m] of its own path.
        stretch: [-] own path per reference path.
        speed: [m/s] v_L on the reference path.
        along, across: [m/s] the mean current along and to starboard of the course.
        doubt: [m/s] how much more the current's variation may bring, in any direction.
    """

    state: np.ndarray
    time: np.ndarray
    north: np.ndarray
    east: np.ndarray
    course: np.ndarray
    curvature: np.ndarray
    stretch: np.ndarray
    speed: np.ndarray
    along: np.ndarray
    across: np.ndarray
    doubt: float

    @property
    def current_speed(self) -> np.ndarray:
        """Speed of the mean current at each station (n,) [m/s]."""
        speed: np.ndarray = np.hypot(self.along, self.across)
        return speed


def stations_of(path: np.ndarray, duration: float) -> Stations:
    """Stations in still water.

    Args:
        path: (n,) [any] path table of the vehicle.
        duration: [s] of the mission; what lies further is left out.
    """
    parts, time = [], 0.0
    for row in table.rows_on_path(path):
        if time > duration:
            break
        if row[table.IS_CURVE]:
            parts.append(_along_curve(row, time))
            time = float(parts[-1][1, -1])
            continue
        speed = row[table.STRETCH] * row[table.SPEED]
        parts.append(_along_segment(row, min(row[table.LENGTH], (duration - time) * speed), time, speed))
        time += row[table.LENGTH] / speed
    values = np.concatenate(parts, axis=1)
    state, when, north, east, course, curvature, stretch, profile = values
    still = np.zeros(len(state))
    return Stations(
        state=state - path[table.AHEAD],
        time=when,
        north=north,
        east=east,
        course=course,
        curvature=curvature,
        stretch=stretch,
        speed=profile,
        along=still,
        across=still,
        doubt=0.0,
    )


def _along_segment(row: np.ndarray, length: float, time: float, speed: float) -> np.ndarray:
    curvature = row[table.CURVATURE]
    finest = max(abs(curvature) * length / FINEST_TURN, length / LONGEST_STEP, 1.0)
    s = np.linspace(0.0, length, min(math.ceil(finest), MOST_IN_SEGMENT) + 1)
    turned = curvature * s
    ahead, aside = (np.sin(turned) / curvature, (1.0 - np.cos(turned)) / curvature) if curvature else (s, 0.0 * s)
    sine, cosine = row[table.SIN_COURSE], row[table.COS_COURSE]
    same = np.ones(len(s))
    return np.array(
        [
            row[table.REFERENCE_START] + s * row[table.REFERENCE_RATE],
            time + s / speed,
            row[table.START_NORTH] + ahead * cosine - aside * sine,
            row[table.START_EAST] + ahead * sine + aside * cosine,
            row[table.START_COURSE] + turned,
            curvature * same,
            row[table.STRETCH] * same,
            row[table.SPEED] * same,
        ]
    )


def _along_curve(row: np.ndarray, time: float) -> np.ndarray:
    """The same of a curve, whose speed and bend change on the way."""
    curve, offset = curve_of(row), row[table.OFFSET]
    finest = max(max(map(abs, curve.bends)) * curve.length / FINEST_TURN, curve.length / LONGEST_STEP, 4.0)
    tau = np.linspace(0.0, 1.0, min(math.ceil(finest), MOST_IN_SEGMENT) + 1)
    ahead, aside, turned, bend = curve.along(tau)
    ahead, aside = ahead - offset * np.sin(turned), aside + offset * (np.cos(turned) - 1.0)
    speed, stretch = curve.speed_along(tau), 1.0 - bend * offset
    slowness = 1.0 / speed
    times = np.cumsum(0.5 * (slowness[1:] + slowness[:-1]) * np.diff(tau) * curve.length)
    sine, cosine = row[table.SIN_COURSE], row[table.COS_COURSE]
    return np.array(
        [
            row[table.REFERENCE_START] + tau * curve.length,
            time + np.concatenate([[0.0], times]),
            row[table.START_NORTH] + ahead * cosine - aside * sine,
            row[table.START_EAST] + ahead * sine + aside * cosine,
            row[table.START_COURSE] + turned,
            bend / stretch,
            stretch,
            speed,
        ]
    )


def in_current(stations: Stations, plan: Plan, water: Choice, depths: np.ndarray) -> Stations | None:
    """The stations with the mission's current; None where the current is a user's own law.

    The law itself is asked, without noise: what it then gives is the mean, at the place, depth and time of a station.

    Args:
        stations: in still water.
        plan: holds the table of a gridded or sheared current.
        water: the law of the current.
        depths: [m] (n,) of the vehicle at each station.
    """
    if not water.law.is_builtin:
        return None
    looked_up = _thinned(stations)
    deep = np.interp(looked_up.time, stations.time, depths)
    places = zip(looked_up.north, looked_up.east, deep, looked_up.time, strict=True)
    flows = [_mean(water, plan, place) for place in places]
    if water.law.name == "gridded":
        stations = looked_up
    north, east = (np.interp(stations.time, looked_up.time, part) for part in np.array(flows, float).T)
    sine, cosine = np.sin(stations.course), np.cos(stations.course)
    along, across = north * cosine + east * sine, east * cosine - north * sine
    doubt = SIGMAS * spread_of(water)[1]
    return replace(stations, along=np.nan_to_num(along), across=np.nan_to_num(across), doubt=doubt)


def _mean(water: Choice, plan: Plan, where: tuple[float, float, float, float]) -> Water:
    """What a law of the current gives when nothing varies, by north, east, depth [m] and time [s]."""
    law, place = water.law, Where(*where, cast(SharedRows, plan.field))
    given = {"place": place, "noise": SILENCE, "dt": plan.tick, **{p.name: water.value(p.name) for p in law.parameters}}
    if law.memory_type is None:
        return cast(Water, law(**given))
    return cast(Water, law(**given, memory=law.memory_type())[0])


def spread_of(water: Choice) -> tuple[str, float]:
    """The parameter that says how much a current varies about its mean, and its value [m/s]; 0 where it does not.

    Args:
        water: one of our laws of the current.
    """
    sigmas = [p.name for p in water.law.parameters if "sigma" in p.name]
    return max(((name, water.value(name)) for name in sigmas), key=lambda pair: pair[1], default=("", 0.0))


def fastest_after(stations: Stations, plan: Plan, water: Choice, depth: float) -> float:
    """The fastest mean current [m/s] at the last station, from the time of arrival to the end of the mission.

    Args:
        stations: of the vehicle.
        plan: of the mission.
        water: one of our laws of the current.
        depth: [m] of the vehicle.
    """
    times = np.linspace(stations.time[-1], max(plan.duration, stations.time[-1]), MOST_TIMES)
    flows = [_mean(water, plan, (stations.north[-1], stations.east[-1], depth, t)) for t in times]
    return float(np.nan_to_num([math.hypot(*flow) for flow in flows]).max())


def _thinned(stations: Stations) -> Stations:
    count = len(stations.time)
    if count <= MOST_LOOKED_UP:
        return stations
    kept = np.unique(np.linspace(0, count - 1, MOST_LOOKED_UP).round().astype(int))
    arrays = {name: value[kept] for name, value in vars(stations).items() if isinstance(value, np.ndarray)}
    return replace(stations, **arrays)
