"""How much work a mission is, before it is flown: vehicle-ticks for the engine, vehicle-steps for its motion."""

from typing import Any

from cardume.compiler.compiled import is_kept_for_lanes
from cardume.missions.mission import Mission
from cardume.simulation.engine import advance

# Vehicle-ticks from which eight missions in one register save more time than bringing the engine for them to machine
# code takes: about a minute on two processors where that was never done, a second or a few where it was.
LANES_FROM, KEPT_LANES_FROM = 100_000_000, 10_000_000


def wants_lanes(ticks: float) -> bool:
    """Whether so much is flown that the engine's second form, eight missions in a register, is worth its preparation.

    Args:
        ticks: [-] of all vehicles of all missions.
    """
    if ticks < min(LANES_FROM, KEPT_LANES_FROM):
        return False
    return ticks >= LANES_FROM or is_kept_for_lanes(advance)


def expected_ticks(mission: Mission) -> float:
    """Ticks of vehicles [-] in a typical mission of those that one stands for.

    Args:
        mission: also with distributions and sweeps.
    """
    return typical(mission.duration) / typical(mission.tick) * len(mission.vehicles)


def expected_steps(mission: Mission) -> float:
    """Steps of the motion of vehicles [-] in a typical mission of those that one stands for.

    Args:
        mission: also with distributions and sweeps.
    """
    return typical(mission.duration) / typical(mission.plant_step) * len(mission.vehicles)


def typical(value: Any) -> float:
    """The middle [any] of what a number may be.

    Args:
        value: [any] a number, a distribution or a sweep of it.
    """
    if isinstance(value, (int, float)):
        return float(value)
    if options := getattr(value, "options", ()):
        return float(sum(options) / len(options))
    return float(value.mean if hasattr(value, "mean") else 0.5 * (value.low + value.high))
