"""What a mission file says of a vehicle that moves about the others, so that its ranges to them tell more."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from cardume.missions.route import Angle, PositiveMeters
from cardume.missions.schema import NOT_NEGATIVE, POSITIVE, Quantity

Fastest = Annotated[float, Quantity("m/s", POSITIVE)]


@dataclass(frozen=True, slots=True, kw_only=True)
class CircleManeuver:
    """Around the vehicles below, clockwise seen from them, always at the same speed over ground."""

    speed_max: Annotated[Fastest, "over ground"]
    radius: Annotated[PositiveMeters, "from where they are to be"]
    bearing: Annotated[Angle, "from them, at first"] = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class SpiralManeuver:
    """Around the vehicles below, farther with every turn."""

    speed_max: Annotated[Fastest, "over ground"]
    radius: Annotated[PositiveMeters, "from where they are to be, at first"]
    growth: Annotated[float, Quantity("m/s", NOT_NEGATIVE), "of the radius"]
    bearing: Annotated[Angle, "from them, at first"] = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ZigzagManeuver:
    """From side to side, behind the vehicles below."""

    speed_max: Annotated[Fastest, "over ground"]
    width: Annotated[PositiveMeters, "from one side to the other"]
    astern: Annotated[float, Quantity("m", NOT_NEGATIVE), "how far behind them"] = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class BestManeuver:
    """The circle or zig-zag whose ranges tell the vehicles below most: the largest log det of the information."""

    speed_max: Annotated[Fastest, "over ground"]
    nearest: Annotated[PositiveMeters, "that it may come to them, in plan"] = 5.0
    farthest: Annotated[PositiveMeters, "that it may go from them"] = 40.0


MANEUVERS = {"circle": CircleManeuver, "spiral": SpiralManeuver, "zigzag": ZigzagManeuver, "best": BestManeuver}
AnyManeuver = CircleManeuver | SpiralManeuver | ZigzagManeuver | BestManeuver
