"""The tables of the page, in HTML; every text from the mission is escaped here."""

import html
import math
import re
from collections.abc import Sequence

from cardume.missions.runs import Run
from cardume.missions.summary import Verdict, is_met
from cardume.report.page.store import color
from cardume.report.table import COLUMNS, NOTHING, Column, cells_of
from cardume.simulation.flight import METRICS, Flight

NO_BREAK = "\u00a0"  # between a number and its unit, which belong on one line
MOST_VEHICLES = 60  # in the tables
NOW = (
    *("north [m]", "east [m]", "depth [m]", "heading [deg]", "speed over ground [m/s]"),
    *("cross-track error [m]", "cross-track error believed [m]", "position error [m]"),
)


def badge(run: Run) -> tuple[str, str]:
    """The verdict in a few words, and its class: good, bad or neutral.

    Args:
        run: just flown or read back.
    """
    if run.flight.reason == "failed":
        return "✗ Failed while flying", "bad"
    if run.flight.reason == "interrupted":
        return "Interrupted", "neutral"
    met = is_met(run.flight, run.verdicts)
    if met is None:
        return "Flown; nothing was required", "neutral"
    return ("✓ Requirements met", "good") if met else ("✗ Requirements missed", "bad")


def requirements_table(verdicts: Sequence[Verdict]) -> str:
    """What was required, what came out; nothing where nothing was.

    Args:
        verdicts: one per requirement.
    """
    if not verdicts:
        return ""
    rows = "".join(_requirement(verdict) for verdict in verdicts)
    head = "<tr><th>Required</th><th>wanted</th><th>got</th><th></th></tr>"
    return _table("required", head, rows)


def subject_of(verdict: Verdict) -> str:
    """What is required, and of whom, in words.

    Args:
        verdict: of the flight.
    """
    name = verdict.metric.replace("cross_track", "cross-track").replace("_", " ")
    return f"{verdict.vehicle}: {name}" if verdict.vehicle else name


def _requirement(verdict: Verdict) -> str:
    got = f"{verdict.got:.4g}{NO_BREAK}{verdict.unit}" if math.isfinite(verdict.got) else "no value"
    if verdict.worst and not verdict.vehicle:
        got += f" ({verdict.worst})"
    word, kind = ("✓ met", "good") if verdict.met else ("✗ missed", "bad")
    meaning = METRICS[verdict.metric].meaning if verdict.metric in METRICS else ""
    texts = [subject_of(verdict), f"{verdict.bound} {verdict.wanted:g}{NO_BREAK}{verdict.unit}", got]
    cells = "".join(f"<td>{html.escape(text)}</td>" for text in texts)
    return f'<tr title="{html.escape(meaning)}">{cells}<td class="text {kind}"><b>{word}</b></td></tr>'


def numbers_table(flight: Flight) -> str:
    """The metrics: one row each, a column per vehicle and one for the fleet.

    Args:
        flight: what was flown.
    """
    shown = flight.vehicle_names[:MOST_VEHICLES]
    found = [(column, cells_of(column, flight, shown)) for column in COLUMNS]
    known = [(column, cells) for column, cells in found if any(text not in (NOTHING, "") for text in cells)]
    is_fleet = len(flight.vehicle_names) > 1
    rows = []
    for column, cells in known:
        texts = cells if is_fleet else cells[:-1]
        numbers = "".join(f"<td>{html.escape(text)}</td>" for text in texts)
        title, words = html.escape(meaning_of(column.metric)), html.escape(words_of(column))
        rows.append(f'<tr title="{title}"><td>{words}</td>{numbers}</tr>')
    head = f"{_vehicle_heads(flight, len(shown))}{'<th>fleet</th>' if is_fleet else ''}"
    return _table("numbers", f"<tr><th></th>{head}</tr>", "".join(rows))


def words_of(column: Column) -> str:
    """A metric in words, its unit last.

    Args:
        column: of the table of numbers.
    """
    words = " ".join(re.sub(r"\[.*?\]", "", f"{column.group} {column.heading}").split()).replace(
        "coord.", "coordination"
    )
    unit = METRICS[column.metric].unit if column.metric in METRICS else ""
    return f"{words} [{unit}]" if unit else words


def meaning_of(metric: str) -> str:
    """What a column of the table of numbers says, in a sentence.

    Args:
        metric: of the column.
    """
    return METRICS[metric].meaning if metric in METRICS else "share of the messages meant for it that arrived"


def now_table(flight: Flight) -> str:
    """Where everything is at the time of the slider; the page fills it in.

    Args:
        flight: what was flown.
    """
    count = min(len(flight.vehicle_names), MOST_VEHICLES)
    empty = "<td></td>" * count
    rows = "".join(f"<tr><td>{html.escape(text)}</td>{empty}</tr>" for text in NOW)
    return _table("now", f"<tr><th></th>{_vehicle_heads(flight, count)}</tr>", rows)


def _table(name: str, head: str, rows: str) -> str:
    return f'<div class="scroll"><table id="{name}"><thead>{head}</thead><tbody>{rows}</tbody></table></div>'


def _vehicle_heads(flight: Flight, count: int) -> str:
    heads = []
    for k, name in enumerate(flight.vehicle_names[:count]):
        text = html.escape(name)
        swatch = f'<span class="swatch" style="background:{color(k)}"></span>'
        heads.append(f'<th class="name" title="{text}">{swatch}{text}</th>')
    return "".join(heads)
