"""The page of a study in Chromium: drawn without a network, fitting any screen and paper."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from cardume.report.study.page.page import write_study_page
from report.browser import LACKING, Page, browser
from report.test_study_report import plain, swept

pytestmark = pytest.mark.skipif(bool(LACKING), reason=LACKING)


@pytest.fixture(scope="module")
def page() -> Iterator[Page]:
    with browser() as found:
        yield found


@pytest.mark.parametrize(("width", "height", "is_dark"), [(1280, 800, False), (390, 844, False), (1280, 800, True)])
def test_every_chart_is_drawn_and_fits(page: Page, tmp_path: Path, width: int, height: int, is_dark: bool) -> None:
    path = tmp_path / "report.html"
    write_study_page(path, swept())
    page.open(path, width, height, is_dark)
    assert page.asked_for() == []
    assert [text for text in page.complaints() if "willReadFrequently" not in text] == []
    assert page.run("return document.documentElement.scrollWidth <= window.innerWidth")
    drawn = page.run("return [...document.querySelectorAll('.plot')].map(p => p.querySelectorAll('.main-svg').length)")
    assert len(drawn) > 3
    assert min(drawn) > 0


def test_nothing_of_the_study_runs(page: Page, tmp_path: Path) -> None:
    path = tmp_path / "report.html"
    write_study_page(path, plain())
    page.open(path)
    assert page.run("return document.title") == "study of <b>"
    assert page.run("return document.querySelectorAll('main i, header b').length") == 0


def test_it_prints(page: Page, tmp_path: Path) -> None:
    path = tmp_path / "report.html"
    write_study_page(path, swept())
    page.open(path)
    page.print(tmp_path / "report.pdf")
    content = (tmp_path / "report.pdf").read_bytes()
    assert 2 <= len(re.findall(rb"/Type /Page\b", content)) <= 6
