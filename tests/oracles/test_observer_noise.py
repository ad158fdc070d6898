"""What the observer (33) makes of noise: its variance, flown and by its impulse response, and the best gains."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import solve_continuous_are, solve_continuous_lyapunov, solve_discrete_lyapunov
from scipy.stats import chi2

from cardume.onboard.estimation.current.complementary import Observed
from cardume.simulation.fly import fly_batch
from flying import fly_text, series
from oracles.aboard import check_limit, memory_of, plan_of, uniform, vessel_of

MISSION = """
cardume: 1
name: noise
duration: {duration!r} s
tick: {tick!r} s
log_period: {log_period!r} s
path: {{type: line, length: 100 m}}
formation: {{speed: 0.5 m/s}}
current: {current}
vehicles:
  - name: alone
    model: kinematic
    start: {{speed: 0.5 m/s}}
    sensors:
      gnss: {{sigma: {sigma!r}, period: {tick!r} s}}
      ahrs: {{heading_sigma: 0 deg, yaw_rate_sigma: 0 deg/s, attitude_sigma: 0 deg, period: {tick!r} s}}
      thruster_speed: {{sigma: 0, period: {tick!r} s}}
guidance: {{law: line_of_sight, lookahead: 1e5 m}}    # so stiff that noise does not steer
end: continue
speed_reference: water
position: {position}
current_observer: {{law: complementary, k1: {k1!r}, k2: {k2!r}}}
"""


def variances(k1, k2):
    """Row J2 over N: of Vc_hat and of p_hat."""
    return np.array([k2 * k2 / (2.0 * k1), (k1 * k1 + k2) / (2.0 * k1)])


# ---- by many flights -------------------------------------------------------------------------------------------------


def discrete_variances(k1, k2, tick, sigma):
    """Exactly, of Vc_hat and p_hat in Euler's form with a fix of that sigma in every tick."""
    step = np.array([[1.0 - k1 * tick, tick], [-k2 * tick, 1.0]])
    gain = sigma * tick * np.array([[k1], [k2]])
    return solve_discrete_lyapunov(step, gain @ gain.T).diagonal()[::-1]


def sampled_estimates(k1, k2, tick, sigma, current, flights):
    """Errors of Vc_hat and p_hat after settling, (axis and flight, two); every flight and axis has its own noise."""
    settled = 9.0 / abs(np.roots([1.0, k1, k2]).real).min()
    duration = tick * math.ceil(settled / tick)
    text = MISSION.format(
        duration=duration,
        tick=tick,
        log_period=duration,
        sigma=f"{sigma!r} m",
        position="{law: direct}",
        current=uniform(*current),
        k1=k1,
        k2=k2,
    )
    plan = plan_of(text)
    rows = []
    for flown in fly_batch([replace(plan, seed=seed) for seed in range(flights)]):
        memory, vessel = Observed(*memory_of(flown, "current_observer")), vessel_of(flown)
        rows.append([memory.current_north - current[0], memory.north - vessel.north])
        rows.append([memory.current_east - current[1], memory.east - vessel.east])
    return np.array(rows)


@pytest.mark.parametrize(
    ("k1", "k2", "tick", "sigma", "flights"),
    [
        (0.2, 0.01, 0.1, 1.0, 1500),
        (0.83, 0.31, 0.2, 0.37, 1500),
        pytest.param(0.2, 0.01, 0.1, 1.0, 20_000, marks=pytest.mark.slow),
    ],
)
def test_variance_over_many_flights(k1, k2, tick, sigma, flights):
    """Row J2: sigma = 1, Ts = .1, (.2, .01): .005 m/s and .1118033989 m, less what Euler's form differs by."""
    errors = sampled_estimates(k1, k2, tick, sigma, (0.1, -0.05), flights)
    exact = discrete_variances(k1, k2, tick, sigma)
    # The sum of squares over the variance is chi-squared with one degree of freedom for each flight and axis.
    low, high = chi2.ppf([5e-4, 1.0 - 5e-4], len(errors))
    sums = (errors**2).sum(axis=0) / exact
    print(f"sample / exact {sums / len(errors)}, bounds {low / len(errors):.4f} {high / len(errors):.4f}")
    assert np.all((low < sums) & (sums < high))
    assert abs(errors.mean(axis=0)) == pytest.approx([0.0, 0.0], abs=4.0 * math.sqrt(exact.max() / len(errors)))
    # First order in the tick: the formula is what Euler's form tends to for the same N.
    assert sigma**2 * tick * variances(k1, k2) == pytest.approx(exact, rel=1.5 * k1 * tick)


def test_printed_numbers_of_the_noise():
    """Row J2: sigma = 1, Ts = .1, (.2, .01): standard deviations .005 m/s and .1118033989 m."""
    assert np.sqrt(0.1 * variances(0.2, 0.01)) == pytest.approx([0.005, 0.1118033989], abs=5e-11)


# ---- by the response to one disturbance ------------------------------------------------------------------------------


def errors_after(k1, k2, tick, disturbance):
    """(p - p_hat, Vc - Vc_hat) per tick after an impulse in the fixes, a step of the position or of the current."""
    duration = tick * math.ceil(18.0 / abs(np.roots([1.0, k1, k2]).real).min() / tick)
    text = MISSION.format(
        duration=duration,
        tick=tick,
        log_period=tick,
        sigma="0 m",
        position=f"{{law: 'probes:disturbed', {disturbance}: 1}}",
        current="none",
        k1=k1,
        k2=k2,
    )
    _, estimate = series(fly_text(text), "current_north_estimate")
    seen = np.diff(estimate) / (k2 * tick)  # p_m - p_hat
    if disturbance == "area":
        seen[1] -= 1.0 / tick  # the fix was wrong, not the position
    return seen[1:], (1.0 if disturbance == "ramp" else 0.0) - estimate[1:-1]


def second_moments(k1, k2, tick, disturbance):
    """Integrals of the errors squared: of V, of p and of their product."""
    p, v = errors_after(k1, k2, tick, disturbance)
    return tick * np.array([v @ v, p @ p, p @ v])


def gains_for(seed):
    """A draw of gains, with ticks that suit them."""
    draw = np.random.default_rng(seed)
    k1 = draw.uniform(0.1, 2.0)
    k2 = k1 * k1 * draw.uniform(0.1, 1.0)
    return k1, k2, tuple(0.02 / k1 / 2**n for n in range(3))


@pytest.mark.parametrize("seed", [None, 0, 1, 2])
def test_variance_by_the_impulse_response(seed):
    """Row J2: var Vc_hat = N k2^2 / (2 k1), var p_hat = N (k1^2 + k2) / (2 k1), printed gains and random ones."""
    k1, k2, ticks = (0.2, 0.01, (0.1, 0.05, 0.025)) if seed is None else gains_for(seed)
    check_limit(lambda tick: second_moments(k1, k2, tick, "area")[:2], variances(k1, k2), ticks)
    for k in range(2):  # each by itself, however small beside the other
        check_limit(
            lambda tick, k=k: second_moments(k1, k2, tick, "area")[k : k + 1], variances(k1, k2)[k : k + 1], ticks
        )


def best_gains(qv, qc, r):
    """Row J3."""
    return math.sqrt(qv / r + 2.0 * math.sqrt(qc / r)), math.sqrt(qc / r)


def riccati(qv, qc, r):
    """Covariance of the best filter of x = (p, Vc), p' = Vc + white(qv), Vc' = white(qc), p measured with white(r)."""
    dynamics, measured = np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[1.0, 0.0]])
    return solve_continuous_are(dynamics.T, measured.T, np.diag([qv, qc]), np.array([[r]]))


DENSITIES = [
    (0.01, 1e-4, 0.1),
    *(tuple(10.0 ** np.random.default_rng(s).uniform([-3, -5, -2], [-1, -3, 0])) for s in (0, 1)),
]


def test_printed_gains_of_kalman_and_bucy():
    """Row J3: qv = .01, qc = 1e-4, r = .1: k1 = .4040365741, k2 = .0316227766."""
    assert best_gains(0.01, 1e-4, 0.1) == pytest.approx((0.4040365741, 0.0316227766), abs=5e-11)


@pytest.mark.parametrize(("qv", "qc", "r"), DENSITIES)
def test_best_gains_solve_the_riccati_equation(qv, qc, r):
    """Row J3: (k1, k2) = P C' / r with P from scipy, and no gains near them have less variance."""
    k1, k2 = best_gains(qv, qc, r)
    assert riccati(qv, qc, r)[0] / r == pytest.approx([k1, k2], rel=1e-9)

    def variance(k1, k2):
        """Trace by Lyapunov's equation, of scipy."""
        gain, noise = np.array([[k1], [k2]]), np.diag([qv, qc])
        return solve_continuous_lyapunov(np.array([[-k1, 1.0], [-k2, 0.0]]), -(noise + r * gain @ gain.T)).diagonal()

    assert variance(k1, k2) == pytest.approx(riccati(qv, qc, r).diagonal(), rel=1e-9)
    for others in ((1.1, 1.0), (0.9, 1.0), (1.0, 1.1), (1.0, 0.9)):
        assert np.all(variance(k1 * others[0], k2 * others[1]) > variance(k1, k2))


@pytest.mark.parametrize(("qv", "qc", "r"), DENSITIES)
def test_flown_observer_with_the_best_gains_is_the_best_filter(qv, qc, r):
    """Row J3: noise of the fixes, of the position and of the current, one at a time: together P of Riccati."""
    k1, k2 = best_gains(qv, qc, r)
    wanted = riccati(qv, qc, r)

    def covariance(tick):
        by = {"area": r, "step": qv, "ramp": qc}
        return sum(density * second_moments(k1, k2, tick, name) for name, density in by.items())

    check_limit(
        covariance, np.array([wanted[1, 1], wanted[0, 0], wanted[0, 1]]), tuple(0.02 / k1 / 2**n for n in range(3))
    )
