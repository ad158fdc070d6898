"""Errata that stand in no row of closed forms: how equations must be read."""

import math

import pytest
from scipy.optimize import brentq, minimize_scalar

from cardume.maths import to_path
from flying import limit, value_at
from oracles.kinematic import Scene, assert_converges, at, circle, flown, line

# ---- (18): a circle to aim on, so that it settles where it should ---------------------------------------------------


@pytest.mark.parametrize(("radius", "d", "turn"), [(12.0, 5.0, "starboard"), (12.0, 5.0, "port"), (30.0, 8.0, "port")])
def test_18_aimed_on_a_larger_circle_settles_on_the_one_that_is_wanted(radius: float, d: float, turn: str) -> None:
    """Structure of (22): with R' cos(d / R') = R the vehicle comes to R, as line of sight does by itself."""
    larger = brentq(lambda r: r * math.cos(d / r) - radius, radius, 2.0 * radius, xtol=1e-14)
    scene = Scene(circle(larger, turn), f"law: along_path, lookahead: {d!r}", "cross_track: 0", 400.0)
    sigma = 1.0 if turn == "starboard" else -1.0
    assert_converges(scene, lambda f: larger - sigma * value_at(f, "cross_track", 400.0), radius)


# ---- (9)-(11): global, but not exponential --------------------------------------------------------------------------


@pytest.mark.parametrize("e0", [50.0, 500.0])
def test_9_line_of_sight_is_not_globally_exponential(e0: float) -> None:
    """From far away e falls by u t, however far: no rate holds for all, as e' / e = -u / sqrt(d^2 + e^2) says."""
    scene = Scene(line(), "law: line_of_sight, lookahead: 5", f"cross_track: {e0!r}", 20.0)
    rate = -math.log(at("cross_track", 20.0)(flown(scene, 0.1)) / e0) / 20.0
    assert rate == pytest.approx(0.5 / math.hypot(5.0, e0 - 5.0), rel=0.05)
    assert rate < 0.15 * 0.5 / 5.0  # of what it is on the path


# ---- (27): the course of the path, not of the vehicle ---------------------------------------------------------------

U, D = 0.5, 5.0
LIMIT = (3.0 - 2.0 * math.sqrt(2.0)) / 4.0


def worst_start(k2: float) -> tuple[float, float]:
    """(e, s_1) [m] where V' = -k2 s1^2 - u s1 (1 - d / D) - u e^2 / D is largest in proportion, D = sqrt(d^2 + e^2)."""
    distance = D * (1.0 + math.sqrt(2.0))
    return math.sqrt(distance**2 - D**2), -U * (1.0 - D / distance) / (2.0 * k2)


def lyapunov_rate(share: float, literal: float, start: tuple[float, float] | None = None) -> float:
    """[m^2/s] the flown V' at the start, V = (s1^2 + e^2) / 2, for k2 d / u = share, for no tick."""
    k2 = share * U / D
    e, s1 = start or worst_start(k2)
    point = f"'printed_rabbit:rabbit_of_27', behind: {s1!r}, target_gain: {k2!r}, speed: {U}, reach: {D}"
    guidance = f"law: line_of_sight, lookahead: {D}, reference_point: {point}, literal: {literal}"
    scene = Scene(line(), guidance, f"cross_track: {e!r}", 1.0, U, log_period=0.0)

    def rate(tick: float) -> float:
        channels = flown(scene, tick).channels
        target = channels["coordination_state_estimate"][:2, 0]
        vehicle = channels["coordination_state"][:2, 0]  # its own arc length, on a line
        value = 0.5 * ((vehicle - target) ** 2 + channels["cross_track"][:2, 0] ** 2)
        return float((value[1] - value[0]) / tick)

    return limit(rate, (0.04, 0.02, 0.01))[0]


def test_27_the_limit_of_the_literal_reading() -> None:
    """With chi = psi the function of the proof can grow iff k2 d / u < (3 - 2 sqrt 2) / 4 = .0428932188."""

    def share(x: float) -> float:
        """k2 d / u below which V' > 0 for some s1, at D = x d: the discriminant in s1."""
        return (x - 1.0) / (4.0 * x * (x + 1.0))

    best = minimize_scalar(lambda x: -share(x), bounds=(1.0, 20.0), method="bounded", options={"xatol": 1e-10})
    assert -best.fun == pytest.approx(LIMIT, abs=1e-12)
    assert pytest.approx(0.0428932188, abs=5e-11) == LIMIT
    assert best.x == pytest.approx(1.0 + math.sqrt(2.0), abs=1e-6)
    flown_limit = brentq(lambda x: lyapunov_rate(x, literal=1.0), 0.9 * LIMIT, 1.1 * LIMIT, xtol=1e-7)
    assert flown_limit == pytest.approx(LIMIT, rel=1e-4)


@pytest.mark.parametrize("share", [0.01, 0.03, 0.06])
def test_27_with_chi_p_it_never_grows(share: float) -> None:
    """(29), (30): V' = -k2 s1^2 + u e sin(psi - chi_p) < 0 at the very starts where the literal reading fails."""
    k2 = share * U / D
    e, s1 = worst_start(k2)
    expected = -k2 * s1**2 - U * e**2 / math.hypot(D, e)
    assert lyapunov_rate(share, literal=0.0) == pytest.approx(expected, rel=1e-5)
    assert (lyapunov_rate(share, literal=1.0) > 0.0) == (share < LIMIT)


# ---- (35): which way the difference of two angles counts ------------------------------------------------------------


@pytest.mark.parametrize(("heading", "course"), [(0.3, 0.1), (1.9, 2.5), (-0.4, 0.2)])
def test_35_the_speed_across_a_course(heading: float, course: float) -> None:
    """R^T(chi_d) u [cos psi, sin psi] = u [cos(psi - chi_d), sin(psi - chi_d)]; printed is sin(chi_d - psi)."""
    along, across = to_path(course, 0.7 * math.cos(heading), 0.7 * math.sin(heading))
    assert along == pytest.approx(0.7 * math.cos(heading - course), abs=1e-15)
    assert across == pytest.approx(0.7 * math.sin(heading - course), abs=1e-15)
    assert across != pytest.approx(0.7 * math.sin(course - heading), abs=0.1)


# ---- the reset rule -------------------------------------------------------------------------------------------------


def fix_error(law: str, u: float, along: float, latency: float, tick: float) -> float:
    """[m] by how much a vehicle on a line is believed too far ahead, once fixes come `latency` [s] late."""
    sensors = (
        f"{{gnss: {{sigma: 0, period: 2, latency: {latency!r}}},"
        " ahrs: {heading_sigma: 0, yaw_rate_sigma: 0, attitude_sigma: 0, period: TICK},"
        " thruster_speed: {sigma: 0, period: TICK, reader: proportional}}"
    )
    extra = (
        f"position: {{law: {law}}}\nspeed_reference: water\n"
        f"current: {{type: uniform, speed: {along!r}, towards: 0.5}}\n"
        f"current_observer: {{law: 'aids:told', speed: {along!r}, towards: 0.5}}"
    )
    scene = Scene(
        line(0.5), "law: line_of_sight, lookahead: 5", "cross_track: 0", 60.0, u, sensors=sensors, extra=extra
    )
    flight = flown(scene, tick)
    north, east = (value_at(flight, f"{a}_estimate", 60.0) - value_at(flight, a, 60.0) for a in ("north", "east"))
    assert abs(-math.sin(0.5) * north + math.cos(0.5) * east) < 1e-9
    return math.cos(0.5) * north + math.sin(0.5) * east


@pytest.mark.parametrize(("u", "along", "latency"), [(0.5, 0.0, 1.0), (0.5, 0.1, 1.0), (0.8, 0.15, 0.4)])
def test_the_reset_rule_believes_what_was(u: float, along: float, latency: float) -> None:
    """p_hat(t_k) = p(k) is V_T tau astern for a fix that is tau late, and stays so; moved on by V_T tau it is right."""
    assert fix_error("reset", u, along, latency, 0.1) == pytest.approx(-(u + along) * latency, abs=1e-9)
    assert fix_error("reset_compensated", u, along, latency, 0.1) == pytest.approx(0.0, abs=1e-9)
