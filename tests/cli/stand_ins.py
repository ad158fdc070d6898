"""Stand-ins for what reads, checks and flies missions, so that the command line can be tried by itself."""

import math
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

from cardume.simulation.flight import Flight
from report.synthetic import make_flight


class Result(NamedTuple):
    """How a command ended."""

    code: int
    out: str
    err: str


class Stage:
    """What the stand-ins do; a test changes it before it runs a command."""

    def __init__(self) -> None:
        self.mission = make_mission()
        self.flight = make_flight(num_rows=71)
        self.findings: list[Any] = []
        self.opened: list[tuple[Any, ...]] = []
        self.opening: Callable[[], None] = lambda: None
        self.flying: Callable[[Any, Any], None] = lambda progress, should_stop: None

    def open_mission(self, given: str, overrides: Any = (), seed: int | None = None, allow_code: Any = ()) -> Any:
        self.opened.append((given, overrides, seed, allow_code))
        self.opening()
        return self.mission

    def fly_mission(self, mission: Any, progress: Any, should_stop: Any, allow_code: Any = ()) -> Flight:
        progress("compile", 0, 18)
        progress("compile", 18, 18)
        progress("fly", 0, 7000)
        self.flying(progress, should_stop)
        if should_stop():
            return replace(self.flight, reason="interrupted", flown=312.0)
        progress("fly", 7000, 7000)
        return self.flight


def make_mission() -> SimpleNamespace:
    """As much of a mission as the command line looks at."""
    law = SimpleNamespace(name="line_of_sight", parameters={"lookahead": 5.0})
    unknown = SimpleNamespace(name="my_lab.laws:mine", parameters={})
    vehicle = SimpleNamespace(guidance=SimpleNamespace(law=law), model=unknown, autopilot=unknown)
    return SimpleNamespace(
        name="figure-5",
        seed=7,
        duration=700.0,
        is_fixed=True,
        path=None,
        require=(),
        transient=SimpleNamespace(threshold=0.5, hold=10.0),
        current=SimpleNamespace(name="uniform", parameters={"speed": 0.1, "towards": math.pi / 3}),
        vehicles=(vehicle,),
        to_yaml=lambda directory=None: "cardume: 1\nname: figure-5\n",
    )


def tree(folder: str = ".") -> dict[str, bytes]:
    """Every file below a folder."""
    return {str(path): path.read_bytes() for path in Path(folder).rglob("*") if path.is_file()}


def command(*arguments: str) -> list[str]:
    return [sys.executable, "-c", "from cardume.cli.main import main; main()", *arguments]
