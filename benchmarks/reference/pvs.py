"""PythonVehicleSimulator (Fossen), where it is installed: another program of this field, on work of its own.

It flies one vehicle at a time and has no path, no messages and no estimator, so that this is less work for a
vehicle, beside six degrees of freedom where the reference workload has three; a rate, not a comparison of equals.
"""

import importlib.util
import math
from collections.abc import Callable
from functools import partial
from typing import Any

from benchmarks.timing import Effort, Work

PACKAGE = "python_vehicle_simulator"
CASE = "PythonVehicleSimulator, Otter"
STEP = 0.05  # [s]
SECONDS = 60.0  # its log grows by copying, so that longer flights are slower


def why_no_pvs() -> str | None:
    """Why it cannot be timed here; None: it can."""
    if importlib.util.find_spec(PACKAGE):
        return None
    return (
        f"{PACKAGE} is not installed here (pip install a checkout of github.com/cybergalactic/PythonVehicleSimulator)"
    )


def pvs_work(effort: Effort) -> tuple[Work, int]:
    """A flight, and how many steps it makes.

    Args:
        effort: a smoke run flies for less.
    """
    from python_vehicle_simulator.lib.mainLoop import simulate  # type: ignore[import-not-found]
    from python_vehicle_simulator.vehicles import otter  # type: ignore[import-not-found]

    steps = round(min(SECONDS, effort.mission_seconds()) / STEP)
    make: Callable[[], Any] = partial(otter, "headingAutopilot", 30.0, 0.1, math.degrees(0.5), 100.0)
    return Work(lambda vehicle: simulate(steps, STEP, vehicle), make), steps
