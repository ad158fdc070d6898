"""What a mission requires of each of its runs: the limits of `require`, and those that vehicles have of their own.

A limit is fixed where nothing that is drawn or swept can change it, and drawn elsewhere.  The mission alone decides
that, so all runs of a study are judged by the same requirements, however the work was cut.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from cardume.errors import InputError
from cardume.missions.distributions import Normal, Uniform, Varying, shared_key
from cardume.missions.mission import Mission, Requirement
from cardume.missions.summary import all_required
from cardume.missions.vehicle import Vehicle
from cardume.onboard.mind import NEVER
from cardume.simulation.flight import METRICS, Limit
from cardume.simulation.results import Measured
from cardume.studies.constants import FLEET
from cardume.units import show_quantity

# Of what vehicles have limits of their own, and the key of each below `limits`.
LIMITED = {"depth_max": "depth", "altitude_min": "altitude", "geofence_margin_min": "geofence"}


class Wanted(NamedTuple):
    """One requirement, as every run is judged by it."""

    name: str  # as people read it
    metric: str
    vehicle: str | None  # whose value is required; None: the fleet's
    limit: float  # in the metric's unit; NaN: drawn, each run has its own

    @property
    def is_drawn(self) -> bool:
        """Whether runs have different limits."""
        return math.isnan(self.limit)


class _Own(NamedTuple):
    """A limit of a vehicle's own: all that it may be at its ends, and the keys on which that depends."""

    ends: frozenset[float]
    keys: frozenset[str]


def wanted_of(mission: Mission) -> tuple[Wanted, ...]:
    """What a mission requires, then the limits that vehicles have of their own, fixed ones first.

    Args:
        mission: also with distributions and sweeps.

    Raises:
        InputError: two requirements that read alike.
    """
    fixed: list[Limit] = []
    drawn: list[Wanted] = []
    for metric in LIMITED:
        own = {vehicle.name: _own_limit(mission, vehicle, metric) for vehicle in mission.vehicles}
        if len(set(own.values())) == 1 and _varies(next(iter(own.values()))):  # one for all
            drawn.append(_drawn(metric, None))
            continue
        drawn += [_drawn(metric, name) for name, one in own.items() if _varies(one)]
        fixed += [
            Limit(metric, name, limit)
            for name, one in own.items()
            for limit in one.ends
            if not _varies(one)
            if abs(limit) < NEVER
        ]
    found = [_fixed(one) for one in all_required(mission.require, fixed, len(mission.vehicles))] + drawn
    names = [one.name for one in found]
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise InputError(f"two requirements read alike, {twice}; let them differ by more, or leave one out")
    return tuple(found)


def judge_runs(
    wanted: Wanted, count: int, metrics: Mapping[str, np.ndarray], measured: Measured, names: Sequence[str]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of every run the value, whether it is what is wanted, and when that was first violated, if it is known.

    Args:
        wanted: of them.
        count: of runs.
        metrics: as a `RunTable` has them.
        measured: of the same runs.
        names: of the vehicles.

    Returns:
        (run,) values in the metric's unit, (run,) verdicts, (run,) [s], NaN where not known.
    """
    metric, k = wanted.metric, None if wanted.vehicle is None else names.index(wanted.vehicle)
    is_least = METRICS[metric].wanted == "at least"
    none = np.full(count, np.nan)
    if k is None:
        got = metrics.get(FLEET + metric, none)
    else:
        got = metrics[metric][:, k] if metric in metrics else none
    never = -NEVER if is_least else NEVER
    limits, first = measured.limits.get(metric, (np.full((count, 1), never), np.full((count, 1), np.nan)))
    limit = limits[:, k or 0] if wanted.is_drawn else np.full(count, wanted.limit)
    met = got >= limit if is_least else got <= limit
    if wanted.is_drawn:
        met |= np.abs(limit) >= NEVER  # nothing is required of this run
    concerned = range(limits.shape[1]) if k is None or limits.shape[1] == 1 else [k]
    when = np.full(count, np.inf)
    for j in concerned:
        happened = (limits[:, j] == limit) & np.isfinite(first[:, j])
        when = np.where(happened, np.minimum(when, first[:, j]), when)
    return got, met, np.where(np.isfinite(when), when, np.nan)


def _own_limit(mission: Mission, vehicle: Vehicle, metric: str) -> _Own:
    """The stricter of a vehicle's own limit and what is required of it, as `missions.orders.safety_of` has it."""
    required = [r.limit for r in mission.require if r.metric == metric and r.vehicle in (None, vehicle.name)]
    is_least = METRICS[metric].wanted == "at least"
    never = -NEVER if is_least else NEVER
    stricter = max if is_least else min
    ends: set[float] = set()
    keys: set[str] = set()

    def ends_of(value: Any, key: str) -> list[Any]:
        if not isinstance(value, Varying):
            return [value]
        keys.add(shared_key(key, value))
        if isinstance(value, Uniform):
            return [value.low, value.high]
        if isinstance(value, Normal):
            return [value.bounds.low, value.bounds.high] if value.deviation > 0.0 else [value.mean]
        return list(value.options)

    here = f"vehicles.{vehicle.name}.limits"
    for limits in ends_of(vehicle.limits, here):
        for value in ends_of(getattr(limits, LIMITED[metric], None), f"{here}.{LIMITED[metric]}"):
            own = never if value is None else 0.0 if metric == "geofence_margin_min" else float(value)
            ends.add(stricter([own, *required]))
    return _Own(frozenset(ends), frozenset(keys) if len(ends) > 1 else frozenset())


def _varies(own: _Own) -> bool:
    return len(own.ends) > 1


def _fixed(required: Requirement) -> Wanted:
    limit = show_quantity(required.limit, METRICS[required.metric].unit, 12)
    return Wanted(
        _name(required.metric, required.vehicle, limit), required.metric, required.vehicle, float(required.limit)
    )


def _drawn(metric: str, vehicle: str | None) -> Wanted:
    return Wanted(_name(metric, vehicle, "its limit"), metric, vehicle, math.nan)


def _name(metric: str, vehicle: str | None, limit: str) -> str:
    sign = ">=" if METRICS[metric].wanted == "at least" else "<="
    return f"{f'{vehicle}: ' if vehicle else ''}{metric} {sign} {limit}"
