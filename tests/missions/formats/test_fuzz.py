"""Whatever a path file holds, it is flown or refused with a reason: no other exception, and not for long."""

import copy
import json
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from cardume.errors import InputError, MissionError
from cardume.missions.formats import parse_plan, read_plan
from cardume.missions.formats.content import FORMATS, decode
from cardume.paths.offset import offset_path
from missions.formats.make_paths import FOLDER
from missions.formats.test_files import GOOD

SMALL = [name for name in GOOD if (FOLDER / name).stat().st_size < 12_000]
WORDS = [
    b"nan",
    b"-1",
    b"1e999",
    b"",
    b"null",
    b"{}",
    b"[]",
    b"0",
    b"\xff\xfe",
    b"<",
    b'"',
    b"\t",
    b"-181",
    b"&x;",
    b"true",
]


def try_out(content: bytes, named: str = "") -> None:
    """Read and lay out; a refusal says where, in one printable line for each problem."""
    try:
        plan = parse_plan(decode(content, "any file"), "any file", named=named)
        assert np.isfinite(offset_path(plan.segments, 0.0, 0.0, 0.5)).all()
    except MissionError as refusal:
        for problem in refusal.problems:
            assert str(problem).startswith("any file")
            assert str(problem).isprintable()
            assert len(str(problem)) < 800
    except InputError as refused:
        said = str(refused)
        assert said.isprintable()


@given(st.binary(max_size=300), st.sampled_from(["", *FORMATS]))
def test_bytes(content: bytes, named: str) -> None:
    try_out(content, named)


@given(st.text(max_size=200), st.sampled_from(["QGC WPL 110\n", "{", "<gpx>", "3\n491854.338 4290819.848 29S\n"]))
def test_texts_with_a_good_beginning(text: str, head: str) -> None:
    try_out((head + text).encode("utf-8", "surrogatepass"))


@given(st.sampled_from(SMALL), st.floats(0.0, 1.0))
@settings(max_examples=60)
def test_files_that_were_cut_off(name: str, share: float) -> None:
    content = (FOLDER / name).read_bytes()
    try_out(content[: int(share * len(content))], "")


@given(
    st.sampled_from(SMALL),
    st.lists(st.tuples(st.floats(0.0, 1.0), st.integers(0, 12), st.sampled_from(WORDS)), max_size=4),
)
@settings(max_examples=150)
def test_files_that_were_changed(name: str, changes: list[tuple[float, int, bytes]]) -> None:
    content = (FOLDER / name).read_bytes()
    for share, width, word in changes:
        at = int(share * len(content))
        content = content[:at] + word + content[at + width :]
    try_out(content)


scalars = st.sampled_from(
    [None, True, -1, 0, 1, 2, 16, 177, 178, 1e308, 10**400, "", "Plan", 38.7, -9.1, [], {}, [1], "x" * 300]
)


@given(
    st.sampled_from([n for n in SMALL if n.endswith((".plan", ".geojson"))]),
    st.lists(st.tuples(st.integers(0, 10_000), scalars), min_size=1, max_size=3),
)
@settings(max_examples=200)
def test_values_of_another_kind(name: str, changes: list[tuple[int, Any]]) -> None:
    content = json.loads((FOLDER / name).read_text())
    for at, value in changes:
        places = list(_places(content))
        container, key = places[at % len(places)]
        container[key] = copy.deepcopy(value)
    try_out(json.dumps(content).encode())


def _places(value: Any) -> Any:
    entries = (
        list(value.items()) if isinstance(value, dict) else list(enumerate(value)) if isinstance(value, list) else []
    )
    for key, inner in entries:
        yield value, key
        yield from _places(inner)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "is empty"),
        (b"\n \t\r\n", "is empty"),
        (b"\xef\xbb\xbf", "holds no mission"),
        ("QGC WPL 110\n".encode("utf-16"), "UTF-16"),
        (b"{" * 100_000, "nested too deeply|not JSON"),
        (b'{"a":' * 50_000, "nested too deeply|not JSON"),
        (b"[" * 100_000, "nested too deeply|not JSON"),
        (b'{"type": ' + b"9" * 5000 + b"}", "too many digits"),
        (b"<gpx>" * 1000, "nested too deeply"),
        (b"<gpx><rte><rtept lat='1' lon='2'/></rte>", "not XML"),
        (b"[1, 2]", "must be an object"),
        (b"null", "version|holds no mission"),
    ],
)
def test_what_would_blow_up_is_refused(content: bytes, said: str) -> None:
    started = time.process_time()
    with pytest.raises(MissionError, match=said):
        parse_plan(decode(content, "x"), "x")
    assert time.process_time() - started < 2.0


@pytest.mark.parametrize(
    ("version", "declaration"),
    [
        ("internal", '<!DOCTYPE gpx [<!ENTITY a "ha"><!ENTITY b "&a;&a;">]>'),
        ("external", '<!DOCTYPE gpx SYSTEM "file:///etc/passwd">'),
        ("parameter", '<!DOCTYPE gpx [<!ENTITY % p SYSTEM "http://127.0.0.1:9/"> %p;]>'),
        ("none", "<!DOCTYPE gpx>"),
    ],
)
def test_entities_are_refused_before_they_are_opened(version: str, declaration: str) -> None:
    text = f'<?xml version="1.0"?>\n{declaration}<gpx><rte><name>&a;</name></rte></gpx>'
    with pytest.raises(MissionError, match="x:2: declares a document type or entities"):
        parse_plan(text, "x")


def test_a_large_survey_takes_no_long(tmp_path: Path) -> None:
    """A million bytes, and an error at their end, which must not be looked for again and again."""
    content = json.loads((FOLDER / "boat_speeds.plan").read_text())
    items = content["mission"]["items"]
    content["mission"]["items"] = [json.loads(json.dumps(items[1 + k % 2] | {"doJumpId": k + 1})) for k in range(3000)]
    (tmp_path / "large.plan").write_text(json.dumps(content, indent=4))
    started = time.process_time()
    assert len(read_plan(tmp_path / "large.plan").segments) > 1000
    content["mission"]["items"][-1]["params"][4] = 95.0
    (tmp_path / "large.plan").write_text(json.dumps(content, indent=4))
    with pytest.raises(MissionError, match=r"mission.items.2999: latitude 95 deg"):
        read_plan(tmp_path / "large.plan")
    assert time.process_time() - started < 3.0


def test_a_long_recording_is_thinned_to_what_a_path_may_have(tmp_path: Path) -> None:
    latitude, longitude = np.cumsum(np.random.default_rng(1).normal(0.0, 1e-5, (2, 30_000)), axis=1)
    rows = "".join(f'<trkpt lat="{a:.7f}" lon="{b:.7f}"/>\n' for a, b in zip(latitude, longitude, strict=True))
    (tmp_path / "day.gpx").write_text(f"<gpx><trk><trkseg>{rows}</trkseg></trk></gpx>")
    started = time.process_time()
    plan = read_plan(tmp_path / "day.gpx")
    assert time.process_time() - started < 8.0
    assert 500 < len(plan.segments) <= 4096
    (note,) = plan.notes
    assert "30,000 points are more than the 4,096 legs that a path may have" in note
