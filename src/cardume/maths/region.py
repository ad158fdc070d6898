"""How far inside a region a place is: a circle, or a polygon."""

from cardume.compiler import Rows, compiled, load, negate, where
from cardume.maths.elementary import clip, hypot, sqrt

FAR = 1e300  # [m^2]


@compiled
def inside_circle(radius: float, north: float, east: float) -> float:
    """R - rho: how far [m] a place at (north, east) [m] from the center is inside a circle of this radius [m]."""
    return radius - hypot(north, east)


@compiled
def inside_polygon(corners: Rows, count: int, north: float, east: float) -> float:
    """Distance [m] to the nearest edge, > 0 inside (an odd number of edges lies to the east), < 0 outside.

    Args:
        corners: [m] (2 * count,) north and east of each corner, in either sense.
        count: [-] corners, the same in all lanes, at least 3.
        north: [m] of the place.
        east: [m]
    """
    nearest = 0.0 * north + FAR
    inside = north != north
    for k in range(count):
        after = k + 1 if k + 1 < count else 0
        y1, x1 = load(corners, 2 * k) - north, load(corners, 2 * k + 1) - east
        y2, x2 = load(corners, 2 * after) - north, load(corners, 2 * after + 1) - east
        dy, dx = y2 - y1, x2 - x1
        squared = dy * dy + dx * dx
        share = clip(-(y1 * dy + x1 * dx) / where(squared > 0.0, squared, 1.0), 0.0, 1.0)
        y, x = y1 + share * dy, x1 + share * dx
        away = y * y + x * x
        nearest = where(away < nearest, away, nearest)
        spans = ((y1 > 0.0) & (y2 <= 0.0)) | ((y1 <= 0.0) & (y2 > 0.0))
        crossing = x1 - y1 * dx / where(dy != 0.0, dy, 1.0)
        crosses = spans & (crossing > 0.0)
        inside = (inside & negate(crosses)) | (negate(inside) & crosses)
    distance = sqrt(nearest)
    return where(inside, distance, -distance)
