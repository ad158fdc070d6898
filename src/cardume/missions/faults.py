"""The faults that a mission file may schedule: one record a kind, and what vehicles do about each.

Every one has the vehicle it happens to, `from`, and `to` or `lasts`; without either it lasts until the end.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from cardume.missions.schema import NOT_NEGATIVE, POSITIVE, Bounds, Member, Quantity, Word

Whose = Annotated[str, Member(), "to whom it happens"]
Begin = Annotated[float, Quantity("s", NOT_NEGATIVE), "when it begins"]
End = Annotated[float | None, Quantity("s", NOT_NEGATIVE), "when it ends"]
Lasting = Annotated[float | None, Quantity("s", POSITIVE), "for how long, instead of to"]
Share = Bounds(0.0, 1.0)
SENSORS = ("gnss", "ahrs", "depth", "usbl", "dvl", "thruster_speed", "altimeter")
WhichSensor = Annotated[str, Word(SENSORS), "that it carries"]
Meters = Annotated[float | None, Quantity("m")]
WhoseOrAll = Annotated[str | None, Member(), "to whom it happens; left out: to all"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ModemSilent:
    """The modem neither sends nor hears nor answers a USBL head."""

    vehicle: Whose
    from_: Begin
    to: End = None
    lasts: Lasting = None


@dataclass(frozen=True, slots=True, kw_only=True)
class GnssLost:
    """No position by GNSS."""

    vehicle: Whose
    from_: Begin
    to: End = None
    lasts: Lasting = None


@dataclass(frozen=True, slots=True, kw_only=True)
class UsblOutlier:
    """Some readings of a USBL head are of echoes."""

    vehicle: Whose
    from_: Begin
    to: End = None
    lasts: Lasting = None
    probability: Annotated[float, Quantity("", Share), "of each reading"] = 0.1
    size: Annotated[float, Quantity("m", POSITIVE), "how far beside the target, anywhere level with it"] = 20.0


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorFrozen:
    """A sensor repeats its last reading."""

    vehicle: Whose
    from_: Begin
    to: End = None
    lasts: Lasting = None
    sensor: WhichSensor


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorBiased:
    """A sensor reads too much: of the quantities of that sensor one or more are given."""

    vehicle: Whose
    from_: Begin
    to: End = None
    lasts: Lasting = None
    sensor: WhichSensor
    heading: Annotated[float | None, Quantity("rad", Bounds(-math.pi, math.pi)), "by ahrs, > 0 too far clockwise"] = (
        None
    )
    depth: Annotated[Meters, "by depth, > 0 too deep"] = None
    altitude: Annotated[Meters, "by altimeter, > 0 too high"] = None
    north: Annotated[Meters, "by gnss"] = None
    east: Annotated[Meters, "by gnss"] = None
    range: Annotated[Meters, "by usbl"] = None
    azimuth: Annotated[float | None, Quantity("rad", Bounds(-math.pi, math.pi)), "by usbl, > 0 to starboard"] = None
    surge: Annotated[float | None, Quantity("m/s"), "by dvl"] = None
    shaft_speed: Annotated[float | None, Quantity("rad/s"), "by thruster_speed"] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorNan:
    """A sensor says NaN."""

    vehicle: Whose
    from_: Begin
    to: End = None
    lasts: Lasting = None
    sensor: WhichSensor


@dataclass(frozen=True, slots=True, kw_only=True)
class ThrusterWeak:
    """Thrusters push with a share of the force that they are told, or not at all."""

    vehicle: Whose
    from_: Begin
    to: End = None
    lasts: Lasting = None
    thruster: Annotated[str, Word(("port", "starboard", "horizontal", "vertical", "all")), "which"] = "horizontal"
    efficiency: Annotated[float, Quantity("", Share), "what is left of the force; 0: dead"] = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class VehicleLost:
    """The vehicle has no power: no thrust, no modem; it drifts at its depth."""

    vehicle: Whose
    from_: Begin
    to: End = None
    lasts: Lasting = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ClockOffset:
    """A clock is set wrong."""

    vehicle: Whose
    from_: Begin
    to: End = None
    lasts: Lasting = None
    offset: Annotated[float, Quantity("s", Bounds(-3600.0, 3600.0)), "> 0 is ahead of time"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ClockDrift:
    """A clock runs too fast or too slow."""

    vehicle: Whose
    from_: Begin
    to: End = None
    lasts: Lasting = None
    drift: Annotated[float, Quantity("", Bounds(-0.1, 0.1)), "> 0 is too fast; 1e-4 loses 0.1 s in 1000 s"]


@dataclass(frozen=True, slots=True, kw_only=True)
class CurrentStep:
    """The water moves otherwise of a sudden, on top of any current."""

    vehicle: WhoseOrAll = None
    from_: Begin
    to: End = None
    lasts: Lasting = None
    speed: Annotated[float, Quantity("m/s", Bounds(0.0, 5.0)), "of the change"]
    towards: Annotated[float, Quantity("rad", Bounds(-2 * math.pi, 2 * math.pi)), "clockwise from north"] = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ForgedPackets:
    """Somebody sends packets in the vehicle's name that tell all positions and states wrong."""

    vehicle: Whose
    from_: Begin
    to: End = None
    lasts: Lasting = None
    size: Annotated[float, Quantity("m"), "of fixes to the north, of states ahead"] = 20.0
    period: Annotated[float, Quantity("s", POSITIVE), "between packets"] = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ReplayedPackets:
    """Somebody records a packet of the vehicle and sends it again and again."""

    vehicle: Whose
    from_: Begin
    to: End = None
    lasts: Lasting = None
    period: Annotated[float, Quantity("s", POSITIVE), "between packets"] = 1.0


AnyFault = (
    ModemSilent
    | GnssLost
    | UsblOutlier
    | SensorFrozen
    | SensorBiased
    | SensorNan
    | ThrusterWeak
    | VehicleLost
    | ClockOffset
    | ClockDrift
    | CurrentStep
    | ForgedPackets
    | ReplayedPackets
)
FAULTS: Mapping[str, type] = {
    "modem_silent": ModemSilent,
    "gnss_lost": GnssLost,
    "usbl_outlier": UsblOutlier,
    "sensor_frozen": SensorFrozen,
    "sensor_biased": SensorBiased,
    "sensor_nan": SensorNan,
    "thruster_weak": ThrusterWeak,
    "vehicle_lost": VehicleLost,
    "clock_offset": ClockOffset,
    "clock_drift": ClockDrift,
    "current_step": CurrentStep,
    "forged_packets": ForgedPackets,
    "replayed_packets": ReplayedPackets,
}
REACTIONS: Mapping[str, str] = {
    "modem_silent": (
        "It reckons without fixes; the others predict it, and after `coordination.silence` go on without "
        "it, slow down or hold their places; when it is back they close up."
    ),
    "gnss_lost": (
        "It reckons, and all who are seen by it with it: the fleet drifts by what its speed and current "
        "are believed wrong, and keeps its shape."
    ),
    "usbl_outlier": "The filter's gate leaves them out; `reset` follows each until the next fix.",
    "sensor_frozen": (
        "Found by repetition, where the sensor is told to be noisy or should have changed; then as one that says NaN."
    ),
    "sensor_biased": "Not found by the vehicle itself: it goes on, wrong by the bias and no more than that.",
    "sensor_nan": (
        "Rejected. Without a heading it stops and keeps the last one; without a speed it takes the one it "
        "asked for; without a depth it leaves the depth as it is; without fixes it reckons."
    ),
    "thruster_weak": (
        "The integrals of the autopilot make up for what they can; a vehicle that cannot keep up is "
        "waited for by coordination."
    ),
    "vehicle_lost": "As a silent modem for the others; for the metrics its path is over.",
    "clock_offset": (
        "Ages are wrong by as much, positions and states by the speed times that; nothing is believed to "
        "come from the future, and when clocks agree again nothing stays behind."
    ),
    "clock_drift": "As an offset that grows.",
    "current_step": "The observer finds it and compensation turns against it.",
    "forged_packets": (
        "With authentication none is taken, but for one in 2^(8 n), n its bytes; without it the gate of "
        "the filter leaves the fixes out, and states turn speeds by no more than the gain."
    ),
    "replayed_packets": (
        "With authentication none is taken; without it each is older than what is known, and changes nothing."
    ),
}
"""What vehicles do about each, as docs/faults.md and its tests have it."""
