"""Closed forms G and I with MEDUSA's hull: drift in a turn, and what a wrong thrust does to a speed."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from flying import fly_text, value_at

MISSION = """
cardume: 1
name: turning
duration: {duration!r} s
tick: {tick!r} s
plant_step: {step!r} s
log_period: {tick!r} s
path: {{{path}}}
formation: {{speed: {speed!r} m/s}}
guidance: {{{guidance}}}
compensation: {compensation}
current_observer: {observer}
position: direct
speed_reference: {reference}
vehicles:
  - {{name: alone, model: {model}, sensors: {sensors}, start: {{speed: {speed!r} m/s}}}}
end: continue
{more}
"""
MASS, DRAG, DRAG_QUADRATIC = 50.0, 55.1, 101.0  # m_u, Y_v, Y_|v|v of farol's mvector, typed again


def turn_at(speed: float, error: float, radius: float) -> tuple[float, float, float]:
    """(v, r, beta) of a steady turn at a distance R - e: 50 u r + (55.1 + 101 |v|) v = 0, r = U / (R - e)."""

    def balance(v: float) -> float:
        rate = math.hypot(speed, v) / (radius - error)
        return MASS * speed * rate + (DRAG + DRAG_QUADRATIC * abs(v)) * v

    v = brentq(balance, -0.5, 0.0, xtol=1e-15)
    return v, math.hypot(speed, v) / (radius - error), math.atan2(v, speed)


def resting(speed: float, radius: float, offset: float, law: str) -> tuple[float, float, float, float]:
    """(e, v, r, beta) where guidance without sway compensation rests: its heading error is the drift angle.

    Args:
        speed: [m/s] surge.
        radius: [m]
        offset: [m] or [1/s] lookahead of line of sight, gain of the arcsine law.
        law: which.
    """

    def gap(e: float) -> float:
        v, _, beta = turn_at(speed, e, radius)
        return e - (offset * v / speed if law == "line_of_sight" else speed / offset * math.sin(beta))

    e = brentq(gap, -2.0, 0.0, xtol=1e-15)
    return (e, *turn_at(speed, e, radius))


def flown(tick: float, duration: float, radius: float = 12.0, turn: str = "starboard", **given):
    """A MEDUSA with exact sensors on a circle, long enough to rest."""
    values = {
        "path": f"type: circle, centre: {{north: 0, east: 0}}, radius: {radius!r}, turn: {turn}",
        "speed": 0.5,
        "guidance": "law: line_of_sight, lookahead: 5",
        "compensation": "none",
        "observer": "none",
        "model": "medusa",
        "sensors": "ideal",
        "reference": "water",
        "more": "",
    }
    text = MISSION.format(duration=duration, tick=tick, step=tick, **{**values, **given})
    return fly_text(text)


def rest(channel: str, **given) -> float:
    """A channel after ten minutes, when the slow integral of the heading loop has nothing left to do.

    With one plant step in a tick the autopilot steers by references of now, so nothing is left of the tick.
    """
    return value_at(flown(0.1, 600.0, **given), channel, 599.9)


# ---- G ---------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("speed", "radius", "printed"),
    [
        (0.5, 12.0, (-0.1804055481, -0.0180405548, 0.0410762477, -2.06639890)),
        (0.5, 20.0, (-0.1105920368, None, None, None)),
        (1.0, 12.0, (-0.3290985454, -0.0658197091, None, None)),
    ],
)
def test_g_the_printed_numbers(speed: float, radius: float, printed: tuple[float | None, ...]) -> None:
    """Row G, line of sight with d = 5 m: e = d v / u. Of the surge-compensated: v = -.0183035802 at e = 0."""
    e, v, r, beta = resting(speed, radius, 5.0, "line_of_sight")
    for value, given in zip((e, v, r, math.degrees(beta)), printed, strict=True):
        assert given is None or value == pytest.approx(given, abs=1e-8)
    assert turn_at(0.5, 0.0, 12.0)[0] == pytest.approx(-0.0183035802, abs=1e-9)


@pytest.mark.parametrize("turn", ["starboard", "port"])
def test_g_line_of_sight_rests_outside_the_arc(turn: str) -> None:
    """Row G flown: e = -.1804055481 m, v = -.0180405548 m/s, r = .0410762477 rad/s at u = .5, R = 12."""
    sigma = 1.0 if turn == "starboard" else -1.0
    e, v, r, _ = resting(0.5, 12.0, 5.0, "line_of_sight")
    assert sigma * rest("cross_track", turn=turn) == pytest.approx(e, rel=1e-6)
    assert sigma * rest("sway", turn=turn) == pytest.approx(v, rel=1e-6)
    assert sigma * rest("yaw_rate", turn=turn) == pytest.approx(r, rel=1e-6)


def test_g_line_of_sight_with_other_parameters() -> None:
    guidance = "law: line_of_sight, lookahead: 8"
    e, v, _, _ = resting(0.4, 20.0, 8.0, "line_of_sight")
    assert rest("cross_track", radius=20.0, speed=0.4, guidance=guidance) == pytest.approx(e, rel=1e-5)
    assert rest("sway", radius=20.0, speed=0.4, guidance=guidance) == pytest.approx(v, rel=1e-5)


def test_g_the_arcsine_law_rests_outside_the_arc() -> None:
    """Row G: e = (u / k1) sin beta."""
    e, v, _, _ = resting(0.5, 12.0, 0.1, "arcsine")
    guidance = "law: arcsine, gain: 0.1"
    assert rest("cross_track", guidance=guidance) == pytest.approx(e, rel=1e-6)
    assert rest("sway", guidance=guidance) == pytest.approx(v, rel=1e-6)


def test_g_sway_compensation_brings_it_onto_the_arc() -> None:
    """Row G: with psi_d = chi_d - asin(v / U) e = 0 and v = -.0183035802 m/s."""
    steers = {"compensation": "{law: crab, use_sway: 1}"}
    assert rest("cross_track", **steers) == pytest.approx(0.0, abs=1e-6)
    assert rest("sway", **steers) == pytest.approx(-0.0183035802, rel=1e-7)


# ---- I ---------------------------------------------------------------------------------------------------------------

OPEN_LOOP = "autopilot: {speed_integral_gain: 0 N/m}"
BY_SHAFT = "{gnss: {sigma: 0 m, period: 0.1 s}, ahrs: {heading_sigma: 0 deg, yaw_rate_sigma: 0 deg/s}"
LINE = "type: line, length: 200 m"


def test_i_the_printed_numbers() -> None:
    """Row I: 2 x 1390 rpm with c = 1.77778e-6: tau = 6.86969748 N, u = .4998071438 m/s; f = 1.1: a = 1.0488088482."""
    tau = 2.0 * 1.77778e-6 * 1390.0**2
    assert tau == pytest.approx(6.86969748, abs=1e-8)
    assert math.sqrt(tau / 27.5) == pytest.approx(0.4998071438, abs=1e-10)
    assert math.sqrt(1.1) == pytest.approx(1.0488088482, abs=1e-10)


def test_i_a_shaft_speed_and_its_speed_flown() -> None:
    """At .4998071438 m/s the shafts of a MEDUSA turn at 1390 rpm and give 6.86969748 N."""
    flight = flown(0.1, 100.0, path=LINE, speed=0.4998071438)
    assert value_at(flight, "shaft_speed_rpm", 99.0) == pytest.approx(1390.0, rel=1e-6)
    assert value_at(flight, "thrust", 99.0) == pytest.approx(6.86969748, rel=1e-6)


@pytest.mark.parametrize("factor", [1.1, 0.8, 1.5])
def test_i_a_wrong_thrust_factor_is_the_root_of_it_in_speed(factor: float) -> None:
    """Thrust believed f times as strong reads the speed sqrt(f) times too high: Vhat = (1 - sqrt f) u ahead."""
    believed = factor * 1.77778e-6 * (30.0 / math.pi) ** 2
    reader = f"thruster_speed: {{sigma: 0, thrust_coefficient: {believed!r} N s^2/rad^2}}"
    flight = flown(
        0.1,
        300.0,
        path=LINE,
        sensors=f"{BY_SHAFT}, {reader}}}",
        observer="{law: complementary, k1: 0.2, k2: 0.01}",
        more=OPEN_LOOP,
    )
    surge = value_at(flight, "surge", 299.0)
    ghost = value_at(flight, "current_north_estimate", 299.0)
    assert surge == pytest.approx(0.5, abs=1e-4)
    assert 1.0 - ghost / surge == pytest.approx(math.sqrt(factor), rel=1e-4)


def test_i_the_speed_lost_in_a_turn() -> None:
    """Row I: at the thrust of .5 m/s a turn of R = 12 m takes u to .4983483136; (37) reads a = 1.0033143212."""
    thrust = 27.5 * 0.25

    def balance(u: float) -> float:
        v, r, _ = turn_at(u, 0.0, 12.0)
        return thrust + 60.0 * v * r - 27.5 * u * u

    u = brentq(balance, 0.4, 0.5, xtol=1e-15)
    assert u == pytest.approx(0.4983483136, abs=1e-7)
    assert 0.5 / u == pytest.approx(1.0033143212, abs=2e-7)
    flight = flown(0.1, 200.0, compensation="{law: crab, use_sway: 1}", more=OPEN_LOOP)
    assert value_at(flight, "thrust", 199.0) == pytest.approx(thrust, rel=1e-5)
    assert value_at(flight, "surge", 199.0) == pytest.approx(u, abs=2e-6)
    rpm = value_at(flight, "shaft_speed_rpm", 199.0)
    assert math.sqrt(2.0 * 1.77778e-6 * rpm**2 / 27.5) / value_at(flight, "surge", 199.0) == pytest.approx(
        1.0033143212, rel=1e-5
    )


# ---- what a speed is over --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("reference", ["ground", "water"])
@pytest.mark.parametrize("along", [0.12, -0.12, 0.0])
@pytest.mark.parametrize("across", [0.0, 0.1])
def test_speed_over_ground_or_through_the_water(reference: str, along: float, across: float) -> None:
    """`ground`: the path is made good at v_L; `water`: at sqrt(v_L^2 - Vperp^2) + Vpar, the current found by (33)."""
    towards = math.atan2(across, along) % math.tau
    more = f"current: {{type: uniform, speed: {math.hypot(along, across)!r}, towards: {towards!r}}}"
    flight = flown(
        0.1,
        200.0,
        path=LINE,
        compensation="crab",
        observer="{law: complementary, k1: 0.2, k2: 0.01}",
        reference=reference,
        more=more,
    )
    gone = value_at(flight, "coordination_state", 199.0) - value_at(flight, "coordination_state", 159.0)
    expected = 0.5 if reference == "ground" else math.sqrt(0.25 - across**2) + along
    assert gone / 40.0 == pytest.approx(expected, abs=5e-4)
    through = math.hypot(0.5 - along, across) if reference == "ground" else 0.5
    assert value_at(flight, "surge", 199.0) == pytest.approx(through, abs=1e-3)
    assert abs(value_at(flight, "cross_track", 199.0)) < 5e-3


def test_both_are_the_same_in_still_water() -> None:
    one, other = (flown(0.1, 60.0, path=LINE, reference=reference) for reference in ("water", "ground"))
    assert np.array_equal(one.channels["north"], other.channels["north"])
