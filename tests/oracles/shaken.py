"""Flights of closed form II: one vehicle in a current that wanders, with rare fixes that come late or never."""

from collections.abc import Iterator
from dataclasses import replace
from statistics import NormalDist
from typing import NamedTuple

import numpy as np

from cardume.simulation.fly import Flown, fly_batch
from cardume.simulation.plan import Plan
from cardume.simulation.recording import CHANNELS, LOG, RECORDS
from oracles.aboard import plan_of

# Both axes are alike: the vehicle goes north-east, at 0.5 m/s along each, as one axis of row II does.
MISSION = """
cardume: 1
name: shaken
duration: {duration!r} s
tick: {tick!r} s
plant_step: {tick!r} s
log_period: {log_period!r} s
path: {{type: line, start: {{course: 45 deg}}, length: 500 m}}
formation: {{speed: 0.7071067811865476 m/s}}
model: kinematic
current: {{type: 'row_two:shaking', velocity_noise: {qv!r}, current_noise: {qc!r}}}
vehicles:
  - name: alone
    start: {{speed: 0.7071067811865476 m/s}}
    sensors:
      gnss: {{law: 'row_two:lossy', sigma: {sigma!r} m, period: {period!r} s, latency: {delay!r} s, lost_above: {lost}}}
      ahrs: {{heading_sigma: 0 deg, yaw_rate_sigma: 0 deg/s, attitude_sigma: 0 deg}}
      thruster_speed: {{sigma: 0, reader: proportional}}
guidance: {{law: line_of_sight, lookahead: 1e5 m}}    # so stiff that nothing steers
position: {position}
current_observer: {observer}
speed_reference: water
end: continue
"""
RESET, COMPENSATED = "{law: reset}", "{law: reset_compensated}"
TOLD = "{law: 'aids:told', speed: 0.1414213562373095 m/s, towards: 45 deg}"  # 0.1 m/s along each axis
NEVER = 1e9  # standard deviations


class Scene(NamedTuple):
    """What row II fixes, and what tests vary."""

    period: float = 5.0  # [s] T between fixes
    loss: float = 0.2  # p
    delay: float = 1.0  # [s] tau
    sigma: float = 1.0  # [m]
    qv: float = 1e-3  # [m^2/s]
    qc: float = 1e-6  # [m^2/s^3]
    duration: float = 600.0  # [s]
    tick: float = 0.1  # [s]
    log_period: float = 0.5  # [s]


def kalman(scene: Scene, **numbers: float) -> str:
    """The filter whose noise is the scene's; starts at P = diag(1, 0.04) as in row II."""
    chosen = {"velocity_noise": scene.qv, "current_noise": scene.qc, "initial_sigma": 1.0, "current_sigma": 0.2}
    return f"{{law: kalman_replay, {', '.join(f'{k}: {v!r}' for k, v in (chosen | numbers).items())}}}"


def plan_for(scene: Scene, position: str, observer: str = "none") -> Plan:
    """The scene with a position law and a current observer."""
    lost = NormalDist().inv_cdf(1.0 - scene.loss) if scene.loss > 0.0 else NEVER
    return plan_of(MISSION.format(**scene._asdict(), position=position, observer=observer, lost=lost))


def channel(flown: Flown, name: str, vehicle: int = 0) -> np.ndarray:
    """(time,) what was logged of one vehicle."""
    size, records = len(flown.plan.vehicles), int(flown.tables.counts[RECORDS])
    log = flown.tables.log.reshape(-1, size, LOG.width)[:records]
    return np.array(log[:, vehicle, CHANNELS.index(name)])


def flights(plan: Plan, seeds: range, portion: int = 50) -> Iterator[Flown]:
    """Fly a plan with every seed, a few at a time so that their logs fit into memory."""
    for first in range(seeds.start, seeds.stop, portion):
        some = range(first, min(first + portion, seeds.stop))
        yield from fly_batch([replace(plan, seed=seed) for seed in some])


def errors_of(flown: Flown, vehicle: int = 0) -> np.ndarray:
    """(time, 2) [m] believed less true position."""
    pairs = [channel(flown, f"{a}_estimate", vehicle) - channel(flown, a, vehicle) for a in ("north", "east")]
    return np.stack(pairs, axis=1)


def nees_of(flown: Flown, vehicle: int = 0) -> np.ndarray:
    """(time,) squared error of the position over its believed covariance, over 2: 1 on average where that is right."""
    north, east = errors_of(flown, vehicle).T
    nn, ne, ee = (channel(flown, c, vehicle) for c in ("north_variance", "north_east_covariance", "east_variance"))
    return np.asarray((ee * north**2 - 2.0 * ne * north * east + nn * east**2) / (nn * ee - ne**2) / 2.0)


def late_half(values: np.ndarray) -> np.ndarray:
    """The last half of a flight."""
    return values[len(values) // 2 :]
