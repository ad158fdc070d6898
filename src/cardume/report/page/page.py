"""The page as one file: words and tables first, then the charts, their numbers and the library that draws them."""

import base64
import hashlib
import html
import json
import re
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from cardume.errors import InputError
from cardume.missions.atomic import write_file
from cardume.missions.runs import Run
from cardume.report.ellipse import BOUND, vehicles_with_certainty
from cardume.report.limits import limits_of
from cardume.report.page.plan_view import arrow_scale, plan_view
from cardume.report.page.series import series_view
from cardume.report.page.space_view import space_view
from cardume.report.page.store import Store, color, pack_messages, shown_messages
from cardume.report.page.tables import badge, now_table, numbers_table, requirements_table
from cardume.report.table import number
from cardume.report.words import meaning
from cardume.simulation.flight import CERTAINTY, Flight

FILE_NAME = "report.html"
SPEEDS = (1, 2, 5, 10, 20, 50, 100, 200, 500)
USERS_LAW = re.compile(r": \"?([A-Za-z_][\w.]*):[A-Za-z_]\w*")  # law: my_lab.laws:my_law
PRINTED = {"width": 680, "height": 925}  # [pixel] of charts on a page of A4, 96 to the inch
MOVED = (
    *("north", "east", "depth", "heading", "speed", "cross_track"),
    *("north_estimate", "east_estimate", "cross_track_estimate", "current_north", "current_east"),
)


class LibraryMissing(InputError):
    """The library that draws the charts is not installed."""


def library() -> str:
    """The text of plotly.js, from the Python package that carries it.

    Raises:
        LibraryMissing: that package is not installed.
    """
    try:
        path = resources.files("plotly") / "package_data" / "plotly.min.js"
        text = path.read_text(encoding="utf-8")
    except (ModuleNotFoundError, FileNotFoundError):
        raise LibraryMissing(f"{FILE_NAME} needs plotly: pip install 'cardume[report]'") from None
    return re.sub(r"</(script)", r"<\\/\1", text, flags=re.IGNORECASE)


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
    script, plotly = _part("report.js"), library()
    word, kind = badge(run)
    return Template(_part("template.html")).substitute(
        policy=page_policy(plotly, script),
        version=html.escape(run.version),
        title=html.escape(flight.mission_name),
        style=_part("report.css"),
        verdict=word,
        verdict_class=kind,
        subtitle=html.escape(_subtitle(run)),
        meaning=html.escape(meaning(flight, run, run.verdicts)),
        requirements=requirements_table(run.verdicts),
        numbers=numbers_table(flight),
        numbers_note=_numbers_note(flight),
        now=now_table(flight),
        plan_note=_plan_note(store),
        space_note=_space_note(figures["space"]),
        series_note=_series_note(store),
        again=_again(run),
        mission=html.escape(run.text),
        speeds="".join(f'<option value="{speed}">{speed} ×</option>' for speed in SPEEDS),
        data=_data(store, figures),
        library=plotly,
        script=script,
    )


def _subtitle(run: Run) -> str:
    count = len(run.flight.vehicle_names)
    fleet = f"{count} vehicles" if count != 1 else "1 vehicle"
    return f"{fleet}, {run.duration:g} s, seed {run.flight.seed}; cardume {run.version}"


def _part(name: str) -> str:
    return (resources.files("cardume.report.page") / name).read_text(encoding="utf-8")


def page_policy(*scripts: str) -> str:
    """Nothing from a network, and no script but our own, whatever a name in the mission says."""
    digests = (base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts)
    allowed = " ".join(f"'sha256-{digest}'" for digest in digests)
    return f"default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; img-src data: blob:"


def _data(store: Store, figures: Mapping[str, Any]) -> str:
    flight = store.flight
    for name in MOVED:
        store.keep(name)
    told = vehicles_with_certainty(flight)
    for name in CERTAINTY if told else ():
        for vehicle in told:
            store.column(name, vehicle)
    delays = np.asarray(flight.messages["time_received"], float) - np.asarray(flight.messages["time_sent"], float)
    known = delays[np.isfinite(delays)]
    contents = {
        "vehicles": list(flight.vehicle_names),
        "colors": [color(k) for k in range(len(flight.vehicle_names))],
        "figures": figures,
        "moved": MOVED,
        "arrow": arrow_scale(store),
        "ellipses": {"vehicles": told, "covariance": CERTAINTY, "bound": BOUND},
        "messages": pack_messages(flight),
        "slowest": float(known.max()) if known.size else 0.0,  # [s] on the way
        "start": float(store.times[len(store.times) // 3]) if len(store.times) else 0.0,
        "printed": PRINTED,
        "store": store.contents(),
    }
    text = json.dumps(contents, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _numbers_note(flight: Flight) -> str:
    if len(flight.vehicle_names) == 1:
        return "After the transient; the figures of merit are explained by <code>cardume list metrics</code>."
    return (
        "Fleet: the worst vehicle; coord.: largest difference along the reference path. "
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
    return f"Drag to turn, scroll to come nearer. {drawn}"


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


def _again(run: Run) -> str:
    encoded = base64.b64encode(run.text.encode()).decode("ascii")
    steps = [
        f"<p>Install cardume {html.escape(run.version)}, save the mission below as "
        f'<a download="mission.yaml" href="data:text/yaml;base64,{encoded}">mission.yaml</a>, and type</p>'
    ]
    users = sorted(set(USERS_LAW.findall(run.text)))
    allow = " --allow-code FOLDER" if users else ""
    steps.append(f"<pre>cardume run mission.yaml{allow}</pre>")
    steps.append(f"<p>The seed, {run.flight.seed}, is in the file: the same version gives the same bits.</p>")
    if users:
        names = ", ".join(f"<code>{html.escape(name)}</code>" for name in users)
        steps.append(f"<p>FOLDER is where the laws of {names} are, which are not part of cardume.</p>")
    if re.search(r"\bfile: ", run.text):
        steps.append("<p>The files that it names must lie where it says.</p>")
    return "\n".join(steps)
