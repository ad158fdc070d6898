"""A run: a flight with its mission, its numbers and the verdict; just flown, or read back from its directory."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from cardume.errors import DataError, InputError, MissionError
from cardume.missions.log import Log, read_log
from cardume.missions.mission import Mission, Transient
from cardume.missions.source import parse_yaml
from cardume.missions.summary import Verdict, judge, read_summary
from cardume.simulation.flight import METRICS, Event, Flight, Metrics
from cardume.units import parse_quantity, printable

LOG_NAME = "log.nc"


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """A flight and all that is known of it.

    Attributes:
        flight: with its metrics.
        mission: as flown; None where its text names laws or files that are not here.
        text: the resolved mission as YAML.
        version: of the cardume that flew it.
        verdicts: one per requirement.
        duration: [s] of the whole mission.
        transient: when a vehicle counts as settled.
    """

    flight: Flight
    mission: Mission | None
    text: str
    version: str
    verdicts: tuple[Verdict, ...]
    duration: float
    transient: Transient


def run_of(mission: Mission, flight: Flight, text: str, version: str) -> Run:
    """A run that was just flown.

    Args:
        mission: as flown.
        flight: what came out.
        text: the resolved mission as YAML.
        version: of cardume.
    """
    return Run(
        flight=flight,
        mission=mission,
        text=text,
        version=version,
        verdicts=judge(mission.require, flight.metrics),
        duration=mission.duration,
        transient=mission.transient,
    )


def read_run(given: Path, allow_code: Iterable[str | Path] = ()) -> Run:
    """A run read back from its directory; its flight equals the one that was flown.

    Args:
        given: the directory of a run, or the log.nc in it.
        allow_code: folders from which the mission's own laws may be imported.

    Raises:
        DataError: no run is there, or a file of it is missing or damaged.
    """
    directory = given.parent if given.name == LOG_NAME else given
    if not directory.is_dir():
        reason = "is a file, not the directory of a run" if directory.exists() else "does not exist"
        raise DataError(f"{printable(str(directory))} {reason}; give the directory of a run, as runs/figure-5/001")
    log = read_log(directory / LOG_NAME)
    summary = read_summary(directory)
    try:
        verdicts = tuple(_verdict(found) for found in summary["requirements"])
        flight = replace(
            log.flight,
            metrics=_metrics(summary),
            wall_seconds=_number(summary["wall_seconds"]),
            events=tuple(_event(found) for found in summary.get("events", ())),  # older summaries have none
        )
        return Run(
            flight=flight,
            mission=_mission(log, directory, allow_code),
            text=log.mission,
            version=log.version,
            verdicts=verdicts,
            duration=_number(summary["duration"]),
            transient=_transient(log.mission),
        )
    except (LookupError, TypeError, ValueError, AttributeError) as problem:
        what = printable(f"{type(problem).__name__}: {problem}")[:200]
        name = printable(str(directory))
        raise DataError(f"the run in {name} is damaged ({what}); fly the mission again") from None


def _mission(log: Log, directory: Path, allow_code: Iterable[str | Path]) -> Mission | None:
    from cardume.missions.available import catalog
    from cardume.missions.loading import parse_mission

    try:
        return parse_mission(log.mission, catalog(allow_code), source="the log", directory=directory)
    except InputError:
        return None


def _transient(text: str) -> Transient:
    """From the text alone, which may name laws that are not here."""
    try:
        section = parse_yaml(text, "the log").value["transient"].value
        return Transient(
            threshold=parse_quantity(section["threshold"].value, "m"), hold=parse_quantity(section["hold"].value, "s")
        )
    except (MissionError, LookupError, TypeError, AttributeError):  # a log of another program
        return Transient()


def _metrics(summary: Mapping[str, Any]) -> Metrics:
    fleet = {n: _number(v) for n, v in summary["fleet"].items() if n in METRICS and METRICS[n].of_fleet_only}
    vehicles = {
        vehicle: {name: _number(value) for name, value in found.items()}
        for vehicle, found in summary["vehicles"].items()
    }
    return Metrics(fleet=fleet, vehicles=vehicles)


def _verdict(found: Mapping[str, Any]) -> Verdict:
    verdict = Verdict(**found)
    return verdict._replace(wanted=_number(verdict.wanted), got=_number(verdict.got))


def _event(found: Mapping[str, Any]) -> Event:
    return Event(float(found["time"]), str(found["vehicle"]), str(found["what"]), _number(found.get("until")))


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)
