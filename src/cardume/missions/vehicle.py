"""What a mission file says of one vehicle: its place, what it carries, and the laws it runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Any

from cardume.missions.maneuver import MANEUVERS, AnyManeuver
from cardume.missions.route import Angle, Meters, Point
from cardume.missions.schema import (
    NOT_NEGATIVE,
    POSITIVE,
    Bounds,
    Default,
    Forms,
    Graph,
    Group,
    Laws,
    ListOf,
    Name,
    Profile,
    Profiled,
    Quantity,
    Shared,
    Variant,
    Word,
    fields_of,
)

if TYPE_CHECKING:
    from cardume.missions.catalog import Context

MetersPerSecond = Annotated[float, Quantity("m/s")]
SecondsOrNone = Annotated[float | None, Quantity("s", POSITIVE)]
DEPTHS = Bounds(0.0, 12_000.0)
Depth = Quantity("m", DEPTHS)
Topology = str | tuple[tuple[float, ...], ...]


class Table(Mapping[str, Any]):
    """A small immutable mapping that compares, hashes and pickles."""

    __slots__ = ("_items",)

    def __init__(self, items: Mapping[str, Any] | None = None) -> None:
        self._items = dict(items or {})

    def __getitem__(self, key: str) -> Any:
        return self._items[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __hash__(self) -> int:
        return hash(frozenset(self._items.items()))

    def __repr__(self) -> str:
        return repr(self._items)


@dataclass(frozen=True, slots=True, kw_only=True)
class LawChoice:
    """A law and the value of each of its parameters, SI; `none` has no parameters."""

    family: str
    name: str
    parameters: Table = field(default_factory=Table)
    units: Table = field(default_factory=Table, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Offset:
    """A vehicle's place in the formation, seen along the reference path."""

    ahead: Annotated[Meters, "ahead of the formation's point"] = 0.0
    starboard: Annotated[Meters, "to starboard of the reference path"] = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class RelativeStart:
    """Where a vehicle starts, seen from the start of its own path."""

    along_track: Annotated[Meters, "ahead of the path's start"] = 0.0
    cross_track: Annotated[Meters, "to starboard of the path"] = 0.0
    heading_error: Annotated[Angle, "clockwise from the path's course"] = 0.0
    speed: Annotated[MetersPerSecond, "through the water"] = 0.0
    depth: Annotated[float | None, Depth, "left out: the depth to keep, or 0 where it dives first"] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class AbsoluteStart:
    """Where a vehicle starts, NED."""

    north: Annotated[Meters, "north of the origin"]
    east: Annotated[Meters, "east of the origin"]
    heading: Annotated[Angle, "clockwise from north"] = 0.0
    speed: Annotated[MetersPerSecond, "through the water"] = 0.0
    depth: Annotated[float | None, Depth, "left out: the depth to keep, or 0 where it dives first"] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Guidance:
    """The law that steers, and how the vehicle's place on its path is found."""

    law: Annotated[LawChoice, Laws("guidance", default="line_of_sight", inlined=True)]
    reference_point: Annotated[LawChoice, Laws("reference_point", "reference_point", "projection", inlined=True)]


NOT_AT_ALL: Mapping[str, Any] = {"none": None}


@dataclass(frozen=True, slots=True, kw_only=True)
class Silence:
    """What a vehicle does where a neighbor has been silent for long, until it is heard again."""

    after: Annotated[float, Quantity("s", POSITIVE), "without news of a neighbor"] = 30.0
    do: Annotated[str, Word(("go_on", "slow_down", "hold")), "without it, slower, or not at all"] = "go_on"
    share: Annotated[float, Quantity("", Bounds(0.0, 1.0)), "of the speed along the path, for slow_down"] = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Coordination:
    """The law that corrects the speed, and who hears whom: one graph for the whole fleet."""

    law: Annotated[LawChoice, Laws("coordination", default="laplacian_tanh", inlined=True)]
    topology: Annotated[Topology, Graph(), "star: the first vehicle is the hub; a matrix's rows are listeners"] = (
        "complete"
    )
    silence: Annotated[
        Silence | None, Group(Silence, words=NOT_AT_ALL), "left out: it is thought to go on as it did"
    ] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ThrusterSpeed:
    """The sensor of shaft speed, and how its readings become speed through the water."""

    law: Annotated[LawChoice, Laws("thruster_speed", inlined=True)]
    reader: Annotated[LawChoice, Laws("speed", "reader", "thruster_calibration", inlined=True)]


NO_SENSOR: Mapping[str, Any] = {"none": None}


@dataclass(frozen=True, slots=True, kw_only=True)
class Sensors:
    """The sensors a vehicle carries, None where it has none; `ideal` ones are exact and immediate."""

    ideal: bool = False
    gnss: Annotated[LawChoice | None, Laws("gnss", words=NO_SENSOR), "position, at the surface"] = None
    ahrs: Annotated[LawChoice | None, Laws("ahrs", words=NO_SENSOR), "heading and yaw rate"] = None
    depth: Annotated[LawChoice | None, Laws("depth", words=NO_SENSOR), "depth, from pressure"] = None
    usbl: Annotated[LawChoice | None, Laws("usbl", words=NO_SENSOR), "where the others are, by sound"] = None
    dvl: Annotated[LawChoice | None, Laws("dvl", default="dvl", words=NO_SENSOR), "velocity, by sound"] = None
    altimeter: Annotated[LawChoice | None, Laws("altimeter", words=NO_SENSOR), "altitude, by sound"] = None
    thruster_speed: Annotated[
        ThrusterSpeed | None, Group(ThrusterSpeed, words=NO_SENSOR), "shaft speed; `scale` is a of eq. (38)"
    ] = None


IDEAL: Mapping[str, Any] = {"ideal": Sensors(ideal=True)}
SILENT: Mapping[str, Any] = {"none": LawChoice(family="messaging", name="silent")}


def _default_sensors(values: Mapping[str, Any], context: Context) -> Any:
    model, depth, altitude = values.get("model"), values.get("depth", 0.0), values.get("altitude")
    kinds = context.catalog.default_sensors(getattr(model, "name", ""), depth != 0.0 or altitude is not None)
    if isinstance(kinds, str):
        return kinds
    return {kind: {} for kind in (*kinds, *(("altimeter",) if altitude is not None else ()))}


def _unless_alone(section: str, alone: str) -> Default:
    return Default(lambda _values, context: alone if len(context.fleet) == 1 else {})


@dataclass(frozen=True, slots=True, kw_only=True)
class Dive:
    """How a vehicle goes down before it sets out."""

    tolerance: Annotated[float, Quantity("m", POSITIVE), "of the depth, within which it is down"] = 0.5
    timeout: Annotated[SecondsOrNone, "after which it goes on all the same; left out: never"] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Gather:
    """How a vehicle waits at its start for those it hears."""

    radius: Annotated[float, Quantity("m", POSITIVE), "of its start, within which it is there"] = 2.0
    timeout: Annotated[SecondsOrNone, "after which it goes without them; left out: never"] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Phases:
    """What a vehicle does before and after its path."""

    dive: Annotated[Dive | None, Group(Dive, words=NOT_AT_ALL), "first down, at its start"] = None
    gather: Annotated[Gather | None, Group(Gather, words=NOT_AT_ALL), "then wait for the others"] = None
    hold: Annotated[float | None, Quantity("s", NOT_NEGATIVE), "how long at the end before `end: surface`"] = None
    circle: Annotated[
        float | None, Quantity("m", POSITIVE), "radius on which it waits; left out: it holds its place"
    ] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RoundFence:
    """A round geofence."""

    centre: Annotated[Point, Group(Point), "of the circle"] = Point(north=0.0, east=0.0)
    radius: Annotated[float, Quantity("m", POSITIVE), "that is not to be left"]


@dataclass(frozen=True, slots=True, kw_only=True)
class PolygonFence:
    """A geofence with corners."""

    polygon: Annotated[tuple[Point, ...], ListOf(Group(Point)), "its corners, at least three, in order"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """What a vehicle is never to go beyond; each is required of the flight."""

    depth: Annotated[float | None, Depth, "largest"] = None
    altitude: Annotated[float | None, Quantity("m", NOT_NEGATIVE), "least height above the seabed"] = None
    geofence: Annotated[
        RoundFence | PolygonFence | None, Forms((RoundFence, PolygonFence)), "region not to be left"
    ] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Abort:
    """When a vehicle gives up: beyond one of its limits as it believes, or as said here."""

    to: Annotated[str, Word(("surface", "hold")), "what it does then, where it is"] = "surface"
    silence: Annotated[SecondsOrNone, "without hearing anybody"] = None
    time: Annotated[SecondsOrNone, "since the start of the mission"] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Vehicle:
    """One vehicle of the fleet; every section resolved, whether it was given here or for the fleet."""

    name: Annotated[str, Name(fixed=True), "unique in the fleet"]
    model: Annotated[LawChoice, Laws("model", default="medusa", announces=True), Shared(), "how it moves"]
    depth: Annotated[float | Profile, Profiled("m", DEPTHS), "to keep; a constant, or a profile of time or path"] = 0.0
    altitude: Annotated[
        float | None, Quantity("m", POSITIVE), "above the seabed to keep, instead of a depth; needs an altimeter"
    ] = None
    offset: Annotated[Offset, Group(Offset), "its place in the formation"] = Offset()
    maneuver: Annotated[
        AnyManeuver | None,
        Variant(MANEUVERS, words={"none": None}),
        "instead: how it moves about those below, so that its ranges tell more",
    ] = None
    start: Annotated[
        RelativeStart | AbsoluteStart, Forms((RelativeStart, AbsoluteStart)), "where it is when the mission begins"
    ] = RelativeStart()
    initial_estimate: Annotated[Point | None, Group(Point), "where it believes it begins"] = None
    sensors: Annotated[Sensors, Group(Sensors, words=IDEAL), Shared(), Default(_default_sensors), "what it carries"]
    guidance: Annotated[Guidance, Group(Guidance), Shared(), "the course back to the path"]
    compensation: Annotated[LawChoice, Laws("compensation", default="none"), Shared(), "heading against the current"]
    current_observer: Annotated[LawChoice, Laws("current_observer", default="none"), Shared(), "what the current is"]
    position: Annotated[LawChoice, Laws("position", default="reset"), Shared(), "where it is"]
    neighbors: Annotated[LawChoice, Laws("neighbors", default="coordinated"), Shared(), "how far the others are"]
    coordination: Annotated[
        Coordination, Group(Coordination), Shared(), _unless_alone("coordination", "none"), "keeping together"
    ]
    speed_reference: Annotated[str, Word(("ground", "water")), Shared(), "what the speed along the path is over"] = (
        "ground"
    )
    messaging: Annotated[
        LawChoice,
        Laws("messaging", "schedule", "periodic", words=SILENT),
        Shared(),
        _unless_alone("messaging", "none"),
        "when it speaks",
    ]
    acoustics: Annotated[
        LawChoice, Laws("acoustics", "channel", "ideal"), Shared(), "what becomes of messages on the way to it"
    ]
    autopilot: Annotated[LawChoice, Laws("autopilot"), Shared(), "from course and speed to forces"]
    end: Annotated[str, Word(("hold", "surface", "continue")), Shared(), "what it does at the end of the path"] = "hold"
    phases: Annotated[Phases | None, Group(Phases, words=NOT_AT_ALL), Shared(), "before and after the path"] = None
    limits: Annotated[Limits | None, Group(Limits, words=NOT_AT_ALL), Shared(), "never to be exceeded"] = None
    abort: Annotated[Abort | None, Group(Abort, words=NOT_AT_ALL), Shared(), "when it gives up"] = None


SHARED = {field.key: field for field in fields_of(Vehicle) if field.shared}
"""The sections that may stand at the top of the file, for the whole fleet."""
