"""What the numbers of a flight mean, in plain words."""

import math
from collections.abc import Iterator, Sequence
from typing import Protocol

import numpy as np

from cardume.missions.mission import Transient
from cardume.missions.summary import Verdict, is_met
from cardume.report.fault_lanes import lasting
from cardume.report.table import number, share_heard
from cardume.simulation.flight import DOUBTS, FAULT, Event, Flight

MOST_FAULTS = 6  # that are told one by one
NOTICEABLE = 0.05  # [m] of cross-track error below which its cause is not worth a sentence


class Planned(Protocol):
    """What of a mission, or of a run read back, the sentences need."""

    @property
    def duration(self) -> float:
        """[s] of the whole mission."""

    @property
    def transient(self) -> Transient:
        """When a vehicle counts as settled."""


def meaning(flight: Flight, mission: Planned, verdicts: Sequence[Verdict]) -> str:
    """A few sentences: how it ended, whether the paths were kept, why not better, and the verdict.

    Args:
        flight: what was flown.
        mission: as flown.
        verdicts: of its numbers.
    """
    parts = (
        _ending(flight, mission),
        *_gone_wrong(flight),
        *_given_up(flight),
        *_keeping(flight, mission),
        *_together(flight),
        *_verdict(flight, verdicts),
    )
    return " ".join(part for part in parts if part)


def verdict_lines(verdicts: Sequence[Verdict]) -> list[tuple[str, bool]]:
    """One line per requirement, aligned, and whether it is met."""
    rows = [
        (
            verdict.metric if verdict.vehicle is None else f"{verdict.vehicle}.{verdict.metric}",
            f"wanted {verdict.bound} {verdict.wanted:g} {verdict.unit}".rstrip(),
            _got(verdict),
        )
        for verdict in verdicts
    ]
    widths = [max((len(row[k]) for row in rows), default=0) for k in range(3)]
    return [
        (
            "  ".join([*(f"{text:<{width}}" for text, width in zip(row, widths, strict=True)), _word(verdict.met)]),
            verdict.met,
        )
        for row, verdict in zip(rows, verdicts, strict=True)
    ]


def _word(is_good: bool) -> str:
    return "met" if is_good else "MISSED"


def _got(verdict: Verdict) -> str:
    if not math.isfinite(verdict.got):
        text = "got no value"
    else:
        text = f"got {verdict.got:.4g} {verdict.unit}".rstrip()
    text = f"{text} ({verdict.worst})" if verdict.worst and verdict.vehicle is None else text
    if verdict.met or verdict.first_violated is None:
        return text
    by = f" by {verdict.by}" if verdict.by and verdict.vehicle is None else ""
    return f"{text}, first at {verdict.first_violated:g} s{by}"


def _ending(flight: Flight, mission: Planned) -> str:
    whole = f"{mission.duration:g} s"
    if flight.reason == "failed":
        return f"The mission failed at {flight.flown:g} s of {whole}: {flight.failure}."
    if flight.reason == "interrupted":
        return f"Interrupted at {flight.flown:g} s of {whole}; all below is about the part that was flown."
    wall = f", in {_duration(flight.wall_seconds)} of computing" if math.isfinite(flight.wall_seconds) else ""
    return f"Flew {whole}{wall}."


def _gone_wrong(flight: Flight) -> Iterator[str]:
    """What was scheduled to go wrong, and what the vehicles found of it."""
    faults = [event for event in flight.events if event.what.startswith(FAULT)]
    shown = [_happened(event, flight.flown) for event in faults[:MOST_FAULTS]]
    if len(faults) > MOST_FAULTS:
        shown.append(f"and {len(faults) - MOST_FAULTS} more, among the events of the summary")
    if shown:
        yield f"As scheduled, {'; '.join(shown)}."
    for event in flight.events:
        if event.what.startswith(DOUBTS):
            yield f"From {event.time:g} s {event.vehicle} did not believe{event.what.removeprefix(DOUBTS)}."


def _happened(event: Event, flown: float) -> str:
    lasted = math.isfinite(event.until)
    when = lasting(event.time, event.until, flown) if lasted else f"at {event.time:g} s"
    who = f"{event.vehicle}: " if event.vehicle else ""
    return f"{who}{event.what.removeprefix(FAULT)} ({when})"


def _given_up(flight: Flight) -> Iterator[str]:
    """Who gave up, and why."""
    for event in flight.events:
        if event.what.startswith("gives up"):
            yield f"{event.vehicle} gave up at {event.time:g} s: {event.what.partition(': ')[2]}."


def _duration(seconds: float) -> str:
    if seconds >= 0.9995:
        return f"{seconds:.3g} s"
    return f"{1000 * seconds:.2g} ms" if seconds < 0.0995 else f"{1000 * seconds:.0f} ms"


def _keeping(flight: Flight, mission: Planned) -> Iterator[str]:
    """How well the paths were kept, and whether steering or navigation limits it."""
    lost = [name for name, found in flight.metrics.vehicles.items() if math.isnan(found.get("settling_time", math.nan))]
    if lost:
        limit, hold = mission.transient.threshold, mission.transient.hold
        yield f"{_listed(lost)} never stayed within {limit:g} m of the path for {hold:g} s: most numbers are missing."
        return
    if not flight.metrics.vehicles:
        return
    last, who = flight.metrics.worst("settling_time")
    often, _ = flight.metrics.worst("cross_track_p95")
    alone = len(flight.vehicle_names) == 1
    who_reached = "The vehicle reached its path" if alone else "Every vehicle reached its path"
    after = f"after {last:.0f} s" if alone else f"the last ({who}) after {last:.0f} s"
    reached = f"{who_reached}, {after},"
    if last < 0.5:  # would be told as 0 s
        reached = "The vehicle began on its path" if alone else "Every vehicle began on its path"
    if math.isnan(often):
        yield f"{reached.removesuffix(',')}."
        return
    yield f"{reached} and from then on was within {number(often)} m of it 95 % of the time."
    yield from _cause(flight)


def _cause(flight: Flight) -> Iterator[str]:
    """Whether the vehicle that was worst was lost or steered badly, from the log's rows after it settled."""
    _, name = flight.metrics.worst("cross_track_rms")
    if name is None:
        return
    rows = flight.times >= flight.metrics.vehicles[name].get("settling_time", math.nan)
    place = flight.vehicle_names.index(name)
    true, believed = (flight.channels[c][rows, place] for c in ("cross_track", "cross_track_estimate"))
    misjudged = _rms(believed - true)
    if not _rms(true) > NOTICEABLE or math.isnan(misjudged):
        return
    who = "It" if len(flight.vehicle_names) == 1 else f"{name}, the worst,"
    if misjudged > 0.6 * _rms(true):
        yield f"{who} misjudged its error by {number(misjudged)} m rms: knowing where it is limits it, not steering."
    else:
        how_well = f"to {number(misjudged)} m rms" if misjudged >= 1e-3 else "exactly"
        yield f"{who} knew its error {how_well}: steering limits it, not knowing where it is."


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2))) if values.size else math.nan


def _together(flight: Flight) -> Iterator[str]:
    if len(flight.vehicle_names) == 1:
        return
    rms, worst = (flight.metrics.worst(f"coordination_error_{kind}")[0] for kind in ("rms", "max"))
    if math.isfinite(rms):
        yield f"Along the path they kept together to {number(rms)} m rms, {number(worst)} m at worst."
    nearest, _ = flight.metrics.worst("separation_min")
    if math.isfinite(nearest):
        yield f"No two came closer than {number(nearest)} m."
    heard = share_heard(flight)
    if heard < 0.995:
        yield f"{100 * (1 - heard):.0f} % of the messages were lost."


def _verdict(flight: Flight, verdicts: Sequence[Verdict]) -> Iterator[str]:
    met, missed = is_met(flight, verdicts), [v.metric for v in verdicts if not v.met]
    if met:
        yield "All that was required is met." if len(verdicts) > 1 else "What was required is met."
    elif met is False:
        yield (
            f"Missed: {_listed(missed)}, of {len(verdicts)} required." if len(verdicts) > 1 else f"Missed: {missed[0]}."
        )
    elif verdicts:
        yield "What was required cannot be judged, for the mission did not come to its end."


def _listed(names: Sequence[str], most: int = 4) -> str:
    shown = list(dict.fromkeys(names))
    if len(shown) > most:
        return f"{', '.join(shown[:most])} and {len(shown) - most} more"
    return " and ".join([", ".join(shown[:-1]), shown[-1]] if len(shown) > 1 else shown)
