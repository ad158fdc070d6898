"""Packets without a code: what forged, replayed, truncated and damaged ones can do to a gated filter."""

import math

import numpy as np

from cardume.onboard.estimation.position.belief import Doubts, Moment, aged
from cardume.onboard.estimation.position.kalman_replay import Replayed, kalman_replay
from cardume.onboard.estimation.position.past_fixes import FIXES_WIDTH, KEPT, get_belief, get_moment
from cardume.onboard.messaging.codec import PacketError, decode, encode
from cardume.signals import NOTHING, Fix, Motion, NavigationEstimate, Report, Sighting

DT, SPEED, DIVER, HEAD = 0.1, 0.5, 1, 0  # [s], [m/s], numbers of vehicles
SIGMA, GATE = 1.0, 16.0  # [m] of a fix, [-]
DOUBTS = Doubts(4.0, 0.04, 0.0, 0.0, 3e-3, 1e-6, 0.0, SIGMA**2, GATE, 5.0)
NUMBERS = {"initial_sigma": 2.0, "current_sigma": 0.2, "gate": GATE, "fix_sigma": SIGMA}
NO_FIX = Fix(*[NOTHING] * len(Fix._fields))


class Diver:
    """A filter aboard a vehicle that goes north at 0.5 m/s in still water."""

    def __init__(self) -> None:
        self.memory = Replayed(*(np.array(v) if np.ndim(v) else v for v in Replayed()))
        self.ticks = 0

    def copy(self) -> "Diver":
        other = Diver()
        other.memory = self.memory._replace(
            norths=self.memory.norths.copy(), easts=self.memory.easts.copy(), fixes=self.memory.fixes.copy()
        )
        other.ticks = self.ticks
        return other

    @property
    def time(self) -> float:
        return DT * self.ticks

    def step(self, fix: Fix = NO_FIX) -> NavigationEstimate:
        motion = Motion(0.0, 0.0, SPEED, 0.0, SPEED, 0.0, 0.0, 0.0)
        estimate, self.memory = kalman_replay(fix, motion, self.memory, DT, **NUMBERS)
        self.ticks += 1
        return estimate

    def heard(self, packet: bytes) -> Fix:
        """The fix in a packet that nobody checked; none where it is no packet, or tells nothing of this vehicle."""
        try:
            seen = decode(packet, self.time).sightings.get(DIVER)
        except PacketError:
            return NO_FIX
        if seen is None or math.isnan(seen.north + seen.east + seen.time_of_fix):
            return NO_FIX
        return NO_FIX._replace(north=seen.north, east=seen.east, age=self.time - seen.time_of_fix)

    def most(self, fix: Fix) -> float:
        """How far a believed fix can move the estimate [m]: sqrt(gate) sigmas of what it is compared with, by now."""
        valid = self.memory.tick - fix.age / DT
        slot = next((k for k in range(KEPT + 1) if get_moment(self.memory.fixes, k).tick <= valid), KEPT)
        now = Moment(self.memory.tick, self.memory.way_north, self.memory.way_east, 0.0)
        believed = aged(get_belief(self.memory.fixes, slot), now, DOUBTS, DT).covariance
        spread = np.array([[believed.pp_nn, believed.pp_ne], [believed.pp_ne, believed.pp_ee]])
        return math.sqrt(GATE * float(np.linalg.eigvalsh(spread)[-1]))


def told(time: float, north: float, east: float, age: float = 0.4) -> bytes:
    """What the head says: of itself, and where it saw the diver."""
    return encode(
        HEAD,
        Report(1.0, round(10.0 * time), time, 0.0, 0.5, 4.0),
        [Sighting(north, east, time - age, 0.5 * time, 0.5, time - age, 4.0)],
    )


def settled(draw: np.random.Generator, heard: list[bytes]) -> Diver:
    """After a minute with a fix every five seconds."""
    diver = Diver()
    while diver.ticks < 600:
        fix = NO_FIX
        if diver.ticks % 50 == 49:
            where = SPEED * (diver.time - 0.4) + SIGMA * draw.normal(), SIGMA * draw.normal()
            heard.append(told(diver.time, *where))
            fix = diver.heard(heard[-1])
        diver.step(fix)
    return diver


def forge(draw: np.random.Generator, diver: Diver, heard: list[bytes]) -> bytes:
    """A forged, replayed, truncated or damaged packet."""
    kind, one = draw.integers(5), heard[draw.integers(len(heard))]
    if kind == 0:
        return draw.bytes(int(draw.choice([6, 13, 20])))
    if kind == 1:
        return one
    if kind == 2:
        return one[: draw.integers(len(one))]
    if kind == 3:
        bit = int(draw.integers(8 * len(one)))
        return (int.from_bytes(one, "big") ^ 1 << bit).to_bytes(len(one), "big")
    far = draw.choice([0.5, 2.0, 5.0, 20.0, 300.0])  # by one who knows nearly where the diver is
    return told(diver.time, *(far * draw.normal(size=2) + [SPEED * diver.time, 0.0]), age=draw.uniform(0.0, 5.0))


def test_no_bad_packet_of_ten_thousand_moves_a_filter_by_more_than_its_gate() -> None:
    draw = np.random.default_rng(8)
    heard: list[bytes] = []
    diver = settled(draw, heard)
    before = diver.copy().step()
    moved, believed = [], 0
    for _ in range(10_000):
        fix = diver.heard(forge(draw, diver, heard))
        after = diver.copy().step(fix)
        moved.append(math.hypot(after.north - before.north, after.east - before.east))
        if math.isnan(fix.north):
            assert moved[-1] == 0.0
        else:
            assert moved[-1] <= 1.001 * diver.most(fix), fix
            believed += moved[-1] > 0.0
    print(f"{believed} believed, at most {max(moved):.2f} m")
    assert believed > 500  # without a code nothing else keeps them out
    assert 0.3 < max(moved) < 4.0


def test_between_good_fixes_bad_ones_do_not_drive_it_off() -> None:
    """Three bad packets for each good one, for ten minutes: the filter stays where it is."""
    draw = np.random.default_rng(9)
    heard: list[bytes] = []
    diver, errors = settled(draw, heard), []
    while diver.ticks < 6600:
        fix = NO_FIX
        if diver.ticks % 50 == 49:
            packet = told(diver.time, SPEED * (diver.time - 0.4) + SIGMA * draw.normal(), SIGMA * draw.normal())
            heard = [*heard[-20:], packet]
            fix = diver.heard(packet)
        elif diver.ticks % 50 in (10, 20, 30):
            fix = diver.heard(forge(draw, diver, heard))
        estimate = diver.step(fix)
        errors.append(math.hypot(estimate.north - SPEED * (diver.time - DT), estimate.east))
    print(f"error RMS {np.sqrt(np.mean(np.square(errors))):.2f} m, at most {max(errors):.2f} m")
    assert max(errors) < 5.0
    assert np.sqrt(np.mean(np.square(errors))) < 2.0
    assert len(diver.memory.fixes) == FIXES_WIDTH
