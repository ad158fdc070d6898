"""The laboratory as a person has it: in Chromium, moved by hand and by keys."""

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("tornado", reason="pip install 'cardume[lab]'")

from cardume.missions.opening import open_mission
from lab.serving import serving
from report.browser import LACKING, Page, browser

pytestmark = [
    pytest.mark.skipif(bool(LACKING), reason=LACKING),
    pytest.mark.slow,
    pytest.mark.timeout(900),
]
PICTURES = Path(__file__).parents[2] / ".cache" / "pictures"
PROGRAM = [sys.executable, "-c", "from cardume.cli.main import main; main()", "lab", "--no-browser"]

# What does not change where paper/figure-5 goes: limits that it stays within, phases of errors it does not have,
# metrics, and what moves it only up and down.
WITHOUT_EFFECT = re.compile(
    r"require\.|transient\.|variation_time_constant|sound_speed|max_range|use_sway|correlation_time|deepest|deviation_phase"
    r"|heave|depth_integral_gain|thrust_max|log_period"
)
MOVE = """
    const row = [...document.querySelectorAll('.control')].find((one) => one.dataset.key === arguments[0]);
    const slider = row.querySelector('.slider');
    slider.value = Number(slider.min) + arguments[1] * (slider.max - slider.min);
    slider.dispatchEvent(new Event('input', { bubbles: true }));
"""
DRAWN = """
    return document.getElementById('plan').data.filter((trace) => trace.meta === 'track')
        .map((trace) => [...trace.x].concat([...trace.y]));
"""


SWEPT = """\
cardume: 1
name: swept
duration: 60 s
guidance: {lookahead: {sweep: [5 m, 9 m]}}
path: {type: line, length: 200 m}
formation: {speed: 0.5 m/s}
vehicles: [{name: alone, model: kinematic, sensors: ideal, start: {cross_track: 4 m}}]
"""


def opened(page: Page, address: str, width: int = 1280, height: int = 800, is_dark: bool = False) -> None:
    scheme = {"name": "prefers-color-scheme", "value": "dark" if is_dark else "light"}
    page.say("Emulation.setEmulatedMedia", features=[scheme])
    page.resize(width, height)
    page.go(address)


def complaints(page: Page) -> list[str]:
    """What the console says, but for advice to plotly.js on how to be faster."""
    return [text for text in page.complaints() if "willReadFrequently" not in text]


# Lines that a test can cut, and of which it can make the answers late.
LINES = """
    window.lines = [];
    window.late = 0;
    window.WebSocket = class extends WebSocket {
        constructor(address) { super(address); window.lines.push(this); }
        set onmessage(does) { super.onmessage = (event) => setTimeout(() => does(event), window.late); }
    };
"""
SLOW = """
    for (const name of ['react', 'animate']) {
        const draw = Plotly[name];
        Plotly[name] = (...given) => new Promise((done) => setTimeout(() => done(draw(...given)), 1500));
    }
"""


def flights(page: Page) -> int:
    return int(page.run("return document.body.dataset.flown"))


def move(page: Page, key: str, share: float) -> None:
    """As a hand does, until the new flight is drawn."""
    before = page.run("return cardume.latencies.length")
    page.run(MOVE, key, share)
    page.wait(f"cardume.latencies.length > {before} || document.body.dataset.refused > 0")


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    with serving(tmp_path_factory.mktemp("work"), "paper/figure-5") as served:
        yield served


@pytest.fixture(scope="module")
def page(lab: Any) -> Iterator[Page]:
    with browser() as window:
        opened(window, lab.guard.address)
        yield window


@pytest.fixture(autouse=True)
def fresh(request: pytest.FixtureRequest) -> None:
    """Every test begins with the mission as it is in its file."""
    if "page" in request.fixturenames:
        page = request.getfixturevalue("page")
        page.go(page.run("return location.href"))


def test_it_opens_without_a_complaint_and_asks_nobody_else(page: Page, lab: Any) -> None:
    assert complaints(page) == []
    urls = page.asked_for()
    assert urls
    assert all(url.startswith((lab.guard.address, f"ws://127.0.0.1:{lab.guard.port}/")) for url in urls)
    assert page.run("return document.getElementById('verdict').textContent") == "✓ Requirements met"


def test_each_slider_moves_the_drawn_track(page: Page) -> None:
    sliders = page.run(
        "return [...document.querySelectorAll('.control')].filter((row) => row.querySelector('.slider'))"
        ".map((row) => row.dataset.key)"
    )
    assert len(sliders) > 100
    idle = []
    for key in sliders:
        page.run("delete document.body.dataset.refused")
        first = page.run(DRAWN)
        move(page, key, 0.75)
        if page.run(DRAWN) == first:
            move(page, key, 0.25)  # a limit may bind on one side only
        assert page.run("return document.body.dataset.refused") is None, key
        if page.run(DRAWN) == first:
            idle.append(key)
        before = flights(page)
        page.run("document.getElementById('reset').click()")
        page.wait(f"document.body.dataset.flown > {before}")
    assert [key for key in idle if not WITHOUT_EFFECT.search(key)] == []
    assert complaints(page) == []


def test_what_is_drawn_is_what_the_number_says(page: Page) -> None:
    from cardume.missions.flying import fly_mission

    move(page, "vehicles.surface.acoustics.loss", 0.6)
    shown = page.run(
        "return [...document.querySelectorAll('.control')].find((one) => one.dataset.key ==="
        " 'vehicles.surface.acoustics.loss').querySelector('.value').value"
    )
    flight = fly_mission(open_mission("paper/figure-5", [f"acoustics.loss={shown}"]))
    for vehicle, track in enumerate(page.run(DRAWN)):
        count = len(track) // 2
        assert track[count - 1] == pytest.approx(flight.channels["east"][-1, vehicle], abs=1e-3)
        assert track[-1] == pytest.approx(flight.channels["north"][-1, vehicle], abs=1e-3)


def test_the_keyboard_is_enough(page: Page) -> None:
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.keys import Keys

    def press(*keys: str) -> None:
        ActionChains(page.driver).send_keys(*keys).perform()

    page.run("document.activeElement.blur()")
    press("/")
    assert page.run("return document.activeElement.id") == "filter"
    press("lookahead")
    seen = page.run("return [...document.querySelectorAll('.control')].filter((row) => row.offsetParent).length")
    assert 1 <= seen <= 3
    first = page.run(DRAWN)
    for _ in range(20):
        press(Keys.TAB)
        if page.run("return document.activeElement.classList.contains('slider')"):
            break
    before = flights(page)
    press(Keys.ARROW_RIGHT, Keys.ARROW_RIGHT)
    page.wait(f"document.body.dataset.flown > {before}")
    assert page.run(DRAWN) != first
    assert page.run("return document.querySelector('.control.changed .value').value") != "5"
    page.run("document.activeElement.blur()")
    press("p")
    page.wait("document.getElementById('pin').getAttribute('aria-pressed') === 'true'")
    press("p")


def test_a_law_is_switched_and_a_run_pinned(page: Page) -> None:
    page.run("document.getElementById('pin').click()")
    before = flights(page)
    page.run(
        "const select = [...document.querySelectorAll('.control')].find((one) => one.dataset.key ==="
        " 'vehicles.surface.guidance.law').querySelector('select');"
        "select.value = 'arcsine'; select.dispatchEvent(new Event('change'));"
    )
    page.wait(f"document.body.dataset.flown > {before}", 300)
    keys = page.run("return [...document.querySelectorAll('.control')].map((row) => row.dataset.key)")
    assert "vehicles.surface.guidance.gain" in keys
    assert "vehicles.surface.guidance.lookahead" not in keys
    dashed = page.run(
        "return document.getElementById('plan').data.filter((t) => t.line && t.line.dash === 'dash').length"
    )
    assert dashed == 3
    assert "law as in the file, now arcsine" in page.run("return document.getElementById('pinned').textContent")
    heads = page.run("return [...document.querySelectorAll('#numbers th')].map((th) => th.textContent)")
    assert heads[-3:] == ["now", "pinned", "change"]


def test_waypoints_are_dragged_and_moved_by_keys(page: Page) -> None:
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys

    page.run("document.getElementById('waypoints').click()")
    page.wait("document.querySelectorAll('.handle').length > 5")
    handle = page.driver.find_elements(By.CLASS_NAME, "handle")[1]
    said = handle.get_attribute("aria-label")
    before = flights(page)
    ActionChains(page.driver).click_and_hold(handle).move_by_offset(15, -20).release().perform()
    page.wait(f"document.body.dataset.flown > {before}")
    assert page.run("return cardume.lab.laws.path").startswith("{type: waypoints, points: [")
    page.wait("document.querySelectorAll('.handle').length > 5")
    handle = page.driver.find_elements(By.CLASS_NAME, "handle")[1]
    assert handle.get_attribute("aria-label") != said
    kept = page.run("return cardume.lab.laws.path")
    page.run("document.querySelectorAll('.handle')[1].focus()")
    ActionChains(page.driver).send_keys(Keys.ARROW_UP).perform()
    page.wait(f"cardume.lab.laws.path !== {kept!r}")
    count = page.run("return document.querySelectorAll('.handle').length")
    ActionChains(page.driver).send_keys(Keys.DELETE).perform()
    page.wait(f"document.querySelectorAll('.handle').length === {count - 1}")


def test_a_study_grows_and_stops(page: Page) -> None:
    page.run("document.getElementById('runs').value = 500; document.getElementById('begin').click()")
    page.wait("document.querySelectorAll('#histogram .bars path').length > 2", 300)
    page.run("document.getElementById('stop').click()")
    assert "stopped after" in page.run("return document.getElementById('found').textContent")
    assert page.run("return document.getElementById('begin').disabled") is False
    assert page.run("return document.getElementById('metric').value") == "cross_track_rms"


def test_another_mission_ends_the_study_and_clears_what_it_found(page: Page) -> None:
    page.run("document.getElementById('runs').value = 100000; document.getElementById('begin').click()")
    page.wait("document.querySelectorAll('#histogram .bars path').length > 2", 300)
    choose(page, "kinematic/circle")
    assert page.run("return document.querySelectorAll('#histogram .bars path').length") == 0
    assert page.run("return document.getElementById('metric').options.length") == 0
    assert "missions" not in page.run("return document.getElementById('found').textContent")
    assert page.run("return document.getElementById('begin').disabled") is False


def choose(page: Page, name: str) -> None:
    """Open another mission from the list, until it is drawn."""
    before = flights(page)
    page.run(
        "const select = document.getElementById('mission'); select.value = arguments[0];"
        "select.dispatchEvent(new Event('change'));",
        name,
    )
    page.wait(f"document.body.dataset.flown > {before}", 300)


def test_what_one_should_know_of_a_mission_stays_to_be_read(page: Page, lab: Any) -> None:
    (lab.folder.root / "old.yaml").write_text(SWEPT, encoding="utf-8")
    page.go(page.run("return location.href"))
    choose(page, "old.yaml")
    move(page, "vehicles.alone.start.cross_track", 0.6)
    assert "guidance.lookahead is swept" in page.run("return document.getElementById('notes').innerText")
    choose(page, "kinematic/line")
    assert page.run("return document.getElementById('notes').hidden")


def test_a_line_that_breaks_loses_no_work(page: Page, lab: Any) -> None:
    script = page.say("Page.addScriptToEvaluateOnNewDocument", source=LINES)["identifier"]
    try:
        page.go(page.run("return location.href"))
        choose(page, "kinematic/line")
        page.run("document.getElementById('pin').click()")
        move(page, "vehicles.alone.guidance.lookahead", 0.9)
        page.run(
            "const seed = document.getElementById('seed'); seed.value = 77; seed.dispatchEvent(new Event('input'));"
        )
        page.wait("cardume.lab.flight.seed === 77")
        kept, values = page.run(DRAWN), page.run("return cardume.changes()")
        before = flights(page)
        page.run("lines.at(-1).close()")
        page.wait("document.body.dataset.lost === 'gone'")
        page.wait(f"!document.body.dataset.lost && document.body.dataset.flown > {before}")
        assert page.run("return document.getElementById('mission').value") == "kinematic/line"
        assert page.run("return cardume.changes()") == values
        assert page.run("return cardume.lab.flight.seed") == 77
        assert page.run(DRAWN) == kept
        assert page.run("return document.querySelectorAll('.control.changed').length") == 1
        assert page.run("return document.getElementById('pin').getAttribute('aria-pressed')") == "true"
    finally:
        page.say("Page.removeScriptToEvaluateOnNewDocument", identifier=script)


def test_a_flight_that_was_asked_for_while_another_is_drawn_is_shown(page: Page) -> None:
    script = page.say("Page.addScriptToEvaluateOnNewDocument", source=LINES)["identifier"]
    try:
        page.go(page.run("return location.href"))
        move(page, "vehicles.surface.acoustics.loss", 0.1)
        first = page.run(DRAWN)
        page.run(SLOW)
        page.run(MOVE, "vehicles.surface.acoustics.loss", 0.4)
        time.sleep(0.4)  # it is flown, and being drawn
        page.run("window.late = 2000")
        page.run(MOVE, "vehicles.surface.acoustics.loss", 0.9)
        page.wait("cardume.lab.flight && cardume.latencies.length > 2", 60)
        assert page.run(DRAWN) != first
    finally:
        page.say("Page.removeScriptToEvaluateOnNewDocument", identifier=script)


def test_what_is_too_large_is_refused_on_the_page(page: Page) -> None:
    page.run(
        "const value = document.querySelector('.control .value'); value.value = arguments[0];"
        "value.dispatchEvent(new Event('change'));",
        "9" * 1_000_000,
    )
    page.wait("document.getElementById('banner').textContent.includes('too large')")
    assert page.run("return document.body.dataset.lost") is None
    before = flights(page)
    page.run("document.getElementById('reset').click()")
    page.wait(f"document.body.dataset.flown > {before}")


def test_the_file_that_the_browser_is_started_with_leads_to_the_page(page: Page, lab: Any) -> None:
    from cardume.cli.lab import door

    with door(lab.guard.address) as file:
        page.driver.get(file.as_uri())
        page.wait("location.protocol === 'http:' && document.body && document.body.dataset.ready === 'yes'", 300)
    assert page.run("return location.href") == lab.guard.address


def test_saving_and_the_report(page: Page, lab: Any) -> None:
    move(page, "vehicles.surface.acoustics.loss", 0.4)
    page.run("document.getElementById('name').value = 'lossy'; cardume.lab; document.getElementById('save').click()")
    page.run("document.getElementById('keep').click()")
    page.wait("document.getElementById('status').textContent === 'saved as lossy.yaml'")
    assert open_mission(lab.folder.root / "lossy.yaml").vehicles[0].acoustics.parameters["loss"] == pytest.approx(0.4)
    here = page.driver.current_window_handle
    page.run("document.getElementById('report').click()")
    for _ in range(100):
        if len(page.driver.window_handles) > 1:
            break
        time.sleep(0.1)
    page.driver.switch_to.window(next(name for name in page.driver.window_handles if name != here))
    page.wait("document.body && document.body.dataset.ready === 'yes'", 300)
    assert page.run("return document.title") == "figure-5"
    page.driver.close()
    page.driver.switch_to.window(here)


def test_two_pages_at_once(page: Page, lab: Any) -> None:
    here = page.driver.current_window_handle
    page.driver.switch_to.new_window("tab")
    page.driver.get(lab.guard.address)
    page.wait("document.body && document.body.dataset.ready === 'yes'", 300)
    other = page.driver.current_window_handle
    move(page, "vehicles.surface.acoustics.loss", 0.9)
    changed = page.run(DRAWN)
    page.driver.switch_to.window(here)
    assert page.run(DRAWN) != changed
    move(page, "current.speed", 0.9)
    page.driver.switch_to.window(other)
    assert page.run(DRAWN) == changed
    assert complaints(page) == []
    page.driver.close()
    page.driver.switch_to.window(here)


@pytest.mark.parametrize(("width", "height", "is_dark"), [(1280, 800, False), (390, 844, False), (1280, 800, True)])
def test_it_fits_the_screen(page: Page, lab: Any, width: int, height: int, is_dark: bool) -> None:
    opened(page, lab.guard.address, width, height, is_dark)
    assert page.run("return document.documentElement.scrollWidth <= window.innerWidth")
    PICTURES.mkdir(parents=True, exist_ok=True)
    picture = PICTURES / f"lab-{width}x{height}{'-dark' if is_dark else ''}.png"  # kept, for people to look at
    page.picture(picture)
    assert picture.stat().st_size > 20_000
    back = page.run("return getComputedStyle(document.body).backgroundColor")
    levels = [int(level) for level in re.findall(r"\d+", back)[:3]]
    assert (max(levels) < 64) == is_dark


def begun(folder: Path, *options: str) -> tuple[subprocess.Popen[str], str]:
    process = subprocess.Popen(
        [*PROGRAM, "kinematic/line", "--folder", str(folder), *options],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env=os.environ | {"PYTHONUNBUFFERED": "1"},
    )
    assert process.stdout is not None
    return process, process.stdout.readline().split()[-1]


def test_a_page_whose_laboratory_ended_says_so_and_what_to_do(tmp_path: Path) -> None:
    process, address = begun(tmp_path)
    port = re.search(r":(\d+)/", address)
    assert port is not None
    with browser() as window:
        try:
            opened(window, address)
            process.send_signal(signal.SIGKILL)
            process.wait(30)
            window.wait("document.body.dataset.lost === 'gone'")
            assert "cardume lab again" in window.run("return document.getElementById('banner').textContent")
            process, address = begun(tmp_path, "--port", port[1])
            window.wait("document.body.dataset.lost === 'other'")
            assert "address that cardume lab printed last" in window.run(
                "return document.getElementById('banner').textContent"
            )
            window.driver.get(address)
            window.wait("document.body && document.body.dataset.ready === 'yes'", 300)
        finally:
            process.terminate()
            assert process.wait(30) == 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_in_good_order(tmp_path: Path, number: signal.Signals) -> None:
    process, address = begun(tmp_path)
    assert re.fullmatch(r"http://127\.0\.0\.1:\d+/[\w-]{43}/", address)
    process.send_signal(number)
    said, _ = process.communicate(timeout=60)
    assert process.returncode == 0
    assert "ended" in said
    assert "Traceback" not in said
    assert list(tmp_path.iterdir()) == []
