"""Integral line of sight: an integral of the error finds the drift that plain line of sight leaves."""

from typing import NamedTuple

from cardume.laws import Meters, MetersPerSecond, NotNegative, Positive, Radians, Seconds
from cardume.maths import atan2
from cardume.onboard.guidance.base import guidance_law
from cardume.signals import PathError


class CrossTrackIntegral(NamedTuple):
    """What the law remembers."""

    sum: float = 0.0  # [s] z


@guidance_law
def integral_line_of_sight(
    error: PathError,
    memory: CrossTrackIntegral,
    dt: Seconds,
    lookahead: Positive[Meters] = 5.0,
    integral_gain: NotNegative[MetersPerSecond] = 0.05,
) -> tuple[Radians, CrossTrackIntegral]:
    """Line-of-sight steering with integral action against a constant drift.

    chi_d = chi_p - atan((e + k z) / d),   z' = d e / (d^2 + (e + k z)^2)

    The integral grows the less the larger the error, so that a long approach does not wind it up. In a
    current V across a line it settles at z = d tan(asin(V / u)) / k, and e at 0; about that point it has
    poles of s^2 + (u / d) s + k u / d^2 where V is small, critical for k = u / 4. It needs no estimate of the
    current; beside `crab` it finds what that leaves.

    Args:
        error: path error; e = cross_track > 0 to starboard, chi_p = path_course.
        memory: z [s].
        dt: [s] tick.
        lookahead: [m] d > 0, how far ahead on the tangent it looks.
        integral_gain: [m/s] k; 0 gives plain line of sight.

    Returns:
        Desired course [rad], NED, and the next memory.

    Source: MSS `GNC/ILOSpsi.m` (psi_ref and y_int), which gives Borhaug, Pavlov & Pettersen, CDC 2008, as
    its own; that paper was not opened. Of Caharija et al. 2016 only the abstract was.
    """
    aim = error.cross_track + integral_gain * memory.sum
    rate = lookahead * error.cross_track / (lookahead * lookahead + aim * aim)
    return error.path_course + atan2(-aim, lookahead), CrossTrackIntegral(memory.sum + dt * rate)
