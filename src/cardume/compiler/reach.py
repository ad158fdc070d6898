"""What a user's law reaches: its helpers are compiled with it, and its name in the cache covers them all."""

import dis
import hashlib
import typing
from collections.abc import Callable
from types import CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np
from numba import config, njit

from cardume.compiler.compiled import INLINED, OPTIONS, is_compiled
from cardume.compiler.fusing import fused


def _helpers(function: FunctionType) -> dict[str, FunctionType]:
    """Plain Python functions that the body names and that compiled code cannot call yet."""
    found = {}
    for name in function.__code__.co_names:
        value = function.__globals__.get(name)
        if isinstance(value, FunctionType) and not is_compiled(value) and not _is_primitive(value):
            found[name] = value
    return found


def _is_primitive(function: FunctionType) -> bool:
    """Whether compiled code has machine code for a function of this package."""
    return function.__module__.startswith("cardume.compiler")


def is_recursive(function: Any, above: tuple[Any, ...] = ()) -> bool:
    """Whether a function reaches itself: Numba aborts the process when it reloads such code from disk."""
    if function in above:
        return True
    return any(is_recursive(helper, (*above, function)) for helper in _helpers(function).values())


def with_compiled_helpers(function: Any, done: dict[Any, Any] | None = None) -> Any:
    """A compiled twin of a plain function and, through it, of every plain helper that it calls."""
    done = {} if done is None else done
    if config.DISABLE_JIT or is_compiled(function):
        return function
    if function not in done:
        twin = FunctionType(
            function.__code__,
            dict(function.__globals__),
            function.__name__,
            function.__defaults__,
            function.__closure__,
        )
        twin.__module__, twin.__qualname__ = function.__module__, function.__qualname__
        fused(twin.__code__)
        done[function] = njit(**OPTIONS, **INLINED)(twin)
        twin.__globals__.update({n: with_compiled_helpers(h, done) for n, h in _helpers(function).items()})
    return done[function]


def fingerprint(function: Callable[..., Any], wrapper: str = "") -> str:
    """Hash of the bytecode and constants of a function and of all it reaches by name, and of the code around it.

    Its module counts too: what is kept on disk imports it by name when it is read, so another module with the
    same code must not find it.
    """
    digest = hashlib.blake2s(f"{function.__module__} {wrapper}".encode(), digest_size=8)
    seen: set[Any] = set()

    def add(value: Any, scope: dict[str, Any]) -> None:
        value = getattr(value, "py_func", value)
        if isinstance(value, CodeType):
            _add_code(value, scope)
        elif isinstance(value, FunctionType):
            if value not in seen and not value.__module__.startswith("cardume."):
                seen.add(value)
                add(value.__code__, value.__globals__)
                for cell in value.__closure__ or ():
                    add(cell.cell_contents, value.__globals__)
                add(value.__defaults__, value.__globals__)
        elif isinstance(value, np.ndarray):
            digest.update(repr((value.dtype.str, value.shape)).encode() + value.tobytes())
        elif isinstance(value, type) and hasattr(value, "_fields"):
            digest.update(repr((value._fields, getattr(value, "_field_defaults", {}))).encode())
        elif isinstance(value, tuple):
            for part in value:
                add(part, scope)
        elif isinstance(value, (bool, int, float, str, np.generic)):
            digest.update(repr(value).encode())

    def _add_code(code: CodeType, scope: dict[str, Any]) -> None:
        digest.update(code.co_code)
        modules = [scope[n] for n in code.co_names if isinstance(scope.get(n), ModuleType)]
        for name in code.co_names:
            digest.update(name.encode())
            add(scope.get(name), scope)
            for module in modules:  # helpers.turn: the attribute stands in the names too
                add(vars(module).get(name), vars(module))
                modules += [v for v in [vars(module).get(name)] if isinstance(v, ModuleType) and v not in modules]
        for constant in code.co_consts:
            add(constant, scope)

    add(function, {})
    return digest.hexdigest()


def fields_read(function: Callable[..., Any], kind: type[Any]) -> set[str]:
    """Which fields of a record a function reads of its argument of that kind; all of them where that cannot be seen.

    Seen is only the plain case: the argument is loaded, and the next instruction takes a field of it.

    Args:
        function: plain Python with annotations.
        kind: the class of the record.

    Returns:
        Names of fields; none without such an argument.
    """
    hints = typing.get_type_hints(function)
    names = {name for name, hint in hints.items() if hint is kind and name != "return"}
    everything, found = set(kind._fields), set()
    steps = list(dis.get_instructions(function))
    for step, after in zip(steps, [*steps[1:], None], strict=True):
        # since Python 3.13 one instruction may store or load a local and then load another: both stand in it, in order
        mentioned = step.argval if isinstance(step.argval, tuple) else (step.argval,)
        if names.isdisjoint(mentioned):
            continue
        is_loaded = step.opname.startswith("LOAD") or "_LOAD" in step.opname
        is_last = names.isdisjoint(mentioned[:-1])
        if not (is_loaded and is_last and after and after.opname == "LOAD_ATTR" and after.argval in everything):
            return everything
        found.add(after.argval)
    return found
