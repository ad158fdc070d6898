"""Closed form O: what it costs to take late reports for fresh ones, and how to bring them up to date."""

import math
from collections.abc import Callable, Sequence

import numpy as np
import pytest
from scipy.optimize import brentq

from cardume.simulation.flight import Flight
from flying import fly_text

MISSION = """
cardume: 1
name: stale
duration: {until!r} s
tick: {tick!r} s
log_period: {log_period!r} s
path: {{type: line, start: {{course: 70 deg}}, length: 300 m}}
formation: {{speed: {speed!r} m/s}}
current: {{type: uniform, speed: {current!r}, towards: 70 deg}}
current_observer: {{law: 'aids:told', speed: {current!r}, towards: 70 deg}}
speed_reference: water
model: kinematic
vehicles:
{vehicles}
guidance: {{law: line_of_sight, lookahead: 5 m}}
end: continue
coordination: {{law: {law}, topology: {topology}}}
neighbors: {{law: {neighbors}}}
messaging: {{schedule: periodic, period: {tick!r} s}}
"""
LATE = "{{channel: bernoulli, loss: 0, delay: {!r}, sound_speed: 1e9}}".format
# What is said is heard a tick later at the earliest. At most 64 messages of a sender are under way: delay / tick < 64.
VEHICLE = (
    "  - {{name: v{k}, sensors: {sensors}, start: {{along_track: {start!r}, speed: {speed!r}}}, acoustics: {air}}}"
)


def fly(starts, delays, tick, until, sensors=None, neighbors="last_report", **numbers) -> Flight:
    """A fleet along a line; each vehicle hears the others after its own delay [s]."""
    chosen = {"speed": 0.5, "gain": 0.2, "scale": 1.0, "current": 0.0, "topology": "complete", **numbers}
    rows = (
        VEHICLE.format(k=k, sensors=carried, start=start, speed=chosen["speed"], air=LATE(max(0.0, delay - 0.5 * tick)))
        for k, (start, delay, carried) in enumerate(
            zip(starts, delays, sensors or ["ideal"] * len(starts), strict=True)
        )
    )
    chosen.setdefault("law", "laplacian_tanh, gain: {gain!r}, length_scale: {scale!r}".format(**chosen))
    text = MISSION.format(
        tick=tick, until=until, log_period=until / 10.0, vehicles="\n".join(rows), neighbors=neighbors, **chosen
    )
    flight = fly_text(text)
    assert flight.reason == "completed", flight.failure
    return flight


def pace(flight: Flight) -> float:
    """[m/s] at which the fleet goes in the last tenth."""
    state = flight.channels["coordination_state"].mean(axis=1)
    return float((state[-1] - state[-2]) / (flight.times[-1] - flight.times[-2]))


def lag(flight: Flight) -> float:
    """[m] how far the first vehicle is ahead of the others."""
    state = flight.channels["coordination_state"][-1]
    return float(state[0] - state[1:].mean())


def paced(speed: float, gain: float, delay: float, scale: float = 1.0) -> float:
    """Row O: v = v_L - k tanh(v tau / gamma_0)."""
    return float(brentq(lambda v: v - speed + gain * math.tanh(v * delay / scale), 0.0, speed, xtol=1e-14))


def check(flights: Sequence[Flight], quantity: Callable[[Flight], float], wanted: float) -> None:
    """The closed form, whatever the tick: where delays are whole ticks the steady motion knows no tick."""
    for flight in flights:
        found = quantity(flight)
        print(f"{wanted:.10f}: relative error {found / wanted - 1.0:.1e}")
        assert found == pytest.approx(wanted, rel=1e-6)


TICKS = (0.2, 0.1)


@pytest.mark.parametrize(("delay", "printed"), [(1.0, 0.4205254067), (5.0, 0.3162418876)])
def test_all_delayed_at_the_printed_numbers(delay, printed):
    """Row O: all take reports of age tau for fresh ones: v = v_L - k tanh(v tau), 15.9 % less at 1 s."""
    assert paced(0.5, 0.2, delay) == pytest.approx(printed, abs=5e-11)
    if delay == 1.0:
        assert 100.0 * (printed / 0.5 - 1.0) == pytest.approx(-15.9, abs=0.05)
    found = [fly((0.0, 1.0, -0.5), [delay] * 3, tick, 400.0) for tick in TICKS]
    check(found, pace, printed)
    assert np.ptp(found[-1].channels["coordination_state"][-1]) < 1e-6  # they agree, and all are late


@pytest.mark.parametrize("seed", range(3))
def test_all_delayed_at_random(seed):
    """Row O at random v_L, k, gamma_0 and tau, on another graph each."""
    draw = np.random.default_rng([51, seed])
    speed, gain, scale = draw.uniform(0.4, 1.0), draw.uniform(0.1, 0.3), draw.uniform(0.5, 2.0)
    delay = 0.2 * int(draw.integers(3, 20))
    numbers = {"speed": speed, "gain": gain, "scale": scale, "topology": ("star", "ring", "path")[seed]}
    found = [fly((0.0, 0.6, -0.5, 0.1), [delay] * 4, t, 400.0, **numbers) for t in (0.2, 0.1)]
    check(found, pace, paced(speed, gain, delay, scale))


def check_one_sided(tick: float, delay: float, speed: float, gain: float, scale: float) -> None:
    """Row O with the surface vehicle one tick h behind: (tau + h) / 2 in the pace, ahead by v (tau - h) / 2."""
    numbers = {"speed": speed, "gain": gain, "scale": scale, "topology": "star"}
    flight = fly((0.0, 0.3, -0.2), [0.0, delay, delay], tick, 600.0, **numbers)
    slowed = paced(speed, gain, (delay + tick) / 2.0, scale)
    check([flight], pace, slowed)
    check([flight], lag, slowed * (delay - tick) / 2.0)


def test_surface_vehicle_that_sees_at_the_printed_numbers():
    """Row O: the SV knows the UVs without delay, they it after 5 s: v = v_L - k tanh(v tau / 2), SV v tau / 2 ahead."""
    speed = paced(0.5, 0.2, 2.5)
    assert (speed, 2.5 * speed) == pytest.approx((0.3573810317, 0.8934525794), abs=5e-11)
    for tick in TICKS:
        check_one_sided(tick, 5.0, 0.5, 0.2, 1.0)


def test_surface_vehicle_that_sees_by_usbl():
    """Row O, the same where it is the USBL that sees: it overtakes the late reports of those below."""
    sees = (
        "{gnss: {sigma: 0, period: 0.1}, ahrs: {heading_sigma: 0, yaw_rate_sigma: 0, attitude_sigma: 0, period: 0.1},"
        " thruster_speed: {sigma: 0, period: 0.1, reader: proportional},"
        " usbl: {range_sigma: 0, angle_sigma: 0, period: 0.1, latency: 0}}"
    )
    flight = fly((0.0, 0.5, -0.5), [5.0] * 3, 0.1, 400.0, [sees, "ideal", "ideal"], topology="star")
    assert pace(flight) == pytest.approx(0.3573810317, rel=0.02)
    assert lag(flight) == pytest.approx(0.8934525794, rel=0.03)


@pytest.mark.parametrize("seed", range(2))
def test_surface_vehicle_that_sees_at_random(seed):
    """Row O, the asymmetric case, at random v_L, k, gamma_0 and tau."""
    draw = np.random.default_rng([52, seed])
    speed, gain, scale = draw.uniform(0.4, 1.0), draw.uniform(0.1, 0.3), draw.uniform(0.5, 2.0)
    check_one_sided(0.1, 0.2 * int(draw.integers(5, 15)), speed, gain, scale)


@pytest.mark.parametrize(("delay", "printed"), [(1.0, 0.0166), (5.0, 0.0495)])
def test_adding_v_l_times_the_age(delay, printed):
    """Row O: in a current Vpar = .1 it leaves Vpar - delta, delta = Vpar - k tanh(delta tau): .0166 and .0495 m/s."""
    along, gain = 0.1, 0.2
    surplus = brentq(lambda x: x - along + gain * math.tanh(x * delay), 0.0, along, xtol=1e-14)
    assert along - surplus == pytest.approx(printed, abs=5e-5)
    law = "'printed_prediction:nominal_speed'"
    found = [fly((0.0, 1.0), [delay] * 2, t, 400.0, neighbors=law, current=along) for t in TICKS]
    check(found, lambda flight: 0.5 + along - pace(flight), along - surplus)


@pytest.mark.parametrize("delay", [1.0, 4.0])
@pytest.mark.parametrize("current", [0.1, 0.2])
def test_adding_the_reported_speed_times_the_age(delay, current):
    """Row O, the remedy: with the path speed that each reports, the fleet goes at v_L + Vpar, at any tick."""
    flight = fly((0.0, 1.0, -2.0), [delay] * 3, 0.1, 800.0, neighbors="reported_speed", current=current)
    assert pace(flight) == pytest.approx(0.5 + current, abs=1e-9)
    assert np.ptp(flight.channels["coordination_state"][-1]) < 1e-9


@pytest.mark.parametrize(("share", "settles"), [(0.9, True), (1.1, False)])
def test_the_remedy_bears_a_delay_of_one_time_constant(share, settles):
    """Row O, what it does not say: gamma_j + tau gamma_j' feeds a rate back, which is stable iff k tau / gamma_0 < 1.

    x' = -k x + k mu (x(t - tau) + tau x'(t - tau)) is of neutral type for each eigenvalue mu of D^-1 A, 1 among them.
    """
    flight = fly((0.0, 0.3), [5.0] * 2, 0.1, 1500.0, neighbors="reported_speed", gain=share / 5.0)
    correction = np.abs(flight.channels["speed_correction"][-2:]).max()
    assert (correction < 1e-6) if settles else (correction > 0.05)


@pytest.mark.parametrize(("delay", "topology"), [(5.0, "ring"), (10.0, "star"), (40.0, "path")])
def test_the_linear_law_agrees_whatever_the_delay(delay, topology):
    """Row O: I - D^-1 A is stable whatever the delay, here up to k tau = 4; the pace is v_L / (1 + k tau)."""
    law = "'printed_coordination:linear', gain: 0.1"
    flight = fly((0.0, 3.0, -2.0, 1.0), [delay] * 4, delay / 50.0, 300.0 * delay, law=law, topology=topology)
    assert np.ptp(flight.channels["coordination_state"][-1]) < 1e-6
    assert pace(flight) == pytest.approx(0.5 / (1.0 + 0.1 * delay), rel=1e-6)


def test_tanh_takes_no_notice_where_the_delay_is_long():
    """Row O, what it does not say: far beyond v tau = gamma_0 all brake as hard as they can, and nobody agrees."""
    flight = fly((0.0, 3.0, -2.0, 1.0), [40.0] * 4, 0.8, 4000.0, topology="ring")
    assert pace(flight) == pytest.approx(0.5 - 0.2, rel=1e-6)
    assert np.ptp(flight.channels["coordination_state"][-1]) == pytest.approx(5.0, abs=0.01)
