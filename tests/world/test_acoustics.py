"""What becomes of a message."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st
from numba import config

from cardume.signals import Arrival, Link
from cardume.world.acoustics import bernoulli, ideal

draws = st.floats(0.0, 1.0, exclude_min=True, exclude_max=True)


@given(st.floats(0.0, 1e7), draws, draws)
def test_an_ideal_channel_delivers_at_once(distance: float, first: float, second: float) -> None:
    assert ideal(Link(distance, first, second)) == Arrival(0.0, 1.0)


@given(st.floats(0.0, 1e4), draws, st.floats(0.0, 5.0), st.floats(1400.0, 1600.0))
def test_what_arrives_has_travelled_at_the_speed_of_sound(
    distance: float, draw: float, delay: float, sound_speed: float
) -> None:
    arrival = bernoulli(Link(distance, draw, 0.5), 0.0, delay, sound_speed)
    assert arrival.delivered == 1.0
    assert arrival.delay == delay + distance / sound_speed


def test_by_default_only_time_is_lost() -> None:
    assert bernoulli(Link(750.0, 1e-300, 0.5)) == Arrival(0.3 + 0.5, 1.0)


@given(draws, draws)
def test_loss_is_a_threshold_on_the_first_draw(draw: float, loss: float) -> None:
    assert bernoulli(Link(10.0, draw, 0.5), loss).delivered == float(draw >= loss)
    assert bernoulli(Link(10.0, draw, 0.5), 0.0).delivered == 1.0
    assert bernoulli(Link(10.0, draw, 0.5), 1.0).delivered == 0.0


@pytest.mark.parametrize("loss", [0.05, 0.2, 0.5])
def test_messages_are_lost_as_often_as_said_and_independently(loss: float) -> None:
    arrived = np.array(
        [bernoulli(Link(10.0, d, 0.5), loss).delivered for d in np.random.default_rng(2).uniform(size=5000)]
    )
    spread = math.sqrt(loss * (1.0 - loss) / 5000.0)
    assert np.mean(arrived) == pytest.approx(1.0 - loss, abs=4.0 * spread)
    both_lost = np.mean((1.0 - arrived[1:]) * (1.0 - arrived[:-1]))
    assert both_lost == pytest.approx(loss**2, abs=4.0 * math.sqrt(loss**2 * (1.0 - loss**2) / 5000.0 * 2.0))


def test_beyond_its_range_everything_is_lost() -> None:
    assert bernoulli(Link(500.0, 0.5, 0.5), 0.0, 0.3, 1500.0, 500.0).delivered == 1.0
    assert bernoulli(Link(500.1, 0.5, 0.5), 0.0, 0.3, 1500.0, 500.0).delivered == 0.0


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compiles the laws")
@pytest.mark.parametrize("law", [ideal, bernoulli], ids=lambda law: law.name)
def test_the_laws_compile_for_one_mission_and_for_lanes(law) -> None:
    assert law.handle() > 0
    assert law.handle(lanes=True) > 0
