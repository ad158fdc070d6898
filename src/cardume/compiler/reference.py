"""A record by reference: compiled code hands on its address instead of copying all that it holds.

A fleet or a mind holds dozens of values. Passed by value to a function that is not inlined each of them is copied,
and to inline all that takes a fleet makes the engine too large for the processor's cache of instructions.
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.imputils import lower_getattr_generic
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import models, register_model

from cardume.compiler.lanes import INT32
from cardume.compiler.primitive import primitive


class ReferenceType(types.Type):
    """Numba type of the address of a record; its fields are read as the record's own."""

    def __init__(self, record: Any) -> None:
        self.record = record
        super().__init__(name=f"Reference({record})")


@register_model(ReferenceType)
class _ReferenceModel(models.PrimitiveModel):
    def __init__(self, manager: Any, fe_type: Any) -> None:
        super().__init__(manager, fe_type, manager.lookup(fe_type.record).get_value_type().as_pointer())


@infer_getattr
class _ReferenceFields(AttributeTemplate):
    key = ReferenceType

    def generic_resolve(self, reference: Any, name: str) -> Any:
        fields = reference.record.instance_class._fields
        return reference.record.types[fields.index(name)] if name in fields else None


@lower_getattr_generic(ReferenceType)
def _read_field(context: Any, builder: Any, kind: Any, value: Any, name: str) -> Any:
    place = kind.record.instance_class._fields.index(name)
    return builder.load(builder.gep(value, [ir.Constant(INT32, 0), ir.Constant(INT32, place)], inbounds=True))


def passing(record: Any) -> Any:
    """The same record, by reference, until this place in the calling function makes the next one.

    Args:
        record: a `NamedTuple`.

    Returns:
        In compiled code its address; in plain Python the record itself.
    """
    return record


@primitive(passing, lambda record: ReferenceType(record)(record) if isinstance(record, types.BaseNamedTuple) else None)
def _take_the_address(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    return cgutils.alloca_once_value(b, arguments[0])
