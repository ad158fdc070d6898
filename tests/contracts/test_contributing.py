"""The law in CONTRIBUTING.md works as it is printed there."""

import importlib.util
import re
from pathlib import Path

import pytest

from cardume.laws import Law
from cardume.signals import PathError
from contracts.docstring_rules import complaints, vocabulary

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "src" / "cardume"
EXAMPLE = re.search(r"```python\n(.*?)```", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"), re.DOTALL)[1]


@pytest.fixture
def law(tmp_path: Path) -> Law:
    file = tmp_path / "vector_field.py"
    file.write_text(EXAMPLE, encoding="utf-8")
    spec = importlib.util.spec_from_file_location("vector_field", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.vector_field


def test_the_example_is_a_law_with_its_units(law: Law) -> None:
    assert {parameter.name: parameter.unit for parameter in law.parameters} == {"approach": "rad", "width": "m"}


def test_the_example_leads_onto_the_path(law: Law) -> None:
    on_path, to_starboard, far_to_port = (PathError(path_course=0.3, cross_track=e) for e in (0.0, 5.0, -1e9))
    assert law(on_path) == 0.3
    assert law(to_starboard) == pytest.approx(0.3 - 1.2 / 2)
    assert law(far_to_port) == pytest.approx(0.3 + 1.2)


def test_the_example_keeps_the_docstring_rules() -> None:
    words = vocabulary({path: path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py")})
    assert complaints(EXAMPLE, "onboard/guidance/vector_field.py", words) == []
    assert complaints(EXAMPLE.replace("Source:", ""), "onboard/guidance/vector_field.py", words)
