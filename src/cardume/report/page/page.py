"""The page as one file: words and tables first, then the charts, their numbers and the library that draws them."""

import html
from collections.abc import Mapping
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from cardume.missions.atomic import write_file
from cardume.missions.runs import Run
from cardume.report.ellipse import BOUND, vehicles_with_certainty
from cardume.report.limits import limits_of
from cardume.report.page.faults import fault_marks
from cardume.report.page.frame import Subject, framed, part
from cardume.report.page.plan_view import arrow_scale, plan_view
from cardume.report.page.series import series_view
from cardume.report.page.space_view import space_view
from cardume.report.page.store import Store, color, pack_messages, shown_messages
from cardume.report.page.tables import badge, now_table, numbers_table, requirements_table
from cardume.report.table import number
from cardume.report.words import meaning
from cardume.simulation.flight import CERTAINTY, Flight

STILL = 1e-4  # [m/s] of a current that is none
SPEEDS = (1, 2, 5, 10, 20, 50, 100, 200, 500)
MOVED = (
    *("north", "east", "depth", "heading", "speed", "cross_track"),
    *("north_estimate", "east_estimate", "cross_track_estimate", "current_north", "current_east"),
)


def write_page(path: Path, run: Run) -> None:
    """Write the report of a run, complete or not at all.

    Args:
        path: of the new file.
        run: just flown or read back.

    Raises:
        LibraryMissing: the library that draws the charts is not installed.
    """
    write_file(path, make_page(run).encode("utf-8"))


def make_page(run: Run) -> str:
    """The report of a run as the text of one HTML file.

    Args:
        run: just flown or read back.

    Raises:
        LibraryMissing: the library that draws the charts is not installed.
    """
    flight, store = run.flight, Store(run.flight)
    figures = {
        "plan": plan_view(store),
        "space": space_view(store),
        "series": series_view(store, limits_of(run.mission)),
    }
    word, kind = badge(run)
    subject = Subject(
        title=flight.mission_name,
        subtitle=_subtitle(run),
        version=run.version,
        verdict=word,
        kind=kind,
        mission=run.text,
        command=("cardume run", ""),
        seed=f"The seed, {flight.seed}, is in the file",
    )
    main = Template(part("main.html")).substitute(
        meaning=html.escape(meaning(flight, run, run.verdicts)),
        requirements=requirements_table(run.verdicts),
        numbers=numbers_table(flight),
        numbers_note=_numbers_note(flight),
        now=now_table(flight),
        plan_note=_plan_note(store),
        space_note=_space_note(figures["space"]),
        series_note=_series_note(store),
    )
    speeds = "".join(f'<option value="{speed}">{speed} ×</option>' for speed in SPEEDS)
    player = Template(part("player.html")).substitute(speeds=speeds)
    return framed(subject, main, _contents(store, figures), script=part("report.js"), below=player)


def _subtitle(run: Run) -> str:
    count = len(run.flight.vehicle_names)
    fleet = f"{count} vehicles" if count != 1 else "1 vehicle"
    length = float(np.hypot(*np.diff(run.flight.reference_path, axis=0).T).sum())
    path = f", {length:.3g} m of path" if length > 0.0 else ""
    water = np.hypot(run.flight.channels["current_north"], run.flight.channels["current_east"])
    strongest = float(np.max(water, initial=0.0, where=np.isfinite(water)))
    sea = f"in a current of up to {number(strongest)} m/s" if strongest > STILL else "in still water"
    return f"{fleet}{path} {sea}, {run.duration:g} s, seed {run.flight.seed}; cardume {run.version}"


def _contents(store: Store, figures: Mapping[str, Any]) -> dict[str, Any]:
    flight = store.flight
    for name in MOVED:
        store.keep(name)
    told = vehicles_with_certainty(flight)
    for name in CERTAINTY if told else ():
        for vehicle in told:
            store.column(name, vehicle)
    delays = np.asarray(flight.messages["time_received"], float) - np.asarray(flight.messages["time_sent"], float)
    known = delays[np.isfinite(delays)]
    return {
        "vehicles": list(flight.vehicle_names),
        "colors": [color(k) for k in range(len(flight.vehicle_names))],
        "figures": figures,
        "moved": MOVED,
        "arrow": arrow_scale(store),
        "ellipses": {"vehicles": told, "covariance": CERTAINTY, "bound": BOUND},
        "messages": pack_messages(flight),
        "slowest": float(known.max()) if known.size else 0.0,  # [s] on the way
        "start": float(store.times[len(store.times) // 3]) if len(store.times) else 0.0,
        "faults": fault_marks(flight),
        "store": store.contents(),
    }


def _numbers_note(flight: Flight) -> str:
    if len(flight.vehicle_names) == 1:
        return "After the transient; the figures of merit are explained by <code>cardume list metrics</code>."
    return (
        "Fleet: the worst vehicle; coordination: largest difference along the reference path. "
        "After the transient; explained by <code>cardume list metrics</code>."
    )


def _plan_note(store: Store) -> str:
    flight, scale = store.flight, arrow_scale(store)
    parts = [
        "Tips of arrowheads: vehicles; circles: where they believe to be; wide lines: paths; dotted: believed tracks."
    ]
    if vehicles_with_certainty(flight):
        parts.append("Thin ellipses: 95 % of the error that a vehicle expects; zoom in where the circle hides one.")
    if scale:
        strongest = np.nanmax(np.hypot(store.values("current_north"), store.values("current_east")))
        parts.append(f"Blue arrows: current, the longest {number(float(strongest))} m/s.")
    if len(flight.messages["time_sent"]):
        parts.append("Gray dots: messages on their way, slowed down to be seen; crosses: lost ones.")
        shown, count = len(shown_messages(flight)), len(flight.messages["time_sent"])
        if shown < count:
            parts.append(f"{shown} of {count} messages are shown.")
    return " ".join(parts)


def _space_note(figure: Mapping[str, Any]) -> str:
    stretch = figure["stretch"]
    drawn = "Depths are drawn to scale." if stretch < 1.05 else f"Depths are drawn {stretch:.2g} times too large."
    return f'<span class="screen">Drag to turn, scroll to come nearer.</span> {drawn}'


def _series_note(store: Store) -> str:
    parts = [
        "One axis of time for all: what is pointed at in one is marked in all; drag to zoom, double click to zoom "
        "out, click to move the replay there. Click on a name to hide a vehicle."
    ]
    if store.stride > 1:
        period = store.times[1] - store.times[0]
        parts.append(
            f"Shown is one record of the log in {store.stride}, each {period:.3g} s: shorter peaks may be missing; "
            "log.nc has them."
        )
    return " ".join(parts)
