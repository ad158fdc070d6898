"""Missions for tests: written as text, flown through the real engine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from cardume.missions.available import catalog
from cardume.missions.flying import fly_mission
from cardume.missions.loading import parse_mission
from cardume.simulation.flight import Flight

LAWS = Path(__file__).parent / "laws"  # laws of the tests' own, such as printed and wrong ones


def fly_text(text: str, overrides: Sequence[str] = ()) -> Flight:
    """Fly the mission in a text; laws written as `module:function` come from tests/laws."""
    return fly_mission(parse_mission(text, catalog([LAWS]), overrides), allow_code=[LAWS])


def series(flight: Flight, channel: str, vehicle: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] and values of one channel of one vehicle."""
    return flight.times, flight.channels[channel][:, vehicle]


def value_at(flight: Flight, channel: str, time: float, vehicle: int = 0) -> float:
    """The logged value at a time that the log holds."""
    times, values = series(flight, channel, vehicle)
    place = int(np.argmin(abs(times - time)))
    assert abs(times[place] - time) < 1e-9, f"the log has no record at {time} s"
    return float(values[place])


def limit(value: Callable[[float], float], ticks: Sequence[float] = (0.1, 0.05, 0.025)) -> tuple[float, float]:
    """Value of a quantity for a tick that goes to zero, and the order at which it converges.

    The engine holds commands over a tick: v(h) = v0 + a h + b h^2 + ...; three ticks, each half the one
    before, give v0 to third order (Richardson).
    """
    coarse, middle, fine = (value(tick) for tick in ticks)
    first, second = 2.0 * middle - coarse, 2.0 * fine - middle
    order = float(np.log2(abs((coarse - middle) / (middle - fine)))) if middle != fine else np.inf
    return (4.0 * second - first) / 3.0, order
