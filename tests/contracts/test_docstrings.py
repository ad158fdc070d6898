"""Every public name says what a reader must know before calling it (CONTRIBUTING.md, "Docstrings")."""

from pathlib import Path

import pytest

from contracts.docstring_rules import complaints, vocabulary

PACKAGE = Path(__file__).parents[2] / "src" / "cardume"
SOURCES = {path: path.read_text(encoding="utf-8") for path in sorted(PACKAGE.rglob("*.py"))}
WORDS = vocabulary(SOURCES)


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_public_names_state_units_shapes_errors_and_sources(path: Path) -> None:
    found = complaints(SOURCES[path], path.relative_to(PACKAGE).as_posix(), WORDS)
    if found:
        pytest.fail("\n".join(found), pytrace=False)


# ---- the rules themselves --------------------------------------------------------------------------------------------

DEFINITIONS = """
Meters = Annotated[float, Unit("m")]
guidance_law, guide = law_family("guidance", ())
"""
GOOD = '''"""Steering."""
@guidance_law
def steer(
    error: PathError, memory: Integral, dt: Seconds, lookahead: Positive[Meters] = 5.0,
    gain: Annotated[float, Unit("N/m")] = 1.0,
) -> Radians:
    """Steer to the path.

    Args:
        error: path error; cross_track > 0 to starboard.
        lookahead: [m] distance ahead
            on the tangent, > 0.
        gain: [N/m]

    Raises:
        MissionError: where there is no path.

    Source: a paper (2001), eq. (3).
    """
    if lookahead < 0.0:
        raise MissionError("no path")

@compiled
def wrap_angle(angle: float, turns: int) -> float:
    """The same angle [rad] in (-pi, pi]."""

def laplacian(adjacency: np.ndarray) -> np.ndarray:
    """Degree minus adjacency.

    Args:
        adjacency: [-] (N, N), rows are listeners.
    """

class Integral(NamedTuple):
    """Memory of the law; drift [m/s] is what it learned."""

    distance: float  # [m]
    drift: float = 0.0
'''


def judge(text: str) -> list[str]:
    return complaints(text, "onboard/guidance/steer.py", vocabulary({Path("laws.py"): DEFINITIONS}))


def test_a_complete_file_passes() -> None:
    assert judge(GOOD) == []


@pytest.mark.parametrize(
    ("said", "instead", "complaint"),
    [
        ('"""Steering."""\n', "", "module has no docstring"),
        ("lookahead: [m] distance", "lookahead: distance", "argument lookahead lacks its [unit]"),
        ("lookahead: [m] distance", "lookahead: [km] distance", "in [km] by its docstring and in [m]"),
        ("lookahead: [m] distance", "lookahead: [0, 1] distance", "argument lookahead lacks its [unit]"),
        ("gain: [N/m]", "gain:", "argument gain lacks its [unit]"),
        ("gain: [N/m]", "gain: [N m]", "in [N m] by its docstring and in [N/m]"),
        ("Source: a paper (2001), eq. (3).", "", "a law without"),
        ("MissionError: where", "where", "raises MissionError"),
        ("angle [rad] in", "angle in", "argument angle lacks its [unit]"),
        ("(N, N), rows", "rows", "argument adjacency lacks its shape"),
        ("adjacency: [-]", "adjacency:", "argument adjacency lacks its [unit]"),
        ("  # [m]", "", "field distance lacks its [unit]"),
        ("drift [m/s]", "drift", "field drift lacks its [unit]"),
        ('"""Degree minus', '# """Degree minus', "laplacian: has no docstring"),
    ],
)
def test_each_rule_bites(said: str, instead: str, complaint: str) -> None:
    text = GOOD.replace(said, instead, 1)
    if instead.startswith("#"):
        text = text.replace('rows are listeners.\n    """', "rows are listeners.\n    ")
        text = text[: text.index("# ")] + "pass\n" + text[text.index("class Integral") :]
    found = judge(text)
    assert len(found) == 1
    assert complaint in found[0]
