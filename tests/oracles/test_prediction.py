"""How fast a coordination state grows, (53), and how far its prediction (55) holds."""

import math

import numpy as np
import pytest

from flying import fly_text, limit
from oracles.aboard import uniform

MISSION = """
cardume: 1
name: prediction
duration: {duration!r} s
tick: {tick!r} s
log_period: {log_period!r} s
path: {path}
formation: {{speed: {speed!r} m/s}}
current: {current}
model: kinematic
sensors: ideal
vehicles:
{vehicles}
guidance: {{law: line_of_sight, lookahead: 5 m}}
end: continue
position: {{law: direct}}
current_observer: {observer}
compensation: {{law: crab}}
speed_reference: {over}
coordination: {coordination}
neighbors: {{law: {neighbors}}}
messaging: {{schedule: periodic, period: {message_period!r} s}}
acoustics: {{channel: ideal}}
"""
OBSERVER = "{law: complementary, k1: 1, k2: 0.25}"
LINE = "{type: line, start: {course: 40 deg}, length: 50 m}"


def fly(starts, speed, tick, until, **choices):
    """A fleet; `starts` are texts of the vehicles' start and offset."""
    names = (f"  - {{name: v{k}, {start}}}" for k, start in enumerate(starts))
    defaults = {
        "path": LINE,
        "current": "none",
        "observer": OBSERVER,
        "over": "ground",
        "coordination": "none",
        "neighbors": "coordinated",
        "log_period": tick,
        "message_period": tick,
    }
    numbers = {"duration": until + tick, "tick": tick, "speed": speed, "vehicles": "\n".join(names)}
    return fly_text(MISSION.format(**{**defaults, **numbers, **choices}))


def slope_after_a_message(speed, current, neighbors, over="water"):
    """(true rate, rate of the prediction) of a neighbor's state between two messages, long after all has settled."""
    course = math.radians(40.0)
    north = current[0] * math.cos(course) - current[1] * math.sin(course)
    east = current[0] * math.sin(course) + current[1] * math.cos(course)
    start = f"start: {{along_track: 0 m, speed: {speed!r}}}"
    flight = fly(
        [start, start],
        speed,
        0.1,
        350.0,
        current=uniform(north, east),
        over=over,
        neighbors=neighbors,
        log_period=10.0,
        message_period=100.0,
    )
    true, predicted = flight.channels["coordination_state"][:, 1], flight.neighbor_state_estimate[:, 0, 1]
    # The message of 300 s is heard at 300.1 s.
    return (true[35] - true[31]) / 40.0, (predicted[35] - predicted[31]) / 40.0


def progress(speed, along, across):
    """(53) corrected, on a line: sqrt(u^2 - Vperp^2) + Vpar."""
    return math.sqrt(speed * speed - across * across) + along


def test_printed_rate_at_the_printed_numbers():
    """Errata of (53): u = .5, Vpar = .1, Vperp = .15: .57696960 m/s, 15.39 % more than printed."""
    printed = "'printed_prediction:through_the_water', speed: 0.5"
    true, predicted = slope_after_a_message(0.5, (0.1, 0.15), printed)
    assert true == pytest.approx(0.57696960, abs=5e-9)
    assert predicted == pytest.approx(0.5, abs=1e-9)
    assert 100.0 * (true - predicted) / predicted == pytest.approx(15.39, abs=5e-3)
    # `coordinated` assumes a path speed over ground, and is as wrong as the printed one where it is not.
    assert slope_after_a_message(0.5, (0.1, 0.15), "coordinated")[1] == pytest.approx(0.5, abs=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_corrected_rate_at_random(seed):
    """Errata of (53): the true rate by the formula; the reported one predicts it, and over ground v_L does."""
    draw = np.random.default_rng(seed)
    speed = draw.uniform(0.4, 1.0)
    current = speed * draw.uniform(-0.4, 0.4, 2)
    true, predicted = slope_after_a_message(speed, current, "reported_speed")
    assert true == pytest.approx(progress(speed, *current), rel=1e-9)
    assert predicted == pytest.approx(true, rel=1e-9)
    true, predicted = slope_after_a_message(speed, current, "reported_speed", over="ground")
    assert true == pytest.approx(speed, rel=1e-9)
    assert predicted == pytest.approx(speed, rel=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_rate_beside_an_offset_arc_in_a_current(seed):
    """Errata of (53): gamma' = V . t / ((1 - c e) h): the true rate, and the one that is reported, at first order."""
    draw = np.random.default_rng(seed)
    speed, radius, time = draw.uniform(0.4, 0.8), draw.uniform(15.0, 30.0), 12.8
    turn, sigma = ("starboard", 1.0) if seed % 2 else ("port", -1.0)
    offset, aside = draw.uniform(-5.0, 5.0), draw.uniform(1.0, 3.0)
    current = 0.2 * speed * draw.uniform(-1.0, 1.0, 2)
    start = f"offset: {{starboard: {offset!r}}}, start: {{cross_track: {aside!r}, speed: {speed!r}}}"

    def rates(tick):
        """(true rate, reported rate) less the formula at `time`, and the formula; rates are steps over the tick."""
        flight = fly(
            [start, start],
            speed,
            tick,
            time + 2.0 * tick,
            path=f"{{type: arc, radius: {radius!r}, turn: {turn}, angle: 170 deg}}",
            current=uniform(*current),
            neighbors="reported_speed",
        )
        now = round(time / tick)
        at = {name: values[now, 1] for name, values in flight.channels.items()}
        state = flight.channels["coordination_state"][:, 1]
        heard = flight.neighbor_state_estimate[now + 1, 0, 1]
        north, east = at["north"], at["east"] - sigma * radius  # from the centre
        tangent = sigma / math.hypot(north, east) * np.array([-east, north])
        through = at["speed_desired"] * np.array([math.cos(at["heading_desired"]), math.sin(at["heading_desired"])])
        believed = np.array([at["current_north_estimate"], at["current_east_estimate"]])
        # (1 - c e) h = rho / R, wherever the own path lies; what is reported counts the current that is believed.
        ratio = radius / math.hypot(north, east)
        formula, reported = (through + current) @ tangent * ratio, (through + believed) @ tangent * ratio
        return (state[now + 1] - state[now]) / tick - formula, (heard - state[now]) / tick - reported, formula

    flown = {tick: rates(tick) for tick in (0.1, 0.05, 0.025)}
    rate, _ = limit(lambda tick: flown[tick][2], tuple(flown))
    for k in range(2):
        error, order = limit(lambda tick, k=k: flown[tick][k], tuple(flown))
        print(f"relative error {abs(error) / rate:.1e}, order {order:.3f}")
        assert abs(error) < 1e-5 * rate
        assert order == pytest.approx(1.0, abs=0.15)


NEVER = 1e6  # ticks: one message at the start
tanh_of = "{{law: laplacian_tanh, gain: {!r}, length_scale: {!r}, topology: complete}}".format


@pytest.mark.parametrize(("size", "tick"), [(2, 0.1), (3, 1.0), (4, 0.4)])
def test_a_formation_that_agrees_is_predicted_exactly(size, tick):
    """(55): with no disagreement gamma_hat grows by v_L dt, whatever the tick: nobody corrects anything."""
    starts = ["start: {along_track: 0 m, speed: 0.5}"] * size
    flight = fly(
        starts, 0.5, tick, 100 * tick, observer="none", coordination=tanh_of(0.15, 1.0), message_period=NEVER * tick
    )
    states = flight.channels["coordination_state"]
    assert np.abs(states - 0.5 * flight.times[:, None]).max() < 1e-9
    others = ~np.eye(size, dtype=bool)
    errors = (flight.neighbor_state_estimate - states[:, None, :])[1:, others]  # from the first message on
    assert np.abs(errors).max() < 1e-9


@pytest.mark.parametrize(("size", "largest"), [(2, 2.0), (3, 1.5), (4, 4.0 / 3.0)])
@pytest.mark.parametrize(("tick", "scale"), [(0.9, 0.1), (0.6, 0.07)])
def test_longest_step_of_the_prediction(size, largest, tick, scale):
    """Errata of (55): agreement in steps of dt is stable iff (k / gamma_0) dt lambda_max < 2, on complete graphs."""
    starts = 1e-4 * scale * np.arange(size)

    def agrees(gain):
        # One message at the start: from then on each predicts all the others, and that is exact.
        flight = fly(
            [f"start: {{along_track: {s!r}, speed: 0.5}}" for s in starts.tolist()],
            0.5,
            tick,
            2000 * tick,
            observer="none",
            coordination=tanh_of(gain, scale),
            log_period=2000 * tick,
            message_period=NEVER * tick,
        )
        return np.ptp(flight.channels["coordination_state"][-1]) < np.ptp(starts)

    wanted = 2.0 * scale / (tick * largest)
    low, high = 0.9 * wanted, 1.1 * wanted
    assert agrees(low)
    assert not agrees(high)
    while high - low > 1e-3 * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if agrees(middle) else (low, middle)
    assert low == pytest.approx(wanted, rel=2e-3)
