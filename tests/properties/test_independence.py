"""Must show 4, with noise and losses: what does not concern a vehicle changes none of its bits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings, strategies as st

from cardume.simulation.flight import CHANNELS, MESSAGE_COLUMNS, Flight
from flying import fly_text
from properties.flown import different_channels, same_bits

MISSION = """
cardume: 1
name: independent
seed: {seed}
duration: 60 s
path: {{type: lawnmower, start: {{north: 0 m, east: 0 m, course: 20 deg}}, leg: 15 m, legs: 3, spacing: 20 m}}
formation: {{speed: 0.5 m/s}}
current: {{type: uniform, speed: 0.1 m/s, towards: 60 deg, variation_sigma: 0.02 m/s}}
model: medusa
compensation: {{law: crab}}
current_observer: {{law: complementary}}
position: {{law: reset_compensated}}
coordination: {{law: laplacian_tanh, topology: {topology}}}
messaging: {{schedule: periodic, period: 1 s}}
acoustics: {{channel: bernoulli, loss: 0.25, delay: 0.3 s}}
vehicles:
"""
BODIES = {
    "surface": "start: {cross_track: 2 m, speed: 0.2 m/s}",
    "port": "depth: 4 m, offset: {starboard: -3 m}, start: {cross_track: -1 m}",
    "starboard": "depth: 4 m, offset: {starboard: 3 m}, start: {cross_track: 1 m}",
    "zulu": "model: kinematic, offset: {ahead: -4 m}, start: {along_track: -2 m, speed: 0.5 m/s}",
}
SENSORS = {
    "surface": "gnss: {correlated_sigma: 0.3 m}, usbl: {}, ahrs: {}, depth: {}, thruster_speed: {}",
    "port": "ahrs: {}, depth: {}, thruster_speed: {}",
    "starboard": "ahrs: {}, depth: {}, thruster_speed: {}",
    "zulu": "gnss: {}, ahrs: {}, thruster_speed: {}",
}


def member(name: str, also: str = "") -> str:
    """One of the fleet, with one more sensor."""
    carried = ", ".join(s for s in (SENSORS[name], also) if s)
    return f"{{name: {name}, {BODIES[name]}, sensors: {{{carried}}}}}"


MEMBERS = {name: member(name) for name in BODIES}
HEARS = {  # the row's vehicle coordinates with those listed
    "surface": ("port", "starboard"),
    "port": ("surface",),
    "starboard": ("surface", "zulu"),
    "zulu": ("port",),
}
few = settings(max_examples=25, suppress_health_check=list(HealthCheck), phases=(Phase.reuse, Phase.generate))


def mission(
    names: Sequence[str], members: dict[str, str] = MEMBERS, hears: dict[str, Sequence[str]] = HEARS, seed: int = 3
) -> str:
    """The mission of some of the members, in some order."""
    matrix = [[float(other in hears[name]) for other in names] for name in names]
    return MISSION.format(seed=seed, topology=matrix) + "\n".join(f"  - {members[name]}" for name in names)


def heard(flight: Flight, names: Sequence[str]) -> list[tuple[object, ...]]:
    """The messages among some vehicles, by name, in the order of time."""
    columns = [flight.messages[c] for c in MESSAGE_COLUMNS]
    place = {c: k for k, c in enumerate(MESSAGE_COLUMNS)}
    rows = []
    for row in zip(*columns, strict=True):
        sender, receiver = (flight.vehicle_names[int(row[place[c]])] for c in ("sender", "receiver"))
        if sender in names and receiver in names:
            times = [float(row[place[c]]) for c in ("time_sent", "time_received", "time_of_validity")]
            rows.append((times[0], sender, receiver, bool(row[place["lost"]]), repr(times)))
    return sorted(rows)


def assert_same(one: Flight, other: Flight, names: Sequence[str], also_formation: bool = True) -> None:
    """Check that two flights tell the same of these vehicles, bit by bit."""
    assert one.reason == other.reason == "completed"
    assert different_channels(one, other, names) == []
    assert heard(one, names) == heard(other, names)
    assert len(heard(one, names)) > 100
    here, there = ([f.vehicle_names.index(n) for n in names] for f in (one, other))
    known = one.neighbor_state_estimate[:, here][:, :, here], other.neighbor_state_estimate[:, there][:, :, there]
    assert same_bits(known[0].copy(), known[1].copy())
    for name in names:
        for metric, value in one.metrics.vehicles[name].items():
            if also_formation or not metric.startswith("formation"):
                assert same_bits(np.array(value), np.array(other.metrics.vehicles[name][metric])), (name, metric)


@few
@given(order=st.permutations(list(MEMBERS)), seed=st.integers(0, 2**63 - 1))
def test_the_order_of_the_fleet_in_the_file_changes_nothing(order: list[str], seed: int) -> None:
    one, other = fly_text(mission(list(MEMBERS), seed=seed)), fly_text(mission(order, seed=seed))
    assert_same(one, other, list(MEMBERS))
    assert dict(one.metrics.fleet) == dict(other.metrics.fleet)


@few
@given(
    name=st.sampled_from(["aardvark", "quebec", "zz-top"]),  # first, amid and last in the engine
    hears=st.lists(st.sampled_from(list(MEMBERS)), unique=True),
    depth=st.sampled_from([0.0, 3.0]),
    period=st.sampled_from(["0.1 s", "0.5 s", "2.3 s"]),
    latency=st.sampled_from(["0 s", "0.7 s", "2 s"]),
    place=st.integers(0, 4),
)
def test_a_vehicle_nobody_hears_changes_nothing(
    name: str, hears: list[str], depth: float, period: str, latency: str, place: int
) -> None:
    """Whatever it hears itself, how often it speaks and how late its sensors are."""
    gnss = f"gnss: {{latency: {latency}}}, " if depth == 0.0 else ""
    new = (
        f"{{name: {name}, depth: {depth} m, offset: {{starboard: 6 m, ahead: 1 m}}, messaging: {{period: {period}}},"
        f" sensors: {{{gnss}ahrs: {{}}, depth: {{latency: {latency}}}, thruster_speed: {{}}}},"
        " guidance: {law: arcsine}}"
    )
    names = list(MEMBERS)
    names.insert(place, name)
    one = fly_text(mission(list(MEMBERS)))
    other = fly_text(mission(names, MEMBERS | {name: new}, HEARS | {name: hears}))
    assert_same(one, other, list(MEMBERS), also_formation=False)  # the formation has one more


UNREAD = {
    "a depth sensor of a kinematic vehicle, whose depth nobody controls": (
        "zulu",
        "depth: {sigma: 5 m, period: 0.3 s, latency: 1.7 s}",
    ),
    "a gnss under water, which hears no satellite": (
        "port",
        "gnss: {sigma: 9 m, correlated_sigma: 5 m, latency: 0.4 s}",
    ),
}


@pytest.mark.parametrize("what", UNREAD)
def test_a_sensor_nobody_reads_changes_nothing(what: str) -> None:
    name, sensor = UNREAD[what]
    flights = [fly_text(mission(list(MEMBERS), MEMBERS | {name: member(name, also)})) for also in ("", sensor)]
    assert_same(*flights, list(MEMBERS))


def test_a_sensor_that_is_read_changes_bits() -> None:
    flights = [fly_text(mission(list(MEMBERS), MEMBERS | {"port": member("port", also)})) for also in ("", "dvl: {}")]
    assert different_channels(*flights, ["port"])


def test_a_usbl_head_of_a_vehicle_that_neither_tells_nor_coordinates_changes_nothing() -> None:
    hermit = "{name: hermit, offset: {starboard: 6 m}, messaging: none, sensors: {gnss: {}, ahrs: {}, depth: {}%s}}"
    names = [*MEMBERS, "hermit"]
    hears = HEARS | {"hermit": ()}
    flights = [
        fly_text(mission(names, MEMBERS | {"hermit": hermit % head}, hears))
        for head in ("", ", usbl: {range_sigma: 3 m, latency: 1.3 s}")
    ]
    assert_same(*flights, names)


@pytest.mark.parametrize("period", ["0.1 s", "0.7 s", "20 s"])
def test_the_period_of_the_log_changes_nothing(period: str) -> None:
    one = fly_text(mission(list(MEMBERS)), ["log_period=0.1 s"])
    other = fly_text(mission(list(MEMBERS)), [f"log_period={period}"])
    step = round(float(period.split()[0]) / 0.1)
    for channel in CHANNELS:
        assert same_bits(one.channels[channel][::step].copy(), other.channels[channel].copy()), channel
    assert other.times.tolist() == pytest.approx(one.times[::step].tolist())
    assert one.metrics == other.metrics
    assert heard(one, list(MEMBERS)) == heard(other, list(MEMBERS))


def test_another_seed_changes_every_vehicle() -> None:
    one, other = fly_text(mission(list(MEMBERS))), fly_text(mission(list(MEMBERS), seed=4))
    assert {line.split()[-1] for line in different_channels(one, other, list(MEMBERS))} == set(MEMBERS)
