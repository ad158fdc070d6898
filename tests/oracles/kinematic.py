"""One kinematic vehicle with ideal sensors, flown through the engine at several ticks, for the limit of no tick."""

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from cardume.simulation.flight import Flight
from flying import fly_text, limit, series, value_at

TICKS = (0.1, 0.05, 0.025)
FINE = (0.02, 0.01, 0.005)  # where a law has a kink, whose phase within the tick is an error of second order
TOLERANCE = 1e-5

Quantity = Callable[[Flight], float]


@dataclass(frozen=True)
class Scene:
    """A mission of one vehicle; `path`, `guidance` and the rest are written as in a mission file.

    Attributes:
        path: section of the mission.
        guidance: section of the mission.
        start: where the vehicle starts, without its speed.
        duration: [s]
        speed: [m/s] of the formation, and of the vehicle when it starts.
        model: name or section.
        sensors: word or section, in which TICK stands for the tick.
        log_period: [s]; 0: every tick.
        extra: further sections, one a line.
    """

    path: str
    guidance: str
    start: str
    duration: float
    speed: float = 0.5
    model: str = "kinematic"
    sensors: str = "ideal"
    log_period: float = 1.0
    extra: str = ""

    def text(self, tick: float) -> str:
        """The mission file at one tick [s]."""
        period = self.log_period or tick
        return f"""
cardume: 1
name: oracle
duration: {round(self.duration + period, 6)!r}
tick: {tick!r}
plant_step: {tick!r}
log_period: {period!r}
path: {{{self.path}}}
formation: {{speed: {self.speed!r}}}
guidance: {{{self.guidance}}}
vehicles:
  - name: alone
    model: {self.model}
    sensors: {self.sensors.replace("TICK", repr(tick))}
    start: {{{self.start}, speed: {self.speed!r}}}
end: continue
{self.extra}
"""


@functools.lru_cache(maxsize=12)
def flown(scene: Scene, tick: float) -> Flight:
    """The flight at one tick [s]."""
    flight = fly_text(scene.text(tick))
    assert flight.reason == "completed", flight.failure
    return flight


def at(channel: str, time: float) -> Quantity:
    """The value of a channel at a time [s]."""
    return lambda flight: value_at(flight, channel, time)


def when(channel: str, level: float, after: float = 0.0) -> Quantity:
    """The time [s] at which a channel first comes to a level; smooth between ticks, as the solution is."""

    def time(flight: Flight) -> float:
        times, values = series(flight, channel)
        first = int(np.flatnonzero((np.diff(np.sign(values - level)) != 0.0) & (times[1:] > after))[0])
        curve = CubicSpline(times[max(0, first - 3) : first + 5], values[max(0, first - 3) : first + 5])
        return float(brentq(lambda t: curve(t) - level, times[first], times[first + 1], xtol=1e-13))

    return time


def at_time(channel: str, time: Quantity) -> Quantity:
    """The value of a channel at a time that differs from flight to flight."""

    def value(flight: Flight) -> float:
        times, values = series(flight, channel)
        first = max(0, int(np.searchsorted(times, time(flight))) - 4)
        return float(CubicSpline(times[first : first + 8], values[first : first + 8])(time(flight)))

    return value


def converged(scene: Scene, quantity: Quantity, ticks: Sequence[float] = TICKS) -> tuple[float, float]:
    """Limit of a quantity for no tick, and the order at which it is approached."""
    return limit(lambda tick: quantity(flown(scene, tick)), ticks)


def assert_converges(
    scene: Scene,
    quantity: Quantity,
    expected: float,
    ticks: Sequence[float] = TICKS,
    scale: float = 0.0,
    order: float = 1.0,
) -> None:
    """The error falls in proportion to the tick, and its limit is the closed form.

    Args:
        scene: what is flown.
        quantity: what is read from the flight.
        expected: [any] its closed form.
        ticks: [s] each half the one before.
        scale: [any] what the tolerance is relative to, where the quantity itself is nearly zero.
        order: [-] 2 for a quantity whose error is that of the tick squared.
    """
    value, found = converged(scene, quantity, ticks)
    error = abs(value - expected) / (scale or abs(expected))
    assert error < TOLERANCE, f"{value!r} instead of {expected!r}: {error:.1e} relative"
    assert found == pytest.approx(order, abs=0.1), f"order {found}"


def line(course: float = 0.5) -> str:
    """A line of a course [rad], which goes on beyond its end."""
    return f"type: line, start: {{north: 3, east: -2, course: {course!r}}}, length: 50"


def circle(radius: float, turn: str, bearing: float = 0.7) -> str:
    """A circle about north = east = 0."""
    return f"type: circle, centre: {{north: 0, east: 0}}, radius: {radius!r}, turn: {turn}, start_bearing: {bearing!r}"


def curve(curvature: float) -> str:
    """A line or a circle of a signed curvature [1/m]."""
    return circle(1.0 / abs(curvature), "starboard" if curvature > 0.0 else "port") if curvature else line()


def water(
    speed: float, towards: float, compensation: str = "none", observer: str = "", reference: str = "water"
) -> str:
    """Sections: a current [m/s, rad] that is known aboard unless an observer is given, and what is done about it."""
    known = f"{{law: 'aids:told', speed: {speed!r}, towards: {towards!r}}}"
    return (
        f"current: {{type: uniform, speed: {speed!r}, towards: {towards!r}}}\n"
        f"current_observer: {observer or known}\ncompensation: {compensation}\nspeed_reference: {reference}"
    )


def rho(radius: float, turn: str, channel: str = "cross_track") -> Callable[[float], Quantity]:
    """Distance to a circle's center [m] at a time [s]."""
    sigma = 1.0 if turn == "starboard" else -1.0
    return lambda time: lambda flight: radius - sigma * value_at(flight, channel, time)


def distance_from_origin(time: float) -> Quantity:
    """Distance to north = east = 0 [m] at a time [s]."""
    return lambda flight: math.hypot(value_at(flight, "north", time), value_at(flight, "east", time))


def time_within(radius: float) -> Quantity:
    """The time [s] at which a vehicle comes as near as that [m] to north = east = 0."""

    def time(flight: Flight) -> float:
        times, (north, east) = flight.times, (flight.channels[c][:, 0] for c in ("north", "east"))
        distances = np.hypot(north, east) - radius
        first = int(np.flatnonzero(distances < 0.0)[0]) - 1
        near = slice(max(0, first - 3), first + 5)
        curve = CubicSpline(times[near], distances[near])
        return float(brentq(curve, times[first], times[first + 1], xtol=1e-13))

    return time
