"""What a replay leaves behind: a directory like that of a run.

DIR/log.nc          what was believed, and the truth where there is one, row by row, as in the log of a run
DIR/summary.json    the numbers, with those of the replay under "replay"
DIR/mission.yaml    the mission that stood around the vehicles, with the laws that were judged
DIR/smoothed.csv    what later fixes say, where that was asked for
DIR/innovations.csv how far every fix was from where it was expected
"""

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from cardume.missions.log import write_log
from cardume.missions.recordings.base import REPLAYED
from cardume.missions.recordings.replaying import Part, Replay
from cardume.missions.results import Destination, write_atomically
from cardume.missions.summary import FILE_NAME, summarize
from cardume.simulation.flight import (
    CHANNELS,
    CURRENT,
    EFFORT,
    MESSAGE_COLUMNS,
    MOTION,
    ON_PATH,
    VERTICAL,
    Flight,
    Metrics,
)

TRUE = (*MOTION, *CURRENT, *ON_PATH, *EFFORT, *VERTICAL)
NO_LINE = np.zeros((0, 2))


def keep(
    destination: Destination, replay: Replay, *, version: str, draw: Callable[[Path], None] | None = None
) -> tuple[Path, dict[str, Any]]:
    """Write everything, complete or not at all.

    Args:
        destination: from `choose_destination`.
        replay: what came out.
        version: of cardume.
        draw: adds pictures to the folder.

    Returns:
        The directory, and the summary as written there.

    Raises:
        ResultsError: the disk is full, or refused otherwise; nothing is left behind.
    """
    return write_atomically(destination, replay.name, lambda folder, _final: _fill(folder, replay, version, draw))


def _fill(folder: Path, replay: Replay, version: str, draw: Callable[[Path], None] | None) -> dict[str, Any]:
    flight, text = flight_of(replay), mission_of(replay, version)
    (folder / "mission.yaml").write_text(text, encoding="utf-8")
    write_log(folder / "log.nc", flight, mission=text, version=version)
    _write_innovations(folder / "innovations.csv", replay)
    if any(part.smoothed for part in replay.parts):
        _write_smoothed(folder / "smoothed.csv", replay)
    if draw is not None:
        draw(folder)
    files = sorted([*(p.relative_to(folder).as_posix() for p in folder.rglob("*") if not p.is_dir()), FILE_NAME])
    summary = summary_of(replay, flight, version, files)
    (folder / FILE_NAME).write_text(json.dumps(summary, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    return summary


def mission_of(replay: Replay, version: str) -> str:
    """The text of the mission that stood around the vehicles.

    Args:
        replay: what came out.
        version: of cardume.
    """
    head = f"{REPLAYED} ({replay.kind}) was replayed by cardume {version}; not flown.\n"
    if replay.mission is None:
        return f"{head}# No law of the engine was judged, but missions/ranging/range_filter.py.\n"
    return head + replay.mission.to_yaml(Path())


def flight_of(replay: Replay) -> Flight:
    """A replay in the form of a flight: what was believed, and the truth where it is known.

    Args:
        replay: what came out.
    """
    times = _times(replay)
    channels = {name: np.full((len(times), len(replay.parts)), math.nan) for name in CHANNELS}
    for k, part in enumerate(replay.parts):
        for name, values in _columns(part, times).items():
            channels[name][:, k] = values
    names, flown = tuple(part.believed.name for part in replay.parts), replay.log.flight if replay.log else None
    places = [flown.vehicle_names.index(name) for name in names] if flown else []
    if flown and len(times) == len(flown.times):
        for name in TRUE:
            channels[name] = flown.channels[name][:, places].astype(float)
    return Flight(
        mission_name=replay.name,
        seed=flown.seed if flown else 0,
        vehicle_names=names,
        times=times,
        channels=channels,
        neighbor_state_estimate=np.full((len(times), len(names), len(names)), math.nan),
        messages={name: np.zeros(0) for name in MESSAGE_COLUMNS},
        metrics=_metrics(replay),
        reason="completed",
        flown=float(times[-1]),
        reference_path=flown.reference_path if flown else NO_LINE,
        own_paths=tuple(flown.own_paths[k] for k in places) if flown else (NO_LINE,) * len(names),
    )


def _times(replay: Replay) -> np.ndarray:
    if replay.log is not None:
        last = max(part.believed.times[-1] for part in replay.parts)
        found: np.ndarray = replay.log.flight.times[replay.log.flight.times <= last + 1e-9]
        return found
    last = max(part.believed.times[-1] for part in replay.parts)
    return replay.log_period * np.arange(math.floor(last / replay.log_period + 1e-9) + 1)


def _columns(part: Part, times: np.ndarray) -> dict[str, np.ndarray]:
    """Channels of a vehicle at the rows of the log: the last tick before each."""
    b = part.believed
    rows = np.searchsorted(b.times, times + 1e-6, side="right") - 1
    is_there = (rows >= 0) & (times <= b.times[-1] + 1e-6)
    tables = {
        ("north", "east"): b.truth,
        ("depth",): b.depth[:, None],
        ("current_north", "current_east"): b.true_current,
        ("north_estimate", "east_estimate"): b.position,
        ("current_north_estimate", "current_east_estimate"): b.current,
        ("north_variance", "north_east_covariance", "east_variance"): b.covariance,
    }
    return {
        name: np.where(is_there, table[np.maximum(rows, 0), column], math.nan)
        for names, table in tables.items()
        for column, name in enumerate(names)
    }


def _metrics(replay: Replay) -> Metrics:
    names = ("position_error_rms", "current_error_rms")
    return Metrics(
        vehicles={
            part.believed.name: {name: value for name in names if math.isfinite(value := getattr(part.score, name))}
            for part in replay.parts
        }
    )


def summary_of(replay: Replay, flight: Flight, version: str, files: list[str]) -> dict[str, Any]:
    """The summary as plain values: that of a run, and `replay` with what only a replay has.

    Args:
        replay: what came out.
        flight: from `flight_of`.
        version: of cardume.
        files: written beside it.
    """
    found = summarize(flight, (), duration=flight.flown, version=version, files=files)
    vehicles = {}
    for part in replay.parts:
        numbers: dict[str, Any] = {name: plain(value) for name, value in part.score._asdict().items()}
        numbers |= {"position_law": part.position} | {name: plain(v) for name, v in (part.found or {}).items()}
        if part.smoothed is not None:
            numbers["smoothed_position_error_rms"] = plain(part.smoothed.position_error_rms)
        vehicles[part.believed.name] = numbers
    return found | {
        "replay": {
            "format": replay.kind,
            "began": replay.began or None,
            "origin_deg": [math.degrees(x) for x in replay.origin] if replay.origin else None,
            "vehicles": vehicles,
            "notes": list(replay.notes),
        }
    }


def plain(value: float) -> float | int | None:
    """A number as JSON has it: counts whole, what is none as null.

    Args:
        value: [any]
    """
    if not math.isfinite(value):
        return None
    return int(value) if float(value).is_integer() and abs(value) < 1e15 else float(value)


def _write_innovations(path: Path, replay: Replay) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["vehicle", "time", "distance", "normalized_square", "size", "is_believed"])
        for part in replay.parts:
            for i in part.innovations:
                square = "" if math.isnan(i.square) else repr(i.square)
                writer.writerow(
                    [part.believed.name, repr(i.time), repr(i.apart), square, int(i.size), int(i.is_believed)]
                )


def _write_smoothed(path: Path, replay: Replay) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        names = ["north", "east", "current_north", "current_east"]
        writer.writerow(["vehicle", "time", *names, "north_variance", "north_east_covariance", "east_variance"])
        for part in replay.parts:
            if part.smoothed is not None:
                s = part.smoothed
                for time, mean, spread in zip(s.times, s.means, s.covariances, strict=True):
                    row = [float(time), *map(float, mean), *(float(spread[i, j]) for i, j in ((0, 0), (0, 1), (1, 1)))]
                    writer.writerow([part.believed.name, *map(repr, row)])
