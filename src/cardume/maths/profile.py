"""A function given by points: linear between them, held before the first and after the last."""

from cardume.compiler import Rows, compiled, gather, some, where
from cardume.maths.elementary import clip

MOST_POINTS = 1024  # of a profile: what the search covers


@compiled
def interpolate(points: Rows, count: int, x: float) -> float:
    """y(x), linear between the points: y_i + (y_i+1 - y_i) (x - x_i) / (x_i+1 - x_i).

    Args:
        points: [any] (2 * count,) x_0, y_0, x_1, y_1, ..., the x increasing.
        count: [-] points, the same in all lanes, at least 1.
        x: [any] where.

    Returns:
        y there [any].
    """
    left = 0.0 * x
    stride = 0.5 * MOST_POINTS
    for _ in range(10):
        probe = left + stride
        if some(probe < count - 1.0):
            inside = probe < count - 1.0
            left = where(inside & (gather(points, 2.0 * where(inside, probe, left)) <= x), probe, left)
        stride = 0.5 * stride
    right = where(left < count - 1.0, left + 1.0, left)
    low, high = gather(points, 2.0 * left), gather(points, 2.0 * right)
    width = where(high > low, high - low, 1.0)
    share = clip((x - low) / width, 0.0, 1.0)
    first, second = gather(points, 2.0 * left + 1.0), gather(points, 2.0 * right + 1.0)
    return where(share < 1.0, first + (second - first) * share, second)
