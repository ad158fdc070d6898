"""Duration and steps: a mission that ends early, and steps that models and autopilots do not stand."""

import math
from collections.abc import Iterator

import numpy as np

from cardume.missions.checks.finding import Finding, Level, Ranked, at_most, setting, show, worst
from cardume.missions.checks.fixes import has_parameter
from cardume.missions.checks.scene import Craft, Scene
from cardume.missions.route import CirclePath
from cardume.paths import table
from cardume.paths.curve import BETWEEN
from cardume.paths.offset import curve_of
from cardume.vehicles.thrusters import smallest_plant_step

BANDWIDTHS = ("speed_bandwidth", "turn_bandwidth", "heave_bandwidth")  # of filters integrated by Euler's rule


def check_duration(scene: Scene) -> Iterator[Finding]:
    """A mission that ends before the formation comes to the end of its path."""
    if isinstance(scene.mission.path, CirclePath):
        return
    rows = table.rows_on_path(scene.reference)
    length = float(rows[:, table.LENGTH].sum())
    needed = float(_durations(rows).sum())
    duration = scene.mission.duration
    if duration >= needed:
        return
    done = float(np.interp(duration, *_schedule(rows)))
    message = (
        f"after {show(duration, 's')} the formation is {show(done, 'm')} along a path of {show(length, 'm')}, which"
        f" takes {show(needed, 's')} at its speed"
    )
    yield Finding("warning", "duration", message, setting("duration", 10.0 * math.ceil(needed / 10.0), "s"))


def _durations(rows: np.ndarray) -> np.ndarray:
    """Times (n,) [s] that the formation takes for each segment."""
    speeds = rows[:, table.SPEED].copy()
    for k in np.flatnonzero(rows[:, table.IS_CURVE]):
        speeds[k] = len(BETWEEN) / (1.0 / curve_of(rows[k]).speed_along(BETWEEN)).sum()
    times: np.ndarray = rows[:, table.LENGTH] / speeds
    return times


def _schedule(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] and how far the formation is then [m]."""
    lengths = rows[:, table.LENGTH]
    times = np.concatenate([[0.0], np.cumsum(_durations(rows))])
    return times, np.concatenate([[0.0], np.cumsum(lengths)])


def check_steps(scene: Scene) -> list[Finding]:
    """Plant steps too short for the thrusters' delay, or too long for the autopilot's filters."""
    return worst(ranked for craft in scene.crafts for ranked in _steps(scene, craft))


def _steps(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    step, tick = scene.mission.plant_step, scene.mission.tick
    model, autopilot = craft.law("model"), craft.law("autopilot")
    if has_parameter(model, "motor_delay") and model.law.is_builtin:
        shortest = smallest_plant_step(model.value("motor_delay"))
        if step < shortest * (1.0 - 1e-9):
            message = (
                f"{craft.name}: its thrusters remember the commands of {show(model.value('motor_delay'), 's')} in 63"
                f" steps, so {show(step, 's')} is too short: at least {show(shortest, 's')}, or the mission stops with"
                " numbers that are none"
            )
            longest = tick / max(1, math.floor(tick / shortest + 1e-9))
            suggestion = setting("plant_step", longest, "s") if tick >= shortest else ""
            yield Ranked(shortest / step, Finding("error", "plant_step", message, suggestion))
    if autopilot.law.name != "feedforward_pid":
        return
    for name in BANDWIDTHS:
        bandwidth, key = autopilot.value(name), scene.key(craft, f"autopilot.{name}")
        if bandwidth * step >= 2.0:
            steers = name == "turn_bandwidth"
            message = (
                f"{craft.name}: {name} {show(bandwidth, '1/s')} in plant steps of {show(step, 's')} is unstable,"
                f" Euler's rule holding below 2 / step: {'it cannot steer' if steers else 'its thrusters chatter'}"
            )
            level: Level = "error" if steers else "warning"
            yield Ranked(bandwidth * step, Finding(level, key, message, at_most(key, 0.5 / step, "1/s")))
