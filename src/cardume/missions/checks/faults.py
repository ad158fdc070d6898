"""Faults that nobody would notice: after the end, or to a vehicle that is lost."""

import math
from collections.abc import Iterator
from typing import Any

from cardume.missions.checks.finding import Finding, setting, show
from cardume.missions.checks.scene import Scene
from cardume.missions.faults import CurrentStep, ForgedPackets, ReplayedPackets, VehicleLost

OF_OTHERS = (CurrentStep, ForgedPackets, ReplayedPackets)  # happen though the vehicle has no power


def check_after_the_end(scene: Scene) -> Iterator[Finding]:
    """A fault that begins when the mission is over.

    Args:
        scene: the mission and its plan.
    """
    duration = scene.mission.duration
    for number, fault in enumerate(scene.mission.faults):
        if fault.from_ >= duration:
            key = f"faults.{number}.from"
            message = f"{show(fault.from_, 's')} is past the end of the mission, {show(duration, 's')}: nothing happens"
            yield Finding("warning", key, message, setting(key, math.floor(0.5 * duration), "s"))


def check_of_the_lost(scene: Scene) -> Iterator[Finding]:
    """A fault of a vehicle that has no power all that time: no thrust, no modem.

    Args:
        scene: the mission and its plan.
    """
    losses: list[VehicleLost] = []  # those of vehicles that are lost by now, in the order of their beginnings
    ordered = sorted(enumerate(scene.mission.faults), key=lambda pair: (pair[1].from_, -_window(pair[1])[1]))
    for number, fault in ordered:
        _, end = _window(fault)
        for loss in losses:
            lost, found = _window(loss)
            if loss.vehicle == fault.vehicle and end <= found and not isinstance(fault, OF_OTHERS):
                when = f"from {show(lost, 's')}" + ("" if math.isinf(found) else f" to {show(found, 's')}")
                message = f"{loss.vehicle} is lost {when}: what else fails aboard moves nothing and reaches nobody"
                yield Finding("warning", f"faults.{number}.from", message)
                break
        if isinstance(fault, VehicleLost):
            losses.append(fault)


def _window(fault: Any) -> tuple[float, float]:
    """When a fault begins and ends [s]."""
    if fault.lasts is not None:
        return fault.from_, fault.from_ + fault.lasts
    return fault.from_, math.inf if fault.to is None else fault.to
