"""The page of a study as one file: words and tables first, then the charts, and the library that draws them."""

import base64
import html
import json
import re
import shlex
from collections.abc import Sequence
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from cardume.missions.atomic import write_file
from cardume.report.page.page import library, page_policy
from cardume.report.study.blocks import Block, study_blocks
from cardume.report.study.common import as_results, percent
from cardume.report.study.page.charts import distribution_charts, flight_chart, influence_charts, law_charts
from cardume.report.study.page.plotting import Chart
from cardume.report.study.page.regions import curve_charts, map_charts
from cardume.report.study.words import study_words
from cardume.simulation.flight import Flight
from cardume.studies.answers.requirements import chance_of_all
from cardume.studies.answers.results import Results
from cardume.studies.answers.worst import WorstRun

FILE_NAME = "report.html"
Worst = Sequence[tuple[WorstRun, Flight]]

SECTIONS = (
    (
        "map",
        "Where it holds",
        "White: where the requirement holds in 95 % of the missions; dotted: both ends of its 95 % interval, by Wilson,"
        " at each point. Between the cases the logit of the probability is taken for straight.",
        map_charts,
    ),
    (
        "curves",
        "Along the swept key",
        "Lines: means over the runs; bands: their 95 % intervals; dashed and dotted: what is wanted.",
        curve_charts,
    ),
    (
        "laws",
        "Law against law",
        "Differences in pairs of equal seed, with their 95 % intervals; filled: not by chance, at odds that all share.",
        law_charts,
    ),
    (
        "distributions",
        "How the numbers are distributed",
        "Blue lines: median, 5 and 95 % quantiles, in the bands of their 95 % intervals; ring: mean.",
        distribution_charts,
    ),
    (
        "influences",
        "What matters",
        "Shares of the variance (Sobol), by polynomials fitted to the runs, with the intervals of a jackknife over"
        " groups of runs. Alone: by itself; with others: in all combinations. The rest is noise by the seed, or finer.",
        influence_charts,
    ),
)


def write_study_page(path: Path, study: Any, worst: Worst = ()) -> None:
    """Write the report of a study, complete or not at all.

    Args:
        path: of the new file.
        study: `Results`, or its dataset.
        worst: its worst runs, flown again.

    Raises:
        LibraryMissing: the library that draws the charts is not installed.
    """
    write_file(path, make_study_page(study, worst).encode("utf-8"))


def make_study_page(study: Any, worst: Worst = ()) -> str:
    """The report of a study as the text of one HTML file.

    Args:
        study: `Results`, or its dataset.
        worst: its worst runs, flown again.

    Raises:
        LibraryMissing: the library that draws the charts is not installed.
    """
    results = as_results(study)
    plotly, script = library(), _part("study.js")
    charts: dict[str, Chart] = {}
    sections = [_tables(study_blocks(results))]
    for name, title, note, make in SECTIONS:
        sections.append(_charts(charts, name, title, note, make(results)))
    sections.append(_worst(charts, results, worst))
    attrs = results.dataset.attrs
    word, kind = _badge(results)
    mission = str(attrs.get("mission", ""))
    return Template(_part("study.html")).substitute(
        policy=page_policy(plotly, script),
        version=html.escape(str(attrs.get("version", ""))),
        title=html.escape(str(attrs.get("title", "study"))),
        style=(resources.files("cardume.report.page") / "report.css").read_text(encoding="utf-8") + _part("study.css"),
        verdict=word,
        verdict_class=kind,
        subtitle=html.escape(_subtitle(results)),
        words="".join(f"<p>{html.escape(sentence)}</p>" for sentence in study_words(results)),
        sections="\n".join(section for section in sections if section),
        again=_again(mission, str(attrs.get("command", ""))),
        mission=html.escape(mission),
        data=_data(charts),
        library=plotly,
        script=script,
    )


def _part(name: str) -> str:
    return (resources.files("cardume.report.study.page") / name).read_text(encoding="utf-8")


def _badge(results: Results) -> tuple[str, str]:
    if not results.requirements:
        return "nothing was required", "neutral"
    if results.num_cases > 1:
        return f"{results.num_cases} cases", "neutral"
    (case,) = np.ndindex(*results.shape)
    found = chance_of_all(results, case)
    kind = "good" if found.low >= 0.95 else "bad" if found.high < 0.95 else "neutral"
    return f"required holds in {percent(found.share)}", kind


def _subtitle(results: Results) -> str:
    attrs = results.dataset.attrs
    sampling = str(attrs.get("sampling", "")).replace("_", " ")
    return f"{results.num_flown} missions, sampled by {sampling}; cardume {attrs.get('version', '')}"


def _tables(blocks: Sequence[Block]) -> str:
    found = "".join(f"<div>{_table(block)}</div>" for block in blocks)
    return f'<section class="wide" aria-label="Numbers"><div class="tables">{found}</div></section>' if found else ""


def _table(block: Block) -> str:
    kept = [k for k in range(len(block.heads)) if any(cells[k] for _, cells in block.rows)]
    head = "".join(f"<th>{html.escape(text)}</th>" for text in (block.title, *(block.heads[k] for k in kept)))
    rows = "".join(
        f"<tr><td>{html.escape(name)}</td>{''.join(f'<td>{html.escape(cells[k])}</td>' for k in kept)}</tr>"
        for name, cells in block.rows
    )
    note = f'<p class="note">{html.escape(block.note)}</p>' if block.note else ""
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>{note}'


def _charts(charts: dict[str, Chart], name: str, title: str, note: str, found: Sequence[Chart]) -> str:
    if not found:
        return ""
    places = []
    for number, one in enumerate(found):
        charts[f"{name}-{number}"] = one
        places.append(f'<div><div id="{name}-{number}" class="plot{" tall" if name == "map" else ""}"></div></div>')
    return (
        f'<section class="wide" aria-labelledby="h-{name}"><h2 id="h-{name}">{title}</h2>'
        f'<p class="note">{note}</p><div class="charts">{"".join(places)}</div></section>'
    )


def _worst(charts: dict[str, Chart], results: Results, worst: Worst) -> str:
    if not worst:
        return ""
    places = []
    for number, (run, flight) in enumerate(worst):
        charts[f"worst-{number}"] = flight_chart(flight)
        why = run.failure or "; ".join(run.missed) or "nothing missed"
        lines = [f"<b>seed {run.seed}</b> {html.escape(run.label)}", html.escape(why)]
        said = "".join(f"<p>{line}</p>" for line in lines)
        places.append(f'<div>{said}<div id="worst-{number}" class="plot"></div></div>')
    note = "Flown again with the whole log: the same seed and draws, so the same numbers. Wide lines: paths."
    return (
        '<section class="wide" aria-labelledby="h-worst"><h2 id="h-worst">The worst runs</h2>'
        f'<p class="note">{note}</p><div class="worst">{"".join(places)}</div></section>'
    )


def _again(mission: str, command: str) -> str:
    encoded = base64.b64encode(mission.encode()).decode("ascii")
    saved = f'<a download="mission.yaml" href="data:text/yaml;base64,{encoded}">mission.yaml</a>'
    options = re.sub(r"^.*?\bstudy\s+(?:'[^']*'|\S+)\s*", "", command)
    kept = re.sub(r"(?:-o\s+(?:'[^']*'|\S+)|--set\s+(?:'[^']*'|\S+)|--resume)\s*", "", options).strip()
    typed = shlex.join(["cardume", "study", "mission.yaml"]) + (f" {kept}" if kept else "")
    return f"<p>Save the mission below as {saved}, and type</p><pre>{html.escape(typed)}</pre>"


def _data(charts: dict[str, Chart]) -> str:
    text = json.dumps({"charts": charts}, allow_nan=False, separators=(",", ":"), default=_plain)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _plain(value: Any) -> Any:
    return value.item() if hasattr(value, "item") else str(value)
