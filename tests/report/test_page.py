"""The report as a file: small, self-contained, honest about what it leaves out, deaf to hostile names."""

import base64
import html.parser
import itertools
import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cardume.report.fault_lanes import MOST_LANES as MOST_FAULTS
from cardume.report.message_lanes import links
from cardume.report.page import frame as pages
from cardume.report.page.frame import LibraryMissing
from cardume.report.page.page import make_page, write_page
from cardume.report.page.series import BOTTOM, LANE_PRINTED, LANES_PRINTED, MOST_LANES, TOP, series_view
from cardume.report.page.store import MOST_CELLS, Store, packed
from cardume.simulation.flight import CERTAINTY, CHANNELS, MESSAGE_COLUMNS, Event, Flight
from report.runs import HOSTILE, hostile_run, make_run
from report.synthetic import make_flight, with_certainty, with_faults
from report.test_figures import odd_flights

LIMIT = 8_000_000  # [bytes] of a mail attachment


class Reader(html.parser.HTMLParser):
    """The elements of a page, and its scripts."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.scripts: list[str] = []
        self.words: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        last = self.tags[-1][0] if self.tags else ""
        (self.scripts if last == "script" and data.strip() else self.words).append(data)


def numbers(text: str) -> dict[str, Any]:
    """What the page carries for its charts."""
    found = re.search(r'<script type="application/json" id="report-data">(.*?)</script>', text, re.DOTALL)
    assert found
    return json.loads(found[1])


def unpacked(column: dict[str, str]) -> np.ndarray:
    return np.frombuffer(base64.b64decode(column["bdata"]), f"<{column['dtype']}")


@pytest.fixture(scope="module")
def text() -> str:
    return make_page(make_run())


def test_half_an_hour_of_three_vehicles_fits_in_a_mail() -> None:
    short = make_flight(num_rows=18_001)
    times = np.linspace(0.0, 1800.0, 18_001)
    many = {name: np.tile(short.messages[name], 4) for name in MESSAGE_COLUMNS}
    assert len(make_page(make_run(replace(short, times=times, messages=many))).encode()) <= LIMIT


def test_a_large_fleet_is_thinned_harder() -> None:
    flight = make_flight(num_rows=5001, names=tuple(f"vehicle-{k}" for k in range(20)))
    store = Store(flight)
    assert len(store.rows) * 20 <= MOST_CELLS
    text = make_page(make_run(flight))
    assert len(text.encode()) <= LIMIT
    assert f"one record of the log in {store.stride}" in text


def test_the_page_carries_the_numbers_of_the_log(text: str) -> None:
    flight, carried = make_flight(), numbers(text)
    assert np.array_equal(unpacked(carried["store"]["times"]), flight.times)
    for name in ("north", "east", "depth", "heading", "north_estimate", "cross_track", "current_east"):
        for k in range(3):
            column = unpacked(carried["store"]["columns"][name][k])
            np.testing.assert_array_equal(column, flight.channels[name][:, k].astype("f4"), err_msg=name)
    assert np.array_equal(unpacked(carried["messages"]["lost"]), flight.messages["lost"])
    assert "one record of the log in" not in text


def test_the_page_carries_covariances_only_of_vehicles_that_tell_them(text: str) -> None:
    plain, flight = make_flight(), with_certainty(make_flight())
    with_them = make_page(make_run(flight))
    carried = numbers(with_them)
    for name in CERTAINTY:
        first, *rest = carried["store"]["columns"][name]
        assert first is None
        for k, column in enumerate(rest, 1):
            np.testing.assert_array_equal(unpacked(column), flight.channels[name][:, k].astype("f4"))
    assert len(with_them) - len(text) < 2 * 3 * 4 * len(flight.times) * 4 / 3 + 2000
    assert "Thin ellipses" in with_them
    old = replace(plain, channels={name: values for name, values in plain.channels.items() if name not in CERTAINTY})
    unknown = replace(plain, channels=plain.channels | dict.fromkeys(CERTAINTY, plain.channels["north"] * np.nan))
    for run in (make_run(old), make_run(unknown)):
        assert numbers(make_page(run)) == numbers(text)
        assert "Thin ellipses" not in make_page(run)


def test_nothing_is_fetched_and_only_our_scripts_may_run(text: str) -> None:
    reader = Reader(text)
    policy = next(a["content"] for tag, a in reader.tags if a.get("http-equiv") == "Content-Security-Policy")
    assert policy is not None
    assert policy.startswith("default-src 'none'; script-src 'sha256-")
    assert "unsafe-eval" not in policy
    outside = [a for tag, a in reader.tags if tag in ("link", "img", "iframe", "base") or "src" in a]
    assert outside == []
    targets = [a["href"] for tag, a in reader.tags if "href" in a]
    assert all(target is not None and target.startswith("data:text/yaml") for target in targets)


def test_hostile_texts_stay_texts() -> None:
    text = make_page(hostile_run())
    reader = Reader(text)
    assert [tag for tag, _ in reader.tags].count("script") == [
        tag for tag, _ in Reader(make_page(make_run())).tags
    ].count("script")
    assert not [a for _, a in reader.tags if "onerror" in a or "onclick" in a]
    assert "img" not in {tag for tag, _ in reader.tags}
    assert "<img" not in text.replace("\\u003c", "<").partition('id="report-data"')[0]
    assert numbers(text)["vehicles"] == list(HOSTILE)
    assert HOSTILE[0] in "".join(reader.words)  # shown as it is


def test_the_same_run_gives_the_same_page(text: str) -> None:
    assert make_page(make_run()) == text


@pytest.mark.parametrize("name", odd_flights())
def test_any_flight_has_a_page(name: str) -> None:
    text = make_page(make_run(odd_flights()[name]))
    assert numbers(text)["vehicles"]


def test_faults_have_a_lane_a_shade_and_a_word_as_long_as_they_last() -> None:
    flight = with_faults()
    page = numbers(make_page(make_run(flight)))
    end = flight.flown
    assert [(mark["begin"], mark["end"]) for mark in page["faults"]] == [(60.0, 100.0), (120.0, end)]
    assert page["faults"][0]["words"] == "port: its modem falls silent (60 to 100 s)"
    assert page["faults"][1]["words"] == "the current turns (from 120 s on)"
    layout, data = (page["figures"]["series"][what] for what in ("layout", "data"))
    shades = [shape for shape in layout["shapes"] if shape["type"] == "rect"]
    assert [(shade["x0"], shade["x1"]) for shade in shades] == [(60.0, 100.0), (120.0, end)]
    bars = [trace for trace in data if trace.get("line", {}).get("width") == 5]
    assert [bar["x"] for bar in bars] == [[60.0, 100.0], [120.0, end]]
    axes = {bar["yaxis"] for bar in bars}
    assert len(axes) == 1
    assert not [trace for trace in data if trace["yaxis"] in axes and trace["mode"] == "markers"]


def test_a_flight_without_faults_has_no_lane_for_them(text: str) -> None:
    page = numbers(text)
    assert not page["faults"]
    assert "Faults" not in json.dumps(page["figures"]["series"]["layout"])


def test_of_many_faults_the_first_have_lanes_and_all_a_shade() -> None:
    flight = with_faults()
    many = tuple(Event(10.0 + k, "port", "fault: its modem falls silent", 11.0 + k) for k in range(MOST_FAULTS + 5))
    series = series_view(Store(replace(flight, events=many)), {})
    assert sum(trace.get("line", {}).get("width") == 5 for trace in series["data"]) == MOST_FAULTS
    assert sum(shape["type"] == "rect" for shape in series["layout"]["shapes"]) == len(many)
    assert f"the first {MOST_FAULTS} of {len(many)}" in json.dumps(series["layout"]["annotations"])


def test_the_verdict_comes_first(text: str) -> None:
    body = text.partition("<body>")[2]
    places = [
        body.index(word) for word in ("Requirements met", "cross-track rms", "Numbers", 'id="plan"', "mission.yaml")
    ]
    assert places == sorted(places)
    failed = make_page(make_run(replace(make_flight(num_rows=71), reason="failed", failure="the state was no number")))
    assert "Failed while flying" in failed
    assert "nothing was required" in make_page(make_run(verdicts=()))


def test_limits_are_drawn_where_they_are_near_and_told_where_they_are_far() -> None:
    flight = make_flight(num_rows=71)
    thrust = np.full_like(flight.channels["thrust"], 5.0)
    flight = replace(flight, channels={**flight.channels, "thrust": thrust, "yaw_moment": thrust})
    figure = series_view(Store(flight), {"thrust": (6.0, 6.0, 6.0), "yaw_moment": (100.0, 100.0, 100.0)})
    heights = [shape["y0"] for shape in figure["layout"]["shapes"]]
    assert heights == [6.0]
    words = [note["text"] for note in figure["layout"]["annotations"]]
    assert any("limit 6 N, 83 % used" in text for text in words)
    assert any("limit 100 N m, 5 % used" in text for text in words)


def test_a_user_s_own_law_is_told_beside_the_command() -> None:
    text = make_page(make_run(text="guidance: {law: my_lab.laws:mine, gain: 1}\n"))
    assert "--allow-code FOLDER" in text
    assert "<code>my_lab.laws</code>" in text
    assert "--allow-code" not in make_page(make_run(text="duration: 60 s\ncurrent: {file: a.nc}\n"))


def test_links_are_those_that_spoke() -> None:
    assert links(make_flight(num_rows=11)) == [(0, 1), (0, 2), (1, 0), (2, 0)]
    alone = make_flight(num_rows=11, names=("alone",))
    assert links(alone) == []


def test_without_the_library_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def gone(name: str) -> Any:
        raise ModuleNotFoundError(name)

    monkeypatch.setattr(pages.resources, "files", gone)
    with pytest.raises(LibraryMissing, match=r"pip install 'cardume\[report\]'"):
        pages.library()
    assert list(tmp_path.iterdir()) == []


def test_packed_numbers_read_back() -> None:
    values = np.array([1.5, np.nan, -2.0])
    assert np.array_equal(unpacked(packed(values, "f8")), values, equal_nan=True)


def test_the_page_is_written_whole(tmp_path: Path, text: str) -> None:
    write_page(tmp_path / "report.html", make_run())
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == text
    assert [path.name for path in tmp_path.iterdir()] == ["report.html"]


def test_every_channel_that_a_panel_names_exists() -> None:
    flight: Flight = make_flight(num_rows=11)
    derived = {"north_error", "east_error", "ahead_of_mean", "heading_error_deg"}
    columns = series_view(store := Store(flight), {}) and store.contents()["columns"]
    assert set(columns) <= set(CHANNELS) | derived


@pytest.mark.parametrize("num_vehicles", [1, 2, 6])
def test_on_paper_a_lane_of_messages_holds_its_words(num_vehicles: int) -> None:
    flight = make_flight(num_rows=71, names=tuple("abcdef"[:num_vehicles]))
    figure, lanes = series_view(Store(flight), {}), min(len(links(flight)), MOST_LANES)
    printed = figure["printed"]
    room = printed["height"] - TOP - BOTTOM
    for domains in (figure["domains"], printed["domains"]):
        assert domains[0][1] == 1.0
        assert domains[-1][0] == pytest.approx(0.0, abs=1e-12)
        assert all(low < high for low, high in domains)
        assert all(below[1] < above[0] for above, below in itertools.pairwise(domains))
    low, high = printed["domains"][-1]
    if lanes and LANE_PRINTED * lanes <= LANES_PRINTED * room:
        assert room * (high - low) / lanes == pytest.approx(LANE_PRINTED)
    else:
        assert printed["domains"] == figure["domains"]
