"""Runs made without flying, and one whose every text tries to break out of a page."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from cardume.missions.mission import Transient
from cardume.missions.results import choose_destination, write_results
from cardume.missions.runs import Run
from cardume.missions.summary import Verdict
from cardume.simulation.flight import Flight
from report.synthetic import make_flight

HOSTILE = (
    "</script><script>window.hacked = 1</script>",
    '"><img src=x onerror="window.hacked = 2">',
    "<a href='javascript:window.hacked = 3'>$style ${data} &lt; \u2028 %</a>",
)


def make_run(flight: Flight | None = None, text: str = "cardume: 1\nname: figure-5\n", **given: Any) -> Run:
    """A run of a flight that never flew."""
    verdict = Verdict("cross_track_rms", "m", "at most", 0.5, 0.2835, None, "port", True)
    values: dict[str, Any] = {"mission": None, "version": "1.2.3", "verdicts": (verdict,), "duration": 700.0}
    return Run(flight=flight or make_flight(), text=text, transient=Transient(), **values | given)


def hostile_run() -> Run:
    """Markup and scripts in every text that a log from elsewhere could bring."""
    flight = make_flight(num_rows=71, names=HOSTILE)
    bad = HOSTILE[0] + HOSTILE[1]
    verdict = Verdict(bad, bad, bad, 0.5, 0.2835, None, HOSTILE[1], False)
    flight = replace(flight, mission_name=bad, failure=bad, reason="failed")
    return make_run(flight, text=f"cardume: 1\nname: {bad}\n</pre>{bad}", version=bad, verdicts=(verdict,))


def kept_run(folder: Path, flight: Flight) -> Path:
    """A flight written as `cardume run` does."""
    mission: Any = SimpleNamespace(
        name=flight.mission_name,
        duration=700.0,
        require=(),
        to_yaml=lambda directory=None: "cardume: 1\nname: figure-5\n",
    )
    directory, _ = write_results(choose_destination("figure-5", folder), mission, flight, version="1.2.3")
    return directory
