"""The frame of every report: one file that asks no network, with its words, charts and the library that draws them."""

import base64
import hashlib
import html
import json
import re
from collections.abc import Mapping
from importlib import resources
from string import Template
from typing import Any, NamedTuple

from cardume.errors import InputError

FILE_NAME = "report.html"
HERE = "cardume.report.page"
USERS_LAW = re.compile(r": \"?([A-Za-z_][\w.]*):[A-Za-z_]\w*")  # law: my_lab.laws:my_law


class LibraryMissing(InputError):
    """The library that draws the charts is not installed."""


class Subject(NamedTuple):
    """What a report is about.

    Attributes:
        title: plain text, as all that follows.
        subtitle: what was flown, and by which version.
        version: of cardume.
        verdict: in a few words.
        kind: of the verdict: good, bad or neutral.
        mission: the text that flies it again.
        command: that flies it again, as words before and after the name of the mission file.
        seed: what is to be known of it, a sentence.
    """

    title: str
    subtitle: str
    version: str
    verdict: str
    kind: str
    mission: str
    command: tuple[str, str]
    seed: str


def framed(
    subject: Subject, main: str, contents: Mapping[str, Any], *, script: str, style: str = "", below: str = ""
) -> str:
    """A report as the text of one HTML file.

    Args:
        subject: what it is about.
        main: HTML of what it says.
        contents: what the script reads, as JSON has it.
        script: that draws the charts.
        style: beside the one of all reports.
        below: HTML that stands below everything.

    Raises:
        LibraryMissing: the library that draws the charts is not installed.
    """
    plotly = library()
    return Template(part("frame.html")).substitute(
        policy=_policy(plotly, script),
        version=html.escape(subject.version),
        title=html.escape(subject.title),
        style=part("report.css") + style,
        verdict=html.escape(subject.verdict),
        verdict_class=subject.kind,
        subtitle=html.escape(subject.subtitle),
        main=main,
        again=_again(subject),
        mission=html.escape(subject.mission),
        below=below,
        data=_as_json(contents),
        library=plotly,
        script=script,
    )


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


def part(name: str, package: str = HERE) -> str:
    """The text of a file that belongs to a page.

    Args:
        name: of the file.
        package: that it lies in.
    """
    return (resources.files(package) / name).read_text(encoding="utf-8")


def _policy(*scripts: str) -> str:
    """Nothing from a network, and no script but our own, whatever a name in the mission says."""
    digests = (base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts)
    allowed = " ".join(f"'sha256-{digest}'" for digest in digests)
    return f"default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; img-src data: blob:"


def _as_json(contents: Mapping[str, Any]) -> str:
    """JSON in which nothing ends the element of the page that holds it."""
    text = json.dumps(contents, allow_nan=False, separators=(",", ":"), default=_plain)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _plain(value: Any) -> Any:
    return value.item() if hasattr(value, "item") else str(value)


def _again(subject: Subject) -> str:
    encoded = base64.b64encode(subject.mission.encode()).decode("ascii")
    users = sorted(set(USERS_LAW.findall(subject.mission)))
    before, after = subject.command
    typed = " ".join(filter(None, (before, "mission.yaml", after, "--allow-code FOLDER" if users else "")))
    steps = [
        f"<p>Install cardume {html.escape(subject.version)}, save the mission below as "
        f'<a download="mission.yaml" href="data:text/yaml;base64,{encoded}">mission.yaml</a>, and type</p>',
        f"<pre>{html.escape(typed)}</pre>",
        f"<p>{html.escape(subject.seed)}: the same version gives the same bits.</p>",
    ]
    if users:
        names = ", ".join(f"<code>{html.escape(name)}</code>" for name in users)
        steps.append(f"<p>FOLDER is where the laws of {names} are, which are not part of cardume.</p>")
    if re.search(r"\bfile: ", subject.mission):
        steps.append("<p>The files that it names must lie where it says.</p>")
    return "\n".join(steps)
