"""Products that feed a sum are rounded once, together with it: the fused multiply-add of every processor since 2013.

C compilers do this where they like (`-ffp-contract`), and the bits then depend on the processor and on the options.
Here a rule that can be read off the source decides, so one mission and eight lanes, with and without AVX, give the same
bits: `a * b + c`, `c + a * b`, `a * b - c` and `c - a * b` are fused where they stand in one expression.  Where both
sides are products neither is: x y' - x' y stays 0 for parallel vectors, and x^2 + y^2 the same with x and y exchanged.
Plain Python rounds twice.
"""

import operator
from collections import Counter
from types import CodeType
from typing import Any

from llvmlite import ir as llvm
from numba.core import ir, types
from numba.core.cgutils import get_or_insert_function
from numba.core.rewrites import Rewrite, register_rewrite

from cardume.compiler.lanes import DOUBLES, LANES, WIDTH, is_number, widened
from cardume.compiler.primitive import primitive

_codes: set[CodeType] = set()  # of the functions to which this applies: other people's compiled code stays as it is


def fused(code: CodeType) -> None:
    """Fuse the products and sums of a function when it is compiled.

    Args:
        code: of the function.
    """
    _codes.add(code)


def _type(a: Any, b: Any, c: Any) -> Any:
    if not all(kind is LANES or is_number(kind) for kind in (a, b, c)):
        return None
    result = LANES if LANES in (a, b, c) else types.float64
    return result(a, b, c)


def product_plus(a: float, b: float, c: float) -> float:
    """a b + c."""
    return a * b + c


def product_less(a: float, b: float, c: float) -> float:
    """a b - c."""
    return a * b - c


def less_product(a: float, b: float, c: float) -> float:
    """c - a b."""
    return c - a * b


def multiply_add(b: Any, x: Any, y: Any, z: Any) -> Any:
    """LLVM code for x y + z, rounded once, of numbers or of lanes."""
    name = f"llvm.fma.v{WIDTH}f64" if x.type == DOUBLES else "llvm.fma.f64"
    return b.call(get_or_insert_function(b.module, llvm.FunctionType(x.type, [x.type] * 3), name), [x, y, z])


def _fma(function: Any, negated: int | None) -> None:
    @primitive(function, _type)
    def generate(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
        parts = [widened(c, b, *part, signature.return_type) for part in zip(arguments, signature.args, strict=True)]
        if negated is not None:
            parts[negated] = b.fneg(parts[negated])
        return multiply_add(b, *parts)


_fma(product_plus, None)
_fma(product_less, 2)
_fma(less_product, 0)

_SUMS, _DIFFERENCES, _PRODUCTS = (
    (operator.add, operator.iadd),
    (operator.sub, operator.isub),
    (operator.mul, operator.imul),
)


@register_rewrite("after-inference")
class _Fuse(Rewrite):
    """Find the products that nothing but one sum of the same expression reads."""

    def __init__(self, state: Any = None) -> None:
        super().__init__(state)
        self._state = state
        self._applies = state is not None and state.func_id.func.__code__ in _codes

    def match(self, func_ir: Any, block: Any, typemap: Any, calltypes: Any) -> bool:
        if not self._applies:
            return False
        self._block, self._types, self._calls = block, typemap, calltypes
        steps = (step for one in func_ir.blocks.values() for step in one.body)
        mentioned = Counter(name.name for step in steps for name in step.list_vars())
        products: dict[str, Any] = {}
        self._found: dict[Any, tuple[Any, Any]] = {}  # sum: product, function
        for step in block.find_insts(ir.Assign):
            name = step.target.name
            if self._is(step.value, _PRODUCTS) and name.startswith("$") and mentioned[name] == 2:  # made, and read once
                products[name] = step
            elif self._is(step.value, _SUMS + _DIFFERENCES):
                left, right = (products.get(side.name) for side in (step.value.lhs, step.value.rhs))
                if (left is None) == (right is None):
                    continue
                is_sum = step.value.fn in _SUMS
                function = product_plus if is_sum else product_less if left else less_product
                self._found[step] = (left or right, function)
        return bool(self._found)

    def _is(self, value: Any, kind: tuple[Any, ...]) -> bool:
        """Whether a step is one of these operations on numbers with fractions."""
        if not (isinstance(value, ir.Expr) and value.op in ("binop", "inplace_binop") and value.fn in kind):
            return False
        signature = self._calls[value]
        return (signature.return_type is LANES or signature.return_type == types.float64) and all(
            self._types[side.name] is LANES or is_number(self._types[side.name]) for side in (value.lhs, value.rhs)
        )

    def apply(self) -> Any:
        made = ir.Block(self._block.scope, self._block.loc)
        gone = {id(product) for product, _ in self._found.values()}
        for step in self._block.body:
            if id(step) in gone:
                continue
            if isinstance(step, ir.Assign) and step in self._found:
                for part in self._call(step, *self._found[step]):
                    made.append(part)
            else:
                made.append(step)
        return made

    def _call(self, step: Any, product: Any, function: Any) -> list[Any]:
        scope, where = self._block.scope, step.loc
        a, b = product.value.lhs, product.value.rhs
        c = step.value.rhs if step.value.lhs.name == product.target.name else step.value.lhs
        callee = scope.redefine("$fused", where)
        kind = self._state.typingctx.resolve_value_type(function)
        self._types[callee.name] = kind
        call = ir.Expr.call(callee, [a, b, c], (), where)
        kinds = [self._types[one.name] for one in (a, b, c)]
        self._calls[call] = self._state.typingctx.resolve_function_type(kind, kinds, {})
        return [
            ir.Assign(ir.Global(function.__name__, function, where), callee, where),
            ir.Assign(call, step.target, where),
        ]
