"""A recording of ranges through the bank of filters that finds its start and the errors of its ranges by itself.

`--position law=range_filter`; its parameters are the fields of `Doubt` in missions/ranging/range_filter.py.
"""

import math
from collections.abc import Iterator, Mapping

import numpy as np

from cardume.errors import InputError
from cardume.missions.ranging.range_filter import (
    CURRENT_EAST,
    CURRENT_NORTH,
    EAST,
    NORTH,
    RANGE_BIAS,
    RANGE_SCALE,
    Doubt,
    RangeFilter,
    known_start,
    unknown_start,
)
from cardume.missions.recordings.base import Recorded, Sighted
from cardume.missions.recordings.playing import Believed, Innovation
from cardume.signals import Fix, Motion
from cardume.units import nearest, parse_quantity, printable

LAW = "range_filter"
UNITS = {
    "position": "m",
    "current": "m/s",
    "turn": "rad",
    "range_bias": "m",
    "range": "m",
}  # of the parameters that have one which a mission file knows
USUAL = Doubt(position=0.5, turn=0.05, range_scale=0.1)  # as with the Plaza records


def doubt_of(parameters: Mapping[str, str]) -> Doubt:
    """What is thought of the errors of a recording.

    Args:
        parameters: names and texts.

    Raises:
        InputError: no such parameter, or a value that is none.
    """
    values = {}
    for name, text in parameters.items():
        if name not in Doubt._fields:
            hint = nearest(name, list(Doubt._fields)) or "."
            raise InputError(
                f"--position {LAW} has no parameter '{printable(name)}'{hint} Valid: {', '.join(Doubt._fields)}"
            )
        values[name] = parse_quantity(text, UNITS.get(name, ""))
        if not (math.isfinite(values[name]) and values[name] >= 0.0):
            raise InputError(f"--position {name}={printable(text)}: must be a number, 0 or more")
    return USUAL._replace(**values)


def play_ranges(
    recorded: Recorded, doubt: Doubt, tick: float, knows_start: bool
) -> tuple[Believed, list[Innovation], dict[str, float]]:
    """Play ranges and dead reckoning through the bank of filters.

    Args:
        recorded: the vehicle.
        doubt: of its errors.
        tick: [s] between steps of dead reckoning, where it has a compass.
        knows_start: whether the filter is told where, and how turned, it starts.

    Returns:
        What it believed at every step, its innovations, and scale [-] and bias [m] of the ranges in the end.

    Raises:
        InputError: there is no range, or no start where one is to be known.
    """
    ranges = [s for s in recorded.sighted if math.isfinite(s.range)]
    if not ranges:
        raise InputError(f"{printable(recorded.name)} has no ranges; --position law=kalman_replay takes positions")
    has_compass = not recorded.ways
    bank: RangeFilter | None = None
    if knows_start:
        if recorded.start is None or not (has_compass or math.isfinite(recorded.start_heading)):
            raise InputError(
                f"{printable(recorded.name)}: nothing says where it starts; give --start NORTH,EAST or --start unknown"
            )
        turn = 0.0 if has_compass else recorded.start_heading
        bank = known_start(*recorded.start, turn, doubt)
    heard, before, rows, innovations = 0, 0.0, [], list[Innovation]()
    for time, ahead, aside in _steps(recorded, tick):
        if bank is not None:
            bank.move(ahead, aside, time - before)
        before = time
        last = None
        while heard < len(ranges) and ranges[heard].heard <= time:
            last = ranges[heard]
            heard += 1
            if bank is None:
                bank = unknown_start(
                    _level(last, recorded), last.north, last.east, doubt, turns=1 if has_compass else 24
                )
            else:
                innovations.append(_hear(bank, last, recorded, time))
        told = (last.north, last.east, last.range) if last else (math.nan,) * 3
        rows.append((time, *_state(bank), *told))
    table = np.array(rows)
    truth = (
        recorded.truth.between(table[:, 0])[:, :2] if recorded.truth.is_there else np.full((len(table), 2), math.nan)
    )
    given = np.full((len(table), len(Fix._fields)), math.nan)
    given[:, [0, 1, -1]] = table[:, 8:]
    believed = Believed(
        recorded.name,
        table[:, 0],
        table[:, 1:3],
        table[:, 3:6],
        table[:, 6:8],
        np.full((len(table), len(Motion._fields)), math.nan),
        np.full((len(table), 5), math.nan),
        given,
        truth,
        np.full((len(table), 2), math.nan),
        recorded.depth.held(table[:, 0])[:, 0] if recorded.depth.is_there else np.full(len(table), math.nan),
    )
    mean = bank.mean if bank is not None else np.full(8, math.nan)
    return believed, innovations, {"range_scale": float(mean[RANGE_SCALE]), "range_bias": float(mean[RANGE_BIAS])}


def _steps(recorded: Recorded, tick: float) -> Iterator[tuple[float, float, float]]:
    """Time [s] at the end of each step, and the way made in it [m], in the axes of dead reckoning."""
    if recorded.ways:
        heading = 0.0
        for way in recorded.ways:
            middle = heading + 0.5 * way.turned
            heading += way.turned
            yield way.time, way.ahead * math.cos(middle), way.ahead * math.sin(middle)
        return
    times = tick * np.arange(1, max(1, math.ceil(recorded.last / tick)) + 1)
    starts = times - tick
    headings = recorded.attitude.held(starts)[:, 0] if recorded.attitude.is_there else np.zeros(len(times))
    surge, sway = (recorded.velocity.held(starts) if recorded.velocity.is_there else np.zeros((len(times), 2))).T
    north, east = surge * np.cos(headings) - sway * np.sin(headings), surge * np.sin(headings) + sway * np.cos(headings)
    yield from zip(times.tolist(), (tick * north).tolist(), (tick * east).tolist(), strict=True)


def _level(sighted: Sighted, recorded: Recorded) -> float:
    """The level part [m] of a range; of one between unknown depths all of it."""
    if math.isnan(sighted.depth) or not recorded.depth.is_there:
        return sighted.range
    below = float(recorded.depth.held(np.array([sighted.valid]))[0, 0]) - sighted.depth
    return math.sqrt(max(sighted.range**2 - below**2, 1e-4 * sighted.range**2))


def _hear(bank: RangeFilter, sighted: Sighted, recorded: Recorded, time: float) -> Innovation:
    measured = _level(sighted, recorded)
    mean, covariance, doubt = bank.mean, bank.covariance, bank.doubt
    apart = np.array([mean[NORTH] - sighted.north, mean[EAST] - sighted.east])
    distance, scale = max(float(np.hypot(*apart)), 0.01), 1.0 + mean[RANGE_SCALE]
    slope = np.zeros(len(mean))
    slope[[NORTH, EAST]], slope[RANGE_SCALE], slope[RANGE_BIAS] = scale * apart / distance, distance, 1.0
    error = measured - scale * distance - mean[RANGE_BIAS]
    square = error**2 / float(slope @ covariance @ slope + doubt.range**2)
    bank.hear(measured, sighted.north, sighted.east)
    return Innovation(time, abs(float(error)), square, 1.0, bool(square <= doubt.gate))


def _state(bank: RangeFilter | None) -> tuple[float, ...]:
    if bank is None:
        return (math.nan,) * 7
    mean, p = bank.mean, bank.covariance
    return (
        mean[NORTH],
        mean[EAST],
        p[NORTH, NORTH],
        p[NORTH, EAST],
        p[EAST, EAST],
        mean[CURRENT_NORTH],
        mean[CURRENT_EAST],
    )
