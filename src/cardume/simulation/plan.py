"""A mission as the engine takes it: laws, numbers and path tables, one record per vehicle."""

from dataclasses import dataclass, field

import numpy as np

from cardume.laws import Law
from cardume.onboard.mind import Setup
from cardume.paths.table import PathPlace
from cardume.signals import VesselState
from cardume.simulation.score import Rules


@dataclass(frozen=True)
class Choice:
    """A law and the parameters that differ from its defaults, SI."""

    law: Law
    parameters: dict[str, float] = field(default_factory=dict)

    def value(self, parameter: str) -> float:
        """One parameter, given or default."""
        return float(self.parameters.get(parameter, self._default(parameter)))

    def _default(self, parameter: str) -> float:
        return next(p.default for p in self.law.parameters if p.name == parameter)


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
    """

    name: str
    laws: dict[str, Choice]
    path: np.ndarray
    state: VesselState = VesselState()
    estimate: tuple[float, float] | None = None
    place: PathPlace = PathPlace()
    setup: Setup = Setup()


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

    @property
    def num_ticks(self) -> int:
        """How many ticks the mission lasts."""
        return round(self.duration / self.tick)

    @property
    def order(self) -> list[int]:
        """The vehicles sorted by name: the order inside the engine, so that sums do not depend on the file's."""
        return sorted(range(len(self.vehicles)), key=lambda k: self.vehicles[k].name)
