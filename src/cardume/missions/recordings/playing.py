"""Play what vehicles met through their own navigation, and hold what they believed against the truth."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from cardume.laws import COLUMNS, FAMILIES, WIDTH
from cardume.missions.recordings.meeting import Met
from cardume.signals import Fix, Motion, NavigationEstimate, Water
from cardume.simulation.fleet import Held
from cardume.simulation.replaying import PLAYED, READINGS, Before, navigate_through
from cardume.simulation.tables import make_tables

PART = 10_000  # ticks played at once
LEAST = 1e-12  # [m^2] a smaller variance is none
NINETY_FIVE = 3.8414588206941, 5.9914645471080  # [-] of chi-square with 1 and 2 degrees of freedom


class Believed(NamedTuple):
    """What one vehicle made of a recording, tick by tick."""

    name: str
    times: np.ndarray  # (tick,) [s]
    position: np.ndarray  # (tick, 2) [m] north, east
    covariance: np.ndarray  # (tick, 3) [m^2] of north, of both, of east; NaN: its law does not say
    current: np.ndarray  # (tick, 2) [m/s]
    motion: np.ndarray  # (tick, len(Motion)) as it believed to move through the water
    before: np.ndarray  # (tick, 5) position [m] and covariance [m^2] without the fix of the tick
    fixes: np.ndarray  # (tick, len(Fix)) what it was given; NaN: nothing
    truth: np.ndarray  # (tick, 2) [m]; NaN: not known
    true_current: np.ndarray  # (tick, 2) [m/s]; NaN: not known
    depth: np.ndarray  # (tick,) [m] as measured; NaN: not measured


class Score(NamedTuple):
    """How well a vehicle navigated; NaN where nothing is known."""

    fixes: float  # [-] that it was given, ranges among them
    believed: float  # [-] of them, those that changed what it believed
    position_error_rms: float  # [m] horizontal
    position_error_max: float  # [m]
    current_error_rms: float  # [m/s]
    anees: float  # [-] mean of e' P^-1 e / 2; 1: the covariance is that of the errors
    nis: float  # [-] mean of y' S^-1 y over its size; 1: the innovations are as large as the filter thinks
    inside_95: float  # [-] share of innovations within the bounds that 95 % are to be within
    innovation_rms: float  # [m] from where it expected a fix to that; of a range, along it


def play(met: Met) -> Believed:
    """Play what a vehicle met through its navigation.

    Args:
        met: what it met.
    """
    plan, ticks = met.plan, len(met.readings)
    for family in ("speed", "position", "current_observer"):
        plan.vehicles[met.vehicle].laws[family].law.handle()
    tables, place = make_tables(plan, with_laws=True), plan.order.index(met.vehicle)
    handles = tables.handles.reshape(len(plan.vehicles), len(FAMILIES), COLUMNS)
    kept = np.zeros(max(1, int(handles[place, FAMILIES.index("position"), WIDTH])))
    played = np.full((ticks, PLAYED.width), np.nan)
    for first in range(0, ticks, PART):
        last = min(first + PART, ticks)
        part, inboxes = played[first:last].reshape(-1), met.inboxes(first, last)
        inboxes = np.ascontiguousarray(inboxes).reshape(-1) if inboxes.size else np.zeros(1)
        readings = np.ascontiguousarray(met.readings[first:last]).reshape(-1)
        navigate_through(tables, place, first, readings, inboxes, kept, part)
        played[first:last] = part.reshape(-1, PLAYED.width)

    def of(record: Any) -> np.ndarray:
        start = PLAYED.offsets[record]
        found: np.ndarray = played[:, start : start + len(record._fields)]
        return found

    estimate = of(NavigationEstimate)
    return Believed(
        met.name,
        plan.tick * np.arange(ticks),
        estimate[:, :2],
        estimate[:, 4:7],
        of(Water),
        of(Motion),
        of(Before),
        of(Fix),
        met.truth,
        met.true_current,
        met.readings[:, READINGS.column(Held, "depth")],
    )


class Innovation(NamedTuple):
    """How far a fix is from where it was expected."""

    time: float  # [s] when it came
    apart: float  # [m]
    square: float  # [-] the square of that over its variance; NaN: not known
    size: float  # [-] 1 for a range, 2 for a position
    is_believed: bool


def innovations_of(believed: Believed, sigma: float = math.nan) -> list[Innovation]:
    """Of every fix that a vehicle was given, how far it is from what was believed when it was true, before it came.

    y = z - p,   S = P + R,   y' S^-1 y

    Args:
        believed: by one vehicle.
        sigma: [m] of a fix that does not tell its own, as its law thinks.
    """
    b = believed
    given = np.isfinite(b.fixes[:, 0]) & np.isfinite(b.fixes[:, 1])
    changed = np.any(np.nan_to_num(np.hstack([b.position, b.covariance]) - b.before) != 0.0, axis=1)
    return [
        Innovation(float(b.times[row]), *_innovation(b, int(row), sigma), bool(changed[row]))
        for row in np.flatnonzero(given)
    ]


def score(believed: Believed, innovations: Sequence[Innovation]) -> Score:
    """The numbers of a replay.

    Args:
        believed: by one vehicle.
        innovations: of its fixes.
    """
    b = believed
    away = np.hypot(*(b.position - b.truth).T)
    apart, square, size = np.array([i[1:4] for i in innovations], float).reshape(-1, 3).T
    is_told = np.isfinite(square)
    limits = np.where(size == 1.0, *NINETY_FIVE)
    return Score(
        float(len(innovations)),
        float(sum(i.is_believed for i in innovations)),
        _rms(away),
        float(np.nanmax(away)) if np.isfinite(away).any() else math.nan,
        _rms(np.hypot(*(b.current - b.true_current).T)),
        _mean(_squares(b.position - b.truth, b.covariance)) / 2.0,
        _mean(square / size),
        _mean((square <= limits)[is_told].astype(float)),
        _rms(apart),
    )


def _innovation(b: Believed, row: int, sigma: float) -> tuple[float, float, float]:
    """How far a fix is from where it was expected [m], the square of that over its variance, and its dimension."""
    fix = Fix(*b.fixes[row])
    expected = _expected(b, row, fix.age)
    spread = np.array([[expected[2], expected[3]], [expected[3], expected[4]]])
    noise = np.array([[fix.north_variance, fix.covariance], [fix.covariance, fix.east_variance]])
    apart = np.array([fix.north, fix.east]) - expected[:2]
    if not np.isfinite(noise).all():
        noise = sigma**2 * np.eye(2)
    whole = spread + noise
    if math.isfinite(fix.level_range):
        distance = max(float(np.hypot(*apart)), 1e-9)
        line = apart / distance
        across = float(np.nan_to_num(np.array([-line[1], line[0]]) @ spread @ [-line[1], line[0]]))
        more = 0.5 * across / distance  # a range is longer than that of the mean place, as in belief.py
        error, variance = fix.level_range - distance - more, float(line @ whole @ line) + 2.0 * more**2
        return abs(error), error**2 / variance if variance > LEAST else math.nan, 1.0
    is_known = np.isfinite(whole).all() and np.linalg.det(whole) > LEAST**2
    return float(np.hypot(*apart)), float(apart @ np.linalg.solve(whole, apart)) if is_known else math.nan, 2.0


def _expected(b: Believed, row: int, age: float) -> np.ndarray:
    """(5,) position and covariance as they were believed when a fix was valid, before it came."""
    dt = b.times[1] - b.times[0] if len(b.times) > 1 else 1.0
    then = row - max(0.0, age) / dt
    if then > row - 1e-6:
        now: np.ndarray = b.before[row]
        return now
    low = max(0, math.floor(then + 1e-6))
    share = min(max(then - low, 0.0), 1.0)
    after = np.concatenate([b.position[low], b.covariance[low]])
    found: np.ndarray = after + share * (b.before[low + 1] - after)
    return found


def _squares(errors: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """e' P^-1 e of each row; NaN where P is not known."""
    nn, ne, ee = covariance.T
    size = nn * ee - ne * ne
    north, east = errors.T
    with np.errstate(divide="ignore", invalid="ignore"):
        found: np.ndarray = (ee * north**2 - 2.0 * ne * north * east + nn * east**2) / size
    return np.where(size > LEAST**2, found, np.nan)


def _mean(values: np.ndarray) -> float:
    known = values[np.isfinite(values)]
    return float(known.mean()) if len(known) else math.nan


def _rms(values: np.ndarray) -> float:
    return math.sqrt(_mean(values**2))
