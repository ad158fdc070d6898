"""What becomes of a fleet under each fault: the missions, what is measured of them, and the table of docs/faults.md.

`python tests/acceptance/fault_table.py` (with src and tests on the path) writes the table anew.
"""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass, field
from functools import cache
from pathlib import Path

import numpy as np

from cardume.simulation.flight import Flight
from flying import fly_text

DOC = Path(__file__).parents[2] / "docs" / "faults.md"
BEGIN, END, DURATION = 100.0, 160.0, 300.0  # [s]
AFTER = 250.0  # [s] from when all is to be well again
TEXT = """
cardume: 1
name: faulty
seed: 7
duration: 300 s
path: {type: lawnmower, leg: 60 m, legs: 3, spacing: 24 m, turn: starboard}
formation: {speed: 0.5 m/s}
current: {type: uniform, speed: 0.1 m/s, towards: 60 deg}
bathymetry: {type: flat, depth: 25 m}
vehicles:
  - {name: surface, sensors: {gnss: {sigma: 0.3 m}, usbl: {}}}
  - {name: port, depth: 10 m, offset: {starboard: -3 m}, sensors: {dvl: {}, altimeter: {}}}
  - {name: starboard, depth: 10 m, offset: {starboard: 3 m}}
model: medusa
autopilot: {speed_bandwidth: 0.3 1/s}
guidance: {law: line_of_sight, lookahead: 5 m}
compensation: {law: crab}
current_observer: {law: from_position}
position: {law: kalman_replay}
coordination: {law: laplacian_tanh, gain: 0.15 m/s, length_scale: 1 m, topology: star}
messaging: {schedule: periodic, period: 1 s, offset: 0.1 s}
acoustics: {channel: bernoulli, loss: 0.2, delay: 0.3 s}
"""
RESET = ("position.law=reset", "current_observer={law: complementary, k1: 0.2, k2: 0.01}")
SEALED = ("acoustics={channel: modem, authentication: 4}", "messaging={schedule: tdma}")
GO_ON = ("coordination.silence={after: 10 s, do: go_on}",)
SLOW_DOWN = ("coordination.silence={after: 10 s, do: slow_down}",)
HOLD = ("coordination.silence={after: 10 s, do: hold}",)
FLEET = ("surface", "port", "starboard")


@dataclass(frozen=True)
class Limits:
    """What is measured at worst, and what it may be.

    Attributes:
        position: [m] believed minus true position.
        cross_track: [m] true.
        spread: [m] of the true coordination states.
        depth: [m] true less wanted.
    """

    position: float
    cross_track: float
    spread: float
    depth: float = 0.1


HEALTHY = Limits(0.6, 0.8, 1.2)
HEALTHY_BY_RESET = Limits(1.6, 1.2, 1.5)


@dataclass(frozen=True)
class Case:
    """One fault in one mission.

    Attributes:
        fault: its keys, without times.
        note: what of the mission is special, in words.
        during: limits while it lasts.
        overrides: of the mission.
        counted: the vehicles that are measured.
        after: limits from AFTER on.
        lasts: whether it ends at END; else at the end of the mission.
        doubted: the vehicle that finds its sensor at fault, and how long that may take [s].
    """

    fault: str
    during: Limits
    note: str = ""
    overrides: tuple[str, ...] = ()
    counted: tuple[str, ...] = FLEET
    after: Limits = field(default=HEALTHY)
    lasts: bool = True
    doubted: tuple[str, float] | None = None

    @property
    def kind(self) -> str:
        """The kind of the fault."""
        return self.fault.split(",")[0].removeprefix("kind: ")

    @property
    def text(self) -> str:
        """The mission."""
        until = f", to: {END:g} s" if self.lasts else ""
        return f"{TEXT}faults:\n  - {{{self.fault}, from: {BEGIN:g} s{until}}}\n"


CASES = (
    Case("kind: modem_silent, vehicle: port", Limits(0.6, 0.8, 1.2), "the others think it goes on"),
    Case("kind: modem_silent, vehicle: port", Limits(0.6, 0.8, 1.2), "silence: go_on", GO_ON),
    Case("kind: modem_silent, vehicle: port", Limits(0.6, 0.8, 8.0), "silence: slow_down", SLOW_DOWN),
    Case("kind: modem_silent, vehicle: port", Limits(1.5, 1.0, 20.0), "silence: hold", HOLD),
    Case("kind: gnss_lost, vehicle: surface", Limits(1.5, 1.2, 1.5)),
    Case("kind: usbl_outlier, vehicle: surface, probability: 0.2, size: 20 m", Limits(0.6, 0.8, 1.2)),
    Case(
        "kind: usbl_outlier, vehicle: surface, probability: 0.2, size: 20 m",
        Limits(22.0, 5.0, 15.0),
        "position: reset",
        RESET,
        after=HEALTHY_BY_RESET,
    ),
    Case("kind: sensor_frozen, vehicle: surface, sensor: gnss", Limits(1.5, 1.2, 1.5), doubted=("surface", 1.0)),
    Case("kind: sensor_frozen, vehicle: port, sensor: ahrs", Limits(1.0, 5.0, 20.0), doubted=("port", 5.5)),
    Case("kind: sensor_frozen, vehicle: port, sensor: depth", Limits(0.6, 0.8, 1.2), doubted=("port", 5.5)),
    Case("kind: sensor_frozen, vehicle: surface, sensor: usbl", Limits(1.2, 1.0, 1.2)),
    Case("kind: sensor_frozen, vehicle: port, sensor: dvl", Limits(0.6, 0.8, 1.2), doubted=("port", 5.5)),
    Case(
        "kind: sensor_frozen, vehicle: starboard, sensor: thruster_speed",
        Limits(0.6, 0.8, 1.2),
        doubted=("starboard", 5.5),
    ),
    Case("kind: sensor_frozen, vehicle: port, sensor: altimeter", Limits(0.6, 0.8, 1.2)),
    Case("kind: sensor_biased, vehicle: surface, sensor: gnss, north: 3 m", Limits(3.8, 3.8, 3.0)),
    Case("kind: sensor_biased, vehicle: port, sensor: ahrs, heading: 10 deg", Limits(1.0, 1.8, 1.2)),
    Case("kind: sensor_biased, vehicle: port, sensor: depth, depth: 1 m", Limits(0.6, 0.8, 1.2, 1.3)),
    Case("kind: sensor_biased, vehicle: surface, sensor: usbl, azimuth: 5 deg", Limits(0.8, 0.8, 2.0)),
    Case("kind: sensor_biased, vehicle: port, sensor: dvl, surge: 0.1 m/s", Limits(0.8, 1.0, 1.5)),
    Case(
        "kind: sensor_biased, vehicle: starboard, sensor: thruster_speed, shaft_speed: 100 rpm", Limits(0.6, 0.8, 1.2)
    ),
    Case("kind: sensor_biased, vehicle: port, sensor: altimeter, altitude: 1 m", Limits(0.6, 0.8, 1.2)),
    Case("kind: sensor_nan, vehicle: surface, sensor: gnss", Limits(1.5, 1.2, 1.5)),
    Case("kind: sensor_nan, vehicle: port, sensor: ahrs", Limits(0.6, 6.0, 22.0), doubted=("port", 0.1)),
    Case("kind: sensor_nan, vehicle: surface, sensor: ahrs", Limits(2.5, 6.0, 18.0), doubted=("surface", 0.1)),
    Case("kind: sensor_nan, vehicle: port, sensor: depth", Limits(0.6, 0.8, 1.2), doubted=("port", 0.3)),
    Case("kind: sensor_nan, vehicle: surface, sensor: usbl", Limits(1.2, 1.0, 1.2)),
    Case("kind: sensor_nan, vehicle: port, sensor: dvl", Limits(0.6, 0.8, 1.2), doubted=("port", 0.6)),
    Case(
        "kind: sensor_nan, vehicle: starboard, sensor: thruster_speed",
        Limits(0.6, 0.8, 1.2),
        doubted=("starboard", 0.2),
    ),
    Case("kind: sensor_nan, vehicle: port, sensor: altimeter", Limits(0.6, 0.8, 1.2)),
    Case("kind: thruster_weak, vehicle: port, thruster: port, efficiency: 0.5", Limits(0.6, 1.5, 2.0)),
    Case("kind: thruster_weak, vehicle: port, efficiency: 0.3", Limits(0.6, 0.8, 4.5)),
    Case("kind: thruster_weak, vehicle: port, efficiency: 0", Limits(0.6, 5.5, 20.0), "both dead"),
    Case("kind: thruster_weak, vehicle: port, thruster: vertical, efficiency: 0", Limits(0.6, 0.8, 1.2)),
    Case(
        "kind: vehicle_lost, vehicle: port",
        Limits(0.6, 0.8, 1.2),
        "silence: go_on; of the two that are left",
        GO_ON,
        counted=("surface", "starboard"),
        lasts=False,
    ),
    Case(
        "kind: vehicle_lost, vehicle: surface",
        Limits(1.5, 1.0, 1.5),
        "silence: go_on; of the two that are left, without fixes",
        GO_ON,
        counted=("port", "starboard"),
        after=Limits(3.0, 1.0, 3.0),
        lasts=False,
    ),
    Case("kind: clock_offset, vehicle: port, offset: 2 s", Limits(2.0, 0.8, 1.2)),
    Case("kind: clock_offset, vehicle: surface, offset: 60 s", Limits(2.0, 1.2, 2.0)),
    Case("kind: clock_offset, vehicle: surface, offset: -60 s", Limits(1.2, 1.0, 1.5)),
    Case("kind: clock_drift, vehicle: surface, drift: 0.01", Limits(0.7, 0.8, 1.2)),
    Case("kind: current_step, speed: 0.15 m/s, towards: 90 deg", Limits(2.0, 3.0, 2.0)),
    Case("kind: forged_packets, vehicle: surface", Limits(0.6, 0.8, 1.5)),
    Case("kind: forged_packets, vehicle: surface", Limits(0.6, 0.8, 1.2), "authentication: 4", SEALED),
    Case(
        "kind: forged_packets, vehicle: surface, size: 5 m",
        Limits(7.0, 7.0, 8.0),
        "position: reset",
        RESET,
        after=HEALTHY_BY_RESET,
    ),
    Case("kind: replayed_packets, vehicle: surface", Limits(0.6, 0.8, 1.2)),
    Case("kind: replayed_packets, vehicle: surface", Limits(0.6, 0.8, 1.2), "authentication: 4", SEALED),
)


@cache
def flown(case: Case) -> Flight:
    """The flight of a case."""
    return fly_text(case.text, case.overrides)


def measured(case: Case, start: float, end: float) -> Limits:
    """The worst of a flight between two times [s]."""
    flight = flown(case)
    rows = (flight.times >= start) & (flight.times <= end)
    places = [flight.vehicle_names.index(name) for name in case.counted]
    c = {name: values[rows][:, places] for name, values in flight.channels.items()}
    away = np.hypot(c["north_estimate"] - c["north"], c["east_estimate"] - c["east"])
    spread = np.ptp(c["coordination_state"], axis=1)
    off_depth = abs(c["depth"] - c["depth_desired"])
    return Limits(*(float(abs(values).max()) for values in (away, c["cross_track"], spread, off_depth)))


def found_after(case: Case) -> float:
    """How long [s] it took until the vehicle found its sensor at fault; NaN: it did not."""
    flight = flown(case)
    times = [event.time for event in flight.events if event.what.startswith("does not believe")]
    return min(times, default=math.nan) - BEGIN


def table() -> list[str]:
    """The lines of the table."""
    lines = [
        "| fault | mission | position | cross-track | spread | depth | found | afterwards |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for case in CASES:
        during, after = measured(case, BEGIN, END if case.lasts else DURATION), measured(case, AFTER, DURATION)
        keys = ", ".join(f"`{key.strip()}`" for key in case.fault.split(",")[1:])
        found = found_after(case)
        cells = [
            f"`{case.kind}`",
            f"{keys}; {case.note}" if case.note else keys,
            *(f"{value:.2g}" for value in astuple(during)),
            "" if math.isnan(found) else f"{found:.2g} s",
            " / ".join(f"{value:.2g}" for value in astuple(after)),
        ]
        lines.append(f"| {' | '.join(cells)} |")
    return lines


def main() -> None:
    """Write the table into the page."""
    before, _, rest = DOC.read_text(encoding="utf-8").partition("<!-- table -->\n")
    _, _, after = rest.partition("<!-- end of table -->")
    lines = "\n".join(table())
    DOC.write_text(f"{before}<!-- table -->\n{lines}\n<!-- end of table -->{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
