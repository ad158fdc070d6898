"""Whoever is not the person at this machine is refused: each way in, tried."""

import os
import queue
import socket
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import url2pathname

import pytest

pytest.importorskip("tornado", reason="pip install 'cardume[lab]'")

from tornado.httpclient import HTTPClientError

from cardume.lab.handlers import PARTS, Lab
from lab.serving import Caller, calling, get, serving

MISSION = """\
cardume: 1
name: here
duration: 20 s
path: {type: line, length: 200 m}
formation: {speed: 0.5 m/s}
vehicles: [{name: alone, model: kinematic, sensors: ideal, start: {cross_track: 4 m}}]
"""
CODE = "import pathlib\npathlib.Path(__file__).with_name('ran').touch()\n"


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a mission, beside one with a secret."""
    top = tmp_path_factory.mktemp("place")
    (top / "work").mkdir()
    (top / "work" / "here.yaml").write_text(MISSION, encoding="utf-8")
    (top / "work" / "evil.py").write_text(CODE, encoding="utf-8")
    (top / "secret.yaml").write_text(MISSION.replace("here", "secret"), encoding="utf-8")
    (top / "work" / "leads-out.yaml").symlink_to(top / "secret.yaml")
    return top


@pytest.fixture(scope="module")
def lab(place: Path) -> Iterator[Lab]:
    """A laboratory in that folder."""
    with serving(place / "work") as served:
        yield served


def test_it_listens_on_this_machine_only(lab: Lab) -> None:
    """Not on all addresses: 127.0.0.2 is this machine too, and reaches who listens everywhere."""
    with pytest.raises(OSError, match="refused"):
        socket.create_connection(("127.0.0.2", lab.guard.port), timeout=3).close()


def test_with_the_token_every_part_is_there_and_asks_for_nothing_else(lab: Lab) -> None:
    for name in (*PARTS, "plotly.js"):
        status, text, headers = get(lab, f"/{lab.guard.token}/{name}")
        assert (status, bool(text)) == (200, True), name
        assert "default-src 'none'" in headers["Content-Security-Policy"]
        assert "unsafe-eval" not in headers["Content-Security-Policy"]
        assert headers["Referrer-Policy"] == "no-referrer"
        assert headers["X-Frame-Options"] == "DENY"


@pytest.mark.parametrize(
    "path", ["/", "/lab.js", "//", "//lab.js", "/wrong/", "/wrong/lab.js", "/wrong/report/x", "/%C3%A9/"]
)
def test_without_the_token_nothing_is_there(lab: Lab, path: str) -> None:
    status, text, _ = get(lab, path)
    assert status == 403
    assert "open the address" in text
    assert lab.guard.token not in text


@pytest.mark.parametrize("spoil", [lambda t: t[:-1], lambda t: t + "x", lambda t: t.swapcase(), lambda t: ""])
def test_a_token_that_is_nearly_right_is_wrong(lab: Lab, spoil) -> None:
    assert get(lab, f"/{spoil(lab.guard.token)}/")[0] == 403
    with pytest.raises(HTTPClientError, match="403"):
        Caller(lab, token=spoil(lab.guard.token))


def test_each_laboratory_has_a_token_of_its_own(lab: Lab, place: Path) -> None:
    with serving(place / "work") as other:
        assert other.guard.token != lab.guard.token
        assert len(other.guard.token) >= 43  # 32 bytes
        assert get(other, f"/{lab.guard.token}/")[0] == 403


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "127.0.0.1", "127.0.0.1:1", "", "127.0.0.1.evil.example:{port}"]
)
def test_a_foreign_host_is_refused(lab: Lab, host: str) -> None:
    """A name that somebody points at 127.0.0.1 is not this machine's."""
    status, text, _ = get(lab, f"/{lab.guard.token}/", Host=host.format(port=lab.guard.port))
    assert status in (400, 403)
    assert "<script" not in text


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "http://127.0.0.1", "https://127.0.0.1:{port}", "http://localhost:{port}"]
)
def test_a_foreign_origin_is_refused(lab: Lab, origin: str) -> None:
    told = origin.format(port=lab.guard.port)
    assert get(lab, f"/{lab.guard.token}/", Origin=told)[0] == 403
    with pytest.raises(HTTPClientError, match="403"):
        Caller(lab, Origin=told)


def test_a_line_without_an_origin_is_refused(lab: Lab) -> None:
    with pytest.raises(HTTPClientError, match="403"):
        Caller(lab, Origin="")


@pytest.mark.parametrize(
    "path", ["../secret.yaml", "..%2f..%2fsecret.yaml", "../../../../etc/passwd", "/etc/passwd", "%00", "session.py"]
)
def test_no_file_is_served_but_the_parts_of_the_page(lab: Lab, path: str) -> None:
    status, text, _ = get(lab, f"/{lab.guard.token}/{path}")
    assert status in (400, 403, 404)
    assert "root:" not in text
    assert "cardume: 1" not in text


@pytest.mark.parametrize(
    "name",
    [
        "../secret.yaml",
        "{place}/secret.yaml",
        "leads-out.yaml",
        "./../work/../secret.yaml",
        "/etc/passwd",
        "\0",
        "evil.py",
        "a" * 5000,
    ],
)
def test_no_mission_outside_of_the_folder_is_opened(lab: Lab, place: Path, name: str) -> None:
    with calling(lab) as page:
        page.say(do="open", name=name.format(place=place))
        told = page.hear("refused", "opened")
        assert told["is"] == "refused"
        assert "duration" not in told["problems"][0]["message"]
        page.say(do="open", name="here.yaml")
        assert page.hear("opened", "refused")["is"] == "opened"


@pytest.mark.parametrize(
    "file", ["/etc/passwd", "../secret.yaml", "leads-out.yaml", "../../no-such-file", "/no/such/file"]
)
def test_no_mission_reads_a_file_outside_of_the_folder(lab: Lab, file: str) -> None:
    """Nor does it learn whether one is there."""
    text = MISSION.replace("{type: line, length: 200 m}", f"{{type: file, file: {file}}}")
    with calling(lab) as page:
        page.say(do="open", name="mine.yaml", text=text)
        told = page.hear("refused", "opened")
        assert "outside" in told["problems"][0]["message"]
        page.say(do="open", name="here.yaml")
        page.hear("flown")
        for section, kind in (("path", "file"), ("current", "gridded")):
            page.say(do="fly", id=1, laws={section: f"{{type: {kind}, file: {file}}}"})
            assert "outside" in page.hear("refused", "flown")["problems"][0]["message"]


@pytest.mark.parametrize(
    "name", ["../mine", "a/b", "/tmp/mine", "..", "", ".hidden", "leads-out", "mine.txt", "a" * 65, "no\0", "a\nb"]
)
def test_nothing_is_saved_outside_of_the_folder(lab: Lab, place: Path, name: str) -> None:
    before = {path: path.read_bytes() for path in place.rglob("*") if path.is_file()}
    with calling(lab) as page:
        page.say(do="open", name="here.yaml")
        page.hear("flown")
        page.say(do="save", name=name, replace=True)
        assert page.hear("refused", "saved")["is"] == "refused"
    assert {path: path.read_bytes() for path in place.rglob("*") if path.is_file()} == before


def test_a_mission_that_names_code_is_refused_and_nothing_is_run(lab: Lab, place: Path) -> None:
    text = MISSION + "guidance: {law: 'evil:law'}\n"
    with calling(lab) as page:
        page.say(do="open", name="evil.yaml", text=text)
        assert "--allow-code" in page.hear("refused", "opened")["problems"][0]["message"]
        page.say(do="open", name="here.yaml")
        page.hear("flown")
        for given in ({"laws": {"guidance.law": "evil:law"}}, {"values": {"guidance": "{law: 'evil:law'}"}}):
            page.say(do="fly", id=1, **given)
            assert "--allow-code" in page.hear("refused", "flown")["problems"][0]["message"]
    assert not (place / "work" / "ran").exists()


def test_an_upload_of_a_gigabyte_is_refused_before_it_is_sent(lab: Lab) -> None:
    status, _, _ = get(lab, f"/{lab.guard.token}/", method="POST", Content_Length="1000000000")
    assert status in (400, 405, 413)
    with calling(lab) as page:
        page.say(do="open", name="large.yaml", text="#" * 1_100_000)
        assert page.ends() == 1009  # "message too big"


def test_a_frame_that_announces_a_gigabyte_ends_the_line(lab: Lab) -> None:
    with socket.create_connection(("127.0.0.1", lab.guard.port), timeout=20) as line:
        host = f"127.0.0.1:{lab.guard.port}"
        head = [
            f"GET /{lab.guard.token}/line HTTP/1.1", f"Host: {host}", f"Origin: http://{host}", "Upgrade: websocket",
            "Connection: Upgrade", "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Version: 13", "", "",
        ]  # fmt: skip
        line.sendall("\r\n".join(head).encode())
        assert b"101" in line.recv(100)
        line.sendall(struct.pack("!BBQ", 0x81, 0x80 | 127, 10**9) + os.urandom(4))  # a text of 10^9 bytes follows
        answer = b""
        while more := line.recv(65536):  # the line is closed, not read on
            answer += more
        assert b"\x88" in answer  # a frame that says so


@pytest.mark.parametrize(
    "said",
    [
        "{",
        "[1]",
        "null",
        '{"do": "sweep the deck"}',
        '{"do": 5}',
        '{"do": "fly", "laws": 3}',
        '{"do": "study", "runs": 1e9}',
    ],
)
def test_nonsense_is_refused_and_harms_nobody(lab: Lab, said: str) -> None:
    with calling(lab) as page:
        page.send(said)
        if said.startswith('{"'):
            assert page.hear("refused")["problems"]
        else:
            assert page.ends() == 1003
    with calling(lab) as page:
        page.say(do="open", name="here.yaml")
        assert page.hear("flown")["flight"]["vehicles"] == ["alone"]


def test_pages_beyond_twenty_are_refused(lab: Lab) -> None:
    callers = [Caller(lab) for _ in range(20 - len(lab.sessions))]
    try:
        with pytest.raises(HTTPClientError, match="503"):
            Caller(lab)
    finally:
        for caller in callers:
            caller.close()


def test_a_bug_is_told_without_the_secret(
    lab: Lab, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def broken(*_given: object) -> str:
        raise ZeroDivisionError("by zero")

    monkeypatch.setattr("cardume.lab.handlers.library", broken)
    status, text, _ = get(lab, f"/{lab.guard.token}/plotly.js")
    assert status == 500
    assert "ZeroDivisionError" in caplog.text
    assert lab.guard.token not in caplog.text + text


def test_the_browser_is_started_without_the_secret_on_its_command_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import webbrowser

    from cardume.cli.main import main

    opened: queue.Queue[str] = queue.Queue()
    seen = []

    def serve(*_given: object, ready: Callable[[str], None], **_more: object) -> None:
        ready("http://127.0.0.1:1/secret/")
        url = opened.get(timeout=30)
        file = Path(url2pathname(urlsplit(url).path))
        seen.append((url, file, file.stat().st_mode & 0o777, file.read_text(encoding="utf-8")))

    monkeypatch.setattr(webbrowser, "open", opened.put)
    monkeypatch.setattr("cardume.lab.server.serve", serve)
    with pytest.raises(SystemExit) as ended:
        main(["lab", "--folder", str(tmp_path)])
    ((url, file, mode, text),) = seen
    assert ended.value.code == 0
    assert "secret" not in url
    assert mode == 0o600
    assert 'content="0; url=http://127.0.0.1:1/secret/"' in text
    assert not file.exists()  # it goes with the laboratory
