"""Fly a mission: plan, compile, fly, and gather what the flight leaves."""

import math
import time
from collections.abc import Callable, Iterable
from functools import lru_cache
from pathlib import Path

import numpy as np

from cardume.missions.available import catalog
from cardume.missions.drawing import draw, refuse_sweeps
from cardume.missions.mission import Mission
from cardume.missions.planning import Planned, make_plan
from cardume.paths.outline import outline
from cardume.simulation.events import events_of
from cardume.simulation.flight import Flight
from cardume.simulation.fly import Flown, Trouble, fly
from cardume.simulation.plan import Plan
from cardume.simulation.recording import CHANNELS, LOG, MESSAGE_LOG, MESSAGES, RECORDS, MessageRow
from cardume.simulation.results import metrics_of
from cardume.simulation.warming import warm_up

Progress = Callable[[str, int, int], None]


def fly_mission(
    mission: Mission,
    progress: Progress = lambda stage, done, total: None,
    should_stop: Callable[[], bool] = lambda: False,
    allow_code: Iterable[str | Path] = (),
) -> Flight:
    """Fly a mission to its end, an interruption or a failure.

    Args:
        mission: without sweeps; its distributions are drawn by its seed.
        progress: called with "compile" or "fly", how much is done, and how much there is.
        should_stop: asked every few milliseconds.
        allow_code: folders from which the mission's own laws may be imported.

    Returns:
        The flight; a failure is in it, not raised.

    Raises:
        InputError: the mission cannot be flown.
    """
    refuse_sweeps(mission)
    planned = make_plan(draw(mission, mission.seed), catalog(allow_code))
    warm_up(planned.plan, lambda done, total: progress("compile", done, total))
    begin = time.perf_counter()
    flown = fly(planned.plan, lambda done, total: progress("fly", done, total), should_stop)
    return flight_of(mission.name, planned, flown, time.perf_counter() - begin)


def flight_of(name: str, planned: Planned, flown: Flown, wall_seconds: float = math.nan) -> Flight:
    """What a flight leaves, in the order of the mission's vehicles.

    Args:
        name: of the mission.
        planned: what was to be flown.
        flown: what was.
        wall_seconds: [s] that it took.
    """
    plan, size = flown.plan, len(flown.plan.vehicles)
    back = np.argsort(plan.order)
    records = int(flown.tables.counts[RECORDS])
    log = flown.tables.log[: records * size * LOG.width].reshape(records, size, LOG.width)[:, back]
    channels = {channel: log[:, :, k] for k, channel in enumerate(CHANNELS)}
    channels["shaft_speed_rpm"] = channels.pop("shaft_speed") * 30.0 / math.pi
    predictions = flown.tables.predictions[: records * size * size].reshape(records, size, size)
    trouble = flown.trouble
    return Flight(
        mission_name=name,
        seed=plan.seed,
        vehicle_names=tuple(v.name for v in plan.vehicles),
        times=np.arange(records) * plan.log_period,
        channels=channels,
        neighbor_state_estimate=predictions[:, back][:, :, back],
        messages=_messages(plan, flown),
        metrics=metrics_of(flown),
        reason="failed" if trouble else "interrupted" if flown.stopped else "completed",
        failure=failure_of(trouble) if trouble else None,
        flown=flown.ticks * plan.tick,
        wall_seconds=wall_seconds,
        reference_path=line_of(planned.reference),
        own_paths=tuple(line_of(v.path) for v in plan.vehicles),
        events=events_of(flown),
    )


def line_of(path: np.ndarray) -> np.ndarray:
    """Points (n, 2) [m] along a path, north and east; of one that was asked for lately, without work.

    Args:
        path: [any] (n,) path table.
    """
    return _line_of(path.tobytes())


@lru_cache(maxsize=64)
def _line_of(path: bytes) -> np.ndarray:
    points = outline(np.frombuffer(path))[:, 1:]
    points.flags.writeable = False  # it is handed out again
    return points


def _messages(plan: Plan, flown: Flown) -> dict[str, np.ndarray]:
    count = int(flown.tables.counts[MESSAGES])
    rows = flown.tables.messages[: count * MESSAGE_LOG.width].reshape(count, MESSAGE_LOG.width)
    columns = {name: rows[:, k] for k, name in enumerate(MessageRow._fields)}
    order = np.asarray(plan.order)
    for column in ("sender", "receiver"):
        columns[column] = order[columns[column].astype(int)]
    columns["lost"] = columns["lost"] > 0.5
    columns["kind"] = np.zeros(count, int)
    return columns


def failure_of(trouble: Trouble) -> str:
    """Why a mission failed, and what to do, in words.

    Args:
        trouble: the first number that was not one.
    """
    advice = {
        "current": "it left the grid of the current, or came to a hole in it: move origin or shorten the path",
        "state": "its model diverged: shorten plant_step, or look at its gains",
        "reference": "a law aboard gave no number: look at its sensors and its gains",
        "position estimate": "its estimator diverged: look at its fixes and gains",
    }
    what = f"the {trouble.signal} of vehicle {trouble.vehicle} was no number at {trouble.time:g} s"
    return f"{what}; {advice[trouble.signal]}"
