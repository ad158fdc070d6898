"""Metrics of a flight, from the sums that the engine kept."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cardume.onboard.mind import NEVER
from cardume.paths.table import LENGTH_REFERENCE
from cardume.simulation.flight import METRICS, Limit, Metrics
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
    found = measure([flown])
    vehicles = {
        vehicle.name: {
            name: _number(values[0, k]) for name, values in found.vehicles.items() if not found.is_absent(name)[0, k]
        }
        for k, vehicle in enumerate(flown.plan.vehicles)
    }
    fleet = {name: _number(values[0]) for name, values in found.fleet.items()}
    limits = (*limits_of(flown), *separation_of(flown)) if flown.plan.is_watched else ()
    return Metrics(fleet=fleet, vehicles=vehicles, limits=limits)


def _number(value: float) -> float:
    """The number; of those that are none always the same one, so that equal metrics compare as equal."""
    return float(value) if value == value else math.nan


@dataclass(frozen=True)
class Measured:
    """The metrics of several flights of one fleet.

    Attributes:
        vehicles: each metric that vehicles have, (run, vehicle) in the order of the mission's vehicles; NaN: no value.
        fleet: each metric of the fleet only, (run,).
        absent: (run, vehicle) where a vehicle does not have a metric at all, of those that some lack.
        limits: of a metric, (run, vehicle) limits that are not to be exceeded, beyond NEVER where there is none, and
            (run, vehicle) [s] when each was first; of the separation all vehicles have the fleet's.
    """

    vehicles: Mapping[str, np.ndarray]
    fleet: Mapping[str, np.ndarray]
    absent: Mapping[str, np.ndarray]
    limits: Mapping[str, tuple[np.ndarray, np.ndarray]]

    def is_absent(self, name: str) -> np.ndarray:
        """(run, vehicle) where a vehicle does not have a metric of vehicles at all."""
        return self.absent.get(name, np.zeros(self.vehicles[name].shape, bool))

    def worst(self, name: str) -> np.ndarray:
        """(run,) of the fleet's value of a metric, as `Metrics.worst` says it.

        Args:
            name: one that it has.
        """
        if name in self.fleet:
            return self.fleet[name]
        values, is_absent = self.vehicles[name], self.is_absent(name)
        badness = -values if METRICS[name].wanted == "at least" else values
        badness = np.where(is_absent, -np.inf, np.where(np.isnan(values), np.inf, badness))
        found = np.take_along_axis(values, badness.argmax(axis=1)[:, None], axis=1)[:, 0]
        return np.where(is_absent.all(axis=1), np.nan, found)


def measure(flown: Sequence[Flown]) -> Measured:
    """The metrics of several flights.

    Args:
        flown: missions of the same fleet after their flight; of their tables scores and histograms are read.
    """
    plans = [one.plan for one in flown]
    size, back = len(plans[0].vehicles), np.argsort(plans[0].order)
    rows = np.stack([one.tables.scores for one in flown]).reshape(len(flown), size, SCORES.width)[:, back]
    histograms = np.stack([one.tables.histograms for one in flown]).reshape(len(flown), size, HISTOGRAMS, BINS)[:, back]
    ticks = np.array([[plan.tick] for plan in plans])
    lengths = np.array([[vehicle.path[LENGTH_REFERENCE] for vehicle in plan.vehicles] for plan in plans])
    swaths = np.array([[plan.rules.swath] for plan in plans])
    is_watched = np.array([[plan.is_watched] for plan in plans])
    score, safety = _record(rows, Score), _record(rows, Safety)
    found, absent = _of_path(score, histograms, ticks) | _of_talk(_record(rows, Talk)), {}
    with np.errstate(invalid="ignore", divide="ignore"):
        if size > 1:
            found |= _of_formation(_record(rows, Formation), histograms)
        if (swaths > 0.0).any():
            found["swath_coverage"] = 100.0 * np.minimum(1.0, score.swept / lengths)
            absent["swath_coverage"] = np.broadcast_to(swaths <= 0.0, lengths.shape)
    limits = {}
    if is_watched.any():
        limits = {
            "depth_max": (safety.depth_limit, safety.too_deep),
            "altitude_min": (safety.altitude_limit, safety.too_low),
            "geofence_margin_min": (safety.fence_limit, safety.outside),
        }
        extremes = {"depth_max": safety.depth_max}
        extremes |= {"altitude_min": safety.altitude_min, "geofence_margin_min": safety.fence_margin_min}
        for name, values in extremes.items():
            lacking = ~(values < FAR) | ~is_watched
            if not lacking.all():
                found[name], absent[name] = values, lacking
    fleet = FleetScore(*np.stack([one.tables.fleet_score[: FLEET_SCORES.width] for one in flown]).T)
    if np.greater(fleet.separation_limit, 0.0).any():
        least = np.where(np.greater(fleet.separation_limit, 0.0), fleet.separation_limit, -NEVER)
        limits["separation_min"] = least[:, None], np.asarray(fleet.too_near)[:, None]
    return Measured(found, _of_fleet(fleet) if size > 1 else {}, absent, limits)


def _record(rows: np.ndarray, record: Any) -> Any:
    """A record of (run, vehicle) arrays."""
    start = SCORES.offsets[record]
    return record(*(rows[..., start + k] for k in range(len(record._fields))))


def _of_path(score: Score, histograms: np.ndarray, tick: np.ndarray) -> dict[str, np.ndarray]:
    counted = np.add(score.line_time, score.arc_time)
    steps = counted - tick  # [s] between the first and the last tick that count
    return {
        "cross_track_rms": _rms(np.add(score.line_squares, score.arc_squares), counted),
        "cross_track_p95": percentile(histograms[..., CROSS_TRACK, :], 0.95),
        "cross_track_max": np.where(counted != 0.0, score.cross_track_max, np.nan),
        "cross_track_rms_lines": _rms(score.line_squares, score.line_time),
        "cross_track_rms_arcs": _rms(score.arc_squares, score.arc_time),
        "cross_track_iae": np.asarray(score.absolute_error),
        "settling_time": np.where(np.not_equal(score.settled, 0.0), score.settling_time, np.nan),
        "position_error_rms": _rms(score.position_squares, score.flown),
        "current_error_rms": _rms(score.current_squares, score.flown),
        "path_speed_mean": _ratio(score.progress, steps, steps > 0.5 * tick),
        "energy": np.asarray(score.energy),
        "yaw_effort": np.asarray(score.yaw_effort),
    }


def _of_formation(formation: Formation, histograms: np.ndarray) -> dict[str, np.ndarray]:
    return {
        "formation_error_rms": _rms(formation.squares, formation.time),
        "formation_error_p95": percentile(histograms[..., FORMATION, :], 0.95),
        "formation_error_rms_relative": _rms(formation.relative_squares, formation.time),
    }


def limits_of(flown: Flown) -> list[Limit]:
    """The limits of every vehicle, and when it first went beyond each, in the order of the mission's vehicles."""
    plan = flown.plan
    rows = flown.tables.scores.reshape(len(plan.vehicles), SCORES.width)
    place = {vehicle: row for row, vehicle in enumerate(plan.order)}
    found = []
    for k, vehicle in enumerate(plan.vehicles):
        s = Safety(*(float(x) for x in _record(rows[place[k]], Safety)))
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


def _of_talk(talk: Talk) -> dict[str, np.ndarray]:
    has_heard = np.not_equal(talk.delivered, 0.0)
    return {
        "messages_sent": np.asarray(talk.sent),
        "messages_delivered": np.asarray(talk.delivered),
        "information_age_mean": _ratio(talk.age_sum, talk.delivered, has_heard),
        "information_age_max": np.where(has_heard, talk.age_max, np.nan),
    }


def _of_fleet(score: FleetScore) -> dict[str, np.ndarray]:
    return {
        "coordination_error_rms": _rms(score.coordination_squares, score.time),
        "coordination_error_max": np.where(np.not_equal(score.time, 0.0), score.coordination_max, np.nan),
        "separation_min": np.sqrt(score.separation_squared),
    }


def _rms(squares: Any, time: Any) -> np.ndarray:
    return np.sqrt(_ratio(squares, time, np.greater(time, 0.0)))


def _ratio(above: Any, below: Any, where: np.ndarray) -> np.ndarray:
    """A quotient, NaN elsewhere."""
    return np.divide(above, below, out=np.full(where.shape, np.nan), where=where)


def percentile(bins: np.ndarray, share: float) -> np.ndarray:
    """The error that a share of the counted ticks stays below, from a histogram; a straight line within a bin.

    Args:
        bins: [-] (N, BINS) counts, or with more axes before; bin k holds errors e [m] with BINS e / (1 + e) in
            [k, k + 1).
        share: [-] between 0 and 1.

    Returns:
        (N,) the errors [m]; NaN where nothing was counted.
    """
    total = bins.sum(axis=-1)
    above = np.cumsum(bins, axis=-1)  # at the upper end of each bin
    wanted = share * total
    k = np.minimum((above < wanted[..., None]).sum(axis=-1), BINS - 1)[..., None]
    inside = np.take_along_axis(bins, k, axis=-1)[..., 0]
    below = np.take_along_axis(above, k, axis=-1)[..., 0] - inside  # counts are whole numbers: exact
    within = _ratio(wanted - below, inside, inside != 0.0)
    x = np.minimum((k[..., 0] + np.where(inside != 0.0, within, 0.0)) / BINS, 1.0 - 1e-9)
    return np.where(total != 0.0, x / (1.0 - x), np.nan)
