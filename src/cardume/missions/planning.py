"""From a mission, as written, to a plan, as the engine takes it."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from cardume.errors import DataError
from cardume.laws import laws_of
from cardume.missions.catalog import Catalog
from cardume.missions.currents import Window, explain_coverage, read_current
from cardume.missions.equipping import choice_of, plan_vehicle
from cardume.missions.fault_planning import plan_faults
from cardume.missions.formats import read_plan
from cardume.missions.geodesy import GeoPoint
from cardume.missions.laying import lay_path
from cardume.missions.maneuvering import known_of, maneuver_path, those_below
from cardume.missions.medium_access import scheduled
from cardume.missions.mission import Mission
from cardume.missions.orders import deepest, depths_along, is_watched, separation_of, table_speed
from cardume.missions.route import FilePath
from cardume.missions.seabed import read_seabed
from cardume.missions.vehicle import LawChoice, Vehicle
from cardume.missions.water import CurrentPoint
from cardume.paths.offset import offset_path
from cardume.paths.outline import outline
from cardume.paths.segment import GeometryError, ReferencePath, length_of
from cardume.simulation.memo import NO_MEMO, Memo
from cardume.simulation.plan import Choice, Plan, VehiclePlan
from cardume.simulation.score import Rules
from cardume.world.currents import ProfilePoint, pack_profile

TEXTS = ("file", "east", "north", "start_time")  # what `gridded` takes beside numbers
PROFILE = "profile"  # and `sheared`


@dataclass(frozen=True)
class Planned:
    """A plan and what figures need beside it.

    Attributes:
        plan: for the engine.
        reference: the reference path's table, without offset.
    """

    plan: Plan
    reference: np.ndarray


def make_plan(mission: Mission, catalog: Catalog, memo: Memo = NO_MEMO) -> Planned:
    """Build paths, look up laws and read the current of a mission whose numbers are all drawn.

    Args:
        mission: with every value fixed.
        catalog: where its laws are found.
        memo: of other missions that were drawn from the same one.

    Raises:
        InputError: a path that cannot be built, an offset that does not fit, a current that does not cover it.
    """
    reference, origin = memo.recall("reference", (mission.path, mission.origin), lambda: _reference(mission))
    length = memo.recall("length", (reference,), lambda: length_of(reference))
    speed = table_speed(mission, length)
    own = memo.recall("own path", (reference,), lambda: _formation_path(mission, reference, speed), speed)

    paths = _own_paths(mission, reference, own, speed, memo)
    water, field = _current(mission, origin, paths, catalog, memo)
    fleet = mission.bathymetry, mission.formation, mission.vehicles[0].coordination

    def planned(vehicle: Vehicle, path: np.ndarray) -> VehiclePlan:
        parts = vehicle, path, water, *fleet
        make = partial(plan_vehicle, mission, vehicle, path, water, catalog, memo)
        return memo.recall("vehicle", parts, make, mission.tick)

    seabed = memo.recall(
        "seabed", (mission.bathymetry, mission.origin, *paths), lambda: _seabed(mission, origin, paths)
    )
    vehicles = scheduled(mission, [planned(v, path) for v, path in zip(mission.vehicles, paths, strict=True)])
    faults = plan_faults(mission, vehicles)
    plan = Plan(
        vehicles,
        memo.recall("hears", (mission.vehicles[0].coordination,), lambda: np.asarray(mission.adjacency)),
        mission.duration,
        mission.seed,
        mission.tick,
        mission.plant_step,
        mission.log_period,
        field,
        Rules(mission.transient.threshold, mission.transient.hold, mission.swath or 0.0),
        seabed,
        separation_of(mission),
        is_watched(mission),
        faults,
    )
    return Planned(plan, own)


def _reference(mission: Mission) -> tuple[ReferencePath, GeoPoint | None]:
    origin = GeoPoint(mission.origin.latitude, mission.origin.longitude) if mission.origin else None
    return reference_path(mission, origin)


def _formation_path(mission: Mission, reference: ReferencePath, speed: float) -> np.ndarray:
    """The path of the formation's own point."""
    own: np.ndarray = _positioned(mission, "path", lambda: offset_path(reference, 0.0, 0.0, speed))
    if not np.isfinite(own).all():
        raise mission.error("formation.speed", "is not given, and not every piece of the path has a speed; give it")
    return own


def _positioned(mission: Mission, key: str, build: Callable[[], Any]) -> Any:
    """Build something; what is wrong with it is told with the place of its key in the file."""
    try:
        return build()
    except GeometryError as problem:
        raise mission.error(key, str(problem)) from None


def reference_path(mission: Mission, origin: GeoPoint | None) -> tuple[ReferencePath, GeoPoint | None]:
    """The reference path of a mission, and where its local axes begin.

    Args:
        mission: with every value fixed.
        origin: of the local axes; None: not known, unless a path file says it.

    Raises:
        InputError: a path that cannot be built, or a path file that cannot be read.
    """
    if isinstance(mission.path, FilePath):
        plan = read_plan(Path(mission.path.file), origin)
        return plan.segments, plan.origin
    return _positioned(mission, "path", lambda: lay_path(mission.path)), origin


def _own_paths(
    mission: Mission, reference: ReferencePath, formation: np.ndarray, speed: float, memo: Memo
) -> list[np.ndarray]:
    """The path of every vehicle: first of those with a place in the formation, then of those that move about them."""

    def place(vehicle: Vehicle) -> np.ndarray:
        parts = reference, vehicle.offset
        return memo.recall("path", parts, lambda: _own_path(mission, vehicle, reference, speed), speed)

    paths = {vehicle.name: place(vehicle) for vehicle in mission.vehicles if vehicle.maneuver is None}

    def maneuver(vehicle: Vehicle) -> np.ndarray:
        others = those_below(mission, vehicle)
        known, below = known_of(vehicle, others), [paths[other.name] for other in others]
        make = partial(maneuver_path, mission, vehicle, known, formation, below)
        return memo.recall("maneuver", (formation, *below), make, (vehicle.name, vehicle.maneuver, known))

    paths |= {vehicle.name: maneuver(vehicle) for vehicle in mission.vehicles if vehicle.maneuver is not None}
    return [paths[vehicle.name] for vehicle in mission.vehicles]


def _own_path(mission: Mission, vehicle: Vehicle, reference: ReferencePath, speed: float) -> np.ndarray:
    key = f"vehicles.{vehicle.name}.offset.starboard"
    offset = vehicle.offset
    table: np.ndarray = _positioned(mission, key, lambda: offset_path(reference, offset.starboard, offset.ahead, speed))
    return table


def _current(
    mission: Mission, origin: GeoPoint | None, paths: list[np.ndarray], catalog: Catalog, memo: Memo
) -> tuple[Choice, np.ndarray]:
    """The law of the water and, for a gridded one, its table."""
    chosen = mission.current
    if chosen.name == "none":
        return memo.recall("still", (), lambda: (Choice(laws_of("current")["uniform"], {"speed": 0.0}), np.zeros(1)))
    if chosen.name == "sheared":
        return memo.recall("sheared", (chosen,), lambda: _sheared(chosen))
    if chosen.name != "gridded":
        law = memo.recall("law", (chosen,), lambda: choice_of(chosen, catalog))
        return law, memo.recall("no field", (), lambda: np.zeros(1))
    values = (mission.duration, *(v.depth for v in mission.vehicles), *(chosen.parameters.get(key) for key in TEXTS))
    rows = memo.recall("field", (mission.origin, *paths), lambda: _gridded(mission, origin, paths), values)
    numbers = {key: value for key, value in chosen.parameters.items() if key not in TEXTS}
    return memo.recall("gridded", (chosen,), lambda: Choice(laws_of("current")["gridded"], numbers)), rows


def _sheared(chosen: LawChoice) -> tuple[Choice, np.ndarray]:
    numbers = {key: value for key, value in chosen.parameters.items() if key != PROFILE}
    return Choice(laws_of("current")["sheared"], numbers), _profile(chosen.parameters[PROFILE])


def _gridded(mission: Mission, origin: GeoPoint | None, paths: list[np.ndarray]) -> np.ndarray:
    """The table of a gridded current."""
    if origin is None:
        raise mission.error(
            "origin", "a gridded current needs to know where the mission is; give latitude and longitude"
        )
    texts = {key: mission.current.parameters.get(key) for key in TEXTS}
    window = Window(
        origin=origin,
        start_time=texts["start_time"],
        duration=mission.duration,
        deepest=max(deepest(v) for v in mission.vehicles),
    )
    lines = [outline(path, 20.0)[:, 1:] for path in paths]
    levels = [(line, depth) for line, v in zip(lines, mission.vehicles, strict=True) for depth in depths_along(v)]
    points, depths = [line for line, _ in levels], [np.full((len(line), 1), depth) for line, depth in levels]
    try:
        field = read_current(str(texts["file"]), window=window, east=texts["east"], north=texts["north"])
        rows = field.to_rows(origin)
        uncovered = explain_coverage(field, origin, np.hstack([np.concatenate(points), np.concatenate(depths)]))
    except DataError as problem:
        raise mission.error("current.file", str(problem)) from None
    if uncovered:
        raise mission.error("current.file", uncovered)
    return rows


def _seabed(mission: Mission, origin: GeoPoint | None, paths: list[np.ndarray]) -> np.ndarray:
    """The table of a gridded seabed."""
    is_gridded = mission.bathymetry is not None and mission.bathymetry.name == "gridded"
    return read_seabed(mission, origin, [outline(path, 20.0)[:, 1:] for path in paths] if is_gridded else [])


def _profile(points: Sequence[CurrentPoint]) -> np.ndarray:
    """The table of a sheared current."""
    return pack_profile(
        [ProfilePoint(p.depth, p.speed * math.cos(p.towards), p.speed * math.sin(p.towards)) for p in points]
    )
