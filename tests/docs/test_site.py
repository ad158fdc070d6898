"""The site of the docs builds without a warning and asks nobody on the network for anything."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("sphinx", reason="pip install 'cardume[docs]'")
pytest.importorskip("myst_parser", reason="pip install 'cardume[docs]'")
pytest.importorskip("furo", reason="pip install 'cardume[docs]'")

ROOT = Path(__file__).parents[2]
LOADED = re.compile(
    r"<(?:script|img|iframe|source)\b[^>]*\bsrc=\"([^\"]+)\"|<link\b[^>]*\brel=\"(?:stylesheet|preload)\"[^>]*\bhref=\"([^\"]+)\""
)


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_it_builds_strictly_and_stands_alone(tmp_path: Path) -> None:
    command = [sys.executable, str(ROOT / "docs" / "site" / "build.py"), str(tmp_path / "site")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    pages = list((tmp_path / "site").rglob("*.html"))
    assert len(pages) > 60
    for page in pages:
        loaded = [first or second for first, second in LOADED.findall(page.read_text(encoding="utf-8"))]
        assert not [address for address in loaded if address.startswith(("http:", "https:", "//"))], page
    law = (tmp_path / "site" / "docs" / "laws" / "guidance.html").read_text(encoding="utf-8")
    assert "<msub><mrow><mi>χ</mi></mrow><mtext>d</mtext></msub>" in law
    assert "lookahead" in law
    assert "cardume.compare" in (tmp_path / "site" / "docs" / "api.html").read_text(encoding="utf-8")


def test_equations_are_read_as_they_are_typed() -> None:
    sys.path.insert(0, str(ROOT / "docs" / "site"))
    try:
        from equations import as_math
    finally:
        sys.path.remove(str(ROOT / "docs" / "site"))
    made = as_math("chi_d = chi_p + atan(-e / d)\nx^2 <= exp(-2 k t)")
    assert made.count("<math") == 2
    assert "<msup><mi>x</mi><mn>2</mn></msup>" in made
    assert "≤" in made
    assert '<mi mathvariant="normal">atan</mi>' in made
    assert "<script" not in as_math("<script>")
