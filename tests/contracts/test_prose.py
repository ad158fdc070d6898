"""The two functions that everybody reads first stay readable."""

from pathlib import Path

import pytest

from contracts.prose_rules import complaints, find_function

PACKAGE = Path(__file__).parents[2] / "src" / "cardume"


@pytest.mark.parametrize(("module", "name"), [("simulation/tick.py", "tick"), ("onboard/agent.py", "decide")])
def test_the_heart_reads_as_prose(module: str, name: str) -> None:
    path = PACKAGE / module
    assert path.is_file(), f"src/cardume/{module} is where {name}() stands"
    function = find_function(path.read_text(encoding="utf-8"), name)
    assert function is not None, f"src/cardume/{module} defines no function {name} at its top"
    if found := complaints(function):
        pytest.fail("\n".join(f"src/cardume/{module}:{complaint}" for complaint in found), pytrace=False)


# ---- the rules themselves --------------------------------------------------------------------------------------------


def judge(*body: str) -> list[str]:
    function = find_function("@compiled\ndef f(fleet):\n" + "\n".join(f"    {line}" for line in body), "f")
    assert function is not None
    return complaints(function)


@pytest.mark.parametrize(
    "body",
    [
        ["for i in range(fleet.size):", "    put(fleet, i, fleet.rows[i])", "carry(fleet)"],
        ["if fleet.idle:", "    return", "for i in a:", "    b(i)", "for i in a:", "    c(i)"],
        ["if fleet.size:", "    a()", "elif fleet.idle:", "    b()", "for i in fleet:", "    c(i)"],
        ["x = 0.5 * fleet.speed", "return x, 1"],
        ["pass"] * 38,
    ],
)
def test_prose_passes(body: list[str]) -> None:
    assert judge(*body) == []


@pytest.mark.parametrize(
    ("body", "complaint"),
    [
        (["pass"] * 39, "has 41 lines"),
        (["return fleet[3]"], "fleet[3]: a raw index"),
        (["return fleet[-1]"], "fleet[-1]: a raw index"),
        (["return fleet[i, 0]"], "fleet[i, 0]: a raw index"),
        (["return fleet[1:n]"], "fleet[1:n]: a raw index"),
        (["return fleet[i + 3]"], "fleet[i + 3]: a raw index"),
        (["for i in a:", "    for j in b:", "        c(i, j)"], "`for` within `for`"),
        (["while a:", "    while b:", "        c(i)"], "`while` within `while`"),
        (["for i in a:", "    if i:", "        c(i)"], "`if` within `for`"),
        (
            ["if a:", "    b()", "elif c:", "    d()", "else:", "    if e:", "        f()", "    g()"],
            "`if` within `if`",
        ),
        (["if a:", "    for i in b:", "        c(i)"], "`for` within `if`"),
        (["return [c(i) for i in a]"], "a hidden function or loop"),
        (["g = lambda i: i", "return g"], "a hidden function or loop"),
    ],
)
def test_what_is_not_prose_is_named(body: list[str], complaint: str) -> None:
    found = judge(*body)
    assert any(complaint in line for line in found), found
