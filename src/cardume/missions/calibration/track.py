"""What a calibration looks at: shaft speed, and how the vehicle moved."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from cardume.vehicles import medusa_data as farol


class Numbers(NamedTuple):
    """What is believed of thrusters and hull: those of (37), and the scale that the mission had."""

    thrust_coefficient: float = farol.THRUST_COEFFICIENT  # [N s^2/rad^2] c, of each thruster
    num_thrusters: float = farol.NUM_HORIZONTAL_THRUSTERS  # [-] N
    linear_drag: float = farol.SURGE_DRAG  # [N s/m] d
    quadratic_drag: float = farol.SURGE_DRAG_QUADRATIC  # [N s^2/m^2] D
    scale: float = 1.0  # [-] that the mission multiplied with

    def thrust(self, shaft_speed: np.ndarray) -> np.ndarray:
        """N c n |n| [N].

        Args:
            shaft_speed: [rad/s] (n,)
        """
        thrust: np.ndarray = self.num_thrusters * self.thrust_coefficient * shaft_speed * np.abs(shaft_speed)
        return thrust


@dataclass(frozen=True, kw_only=True, eq=False)
class Track:
    """One vehicle's way; arrays (n,). Either `speed` is there, or heading, north and east.

    Attributes:
        name: of the vehicle, or of the file.
        numbers: what is believed of it.
        time: [s] increasing.
        shaft_speed: [rad/s]
        heading: [rad]
        north, east: [m] over ground.
        speed: [m/s] through the water.
    """

    name: str
    numbers: Numbers
    time: np.ndarray
    shaft_speed: np.ndarray
    heading: np.ndarray | None = None
    north: np.ndarray | None = None
    east: np.ndarray | None = None
    speed: np.ndarray | None = None

    def part(self, rows: slice | np.ndarray) -> "Track":
        """Some rows of it.

        Args:
            rows: [-] which.
        """
        return replace(
            self,
            time=self.time[rows],
            shaft_speed=self.shaft_speed[rows],
            heading=None if self.heading is None else self.heading[rows],
            north=None if self.north is None else self.north[rows],
            east=None if self.east is None else self.east[rows],
            speed=None if self.speed is None else self.speed[rows],
        )
