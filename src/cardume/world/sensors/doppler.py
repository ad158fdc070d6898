"""What water track and bottom track have in common: errors of a Doppler log, pings that fail, the last good reading."""

from typing import NamedTuple

from cardume.compiler import compiled, negate, some, where
from cardume.maths import exp, sincos
from cardume.signals import NOTHING, DvlReading, Noise, Sampling

__all__ = ["LogErrors", "Ping", "disturbed", "heard"]


class Ping(NamedTuple):
    """Memory: the last good reading."""

    surge: float = 0.0  # [m/s]
    sway: float = 0.0  # [m/s]
    silent: float = 1e9  # [s] since then


class LogErrors(NamedTuple):
    """How a Doppler log errs."""

    sigma: float  # [m/s] white noise of each part
    scale: float  # [-]
    bias_surge: float  # [m/s]
    bias_sway: float  # [m/s]
    misalignment: float  # [rad] the instrument is turned to starboard by


@compiled
def disturbed(surge: float, sway: float, noise: Noise, errors: LogErrors) -> DvlReading:
    """A velocity in body axes, as a log says it.

    reading = scale R(-m) (u, v) + bias + sigma (n_1, n_2)

    Args:
        surge: [m/s] u, true.
        sway: [m/s] v, true.
        noise: a and b are n_1 and n_2.
        errors: of the log.

    Returns:
        The reading.
    """
    if some(errors.misalignment != 0.0):
        sine, cosine = sincos(errors.misalignment)
        surge, sway = cosine * surge + sine * sway, cosine * sway - sine * surge
    return DvlReading(
        errors.scale * surge + (errors.bias_surge + errors.sigma * noise.a),
        errors.scale * sway + (errors.bias_sway + errors.sigma * noise.b),
    )


@compiled
def heard(
    reading: DvlReading, in_range: bool, noise: Noise, sampling: Sampling, memory: Ping, invalid: float, hold: float
) -> tuple[DvlReading, Ping]:
    """The reading, or the last good one where a ping fails; nothing once that is too old.

    A ping fails where nothing is in range, and by chance: exp(-(n_3^2 + n_4^2) / 2), uniform in (0, 1), is below
    `invalid`.

    Args:
        reading: of this ping.
        in_range: whether there is an echo at all.
        noise: c and d are n_3 and n_4.
        sampling: time since the last ping.
        memory: the last good reading.
        invalid: [-] share of pings that fail by chance.
        hold: [s] how long a good reading is repeated.

    Returns:
        What the log says, and the next memory.
    """
    fails = invalid < 0.0  # never
    if some(invalid > 0.0):
        fails = exp(-0.5 * (noise.c * noise.c + noise.d * noise.d)) < invalid
    good = in_range & negate(fails)
    silent = where(good, 0.0, memory.silent + sampling.elapsed)
    kept = Ping(where(good, reading.surge, memory.surge), where(good, reading.sway, memory.sway), silent)
    is_old = silent > hold
    return DvlReading(where(is_old, NOTHING, kept.surge), where(is_old, NOTHING, kept.sway)), kept
