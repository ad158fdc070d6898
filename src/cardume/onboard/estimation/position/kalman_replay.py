"""Kalman filter that puts every fix where it belongs in time."""

from typing import Annotated, NamedTuple

import numpy as np

from cardume.compiler import Rows, some, where
from cardume.laws import (
    Bounds,
    Length,
    Meters,
    MetersPerSecond,
    NotNegative,
    Number,
    PerSecond,
    Positive,
    Radians,
    Seconds,
    Unit,
)
from cardume.maths import to_ned
from cardume.maths.history import push, recall
from cardume.onboard.estimation.position.base import position_law
from cardume.onboard.estimation.position.belief import Doubts, Moment, aged
from cardume.onboard.estimation.position.dead_reckoning import swaying, way_through_water
from cardume.onboard.estimation.position.past_fixes import FIXES_WIDTH, begin, get_belief, take
from cardume.signals import Fix, Motion, NavigationEstimate

REMEMBERED = 256  # ticks; an older fix is left out
AtLeastOne = Annotated[float, Unit(""), Bounds(1.0)]


class Replayed(NamedTuple):
    """The way through the water, its recent past, and the last fixes with what was believed after each."""

    north: float = 0.0  # [m] where the vehicle believes it starts
    east: float = 0.0  # [m]
    tick: float = 0.0  # [-]
    way_north: float = 0.0  # [m] measured through the water so far
    way_east: float = 0.0  # [m]
    norths: Annotated[Rows, Length(REMEMBERED)] = np.zeros(REMEMBERED)
    easts: Annotated[Rows, Length(REMEMBERED)] = np.zeros(REMEMBERED)
    fixes: Annotated[Rows, Length(FIXES_WIDTH)] = np.zeros(FIXES_WIDTH)


@position_law
def kalman_replay(
    fix: Fix,
    motion: Motion,
    memory: Replayed,
    dt: Seconds,
    velocity_noise: NotNegative[Annotated[float, Unit("m^2/s")]] = 3e-3,
    current_noise: NotNegative[Annotated[float, Unit("m^2/s^3")]] = 1e-6,
    current_fading: NotNegative[PerSecond] = 0.0,
    initial_sigma: NotNegative[Meters] = 10.0,
    current_sigma: NotNegative[MetersPerSecond] = 0.3,
    scale_sigma: NotNegative[Number] = 0.0,
    heading_sigma: NotNegative[Radians] = 0.0,
    sway_time: NotNegative[Seconds] = 0.0,
    fix_sigma: Positive[Meters] = 1.0,
    gate: Positive[Number] = 16.0,
    patience: AtLeastOne = 5.0,
) -> tuple[NavigationEstimate, Replayed]:
    """Kalman filter of position, current and calibration that works a late fix in at the time of its validity.

    p' = (1 + s) R(b) V_m + c + white(q_v),   c' = -f c + white(q_c),   z(t - age) = p(t - age) + noise(R)

    V_m = R(psi) (u, v) is the velocity through the water as measured, s and b its scale and heading errors, which
    are constant but for a drift by their first variance in an hour.  What is believed after each of the last 8
    fixes is kept; a new one is put among them by its time of validity, and all later ones are worked in again, so
    that neither delay nor order changes the result.  Between fixes the state, and its covariance, is a closed form
    of the time and of the way through the water since the last one.  A fix whose squared innovation over its
    variance exceeds gate (1 + k)^2, after k that were not believed either, is not believed; after `patience` of
    them in a row the filter starts again at the next one that is a position.

    Args:
        fix: position or level range [m], age [s] (a negative one, of a time that was rounded, is 0) and covariance
            [m^2]; NaN when there is none in this tick.
        motion: measured velocity through the water, for the step to the next tick; its current is not used.
        memory: the way through the water, and the last fixes.
        dt: [s] tick.
        velocity_noise: [m^2/s] q_v, density of white noise of the velocity: it adds q_v T to the variance in a time T.
        current_noise: [m^2/s^3] q_c, density of white noise that drives the current; 2 f sigma^2 keeps it at sigma.
        current_fading: [1/s] f, one over the time in which the current is forgotten; 0: a random walk.
        initial_sigma: [m] of the initial estimate, per axis.
        current_sigma: [m/s] of the current at first, per axis.
        scale_sigma: [-] of the scale error s at first; 0: the speed is taken as measured.
        heading_sigma: [rad] of the heading error b at first; 0: the heading is taken as measured.
        sway_time: [s] k of a hull that sways by v = -k u r in a turn, taken for its sway where none is measured; (mass
            and added mass in surge) over the linear drag in sway, 0.9 s for MEDUSA.
        fix_sigma: [m] of a fix that does not tell its own covariance, per axis.
        gate: [-] largest believable squared innovation over its variance; 16 is exceeded by 0.03 % of good fixes.
        patience: [-] how many fixes in a row are not believed before the filter starts again at a position; at least 1.

    Returns:
        The position [m] with its covariance [m^2], the current [m/s] that makes the measured velocity through the water
        that over ground, c + ((1 + s) R(b) - 1) V_m and the sway that was not measured; and the next memory.

    Source: Larsen, Andersen, Ravn & Poulsen (1998), the recalculation that their methods approximate; closed
    form II (docs/theory/closed-forms.md).
    """
    doubts = Doubts(
        initial_sigma * initial_sigma,
        current_sigma * current_sigma,
        scale_sigma * scale_sigma,
        heading_sigma * heading_sigma,
        velocity_noise,
        current_noise,
        current_fading,
        fix_sigma * fix_sigma,
        gate,
        patience,
    )
    push(memory.norths, REMEMBERED, memory.tick, memory.way_north)
    push(memory.easts, REMEMBERED, memory.tick, memory.way_east)
    is_first = memory.tick < 0.5
    if some(is_first):
        begin(memory.fixes, memory.north, memory.east, is_first, doubts)
    has_fix = (fix.north == fix.north) & (fix.east == fix.east)
    if some(has_fix):
        age = where(fix.age < 0.0, 0.0, fix.age)
        old = where(has_fix, age, 0.0) / dt
        is_known = has_fix & (old <= memory.tick) & (old <= REMEMBERED - 1.0)
        then = memory.tick - where(is_known, old, 0.0)
        north, east = recall(memory.norths, REMEMBERED, then), recall(memory.easts, REMEMBERED, then)
        take(memory.fixes, fix, Moment(then, north, east, 0.0 * then), is_known, doubts, dt)
    moved, drift_north, drift_east = motion, 0.0 * motion.north, 0.0 * motion.east
    if some(sway_time > 0.0):
        sway = where(motion.sway == 0.0, -sway_time * motion.surge * motion.yaw_rate, 0.0)
        moved = swaying(motion, sway)
        drift_north, drift_east = to_ned(motion.heading, 0.0 * sway, sway)
    now = Moment(memory.tick, memory.way_north, memory.way_east, 0.0 * memory.tick)
    believed = aged(get_belief(memory.fixes, 0), now, doubts, dt)
    mean, covariance = believed.mean, believed.covariance
    estimate = NavigationEstimate(
        mean.north,
        mean.east,
        mean.current_north + mean.scale * motion.north - mean.turn * motion.east + drift_north,
        mean.current_east + mean.scale * motion.east + mean.turn * motion.north + drift_east,
        covariance.pp_nn,
        covariance.pp_ne,
        covariance.pp_ee,
    )
    ahead, aside = way_through_water(moved, dt)
    after = Replayed(
        memory.north,
        memory.east,
        memory.tick + 1.0,
        memory.way_north + ahead,
        memory.way_east + aside,
        memory.norths,
        memory.easts,
        memory.fixes,
    )
    return estimate, after
