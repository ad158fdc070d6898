"""The report as a reader has it: in Chromium, from a file, without a network."""

import re
import time as clock
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cardume.report.page.page import write_page
from cardume.simulation.flight import Flight
from report.browser import LACKING, Page, browser
from report.runs import HOSTILE, hostile_run, make_run
from report.synthetic import make_flight, with_certainty

pytestmark = [
    pytest.mark.skipif(bool(LACKING), reason=LACKING),
    pytest.mark.slow,
    pytest.mark.timeout(900),  # drawing in three dimensions without a graphics card, beside other tests
]
PICTURES = Path(__file__).parents[2] / ".cache" / "pictures"
FLIGHT = make_flight()
NOW = (
    "return [...document.getElementById('now').tBodies[0].rows].map(r => [...r.cells].slice(1).map(c => c.textContent))"
)

LEGEND = "return [...document.querySelectorAll('#plan .legendtext')].map(t => t.textContent)"
ELLIPSES = "document.getElementById('plan').data.filter(t => t.legendgroup === 'ellipses')"


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    """The report of a synthetic flight, open."""
    path = tmp_path_factory.mktemp("page") / "report.html"
    write_page(path, make_run(FLIGHT))
    with browser() as opened:
        opened.open(path)
        yield opened


def drawn(page: Page, chart: str, trace: str) -> tuple[np.ndarray, np.ndarray]:
    """Abscissas and ordinates of what moves in a chart, as it is drawn."""
    script = """
        const node = document.getElementById(arguments[0]);
        const report = JSON.parse(document.getElementById('report-data').textContent);
        const trace = node.data[report.figures[arguments[0]].moving[arguments[1]]];
        return [Array.from(trace.x), Array.from(trace.y)];
    """
    x, y = page.run(script, chart, trace)
    return np.array(x, float), np.array(y, float)


def move_to(page: Page, time: float) -> None:
    """As a hand does: the slider's value, and the event that follows."""
    script = """
        const slider = document.getElementById('time');
        slider.value = arguments[0];
        slider.dispatchEvent(new Event('input', { bubbles: true }));
    """
    page.run(script, time)


def settled(page: Page, chart: str, trace: str, wanted: np.ndarray) -> None:
    """Plotly draws a little after it is told."""
    page.wait(
        f"""(() => {{
            const report = JSON.parse(document.getElementById('report-data').textContent);
            const trace = document.getElementById('{chart}').data[report.figures['{chart}'].moving['{trace}']];
            return Math.abs(trace.x[0] - {wanted[0]}) < 1e-3; }})()"""
    )


def test_it_opens_without_a_network_and_without_a_complaint(page: Page) -> None:
    assert page.asked_for() == []
    assert [text for text in page.complaints() if "willReadFrequently" not in text] == []


@pytest.mark.parametrize("time", [0.0, 17.0, 250.0, 699.0, 700.0])
def test_the_slider_moves_the_vehicles_to_where_the_log_has_them(page: Page, time: float) -> None:
    move_to(page, time)
    row = int(np.flatnonzero(FLIGHT.times == time)[0])
    wanted = {
        name: FLIGHT.channels[name][row] for name in ("north", "east", "north_estimate", "east_estimate", "depth")
    }
    for chart in ("plan", "space"):
        settled(page, chart, "vehicles", wanted["east"])
        for trace, ending in (("vehicles", ""), ("believed", "_estimate")):
            east, north = drawn(page, chart, trace)
            np.testing.assert_allclose(north, wanted[f"north{ending}"], atol=1e-4)
            np.testing.assert_allclose(east, wanted[f"east{ending}"], atol=1e-4)
    cells = page.run(NOW)
    np.testing.assert_allclose(np.array(cells[0], float), wanted["north"], atol=0.0051)
    np.testing.assert_allclose(np.array(cells[2], float), wanted["depth"], atol=0.051)
    assert page.run("return document.getElementById('instant').textContent") == f"{time:.0f} s"


ROOM = """
    const box = (name) => document.querySelector(`#plan ${name}`).getBoundingClientRect();
    return box('.nsewdrag').top - box('.legend .scrollbox').bottom + 3;
"""


@pytest.fixture
def unsure(page: Page, tmp_path: Path) -> Iterator[Flight]:
    """The page of a flight with error ellipses is open; then the other one again."""
    flight, before = with_certainty(FLIGHT), page.run("return location.href")
    write_page(tmp_path / "report.html", make_run(flight))
    page.open(tmp_path / "report.html")
    yield flight
    page.go(before)


@pytest.mark.parametrize("time", [150.0, 250.0, 420.5])
def test_ellipses_are_those_of_the_covariance_in_the_log(page: Page, unsure: Flight, time: float) -> None:
    """All points at n' P^-1 n = 5.991, around the whole, and as wide as the variances say; between records too."""
    page.run("cardume.setTime(arguments[0])", time)
    told = [1] if time < 200.0 else [1, 2]
    now = {name: [np.interp(time, unsure.times, v[:, k]) for k in range(3)] for name, v in unsure.channels.items()}
    settled(page, "plan", "vehicles", np.array(now["east"]))
    for k in told:
        east, north = drawn(page, "plan", f"ellipse_{k}")
        away = np.column_stack([north - now["north_estimate"][k], east - now["east_estimate"][k]])
        both = now["north_east_covariance"][k]
        matrix = np.array([[now["north_variance"][k], both], [both, now["east_variance"][k]]])
        distance = np.einsum("pi,ij,pj->p", away, np.linalg.inv(matrix), away)
        np.testing.assert_allclose(distance, 5.991, rtol=2e-3)
        # of 48 points evenly around, the outermost lies within 3.75 degrees of the very end
        reach = np.sqrt(5.9915 * np.diag(matrix))
        for ends in (away.max(axis=0), -away.min(axis=0)):
            assert np.all((ends <= reach * 1.001) & (ends >= reach * np.cos(np.radians(3.75)) * 0.999))
        np.testing.assert_array_equal(away[0], away[-1])
    if 2 not in told:
        assert drawn(page, "plan", "ellipse_2")[0].size == 0
    assert [text for text in page.complaints() if "willReadFrequently" not in text] == []


def test_on_paper_a_longer_legend_stands_above_the_plan(page: Page, unsure: Flight) -> None:
    """On the screen it takes two lines, on paper one; the axes are to follow."""
    assert page.run(ROOM) >= 0.0
    page.run("window.dispatchEvent(new Event('beforeprint'))")
    assert page.run(ROOM) >= 0.0
    page.run("window.dispatchEvent(new Event('afterprint'))")
    clock.sleep(0.5)
    assert page.run(ROOM) >= 0.0


def test_ellipses_have_a_word_and_the_colors_of_their_vehicles(page: Page, unsure: Flight) -> None:
    assert page.run(LEGEND).count("expected error, 95 %") == 1
    _, *colors = page.run(f"return {ELLIPSES}.map(t => t.line.color)")  # the first is the legend's
    assert colors == page.run("return document.getElementById('plan').data.at(-1).marker.color")[1:]
    assert len(colors) == len(unsure.vehicle_names) - 1


def test_without_a_law_that_tells_it_there_is_no_ellipse(page: Page) -> None:
    assert not any("95 %" in word for word in page.run(LEGEND))
    assert page.run(f"return {ELLIPSES}.length") == 0


def test_vehicles_point_where_they_head(page: Page) -> None:
    move_to(page, 100.0)
    settled(page, "plan", "vehicles", FLIGHT.channels["east"][100])
    angles = page.run("return document.getElementById('plan').data.at(-1).marker.angle")
    np.testing.assert_allclose(angles, np.degrees(FLIGHT.channels["heading"][100]), atol=1e-3)


def test_the_marks_on_the_screen_are_where_the_axes_say(page: Page) -> None:
    """Not only in the data: the drawn marks, measured in pixels against the axes of the chart."""
    move_to(page, 400.0)
    settled(page, "plan", "vehicles", FLIGHT.channels["east"][400])
    script = """
        const node = document.getElementById('plan');
        const { xaxis, yaxis } = node._fullLayout;
        const marks = [...node.querySelectorAll('.scatterlayer .trace')].at(-1).querySelectorAll('.points path');
        return [...marks].map(m => {
            const [, x, y] = m.getAttribute('transform').match(/translate\\(([-\\d.]+),([-\\d.]+)\\)/);
            return [xaxis.p2l(Number(x)), yaxis.p2l(Number(y))];
        });
    """
    found = np.array(page.run(script))
    wanted = np.column_stack([FLIGHT.channels["east"][400], FLIGHT.channels["north"][400]])
    np.testing.assert_allclose(found, wanted, atol=0.02)
    scales = page.run(
        "const {xaxis, yaxis} = document.getElementById('plan')._fullLayout; return [xaxis._m, -yaxis._m]"
    )
    assert scales[0] == pytest.approx(scales[1], rel=1e-6)


def test_the_keyboard_is_enough(page: Page) -> None:
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys

    def press(key: str) -> Any:
        ActionChains(page.driver).send_keys(key).perform()
        return page.run("return cardume.time()")

    move_to(page, 300.0)
    page.run("document.activeElement.blur()")
    assert press(Keys.ARROW_RIGHT) == 301.0
    assert press(Keys.ARROW_LEFT) == 300.0
    page.driver.find_element(By.ID, "time").send_keys(Keys.ARROW_RIGHT)
    assert page.run("return cardume.time()") == 301.0
    assert press(Keys.PAGE_DOWN) == 266.0  # a twentieth of the flight
    press(Keys.HOME)
    page.wait("cardume.time() === 0")
    page.run("document.activeElement.blur()")
    press(" ")
    page.wait("cardume.time() > 5")
    press(" ")
    stopped = page.run("return cardume.time()")
    assert page.run("return document.getElementById('play').textContent") == "▶ Play"
    assert stopped > 5.0
    reached = []
    page.run("document.querySelector('a[download]').focus()")
    for _ in range(40):
        press(Keys.TAB)
        reached.append(page.run("return document.activeElement.id"))
        if reached[-1] == "speed":
            break
    assert [name for name in reached if name in ("play", "time", "speed")] == ["play", "time", "speed"]


def test_pointing_at_one_panel_marks_all(page: Page) -> None:
    script = """
        const node = document.getElementById('series');
        Plotly.Fx.hover(node, { xval: 350 }, ['xy']);
        return [node._hoverdata.map(p => [p.x, p.data.yaxis || 'y'])];
    """
    (found,) = page.run(script)
    panels = {axis for _, axis in found}
    assert len(panels) >= 6
    assert {x for x, _ in found} == {350.0}


def test_hostile_names_are_shown_and_not_run(page: Page, tmp_path: Path) -> None:
    path = tmp_path / "report.html"
    write_page(path, hostile_run())
    current = page.run("return location.href")
    page.open(path)
    page.run("cardume.setTime(50)")
    assert page.run("return window.hacked === undefined && document.images.length === 0")
    assert page.run("return document.title") == HOSTILE[0] + HOSTILE[1]
    heads = page.run("return [...document.querySelectorAll('#now th.name')].map(th => th.textContent)")
    assert heads == list(HOSTILE)
    legend = page.run("return [...document.querySelectorAll('#plan .legendtext')].map(t => t.textContent)")
    assert HOSTILE[0] in legend
    assert page.run("return document.querySelectorAll('svg a, svg image').length") == 0
    assert [text for text in page.complaints() if "willReadFrequently" not in text] == []
    page.go(current)


@pytest.mark.parametrize(("width", "height", "is_dark"), [(1280, 800, False), (390, 844, False), (1280, 800, True)])
def test_it_fits_the_screen(page: Page, tmp_path: Path, width: int, height: int, is_dark: bool) -> None:
    path = tmp_path / "report.html"
    write_page(path, make_run(FLIGHT))
    page.open(path, width, height, is_dark)
    assert page.run("return document.documentElement.scrollWidth <= window.innerWidth")
    PICTURES.mkdir(parents=True, exist_ok=True)
    picture = PICTURES / f"report-{width}x{height}{'-dark' if is_dark else ''}.png"  # kept, for people to look at
    page.picture(picture)
    assert picture.stat().st_size > 20_000
    back = page.run("return getComputedStyle(document.body).backgroundColor")
    levels = [int(level) for level in re.findall(r"\d+", back)[:3]]
    assert (max(levels) < 64) == is_dark


def test_it_prints(page: Page, tmp_path: Path) -> None:
    page.print(tmp_path / "report.pdf")
    content = (tmp_path / "report.pdf").read_bytes()
    assert content.startswith(b"%PDF")
    assert 3 <= len(re.findall(rb"/Type /Page\b", content)) <= 12
