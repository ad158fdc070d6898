"""The own path of a vehicle that moves about those below it while they follow the formation's path."""

import math
from collections.abc import Sequence

import numpy as np

from cardume.errors import MissionError
from cardume.missions.maneuver import AnyManeuver, BestManeuver, CircleManeuver, SpiralManeuver
from cardume.missions.mission import Mission
from cardume.missions.orders import steady_depth
from cardume.missions.ranging.choosing import Knowledge, most_telling
from cardume.missions.ranging.maneuvers import circle, spiral, zigzag
from cardume.missions.ranging.track import arcs_through
from cardume.missions.vehicle import Offset, Vehicle
from cardume.paths import table
from cardume.paths.offset import write_table
from cardume.paths.projection import formation_speed, point_of_formation
from cardume.paths.segment import GeometryError

SPACING = 2.0  # [s] between the points of a maneuver


def those_below(mission: Mission, vehicle: Vehicle) -> list[Vehicle]:
    """The vehicles that a maneuver is about: those without a GNSS, which need its ranges.

    Args:
        mission: with every value fixed.
        vehicle: the one that moves about them.

    Raises:
        MissionError: there are none, or the vehicle has a place in the formation besides, or cannot measure ranges.
    """
    key = f"vehicles.{vehicle.name}.maneuver"
    others = [v for v in mission.vehicles if v.maneuver is None and not v.sensors.ideal and v.sensors.gnss is None]
    if not others:
        raise mission.error(key, "there is nobody to move about: every other vehicle has a GNSS; leave maneuver out")
    if vehicle.sensors.usbl is None:
        raise mission.error(key, "a maneuver serves to measure ranges; give the vehicle sensors: {usbl: {}}")
    if vehicle.offset != Offset():
        raise mission.error(key, "a vehicle has a maneuver or an offset, not both; leave offset out")
    return others


def maneuver_path(
    mission: Mission, vehicle: Vehicle, known: Knowledge, formation: np.ndarray, below: Sequence[np.ndarray]
) -> np.ndarray:
    """The path table of a maneuver: where the vehicle is to be when the formation has come so far.

    The others are predicted to be in their places, at the formation's speed; the maneuver is about their mean.

    Args:
        mission: with every value fixed.
        vehicle: that moves about the others.
        known: of the others.
        formation: (n,) path table of the formation's own point.
        below: (n,) path tables of the others.

    Raises:
        MissionError: the maneuver is too slow for the formation, or has more pieces than a table.
    """
    assert vehicle.maneuver is not None
    gammas, speeds, times = _timetable(formation)
    target = np.mean([_places(path, gammas) for path in below], axis=0)
    try:
        track = _track(vehicle.maneuver, target, times, known)
        return write_table(arcs_through(track, gammas, list(speeds)), 0.0, math.nan)
    except (ValueError, GeometryError) as problem:
        raise _refusal(mission, vehicle, str(problem)) from None


def _refusal(mission: Mission, vehicle: Vehicle, message: str) -> MissionError:
    return mission.error(f"vehicles.{vehicle.name}.maneuver", message)


def _timetable(formation: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Coordination states [m] along the path, the formation's speed there [m/s], and when it comes there [s]."""
    length = float(formation[table.LENGTH_REFERENCE])
    slowest = min(float(row[table.SPEED]) for row in table.rows_on_path(formation))
    gammas = np.linspace(0.0, length, max(3, math.ceil(length / (SPACING * slowest)) + 1))
    segments = [table.segment_at(formation, float(gamma), table.REFERENCE_START) for gamma in gammas]
    speeds = np.array(
        [formation_speed(formation, segment, float(gamma)) for segment, gamma in zip(segments, gammas, strict=True)]
    )
    pace = 0.5 * (1.0 / speeds[1:] + 1.0 / speeds[:-1])
    return gammas, speeds, np.concatenate([[0.0], np.cumsum(pace * np.diff(gammas))])


def _places(path: np.ndarray, gammas: np.ndarray) -> np.ndarray:
    """(n, 2) [m] where a vehicle is when the formation has come so far."""
    return np.array([point_of_formation(path, float(gamma), 0.0)[:2] for gamma in gammas])


def _track(maneuver: AnyManeuver, target: np.ndarray, times: np.ndarray, known: Knowledge) -> np.ndarray:
    fast = maneuver.speed_max
    if isinstance(maneuver, BestManeuver):
        near, far = maneuver.nearest, maneuver.farthest
        if near > far:
            raise ValueError(f"nearest is {near:g} m and farthest {far:g} m; farthest must not be less")
        return most_telling(target, times, speed_max=fast, known=known, nearest=near, farthest=far).track
    if isinstance(maneuver, CircleManeuver):
        return circle(target, times, radius=maneuver.radius, speed_max=fast, bearing=maneuver.bearing)
    if isinstance(maneuver, SpiralManeuver):
        return spiral(
            target, times, radius=maneuver.radius, growth=maneuver.growth, speed_max=fast, bearing=maneuver.bearing
        )
    return zigzag(target, times, width=maneuver.width, astern=maneuver.astern, speed_max=fast)


def known_of(vehicle: Vehicle, below: Sequence[Vehicle]) -> Knowledge:
    """What the vehicles below are told of themselves, and how well the one above measures.

    Args:
        vehicle: that measures.
        below: the others; the first of them stands for all.
    """
    usbl, gnss = vehicle.sensors.usbl, vehicle.sensors.gnss
    assert usbl is not None
    errors = [usbl.parameters.get("range_sigma", 0.0)]
    errors += [gnss.parameters.get(name, 0.0) for name in ("sigma", "correlated_sigma")] if gnss else []
    told = below[0].position.parameters
    names = {"initial_sigma": "position_sigma", "current_sigma": "current_sigma"}
    names |= {name: name for name in ("velocity_noise", "current_noise")}
    return Knowledge(
        sigma=max(math.hypot(*errors), 0.01),
        below=float(np.mean([steady_depth(other) for other in below])) - steady_depth(vehicle),
        **{field: float(told[name]) for name, field in names.items() if name in told},
    )
