"""docs/theory/medusa-calibration.md: every number of its table, from the models and the published calibrations."""

import re
from pathlib import Path

import numpy as np
import pytest

from cardume.laws import Law
from cardume.signals import Command, VesselState, Water
from cardume.vehicles import medusa, medusa_2013
from cardume.vehicles.thrusters import SLOTS, Thrusters
from flying import fly_text, series

PAGE = (Path(__file__).parents[2] / "docs" / "theory" / "medusa-calibration.md").read_text(encoding="utf-8")
ROWS = [
    [float(x) for x in re.findall(r"\d+\.?\d*", line)] for line in PAGE.splitlines() if re.match(r"\| \d+ \|", line)
]
SURGE_TO_RPM = 101.0  # percent per m/s
SMITH = 0.0006641 / (1.0 - 0.6368 - 0.2936)  # m/s per percent


def steady(model: Law, thrust: float) -> VesselState:
    """A model after two minutes of a thrust [N]."""
    vessel, memory = VesselState(surge=0.3), Thrusters(commands=np.zeros(3 * SLOTS))
    for _ in range(1200):
        vessel, memory = model(vessel, Command(thrust, 0.0, 0.0), Water(), memory, 0.1)
    return vessel


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row[0]:.0f}%")
def test_the_table_is_what_the_models_do(row: list[float]) -> None:
    percent, rpm, thrust, by_farol, by_simulink, by_surge_to_rpm, by_smith, low, high = row
    assert rpm == 45.0 * percent
    one, other = steady(medusa, 2.0 * 1.77778e-6 * rpm**2), steady(medusa_2013, 2.0 * 4.0 / 1500.0**2 * rpm**2)
    for vessel in (one, other):
        assert vessel.shaft_speed * 30.0 / np.pi == pytest.approx(rpm, rel=1e-6)
        assert vessel.thrust == pytest.approx(thrust, abs=6e-4)
    assert one.surge == pytest.approx(by_farol, abs=6e-4)
    assert other.surge == pytest.approx(by_simulink, abs=6e-4)
    assert percent / SURGE_TO_RPM == pytest.approx(by_surge_to_rpm, abs=6e-4)
    assert percent * SMITH == pytest.approx(by_smith, abs=6e-4)
    ratios = [u / v for u in (one.surge, other.surge) for v in (percent / SURGE_TO_RPM, percent * SMITH)]
    assert (min(ratios), sorted(ratios)[-1]) == pytest.approx((low, high), abs=6e-3)


def test_the_table_is_there() -> None:
    assert [row[0] for row in ROWS] == [10.0, 20.0, 40.0, 60.0, 80.0, 100.0]


def test_what_would_reconcile_them() -> None:
    ratio = steady(medusa, 25.92).surge / (60.0 / SURGE_TO_RPM)
    assert ratio == pytest.approx(1.634, abs=1e-3)
    assert 27.5 * ratio**2 == pytest.approx(73.4, abs=0.1)
    assert 1.0 / ratio**2 == pytest.approx(0.375, abs=1e-3)
    assert 1.0 / ratio == pytest.approx(0.612, abs=1e-3)
    assert 1.0 / SMITH == pytest.approx(104.8, abs=0.05)


@pytest.mark.parametrize(("scale", "speed", "ghost"), [(1.634, 0.306, -0.194), (0.612, 0.817, 0.317)])
def test_what_it_does_to_a_mission(scale: float, speed: float, ghost: float) -> None:
    """a = 1.634 or 0.612: asked for 0.5 m/s it goes 0.5 / a, and believes in a current of (1 - a) u ahead."""
    exact = "gnss: {sigma: 0 m, period: 0.1 s}, ahrs: {heading_sigma: 0 deg, yaw_rate_sigma: 0 deg/s}"
    flight = fly_text(f"""
cardume: 1
name: ghost
duration: 300 s
path: {{type: line, length: 400 m}}
formation: {{speed: 0.5 m/s}}
vehicles: [{{name: auv, sensors: {{{exact}, thruster_speed: {{sigma: 0, scale: {scale}}}}}}}]
current_observer: {{law: complementary, k1: 0.5 1/s, k2: 0.06 1/s^2}}
compensation: crab
speed_reference: water
""")
    _, surge = series(flight, "surge")
    _, current = series(flight, "current_north_estimate")
    _, error = series(flight, "cross_track")
    assert surge[-1] == pytest.approx(speed, abs=0.004)
    assert current[-1] == pytest.approx(ghost, abs=0.004)
    assert current[-1] == pytest.approx((1.0 - scale) * surge[-1], abs=0.002)
    assert abs(error[-1]) < 0.01
