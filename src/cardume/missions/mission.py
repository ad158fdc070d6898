"""The records a mission file becomes: every default filled in, SI, radians, NED, frozen.

In a mission that is not drawn yet (`is_fixed` false) any number, word or whole section may be a
record of `distributions` instead; after `draw` all are what their annotation says.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cardume.errors import MissionError, Position, Problem
from cardume.missions.faults import FAULTS, AnyFault
from cardume.missions.route import PATHS, AnyPath
from cardume.missions.schema import (
    NOT_NEGATIVE,
    POSITIVE,
    Bounds,
    Default,
    Group,
    Laws,
    ListOf,
    Name,
    Profile,
    Profiled,
    Quantity,
    Requirements,
    Variant,
    Whole,
)
from cardume.missions.vehicle import LawChoice, Vehicle

if TYPE_CHECKING:
    from cardume.missions.catalog import Context

FORMAT_VERSION = 1
TICKS = Bounds(1e-4, 60.0)
STILL: Mapping[str, Any] = {"none": LawChoice(family="current", name="none")}


@dataclass(frozen=True, slots=True, kw_only=True)
class Origin:
    """Where north = east = 0 lies on the Earth, WGS 84."""

    latitude: Annotated[float, Quantity("rad", Bounds(-math.pi / 2, math.pi / 2)), "north positive"]
    longitude: Annotated[float, Quantity("rad", Bounds(-math.pi, 2 * math.pi)), "east positive"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Formation:
    """How fast the formation goes; None where every piece of the path says it."""

    speed: Annotated[
        float | Profile | None,
        Profiled("m/s", POSITIVE),
        "v_L, along the reference path; a constant, or a profile of time or path",
    ] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Transient:
    """When a vehicle has settled: its cross-track error stayed below `threshold` for `hold`."""

    threshold: Annotated[float, Quantity("m", POSITIVE), "of the true cross-track error"] = 0.5
    hold: Annotated[float, Quantity("s", NOT_NEGATIVE), "for how long"] = 10.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Requirement:
    """A limit on a metric, SI; of the fleet (its worst vehicle) where `vehicle` is None."""

    metric: str
    limit: float
    unit: str
    vehicle: str | None = None


def _default_plant_step(values: Mapping[str, Any], _context: Context) -> Any:
    """The longest step up to 0.05 s of which the tick, or the shortest of several, is a whole multiple."""
    tick = values.get("tick", 0.1)
    shortest = min(getattr(tick, "options", (tick,)))
    return shortest / math.ceil(shortest / 0.05 - 1e-9)


def _default_log_period(values: Mapping[str, Any], _context: Context) -> Any:
    """The whole multiple of the tick nearest to 1 s."""
    tick = values.get("tick")
    return tick * max(1, round(1.0 / tick)) if isinstance(tick, float) else 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Mission:
    """A whole mission."""

    cardume: Annotated[int, Whole(FORMAT_VERSION, FORMAT_VERSION, fixed=True), "the version of the format"]
    name: Annotated[str, Name(fixed=True), "what it is called"]
    seed: Annotated[int, Whole(fixed=True), "of all that is random"] = 0
    duration: Annotated[float, Quantity("s", Bounds(0.0, 30 * 86_400.0, low_open=True)), "how long it lasts"]
    tick: Annotated[float, Quantity("s", TICKS, in_ticks=True), "how often vehicles sense, decide and speak"] = 0.1
    plant_step: Annotated[
        float, Quantity("s", Bounds(1e-5, 60.0), in_ticks=True), Default(_default_plant_step), "of the motion"
    ]
    log_period: Annotated[
        float, Quantity("s", POSITIVE, in_ticks=True), Default(_default_log_period), "between rows of the log"
    ]
    origin: Annotated[Origin | None, Group(Origin), "needed for maps and gridded currents"] = None
    path: Annotated[AnyPath, Variant(PATHS), "the reference path of the formation"]
    formation: Annotated[Formation, Group(Formation), "how fast the formation goes"]
    current: Annotated[LawChoice, Laws("current", "type", "none", words=STILL), "how the water moves"]
    bathymetry: Annotated[
        LawChoice | None, Laws("bathymetry", "type", "none", words={"none": None}), "how deep the sea is"
    ] = None
    vehicles: Annotated[tuple[Vehicle, ...], ListOf(Group(Vehicle), fixed=True), "the fleet"]
    transient: Annotated[Transient, Group(Transient), "what is left out of the metrics"] = Transient()
    swath: Annotated[float | None, Quantity("m", POSITIVE), "width that a vehicle's sonar covers"] = None
    require: Annotated[
        tuple[Requirement, ...], Requirements(Requirement, fixed=True), "limits that make the verdict"
    ] = ()
    faults: Annotated[
        tuple[AnyFault, ...], ListOf(Variant(FAULTS, selector="kind"), fixed=True), "what goes wrong, and when"
    ] = ()
    positions: Mapping[str, Position] = field(default_factory=dict, compare=False, repr=False)

    @property
    def is_fixed(self) -> bool:
        """Whether every value is a plain one, neither drawn nor swept."""
        from cardume.missions.distributions import varying_values

        return not varying_values(self)

    @property
    def adjacency(self) -> tuple[tuple[float, ...], ...]:
        """Who hears whom: (num_vehicles, num_vehicles), rows are listeners."""
        topology, size = self.vehicles[0].coordination.topology, len(self.vehicles)
        if not isinstance(topology, str):
            return topology
        return tuple(tuple(float(_hears(topology, size, i, j)) for j in range(size)) for i in range(size))

    def where(self, key: str) -> Position:
        """Where a value was given; of one left out, where the nearest section around it was.

        A vehicle's value may have been given for the whole fleet, which is then where it is.

        Args:
            key: full name of a value, as `vehicles.port.offset.starboard`.
        """
        return find_position(self.positions, key)

    def error(self, key: str, message: str) -> MissionError:
        """A `MissionError` about one value, to raise.

        Args:
            key: full name of the value.
            message: what was given, what is valid, what to do.
        """
        return MissionError([Problem(self.where(key), message)])

    def to_yaml(self, directory: Path | None = None) -> str:
        """The mission as a file that reads back to an equal mission, every default written.

        Args:
            directory: where the file will lie; files are named relative to it, else absolutely.
        """
        from cardume.missions.saving import to_yaml

        return to_yaml(self, directory)


def find_position(positions: Mapping[str, Position], key: str) -> Position:
    """The position of a key, or of the nearest section around it; see `Mission.where`."""
    words = key.split(".")
    prefix = words[:2] if words[0] == "vehicles" else []
    rest = words[len(prefix) :]
    for end in range(len(rest), 0, -1):
        for of in (prefix, []) if prefix else ([],):
            found = positions.get(".".join(of + rest[:end]))
            if found is not None:
                return found._replace(key=".".join(of + rest))
    found = positions.get(".".join(prefix)) or positions.get("") or Position("the mission", 0, key)
    return found._replace(key=key)


def _hears(topology: str, size: int, listener: int, speaker: int) -> bool:
    apart = abs(listener - speaker)
    return (
        apart > 0
        and {
            "complete": True,
            "star": 0 in (listener, speaker),
            "path": apart == 1,
            "ring": apart in (1, size - 1),
        }[topology]
    )
