"""Rotations between NED, body and path frames, and the spherical coordinates of a sonar head.

NED is north, east, down; a heading or course is clockwise from north seen from above.  Body axes are forward,
starboard, down.  The path frame lies in the horizontal plane: along the path, and across it to starboard.
"""

from cardume.compiler import compiled
from cardume.maths.elementary import hypot, sqrt
from cardume.maths.trigonometry import atan2, sincos

__all__ = ["to_body", "to_body_3d", "to_cartesian", "to_ned", "to_ned_3d", "to_path", "to_spherical"]


@compiled
def to_ned(heading: float, surge: float, sway: float) -> tuple[float, float]:
    """Turn a horizontal vector from body (or path) axes to north and east.

    north = cos(heading) surge - sin(heading) sway,   east = sin(heading) surge + cos(heading) sway

    Args:
        heading: [rad] of the axes that the vector is given in; a course for the path frame.
        surge: [any] forward part.
        sway: [any] part to starboard.

    Returns:
        (north, east) in the unit of the vector.
    """
    s, c = sincos(heading)
    return c * surge - s * sway, s * surge + c * sway


@compiled
def to_body(heading: float, north: float, east: float) -> tuple[float, float]:
    """Turn a horizontal vector from north and east to body axes; the inverse of `to_ned`.

    Args:
        heading: [rad]
        north: [any] part towards north.
        east: [any] part towards east.

    Returns:
        (forward, starboard) in the unit of the vector.
    """
    s, c = sincos(heading)
    return c * north + s * east, c * east - s * north


@compiled
def to_path(path_course: float, north: float, east: float) -> tuple[float, float]:
    """Turn a horizontal offset from a point of the path into the path frame.

    Args:
        path_course: [rad] course of the path there.
        north: [m] vehicle minus point.
        east: [m] vehicle minus point.

    Returns:
        (along, across) [m]: along > 0 ahead of the point, across > 0 to starboard of the path.
    """
    return to_body(path_course, north, east)


@compiled
def to_ned_3d(
    roll: float, pitch: float, heading: float, forward: float, starboard: float, down: float
) -> tuple[float, float, float]:
    """Turn a vector from body axes to NED: v_ned = R_ned_body v_body.

    R_ned_body = R_z(heading) R_y(pitch) R_x(roll)

    Args:
        roll: [rad] > 0: starboard side down.
        pitch: [rad] > 0: bow up.
        heading: [rad]
        forward: [any] part along the bow.
        starboard: [any] part to starboard.
        down: [any] part towards the keel.

    Returns:
        (north, east, down) in the unit of the vector.

    Source: the zyx convention of Fossen, as in MSS `Rzyx.m`.
    """
    s_roll, c_roll = sincos(roll)
    s_pitch, c_pitch = sincos(pitch)
    s_heading, c_heading = sincos(heading)
    across, below = c_roll * starboard - s_roll * down, s_roll * starboard + c_roll * down
    ahead, depth = c_pitch * forward + s_pitch * below, c_pitch * below - s_pitch * forward
    return c_heading * ahead - s_heading * across, s_heading * ahead + c_heading * across, depth


@compiled
def to_body_3d(
    roll: float, pitch: float, heading: float, north: float, east: float, down: float
) -> tuple[float, float, float]:
    """Turn a vector from NED to body axes: v_body = R_ned_body^T v_ned; the inverse of `to_ned_3d`.

    Args:
        roll: [rad] > 0: starboard side down.
        pitch: [rad] > 0: bow up.
        heading: [rad]
        north: [any] part towards north.
        east: [any] part towards east.
        down: [any] part downwards.

    Returns:
        (forward, starboard, down) in the unit of the vector.

    Source: the zyx convention of Fossen, as in MSS `Rzyx.m`.
    """
    s_roll, c_roll = sincos(roll)
    s_pitch, c_pitch = sincos(pitch)
    s_heading, c_heading = sincos(heading)
    ahead, across = c_heading * north + s_heading * east, c_heading * east - s_heading * north
    forward, below = c_pitch * ahead - s_pitch * down, s_pitch * ahead + c_pitch * down
    return forward, c_roll * across + s_roll * below, c_roll * below - s_roll * across


@compiled
def to_spherical(forward: float, starboard: float, down: float) -> tuple[float, float, float]:
    """Range and two angles of a point given in body axes.

    azimuth = atan2(starboard, forward),   elevation = atan2(down, sqrt(forward^2 + starboard^2))

    Args:
        forward: [m]
        starboard: [m]
        down: [m]

    Returns:
        (range [m], azimuth [rad], elevation [rad]).  Azimuth is from the bow, > 0 to starboard, in [-pi, pi] and 0
        straight above or below.  Elevation is from the horizontal plane of the body, > 0 DOWN, in [-pi/2, pi/2].
    """
    level = hypot(forward, starboard)
    return sqrt(level * level + down * down), atan2(starboard, forward), atan2(down, level)


@compiled
def to_cartesian(distance: float, azimuth: float, elevation: float) -> tuple[float, float, float]:
    """The point in body axes that a range and two angles name; the inverse of `to_spherical`.

    Args:
        distance: [m] range, >= 0.
        azimuth: [rad] from the bow, > 0 to starboard.
        elevation: [rad] from the horizontal plane of the body, > 0 DOWN.

    Returns:
        (forward, starboard, down) [m].
    """
    s_azimuth, c_azimuth = sincos(azimuth)
    s_elevation, c_elevation = sincos(elevation)
    level = distance * c_elevation
    return level * c_azimuth, level * s_azimuth, distance * s_elevation
