"""What ranges and bearings tell of a position and of a current: Fisher information along a mission.

A range to a target in direction l tells l l' / sigma^2 of where it is; a range at a time t before the
end, of a target that drifts with a current c, tells of (p, c) at the end what g = (l, -l t) does.  The
inverse of the sum is the least covariance that any unbiased estimator has (Cramer and Rao).
"""

import numpy as np


def range_information(bearings: np.ndarray, sigma: float) -> np.ndarray:
    """What ranges tell of a target that does not move.

    Args:
        bearings: (n,) [rad] of the line of sight, clockwise from north.
        sigma: [m] of each range.

    Returns:
        (2, 2) [1/m^2]

    Source: closed form HH (docs/theory/closed-forms.md): with n uniform bearings its inverse has trace 4 sigma^2 / n.
    """
    lines = np.stack([np.cos(bearings), np.sin(bearings)])
    return np.asarray(lines @ lines.T / sigma**2)


def usbl_information(bearing: float, distance: float, range_sigma: float, angle_sigma: float) -> np.ndarray:
    """What one reading by USBL, level with its target, tells of where that is.

    l l' / sigma_r^2 + n n' / (r sigma_a)^2,   n across l

    Args:
        bearing: [rad]
        distance: [m] r.
        range_sigma: [m]
        angle_sigma: [rad]

    Returns:
        (2, 2) [1/m^2]

    Source: closed form HH (docs/theory/closed-forms.md).
    """
    line = np.array([np.cos(bearing), np.sin(bearing)])
    aside = np.array([-line[1], line[0]])
    return np.asarray(np.outer(line, line) / range_sigma**2 + np.outer(aside, aside) / (distance * angle_sigma) ** 2)


def mission_information(
    times: np.ndarray, offsets: np.ndarray, sigma: float, prior: np.ndarray | None = None
) -> np.ndarray:
    """What ranges along a mission tell of position and current at its end.

    Args:
        times: (n,) [s] of the ranges.
        offsets: (n, 2) [m] target less source, north and east, at those times.
        sigma: [m] of each range.
        prior: (4, 4) information before the first of them; None: none.

    Returns:
        (4, 4) information of north, east [m] and current north, east [m/s].
    """
    distance = np.hypot(*offsets.T)
    lines = offsets / np.where(distance > 0.0, distance, 1.0)[:, None]
    before = (times - times[-1])[:, None]
    slopes = np.hstack([lines, before * lines]) / sigma
    told = slopes.T @ slopes
    return np.asarray(told if prior is None else told + prior)


def log_determinants_along(
    times: np.ndarray,
    offsets: np.ndarray,
    sigma: float,
    prior: np.ndarray,
    *,
    velocity_noise: float = 0.0,
    current_noise: float = 0.0,
    below: float = 0.0,
) -> np.ndarray:
    """How much is known of position and current after each range of a target whose velocity and current wander.

    log det of the inverse of P,   P' = F P F' + Q between ranges,   P^-1 + g g' / sigma^2 at each,   g = (h / r) (l, 0)

    h is the level and r the slant range: of a target below a range tells less of where it is in plan.

    Args:
        times: (n,) [s] of the ranges.
        offsets: (..., n, 2) [m] target less source in plan, of as many maneuvers as wanted.
        sigma: [m] of each slant range.
        prior: (4, 4) covariance of north, east [m] and current north, east [m/s] before the first.
        velocity_noise: [m^2/s] q_v, as `kalman_replay` has it.
        current_noise: [m^2/s^3] q_c.
        below: [m] how much deeper the target is than the source.

    Returns:
        (..., n) [-]

    Source: closed form HH (docs/theory/closed-forms.md); what is forgotten between the ranges is as in closed form V.
    """
    level = np.hypot(offsets[..., 0], offsets[..., 1])
    lines = offsets / np.maximum(np.hypot(level, below), 1e-9)[..., None]
    covariance = np.broadcast_to(prior, (*offsets.shape[:-2], 4, 4)).copy()
    known, unit = np.empty(offsets.shape[:-1]), np.eye(2)
    for k, step in enumerate(np.diff(times, prepend=times[0])):
        onward = np.block([[unit, step * unit], [0.0 * unit, unit]])
        noise = np.block(
            [
                [(velocity_noise * step + current_noise * step**3 / 3.0) * unit, 0.5 * current_noise * step**2 * unit],
                [0.5 * current_noise * step**2 * unit, current_noise * step * unit],
            ]
        )
        covariance = onward @ covariance @ onward.T + noise
        across = covariance[..., :2] @ lines[..., k, :, None]
        innovation = np.sum(lines[..., k, :] * across[..., :2, 0], axis=-1) + sigma**2
        covariance = covariance - across @ np.swapaxes(across, -1, -2) / innovation[..., None, None]
        known[..., k] = -np.linalg.slogdet(covariance)[1]
    return known


def condition_number(information: np.ndarray, duration: float) -> float:
    """How much better the best known direction is known than the worst, the current counted as the way of a mission.

    Args:
        information: (4, 4) as `mission_information` gives it.
        duration: [s] by which the current is multiplied, so that all four are meters.

    Returns:
        [-] 1 at best; infinite where something cannot be observed at all.
    """
    scale = np.array([1.0, 1.0, 1.0 / duration, 1.0 / duration])
    values = np.linalg.eigvalsh(information * np.outer(scale, scale))
    return float(values[-1] / values[0]) if values[0] > 1e-12 * values[-1] else float("inf")


def log_determinant(information: np.ndarray) -> float:
    """The logarithm [-] of its determinant: the larger, the less is not known; -inf where it is singular.

    Args:
        information: (n, n)
    """
    sign, value = np.linalg.slogdet(information)
    return float(value) if sign > 0.0 else float("-inf")
