"""Closed form II, rows V and X, and the algebra of `kalman_replay` against an independent filter."""

import math
from dataclasses import replace
from itertools import product, zip_longest

import numpy as np
import pytest
from scipy.linalg import expm, solve_discrete_are
from scipy.stats import t as student

from cardume.errors import LawError
from cardume.laws import laws_of
from cardume.onboard.estimation.position.belief import Covariance, Mean, Moment
from cardume.onboard.estimation.position.dead_reckoning import way_through_water
from cardume.onboard.estimation.position.kalman_replay import Replayed
from cardume.onboard.estimation.position.past_fixes import KEPT, SLOT
from cardume.signals import Fix, Motion
from cardume.simulation.fly import Flown, fly
from oracles.aboard import memory_of
from oracles.shaken import (
    COMPENSATED,
    RESET,
    TOLD,
    Scene,
    channel,
    errors_of,
    flights,
    kalman,
    late_half,
    nees_of,
    plan_for,
)

KALMAN = laws_of("position")["kalman_replay"]


def rms(plan, runs):
    """Root mean square of the error per axis over the last half of so many flights, two axes each."""
    return math.sqrt(np.mean([np.mean(late_half(errors_of(flown)) ** 2) for flown in flights(plan, range(runs))]))


@pytest.mark.parametrize("runs", [200, pytest.param(2000, marks=pytest.mark.slow)])
def test_row_two(runs):
    """Row II: the paper's rule 1.175 m, delay compensated 1.01 m, replay .446 m, at most 3 % above fixes without delay.

    The reset rules know the current that there was at first.
    """
    scene = Scene()
    replayed = rms(plan_for(scene, kalman(scene)), runs)
    at_once = rms(plan_for(scene._replace(delay=0.0), kalman(scene)), runs)
    paper = rms(plan_for(scene, RESET, TOLD), runs)
    compensated = rms(plan_for(scene, COMPENSATED, TOLD), runs)
    print(f"replay {replayed:.4f}, no delay {at_once:.4f}, reset {paper:.4f}, compensated {compensated:.4f} m")
    assert replayed <= 0.46
    assert replayed <= 1.03 * at_once
    assert paper == pytest.approx(1.175, rel=0.04 if runs < 1000 else 0.005)
    assert compensated == pytest.approx(1.01, rel=0.03 if runs < 1000 else 0.005)


# ---- consistency: is the covariance the one that the errors have? ----------------------------------------------------

CELLS = [
    Scene(period, loss, delay)
    for loss, period, delay in product((0.0, 0.2, 0.5), (1.0, 2.0, 5.0, 10.0), (0.0, 0.5, 2.0))
]


def mean_nees(scene, runs):
    """For each flight the mean over time of the squared error over the covariance; mean of these and its error."""
    plan = plan_for(scene, kalman(scene, gate=1e9))
    found = np.array([late_half(nees_of(flown)).mean() for flown in flights(plan, range(runs))])
    return found.mean(), found.std(ddof=1) / math.sqrt(runs)


def check_nees(scenes, runs, risk=0.01):
    """ANEES of every scene is 1 within bounds which all of them together exceed by chance in 1 % of cases."""
    limit = student.ppf(1.0 - risk / (2 * len(scenes)), runs - 1)
    for scene in scenes:
        mean, error = mean_nees(scene, runs)
        print(f"T {scene.period} p {scene.loss} tau {scene.delay}: ANEES {mean:.4f} of 1 +- {limit * error:.4f}")
        assert abs(mean - 1.0) < limit * error, scene


def test_covariance_is_that_of_the_errors():
    """Row X over a few of the cells below, with other noises than row II's among them."""
    check_nees([Scene(), Scene(2.0, 0.5, 2.0, 0.5, 3e-3, 1e-5), Scene(10.0, 0.5, 0.5, 2.0, 2e-4, 1e-5)], 80)


@pytest.mark.slow
def test_covariance_is_that_of_the_errors_everywhere():
    """Matched noise, loss 0, .2, .5 x period 1, 2, 5, 10 s x delay 0, .5, 2 s."""
    check_nees(CELLS, 300)


def test_covariance_tells_a_mismatch():
    """The test above can fail: with fixes twice as noisy as told ANEES is far above 1."""
    scene = Scene()
    flown = plan_for(scene._replace(sigma=2.0), kalman(scene, gate=1e9))
    flown = replace(
        flown, vehicles=(replace(flown.vehicles[0], datasheet=flown.vehicles[0].datasheet._replace(gnss=1.0)),)
    )
    assert np.mean([late_half(nees_of(f)).mean() for f in flights(flown, range(20))]) > 1.5


# ---- row V: the steady covariance ------------------------------------------------------------------------------------


def steady(scene):
    """K, and the covariance before and after a fix and one tick before it, by scipy's Riccati solver."""

    def grown(t):
        return np.array(
            [[scene.qv * t + scene.qc * t**3 / 3, scene.qc * t**2 / 2], [scene.qc * t**2 / 2, scene.qc * t]]
        )

    step, noise = np.array([[1.0, scene.period], [0.0, 1.0]]), np.array([[scene.sigma**2]])
    prior = solve_discrete_are(step.T, np.array([[1.0], [0.0]]), grown(scene.period), noise)
    gain = prior[:, 0] / (prior[0, 0] + scene.sigma**2)
    back = np.array([[1.0, -scene.tick], [0.0, 1.0]])
    earlier = back @ (prior - grown(scene.tick)) @ back.T
    return gain, math.sqrt(prior[0, 0]), math.sqrt(prior[0, 0] * (1.0 - gain[0])), math.sqrt(earlier[0, 0])


@pytest.mark.parametrize(
    ("period", "gain", "before", "after"),
    [
        (1.0, (0.0532978307, 0.0009729862), 0.2372728683, 0.2308632294),
        (5.0, (0.1524371264, 0.0020585952), 0.4240913498, 0.3904319741),
        (10.0, None, 0.5574207065, 0.4868873504),
    ],
)
def test_steady_covariance_at_the_printed_numbers(period, gain, before, after):
    """Row V: the flown filter's covariance just before and just after a fix is that of the Riccati equation."""
    scene = Scene(period=period, loss=0.0, delay=0.0, log_period=0.1)
    known, prior, posterior, _ = steady(scene)
    assert (prior, posterior) == pytest.approx((before, after), abs=5e-10)
    assert gain is None or known == pytest.approx(gain, abs=5e-10)
    check_steady(scene)


@pytest.mark.parametrize("seed", range(3))
def test_steady_covariance_at_random(seed):
    """Row V at random noises and periods."""
    draw = np.random.default_rng([31, seed])
    period = 0.5 * int(draw.integers(1, 24))
    noises = {"sigma": draw.uniform(0.2, 3.0), "qv": 10.0 ** draw.uniform(-4, -2), "qc": 10.0 ** draw.uniform(-6, -4)}
    check_steady(Scene(period=period, loss=0.0, delay=0.0, log_period=0.1, **noises))


def check_steady(scene):
    """The variance over the last fixes of a long flight; the law adds 1e-6 m^2 to that of each."""
    _, _, posterior, earlier = steady(scene)
    flown = fly(plan_for(scene, kalman(scene)))
    sigmas = np.sqrt(channel(flown, "north_variance")[-2 * round(scene.period / scene.tick) :])
    assert sigmas.min() == pytest.approx(posterior, rel=1e-5)
    assert sigmas.max() == pytest.approx(earlier, rel=1e-5)


# ---- another program: step by step, with matrices --------------------------------------------------------------------


class StepByStep:
    """The same filter tick by tick with 6 x 6 matrices, whose fixes are sorted beforehand."""

    def __init__(self, variances, qv, qc, fading, dt):
        self.x, self.p = np.zeros(6), np.diag(variances)
        self.first, self.qv, self.qc, self.fading, self.dt = self.p.copy(), qv, qc, fading, dt

    def step(self, ahead, aside):
        """One tick: the matrix exponential gives transition and noise (van Loan)."""
        a = np.zeros((6, 6))
        a[:2, 2:4] = np.eye(2)
        a[2:4, 2:4] = -self.fading * np.eye(2)
        a[:2, 4:] = np.array([[ahead, -aside], [aside, ahead]]) / self.dt
        q = np.diag([self.qv] * 2 + [self.qc] * 2 + [0.0, 0.0])
        loan = expm(np.block([[-a, q], [np.zeros((6, 6)), a.T]]) * self.dt)
        f = loan[6:, 6:].T
        self.x = f @ self.x + np.array([ahead, aside, 0, 0, 0, 0])
        self.p = f @ self.p @ f.T + f @ loan[:6, 6:]

    def fix(self, z, r, since):
        """The calibration drifts by its first variance in an hour, all at once."""
        self.p[4:, 4:] += self.first[4:, 4:] * since / 3600.0
        s = self.p[:2, :2] + r + 1e-6 * np.eye(2)
        k = self.p[:, :2] @ np.linalg.inv(s)
        self.x = self.x + k @ (z - self.x[:2])
        self.p = self.p - k @ s @ k.T


def scenario(seed, count=250, dt=0.1):
    """Motion for so many ticks, and fixes (tick of arrival, tick of validity, z, R), some of them out of order."""
    draw = np.random.default_rng([32, seed])
    turn = draw.uniform(-0.1, 0.1)
    motions = []
    for k in range(count):
        heading, surge, sway = 0.3 + turn * k * dt, 0.5 + 0.2 * math.sin(0.05 * k), 0.05
        north, east = (
            math.cos(heading) * surge - math.sin(heading) * sway,
            math.sin(heading) * surge + math.cos(heading) * sway,
        )
        motions.append(Motion(heading, turn, surge, sway, north, east, 0.0, 0.0))
    fixes, arrivals = [], set()
    for valid in range(5, count - 60, 17):
        arrival = valid + int(draw.integers(0, 50))
        while arrival in arrivals:
            arrival += 1
        arrivals.add(arrival)
        root = draw.normal(size=(2, 2))
        fixes.append((arrival, valid, draw.normal(size=2) * 3.0 + 0.05 * valid, root @ root.T + 0.1 * np.eye(2)))
    return motions, fixes


NUMBERS = {
    "velocity_noise": 2e-3,
    "current_noise": 3e-5,
    "current_fading": 0.01,
    "initial_sigma": 2.0,
    "current_sigma": 0.3,
    "scale_sigma": 0.2,
    "heading_sigma": 0.1,
    "gate": 1e9,
}


def fly_law(motions, fixes, dt=0.1, **numbers):
    """Call the law tick by tick in plain Python; its last estimate and its memory."""
    memory = Replayed(*[np.array(v) if np.ndim(v) else v for v in Replayed()])
    told = {arrival: (valid, z, r) for arrival, valid, z, r in fixes}
    for tick, motion in enumerate(motions):
        fix = Fix()
        if tick in told:
            valid, z, r = told[tick]
            fix = Fix(z[0], z[1], (tick - valid) * dt, r[0, 0], r[0, 1], r[1, 1])
        estimate, memory = KALMAN(fix, motion, memory, dt, **(NUMBERS | numbers))
    return estimate, memory


def newest(memory):
    """Tick, state and covariance after the newest fix."""
    row = memory.fixes[: SLOT.width]

    def read(record):
        start = SLOT.offsets[record]
        return record(*row[start : start + len(record._fields)])

    return read(Moment), np.array(read(Mean)), full(read(Covariance))


def full(c):
    """(6, 6) covariance."""
    pp, cc, aa = ([[c[k], c[k + 1]], [c[k + 1], c[k + 2]]] for k in (0, 7, 18))
    pc, pa, ca = (np.reshape(c[k : k + 4], (2, 2)) for k in (3, 10, 14))
    return np.block([[np.array(pp), pc, pa], [pc.T, np.array(cc), ca], [pa.T, ca.T, np.array(aa)]])


@pytest.mark.parametrize("seed", range(2))
def test_replay_is_the_filter_that_had_its_fixes_in_time(seed):
    """Late and out of order, in closed form from fix to fix: what 6 x 6 matrices give tick by tick in order."""
    motions, fixes = scenario(seed)
    estimate, memory = fly_law(motions, fixes)
    other = StepByStep([4.0, 4.0, 0.09, 0.09, 0.04, 0.01], 2e-3, 3e-5, 0.01, 0.1)
    last = 0
    by_time = {valid: (z, r) for _, valid, z, r in fixes}
    moment, mean, covariance = newest(memory)
    for tick, motion in enumerate(motions):
        if tick in by_time:
            other.fix(*by_time[tick], (tick - last) * 0.1)
            last = tick
        if tick == moment.tick:
            assert mean == pytest.approx(other.x, abs=1e-9)
            assert covariance == pytest.approx(other.p, rel=1e-8, abs=1e-12)
        if tick < len(motions) - 1:
            other.step(*way_through_water(motion, 0.1))
    assert (estimate.north, estimate.east) == pytest.approx(other.x[:2], abs=1e-9)
    found = np.array([[estimate.north_variance, estimate.covariance], [estimate.covariance, estimate.east_variance]])
    assert found == pytest.approx(other.p[:2, :2], rel=1e-8)


def test_the_order_in_which_fixes_arrive_makes_no_difference():
    """To the last bit, as long as none arrives behind more than the filter keeps (and dt divides ages exactly)."""
    motions, fixes = scenario(7, count=300)
    few = fixes[:KEPT]
    draw = np.random.default_rng(8)
    found = []
    for _ in range(5):
        arrivals = 200 + draw.permutation(len(few))
        late = [(int(a), *fix[1:]) for a, fix in zip(arrivals, few, strict=True)]
        found.append(fly_law(motions, late, dt=0.125)[0])
    assert all(estimate == found[0] for estimate in found)


def test_a_fix_older_than_what_is_kept_is_left_out():
    """The ninth in line and one from beyond the memory of the way: neither changes anything."""
    motions, fixes = scenario(9, count=400)
    prompt = [(valid, valid, z, r) for _, valid, z, r in fixes if valid >= 40]
    late = (395, 22, np.array([50.0, 50.0]), np.eye(2))
    assert fly_law(motions, [*prompt, late])[0] == fly_law(motions, prompt)[0]
    beyond = [(396, 100, np.array([50.0, 50.0]), np.eye(2))]
    assert fly_law(motions, beyond)[0] == fly_law(motions, [])[0]


# ---- growth between fixes, the gate, and what it does when it is lost ------------------------------------------------


@pytest.mark.parametrize(("sigma", "time_constant"), [(0.05, 100.0), (0.2, 7.0), (0.1, 1e4)])
def test_covariance_grows_as_the_errors_of_dead_reckoning(sigma, time_constant):
    """Row T: 2 s^2 tc (t - tc (1 - exp(-t / tc))) where the velocity's error is Gauss-Markov; .4918 m after 10 s."""
    numbers = {
        "velocity_noise": 0.0,
        "current_fading": 1.0 / time_constant,
        "current_noise": 2.0 * sigma**2 / time_constant,
        "current_sigma": sigma,
        "initial_sigma": 0.0,
        "scale_sigma": 0.0,
        "heading_sigma": 0.0,
    }
    for seconds in (0.5, 10.0, 60.0):
        motions = scenario(1, count=round(seconds / 0.1) + 1)[0]
        estimate, _ = fly_law(motions, [], **numbers)
        lag = time_constant * -math.expm1(-seconds / time_constant)
        wanted = 2.0 * sigma**2 * time_constant * (seconds - lag)
        assert estimate.north_variance == pytest.approx(wanted, rel=1e-6 if seconds > 1.0 else 1e-4)
        assert estimate.east_variance == pytest.approx(wanted, rel=1e-6 if seconds > 1.0 else 1e-4)
        if (sigma, time_constant, seconds) == (0.05, 100.0, 10.0):
            assert math.sqrt(estimate.north_variance) == pytest.approx(0.4918037228, abs=5e-9)


STILL = Motion(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def still(places, ranges=(), **numbers):
    """A vehicle that lies still; a fix, or a range from there, every tenth tick, of 1 m^2; what it then believes."""
    memory = Replayed(*[np.array(v) if np.ndim(v) else v for v in Replayed()])
    found = []
    for (north, east), level_range in zip_longest(places, ranges, fillvalue=math.nan):
        for tick in range(10):
            fix = Fix(north, east, 0.0, 1.0, 0.0, 1.0, level_range) if tick == 9 else Fix()
            estimate, memory = KALMAN(fix, STILL, memory, 0.1, **numbers)
        found.append(estimate)
    return found


def test_an_outlier_is_not_believed():
    """One fix 30 m away changes nothing; the variance goes on growing; the next good one is believed."""
    found = still([*[(0.0, 0.0)] * 30, (30.0, 0.0), (0.3, 0.0)])
    assert abs(found[30].north) < 1e-9
    assert found[30].north_variance > found[29].north_variance
    assert found[31].north > 1e-3
    assert found[31].north_variance < found[30].north_variance


def test_the_gate_opens_with_every_fix_that_was_not_believed():
    """A place 8 sigma away is believed when it comes the second time in a row, one 50 m away only at the sixth."""
    near = still([*[(0.0, 0.0)] * 30, *[(6.0, 0.0)] * 2])
    assert abs(near[30].north) < 1e-9
    assert near[31].north > 0.5
    far = still([*[(0.0, 0.0)] * 30, *[(200.0, 0.0)] * 6])
    assert all(abs(e.north) < 1e-9 for e in far[30:35])
    assert far[35].north == pytest.approx(200.0, abs=0.01)
    assert far[35].north_variance == pytest.approx(1.0, rel=0.01)


def test_a_range_alone_does_not_restart_a_lost_filter():
    """Ranges put it 200 m away: it is not drawn onto their source, and the first position brings it home."""
    good, far = (0.0, 0.0), (30.0, 40.0)  # of the source, 50 m away; the ranges say 210 m
    lost = still([*[good] * 30, *[far] * 12], ranges=[math.nan] * 30 + [210.0] * 12)
    assert all(abs(e.north) < 1e-6 and abs(e.east) < 1e-6 for e in lost[30:37])
    assert min(math.dist((e.north, e.east), far) for e in lost) > 45.0
    found = still([*[good] * 30, *[far] * 7, (-96.0, -128.0)], ranges=[math.nan] * 30 + [210.0] * 7 + [math.nan])
    assert (found[-1].north, found[-1].east) == pytest.approx((-96.0, -128.0), abs=0.01)
    assert found[-1].north_variance == pytest.approx(1.0, rel=0.01)


def test_patience_is_one_at_least():
    """With 0 every fix would be believed and the filter started again at each: the last fix, not a filter."""
    with pytest.raises(LawError, match="patience = 0"):
        KALMAN.gains(0.1, patience=0.0)
    patient = still([*[(0.0, 0.0)] * 30, *[(200.0, 0.0)] * 2], patience=1.0)
    assert abs(patient[30].north) < 1e-9
    assert patient[31].north == pytest.approx(200.0, abs=0.01)


def test_a_fix_whose_time_was_rounded_up_is_one_of_now():
    """An age below zero is none: nothing is read from a place of the memory that is not written yet."""
    motions = scenario(4, count=300)[0]
    fixes = [(tick, np.array([5.0, 5.0])) for tick in range(20, 300, 30)]
    ends = []
    for age in (0.0, -0.15):
        memory = Replayed(*[np.array(v) if np.ndim(v) else v for v in Replayed()])
        told = dict(fixes)
        for tick, motion in enumerate(motions):
            fix = Fix(*told[tick], age, 1.0, 0.0, 1.0) if tick in told else Fix()
            estimate, memory = KALMAN(fix, motion, memory, 0.1, **NUMBERS)
        ends.append(estimate)
    assert ends[0] == ends[1]


def test_numbers_that_are_none_are_no_fix():
    """NaN in a fix or in its covariance: the first is no fix, the second is one of `fix_sigma`."""
    told = still([(1.0, 2.0)])
    memory = Replayed(*[np.array(v) if np.ndim(v) else v for v in Replayed()])
    for tick in range(10):
        estimate, memory = KALMAN(Fix(1.0, 2.0, 0.0) if tick == 9 else Fix(1.0, math.nan, 0.0), STILL, memory, 0.1)
    assert estimate == told[0]


# ---- calibration -----------------------------------------------------------------------------------------------------


def test_speed_scale_and_heading_are_found_in_turns():
    """A lawnmower by a vehicle that measures 1.3 times its speed and a heading 5 deg off, in a current."""
    draw = np.random.default_rng(3)
    scale, turn, current = 1.0 / 1.3, math.radians(5.0), np.array([0.1, -0.05])
    memory = Replayed(*[np.array(v) if np.ndim(v) else v for v in Replayed()])
    place, heading = np.zeros(2), 0.0
    for tick in range(3600):
        rate = 0.04 if (tick // 700) % 2 else 0.0
        measured = 0.6
        motion = Motion(
            heading, rate, measured, 0.0, measured * math.cos(heading), measured * math.sin(heading), 0.0, 0.0
        )
        fix = Fix(*(place + draw.normal(size=2) * 0.3), 0.0, 0.09, 0.0, 0.09) if tick % 20 == 0 else Fix()
        estimate, memory = KALMAN(fix, motion, memory, 0.1, scale_sigma=0.3, heading_sigma=0.1)
        course = heading + 0.05 * rate + turn
        place = place + 0.1 * (scale * measured * np.array([math.cos(course), math.sin(course)]) + current)
        heading += 0.1 * rate
    _, mean, covariance = newest(memory)
    wanted = np.array([*current, scale * math.cos(turn) - 1.0, scale * math.sin(turn)])
    sigmas = np.sqrt(np.diag(covariance)[2:])
    assert np.all(np.abs(mean[2:] - wanted) < 4.0 * sigmas)
    assert np.all(sigmas < [0.02, 0.02, 0.04, 0.03])
    assert np.hypot(estimate.north - place[0], estimate.east - place[1]) < 0.6


def test_memory_lies_where_it_is_said():
    """The engine keeps what the law says it keeps: the newest belief is found in the flown memory."""
    scene = Scene(duration=60.0)
    flown: Flown = fly(plan_for(scene, kalman(scene)))
    memory = memory_of(flown, "position")
    fixes = memory[-(KEPT + 1) * SLOT.width :]
    assert fixes[0] == 550.0  # tick of the newest fix: 55 s, come at 56 s
