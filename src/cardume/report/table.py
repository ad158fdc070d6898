"""The numbers of a flight as a table of plain text, as wide as the terminal and no wider."""

import math
import textwrap
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from cardume.simulation.flight import Flight

NARROWEST_NAME, WIDEST_NAME = 9, 20
ROOMY = 100  # characters from which columns stand two apart
MOST_ROWS = 20  # vehicles shown; of a larger fleet, the worst
NOTHING = "-"


class Column(NamedTuple):
    """A column, left out where the terminal is too narrow for its rank or nothing is known of it."""

    rank: int
    group: str  # heading over neighbors that share it
    heading: str
    metric: str
    is_fleets: bool = False


COLUMNS = (
    Column(1, "cross-track [m]", "rms", "cross_track_rms"),
    Column(3, "cross-track [m]", "95 %", "cross_track_p95"),
    Column(2, "cross-track [m]", "max", "cross_track_max"),
    Column(11, "rms on [m]", "lines", "cross_track_rms_lines"),
    Column(12, "rms on [m]", "arcs", "cross_track_rms_arcs"),
    Column(4, "settled", "[s]", "settling_time"),
    Column(6, "position", "error [m]", "position_error_rms"),
    Column(8, "current", "[m/s]", "current_error_rms"),
    Column(5, "coord.", "rms", "coordination_error_rms", is_fleets=True),
    Column(10, "coord.", "max", "coordination_error_max", is_fleets=True),
    Column(9, "formation", "rms [m]", "formation_error_rms"),
    Column(7, "messages", "heard", "heard"),
    Column(13, "news", "age [s]", "information_age_mean"),
    Column(14, "path speed", "[m/s]", "path_speed_mean"),
    Column(15, "energy", "[J]", "energy"),
)
ALWAYS = 4  # columns of this rank and before stay even when nothing is known of them


def results_table(flight: Flight, width: int) -> str:
    """One row per vehicle and one for the fleet, in ASCII.

    Args:
        flight: what was flown.
        width: [characters] of the terminal.
    """
    shown = _shown_vehicles(flight)
    labels = [*shown, *(["fleet"] if len(flight.vehicle_names) > 1 else [])]
    columns = [(column, cells_of(column, flight, shown)) for column in COLUMNS]
    gap = 2 if width >= ROOMY else 1
    chosen = _fitting(columns, width - NARROWEST_NAME, gap)
    widths = _widths(chosen, gap)
    longest = min(max(len(label) for label in labels), WIDEST_NAME, width - sum(widths) - gap * len(widths))
    first = max(NARROWEST_NAME, longest)

    def line(label: str, texts: Sequence[str]) -> str:
        joined = "".join(f"{' ' * gap}{text:>{room}}" for room, text in zip(widths, texts, strict=True))
        return f"{_cut(label, first):<{first}}{joined}".rstrip()

    heading = line("vehicle", [column.heading for column, _ in chosen])
    body = [line(label, [cells[row] for _, cells in chosen]) for row, label in enumerate(labels)]
    groups = " " * first + _group_line(chosen, widths, gap)
    return "\n".join([groups.rstrip(), heading, "-" * len(heading), *body, *_footnotes(flight, shown, width)])


def _widths(chosen: Sequence[tuple[Column, Sequence[str]]], gap: int) -> list[int]:
    """Of the columns; the first of a group makes room for a long heading over it."""
    widths = [max(len(text) for text in (column.heading, *cells)) for column, cells in chosen]
    for members in _groups(chosen):
        taken = sum(widths[k] for k in members) + gap * (len(members) - 1)
        widths[members[0]] += max(0, len(chosen[members[0]][0].group) - taken)
    return widths


def _groups(chosen: Sequence[tuple[Column, Sequence[str]]]) -> list[list[int]]:
    groups: list[list[int]] = []
    for k, (column, _) in enumerate(chosen):
        if groups and chosen[groups[-1][0]][0].group == column.group:
            groups[-1].append(k)
        else:
            groups.append([k])
    return groups


def _group_line(chosen: Sequence[tuple[Column, Sequence[str]]], widths: Sequence[int], gap: int) -> str:
    texts = []
    for members in _groups(chosen):
        room = sum(widths[k] for k in members) + gap * (len(members) - 1)
        texts.append(f"{' ' * gap}{chosen[members[0]][0].group:>{room}}")
    return "".join(texts)


def number(value: float) -> str:
    """A number of three digits, or more before the point; a dash for NaN."""
    if not math.isfinite(value):
        return NOTHING
    digits = 3 if abs(value) < 1.0 else 2 if abs(value) < 10.0 else 1 if abs(value) < 100.0 else 0
    return f"{value:.{digits}f}"


def share_heard(flight: Flight, receiver: int | None = None) -> float:
    """Share of the messages meant for a vehicle, or for all, that was not lost; NaN where there were none.

    Args:
        flight: what was flown.
        receiver: place in the fleet.
    """
    lost = np.asarray(flight.messages["lost"], float)
    if receiver is not None:
        lost = lost[np.asarray(flight.messages["receiver"]) == receiver]
    return float(1.0 - lost.mean()) if lost.size else math.nan


def cells_of(column: Column, flight: Flight, shown: Sequence[str]) -> list[str]:
    """The texts of a column: the vehicles', then the fleet's.

    Args:
        column: of COLUMNS.
        flight: what was flown.
        shown: names of vehicles.
    """
    if column.metric == "heard":
        places = [flight.vehicle_names.index(name) for name in shown]
        return [_percent(share_heard(flight, place)) for place in (*places, None)]
    of_vehicles = [flight.metrics.vehicles.get(name, {}).get(column.metric, math.nan) for name in shown]
    of_fleet = flight.metrics.worst(column.metric)[0]
    if column.is_fleets:
        return [*([""] * len(shown)), number(of_fleet) if len(flight.vehicle_names) > 1 else NOTHING]
    return [number(value) for value in (*of_vehicles, of_fleet)]


def _percent(share: float) -> str:
    return f"{100.0 * share:.0f} %" if math.isfinite(share) else NOTHING


def _fitting(
    columns: Sequence[tuple[Column, Sequence[str]]], room: int, gap: int
) -> list[tuple[Column, Sequence[str]]]:
    """The columns that fit, the more important ones first; one without a single number takes no room."""
    chosen: list[tuple[Column, Sequence[str]]] = []
    for candidate in sorted(columns, key=lambda pair: pair[0].rank):
        column, cells = candidate
        if column.rank > ALWAYS and all(text in (NOTHING, "") for text in cells):
            continue
        wider = sorted([*chosen, candidate], key=lambda pair: COLUMNS.index(pair[0]))
        if sum(_widths(wider, gap)) + gap * len(wider) <= room:
            chosen = wider
    return chosen


def _shown_vehicles(flight: Flight) -> tuple[str, ...]:
    names = flight.vehicle_names
    if len(names) <= MOST_ROWS:
        return names
    worst = set(sorted(names, key=lambda name: -_or_worst(flight, name))[:MOST_ROWS])
    return tuple(name for name in names if name in worst)


def _or_worst(flight: Flight, name: str) -> float:
    value = flight.metrics.vehicles.get(name, {}).get("cross_track_rms", math.nan)
    return value if math.isfinite(value) else math.inf


def _footnotes(flight: Flight, shown: Sequence[str], width: int) -> list[str]:
    hidden = len(flight.vehicle_names) - len(shown)
    notes = [f"{hidden} vehicles with smaller errors are not shown; all are in summary.json"] if hidden else []
    if len(flight.vehicle_names) > 1:
        notes.append("fleet: the worst vehicle; coord.: largest difference along the reference path [m]")
    return [textwrap.fill(note, max(width, 20)) for note in notes]


def _cut(text: str, longest: int) -> str:
    return text if len(text) <= longest else text[: longest - 2] + ".."
