"""Metrics of a flight, from the sums that the engine kept."""

import math
from typing import Any

import numpy as np

from cardume.onboard.mind import NEVER
from cardume.paths.table import LENGTH_REFERENCE
from cardume.simulation.flight import Limit, Metrics
from cardume.simulation.fly import Flown
from cardume.simulation.safety import FAR, Safety
from cardume.simulation.score import (
    BINS,
    CROSS_TRACK,
    FLEET_SCORES,
    FORMATION,
    HISTOGRAMS,
    SCORES,
    FleetScore,
    Formation,
    Score,
    Talk,
)


def metrics_of(flown: Flown) -> Metrics:
    """All metrics of a flight, per vehicle and for the fleet.

    Args:
        flown: a mission after its flight.

    Returns:
        Metrics in the order of the mission's vehicles; NaN where there is none, as before the transient ended.
    """
    plan, size = flown.plan, len(flown.plan.vehicles)
    rows = flown.tables.scores.reshape(size, SCORES.width)
    histograms = flown.tables.histograms.reshape(size, HISTOGRAMS, BINS)
    place = {vehicle: row for row, vehicle in enumerate(plan.order)}
    vehicles = {}
    for k, vehicle in enumerate(plan.vehicles):
        row = rows[place[k]]
        score, talk = _record(row, Score), _record(row, Talk)
        formation = _record(row, Formation)
        length = float(vehicle.path[LENGTH_REFERENCE])
        found = _of_path(score, histograms[place[k]], plan.tick) | _of_talk(talk)
        if size > 1:
            found |= _of_formation(formation, histograms[place[k]])
        if plan.rules.swath > 0.0:
            found["swath_coverage"] = 100.0 * min(1.0, score.swept / length)
        if plan.is_watched:
            found |= _of_safety(_record(row, Safety))
        vehicles[vehicle.name] = found
    fleet = FleetScore(*flown.tables.fleet_score[: FLEET_SCORES.width].tolist())
    limits = (*limits_of(flown), *separation_of(flown)) if plan.is_watched else ()
    return Metrics(fleet=_of_fleet(fleet) if size > 1 else {}, vehicles=vehicles, limits=limits)


def _record(row: np.ndarray, record: Any) -> Any:
    start = SCORES.offsets[record]
    return record(*(float(x) for x in row[start : start + len(record._fields)]))


def _of_path(score: Score, histograms: np.ndarray, tick: float) -> dict[str, float]:
    counted = score.line_time + score.arc_time
    steps = counted - tick  # [s] between the first and the last tick that count
    return {
        "cross_track_rms": _rms(score.line_squares + score.arc_squares, counted),
        "cross_track_p95": percentile(histograms[CROSS_TRACK], 0.95),
        "cross_track_max": score.cross_track_max if counted else math.nan,
        "cross_track_rms_lines": _rms(score.line_squares, score.line_time),
        "cross_track_rms_arcs": _rms(score.arc_squares, score.arc_time),
        "cross_track_iae": score.absolute_error,
        "settling_time": score.settling_time if score.settled else math.nan,
        "position_error_rms": _rms(score.position_squares, score.flown),
        "current_error_rms": _rms(score.current_squares, score.flown),
        "path_speed_mean": score.progress / steps if steps > 0.5 * tick else math.nan,
        "energy": score.energy,
        "yaw_effort": score.yaw_effort,
    }


def _of_formation(formation: Formation, histograms: np.ndarray) -> dict[str, float]:
    return {
        "formation_error_rms": _rms(formation.squares, formation.time),
        "formation_error_p95": percentile(histograms[FORMATION], 0.95),
        "formation_error_rms_relative": _rms(formation.relative_squares, formation.time),
    }


def _of_safety(safety: Safety) -> dict[str, float]:
    found = {"depth_max": safety.depth_max}
    if safety.altitude_min < FAR:
        found["altitude_min"] = safety.altitude_min
    if safety.fence_margin_min < FAR:
        found["geofence_margin_min"] = safety.fence_margin_min
    return found


def limits_of(flown: Flown) -> list[Limit]:
    """The limits of every vehicle, and when it first went beyond each, in the order of the mission's vehicles."""
    plan = flown.plan
    rows = flown.tables.scores.reshape(len(plan.vehicles), SCORES.width)
    place = {vehicle: row for row, vehicle in enumerate(plan.order)}
    found = []
    for k, vehicle in enumerate(plan.vehicles):
        s = _record(rows[place[k]], Safety)
        kinds = [
            ("depth_max", s.depth_limit, s.too_deep),
            ("altitude_min", s.altitude_limit, s.too_low),
            ("geofence_margin_min", s.fence_limit, s.outside),
        ]
        found += [Limit(m, vehicle.name, limit, first) for m, limit, first in kinds if abs(limit) < NEVER]
    return found


def separation_of(flown: Flown) -> list[Limit]:
    """The distance that vehicles are to keep, and who first did not; none where none is required."""
    plan, fleet = flown.plan, FleetScore(*flown.tables.fleet_score[: FLEET_SCORES.width].tolist())
    if plan.separation <= 0.0:
        return []
    names = [plan.vehicles[plan.order[int(k)]].name for k in (fleet.one, fleet.other)]
    by = " and ".join(sorted(names)) if math.isfinite(fleet.too_near) else None
    return [Limit("separation_min", None, plan.separation, fleet.too_near, by)]


def _of_talk(talk: Talk) -> dict[str, float]:
    return {
        "messages_sent": talk.sent,
        "messages_delivered": talk.delivered,
        "information_age_mean": talk.age_sum / talk.delivered if talk.delivered else math.nan,
        "information_age_max": talk.age_max if talk.delivered else math.nan,
    }


def _of_fleet(score: FleetScore) -> dict[str, float]:
    return {
        "coordination_error_rms": _rms(score.coordination_squares, score.time),
        "coordination_error_max": score.coordination_max if score.time else math.nan,
        "separation_min": math.sqrt(score.separation_squared),
    }


def _rms(squares: float, time: float) -> float:
    return math.sqrt(squares / time) if time > 0.0 else math.nan


def percentile(bins: np.ndarray, share: float) -> float:
    """The error that a share of the counted ticks stays below, from a histogram; a straight line within a bin.

    Args:
        bins: [-] (BINS,) counts; bin k holds errors e [m] with BINS e / (1 + e) in [k, k + 1).
        share: [-] between 0 and 1.

    Returns:
        The error [m]; NaN where nothing was counted.
    """
    total = bins.sum()
    if total == 0.0:
        return math.nan
    below = np.concatenate([[0.0], np.cumsum(bins)])
    k = int(np.searchsorted(below, share * total, side="left")) - 1
    k = min(max(k, 0), BINS - 1)
    within = (share * total - below[k]) / bins[k] if bins[k] else 0.0
    x = float(min((k + within) / BINS, 1.0 - 1e-9))
    return x / (1.0 - x)
