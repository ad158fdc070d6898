"""The only place that knows Numba: what the rest of the package needs to write compiled code."""

from cardume.compiler.bits import scale2, split2, to_bits, to_float, turned
from cardume.compiler.compiled import compiled, entry, inlined, source_stamp
from cardume.compiler.lanes import (
    WIDTH,
    floor,
    negate,
    some,
    sqrt,
    where,
)
from cardume.compiler.polynomial import polynomial
from cardume.compiler.records import Layout
from cardume.compiler.reference import passing, value_of
from cardume.compiler.rows import (
    Rows,
    SharedRows,
    at,
    by_width,
    gather,
    load,
    load_fixed,
    optional,
    ramp,
    rows_of,
    scatter,
    spill,
    store,
)

__all__ = [
    "WIDTH",
    "Layout",
    "Rows",
    "SharedRows",
    "at",
    "by_width",
    "compiled",
    "entry",
    "floor",
    "gather",
    "inlined",
    "load",
    "load_fixed",
    "negate",
    "optional",
    "passing",
    "polynomial",
    "ramp",
    "rows_of",
    "scale2",
    "scatter",
    "some",
    "source_stamp",
    "spill",
    "split2",
    "sqrt",
    "store",
    "to_bits",
    "to_float",
    "turned",
    "value_of",
    "where",
]
