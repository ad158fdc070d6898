"""The Doppler log of (32): what its errors make of the observer (33), and flying by velocity over ground."""

import math

import numpy as np
import pytest

from cardume.missions.available import catalog
from cardume.missions.checks import check_mission
from cardume.missions.loading import parse_mission
from flying import fly_text, limit, series, value_at

COURSE = math.radians(30.0)
EXACT = "gnss: {sigma: 0 m, period: TICK s}, ahrs: {heading_sigma: 0 deg, yaw_rate_sigma: 0 deg/s, period: TICK s}"
MISSION = """
cardume: 1
name: log
duration: {duration!r} s
tick: TICK s
plant_step: TICK s
log_period: {log_period} s
path: {{{path}}}
bathymetry: {{type: flat, depth: {seabed} m}}
formation: {{speed: 0.5 m/s}}
current: {{type: uniform, speed: {speed!r} m/s, towards: {towards!r} rad}}
guidance: {{law: line_of_sight, lookahead: 5 m}}
vehicles:
  - name: alone
    model: {model}
    depth: {depth!r} m
    start: {{speed: 0.5 m/s}}
    sensors: {{{sensors}, dvl: {{{dvl}}}}}
position: {position}
current_observer: {observer}
compensation: {compensation}
speed_reference: {reference}
end: continue
"""
LINE = "type: line, start: {course: 30 deg}, length: 100 m"


def text(
    dvl: str,
    current: tuple[float, float] = (0.06, -0.12),
    observer: str = "{law: complementary, k1: 0.2, k2: 0.01}",
    compensation: str = "none",
    duration: float = 200.0,
    tick: float = 0.1,
    path: str = LINE,
    model: str = "kinematic",
    depth: float = 0.0,
    sensors: str = EXACT,
    position: str = "direct",
    reference: str = "water",
    seabed: float = 20.0,
) -> str:
    """A vehicle with a Doppler log in a current (north, east) [m/s]."""
    return MISSION.format(
        duration=duration,
        log_period=1.0,
        path=path,
        speed=math.hypot(*current),
        towards=math.atan2(current[1], current[0]) % math.tau,
        model=model,
        depth=depth,
        sensors=sensors,
        dvl=dvl,
        position=position,
        observer=observer,
        compensation=compensation,
        reference=reference,
        seabed=seabed,
    ).replace("TICK", repr(tick))


def estimate(flight, time: float) -> complex:
    """The believed current, north + i east [m/s]."""
    return complex(*(value_at(flight, f"current_{axis}_estimate", time) for axis in ("north", "east")))


# ---- (33) with a disturbed velocity ----------------------------------------------------------------------------------

ERRORS = {
    "a bias": ("bias_surge: 0.03, bias_sway: -0.05", lambda v: 0.03 - 0.05j),
    "a scale": ("scale: 1.2", lambda v: 0.2 * v),
    "a twist": ("misalignment: 10 deg", lambda v: v * (np.exp(-1j * math.radians(10.0)) - 1.0)),
    "all": (
        "scale: 0.9, misalignment: -5 deg, bias_surge: 0.02",
        lambda v: 0.9 * v * np.exp(1j * math.radians(5.0)) + 0.02 - v,
    ),
}


@pytest.mark.parametrize("case", ERRORS)
def test_33_finds_the_current_less_the_disturbance(case: str) -> None:
    """(32), (33): p' = R v + Vc and p_hat' = k1 e + R v + V_d + Vhat rest where Vhat = Vc - V_d, not Vc + V_d."""
    keys, error = ERRORS[case]
    flight = fly_text(text(f"sigma: 0, period: TICK s, {keys}".replace("TICK", "0.1")))
    heading = value_at(flight, "heading", 199.0)
    disturbance = np.exp(1j * heading) * error(0.5)
    assert estimate(flight, 199.0) == pytest.approx(0.06 - 0.12j - disturbance, abs=2e-6)


def test_33_on_its_way_there() -> None:
    """Row J with Vc - V_d for Vc: k1 = 2 w, k2 = w^2: Vhat(t) = (Vc - V_d) (1 - (1 + w t) exp(-w t))."""
    w, time = 0.1, 20.0
    parallel = "path: {" + LINE + "}\nguidance: {law: 'aids:parallel'}"

    def found(tick: float) -> complex:
        written = text(f"sigma: 0, bias_surge: 0.03, bias_sway: -0.05, period: {tick} s", duration=21.0, tick=tick)
        written = written.replace("guidance: {law: line_of_sight, lookahead: 5 m}", parallel.split("\n")[1])
        return estimate(fly_text(written), time)

    aim = 0.06 - 0.12j - np.exp(1j * COURSE) * (0.03 - 0.05j)
    expected = aim * (1.0 - (1.0 + w * time) * math.exp(-w * time))
    for part in (np.real, np.imag):
        value, order = limit(lambda tick, part=part: float(part(found(tick))))
        assert value == pytest.approx(float(part(expected)), abs=1e-6)
        assert order == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("turn", ["starboard", "port"])
def test_33_in_a_turn_a_bias_is_a_disturbance_that_turns(turn: str) -> None:
    """V_d = R(psi) b turns at r: |Vhat - Vc| = k2 |b| / sqrt((k2 - r^2)^2 + k1^2 r^2), row L with |b| for |1 - a| u."""
    k1, k2, radius, bias = 0.2, 0.01, 20.0, math.hypot(0.03, -0.05)
    path = f"type: circle, centre: {{north: 0, east: 0}}, radius: {radius}, turn: {turn}"
    r = 0.5 / radius

    def found(tick: float) -> float:
        dvl = f"sigma: 0, bias_surge: 0.03, bias_sway: -0.05, period: {tick} s"
        return abs(estimate(fly_text(text(dvl, (0.0, 0.0), path=path, duration=201.0, tick=tick)), 200.0))

    value, _ = limit(found, (0.2, 0.1, 0.05))
    assert value == pytest.approx(k2 * bias / math.sqrt((k2 - r * r) ** 2 + (k1 * r) ** 2), rel=1e-3)


def test_a_biased_log_is_no_harm_to_the_path_if_heading_and_observer_use_the_same() -> None:
    """V_m + Vhat is the true velocity, so crab with the same (u, v) holds the line; without the sway it cannot."""
    dvl = "sigma: 0, scale: 1.2, bias_sway: -0.05, period: 0.1 s"
    same = fly_text(text(dvl, compensation="{law: crab, use_sway: 1}", duration=400.0))
    assert abs(value_at(same, "cross_track", 399.0)) < 1e-6
    without = fly_text(text(dvl, compensation="{law: crab}", duration=400.0))
    assert abs(value_at(without, "cross_track", 399.0)) > 0.2


# ---- bottom track ----------------------------------------------------------------------------------------------------

BOTTOM = "law: bottom_track, sigma: 0, period: 0.1 s"
STEERS = "{law: crab, use_sway: 1}"


@pytest.mark.parametrize("current", [(0.06, -0.12), (-0.1, 0.1), (0.0, 0.2)])
def test_with_bottom_track_the_path_is_held_without_an_observer(current: tuple[float, float]) -> None:
    """psi_d = chi_d - atan2(v_g, u_g) by the drift angle measured over ground: no offset, whatever the current."""
    flight = fly_text(text(BOTTOM, current, observer="none", compensation=STEERS))
    assert abs(value_at(flight, "cross_track", 199.0)) < 1e-6
    blind = fly_text(text("sigma: 0, period: 0.1 s", current, observer="none", compensation=STEERS))
    assert abs(value_at(blind, "cross_track", 199.0)) > 0.3


def test_with_bottom_track_the_observer_finds_no_current() -> None:
    """V_d = Vc in (32), so Vhat = Vc - V_d = 0."""
    flight = fly_text(text(BOTTOM, compensation=STEERS))
    assert abs(estimate(flight, 199.0)) < 1e-6
    assert abs(value_at(flight, "cross_track", 199.0)) < 1e-6


def test_a_medusa_with_bottom_track_holds_path_and_speed_over_ground() -> None:
    aboard = EXACT + ", depth: {sigma: 0 m}, thruster_speed: {sigma: 0}"
    flight = fly_text(
        text(BOTTOM, observer="none", compensation=STEERS, model="medusa", sensors=aboard, reference="ground")
    )
    assert abs(value_at(flight, "cross_track", 199.0)) < 0.01
    assert value_at(flight, "speed", 199.0) == pytest.approx(0.5, abs=5e-3)
    assert value_at(flight, "surge", 199.0) != pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize(("dvl", "lost"), [(BOTTOM, 0.0), ("sigma: 0, period: 0.1 s", math.hypot(0.06, 0.12) * 150.0)])
def test_dead_reckoning_under_water(dvl: str, lost: float) -> None:
    """No fix ever comes: over ground nothing is lost, through the water the current's way is."""
    sensors = "ahrs: {heading_sigma: 0 deg, yaw_rate_sigma: 0 deg/s, period: 0.1 s}, depth: {}"
    flight = fly_text(
        text(dvl, observer="none", compensation=STEERS, duration=151.0, depth=5.0, sensors=sensors, position="reset")
    )
    errors = [value_at(flight, a, 150.0) - value_at(flight, f"{a}_estimate", 150.0) for a in ("north", "east")]
    assert math.hypot(*errors) == pytest.approx(lost, abs=0.05)


def test_out_of_range_of_the_seabed_the_shafts_tell_the_speed() -> None:
    """At 5 m over 40 m of water the log hears nothing; what is left is dead reckoning through the water."""
    sensors = "ahrs: {heading_sigma: 0 deg, yaw_rate_sigma: 0 deg/s, period: 0.1 s}, thruster_speed: {sigma: 0}"
    written = text(
        BOTTOM,
        seabed=40.0,
        observer="none",
        compensation=STEERS,
        duration=151.0,
        depth=5.0,
        sensors=sensors,
        position="reset",
    )
    flight = fly_text(written)
    errors = [value_at(flight, a, 150.0) - value_at(flight, f"{a}_estimate", 150.0) for a in ("north", "east")]
    assert math.hypot(*errors) == pytest.approx(math.hypot(0.06, 0.12) * 150.0, abs=0.05)
    found = [f for f in check_mission(parse_mission(written, catalog())) if "hears the seabed" in f.message]
    assert [f.level for f in found] == ["warning"]
    assert found[0].suggestion.endswith("dvl.range=35 m")
    (found,) = [f for f in check_mission(parse_mission(written, catalog(), ["bathymetry=none"])) if f.level == "error"]
    assert found.key == "bathymetry"


def test_check_knows_that_bottom_track_needs_a_crab_with_sway() -> None:
    written = text(BOTTOM, observer="none", compensation="{law: crab}")
    (found,) = [f for f in check_mission(parse_mission(written, catalog())) if "over ground how it drifts" in f.message]
    assert found.suggestion == "compensation.law=crab and compensation.use_sway=1"
    mended = text(BOTTOM, observer="none", compensation=STEERS)
    assert not [f for f in check_mission(parse_mission(mended, catalog())) if f.key.startswith("compensation")]


def test_pings_that_fail_leave_the_last_good_reading() -> None:
    """A tenth of the pings lost, as DUNE has it, costs a steady vehicle nothing; not held, or all lost, they do."""
    flight = fly_text(text(BOTTOM + ", invalid: 0.1", observer="none", compensation=STEERS))
    _, errors = series(flight, "cross_track")
    assert np.abs(errors[-50:]).max() < 1e-3
    for lossy in ("invalid: 0.1, hold: 0 s", "invalid: 1"):
        flight = fly_text(text(f"{BOTTOM}, {lossy}", observer="none", compensation=STEERS, duration=60.0))
        assert np.abs(series(flight, "cross_track")[1][-50:]).max() > 0.02
