"""Closed forms AA, BB and DD: laws that learn a drift, against closed forms, integrations and MSS's recursions."""

import math

import numpy as np
import pytest

from flying import series, value_at
from oracles.aboard import fly_plan, memory_of
from oracles.closed_forms import integrate
from oracles.kinematic import Scene, assert_converges, at, curve as curved, flown, water

COURSE = 0.5
LINE = f"type: line, start: {{north: 3, east: -2, course: {COURSE!r}}}, length: 3000"
INTEGRAL = "law: integral_line_of_sight, lookahead: 5, integral_gain: 0.125"
ADAPTIVE = "law: adaptive_line_of_sight, lookahead: 5, adaptation_gain: 0.005"
SIGHT = "law: line_of_sight, lookahead: 5"


def across(v: float, compensation: str = "none", observer: str = "") -> str:
    """Sections: a current v [m/s] square to the line, towards starboard."""
    return water(abs(v), COURSE + math.copysign(math.pi / 2.0, v), compensation, observer)


def crossing(guidance: str, v: float = 0.1, e0: float = 5.0, duration: float = 50.0, u: float = 0.5) -> Scene:
    """A line flown in a current across it that is not compensated."""
    return Scene(LINE, guidance, f"cross_track: {e0!r}", duration, u, extra=across(v))


@pytest.mark.parametrize(("guidance", "printed"), [(INTEGRAL, -0.0739270561), (ADAPTIVE, -0.2336972589)])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_aa_bb_error_at_the_printed_parameters(guidance: str, printed: float, side: float) -> None:
    """Rows AA, BB: e(50 s) from e0 = 5 m in a current of 0.1 m/s, kappa = 0.125 m/s and gamma = 0.005 1/(m s)."""
    assert_converges(crossing(guidance, side * 0.1, side * 5.0), at("cross_track", 50.0), side * printed)


def drawn(seed: int) -> tuple[float, float, float, float, float]:
    """u, d, V, e0, and a gain as a share of the critical one."""
    random = np.random.default_rng([31, seed])
    u, d, share, e0, gain = (float(x) for x in random.uniform([0.3, 3, -0.6, -12, 0.3], [1.2, 12, 0.6, 12, 3.0]))
    return u, d, share * u, e0, gain


@pytest.mark.parametrize("seed", range(6))
def test_aa_at_random(seed: int) -> None:
    """Row AA: e' = V + u sin(chi_d), z' = d e / (d^2 + (e + k z)^2), integrated independently."""
    u, d, v, e0, share = drawn(seed)
    k = share * u / 4.0

    def rates(_: float, y: np.ndarray) -> list[float]:
        aim = y[0] + k * y[1]
        return [v - u * aim / math.hypot(d, aim), d * y[0] / (d * d + aim * aim)]

    law = f"law: integral_line_of_sight, lookahead: {d!r}, integral_gain: {k!r}"
    e = integrate(rates, [e0, 0.0], 30.0)[0]
    assert_converges(crossing(law, v, e0, 30.0, u), at("cross_track", 30.0), e, scale=max(abs(e), 0.1))


@pytest.mark.parametrize("seed", range(6, 12))
def test_bb_at_random(seed: int) -> None:
    """Row BB: e' = V - u sin(b + atan(e / d)), b' = g d e / sqrt(d^2 + e^2), integrated independently."""
    u, d, v, e0, share = drawn(seed)
    g = share * u / (4.0 * d * d)

    def rates(_: float, y: np.ndarray) -> list[float]:
        return [v - u * math.sin(y[1] + math.atan(y[0] / d)), g * d * y[0] / math.hypot(d, y[0])]

    law = f"law: adaptive_line_of_sight, lookahead: {d!r}, adaptation_gain: {g!r}, crab_max: 1.5"
    e = integrate(rates, [e0, 0.0], 30.0)[0]
    assert_converges(crossing(law, v, e0, 30.0, u), at("cross_track", 30.0), e, scale=max(abs(e), 0.1))


@pytest.mark.parametrize(("v", "integral", "angle"), [(0.1, 8.1649658093, 0.2013579208), (-0.2, None, None)])
def test_aa_bb_what_is_learnt(v: float, integral: float | None, angle: float | None) -> None:
    """Rows AA, BB: z = d tan(asin(V / u)) / kappa, b = asin(V / u), and no error is left."""
    crab = math.asin(v / 0.5)
    learnt = 5.0 * math.tan(crab) / 0.125
    if integral and angle:
        assert (learnt, crab) == pytest.approx((integral, angle), abs=1e-10)
    for law, wanted in ((INTEGRAL, learnt), (ADAPTIVE, crab)):
        scene = crossing(law, v, 5.0, 900.0)
        assert memory_of(fly_plan(scene.text(0.1)), "guidance") == pytest.approx([wanted], rel=1e-9)
        assert value_at(flown(scene, 0.1), "cross_track", 900.0) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("share", [0.25, 1.0, 4.0])
def test_aa_bb_poles(share: float) -> None:
    """Rows AA, BB: near the path both obey s^2 + (u / d) s + w^2, critical at kappa = u / 4 and gamma = u / (4 d^2).

    zeta = sqrt(u / kappa) / 2 = sqrt(u / gamma) / (2 d): 2, 1 and 0.5 here.
    """
    u, d, e0 = 0.5, 5.0, 1e-4
    k, g = share * u / 4.0, share * u / (4.0 * d * d)
    assert 0.5 * math.sqrt(u / k) == pytest.approx(math.sqrt(u / g) / (2.0 * d)) == pytest.approx(share**-0.5)
    e = integrate(lambda _, y: [-u / d * (y[0] + y[1]), share * u / (4.0 * d) * y[0]], [e0, 0.0], 20.0)[0]
    for law in (
        f"law: integral_line_of_sight, lookahead: 5, integral_gain: {k!r}",
        f"law: adaptive_line_of_sight, lookahead: 5, adaptation_gain: {g!r}",
    ):
        assert_converges(crossing(law, 0.0, e0, 20.0), at("cross_track", 20.0), e, scale=0.1 * e0)


@pytest.mark.parametrize("tick", [0.1, 0.5])
def test_the_recursions_are_those_of_mss(tick: float) -> None:
    """`ILOSpsi.m` and `ALOSpsi.m`: heading from the state before, then y_int and beta_hat one Euler step on."""
    e, z, b, f, h = 6.0, 0.0, 0.0, 6.0, tick
    integral, adaptive = [], []
    for _ in range(round(60.0 / h) + 1):
        integral.append(e)
        adaptive.append(f)
        psi = -math.atan((1.0 / 5.0) * (e + 0.125 * z))
        z, e = z + h * 5.0 * e / (5.0**2 + (e + 0.125 * z) ** 2), e + h * (0.5 * math.sin(psi) + 0.1)
        psi = -b - math.atan(f / 5.0)
        b, f = b + h * 0.005 * 5.0 * f / math.sqrt(5.0**2 + f**2), f + h * (0.5 * math.sin(psi) + 0.1)
    for law, wanted in ((INTEGRAL, integral), (ADAPTIVE, adaptive)):
        times, flew = series(flown(crossing(law, 0.1, 6.0, 60.0), tick), "cross_track")
        assert flew[:61] == pytest.approx(np.array(wanted)[np.round(times[:61] / h).astype(int)], abs=1e-11)


def test_the_projection_bounds_the_estimate() -> None:
    """A drift that asks for asin(0.9) = 1.12 rad: |b| stops below M + m = 0.31; with M = 1.5 it is found."""
    law = "law: adaptive_line_of_sight, adaptation_gain: 0.02, crab_max: 0.3"
    stopped = memory_of(fly_plan(crossing(law, 0.45, 0.0, 200.0).text(0.1)), "guidance")[0]
    assert 0.3 < stopped <= 0.31
    free = memory_of(fly_plan(crossing(law.replace("0.3", "1.5"), 0.45, 0.0, 900.0).text(0.1)), "guidance")[0]
    assert free == pytest.approx(math.asin(0.9), abs=1e-6)
    within = crossing(law, -0.1, 0.0, 400.0)  # asin(0.2) = 0.2014: nothing is held
    assert memory_of(fly_plan(within.text(0.1)), "guidance") == pytest.approx([-math.asin(0.2)], rel=1e-6)


# ---- Maurya's PI -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(6))
def test_arcsine_integral_is_linear(seed: int) -> None:
    """e'' + k1 e' + k2 e = 0 with e'(0) = V - k1 e0, on lines and arcs of both senses, where nothing saturates."""
    random = np.random.default_rng([32, seed])
    u, k1, damping, v = (float(x) for x in random.uniform([0.4, 0.08, 0.4, -0.1], [1.0, 0.2, 1.5, 0.1]))
    k2, e0 = (0.5 * k1 / damping) ** 2, 0.4 * u / k1 * (1.0, -1.0)[seed % 2]
    curvature = (0.0, 1 / 25.0, -1 / 25.0)[seed % 3]
    drift = v if curvature == 0.0 else 0.0
    path = LINE if curvature == 0.0 else curved(curvature)
    e = integrate(lambda _, y: [drift - k1 * y[0] - k2 * y[1], y[0]], [e0, 0.0], 25.0)[0]
    law = f"law: arcsine_integral, gain: {k1!r}, integral_gain: {k2!r}"
    scene = Scene(path, law, f"cross_track: {e0!r}", 25.0, u, extra=across(drift))
    assert_converges(scene, at("cross_track", 25.0), e, scale=abs(e0))


def test_arcsine_integral_learns_the_drift() -> None:
    """z = V / k2, and no error is left."""
    scene = crossing("law: arcsine_integral, gain: 0.14, integral_gain: 0.01", 0.1, 5.0, 600.0)
    assert memory_of(fly_plan(scene.text(0.1)), "guidance") == pytest.approx([10.0], rel=1e-9)
    assert value_at(flown(scene, 0.1), "cross_track", 600.0) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("gain", "overshoot"), [(10.0, 2.0), (0.0, 15.0)])
def test_arcsine_integral_does_not_wind_up(gain: float, overshoot: float) -> None:
    """From 40 m, 60 s of saturation: back-calculation takes back what the error adds; without it the vehicle runs past.

    e' = u sat(a), z' = e + ka (a - sat(a)), a = -(k1 e + k2 z) / u, integrated independently.
    """

    def rates(_: float, y: np.ndarray) -> list[float]:
        a = -(0.14 * y[0] + 0.01 * y[1]) / 0.5
        sat = min(max(a, -0.99), 0.99)
        return [0.5 * sat, y[0] + gain * (a - sat)]

    law = f"law: arcsine_integral, gain: 0.14, integral_gain: 0.01, anti_windup: {gain!r}"
    flight = flown(crossing(law, 0.0, 40.0, 240.0), 0.05)
    times, e = series(flight, "cross_track")
    assert e.min() < -0.2
    assert (-e.min() < overshoot) == (gain > 0.0)
    for time in (50.0, 100.0, 140.0):
        assert value_at(flight, "cross_track", time) == pytest.approx(integrate(rates, [40.0, 0.0], time)[0], abs=0.1)
    assert times[-1] >= 240.0


# ---- row DD ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("guidance", "gains", "printed"),
    [
        (SIGHT, (1.0, 0.25), 67.29396187),
        (ADAPTIVE, None, 76.77040111),
        (INTEGRAL, None, 79.71327972),
        (SIGHT, (0.2, 0.01), 82.47562905),
        (SIGHT, None, 357.07569370),
    ],
)
def test_dd_integral_of_the_absolute_error(guidance: str, gains: tuple[float, float] | None, printed: float) -> None:
    """Row DD: int |e| dt over 300 s, kinematic, u = 0.5, d = 5, e0 = 5 m, a current of 0.1 m/s across from t = 0.

    The estimates begin at zero; the two laws are critically damped, the observer (33) drives `crab`.
    """
    observer = "none" if gains is None else f"{{law: complementary, k1: {gains[0]}, k2: {gains[1]}}}"
    extra = across(0.1, "none" if gains is None else "crab", observer)
    scene = Scene(LINE, guidance, "cross_track: 5", 299.0, extra=extra)  # the flight lasts a second longer
    assert_converges(scene, lambda flight: flight.metrics.vehicles["alone"]["cross_track_iae"], printed)
