"""What a vehicle does at the end of its path, and never: see `end:` in the mission file."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cardume.onboard.agent import HOLD_RADIUS
from cardume.simulation.flight import Flight
from flying import fly_text

TEXT = """
cardume: 1
name: ending
duration: {duration} s
path: {path}
formation: {{speed: 0.5 m/s}}
current: {{type: uniform, speed: {current} m/s, towards: 100 deg}}
model: {model}
compensation: {{law: crab}}
current_observer: {{law: complementary}}
end: {end}
vehicles:
  - {{name: one, depth: 3 m, sensors: ideal, start: {{cross_track: 1 m, speed: 0.5 m/s}}}}
"""
LINE = "{type: line, start: {north: 2 m, east: -3 m, course: 40 deg}, length: 20.3 m}"
CURVED = (
    "{type: segments, start: {north: 0 m, east: 0 m, course: 0 deg},"
    " segments: [{line: 8 m}, {arc: 10 m, turn: port, angle: 80 deg}]}"
)
COURSE = math.radians(40.0)
END = np.array([2.0 + 20.3 * math.cos(COURSE), -3.0 + 20.3 * math.sin(COURSE)])


def fly(end: str, model: str = "kinematic", path: str = LINE, current: float = 0.1, duration: float = 200.0) -> Flight:
    flight = fly_text(TEXT.format(end=end, model=model, path=path, current=current, duration=duration))
    assert flight.reason == "completed"
    return flight


def distance(flight: Flight) -> np.ndarray:
    """(time,) [m] from the end of the line."""
    return np.hypot(flight.channels["north"][:, 0] - END[0], flight.channels["east"][:, 0] - END[1])


@pytest.mark.parametrize(("model", "away"), [("kinematic", 1.2), ("medusa", 2.5)])
@pytest.mark.parametrize("current", [0.0, 0.1])
@pytest.mark.parametrize("end", ["hold", "surface"])
def test_a_vehicle_stays_at_the_end(model: str, away: float, current: float, end: str) -> None:
    flight = fly(end, model, current=current)
    late = distance(flight)[60:]
    assert late.max() < away * HOLD_RADIUS
    depth = flight.channels["depth"][:, 0]
    assert depth[:35] == pytest.approx(3.0, abs=0.3)
    assert depth[120:] == pytest.approx(0.0 if end == "surface" else 3.0, abs=0.1)


def test_a_resting_vehicle_asks_for_no_speed_within_the_radius() -> None:
    flight = fly("hold", current=0.0)
    speed = flight.channels["speed_desired"][60:, 0]
    assert (distance(flight)[60:] < HOLD_RADIUS).all()
    assert speed == pytest.approx(0.0, abs=2e-3)  # what is left cancels the current that the observer still believes in


@pytest.mark.parametrize("model", ["kinematic", "medusa"])
def test_continue_follows_the_line_on(model: str) -> None:
    flight = fly("continue", model)
    assert flight.channels["cross_track"][100:, 0] == pytest.approx(0.0, abs=0.05)
    assert flight.channels["coordination_state"][-1, 0] == pytest.approx(100.0, abs=3.0)
    assert flight.channels["depth"][-1, 0] == pytest.approx(3.0, abs=0.1)


def test_continue_follows_the_last_arc_round_as_its_circle() -> None:
    flight = fly("continue", path=CURVED, current=0.0)
    assert flight.channels["curvature"][-1, 0] == pytest.approx(-0.1)
    assert flight.channels["cross_track"][80:, 0] == pytest.approx(0.0, abs=0.05)
    laps = (flight.channels["coordination_state"][-1, 0] - 8.0) / (2.0 * math.pi * 10.0)
    assert laps > 1.2  # gamma does not wrap
    radius = np.hypot(flight.channels["north"][80:, 0] - 8.0, flight.channels["east"][80:, 0] + 10.0)
    assert radius == pytest.approx(10.0, abs=0.05)


def test_a_circle_has_no_end() -> None:
    circle = "{type: circle, centre: {north: 0 m, east: 0 m}, radius: 5 m}"
    flight = fly("hold", path=circle, current=0.0)
    assert flight.channels["coordination_state"][-1, 0] == pytest.approx(0.5 * 200.0, rel=0.05)
    assert flight.metrics.vehicles["one"]["cross_track_max"] < 0.5


def test_a_vehicle_that_has_reached_the_end_does_not_take_up_the_path_again() -> None:
    """Drifting back before the end does not count as being on the path once more."""
    # against the path, and not compensated for: it drifts back while it rests
    astream = TEXT.replace("towards: 100 deg", "towards: 220 deg").replace("law: crab", "law: none")
    flight = fly_text(astream.format(end="hold", model="kinematic", path=LINE, current=0.1, duration=400.0))
    gamma = flight.channels["coordination_state"][:, 0]
    arrived = int(np.argmax(gamma > 20.2))
    assert arrived > 0
    assert gamma[arrived + 10 :].min() < 19.5
    assert distance(flight)[arrived:].max() < 1.3 * HOLD_RADIUS
    metrics = flight.metrics.vehicles["one"]
    shorter = fly_text(astream.format(end="hold", model="kinematic", path=LINE, current=0.1, duration=arrived + 5.0))
    assert metrics["cross_track_rms"] == shorter.metrics.vehicles["one"]["cross_track_rms"]


@pytest.mark.parametrize("gain", [0.3, 3.0])
def test_no_vehicle_is_ever_asked_to_go_astern(gain: float) -> None:
    """A correction larger than v_L stops a vehicle that is ahead; it does not turn it round."""
    text = TEXT.format(end="hold", model="kinematic", path=LINE, current=0.0, duration=60)
    text += "  - {name: two, sensors: ideal, offset: {starboard: 2 m}, start: {along_track: 12 m, speed: 0.5 m/s}}\n"
    flight = fly_text(text + f"coordination: {{law: laplacian_tanh, gain: {gain} m/s}}\n")
    asked = flight.channels["speed_desired"]
    assert asked.min() >= 0.0
    assert asked[1:4, 1].max() < (0.25 if gain == 0.3 else 0.002)
    gamma = flight.channels["coordination_state"]
    assert abs(gamma[30, 0] - gamma[30, 1]) < 6.0


@pytest.mark.parametrize("end", ["hold", "continue"])
def test_a_vehicle_that_starts_beyond_the_end(end: str) -> None:
    text = TEXT.replace("cross_track: 1 m", "along_track: 26 m")
    flight = fly_text(text.format(end=end, model="kinematic", path=LINE, current=0.0, duration=60))
    where = distance(flight)[-1]
    assert where < HOLD_RADIUS if end == "hold" else where == pytest.approx(36.0, abs=2.0)
