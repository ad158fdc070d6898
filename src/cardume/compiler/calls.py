"""Calling a law by its machine address, so that laws are data and the kernel never recompiles.

Every law of a family is compiled with one signature, `law(*signals, gains, memory, dt)`, in
Numba's own calling convention, so that exceptions propagate.  A law that does not compile for
lanes is called once per lane; its handle is then negative.  Handles live in one process only.
"""

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import config, types
from numba.core import cgutils
from numba.extending import intrinsic, overload

from cardume.compiler.lanes import INT32, INT64, LANES, WIDTH
from cardume.compiler.rows import LANE_ROWS, ROWS, Rows, SharedRows, lane_of

_python_laws: list[Callable[..., Any]] = []  # NUMBA_DISABLE_JIT: a handle is a place in this list


def record_type(kind: Any, lanes: bool) -> Any:
    """Numba type of a float, a record, or a tuple of them, for one mission or for lanes."""
    if kind is float:
        return LANES if lanes else types.float64
    if isinstance(kind, tuple):
        return types.BaseTuple.from_types([record_type(k, lanes) for k in kind])
    real, rows = (LANES, LANE_ROWS) if lanes else (types.float64, ROWS)
    tables = {Rows: rows, SharedRows: ROWS}
    fields = [tables.get(kind.__annotations__.get(f), real) for f in kind._fields]
    return types.BaseTuple.from_types(fields, kind)


def law_signature(signals: tuple[Any, ...], result: Any, lanes: bool) -> Any:
    """Numba signature that all laws of a family share."""
    rows = LANE_ROWS if lanes else ROWS
    arguments = [record_type(s, lanes) for s in signals]
    return record_type(result, lanes)(*arguments, rows, rows, types.float64)


def make_jump(signals: tuple[Any, ...], result: Any) -> Callable[..., Any]:
    """The function by which compiled code calls a law of this family.

    Args:
        signals: record classes.
        result: float, a record class, or a tuple of them.

    Returns:
        jump(handle, gains, memory, dt, *signals) -> result
    """
    scalar = law_signature(signals, result, lanes=False)
    wide = law_signature(signals, result, lanes=True)

    @intrinsic
    def jump_scalar(context: Any, handle: Any, gains: Any, memory: Any, dt: Any, given: Any) -> Any:
        def generate(c: Any, b: Any, s: Any, arguments: Any) -> Any:
            handle, gains, memory, dt, given = arguments
            parts = cgutils.unpack_tuple(b, given, len(signals))
            return _call(c, b, scalar, handle, [*parts, gains, memory, dt])

        pack = types.BaseTuple.from_types(list(scalar.args[: len(signals)]))
        return scalar.return_type(types.int64, ROWS, ROWS, types.float64, pack), generate

    @intrinsic
    def jump_lanes(context: Any, handle: Any, gains: Any, memory: Any, dt: Any, given: Any) -> Any:
        def generate(c: Any, b: Any, s: Any, arguments: Any) -> Any:
            handle, gains, memory, dt, given = arguments
            parts = cgutils.unpack_tuple(b, given, len(signals))
            answer = cgutils.alloca_once(b, c.get_value_type(wide.return_type))
            vectorized = b.icmp_signed(">", handle, ir.Constant(INT64, 0))
            with b.if_else(vectorized) as (whole, each):
                with whole:
                    b.store(_call(c, b, wide, handle, [*parts, gains, memory, dt]), answer)
                with each, cgutils.for_range(b, ir.Constant(INT64, WIDTH)) as loop:
                    one = [
                        _lane_value(c, b, part, kind, loop.index)
                        for part, kind in zip(parts, wide.args, strict=False)
                    ]
                    rows = [lane_of(c, b, gains, loop.index), lane_of(c, b, memory, loop.index)]
                    value = _call(c, b, scalar, b.neg(handle), [*one, *rows, dt])
                    _put_lane(c, b, answer, value, wide.return_type, loop.index)
            return b.load(answer)

        pack = types.BaseTuple.from_types(list(wide.args[: len(signals)]))
        return wide.return_type(types.int64, LANE_ROWS, LANE_ROWS, types.float64, pack), generate

    def jump(handle: int, gains: Rows, memory: Rows, dt: float, given: Any) -> Any:
        return _python_laws[handle](*given, gains, memory, dt)

    @overload(jump, strict=False)
    def compiled_jump(handle: Any, gains: Any, memory: Any, dt: Any, given: Any) -> Any:
        if gains is LANE_ROWS:
            return lambda handle, gains, memory, dt, given: jump_lanes(handle, gains, memory, dt, given)
        return lambda handle, gains, memory, dt, given: jump_scalar(handle, gains, memory, dt, given)

    return jump


def address(dispatcher: Any, signature: Any) -> int:
    """Where the code of a compiled law lives in this process; under NUMBA_DISABLE_JIT its place in a list."""
    if config.DISABLE_JIT:
        _python_laws.append(dispatcher)
        return len(_python_laws) - 1
    result = dispatcher.get_compile_result(signature)
    return int(result.library.get_pointer_to_function(result.fndesc.llvm_func_name))


def _call(c: Any, b: Any, signature: Any, handle: Any, arguments: Any) -> Any:
    convention = c.call_conv
    pointer = convention.get_function_type(signature.return_type, signature.args).as_pointer()
    law = b.inttoptr(handle, pointer)
    status, value = convention.call_function(b, law, signature.return_type, signature.args, arguments)
    with cgutils.if_unlikely(b, status.is_error):
        convention.return_status_propagate(b, status)
    return value


def _lane_value(c: Any, b: Any, value: Any, kind: Any, lane: Any) -> Any:
    """One lane of a number, a table or a record."""
    if kind is LANES:
        return b.extract_element(value, b.trunc(lane, INT32))
    if kind is LANE_ROWS:
        return lane_of(c, b, value, lane)
    if isinstance(kind, types.BaseTuple):
        scalars = [types.float64 if k is LANES else ROWS for k in kind.types]
        parts = [
            _lane_value(c, b, b.extract_value(value, at), k, lane) for at, k in enumerate(kind.types)
        ]
        return c.make_tuple(b, types.Tuple(scalars), parts)
    return value


def _put_lane(c: Any, b: Any, answer: Any, value: Any, kind: Any, lane: Any) -> None:
    """Store one lane of a result in place."""
    if kind is LANES:
        place = b.gep(b.bitcast(answer, ir.DoubleType().as_pointer()), [lane])
        b.store(value, place)
    elif kind is LANE_ROWS:
        # A lane's rows begin `lane` numbers into the table of all of them.
        data = cgutils.create_struct_proxy(ROWS)(c, b, value).data
        b.store(b.gep(data, [b.neg(lane)]), answer)
    else:
        for k, part in enumerate(kind.types):
            place = b.gep(answer, [ir.Constant(INT32, 0), ir.Constant(INT32, k)])
            _put_lane(c, b, place, b.extract_value(value, k), part, lane)
