"""Maneuvers of a vehicle that measures ranges: within its speed, and what each is worth to the one that is measured."""

import math

import numpy as np
import pytest

from cardume.missions.ranging.information import condition_number, log_determinant, mission_information
from cardume.missions.ranging.maneuvers import best_of, circle, fastest, spiral, steered, zigzag
from cardume.missions.ranging.range_filter import Doubt, known_start

TIMES = np.arange(0.0, 301.0, 2.0)
TARGET = 0.3 * TIMES[:, None] * np.array([math.cos(0.4), math.sin(0.4)])
PRIOR = np.diag([1 / 6.25, 1 / 6.25, 1 / 0.01, 1 / 0.01])  # 2.5 m and 0.1 m/s
SPEED = 0.7
START = np.array([-15.0, 10.0])


def maneuvers():
    return {
        "beside": TARGET + np.array([0.0, 20.0]),
        "circle": circle(TARGET, TIMES, radius=20.0, speed_max=SPEED, bearing=2.5),
        "spiral": spiral(TARGET, TIMES, radius=15.0, growth=0.05, speed_max=SPEED, bearing=2.5),
        "zigzag": zigzag(TARGET, TIMES, width=30.0, astern=15.0, speed_max=SPEED),
        "steered": steered(TARGET, TIMES, start=START, speed_max=SPEED, sigma=0.5, prior=PRIOR),
    }


def test_no_maneuver_is_faster_than_it_may_be():
    found = {name: fastest(track, TIMES) for name, track in maneuvers().items()}
    print(found)
    assert max(found.values()) <= 1.001 * SPEED
    assert min(found[name] for name in ("circle", "zigzag", "steered")) > 0.65


def test_shapes():
    """The circle keeps its distance, the spiral leaves by its growth, the zig-zag stays within its width."""
    made = maneuvers()
    assert np.hypot(*(made["circle"] - TARGET).T) == pytest.approx(np.full(len(TIMES), 20.0))
    assert np.hypot(*(made["spiral"] - TARGET).T) == pytest.approx(15.0 + 0.05 * TIMES)
    aside = (made["zigzag"] - TARGET) @ np.array([-math.sin(0.4), math.cos(0.4)])
    assert abs(aside).max() <= 15.0
    assert np.ptp(aside) > 25.0


def test_what_cannot_be_flown_is_refused():
    with pytest.raises(ValueError, match="the target goes at"):
        circle(TARGET, TIMES, radius=20.0, speed_max=0.3)
    with pytest.raises(ValueError, match="grow slower"):
        spiral(TARGET, TIMES, radius=20.0, growth=0.5, speed_max=0.7)
    with pytest.raises(ValueError, match="all of circle are faster"):
        best_of({"circle": maneuvers()["circle"]}, TARGET, TIMES, sigma=0.5, speed_max=0.5)


def test_keeping_beside_tells_least_and_looking_ahead_nearly_as_much_as_the_best():
    """The steered one has no closed form, begins elsewhere, and looks 80 s ahead."""
    made = maneuvers()
    choice = best_of(made, TARGET, TIMES, sigma=0.5, speed_max=SPEED, prior=PRIOR)
    print(choice)
    assert choice.told[choice.name] == max(choice.told.values())
    assert choice.told["steered"] > choice.told["zigzag"]
    assert choice.told["steered"] > choice.told[choice.name] - 0.8
    assert min(choice.told, key=lambda name: choice.told[name]) == "beside"
    conditions = {n: condition_number(mission_information(TIMES, TARGET - t, 0.5), 300.0) for n, t in made.items()}
    assert conditions["beside"] == math.inf
    assert max(c for n, c in conditions.items() if n != "beside") < 1000.0


def test_log_determinant_is_that_of_the_least_covariance():
    told = mission_information(TIMES, TARGET - maneuvers()["circle"], 0.5, PRIOR)
    assert log_determinant(told) == pytest.approx(-math.log(np.linalg.det(np.linalg.inv(told))))


def final_errors(track, runs, rng_seed):
    """[m] after 300 s, of a filter whose prior is the one above; the same noise for every maneuver."""
    found = []
    for run in range(runs):
        draw = np.random.default_rng([rng_seed, run])
        current, first = 0.1 * draw.normal(size=2), 2.5 * draw.normal(size=2)
        noise = 0.5 * draw.normal(size=len(TIMES))
        doubt = Doubt(position=2.5, current=0.1, turn=0.0, range=0.5, way=0.0, heading=0.0, gate=1e9)
        bank = known_start(*(TARGET[0] - first), 0.0, doubt)
        measured = TARGET - current * (TIMES - TIMES[-1])[:, None]  # the way through the water; it ends where planned
        shift = TARGET[-1] - measured[-1]
        truth = measured + current * (TIMES - TIMES[-1])[:, None] + shift
        for k in range(len(TIMES)):
            if k:
                bank.move(*(measured[k] - measured[k - 1]), TIMES[k] - TIMES[k - 1])
            bank.hear(float(np.hypot(*(truth[k] - track[k]))) + noise[k], *track[k])
        found.append(np.hypot(*(bank.mean[:2] - truth[-1])))
    return np.array(found)


def test_errors_follow_the_information():
    """The same noise for each: what is left is about what Cramer and Rao allow, and far below 1.2 m."""
    made, rms = maneuvers(), {}
    for name in ("circle", "zigzag", "steered"):
        rms[name] = math.sqrt(np.mean(final_errors(made[name], 30, 5) ** 2))
        told = mission_information(TIMES, TARGET - made[name], 0.5, PRIOR)
        least = math.sqrt(np.trace(np.linalg.inv(told)[:2, :2]))
        print(f"{name}: {rms[name]:.3f} m, least {least:.3f}")
        assert 0.85 * least < rms[name] < 1.4 * least
        assert rms[name] <= 1.2
