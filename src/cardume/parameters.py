"""What a parameter of a law is: a number with a unit, a default and bounds; and short names for the usual ones."""

import inspect
import math
import typing
from collections.abc import Callable
from typing import Annotated, Any, NamedTuple, TypeVar


class Unit(NamedTuple):
    """The unit of a parameter, as the mission file spells it."""

    symbol: str


class Bounds(NamedTuple):
    """Closed bounds of a parameter, unless an end is marked open."""

    low: float = -math.inf
    high: float = math.inf
    low_open: bool = False
    high_open: bool = False


class Words:
    """Words of which a mission file says one; compiled code sees its place among them, from 0.

    Attributes:
        choices: the words.
    """

    def __init__(self, *choices: str) -> None:
        self.choices = choices


class Once(NamedTuple):
    """Marks a law's argument that is computed once, before a mission: `Annotated[Plant, Once(plant_of)]`.

    The function's own arguments, but for `dt`, become parameters of the law; it returns a record of floats.
    """

    function: Callable[..., Any]


class Length(NamedTuple):
    """How many numbers a memory field of rows holds."""

    size: int


Number = Annotated[float, Unit("")]
Meters = Annotated[float, Unit("m")]
Radians = Annotated[float, Unit("rad")]
RadiansPerSecond = Annotated[float, Unit("rad/s")]
Seconds = Annotated[float, Unit("s")]
MetersPerSecond = Annotated[float, Unit("m/s")]
PerSecond = Annotated[float, Unit("1/s")]
PerSecondSquared = Annotated[float, Unit("1/s^2")]
Kilograms = Annotated[float, Unit("kg")]
Newtons = Annotated[float, Unit("N")]
NewtonMeters = Annotated[float, Unit("N m")]

T = TypeVar("T")
N = TypeVar("N")
Positive = Annotated[T, Bounds(0.0, math.inf, low_open=True)]
NotNegative = Annotated[T, Bounds(0.0)]
Probability = Annotated[float, Unit(""), Bounds(0.0, 1.0)]


class Parameter(NamedTuple):
    """What a mission file may set in a law: a number, or one of a few words, of which it is the place."""

    name: str
    default: float
    unit: str = ""
    low: float = -math.inf
    high: float = math.inf
    low_open: bool = False
    high_open: bool = False
    words: tuple[str, ...] = ()

    def accepts(self, value: float) -> bool:
        """Whether a value lies within the bounds."""
        above = value > self.low if self.low_open else value >= self.low
        below = value < self.high if self.high_open else value <= self.high
        return above and below


def note_in(hint: Any, kind: type[N]) -> N | None:
    """What an annotation says of one kind: the last `Unit`, `Bounds`, `Once` in it."""
    return next((note for note in reversed(getattr(hint, "__metadata__", ())) if isinstance(note, kind)), None)


def parameter_of(name: str, default: Any, hint: Any) -> Parameter:
    """The parameter that an argument with a default is."""
    if (words := note_in(hint, Words)) is not None:
        last = len(words.choices) - 1.0
        return Parameter(name, float(default), "", 0.0, last, words=words.choices)
    unit, bounds = note_in(hint, Unit) or Unit(""), note_in(hint, Bounds) or Bounds()
    return Parameter(name, float(default), unit.symbol, *bounds)


def parameters_of(function: Callable[..., Any]) -> list[Parameter]:
    """The parameters that a function's arguments are, but for `dt`."""
    hints = typing.get_type_hints(function, include_extras=True)
    arguments = inspect.signature(function).parameters.values()
    return [parameter_of(a.name, a.default, hints.get(a.name, float)) for a in arguments if a.name != "dt"]
