"""Two by two matrices, of which the covariance of a horizontal state is made; sums and products written out."""

from typing import NamedTuple

from cardume.compiler import compiled

__all__ = [
    "UNIT",
    "Block",
    "Spread",
    "inverted",
    "plus",
    "scaled",
    "times",
    "times_transposed",
    "transposed",
    "transposed_times",
]


class Block(NamedTuple):
    """A matrix whose rows and columns are north and east."""

    nn: float  # [any]
    ne: float  # [any]
    en: float  # [any]
    ee: float  # [any]


class Spread(NamedTuple):
    """A symmetric one, such as the covariance of two numbers."""

    nn: float  # [any]
    ne: float  # [any]
    ee: float  # [any]


UNIT = Block(1.0, 0.0, 0.0, 1.0)


@compiled
def transposed(a: Block) -> Block:
    """The matrix [any] with rows for columns."""
    return Block(a.nn, a.en, a.ne, a.ee)


@compiled
def scaled(factor: float, a: Block) -> Block:
    """The product of a number and a matrix.

    Args:
        factor: [any]
        a: [any]
    """
    return Block(factor * a.nn, factor * a.ne, factor * a.en, factor * a.ee)


@compiled
def inverted(a: Block) -> Block:
    """The inverse [any] of a symmetric matrix that is positive definite."""
    area = a.nn * a.ee - a.ne * a.en
    return Block(a.ee / area, -a.ne / area, -a.en / area, a.nn / area)


@compiled
def plus(a: Block, factor: float, b: Block) -> Block:
    """The sum a + factor b.

    Args:
        a: [any]
        factor: [any]
        b: [any]
    """
    return Block(a.nn + factor * b.nn, a.ne + factor * b.ne, a.en + factor * b.en, a.ee + factor * b.ee)


@compiled
def times(a: Block, b: Block) -> Block:
    """The product a b.

    Args:
        a: [any]
        b: [any]
    """
    return Block(
        a.nn * b.nn + a.ne * b.en,
        a.nn * b.ne + a.ne * b.ee,
        a.en * b.nn + a.ee * b.en,
        a.en * b.ne + a.ee * b.ee,
    )


@compiled
def times_transposed(a: Block, b: Block) -> Block:
    """The product a b^T.

    Args:
        a: [any]
        b: [any]
    """
    return times(a, transposed(b))


@compiled
def transposed_times(a: Block, b: Block) -> Block:
    """The product a^T b.

    Args:
        a: [any]
        b: [any]
    """
    return times(transposed(a), b)
