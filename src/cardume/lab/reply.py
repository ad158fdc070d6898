"""A flight in plain values, as the page draws it."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from cardume.missions.runs import Run
from cardume.missions.summary import Verdict
from cardume.report.page.store import color, packed
from cardume.report.page.tables import NO_BREAK, badge, meaning_of, subject_of, words_of
from cardume.report.table import COLUMNS, NOTHING, cells_of, share_heard
from cardume.report.words import meaning
from cardume.simulation.flight import METRICS, Flight

MOST_ROWS = 500  # of one line: two pixels each at the size of the page
DRAWN = ("north", "east", "north_estimate", "east_estimate", "heading", "cross_track", "speed")


def flown(run: Run) -> dict[str, Any]:
    """All that the page shows of a flight.

    Args:
        run: just flown.
    """
    flight = run.flight
    word, kind = badge(run)
    return {
        "name": flight.mission_name,
        "seed": flight.seed,
        "vehicles": list(flight.vehicle_names),
        "colors": [color(k) for k in range(len(flight.vehicle_names))],
        **lines(flight),
        "verdict": [word, kind],
        "meaning": meaning(flight, run, run.verdicts),
        "required": [required(verdict) for verdict in run.verdicts],
        "numbers": numbers(flight),
        "milliseconds": _plain(1e3 * flight.wall_seconds),
    }


def lines(flight: Flight) -> dict[str, Any]:
    """The lines of the charts, in binary.

    Args:
        flight: just flown.
    """
    stride = max(1, -(-len(flight.times) // MOST_ROWS))
    rows = np.unique(np.append(np.arange(0, len(flight.times), stride), len(flight.times) - 1))
    own = {name: np.asarray(flight.channels[name], float)[rows] for name in DRAWN}
    state = np.asarray(flight.channels["coordination_state"], float)[rows]
    own["ahead"] = state - state.mean(axis=1, keepdims=True)
    own["lost_way"] = np.hypot(own["north_estimate"] - own["north"], own["east_estimate"] - own["east"])
    return {
        "times": packed(flight.times[rows]),
        "lines": {name: [packed(column) for column in values.T] for name, values in own.items()},
        "reference": _line(flight.reference_path),
        "paths": [_line(path) for path in flight.own_paths],
    }


def _line(points: np.ndarray) -> dict[str, Any]:
    return {"north": packed(points[:, 0]), "east": packed(points[:, 1])}


def numbers(flight: Flight) -> list[dict[str, Any]]:
    """The metrics, one row each: texts of every vehicle and of the fleet, and the fleet's number.

    Args:
        flight: just flown.
    """
    is_fleet = len(flight.vehicle_names) > 1
    rows = []
    for column in COLUMNS:
        cells = cells_of(column, flight, flight.vehicle_names)
        if all(text in (NOTHING, "") for text in cells):
            continue
        value = share_heard(flight) * 100.0 if column.metric == "heard" else flight.metrics.worst(column.metric)[0]
        rows.append(
            {
                "label": words_of(column),
                "meaning": meaning_of(column.metric),
                "cells": cells if is_fleet else cells[:-1],
                "value": _plain(value),
            }
        )
    return rows


def required(verdict: Verdict) -> dict[str, Any]:
    """A requirement and what became of it, in words.

    Args:
        verdict: of the flight.
    """
    return {
        "metric": verdict.metric,
        "what": subject_of(verdict),
        "wanted": f"{verdict.bound} {verdict.wanted:g}{NO_BREAK}{verdict.unit}".strip(),
        "limit": None if verdict.vehicle else _plain(verdict.wanted),  # of the fleet, which a study shows
        "got": f"{verdict.got:.4g}{NO_BREAK}{verdict.unit}".strip() if math.isfinite(verdict.got) else "no value",
        "worst": verdict.worst if verdict.worst and not verdict.vehicle else "",
        "met": verdict.met,
        "meaning": METRICS[verdict.metric].meaning,
    }


def _plain(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def plain_points(points: Sequence[Any]) -> list[list[float]]:
    """Points of a mission as pairs of north and east [m].

    Args:
        points: records with north and east.
    """
    return [[float(f"{point.north:.6g}"), float(f"{point.east:.6g}")] for point in points]
