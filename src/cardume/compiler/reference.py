"""A record by reference: compiled code hands on its address instead of copying all that it holds.

A fleet or a mind holds dozens of values. Passed by value to a function that is not inlined each of them is copied,
and to inline all that takes a fleet makes the engine too large for the processor's cache of instructions.
"""

from typing import Any

from llvmlite import ir
from numba import types
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
    return field_at(builder, value, kind.record.instance_class._fields.index(name))


def field_at(b: Any, reference: Any, place: int) -> Any:
    """LLVM code that reads one field; a row of a table is aligned for one number, not for eight."""
    return b.load(b.gep(reference, [ir.Constant(INT32, 0), ir.Constant(INT32, place)], inbounds=True), align=8)


def record_at(c: Any, b: Any, kind: Any, reference: Any) -> Any:
    """LLVM code that reads the whole record of a ReferenceType."""
    return c.make_tuple(b, kind.record, [field_at(b, reference, k) for k in range(len(kind.record.types))])


def value_of(record: Any) -> Any:
    """The record itself, of one that may be by reference; what is not asked of it is not read.

    Args:
        record: a `NamedTuple`.
    """
    return record


def _value_type(record: Any) -> Any:
    return (record.record if isinstance(record, ReferenceType) else record)(record)


@primitive(value_of, _value_type)
def _read_all(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    kind = signature.args[0]
    return record_at(c, b, kind, arguments[0]) if isinstance(kind, ReferenceType) else arguments[0]


def put_aside(b: Any, value: Any) -> Any:
    """LLVM code that puts a value on the stack of the function and gives its address."""
    with b.goto_entry_block():
        place = b.alloca(value.type)
    b.store(value, place)
    return place


def passing(record: Any) -> Any:
    """The same record, by reference, until this place in the calling function makes the next one.

    It lies on the stack of that function, which may hand it on to those that it calls but never return it.

    Args:
        record: a `NamedTuple`.

    Returns:
        In compiled code its address; in plain Python the record itself.
    """
    return record


@primitive(passing, lambda record: ReferenceType(record)(record) if isinstance(record, types.BaseNamedTuple) else None)
def _take_the_address(c: Any, b: Any, signature: Any, arguments: Any) -> Any:
    return put_aside(b, arguments[0])
