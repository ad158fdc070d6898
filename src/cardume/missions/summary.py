"""`summary.json`: the numbers of a flight, and whether they are what the mission required."""

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from cardume.errors import DataError
from cardume.missions.mission import Requirement
from cardume.simulation.flight import METRICS, Event, Flight, Limit, Metrics
from cardume.units import printable

FORMAT_VERSION = 1
FILE_NAME = "summary.json"


class Verdict(NamedTuple):
    """One requirement: what was wanted, what was got."""

    metric: str
    unit: str
    bound: str  # "at most" or "at least"
    wanted: float  # [unit]
    got: float  # [unit] NaN where the metric has no value
    vehicle: str | None  # whose value was required; None: of the fleet
    worst: str | None  # whose value it is; None where it is the fleet's own
    met: bool
    margin: float = math.nan  # [unit] by which it is met, < 0: by which it is missed
    first_violated: float | None = None  # [s] None: never, or not known of this metric
    by: str | None = None  # who did then


def judge(requirements: Iterable[Requirement], metrics: Metrics) -> tuple[Verdict, ...]:
    """Hold a flight's numbers against what the mission requires; a metric without a value meets nothing.

    Args:
        requirements: of the mission, in the units of METRICS.
        metrics: of the flight.

    The limits that vehicles have of their own are judged as requirements too, those of all alike as one of the fleet.
    """
    required = all_required(requirements, metrics.limits, len(metrics.vehicles))
    return tuple(_judge_one(requirement, metrics) for requirement in required)


def all_required(requirements: Iterable[Requirement], limits: Sequence[Limit], num_vehicles: int) -> list[Requirement]:
    """What the mission requires, and the limits that vehicles have of their own.

    Args:
        requirements: of the mission.
        limits: of its vehicles.
        num_vehicles: how many it has.
    """
    required = [*requirements]
    own = _own_limits(limits, num_vehicles)
    return required + [limit for limit in own if not any(_covers(r, limit) for r in required)]


def _own_limits(limits: Sequence[Limit], num_vehicles: int) -> list[Requirement]:
    """The limits of the vehicles as requirements, each once."""
    found: list[Requirement] = []
    for metric, value in dict.fromkeys((limit.metric, limit.limit) for limit in limits):
        names = [limit.vehicle for limit in limits if (limit.metric, limit.limit) == (metric, value)]
        of = [None] if None in names or len(names) == num_vehicles else names
        found += [Requirement(metric=metric, limit=value, unit=METRICS[metric].unit, vehicle=name) for name in of]
    return found


def _covers(given: Requirement, limit: Requirement) -> bool:
    same = (given.metric, given.limit) == (limit.metric, limit.limit)
    return same and given.vehicle in (None, limit.vehicle)


def _judge_one(requirement: Requirement, metrics: Metrics) -> Verdict:
    metric, vehicle, worst = METRICS[requirement.metric], requirement.vehicle, requirement.vehicle
    if vehicle is None:
        got, worst = metrics.worst(requirement.metric)
    else:
        got = metrics.vehicles[vehicle].get(requirement.metric, math.nan)
    met = got >= requirement.limit if metric.wanted == "at least" else got <= requirement.limit
    margin = got - requirement.limit if metric.wanted == "at least" else requirement.limit - got
    first, by = _first_violation(requirement, metrics)
    bound, limit = metric.wanted, requirement.limit
    return Verdict(requirement.metric, metric.unit, bound, limit, got, vehicle, worst, bool(met), margin, first, by)


def _first_violation(requirement: Requirement, metrics: Metrics) -> tuple[float | None, str | None]:
    """When a requirement was first not met [s], and by whom, where that is known."""
    times = [
        (limit.first_violated, limit.by or limit.vehicle)
        for limit in metrics.limits
        if (limit.metric, limit.limit) == (requirement.metric, requirement.limit)
        and requirement.vehicle in (None, limit.vehicle)
        and math.isfinite(limit.first_violated)
    ]
    return min(times, key=lambda item: item[0], default=(None, None))


def is_met(flight: Flight, verdicts: Sequence[Verdict]) -> bool | None:
    """Whether all is as required; None where nothing is, or where the mission did not come to its end.

    Args:
        flight: what was flown.
        verdicts: of its numbers.
    """
    if not verdicts or flight.reason != "completed":
        return None
    return all(verdict.met for verdict in verdicts)


def summarize(
    flight: Flight, verdicts: Sequence[Verdict], *, duration: float, version: str, files: Sequence[str] = ()
) -> dict[str, Any]:
    """The summary as plain values; what is no number becomes None.

    Args:
        flight: what was flown.
        verdicts: of its numbers.
        duration: [s] of the whole mission.
        version: of cardume.
        files: written beside the summary.
    """
    names = [name for name in METRICS if _has(flight.metrics, name)]
    fleet = {name: flight.metrics.worst(name)[0] for name in names}
    return {
        "cardume_summary": FORMAT_VERSION,
        "mission": flight.mission_name,
        "version": version,
        "seed": int(flight.seed),
        "reason": flight.reason,
        "failure": flight.failure,
        "requirements_met": is_met(flight, verdicts),
        "duration": _plain(duration),
        "flown": _plain(flight.flown),
        "wall_seconds": _plain(flight.wall_seconds),
        "requirements": [_requirement(verdict) for verdict in verdicts],
        "events": [_event(event) for event in flight.events],
        "fleet": _numbers(fleet),
        "vehicles": {name: _numbers(flight.metrics.vehicles.get(name, {})) for name in flight.vehicle_names},
        "units": {name: METRICS[name].unit for name in names},
        "files": list(files),
    }


def _event(event: Event) -> dict[str, Any]:
    return event._asdict() | {"until": _plain(event.until)}


def to_json(summary: Mapping[str, Any]) -> str:
    """Strict JSON: no NaN, no infinity, ASCII only."""
    return json.dumps(summary, indent=2, allow_nan=False) + "\n"


def read_summary(directory: Path) -> dict[str, Any]:
    """The summary in a run's directory.

    Args:
        directory: of the run.

    Raises:
        DataError: missing, damaged, or not written by cardume.
    """
    path = directory / FILE_NAME
    found = read_kept(path, "cardume_summary", "a run", "fly the mission again")
    if found["cardume_summary"] != FORMAT_VERSION:
        said = printable(str(found["cardume_summary"]))[:40]
        raise DataError(f"{printable(str(path))} has format {said}; this cardume reads format {FORMAT_VERSION}")
    return found


def read_kept(path: Path, mark: str, what: str, again: str) -> dict[str, Any]:
    """A JSON file of ours, which lists the `files` that were written beside it.

    Args:
        path: of the file.
        mark: the key by which it is known as ours.
        what: its directory is the directory of.
        again: what to do where it is damaged.

    Raises:
        DataError: missing, damaged, or not written by cardume.
    """
    name = printable(str(path))
    try:
        found = json.loads(path.read_bytes())
    except OSError as problem:
        raise DataError(f"{name} cannot be read: {problem.strerror}; give the directory of {what}") from None
    except (ValueError, RecursionError):
        raise DataError(f"{name} is damaged: it is not JSON; {again}") from None
    if not isinstance(found, dict) or mark not in found:
        raise DataError(f"{name} was not written by cardume; give the directory of {what}")
    if not is_list_of_files(found):
        raise DataError(f"{name} is damaged: its 'files' is no list of names; {again}")
    return found


def is_list_of_files(found: Mapping[str, Any]) -> bool:
    """Whether the `files` of a summary, if it has any, are a list of names.

    Args:
        found: what was read, of a run or of a comparison.
    """
    files = found.get("files", [])
    return isinstance(files, list) and all(isinstance(name, str) for name in files)


def _has(metrics: Metrics, name: str) -> bool:
    return name in metrics.fleet or any(name in found for found in metrics.vehicles.values())


def _numbers(values: Mapping[str, float]) -> dict[str, float | int | None]:
    """In the order of METRICS, counts as whole numbers."""
    return {name: _plain(values[name], METRICS[name].unit == "") for name in METRICS if name in values}


def _plain(value: float, is_count: bool = False) -> float | int | None:
    value = float(value)
    if not math.isfinite(value):
        return None
    return int(value) if is_count and value.is_integer() else value


def _requirement(verdict: Verdict) -> dict[str, Any]:
    plain = verdict._asdict()
    numbers = {key: _plain(plain[key]) for key in ("wanted", "got", "margin")}
    return plain | numbers
