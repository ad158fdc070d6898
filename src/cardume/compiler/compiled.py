"""How a plain Python function becomes compiled code, and a cache on disk that cannot be stale.

`compiled` leaves the function as it is, plain Python that a debugger can step through, and tells
Numba to use the same source wherever compiled code calls it, for whatever number type it is given.
`entry` makes one of the few functions that Python calls into compiled code; only these, and the
laws of `calls.py`, are kept on disk.  Numba's own key covers just the file that a function stands
in, so both carry a hash of every source of the compute layers in their name: an edit anywhere in
them is a new name.
"""

import hashlib
import inspect
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from numba import config, njit
from numba.extending import overload

from cardume.compiler.fusing import fused

OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy"}
INLINED = {"forceinline": True}
# Numbers that a call passes by value, above which it is inlined: in lanes each takes two registers or 64 bytes of
# stack, and half of `decide` was moving them. Tables and what goes by reference (reference.py) cost nothing.
MOST_PASSED = 6
COMPUTE_LAYERS = (
    "compiler",
    "maths",
    "laws.py",
    "signals.py",
    "paths",
    "vehicles",
    "onboard",
    "world",
    "simulation",
)
F = TypeVar("F", bound=Callable[..., Any])
_registered: set[Callable[..., Any]] = set()


def _numbers_in(kind: Any) -> int:
    """How many numbers a record holds, those of records in it counted one by one, tables not."""
    if not hasattr(kind, "_fields"):
        return 0
    fields = [kind.__annotations__.get(field) for field in kind._fields]
    return sum(1 if field is float else _numbers_in(field) for field in fields)


def compiled(function: F) -> F:
    """Let compiled code call this function; return it unchanged.

    Args:
        function: plain scalar Python, positional arguments only.

    Returns:
        The same function.
    """

    passed = sum(_numbers_in(p.annotation) for p in inspect.signature(function).parameters.values())
    return _specialized(function, OPTIONS | (INLINED if passed > MOST_PASSED else {}))


def inlined(function: F) -> F:
    """The same as `compiled`, in the code of every caller: for what hands back a large record or is short.

    Args:
        function: plain scalar Python, positional arguments only.

    Returns:
        The same function.
    """
    return _specialized(function, OPTIONS | INLINED)


def _specialized(function: F, options: dict[str, Any]) -> F:
    fused(function.__code__)

    # Numba compiles `function` itself, once for each number type that it meets.
    @overload(function, strict=False, jit_options=options)
    def specialized(*arguments: Any) -> Callable[..., Any]:
        return function

    _registered.add(function)
    return function


def is_compiled(function: object) -> bool:
    """Whether compiled code can call this function as it is."""
    return function in _registered


def entry(function: F) -> F:
    """Compile a function that Python calls, kept on disk under a name that carries the source stamp.

    Args:
        function: its arguments are arrays, numbers and records.

    Returns:
        The compiled function; plain Python when NUMBA_DISABLE_JIT is set.
    """
    function.__qualname__ += f"_{source_stamp()}"
    fused(function.__code__)
    return cached(function)


def cached(function: Any, signature: Any = None, keep: bool = True) -> Any:
    """Compile with the cache on disk, or without one where no folder can be written.

    Args:
        function: a function whose name says what it is made of.
        signature: Numba types of the arguments and the result; None compiles at the first call.
        keep: False leaves the cache alone (Numba aborts when it reloads recursive code).

    Returns:
        Numba's dispatcher.
    """
    if config.DISABLE_JIT:
        return function
    try:
        return njit(signature, cache=keep, **OPTIONS)(function)
    except RuntimeError as problem:
        if "cannot cache" not in str(problem):
            raise
        return njit(signature, **OPTIONS)(function)


def is_kept(compiled_function: Any) -> bool:
    """Whether the cache on disk has the code of an `entry`, or there is no such cache to fill."""
    files = getattr(getattr(compiled_function, "_cache", None), "_cache_file", None)
    return files is None or Path(files._index_path).exists()


def is_kept_for_lanes(compiled_function: Any) -> bool:
    """Whether the cache on disk, or this process, has the code of an `entry` for tables of eight missions.

    Args:
        compiled_function: its first argument is a record of tables.
    """
    files = getattr(getattr(compiled_function, "_cache", None), "_cache_file", None)
    if files is None:
        return False
    processor = compiled_function.targetctx.codegen().magic_tuple()
    on_disk = [arguments for arguments, made_for, _ in files._load_index() if made_for == processor]
    known = [arguments[0] for arguments in (*on_disk, *compiled_function.overloads)]
    return any(getattr(table, "ndim", 0) == 2 for tables in known for table in getattr(tables, "types", ()))


@cache
def source_stamp() -> str:
    """Hash of every source file of the compute layers (the command line is not among them)."""
    package = Path(__file__).parent.parent
    digest = hashlib.blake2s(digest_size=6)
    for layer in COMPUTE_LAYERS:
        place = package / layer
        for file in sorted(place.rglob("*.py")) if place.is_dir() else [place]:
            digest.update(file.relative_to(package).as_posix().encode())
            digest.update(file.read_bytes())
    return digest.hexdigest()
