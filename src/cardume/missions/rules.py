"""What the values of a mission must obey together, checked once they are plain values."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cardume.errors import MissionError, Problem
from cardume.missions.distributions import Varying, values_of
from cardume.missions.mission import Mission
from cardume.missions.route import FilePath, LemniscatePath, SegmentsPath
from cardume.missions.vehicle import LawChoice
from cardume.units import show_quantity

MOST_ROWS = 5_000_000
RECURRING = ("tick", "plant_step", "log_period", "period")


def check_rules(mission: Mission) -> None:
    """Check a mission as far as its values are known.

    Raises:
        MissionError: with every rule that is broken, where the value stands.
    """
    rules = (_step_rules, _period_rules, _path_rules, _current_rules, _fleet_rules)
    found = [broken for rule in rules for broken in rule(mission)]
    if found:
        raise MissionError(Problem(mission.where(key), message) for key, message in found)


def is_ruled(key: str, value: object) -> bool:
    """Whether the rules may hold for one value of a distribution and not for another.

    Args:
        key: of the value.
        value: its distribution.
    """
    numbers = getattr(value, "options", (0.0,))
    is_number = all(isinstance(number, float) for number in numbers)
    return not is_number or key.rpartition(".")[2] in RECURRING or key == "duration"


def _step_rules(mission: Mission) -> Iterator[tuple[str, str]]:
    tick, step = mission.tick, mission.plant_step
    if _are_plain(tick, step) and not _is_whole(tick / step):
        count = max(1, int(tick / step))
        valid = f"{_seconds(tick / (count + 1))} and {_seconds(tick / count)}"
        yield (
            "plant_step",
            f"given {_seconds(step)}; the tick, {_seconds(tick)}, must be a whole"
            f" multiple of it: the nearest are {valid}",
        )


def _period_rules(mission: Mission) -> Iterator[tuple[str, str]]:
    """Whatever vehicles do again and again they do every so many ticks; the tide does not."""
    periods = [("log_period", mission.log_period)]
    for key, value in values_of(mission):
        if isinstance(value, LawChoice) and value.family != "current" and "period" in value.parameters:
            periods.append((f"{key}.period", value.parameters["period"]))
    tick = mission.tick
    for key, period in periods:
        if _are_plain(tick, period) and not _is_whole(period / tick):
            count = int(period / tick)
            valid = " and ".join(_seconds(tick * n) for n in (count, count + 1) if n > 0)
            yield (
                key,
                f"given {_seconds(period)}; must be a whole multiple of the tick,"
                f" {_seconds(tick)}: the nearest are {valid}",
            )


def _path_rules(mission: Mission) -> Iterator[tuple[str, str]]:
    path: object = mission.path
    formation: Any = mission.formation
    if isinstance(path, Varying) or isinstance(formation, Varying) or formation.speed is not None:
        return
    pieces = path.segments if isinstance(path, SegmentsPath) else ()
    if isinstance(path, LemniscatePath) and path.parameter_rate is not None:
        return
    if isinstance(path, FilePath) or (pieces and all(getattr(piece, "speed", 0.0) is not None for piece in pieces)):
        return
    yield "formation.speed", "missing; v_L, along the reference path; must be a speed, as '0.5 m/s'"


def _current_rules(mission: Mission) -> Iterator[tuple[str, str]]:
    """The points of a profile go down."""
    current: object = mission.current
    points = current.parameters.get("profile", ()) if isinstance(current, LawChoice) else ()
    for k in range(1, len(points)):
        if not points[k].depth > points[k - 1].depth:
            given, above = (show_quantity(p.depth, "m", digits=12) for p in (points[k], points[k - 1]))
            yield f"current.profile.{k}.depth", f"given {given}; must be below the point before it, {above}"


def _fleet_rules(mission: Mission) -> Iterator[tuple[str, str]]:
    first = mission.vehicles[0]
    for vehicle in mission.vehicles[1:]:
        here = f"vehicles.{vehicle.name}"
        if _differ(getattr(vehicle.coordination, "topology", None), getattr(first.coordination, "topology", None)):
            yield (
                f"{here}.coordination.topology",
                f"differs from that of {first.name}; the fleet has one graph:"
                " give it once, in the coordination section of the whole fleet",
            )
        if _differ(getattr(vehicle.acoustics, "name", None), getattr(first.acoustics, "name", None)):
            yield (
                f"{here}.acoustics.channel",
                f"differs from that of {first.name}; the fleet shares one channel:"
                " give it once, and per vehicle only its parameters",
            )
    if _are_plain(mission.duration, mission.log_period):
        rows = mission.duration / mission.log_period * len(mission.vehicles)
        if rows > MOST_ROWS:
            least = mission.log_period * rows / MOST_ROWS
            yield (
                "log_period",
                f"the log would have {rows:.3g} rows, at most {MOST_ROWS:,}; a period above {least:.3g} s fits",
            )


def _seconds(value: float) -> str:
    return show_quantity(value, "s", digits=12)


def _are_plain(*values: object) -> bool:
    """Whether all values are numbers already, neither drawn nor swept."""
    return all(isinstance(value, float) for value in values)


def _is_whole(ratio: float) -> bool:
    return ratio > 0.5 and abs(ratio - round(ratio)) <= 1e-9 * ratio


def _differ(one: object, other: object) -> bool:
    return one is not None and other is not None and one != other
