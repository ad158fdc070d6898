"""Which depth to keep: a constant, a profile over time or along the path, or so much above the seabed."""

from cardume.compiler import compiled, load, where
from cardume.maths import clip, interpolate
from cardume.onboard.mind import (
    DEPTH_OVER,
    DEPTH_POINTS,
    HAS_PHASES,
    KEEPS_ALTITUDE,
    OVER_PATH,
    Mind,
    Sounding,
    depth_points,
    get_orders,
    get_progress,
    get_setup,
    get_sounding,
    put_sounding,
)
from cardume.onboard.phases import ABORT, HALF, SURFACE, takes_part
from cardume.paths.table import AHEAD
from cardume.signals import Measured, PathError

SMOOTHING = 1.0  # [s] time constant of the filter of the seabed's depth


@compiled
def choose_depth(mind: Mind, measured: Measured, error: PathError, time: float) -> float:
    """The depth to keep now [m], 0 when it is to come up.

    Args:
        mind: of the vehicle.
        measured: depth and altitude.
        error: where it is on its path.
        time: [s] since the start of the mission.
    """
    setup = get_setup(mind.own, 0)
    depth = setup.depth
    if load(mind.features, DEPTH_OVER) > 0:
        along = error.path_parameter + load(error.path, AHEAD)
        x = along if load(mind.features, DEPTH_OVER) == OVER_PATH else time + 0.0 * along
        depth = interpolate(depth_points(mind), load(mind.features, DEPTH_POINTS), x)
    if load(mind.features, KEEPS_ALTITUDE) > 0:
        depth = above_seabed(mind, measured, depth)
    rises = setup.surfaces * error.finished
    if load(mind.features, HAS_PHASES) > 0:
        depth = clip(depth, 0.0, get_orders(mind.orders, 0).depth_limit)
        rises = where(comes_up(mind), 1.0, 0.0)
        put_sounding(mind.own, 0, Sounding(get_sounding(mind.own, 0).seabed, depth))
    return depth * (1.0 - rises)


@compiled
def comes_up(mind: Mind) -> bool:
    """Whether the phase of the mission is one in which the vehicle comes up."""
    phase = get_progress(mind.own, 0).phase
    gives_up = (phase > ABORT - HALF) & (get_orders(mind.orders, 0).abort_surfaces > HALF)
    return ((phase > SURFACE - HALF) & takes_part(phase)) | gives_up


@compiled
def above_seabed(mind: Mind, measured: Measured, depth: float) -> float:
    """The depth that is so much above the seabed as is asked for: z_ref = b - h_ref,  b' = (z + h - b) / T.

    Without an echo it keeps the depth that it was to keep; before the first echo, that of the mission file.

    Args:
        mind: of the vehicle.
        measured: depth z and altitude h.
        depth: [m] before the first echo.

    Returns:
        The depth to keep [m].
    """
    before = get_sounding(mind.own, 0)
    echo = measured.depth + measured.altitude
    is_heard, was_heard = echo == echo, before.seabed == before.seabed
    share = mind.book.dt / (SMOOTHING + mind.book.dt)
    smoothed = where(was_heard, before.seabed + share * (echo - before.seabed), echo)
    seabed = where(is_heard, smoothed, before.seabed)
    wanted = clip(seabed - get_orders(mind.orders, 0).altitude, 0.0, 1e9)
    kept = where(is_heard, wanted, where(before.wanted == before.wanted, before.wanted, depth))
    put_sounding(mind.own, 0, Sounding(seabed, kept))
    return kept
