"""Coordination (44), (45) flown on a line: the closed forms of its modes, its equilibria, and its wrong readings."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from cardume.maths.graphs import normalized_laplacian
from flying import fly_text
from oracles.aboard import check_limit

MISSION = """
cardume: 1
name: consensus
duration: {duration!r} s
tick: {tick!r} s
log_period: {log_period!r} s
path: {{type: line, start: {{course: 70 deg}}, length: 300 m}}
formation: {{speed: {speed!r} m/s}}
model: kinematic
sensors: ideal
vehicles:
{vehicles}
guidance: {{law: line_of_sight, lookahead: 5 m}}
end: continue
coordination: {{law: {law}, topology: {topology}}}
neighbors: {{law: {neighbors}}}
messaging: {{schedule: periodic, period: {message_period!r} s}}
acoustics: {{channel: ideal}}
"""
VEHICLE = "  - {{name: v{k}, start: {{along_track: {along!r}, speed: {speed!r}}}{more}}}"
TANH = "laplacian_tanh, gain: {gain!r}, length_scale: {scale!r}"


def fly_states(starts, law, tick, until, topology="star", speed=0.5, neighbors="coordinated", more=None, **periods):
    """Coordination states (record, vehicle) in the frame that moves with the formation."""
    period = periods.get("log_period", until)
    more = more or [""] * len(starts)
    vehicles = [
        VEHICLE.format(k=k, along=float(start), speed=speed, more=extra)
        for k, (start, extra) in enumerate(zip(starts, more, strict=True))
    ]
    text = MISSION.format(
        duration=until + tick,
        tick=tick,
        log_period=period,
        speed=speed,
        vehicles="\n".join(vehicles),
        law=law,
        topology=topology,
        neighbors=neighbors,
        message_period=periods.get("message_period", tick),
    )
    flight = fly_text(text)
    return flight.channels["coordination_state"] - speed * flight.times[:, None]


def final_states(starts, law, tick, until, **choices):
    return fly_states(starts, law, tick, until, **choices)[-1]


def mode(start, rate, scale, time):
    """Row N: sinh(D / gamma_0) = sinh(D0 / gamma_0) exp(-rate t / gamma_0)."""
    return scale * math.asinh(math.sinh(start / scale) * math.exp(-rate * time / scale))


def tanh_law(gain, scale=1.0):
    return TANH.format(gain=gain, scale=scale)


PREDICTIONS = ("coordinated", "last_report", "reported_speed")


@pytest.mark.parametrize("neighbors", PREDICTIONS)
@pytest.mark.parametrize(("time", "printed"), [(20.0, 2.0178319882), (30.0, 0.0676161069)])
def test_pair_at_the_printed_numbers(neighbors, time, printed):
    """Row N: k = .2, D0 = 10: sinh D = sinh D0 e^{-2kt}: D(20) = 2.0178319882, D(30) = .0676161069."""
    assert mode(10.0, 0.4, 1.0, time) == pytest.approx(printed, abs=5e-11)

    def apart(tick):
        states = final_states((0.0, 10.0), tanh_law(0.2), tick, time, topology="complete", neighbors=neighbors)
        return [states[1] - states[0]]

    check_limit(apart, np.array([printed]), (0.05, 0.025, 0.0125))


def test_pair_that_speaks_once():
    """Row N, (55): after one message at the start each predicts the other by the law of both, and D(20) is the same."""

    def apart(tick):
        states = final_states((0.0, 10.0), tanh_law(0.2), tick, 20.0, topology="complete", message_period=1e6 * tick)
        return [states[1] - states[0]]

    check_limit(apart, np.array([2.0178319882]), (0.05, 0.025, 0.0125))


@pytest.mark.parametrize("neighbors", PREDICTIONS)
def test_star_modes_at_the_printed_numbers(neighbors):
    """Row N: k = .2: leaf mode d0 = 5: d(20) = 1.1139649279; hub mode a0 = 3: a(20) = .0338078461."""
    assert mode(5.0, 0.2, 1.0, 20.0) == pytest.approx(1.1139649279, abs=5e-11)
    assert 0.5 * mode(6.0, 0.4, 1.0, 20.0) == pytest.approx(0.0338078461, abs=5e-11)

    def leaf(tick):
        states = final_states((0.0, 5.0, -5.0), tanh_law(0.2), tick, 20.0, neighbors=neighbors)
        return [states[1] - states[0], states[0] - states[2]]

    def hub(tick):
        states = final_states((3.0, -3.0, -3.0), tanh_law(0.2), tick, 20.0, neighbors=neighbors)
        return [0.5 * (states[0] - states[1]), 0.5 * (states[0] - states[2])]

    check_limit(leaf, np.array([1.1139649279] * 2), (0.05, 0.025, 0.0125))
    check_limit(hub, np.array([0.0338078461] * 2), (0.05, 0.025, 0.0125))


@pytest.mark.parametrize("seed", range(4))
def test_modes_at_random_gains_scales_and_starts(seed):
    """Row N: the pair, the leaf mode and the hub mode at random k, gamma_0, D0 and t."""
    draw = np.random.default_rng(seed)
    gain, scale = draw.uniform(0.05, 0.3), draw.uniform(0.5, 3.0)
    start, time = scale * draw.uniform(1.0, 6.0), draw.uniform(0.5, 4.0) * scale / gain
    ticks = tuple(time / count for count in (400, 800, 1600))
    law = tanh_law(gain, scale)

    def apart(tick):
        pair = final_states((0.0, start), law, tick, time, topology="complete")
        leaf = final_states((0.0, start, -start), law, tick, time)
        hub = final_states((start, 0.0, 0.0), law, tick, time)
        return [pair[1] - pair[0], leaf[1] - leaf[0], hub[0] - hub[1]]

    fast, slow = mode(start, 2.0 * gain, scale, time), mode(start, gain, scale, time)
    check_limit(apart, np.array([fast, slow, fast]), ticks)


@pytest.mark.parametrize("seed", range(4))
def test_any_graph_against_its_differential_equation(seed):
    """Row N beyond its modes: gamma' = v_L - k tanh((I - D^-1 A) gamma / gamma_0) on random directed graphs."""
    draw = np.random.default_rng(seed)
    size = int(draw.integers(3, 6))
    # A ring, so that all agree, and some more links.
    hears = (np.roll(np.eye(size), 1, axis=1) + (draw.random((size, size)) < 0.3) > 0) * (1.0 - np.eye(size))
    gain, scale, time = draw.uniform(0.1, 0.3), draw.uniform(0.5, 2.0), draw.uniform(5.0, 15.0)
    starts = draw.uniform(-5.0, 5.0, size)
    matrix = normalized_laplacian(hears)
    solution = solve_ivp(
        lambda _, states: -gain * np.tanh(matrix @ states / scale), (0.0, time), starts, rtol=1e-11, atol=1e-12
    )
    check_limit(
        lambda tick: final_states(starts, tanh_law(gain, scale), tick, time, topology=hears.tolist()),
        solution.y[:, -1],
        tuple(time / count for count in (200, 400, 800)),
    )


STAR, LONG = (0.0, 6.0, -2.0), 60.0  # errata of (45): g0, k = .5


def test_equilibrium_of_the_random_walk_laplacian():
    """Errata of (45): D^-1 L on the star, g0 = (0, 6, -2), k = .5: (1.8634307 x3)."""
    check_limit(
        lambda tick: final_states(STAR, tanh_law(0.5), tick, LONG, speed=1.0),
        np.array([1.8634307] * 3),
        (0.1, 0.05, 0.025),
    )


@pytest.mark.parametrize(
    ("starts", "mean"), [(STAR, 1.0), ((-3.1, 2.0, 0.7, -1.3), (3.0 * -3.1 + 2.0 + 0.7 - 1.3) / 6.0)]
)
def test_the_linear_law_keeps_the_weighted_mean(starts, mean):
    """Errata of (45): without tanh the mean weighted by the degrees, 1.0 for STAR, is kept at any tick."""
    law = "'printed_coordination:linear', gain: 0.1"
    for tick in (0.5, 0.1):
        states = final_states(starts, law, tick, 300.0, speed=1.0)
        assert states == pytest.approx(np.full(len(starts), mean), abs=1e-9)


def test_the_plus_sign_diverges():
    """Errata of (44), (45): with + the spread of the star, g0 = (0, 6, -2), k = .5, is 27.4 m after 20 s and grows."""
    law = "'printed_coordination:plus_sign', gain: 0.5"

    def spread(tick):
        return [np.ptp(row) for row in fly_states(STAR, law, tick, 40.0, speed=1.0, log_period=20.0)[1:]]

    wanted = solve_ivp(
        lambda _, g: 0.5 * np.tanh(normalized_laplacian(hub_and(2)) @ g),
        (0.0, 40.0),
        STAR,
        t_eval=(20.0, 40.0),
        rtol=1e-11,
    ).y
    assert np.ptp(wanted[:, 0]) == pytest.approx(27.4, abs=0.05)
    check_limit(spread, np.ptp(wanted, axis=0), (0.05, 0.025, 0.0125))
    assert spread(0.05)[1] > spread(0.05)[0] + 15.0
    assert np.ptp(final_states(STAR, tanh_law(0.5), 0.05, 40.0, speed=1.0)) < 1e-5


def hub_and(leaves):
    """Adjacency of a star."""
    adjacency = np.zeros((leaves + 1, leaves + 1))
    adjacency[0, 1:] = adjacency[1:, 0] = 1.0
    return adjacency


@pytest.mark.parametrize(("starts", "gain"), [(STAR, 0.5), ((-3.0, 2.0, 1.0), 0.3), ((1.0, 4.0, -2.0, 3.0), 0.4)])
def test_the_symmetric_laplacian_does_not_agree(starts, gain):
    """Errata of (45): with D^-1/2 L D^-1/2 the star settles at (2.539, 1.795, 1.795), along D^1/2 1: no consensus."""
    leaves = len(starts) - 1
    root = math.sqrt(leaves)
    scaled = np.diag([1.0 / root, *[1.0] * leaves])
    matrix = np.eye(leaves + 1) - scaled @ hub_and(leaves) @ scaled
    wanted = solve_ivp(lambda _, g: -gain * np.tanh(matrix @ g), (0.0, 200.0), starts, rtol=1e-11, atol=1e-13).y[:, -1]
    assert wanted[0] == pytest.approx(root * wanted[1], rel=1e-9)
    if starts == STAR:
        assert wanted == pytest.approx([2.539, 1.795, 1.795], abs=5e-4)
    law = f"'printed_coordination:symmetric', gain: {gain!r}, speed: 1.0"
    roots = [root, *[1.0 / root] * leaves]
    check_limit(
        lambda tick: final_states(
            starts,
            law,
            tick,
            200.0,
            speed=1.0,
            neighbors="reported_speed",
            more=[f", coordination: {{law: {law}, root: {r!r}}}" for r in roots],
        ),
        wanted,
        (0.1, 0.05, 0.025),
    )
