"""Everything that can go wrong, as one small tree; the class decides how `cardume` exits.

    CardumeError                 exit code
      InputError                 2   what the user gave cannot be used
        UnitError                    a quantity in a wrong or unknown unit
        LawError                     a law that cannot be found or breaks its family's contract
        DataError                    a data file that is missing, damaged or does not fit
        MissionError                 a mission file, with the position of every problem
      FlightError                3   the mission failed while flying

Any other exception that reaches the command line is a bug of ours: exit code 4.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

MOST_SHOWN = 20


class Position(NamedTuple):
    """Where a value was given: `source` is a file, or the `--set` or `--vary` that gave it, then line 0."""

    source: str
    line: int
    key: str

    def __str__(self) -> str:
        is_said = self.source.startswith((f"--set {self.key}=", f"--vary {self.key}="))
        parts = (self.source, str(self.line or ""), "" if is_said else self.key)
        return ":".join(part for part in parts if part)


class Problem(NamedTuple):
    """One thing wrong with a mission: where, and what was given, what is valid, what to do."""

    position: Position
    message: str

    def __str__(self) -> str:
        return f"{self.position}: {self.message}"


class CardumeError(Exception):
    """The root of every error cardume raises on purpose."""

    exit_code = 4


class InputError(CardumeError):
    """What the user gave cannot be used; nothing was run."""

    exit_code = 2


class UnitError(InputError):
    """A quantity that is no number, has an unknown unit, or has the wrong dimension."""


class LawError(InputError):
    """A law that cannot be found, may not be imported, or breaks its family's contract."""


class DataError(InputError):
    """A data file that is missing, damaged, or does not hold what is needed."""


class MissionError(InputError):
    """A mission that cannot be flown, with every problem found and where it is."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems = tuple(dict.fromkeys(problems))
        super().__init__(self.problems)

    def __str__(self) -> str:
        lines = [str(problem) for problem in self.problems[:MOST_SHOWN]]
        unshown = len(self.problems) - len(lines)
        return "\n".join([*lines, f"... and {unshown} more problems"] if unshown else lines)


class Collector:
    """Gathers the problems of several steps, so that one run tells them all.

    with collector:
        step()                  # a MissionError is kept, and the next step follows
    collector.finish()          # raises all that was kept
    """

    def __init__(self) -> None:
        self.problems: list[Problem] = []

    def __enter__(self) -> Collector:
        return self

    def __exit__(self, kind: object, error: BaseException | None, _trace: object) -> bool:
        if not isinstance(error, MissionError):
            return False
        self.add(error)
        return True

    def add(self, error: MissionError) -> None:
        """Keep the problems of an error that was not raised."""
        self.problems += error.problems

    def finish(self) -> None:
        """End the collection.

        Raises:
            MissionError: with everything that was kept, if anything was.
        """
        if self.problems:
            raise MissionError(self.problems)


class FlightError(CardumeError):
    """A mission that failed while flying: which vehicle, which signal, when."""

    exit_code = 3

    def __init__(self, reason: str, vehicle: str, signal: str, time: float) -> None:
        self.reason, self.vehicle, self.signal, self.time = reason, vehicle, signal, time
        super().__init__(reason, vehicle, signal, time)

    def __str__(self) -> str:
        return f"vehicle {self.vehicle}, {self.signal}, at {self.time:g} s: {self.reason}"
