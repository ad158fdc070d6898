"""Primitives: plain Python functions for which compiled code has a few machine instructions instead.

Numba's `overload` compiles a little function for every combination of types; a primitive is typed by
a rule and written straight as LLVM code, which keeps the first compilation of the engine short.
"""

from collections.abc import Callable
from typing import Any

from numba import types
from numba.core.typing.templates import AbstractTemplate, infer_global
from numba.extending import lower_builtin


def primitive(function: Callable[..., Any], typer: Callable[..., Any]) -> Callable[[Any], Any]:
    """Decorate the code generator of a plain Python function.

    Args:
        function: what it does, in plain Python.
        typer: (argument types) -> Numba signature, or None where the function does not apply.

    Returns:
        A decorator for generate(context, builder, signature, arguments) -> LLVM value.
    """

    class Template(AbstractTemplate):
        key = function

        def generic(self, arguments: Any, keywords: Any) -> Any:
            return None if keywords else typer(*arguments)

    infer_global(function, types.Function(Template))

    def register(generate: Callable[..., Any]) -> Callable[..., Any]:
        lower_builtin(function, types.VarArg(types.Any))(generate)
        return generate

    return register
