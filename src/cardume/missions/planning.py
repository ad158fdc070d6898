"""From a mission, as written, to a plan, as the engine takes it."""

import inspect
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from cardume.errors import DataError
from cardume.laws import Law, laws_of
from cardume.missions.catalog import Catalog
from cardume.missions.currents import Window, explain_coverage, read_current
from cardume.missions.formats import read_plan
from cardume.missions.geodesy import GeoPoint
from cardume.missions.laying import lay_path
from cardume.missions.medium_access import scheduled
from cardume.missions.mission import Mission
from cardume.missions.orders import (
    deepest,
    depths_along,
    is_watched,
    order_book,
    safety_of,
    separation_of,
    start_depth,
    table_speed,
)
from cardume.missions.route import FilePath
from cardume.missions.seabed import numbers_only, read_seabed
from cardume.missions.vehicle import LawChoice, RelativeStart, Sensors, Vehicle
from cardume.missions.water import CurrentPoint
from cardume.onboard.mind import Datasheet, Setup
from cardume.paths.offset import offset_path
from cardume.paths.outline import outline
from cardume.paths.projection import point_at
from cardume.paths.segment import GeometryError, ReferencePath, length_of
from cardume.paths.table import PathPlace, start_at
from cardume.signals import Command, Reference, VesselState, Water
from cardume.simulation.memo import NO_MEMO, Memo
from cardume.simulation.plan import Choice, Plan, VehiclePlan
from cardume.simulation.score import Rules
from cardume.world.currents import ProfilePoint, pack_profile

IDEAL_SENSORS = ("gnss", "ahrs", "depth", "dvl", "thruster_speed")
ERRORS = ("sigma", "bias", "deviation", "misalignment", "latency")  # parts of the names of parameters that are errors
UNLIMITED = 1e9  # [m]
FARTHEST = ("deepest", "range")  # names of parameters that are limits
TRIM_STEP = 0.05  # [s]
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

    def own_path(vehicle: Vehicle) -> np.ndarray:
        parts = reference, vehicle.offset
        return memo.recall("path", parts, lambda: _own_path(mission, vehicle, reference, speed), speed)

    paths = [own_path(vehicle) for vehicle in mission.vehicles]
    water, field = _current(mission, origin, paths, catalog, memo)
    fleet = mission.bathymetry, mission.formation, mission.vehicles[0].coordination

    def planned(vehicle: Vehicle, path: np.ndarray) -> VehiclePlan:
        parts = vehicle, path, water, *fleet
        make = partial(_vehicle, mission, vehicle, path, water, catalog, memo)
        return memo.recall("vehicle", parts, make, mission.tick)

    seabed = memo.recall(
        "seabed", (mission.bathymetry, mission.origin, *paths), lambda: _seabed(mission, origin, paths)
    )
    vehicles = tuple(planned(vehicle, path) for vehicle, path in zip(mission.vehicles, paths, strict=True))
    plan = Plan(
        scheduled(mission, vehicles),
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
        law = memo.recall("law", (chosen,), lambda: _choice(chosen, catalog))
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


def _choice(chosen: LawChoice, catalog: Catalog) -> Choice:
    """A law and its numbers, found again by name."""
    if ":" in chosen.name:
        law: Any = catalog.resolve_law(chosen.family, chosen.name)
    else:
        law = laws_of(chosen.family)[chosen.name]
    return Choice(law, {name: float(value) for name, value in chosen.parameters.items()})


def _vehicle(
    mission: Mission, vehicle: Vehicle, path: np.ndarray, water: Choice, catalog: Catalog, memo: Memo
) -> VehiclePlan:
    def choice(chosen: LawChoice) -> Choice:
        return memo.recall("law", (chosen,), lambda: _choice(chosen, catalog))

    seabed, heard = mission.bathymetry, vehicle.acoustics
    laws = {
        "guidance": choice(vehicle.guidance.law),
        "reference_point": choice(vehicle.guidance.reference_point),
        "compensation": choice(vehicle.compensation),
        "current_observer": choice(vehicle.current_observer),
        "position": choice(vehicle.position),
        "neighbors": choice(vehicle.neighbors),
        "coordination": choice(vehicle.coordination.law),
        "messaging": choice(vehicle.messaging),
        "model": choice(vehicle.model),
        "autopilot": memo.recall("autopilot", (vehicle.model, vehicle.autopilot), lambda: _autopilot(vehicle, catalog)),
        "acoustics": memo.recall("channel", (heard,), lambda: _choice(numbers_only(heard), catalog)),
        "current": water,
        **({"bathymetry": _seabed_law(seabed, catalog, memo)} if seabed else {}),
        **memo.recall(
            "sensors",
            (vehicle.sensors, vehicle.model),
            lambda: _sensors(vehicle, mission.tick, seabed is not None, catalog, memo),
            (mission.tick, seabed is not None),
        ),
    }
    state, place = memo.recall(
        "start",
        (vehicle.start, path, laws["model"]),
        lambda: _start(vehicle, path, laws["model"], memo),
        start_depth(vehicle),
    )
    believed = vehicle.initial_estimate
    return VehiclePlan(
        vehicle.name,
        laws,
        path,
        state,
        (believed.north, believed.east) if believed else None,
        place,
        memo.same(_setup(vehicle, laws)),
        memo.same(order_book(mission, vehicle, path, memo)),
        memo.same(safety_of(mission, vehicle)),
        memo.same(_datasheet(laws)),
    )


def _datasheet(laws: dict[str, Choice]) -> Datasheet:
    """What is told of the errors of sensors whose laws have parameters that say them."""

    def told(kind: str, *names: str) -> float:
        choice = laws.get(kind)
        known = {p.name for p in choice.law.parameters} if choice else set()
        return math.hypot(*(choice.value(name) for name in names)) if choice and known >= set(names) else math.nan

    gnss, of_ahrs = told("gnss", "sigma", "correlated_sigma"), laws.get("ahrs")
    return Datasheet(
        told("gnss", "sigma") if math.isnan(gnss) else gnss,
        told("usbl", "range_sigma"),
        told("usbl", "angle_sigma"),
        told("ahrs", "heading_sigma") if of_ahrs else 0.0,
        told("ahrs", "attitude_sigma") if of_ahrs else 0.0,
    )


def _setup(vehicle: Vehicle, laws: dict[str, Choice]) -> Setup:
    return Setup(
        deepest(vehicle),
        float(vehicle.speed_reference == "ground"),
        float(vehicle.end != "continue"),
        float(vehicle.end == "surface"),
        float("usbl" in laws),
        float("fixes" in getattr(laws["position"].law.memory_type, "_fields", ())),
    )


def _seabed_law(seabed: LawChoice, catalog: Catalog, memo: Memo) -> Choice:
    return memo.recall("seabed law", (seabed,), lambda: _choice(numbers_only(seabed), catalog))


def _autopilot(vehicle: Vehicle, catalog: Catalog) -> Choice:
    """A kinematic vehicle follows its reference by itself."""
    if vehicle.model.name == "kinematic":
        return Choice(laws_of("autopilot")["none"])
    return _choice(vehicle.autopilot, catalog)


def _sensors(vehicle: Vehicle, tick: float, has_seabed: bool, catalog: Catalog, memo: Memo) -> dict[str, Choice]:
    """The sensors a vehicle carries, and the law by which it reads its shaft speed."""
    sensors = vehicle.sensors

    def choice(chosen: LawChoice) -> Choice:
        return memo.recall("law", (chosen,), lambda: _choice(chosen, catalog))

    laws: dict[str, Choice] = {}
    if sensors.ideal:
        kinds = (*IDEAL_SENSORS, *(("altimeter",) if has_seabed else ()))
        laws = {kind: _exact(laws_of(kind)[kind], tick) for kind in kinds}
    else:
        for kind in ("gnss", "ahrs", "depth", "usbl", "dvl", "altimeter"):
            if (chosen := getattr(sensors, kind)) is not None:
                laws[kind] = choice(chosen)
        if sensors.thruster_speed is not None:
            laws["thruster_speed"] = choice(sensors.thruster_speed.law)
    laws["speed"] = memo.recall(
        "reader", (vehicle.model, sensors.thruster_speed), lambda: _reader(vehicle, sensors, catalog)
    )
    return laws


def _reader(vehicle: Vehicle, sensors: Sensors, catalog: Catalog) -> Choice:
    """How shaft speed becomes speed: the shaft speed of a kinematic vehicle is its speed already."""
    if sensors.thruster_speed is not None:
        chosen = _choice(sensors.thruster_speed.reader, catalog)
    else:
        chosen = _told_by(vehicle.model, laws_of("speed")["thruster_calibration"], catalog)
    if vehicle.model.name == "kinematic" and chosen.law.is_builtin:
        return Choice(laws_of("speed")["proportional"], {"scale": chosen.value("scale")})
    return chosen


def _told_by(model: LawChoice, law: Law, catalog: Catalog) -> Choice:
    """A law with the defaults that a model announces for it."""
    told = _choice(model, catalog).law.announced.get(law.family, {})
    names = {parameter.name for parameter in law.parameters}
    return Choice(law, {name: value for name, value in told.items() if name in names})


def _exact(law: Law, tick: float) -> Choice:
    """A sensor without any error, everywhere, in every tick."""
    exact = {p.name: 0.0 for p in law.parameters if any(part in p.name for part in ERRORS)}
    exact |= {p.name: UNLIMITED for p in law.parameters if p.name in FARTHEST}
    exact |= {p.name: 0.0 for p in law.parameters if p.name == "nearest"}
    return Choice(law, exact | {"period": tick})


def _start(vehicle: Vehicle, path: np.ndarray, model: Choice, memo: Memo) -> tuple[VesselState, PathPlace]:
    """Where a vehicle starts, and where on its path that is."""
    start = vehicle.start
    if isinstance(start, RelativeStart):
        along = start.along_track
        place = memo.recall("place", (path,), lambda: start_at(path, along), along)
        point = memo.recall("point", (path,), lambda: point_at(path, along), along)
        north = point.north - start.cross_track * point.sin_course
        east = point.east + start.cross_track * point.cos_course
        heading = point.course + start.heading_error
    else:
        north, east, heading = start.north, start.east, start.heading
        place = memo.recall("place", (path,), lambda: start_at(path, 0.0), 0.0)
    state = VesselState(north, east, start_depth(vehicle), heading, start.speed)
    trimmed = memo.recall("trimmed", (model,), lambda: _trimmed(model, start.speed), start.speed)
    return state._replace(shaft_speed=trimmed), place


def _trimmed(model: Choice, speed: float) -> float:
    """The shaft speed that a vehicle starts with: that of its model, steady at its speed."""
    law = model.law
    given: dict[str, Any] = {"vessel": VesselState(surge=speed), "command": Command(), "water": Water()}
    given |= {"reference": Reference(speed=speed), "dt": TRIM_STEP, **model.parameters}
    if law.memory_type is not None:
        given["memory"] = law.memory_type(*(np.array(v) if np.ndim(v) else v for v in law.memory_type()))
    names = {*inspect.signature(law.function).parameters, *(p.name for p in law.parameters)}
    try:
        answer = law(**{name: value for name, value in given.items() if name in names})
    except Exception:  # a user's model; it is told what is wrong when it is compiled
        return 0.0
    return float((answer[0] if law.memory_type is not None else answer).shaft_speed)
