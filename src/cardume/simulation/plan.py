"""A mission as the engine takes it: laws, numbers and path tables, one record per vehicle."""

import dataclasses
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from cardume.laws import Law
from cardume.onboard.mind import OVER_PATH, OVER_TIME, Datasheet, Grid, Orders, Setup
from cardume.paths.table import PathPlace
from cardume.signals import VesselState
from cardume.simulation.safety import Safety
from cardume.simulation.score import Rules
from cardume.world.acoustics.medium import Medium
from cardume.world.faults import FROZEN, Fault, Weakness


@dataclass(frozen=True)
class Choice:
    """A law and the parameters that differ from its defaults, SI."""

    law: Law
    parameters: dict[str, float] = field(default_factory=dict)

    def value(self, parameter: str) -> float:
        """One parameter, given or default."""
        return float(self.parameters.get(parameter, self._default(parameter)))

    def value_or(self, parameter: str, otherwise: float) -> float:
        """One parameter, given or default; of a law without it, something else."""
        return self.value(parameter) if any(p.name == parameter for p in self.law.parameters) else otherwise

    def _default(self, parameter: str) -> float:
        return next(p.default for p in self.law.parameters if p.name == parameter)


@dataclass(frozen=True)
class OrderBook:
    """What a vehicle is told beside its `Setup`.

    Attributes:
        orders: numbers.
        pace: [s] or [m], [m/s] points of v_L; none: it is that of the path's table.
        pace_over: what the first of each pair is.
        varies_along: whether v_L differs along the path.
        depth: [s] or [m], [m] points of the depth to keep; none: it is a constant.
        depth_over: what the first of each pair is.
        keeps_altitude: whether it keeps an altitude.
        has_phases: whether it has more to do than to follow its path.
        fence: [m], [m] north and east of the corners of a polygon; none: no fence or a round one.
    """

    orders: Orders = Orders()
    pace: tuple[tuple[float, float], ...] = ()
    pace_over: Literal["time", "path"] = "time"
    varies_along: bool = False
    depth: tuple[tuple[float, float], ...] = ()
    depth_over: Literal["time", "path"] = "time"
    keeps_altitude: bool = False
    has_phases: bool = False
    fence: tuple[tuple[float, float], ...] = ()

    @property
    def numbers(self) -> list[float]:
        """As the table of `onboard/mind.py` has it."""
        return [*self.orders, *(x for points in (self.pace, self.depth, self.fence) for point in points for x in point)]

    def features(self, start: int) -> list[int]:
        """The whole numbers beside it.

        Args:
            start: [-] where in the table of orders its numbers begin.
        """
        over = {"time": OVER_TIME, "path": OVER_PATH}
        pace = over[self.pace_over] if self.pace else 0, len(self.pace), int(self.varies_along)
        depth = over[self.depth_over] if self.depth else 0, len(self.depth), int(self.keeps_altitude)
        return [start, *pace, *depth, int(self.has_phases), len(self.fence)]


@dataclass(frozen=True)
class FaultPlan:
    """One thing that goes wrong; a kind of a mission file may be several.

    Attributes:
        kind: one of those of `world/faults`.
        vehicle: whose; None: of all.
        numbers: when, and by how much.
        sensor: place in SENSORS; -1: of no sensor.
        weakness: of thrusters.
        says: what it is, in words; "": it belongs to another one.
    """

    kind: int
    vehicle: str | None
    numbers: Fault
    sensor: int = -1
    weakness: Weakness = Weakness()
    says: str = ""

    @property
    def keeps_reading(self) -> bool:
        """Whether it remembers a reading, of which there is none at first."""
        return self.kind == FROZEN


@dataclass(frozen=True)
class VehiclePlan:
    """One vehicle of a mission.

    Attributes:
        name: unique in the fleet; its random numbers are named after it.
        laws: one choice per family, sensors only where it has them.
        path: (n,) path table.
        state: where and how it truly starts.
        estimate: [m] north and east where it believes it starts.
        place: where on its path it starts.
        setup: what it is told before the mission.
        orders: what more it is told, of phases, profiles and limits.
        safety: the limits of depth and altitude that it is measured by.
        datasheet: what it is told of its sensors' errors.
        medium: its modem and the water, where vehicles share the water; all of a fleet have one, or none.
        grid: what is left of the numbers that it sends; None: all.
    """

    name: str
    laws: dict[str, Choice]
    path: np.ndarray
    state: VesselState = VesselState()
    estimate: tuple[float, float] | None = None
    place: PathPlace = PathPlace()
    setup: Setup = Setup()
    orders: OrderBook = OrderBook()
    safety: Safety = Safety()
    datasheet: Datasheet = Datasheet()
    medium: Medium | None = None
    grid: Grid | None = None

    @property
    def believed_start(self) -> tuple[float, float]:
        """North and east [m] where it believes it starts: where it does, unless it is told otherwise."""
        return self.estimate or (self.state.north, self.state.east)


@dataclass(frozen=True)
class Plan:
    """A mission, ready to become tables.

    Attributes:
        vehicles: in the order in which results are reported.
        hears: (vehicle, vehicle) 1 where the vehicle of the row coordinates with that of the column.
        duration: [s]
        seed: of all randomness.
        tick: [s] between decisions.
        plant_step: [s] between steps of autopilots and hulls; a whole part of the tick.
        log_period: [s] between records; 0: no log.
        field: (n,) table of a gridded current.
        rules: what the metrics count.
        seabed: (n,) table of a gridded seabed.
        separation: [m] that two vehicles are not to come nearer; 0: no limit.
        is_watched: whether anything of depth, altitude, geofence or separation is limited.
        faults: what goes wrong.
    """

    vehicles: tuple[VehiclePlan, ...]
    hears: np.ndarray
    duration: float
    seed: int = 0
    tick: float = 0.1
    plant_step: float = 0.05
    log_period: float = 1.0
    field: np.ndarray = field(default_factory=lambda: np.zeros(1))
    rules: Rules = Rules()
    seabed: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(1))
    separation: float = 0.0
    is_watched: bool = False
    faults: tuple[FaultPlan, ...] = ()

    @property
    def num_ticks(self) -> int:
        """How many ticks the mission lasts."""
        return round(self.duration / self.tick)

    @property
    def substeps(self) -> int:
        """Plant steps in a tick."""
        return max(1, round(self.tick / self.plant_step))

    @property
    def order(self) -> list[int]:
        """The vehicles sorted by name: the order inside the engine, so that sums do not depend on the file's."""
        return sorted(range(len(self.vehicles)), key=lambda k: self.vehicles[k].name)
