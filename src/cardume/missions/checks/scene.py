"""A mission as the checks look at it: every vehicle with its path, its current and what it can do."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from cardume.missions.checks.abilities import SpeedLimits, speed_limits
from cardume.missions.checks.fixes import Fixes, fixes_of
from cardume.missions.checks.stations import Stations, in_current, stations_of
from cardume.missions.mission import Mission
from cardume.missions.planning import Planned
from cardume.missions.schema import Profile
from cardume.missions.vehicle import Vehicle
from cardume.simulation.plan import Choice, Plan, VehiclePlan

# How a vehicle meets the current: it holds its course and its speed over ground; its course alone;
# neither.
Meeting = Literal["course and speed", "course", "nothing"]
FACTORS = {"uniform": "speed", "gauss_markov": "speed", "power_law": "speed", "ekman": "speed", "sheared": "scale"}


@dataclass(frozen=True, kw_only=True, eq=False)
class Craft:
    """One vehicle of the fleet.

    Attributes:
        vehicle: as the mission has it.
        plan: as the engine gets it.
        stations: along its path.
        knows_current: whether the stations hold the current; not for a user's own law of it.
        fixes: how it learns where it is.
        hears_anyone: whether it has neighbors in the coordination graph.
    """

    vehicle: Vehicle
    plan: VehiclePlan
    stations: Stations
    knows_current: bool
    fixes: Fixes
    hears_anyone: bool

    @property
    def name(self) -> str:
        """Its name."""
        return self.plan.name

    def law(self, family: str) -> Choice:
        """The law that it runs for a family."""
        return self.plan.laws[family]

    @cached_property
    def limits(self) -> SpeedLimits | None:
        """Its least and largest steady speed; None where they are not known."""
        return speed_limits(self.plan)

    @cached_property
    def meeting(self) -> Meeting | None:
        """How it meets the current; None for a user's own compensation."""
        compensation, observer = self.law("compensation").law, self.law("current_observer").law
        if not compensation.is_builtin:
            return None
        if self.tracks_bottom:
            steers = compensation.name == "crab" and self.law("compensation").value("use_sway") == 1.0
            is_obeyed = self.law("model").law.name == "kinematic"  # has the speed asked for, through the water
            return ("course" if is_obeyed else "course and speed") if steers else "nothing"
        if compensation.name == "none" or (observer.is_builtin and observer.name == "none"):
            return "nothing"
        return "course and speed" if self.plan.setup.over_ground else "course"

    @property
    def tracks_bottom(self) -> bool:
        """Whether it measures its velocity over ground."""
        return "dvl" in self.plan.laws and self.plan.laws["dvl"].law.name == "bottom_track"

    @property
    def correction(self) -> float:
        """Largest correction [m/s] of the formation's speed by coordination: k."""
        law = self.law("coordination")
        return law.value("gain") if law.law.name == "laplacian_tanh" and self.hears_anyone else 0.0

    @property
    def reach(self) -> float:
        """Length scale [m] of the correction."""
        return self.law("coordination").value("length_scale")

    def path_speed(self, correction: float = 0.0, profile: float | None = None) -> np.ndarray:
        """Wanted speed along its own path at each station, h (v_L + correction), never astern.

        Args:
            correction: [m/s]
            profile: [m/s] instead of the mission's v_L.
        """
        speed = self.stations.speed if profile is None else np.full_like(self.stations.speed, profile)
        wanted: np.ndarray = self.stations.stretch * np.maximum(speed + correction, 0.0)
        return wanted

    def through_water(self, path_speed: np.ndarray) -> np.ndarray:
        """The speed through the water that is asked for: hypot(v - Vpar, Vperp), or v without compensation.

        Args:
            path_speed: (n,) [m/s] along the path, at each station.
        """
        if self.meeting != "course and speed":
            return path_speed
        needed: np.ndarray = np.hypot(path_speed - self.stations.along, self.stations.across)
        return needed


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """A mission and its fleet."""

    mission: Mission
    plan: Plan
    crafts: tuple[Craft, ...]
    reference: np.ndarray  # (n,) table of the reference path
    distances: np.ndarray  # (n, n) [m] largest distance of each pair

    def key(self, craft: Craft, key: str) -> str:
        """The full name of a value of a vehicle: its own where its section was given for it, else the fleet's.

        Args:
            craft: the vehicle.
            key: such as `guidance.lookahead`.
        """
        own = f"vehicles.{craft.name}.{key}"
        section = f"vehicles.{craft.name}.{key.split('.')[0]}"
        return own if section in self.mission.positions else key

    def pairs(self) -> Iterator[tuple[int, int]]:
        """Places in the fleet of every two vehicles."""
        count = len(self.crafts)
        return ((i, j) for i in range(count) for j in range(i + 1, count))

    @property
    def sets_speed(self) -> bool:
        """Whether formation.speed is given and holds all along the path."""
        speed = self.mission.formation.speed
        return speed is not None and all(np.all(craft.stations.speed == speed) for craft in self.crafts)

    @property
    def current_factor(self) -> str:
        """The parameter in proportion to which the whole mean current is; empty where there is none."""
        return FACTORS.get(self.mission.current.name, "")


def make_scene(mission: Mission, planned: Planned) -> Scene:
    """Look at a mission that can be planned.

    Args:
        mission: with every value fixed.
        planned: its plan.
    """
    vehicles = planned.plan.vehicles
    still = [stations_of(vehicle.path, mission.duration) for vehicle in vehicles]
    in_water = [
        in_current(stations, planned.plan, vehicle.laws["current"], _depths(told, stations))
        for stations, vehicle, told in zip(still, vehicles, mission.vehicles, strict=True)
    ]
    distances = _distances(vehicles, still)
    fixes = fixes_of(vehicles, distances, mission.tick)
    hears = np.count_nonzero(planned.plan.hears, axis=1)
    crafts = tuple(
        Craft(
            vehicle=mission.vehicles[k],
            plan=vehicles[k],
            stations=in_water[k] or still[k],
            knows_current=in_water[k] is not None,
            fixes=fixes[k],
            hears_anyone=bool(hears[k]),
        )
        for k in range(len(vehicles))
    )
    return Scene(mission=mission, plan=planned.plan, crafts=crafts, reference=planned.reference, distances=distances)


def _depths(vehicle: Vehicle, stations: Stations) -> np.ndarray:
    """The depth [m] that a vehicle is told to keep at each of its stations (n,)."""
    depth = vehicle.depth
    if not isinstance(depth, Profile):
        return np.full(len(stations.time), depth)
    over = stations.time if depth.over == "time" else stations.state + vehicle.offset.ahead
    return np.array([depth.at(float(value)) for value in over])


def place_at(stations: Stations, states: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """North and east [m] of a vehicle's place in the formation.

    Args:
        stations: of the vehicle.
        states: (n,) [m] of the formation; before and beyond its path it stays at the ends.
    """
    return np.interp(states, stations.state, stations.north), np.interp(states, stations.state, stations.east)


def common_states(one: Stations, other: Stations) -> np.ndarray:
    """States (n,) [m] of the formation at which both vehicles are on their paths; none where they never are."""
    states = np.union1d(one.state, other.state)
    low, high = max(one.state[0], other.state[0]), min(one.state[-1], other.state[-1])
    common: np.ndarray = states[(states >= low) & (states <= high)]
    return common


def distances_in_formation(one: Craft, other: Craft) -> np.ndarray:
    """Distances (n,) [m] of two vehicles that are both in their places, along the path; depths count.

    Args:
        one: a vehicle.
        other: another.
    """
    return _between(one.plan, other.plan, one.stations, other.stations)


def distance_at_start(one: VehiclePlan, other: VehiclePlan) -> float:
    """Distance [m] of two vehicles when the mission begins."""
    a, b = one.state, other.state
    return float(np.linalg.norm([a.north - b.north, a.east - b.east, a.depth - b.depth]))


def _between(one: VehiclePlan, other: VehiclePlan, its: Stations, others: Stations) -> np.ndarray:
    states = common_states(its, others)
    (north, east), (there_north, there_east) = place_at(its, states), place_at(others, states)
    down = one.setup.depth - other.setup.depth
    apart: np.ndarray = np.sqrt((north - there_north) ** 2 + (east - there_east) ** 2 + down**2)
    return apart


def _distances(vehicles: Sequence[VehiclePlan], stations: Sequence[Stations]) -> np.ndarray:
    count = len(vehicles)
    found = np.zeros((count, count))
    for i in range(count):
        for j in range(i):
            here = _between(vehicles[i], vehicles[j], stations[i], stations[j])
            found[i, j] = found[j, i] = max(distance_at_start(vehicles[i], vehicles[j]), here.max(initial=0.0))
    return found
