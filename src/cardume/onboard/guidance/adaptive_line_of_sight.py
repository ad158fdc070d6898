"""Adaptive line of sight: the crab angle is estimated from the cross-track error, within bounds."""

from typing import Annotated, NamedTuple

from cardume.compiler import where
from cardume.laws import Bounds, Meters, NotNegative, Positive, Radians, Seconds, Unit
from cardume.maths import HALF_PI, atan2, clip, sqrt
from cardume.onboard.guidance.base import guidance_law
from cardume.signals import PathError

AdaptationGain = Annotated[float, Unit("1/(m s)")]
MARGIN = 0.01  # [rad] in which the projection lets the estimate run out


class CrabEstimate(NamedTuple):
    """What the law remembers."""

    angle: float = 0.0  # [rad]


@guidance_law
def adaptive_line_of_sight(
    error: PathError,
    memory: CrabEstimate,
    dt: Seconds,
    lookahead: Positive[Meters] = 5.0,
    adaptation_gain: NotNegative[AdaptationGain] = 0.005,
    crab_max: Annotated[Radians, Bounds(0.0, HALF_PI, high_open=True)] = 0.7,
) -> tuple[Radians, CrabEstimate]:
    """Line-of-sight steering that learns the crab angle which the drift asks for.

    chi_d = chi_p - b - atan(e / d),   b' = g d / sqrt(d^2 + e^2) Proj(b, e)
    Proj(b, e) = e, but (1 - min(1, (b^2 - M^2) / ((M + m)^2 - M^2))) e  where |b| > M and b e > 0

    In a current V across a line b settles at asin(V / u), and e at 0; about that point it is critically
    damped for g = u / (4 d^2) where V is small. The projection keeps |b| below M + m, m = 0.01 rad, also
    where no angle would do.

    Args:
        error: path error; e = cross_track > 0 to starboard, chi_p = path_course.
        memory: b [rad].
        dt: [s] tick.
        lookahead: [m] d > 0, how far ahead on the tangent it looks.
        adaptation_gain: [1/(m s)] g; 0 gives plain line of sight.
        crab_max: [rad] M, the largest crab angle that is learnt, either way.

    Returns:
        Desired course [rad], NED, and the next memory.

    Source: MSS `GNC/ALOSpsi.m` (psi_ref and beta_hat), which gives Fossen, IEEE TCST 31(6), 2023, as its own,
    and `GNC/ALOS3D.m` (proj), after Fossen & Aguiar, Automatica 163, 2024; neither paper was opened. MSS
    computes its c as (M_hat^2 - M^2) / (M_hat^2 - M^2) = 1, a hard stop at M; here it is the usual smooth one.
    """
    e, b = error.cross_track, memory.angle
    outer = crab_max + MARGIN
    beyond = clip((b * b - crab_max * crab_max) / (outer * outer - crab_max * crab_max), 0.0, 1.0)
    held = (abs(b) > crab_max) & (b * e > 0.0)
    rate = adaptation_gain * lookahead * where(held, (1.0 - beyond) * e, e) / sqrt(lookahead * lookahead + e * e)
    course = error.path_course - b + atan2(-e, lookahead)
    return course, CrabEstimate(clip(b + dt * rate, -outer, outer))
