"""The page of a study as one file: words and tables first, then the charts, and the library that draws them."""

import html
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cardume.missions.atomic import write_file
from cardume.report.page.frame import Subject, framed, part
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

HERE = "cardume.report.study.page"
Worst = Sequence[tuple[WorstRun, Flight]]

SECTIONS = (
    (
        "map",
        "Where it holds",
        "White: where the middle of the probability's 95 % interval, by Wilson, is 0.95; dotted: where its ends are, so"
        " that between them nothing is sure. Between the cases the logit of the probability is taken for straight.",
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
    charts: dict[str, Chart] = {}
    sections = [_tables(study_blocks(results))]
    for name, title, note, make in SECTIONS:
        sections.append(_charts(charts, name, title, note, make(results)))
    sections.append(_worst(charts, results, worst))
    words = "".join(f"<p>{html.escape(sentence)}</p>" for sentence in study_words(results))
    main = [f'<section aria-label="What it says">{words}</section>', *(section for section in sections if section)]
    style, script = (part(name, HERE) for name in ("study.css", "study.js"))
    return framed(_subject(results), "\n".join(main), {"charts": charts}, script=script, style=style)


def _subject(results: Results) -> Subject:
    attrs = results.dataset.attrs
    word, kind = _badge(results)
    sampling = str(attrs.get("sampling", "monte_carlo"))
    options = f"--runs {len(results.seeds)}" + (f" --sampling {sampling}" if sampling != "monte_carlo" else "")
    version = str(attrs.get("version", ""))
    return Subject(
        title=str(attrs.get("title", "study")),
        subtitle=f"{results.num_flown} missions, sampled by {sampling.replace('_', ' ')}; cardume {version}",
        version=version,
        verdict=word,
        kind=kind,
        mission=str(attrs.get("mission", "")),
        command=("cardume study", options),
        seed=f"Seeds count from the one in the file, {results.seeds[0]}",
    )


def _badge(results: Results) -> tuple[str, str]:
    if not results.requirements:
        return "nothing was required", "neutral"
    if results.num_cases > 1:
        return f"{results.num_cases} cases", "neutral"
    (case,) = np.ndindex(*results.shape)
    found = chance_of_all(results, case)
    kind = "good" if found.low >= 0.95 else "bad" if found.high < 0.95 else "neutral"
    return f"required holds in {percent(found.share)}", kind


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
