"""How a plain function becomes a law.

A law is a plain scalar Python function with named parameters, marked by the decorator of its
family.  Its signature is the only definition: it says which signals the law gets (by annotation),
whether it has a memory (a `NamedTuple` argument that is not a signal), and which parameters a
mission file may set, with unit, default and bounds.  Compiled code calls it by address.
"""

import importlib
import inspect
import math
import threading
import typing
from collections.abc import Callable
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from cardume.compiler import Rows, at, load, load_fixed, store, value_of
from cardume.compiler.calls import (
    FLAT,
    STRIDED,
    WIDE,
    address,
    call_python,
    define_verb,
    law_answer,
    law_signature,
)
from cardume.compiler.compiled import cached, source_stamp
from cardume.compiler.reach import fingerprint, is_recursive, with_compiled_helpers
from cardume.compiler.records import flattened, read_record, size_of
from cardume.errors import LawError
from cardume.parameters import (
    Bounds as Bounds,
    Kilograms as Kilograms,
    Length as Length,
    Meters as Meters,
    MetersPerSecond as MetersPerSecond,
    NewtonMeters as NewtonMeters,
    Newtons as Newtons,
    NotNegative as NotNegative,
    Number as Number,
    Once as Once,
    Parameter as Parameter,
    PerSecond as PerSecond,
    PerSecondSquared as PerSecondSquared,
    Positive as Positive,
    Probability as Probability,
    Radians as Radians,
    RadiansPerSecond as RadiansPerSecond,
    Seconds as Seconds,
    Unit as Unit,
    Words as Words,
    note_in,
    parameter_of,
    parameters_of,
)
from cardume.trial import fits, last_words, same, sample, shape


class LawBook(NamedTuple):
    """Whom to call and with what, for one vehicle: its handles, gains and memories."""

    handles: Any  # Ints (family, 4): handle, first gain, first memory row, memory width
    gains: Rows
    memory: Rows
    dt: float  # [s] one tick


HANDLE, GAINS, MEMORY, WIDTH, COLUMNS = 0, 1, 2, 3, 4  # columns of LawBook.handles

# Every family has its place in the table, whatever is imported first.  The order is the table's layout.
FAMILIES = (
    "guidance",
    "reference_point",
    "compensation",
    "current_observer",
    "position",
    "neighbors",
    "coordination",
    "messaging",
    "speed",
    "autopilot",
    "model",
    "current",
    "acoustics",
    "gnss",
    "ahrs",
    "depth",
    "usbl",
    "dvl",
    "thruster_speed",
    "altimeter",
    "bathymetry",
)
_families: dict[str, "Family"] = {}
_compiling = threading.RLock()  # a law has one address in a process, also where threads ask for it at once


class Family:
    """A kind of law: what all its members receive and return, and the verb that calls them."""

    def __init__(
        self, name: str, signals: tuple[Any, ...], result: Any, plain: str | None = None, may_leave_out: bool = False
    ) -> None:
        self.name, self.signals, self.result, self.plain = name, signals, result, plain
        self.may_leave_out = may_leave_out
        self.place = FAMILIES.index(name)
        self.laws: dict[str, Law] = {}
        _families[name] = self

    def decorator(self, **common: float) -> Any:
        """The decorator that makes a function a law; `common` are parameters the engine itself reads."""

        def make(function: Callable[..., Any]) -> Law:
            law = Law(self, function, common)
            if law.is_builtin:
                self.laws[law.name] = law
            return law

        return make

    def verb(self) -> Callable[..., Any]:
        """A function (book, slot, *signals) -> result; the slot chooses among several memories of the law."""
        first = self.place * COLUMNS

        def call(book: LawBook, slot: int, *signals: Any) -> Any:
            row = book.handles[first : first + COLUMNS]
            memory = book.memory[row[MEMORY] + slot * row[WIDTH] :]
            return call_python(row[HANDLE], (*signals, book.gains[row[GAINS] :], memory, book.dt))

        define_verb(call, self.place, self.signals, self.result)
        return call


def law_family(
    name: str, signals: tuple[Any, ...], result: Any = float, plain: str | None = None, may_leave_out: bool = False
) -> tuple[Callable[[Callable[..., Any]], "Law"], Callable[..., Any]]:
    """Make a family.

    Args:
        name: [-] one of FAMILIES, the mission key.
        signals: [-] record classes that its laws may ask for.
        result: [-] float, a record class or a tuple of them.
        plain: [-] the field of that record which a law means that returns one number; the others are then NaN.
        may_leave_out: [-] whether its laws may leave out the last fields of that record that have defaults.

    Returns:
        The decorator for its laws, and the verb by which compiled code calls them.
    """
    family = Family(name, signals, result, plain, may_leave_out)
    return family.decorator(), family.verb()


def sensor_family(name: str, signals: tuple[Any, ...], result: Any = float) -> tuple[Any, Callable[..., Any]]:
    """Make a family whose laws also have a period and a latency, which the engine keeps.

    Args:
        name: [-] one of FAMILIES.
        signals: [-] record classes that its laws may ask for.
        result: [-] float or a record class.

    Returns:
        A decorator called with default period [s] and latency [s], and the verb.
    """
    family = Family(name, signals, result)

    def decorator(period: float, latency: float = 0.0) -> Any:
        return family.decorator(period=period, latency=latency)

    return decorator, family.verb()


COMMON = MappingProxyType(
    {
        "period": Parameter("period", 0.0, "s", 0.0, math.inf, low_open=True),
        "latency": Parameter("latency", 0.0, "s", 0.0, 60.0),
    }
)


class Law:
    """A function, what its signature says and, once used, the address that compiled code calls."""

    def __init__(self, family: Family, function: Callable[..., Any], common: dict[str, float]) -> None:
        self.family, self.function, self.name = family.name, function, function.__name__
        self.common, self._family = common, family
        self._handles: dict[bool, int] = {}
        self.doc = inspect.getdoc(function) or ""
        self.memory_type: Any = None
        self.parameters: tuple[Parameter, ...] = ()
        self.announced: dict[str, dict[str, float]] = {}  # by family: what its laws' defaults are beside this law
        self.constants_type: Any = None
        self._constants_of: Callable[..., Any] | None = None
        self._constants_name, self._num_own = "", 0
        self._given: list[str] = []
        self._read_signature()
        self.__name__, self.__qualname__, self.__doc__ = self.name, function.__qualname__, function.__doc__
        self.__module__ = function.__module__
        self._kept: list[Any] = []  # compiled code lives as long as this object

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        """Call it in plain Python; what it wants computed from parameters may be given as those."""
        if self._constants_of is None:
            return self.function(*arguments, **named)
        values = {p.name: named.pop(p.name, p.default) for p in self._computed_from()}
        given = inspect.signature(self.function).bind_partial(*arguments, **named).arguments
        if self._constants_name not in given:
            named[self._constants_name] = self._constants_of(dt=given.get("dt", math.nan), **values)
        return self.function(*arguments, **named)

    def __repr__(self) -> str:
        return f"<{self.family} law {self.name}>"

    @property
    def is_builtin(self) -> bool:
        """Whether cardume ships this law."""
        return self.function.__module__.split(".")[0] == "cardume"

    def _read_signature(self) -> None:
        hints = typing.get_type_hints(self.function, include_extras=True)
        own: list[Parameter] = []
        first: list[Parameter] = []
        for argument in inspect.signature(self.function).parameters.values():
            hint = hints.get(argument.name, float)
            if hint in self._family.signals and hint is not float:
                self._given.append(f"signal_{self._family.signals.index(hint)}")
            elif argument.name == "dt":
                self._given.append("dt")
            elif (once := note_in(hint, Once)) is not None:
                self._constants_of, self._constants_name = once.function, argument.name
                self.constants_type = hint.__origin__
                first = parameters_of(once.function)
                self._given.append("constants")
            elif hasattr(hint, "_fields"):
                self._accept_memory(hint)
            elif argument.default is argument.empty:
                raise LawError(
                    f"{self.family} law '{self.name}': parameter '{argument.name}' needs a default value, or the"
                    f" annotation of one of the family's signals: {self._signal_names()}"
                )
            else:
                self._given.append(f"load_fixed(gains, {len(own)})")
                own.append(parameter_of(argument.name, argument.default, hint))
        shared = [COMMON[name]._replace(default=value) for name, value in self.common.items()]
        self._num_own = len(own)
        self.parameters = (*own, *first, *shared)

    def _accept_memory(self, hint: Any) -> None:
        if self.memory_type is not None:
            raise LawError(
                f"{self.family} law '{self.name}' has two records that are no signals of its family,"
                f" {self.memory_type.__name__} and {hint.__name__}; signals are {self._signal_names()}, and one memory"
            )
        if len(hint._field_defaults) != len(hint._fields):
            raise LawError(
                f"{self.family} law '{self.name}': every field of its memory {hint.__name__} needs a default,"
                f" the value at the start of a mission"
            )
        self.memory_type = hint
        self._given.append("memory")

    def _signal_names(self) -> str:
        return ", ".join(s.__name__ for s in self._family.signals)

    def asks_for(self, signal: Any) -> bool:
        """Whether the law takes a signal of its family."""
        return f"signal_{self._family.signals.index(signal)}" in self._given

    @property
    def doc_of_parameters(self) -> str:
        """The docstring that says what the parameters are: the law's, or that of what computes of them."""
        return str((self._constants_of or self.function).__doc__ or "")

    def _computed_from(self) -> tuple[Parameter, ...]:
        """The parameters of which something is computed once."""
        return self.parameters[self._num_own : len(self.parameters) - len(self.common)]

    @property
    def gains_width(self) -> int:
        """How many numbers the law reads in flight: its parameters, or what is computed of them."""
        return self._num_own + (size_of(self.constants_type) if self.constants_type else 0)

    def gains(self, dt: float, **named: float) -> np.ndarray:
        """What the law reads in flight, from its parameters: defaults overridden by name, checked against their bounds.

        Args:
            dt: [s] between two calls.
            named: [any] values of parameters, in the parameter's unit.

        Returns:
            (gains_width,) array.

        Raises:
            LawError: unknown name or a value out of bounds.
        """
        known = {p.name: p for p in self.parameters}
        if unknown := named.keys() - known.keys():
            raise LawError(f"law '{self.name}' has no parameter {sorted(unknown)}; it has {sorted(known)}")
        for name, value in named.items():
            if not known[name].accepts(value):
                p = known[name]
                raise LawError(f"law '{self.name}': {name} = {value} {p.unit} is outside {p.low} to {p.high}")
        own = [named.get(p.name, p.default) for p in self.parameters[: self._num_own]]
        values = {p.name: float(named.get(p.name, p.default)) for p in self._computed_from()}
        constants = self._constants_of(dt=dt, **values) if self._constants_of else ()
        return np.array([*own, *flattened(constants)], float)

    def initial_memory(self) -> np.ndarray:
        """(width,) array of the memory at the start of a mission."""
        if self.memory_type is None:
            return np.zeros(0)
        return np.concatenate([np.ravel(np.asarray(v, float)) for v in self.memory_type()])

    def handle(self, lanes: bool = False) -> int:
        """Where the compiled law lives in THIS process: never store it, never send it.

        Args:
            lanes: [-] for the lanes kernel; negative where the law is called once per lane.

        Returns:
            A machine address.

        Raises:
            LawError: the law does not compile, or returned the wrong thing when tried.
        """
        with _compiling:
            if lanes not in self._handles:
                if not self.is_builtin and not self._handles:
                    self._try_once()
                self._handles[lanes] = self._compile_lanes() if lanes else self._compile(FLAT)
        return self._handles[lanes]

    def _compile_lanes(self) -> int:
        from numba.core.errors import NumbaError  # costs a tenth of a second; only batches need it

        try:
            return self._compile(WIDE)
        except (NumbaError, LawError):
            return -self._compile(STRIDED)

    def _compile(self, rows: Any) -> int:
        from numba.core.errors import NumbaError

        signature = law_signature(self._family.signals, self._family.result, rows)
        try:
            wrapper = cached(self._wrapper(rows), signature, keep=not is_recursive(self.function))
        except NumbaError as problem:
            raise LawError(
                f"{self.family} law '{self.name}' does not compile: {last_words(problem)}\n"
                f"A law is plain scalar Python: numbers, records, `if`, loops, and functions of cardume.maths."
            ) from problem
        self._kept.append(wrapper)
        return address(wrapper, signature)

    def _wrapper(self, rows: Any) -> Any:
        """Write law(*signals, gains, memory, dt) around the function, named after what it is made of."""
        slots, stores, first = [], [], 0
        for field, start in zip(self.memory_type._fields, self.memory_type(), strict=True) if self.memory_type else ():
            if np.ndim(start):
                slots.append(f"at(memory, {first})")
            else:
                slots.append(f"load(memory, {first})")
                stores.append(f"    store(memory, {first}, after.{field})")
            first += int(np.size(start))
        scope: dict[str, Any] = {"__name__": __name__}
        records = {"memory": f"Memory({', '.join(slots)})"}
        if self.constants_type is not None:
            records["constants"] = read_record(self.constants_type, "gains", self._num_own, scope)
        records |= {g: f"value_of({g})" for g in self._given if g.startswith("signal_")}
        given = ", ".join(records.get(g, g) for g in self._given)
        call = f"    answer, after = law({given})" if stores else f"    answer = law({given})"
        if self.memory_type is not None and not stores:
            call = f"    answer, after = law({given})"
        signals = ", ".join(f"signal_{k}" for k in range(len(self._family.signals)))
        body = "\n".join([call, *stores, "    return as_answer(memory, answer)"])
        made_of = source_stamp() + ("" if self.is_builtin else fingerprint(self.function, body))
        name = f"{self.family}_{self.name}_{made_of}_{rows.name}"
        scope |= {"law": with_compiled_helpers(self.function), "Memory": self.memory_type}
        scope |= {
            "load": load,
            "load_fixed": load_fixed,
            "store": store,
            "at": at,
            "value_of": value_of,
            "as_answer": law_answer(self._family.result, self._family.plain, self._family.may_leave_out),
        }
        exec(compile(f"def {name}({signals}, gains, memory, dt):\n{body}", __file__, "exec"), scope)
        return scope[name]

    def _try_once(self) -> None:
        """Call a user's law in Python and look at what it returns, before Numba says it in its own words."""
        required = f"it must return {shape(float if self._family.plain else self._family.result)}"
        if self.memory_type is not None:
            required += f" and the next {self.memory_type.__name__}, as a pair"
        if self._family.plain:
            required += f" (or {shape(self._family.result)} in the number's place)"
        try:
            first, second = self._sample_call(), self._sample_call()
        except Exception as problem:
            raise LawError(
                f"{self.family} law '{self.name}' failed on sample input:"
                f" {type(problem).__name__}: {problem}; {required}"
            ) from problem
        answer = first
        if self.memory_type is not None:
            if not (isinstance(first, tuple) and len(first) == 2 and isinstance(first[1], self.memory_type)):
                raise LawError(f"{self.family} law '{self.name}' returned {first!r}; {required}")
            answer = first[0]
        if not (fits(answer, self._family.result) or (self._family.plain and fits(answer, float))):
            raise LawError(f"{self.family} law '{self.name}' returned {answer!r}; {required}")
        if not same(first, second):
            raise LawError(
                f"{self.family} law '{self.name}' gave {first!r}, then {second!r}, for the same input:"
                f" a law is a pure function of its arguments"
            )

    def sample_answer(self) -> Any:
        """What the law returns for plausible input, without its memory: as the record of its family, if it has one."""
        answer = self._sample_call()
        answer = answer if self.memory_type is None else answer[0]
        plain = self._family.plain
        return answer if plain is None or isinstance(answer, tuple) else self._family.result(**{plain: answer})

    def _sample_call(self) -> Any:
        samples: dict[str, Any] = {f"signal_{k}": sample(kind) for k, kind in enumerate(self._family.signals)}
        fresh = [np.array(v) if np.ndim(v) else v for v in self.memory_type()] if self.memory_type else []
        samples |= {"dt": 0.1, "memory": self.memory_type(*fresh) if self.memory_type else None}
        if self._constants_of is not None:
            samples["constants"] = self._constants_of(dt=0.1, **{p.name: p.default for p in self._computed_from()})
        defaults = iter(p.default for p in self.parameters)
        return self.function(*[samples[g] if g in samples else next(defaults) for g in self._given])

    def __reduce__(self) -> Any:
        """Pickle by reference; a law typed in a script or notebook goes by value."""
        if self.function.__module__ != "__main__":
            return _law_at, (self.function.__module__, self.function.__qualname__)
        import cloudpickle

        return _rebuild, (cloudpickle.dumps((self.family, self.function, self.common)),)


def _law_at(module: str, name: str) -> Law:
    return typing.cast(Law, getattr(importlib.import_module(module), name))


def _rebuild(data: bytes) -> Law:
    import cloudpickle

    family, function, common = cloudpickle.loads(data)
    return Law(_families[family], function, common)


def all_families() -> dict[str, dict[str, Law]]:
    """The built-in laws of every family that has been imported."""
    return {name: dict(_families[name].laws) for name in FAMILIES if name in _families}


def family(name: str) -> Family:
    """A family by its mission key."""
    return _families[name]


def laws_of(name: str) -> dict[str, Law]:
    """The built-in laws of one family."""
    return dict(_families[name].laws)
