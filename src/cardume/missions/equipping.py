"""From a vehicle, as written, to its plan: the laws aboard, its sensors, where it starts, what it is told."""

import inspect
import math
from typing import Any

import numpy as np

from cardume.laws import Law, laws_of
from cardume.missions.catalog import Catalog
from cardume.missions.mission import Mission
from cardume.missions.orders import deepest, order_book, safety_of, start_depth
from cardume.missions.vehicle import LawChoice, RelativeStart, Sensors, Vehicle
from cardume.onboard.mind import Datasheet, Setup
from cardume.paths.projection import point_at
from cardume.paths.table import PathPlace, start_at
from cardume.signals import Command, Reference, VesselState, Water
from cardume.simulation.memo import Memo
from cardume.simulation.plan import Choice, VehiclePlan

IDEAL_SENSORS = ("gnss", "ahrs", "depth", "dvl", "thruster_speed")
ERRORS = ("sigma", "bias", "deviation", "misalignment", "latency")  # parts of the names of parameters that are errors
UNLIMITED = 1e9  # [m]
FARTHEST = ("deepest", "range")  # names of parameters that are limits
TRIM_STEP = 0.05  # [s]
HOLDING = ("ahrs", "depth", "dvl", "thruster_speed", "altimeter")  # sensors whose last reading stands until the next
LEAST_PATIENCE = 5.0  # [s] for which a reading may stay the same


def choice_of(chosen: LawChoice, catalog: Catalog) -> Choice:
    """A law and its numbers, found again by name: words as their places, without what only planning reads.

    Args:
        chosen: in a mission.
        catalog: where laws are found.

    Raises:
        InputError: a law of the user's that is not there any more.
    """
    if ":" in chosen.name:
        law: Any = catalog.resolve_law(chosen.family, chosen.name)
    else:
        law = laws_of(chosen.family)[chosen.name]
    given = {p.name: chosen.parameters[p.name] for p in law.parameters if p.name in chosen.parameters}
    words = {p.name: p.words for p in law.parameters if p.words}
    return Choice(law, {k: float(words[k].index(v) if k in words else v) for k, v in given.items()})


def plan_vehicle(
    mission: Mission, vehicle: Vehicle, path: np.ndarray, water: Choice, catalog: Catalog, memo: Memo
) -> VehiclePlan:
    """What the engine takes of one vehicle.

    Args:
        mission: with every value fixed.
        vehicle: of it.
        path: (n,) table of its own path.
        water: the law of the current.
        catalog: where laws are found.
        memo: of other missions that were drawn from the same one.

    Raises:
        InputError: a law of the user's that is not there any more.
    """

    def choice(chosen: LawChoice) -> Choice:
        return memo.recall("law", (chosen,), lambda: choice_of(chosen, catalog))

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
        "acoustics": memo.recall("channel", (heard,), lambda: choice_of(heard, catalog)),
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
        told("depth", "sigma"),
        told("altimeter", "sigma"),
        told("dvl", "sigma"),
        told("thruster_speed", "sigma"),
        max(LEAST_PATIENCE, *(5.0 * laws[kind].value("period") for kind in HOLDING if kind in laws), 0.0),
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
    return memo.recall("seabed law", (seabed,), lambda: choice_of(seabed, catalog))


def _autopilot(vehicle: Vehicle, catalog: Catalog) -> Choice:
    """A kinematic vehicle follows its reference by itself."""
    if vehicle.model.name == "kinematic":
        return Choice(laws_of("autopilot")["none"])
    return choice_of(vehicle.autopilot, catalog)


def _sensors(vehicle: Vehicle, tick: float, has_seabed: bool, catalog: Catalog, memo: Memo) -> dict[str, Choice]:
    """The sensors a vehicle carries, and the law by which it reads its shaft speed."""
    sensors = vehicle.sensors

    def choice(chosen: LawChoice) -> Choice:
        return memo.recall("law", (chosen,), lambda: choice_of(chosen, catalog))

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
        chosen = choice_of(sensors.thruster_speed.reader, catalog)
    else:
        chosen = _told_by(vehicle.model, laws_of("speed")["thruster_calibration"], catalog)
    if vehicle.model.name == "kinematic" and chosen.law.is_builtin:
        return Choice(laws_of("speed")["proportional"], {"scale": chosen.value("scale")})
    return chosen


def _told_by(model: LawChoice, law: Law, catalog: Catalog) -> Choice:
    """A law with the defaults that a model announces for it."""
    told = choice_of(model, catalog).law.announced.get(law.family, {})
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
