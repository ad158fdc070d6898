"""Larger fleets on a sparse graph: the reference mission in rows of three, each vehicle hears its neighbors in line."""

from dataclasses import replace

from benchmarks.reference.workload import FILE
from benchmarks.row import ROOT
from benchmarks.timing import Effort
from cardume.missions.available import catalog
from cardume.missions.drawing import draw
from cardume.missions.loading import parse_mission
from cardume.missions.planning import make_plan
from cardume.simulation.plan import Plan

COLUMNS = (0.0, -4.0, 4.0)  # [m] to starboard
APART = 8.0  # [m] between rows
BEGINS = "vehicles:"
SHARED = "model:"


def fleet_plans(size: int, count: int, effort: Effort) -> list[Plan]:
    """Missions of a fleet, without logs.

    Args:
        size: [-] vehicles.
        count: [-] missions.
        effort: a smoke run flies for less.
    """
    known = catalog([ROOT])
    overrides = [f"duration={effort.mission_seconds()} s", "coordination.topology=path", "position={law: direct}"]
    overrides.append("sensors.gnss={sigma: 0 m, period: 0.1 s}")
    mission = parse_mission(fleet_text(size), known, overrides, source="reference fleet")
    return [replace(make_plan(draw(mission, seed), known).plan, log_period=0.0) for seed in range(count)]


def fleet_text(size: int) -> str:
    """The reference mission with other vehicles.

    Args:
        size: [-] of them.
    """
    head, _, rest = FILE.read_text(encoding="utf-8").partition(BEGINS)
    return f"{head}{BEGINS}\n{''.join(map(_vehicle, range(size)))}\n{SHARED}{rest.partition(SHARED)[2]}"


def _vehicle(number: int) -> str:
    row, column = divmod(number, len(COLUMNS))
    ahead, starboard = -APART * row, COLUMNS[column]
    return (
        f"  - name: v{number:02d}\n"
        f"    offset: {{ahead: {ahead} m, starboard: {starboard} m}}\n"
        f"    start: {{along_track: {ahead - 1.0} m, cross_track: 1 m, speed: 0.2 m/s}}\n"
        f"    messaging: {{schedule: periodic, period: 1 s, offset: {0.1 * (number % 10):.1f} s}}\n"
    )
