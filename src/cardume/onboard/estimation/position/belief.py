"""What a Kalman filter believes of position, current and calibration; how that ages, and what a fix makes of it.

The state is p (position), c (current) and the calibration (s, b): through the water the vehicle makes
(1 + s) times the way that it measures, turned to starboard by b.  In between two moments it measured
the way d = (dn, de) through the water, and

    p' = p + d + G (s, b) + g c + w,   c' = phi c + w_c,   (s, b)' = (s, b) + w_a,
    G = [[dn, -de], [de, dn]],   phi = exp(-f T),   g = (1 - phi) / f  (T where f = 0)

which is linear in the state and holds for any T: nothing needs to be computed in between.  The variances
of the calibration grow by what they were at first in an hour; what that makes of the way inside one T is left out.
The covariance is kept as blocks of two by two.
"""

from typing import NamedTuple

from cardume.compiler import compiled, negate, some, where
from cardume.maths import exp, hypot
from cardume.maths.blocks import (
    UNIT,
    Block,
    Spread,
    inverted,
    plus,
    scaled,
    times,
    times_transposed,
    transposed,
    transposed_times,
)
from cardume.signals import Fix

CALIBRATION_HOLDS = 3600.0  # [s] in which the variances of the calibration grow by what they were at first
UNKNOWN = 1e6  # [m^2] variance of a position of which nothing is known
EXACT = 1e-6  # [m^2] no fix is better than a millimeter
NEAREST = 1e-3  # [m] a source nearer than this has no direction
NEARLY_NONE = 0.02  # of f T: below it the closed forms lose digits


class Moment(NamedTuple):
    """When a belief holds."""

    tick: float = 0.0  # [-]
    way_north: float = 0.0  # [m] measured through the water by then
    way_east: float = 0.0  # [m]
    rejected: float = 0.0  # [-] fixes in a row, by then, that were not believed


class Mean(NamedTuple):
    """The state."""

    north: float = 0.0  # [m]
    east: float = 0.0  # [m]
    current_north: float = 0.0  # [m/s]
    current_east: float = 0.0  # [m/s]
    scale: float = 0.0  # [-] s: true way through the water over measured one, less 1
    turn: float = 0.0  # [rad] b: true heading less measured one


class Covariance(NamedTuple):
    """Of the state, by blocks: position p, current c, calibration a; xy_ij is that of part i of x with part j of y."""

    pp_nn: float = 0.0  # [m^2]
    pp_ne: float = 0.0  # [m^2]
    pp_ee: float = 0.0  # [m^2]
    pc_nn: float = 0.0  # [m^2/s]
    pc_ne: float = 0.0  # [m^2/s]
    pc_en: float = 0.0  # [m^2/s]
    pc_ee: float = 0.0  # [m^2/s]
    cc_nn: float = 0.0  # [m^2/s^2]
    cc_ne: float = 0.0  # [m^2/s^2]
    cc_ee: float = 0.0  # [m^2/s^2]
    pa_nn: float = 0.0  # [m]
    pa_ne: float = 0.0  # [m]
    pa_en: float = 0.0  # [m]
    pa_ee: float = 0.0  # [m]
    ca_nn: float = 0.0  # [m/s]
    ca_ne: float = 0.0  # [m/s]
    ca_en: float = 0.0  # [m/s]
    ca_ee: float = 0.0  # [m/s]
    aa_nn: float = 0.0  # [-] of s
    aa_ne: float = 0.0  # [-]
    aa_ee: float = 0.0  # [-] of b


class Belief(NamedTuple):
    """State and covariance at one moment."""

    moment: Moment
    mean: Mean
    covariance: Covariance


class Blocks(NamedTuple):
    """A covariance as matrices."""

    pp: Block  # [m^2]
    pc: Block  # [m^2/s]
    cc: Block  # [m^2/s^2]
    pa: Block  # [m]
    ca: Block  # [m/s]
    aa: Block  # [-]


class Doubts(NamedTuple):
    """How uncertain a filter is at first, and how quickly it becomes so again."""

    position: float  # [m^2] variance at first, of north as of east
    current: float  # [m^2/s^2]
    scale: float  # [-]
    turn: float  # [rad^2]
    wander: float  # [m^2/s] density of white noise of the velocity
    change: float  # [m^2/s^3] density of white noise that drives the current
    fading: float  # [1/s] f, at which the current is forgotten
    fix: float  # [m^2] variance of a fix that does not tell its own
    gate: float  # [-] largest believable squared innovation over its variance
    patience: float  # [-] fixes in a row that are not believed, at least 1, before a position restarts the filter


class Innovation(NamedTuple):
    """How far a fix is from what was believed of it, and the inverse of the covariance of that."""

    north: float  # [m]
    east: float  # [m]
    weight: Block  # [1/m^2]


@compiled
def first_belief(north: float, east: float, doubts: Doubts) -> Belief:
    """What is believed before the first fix.

    Args:
        north: [m]
        east: [m]
        doubts: variances at first.
    """
    zero = 0.0 * north
    none = Block(zero, zero, zero, zero)
    blocks = Blocks(
        _diagonal(doubts.position + zero, doubts.position + zero),
        none,
        _diagonal(doubts.current + zero, doubts.current + zero),
        none,
        none,
        _diagonal(doubts.scale + zero, doubts.turn + zero),
    )
    return Belief(Moment(zero, zero, zero, zero), Mean(north, east, zero, zero, zero, zero), _joined(blocks))


@compiled
def _diagonal(first: float, second: float) -> Block:
    return Block(first, 0.0 * first, 0.0 * first, second)


@compiled
def _blocks(c: Covariance) -> Blocks:
    return Blocks(
        Block(c.pp_nn, c.pp_ne, c.pp_ne, c.pp_ee),
        Block(c.pc_nn, c.pc_ne, c.pc_en, c.pc_ee),
        Block(c.cc_nn, c.cc_ne, c.cc_ne, c.cc_ee),
        Block(c.pa_nn, c.pa_ne, c.pa_en, c.pa_ee),
        Block(c.ca_nn, c.ca_ne, c.ca_en, c.ca_ee),
        Block(c.aa_nn, c.aa_ne, c.aa_ne, c.aa_ee),
    )


@compiled
def _joined(b: Blocks) -> Covariance:
    return Covariance(
        *(b.pp.nn, b.pp.ne, b.pp.ee),
        *(b.pc.nn, b.pc.ne, b.pc.en, b.pc.ee),
        *(b.cc.nn, b.cc.ne, b.cc.ee),
        *(b.pa.nn, b.pa.ne, b.pa.en, b.pa.ee),
        *(b.ca.nn, b.ca.ne, b.ca.en, b.ca.ee),
        *(b.aa.nn, b.aa.ne, b.aa.ee),
    )


@compiled
def aged(belief: Belief, until: Moment, doubts: Doubts, dt: float) -> Belief:
    """The belief at a later moment without any fix in between.

    P' = F P F^T + Q; the noise adds, per axis, q_v T to the variance of the position, and where f = 0 also
    q_c (T^3 / 3, T^2 / 2, T) to the variances of position, of both, and of current.

    Args:
        belief: before.
        until: the moment; how many fixes were rejected is the belief's.
        doubts: densities of noise.
        dt: [s] one tick.
    """
    was, mean, before = belief.moment, belief.mean, _blocks(belief.covariance)
    time = (until.tick - was.tick) * dt
    north, east = until.way_north - was.way_north, until.way_east - was.way_east
    reach, kept, noise = _grown(time, doubts)
    way = Block(north, -east, east, north)
    to_current = plus(plus(before.pc, reach, before.cc), 1.0, times_transposed(way, before.ca))
    to_calibration = plus(plus(before.pa, reach, before.ca), 1.0, times(way, before.aa))
    pp = plus(plus(before.pp, reach, transposed(before.pc)), 1.0, times_transposed(way, before.pa))
    pp = plus(plus(pp, reach, to_current), 1.0, times_transposed(to_calibration, way))
    drift = time / CALIBRATION_HOLDS
    blocks = Blocks(
        plus(pp, noise.nn, UNIT),
        plus(scaled(kept, to_current), noise.ne, UNIT),
        plus(scaled(kept * kept, before.cc), noise.ee, UNIT),
        to_calibration,
        scaled(kept, before.ca),
        plus(before.aa, drift, Block(doubts.scale, 0.0, 0.0, doubts.turn)),
    )
    after = Mean(
        mean.north + north + north * mean.scale - east * mean.turn + reach * mean.current_north,
        mean.east + east + east * mean.scale + north * mean.turn + reach * mean.current_east,
        kept * mean.current_north,
        kept * mean.current_east,
        mean.scale,
        mean.turn,
    )
    return Belief(Moment(until.tick, until.way_north, until.way_east, was.rejected), after, _joined(blocks))


@compiled
def _grown(time: float, doubts: Doubts) -> tuple[float, float, Spread]:
    """g [s], phi [-], and what noise adds in a time T [s] to the variances of position, both, and current, per axis."""
    reach, kept, square = time, 0.0 * time + 1.0, time * time
    of_position = square * time / 3.0
    of_current = time
    if some(doubts.fading > 0.0):
        fades = doubts.fading > 0.0
        rate = where(fades, doubts.fading, 1.0)
        faded = rate * time
        decay = exp(-faded)
        closed = (1.0 - decay) / rate
        short = faded < NEARLY_NONE
        series = time * (1.0 - faded * (0.5 - faded * (1.0 / 6.0 - faded * (1.0 / 24.0 - faded / 120.0))))
        filled = where(short, series, closed)
        third = (time - filled - 0.5 * rate * filled * filled) / (rate * rate)
        as_series = of_position * (1.0 - faded * (0.75 - faded * (0.35 - faded * (0.125 - faded * 31.0 / 840.0))))
        reach, kept = where(fades, filled, reach), where(fades, decay, kept)
        of_position = where(fades, where(short, as_series, third), of_position)
        of_current = where(fades, filled * (1.0 - 0.5 * rate * filled), of_current)
    noise = Spread(
        doubts.wander * time + doubts.change * of_position,
        0.5 * doubts.change * reach * reach,
        doubts.change * of_current,
    )
    return reach, kept, noise


@compiled
def corrected(belief: Belief, fix: Fix, doubts: Doubts) -> Belief:
    """What a fix makes of the belief at the moment of its validity.

    y = z - p,   S = P_pp + R,   x' = x + K y,   P' = P - K S K^T,   K = P H^T S^-1;   of a range see `_ranged`

    A fix whose y^T S^-1 y exceeds gate (1 + k)^2, k the fixes before it in a row that were not believed either, is not
    believed.  After `patience` of them in a row the position is taken for unknown and the current for as uncertain as
    at first when the next position comes, and that is believed whatever it is.  A range alone never is: around its
    source it leaves all directions open, and no mean stands for a circle.

    Args:
        belief: at that moment.
        fix: a position or a level range, and its covariance.
        doubts: the gate, the patience, and the variance of a fix that does not tell its own.
    """
    was, mean, before = belief.moment, belief.mean, _blocks(belief.covariance)
    is_position = negate(fix.level_range == fix.level_range)
    lost = is_position & (was.rejected >= doubts.patience)
    pp = plus(before.pp, where(lost, UNKNOWN, 0.0), UNIT)
    cc = plus(before.cc, where(lost, doubts.current, 0.0), UNIT)
    seen = _seen(fix, mean, pp, doubts)
    north, east, inverse = seen.north, seen.east, seen.weight
    nis = north * (inverse.nn * north + inverse.ne * east) + east * (inverse.en * north + inverse.ee * east)
    wide = 1.0 + was.rejected
    believed = lost | (nis <= doubts.gate * wide * wide)
    k_p = times(pp, inverse)
    k_c, k_a = transposed_times(before.pc, inverse), transposed_times(before.pa, inverse)
    blocks = Blocks(
        plus(pp, -1.0, times(k_p, pp)),
        plus(before.pc, -1.0, times(k_p, before.pc)),
        plus(cc, -1.0, times(k_c, before.pc)),
        plus(before.pa, -1.0, times(k_p, before.pa)),
        plus(before.ca, -1.0, times(k_c, before.pa)),
        plus(before.aa, -1.0, times(k_a, before.pa)),
    )
    after = Mean(
        mean.north + k_p.nn * north + k_p.ne * east,
        mean.east + k_p.en * north + k_p.ee * east,
        mean.current_north + k_c.nn * north + k_c.ne * east,
        mean.current_east + k_c.en * north + k_c.ee * east,
        mean.scale + k_a.nn * north + k_a.ne * east,
        mean.turn + k_a.en * north + k_a.ee * east,
    )
    moment = Moment(was.tick, was.way_north, was.way_east, where(believed, 0.0, was.rejected + 1.0))
    return Belief(moment, where(believed, after, mean), where(believed, _joined(blocks), belief.covariance))


@compiled
def _seen(fix: Fix, mean: Mean, pp: Block, doubts: Doubts) -> Innovation:
    """How far a fix is from what was believed, and the inverse of the covariance of that."""
    noise = _noise_of(fix, doubts)
    place = Innovation(fix.north - mean.north, fix.east - mean.east, inverted(plus(pp, 1.0, noise)))
    is_range = fix.level_range == fix.level_range
    if some(is_range):
        ranged = _ranged(fix, mean, pp, noise)
        place = Innovation(
            where(is_range, ranged.north, place.north),
            where(is_range, ranged.east, place.east),
            where(is_range, ranged.weight, place.weight),
        )
    return place


@compiled
def _ranged(fix: Fix, mean: Mean, pp: Block, noise: Block) -> Innovation:
    """The same of a range: all of it lies along the line of sight l from its source, and so does its weight l l' / S.

    h(p) = |p - p_s| has the slope l = (p - p_s) / h, and at second order a mean m / (2 h) greater and a variance
    m^2 / (2 h^2) greater, m the variance of p across l.

    Source: the second-order extended Kalman filter, whose sums have one term here (derived).
    """
    north, east = mean.north - fix.north, mean.east - fix.east
    distance = hypot(north, east)
    is_apart = distance > NEAREST
    h = where(is_apart, distance, NEAREST)
    n, e = where(is_apart, north / h, 1.0), where(is_apart, east / h, 0.0)
    across = pp.nn * e * e - 2.0 * pp.ne * n * e + pp.ee * n * n
    more = 0.5 * across / h
    along = n * n * (pp.nn + noise.nn) + 2.0 * n * e * (pp.ne + noise.ne) + e * e * (pp.ee + noise.ee)
    error, weight = fix.level_range - distance - more, 1.0 / (along + 2.0 * more * more)
    return Innovation(error * n, error * e, Block(weight * n * n, weight * n * e, weight * n * e, weight * e * e))


@compiled
def _noise_of(fix: Fix, doubts: Doubts) -> Block:
    """R [m^2] of a fix: what it tells of itself, else what is thought of all."""
    told = fix.north_variance + fix.east_variance + fix.covariance
    tells = told == told
    nn, ee = where(tells, fix.north_variance, doubts.fix), where(tells, fix.east_variance, doubts.fix)
    ne = where(tells, fix.covariance, 0.0)
    return Block(nn + EXACT, ne, ne, ee + EXACT)
