"""Calibration: known scales, drags and currents come back, as often as the intervals say, and bad files are refused."""

import functools
import json
import math
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.stats import binom, t as students_t

from cardume.cli.main import cli
from cardume.errors import DataError
from cardume.missions.available import catalog
from cardume.missions.calibration import Calibration, Numbers, Track, calibrate, read_tracks
from cardume.missions.calibration.fit import calibrated_speed, student
from cardume.missions.loading import parse_mission
from cardume.missions.log import write_log
from cardume.missions.mission import Mission
from cardume.simulation.flight import Flight
from flying import fly_text

RPM = math.pi / 30.0
LEGS = tuple((800.0 + 500.0 * (k % 3), 90.0 * k) for k in range(8))  # rpm and heading [deg] of each leg of 60 s


def parsed(text: str) -> Mission:
    return parse_mission(text, catalog())


def track(
    seed: int = 0,
    scale: float = 1.0,
    current: tuple[float, float] = (0.06, -0.1),
    position_sigma: float = 0.5,
    heading_sigma: float = 0.0,
    memory: float = 0.0,
    legs: tuple[tuple[float, float], ...] = LEGS,
    by_speed: float = 0.0,
    drag: tuple[float, float] | None = None,
) -> Track:
    """A vehicle that goes leg by leg, turning and changing its speed at once, as its sensors see it each second.

    Args:
        seed: of the noise.
        scale: true speed over that of the believed calibration.
        current: [m/s] north, east.
        position_sigma: [m]
        heading_sigma: [rad]
        memory: [s] of the noise of position; 0 is white.
        legs: rpm and heading [deg].
        by_speed: [m/s] sigma of a measured speed, instead of a track.
        drag: [N s/m], [N s^2/m^2] the true one, instead of a scale.
    """
    random, numbers, fine = np.random.default_rng(seed), Numbers(), 10
    shaft = np.repeat([rpm * RPM for rpm, _ in legs], 60 * fine)
    heading = np.repeat([math.radians(course) for _, course in legs], 60 * fine)
    thrust = numbers.thrust(shaft)
    speed = calibrated_speed(thrust, *drag) if drag else scale * calibrated_speed(thrust, 0.0, numbers.quadratic_drag)
    way = [np.cumsum(speed * f(heading) + c) / fine for f, c in zip((np.cos, np.sin), current, strict=True)]
    rows = slice(None, None, fine)
    noise = random.normal(size=(2, len(shaft[rows])))
    if memory:
        keep = math.exp(-1.0 / memory)
        for k in range(1, noise.shape[1]):
            noise[:, k] = keep * noise[:, k - 1] + math.sqrt(1.0 - keep**2) * noise[:, k]
    time = np.arange(len(shaft[rows]), dtype=float)
    common = {"name": "auv", "numbers": numbers, "time": time, "shaft_speed": shaft[rows]}
    if by_speed:
        return Track(**common, speed=speed[rows] + by_speed * random.normal(size=len(time)))
    return Track(
        **common,
        heading=heading[rows] + heading_sigma * random.normal(size=len(time)),
        north=way[0][rows] + position_sigma * noise[0],
        east=way[1][rows] + position_sigma * noise[1],
    )


# ---- known truths ----------------------------------------------------------------------------------------------------


def test_without_noise_scale_and_current_come_back() -> None:
    found = calibrate(track(scale=0.93, position_sigma=0.0))
    assert found.scale.value == pytest.approx(0.93, abs=1e-6)
    assert found.current_north is not None
    assert found.current_east is not None
    assert (found.current_north.value, found.current_east.value) == pytest.approx((0.06, -0.1), abs=1e-6)
    assert found.num_legs == 8
    assert found.residual < 1e-4
    assert found.explained > 0.999999
    assert not found.warnings


def test_without_noise_the_drag_comes_back() -> None:
    found = calibrate(track(drag=(3.0, 21.0), position_sigma=0.0))
    assert found.linear_drag is not None
    assert found.quadratic_drag is not None
    assert (found.linear_drag.value, found.quadratic_drag.value) == pytest.approx((3.0, 21.0), abs=1e-4)
    assert found.drag_residual < 1e-3 * found.residual


def test_drag_never_turns_negative() -> None:
    for seed in range(8):
        found = calibrate(track(seed, drag=(0.0, 27.5), position_sigma=1.0))
        assert found.linear_drag is not None
        assert found.linear_drag.value >= 0.0
        assert found.quadratic_drag is not None
        assert found.quadratic_drag.holds(27.5) or found.linear_drag.value > 0.0


def test_by_a_measured_speed() -> None:
    found = calibrate(track(scale=1.2, by_speed=0.02))
    assert found.current_north is None
    assert found.scale.value == pytest.approx(1.2, abs=0.01)
    assert found.scale.holds(1.2)


def test_astern_is_the_same_relation() -> None:
    found = calibrate(track(scale=1.1, position_sigma=0.0, legs=tuple((-rpm, h) for rpm, h in LEGS)))
    assert found.scale.value == pytest.approx(1.1, abs=1e-6)


# ---- intervals -------------------------------------------------------------------------------------------------------

SEEDS = 80
CASES = {
    "white": {"scale": 0.9},
    "a noisy compass": {"scale": 1.1, "heading_sigma": math.radians(2.0), "position_sigma": 0.2},
    "noise that remembers": {"scale": 1.0, "memory": 10.0},
    "a measured speed": {"scale": 1.05, "by_speed": 0.03},
}


@functools.cache
def found(case: str) -> tuple[Calibration, ...]:
    return tuple(calibrate(track(seed, **CASES[case])) for seed in range(SEEDS))


@pytest.mark.parametrize("case", CASES)
def test_intervals_hold_the_truth_as_often_as_they_say(case: str) -> None:
    """95 % or more of the intervals, to the luck of 80 draws (one in a thousand), and none much too wide."""
    truth = CASES[case]["scale"]
    held = sum(c.scale.holds(truth) for c in found(case))
    assert held >= binom.ppf(0.001, SEEDS, 0.95)
    values, halves = np.array([(c.scale.value, c.scale.half_width) for c in found(case)]).T
    assert values.mean() == pytest.approx(truth, abs=4.0 * values.std() / math.sqrt(SEEDS) + 1e-3)
    assert np.median(halves) < 2.0 * 1.96 * values.std()


def test_intervals_of_the_current_hold_it() -> None:
    held = [c.current_east.holds(-0.1) for c in found("white") if c.current_east is not None]
    assert sum(held) >= binom.ppf(0.001, SEEDS, 0.95)


def test_intervals_of_the_drag_hold_it() -> None:
    cases = [calibrate(track(seed, drag=(3.0, 21.0), position_sigma=0.3)) for seed in range(40)]
    for name, truth in (("linear_drag", 3.0), ("quadratic_drag", 21.0)):
        assert sum(getattr(c, name).holds(truth) for c in cases) >= binom.ppf(0.001, 40, 0.95)


@pytest.mark.parametrize("freedom", [3, 5, 7, 20, 300])
def test_students_quantile(freedom: int) -> None:
    assert student(freedom) == pytest.approx(students_t.ppf(0.975, freedom), rel=0.01)


# ---- what the data cannot tell ---------------------------------------------------------------------------------------


def test_one_heading_and_one_speed_tell_nothing() -> None:
    found = calibrate(track(legs=((1400.0, 30.0),) * 6))
    assert not found.is_usable
    assert not found.scale.is_known
    assert found.linear_drag is None
    text = " ".join(found.warnings)
    assert "hard to tell apart" in text
    assert "nearly the same speed" in text
    assert "not known well enough" in text


def test_to_and_fro_at_one_speed_tells_the_scale_but_no_drag() -> None:
    found = calibrate(track(legs=((1400.0, 30.0), (1400.0, 210.0)) * 4, scale=0.9))
    assert found.is_usable
    assert found.scale.holds(0.9)
    assert found.linear_drag is None
    assert len(found.warnings) == 1


def test_turns_and_changes_of_speed_are_left_out() -> None:
    whole = track(position_sigma=0.0)
    time = whole.time
    near_a_turn = (np.minimum(time % 60.0, 60.0 - time % 60.0) < 4.0) & (time > 30.0) & (time < 450.0)
    assert whole.north is not None
    north = np.where(near_a_turn, whole.north + 20.0, whole.north)  # whatever happens there
    found = calibrate(
        Track(
            name="auv",
            numbers=whole.numbers,
            time=time,
            shaft_speed=whole.shaft_speed,
            heading=whole.heading,
            north=north,
            east=whole.east,
        )
    )
    assert found.scale.value == pytest.approx(1.0, abs=1e-6)
    assert found.used < 8 * 60.0 - 8 * 10.0


def test_a_vehicle_that_only_turns_is_refused() -> None:
    time = np.arange(300.0)
    round_and_round = Track(
        name="spinner",
        numbers=Numbers(),
        time=time,
        shaft_speed=np.full(300, 100.0),
        heading=0.05 * time,
        north=np.sin(0.05 * time),
        east=np.cos(0.05 * time),
    )
    with pytest.raises(DataError, match="spinner has no steady part"):
        calibrate(round_and_round)


# ---- flown by the engine ---------------------------------------------------------------------------------------------

SQUARE = """
cardume: 1
name: square
duration: 1000 s
path: {type: segments, segments: [SEGMENTS]}
formation: {speed: 0.5 m/s}
current: {type: uniform, speed: 0.1 m/s, towards: 300 deg}
model: {law: medusa, thrust_coefficient: COEFFICIENT N s^2/rad^2}
vehicles: [{name: auv, sensors: {gnss: {sigma: 0.5 m}, ahrs: {}, depth: {}, thruster_speed: {scale: SCALE}}}]
guidance: {law: line_of_sight, lookahead: 5 m}
end: continue
"""


@functools.cache
def flown(stronger: float, scale: float = 1.0) -> tuple[Flight, str]:
    """A MEDUSA whose thrusters are stronger by a factor, on legs of several speeds to all sides, and its mission."""
    speeds = (0.4, 0.6, 0.5, 0.7, 0.4, 0.6, 0.5, 0.7, 0.6)
    pieces = [f"{{line: 40 m, speed: {v}}}, {{arc: 8 m, turn: starboard, angle: 90 deg, speed: {v}}}" for v in speeds]
    coefficient = stronger * Numbers().thrust_coefficient
    text = SQUARE.replace("SEGMENTS", ", ".join(pieces)).replace("COEFFICIENT", repr(coefficient))
    text = text.replace("SCALE", repr(scale))
    return fly_text(text), parsed(text).to_yaml()


def test_a_log_tells_how_much_stronger_the_thrusters_are(tmp_path: Path) -> None:
    """Row I: thrusters f times as strong go sqrt(f) times as fast at the same shaft speed."""
    flight, mission = flown(1.3)
    write_log(tmp_path / "log.nc", flight, mission=mission, version="0")
    (track_of_log,) = read_tracks(tmp_path / "log.nc")
    found = calibrate(track_of_log)
    assert found.num_legs >= 6
    assert found.scale.value == pytest.approx(math.sqrt(1.3), rel=0.005)  # what the hull adds to the noise
    assert found.current_north is not None
    assert found.current_north.value == pytest.approx(0.05, abs=0.01)


def test_the_scale_that_the_mission_had_is_judged(tmp_path: Path) -> None:
    flight, mission = flown(1.0, 1.2)
    write_log(tmp_path / "log.nc", flight, mission=mission, version="0")
    found = calibrate(read_tracks(tmp_path / "log.nc")[0])
    assert found.scale.value == pytest.approx(1.0, abs=0.01)
    assert found.speed_factor == pytest.approx(1.2, abs=0.015)


# ---- files and the command -------------------------------------------------------------------------------------------


def table(of: Track, path: Path, columns: str) -> Path:
    """Write a track as CSV."""
    assert of.heading is not None
    values = {
        "time": of.time,
        "shaft_speed_rpm": of.shaft_speed / RPM,
        "percent": of.shaft_speed / RPM / 45.0,
        "heading_deg": np.degrees(of.heading) % 360.0,
        "north": of.north,
        "east": of.east,
        "latitude": 36.8 + (of.north if of.north is not None else 0.0) / 110972.0,
        "longitude": -7.24 + (of.east if of.east is not None else 0.0) / 89251.0,
    }
    names = columns.split(",")
    rows = zip(*(values[name] for name in names), strict=True)
    path.write_text("\n".join([columns, *(",".join(repr(float(x)) for x in row) for row in rows)]) + "\n")
    return path


@pytest.mark.parametrize(
    "columns", ["time,shaft_speed_rpm,heading_deg,north,east", "time,percent,heading_deg,east,north"]
)
def test_a_table_gives_the_same_as_its_track(columns: str, tmp_path: Path) -> None:
    direct = calibrate(track(3))
    by_table = calibrate(read_tracks(table(track(3), tmp_path / "auv.csv", columns))[0])
    assert by_table.scale.value == pytest.approx(direct.scale.value, rel=1e-9)
    assert by_table.scale.half_width == pytest.approx(direct.scale.half_width, rel=1e-6)


def test_a_table_of_latitudes(tmp_path: Path) -> None:
    columns = "time,shaft_speed_rpm,heading_deg,latitude,longitude"
    found = calibrate(read_tracks(table(track(3, scale=0.9, position_sigma=0.0), tmp_path / "t.csv", columns))[0])
    assert found.scale.value == pytest.approx(0.9, rel=2e-3)


HEAD = "time,shaft_speed_rpm,speed\n"
BAD = {
    "nothing": ("", "is empty"),
    "a column that is unknown": ("time,shaft_rpm,speed\n", "no column 'shaft_rpm'.*Did you mean 'shaft_speed_rpm'"),
    "no shaft speed": ("time,speed\n0,1\n", "shaft_speed_rpm or percent"),
    "no motion": ("time,percent\n0,1\n", "either speed"),
    "a heading alone": ("time,percent,heading_deg\n0,1,2\n1,1,2\n", "no position beside it"),
    "twice": ("time,time,percent,speed\n", "there twice"),
    "a word": (HEAD + "0,1,fast\n", ":2:speed: 'fast' is no number"),
    "a short row": (HEAD + "0,1\n", ":2: has 2 values"),
    "back in time": (HEAD + "0,1,1\n1,1,1\n1,1,1\n", ":4:time: must increase"),
    "one row": (HEAD + "0,1,1\n", "at least two rows"),
    "no steady part": (HEAD + "0,1,1\n1,1,1\n", "no steady part"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_tables_are_refused(case: str, tmp_path: Path) -> None:
    text, expected = BAD[case]
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(DataError, match=f"(?s){expected}"):
        calibrate(read_tracks(path)[0])


def test_other_files_are_refused(tmp_path: Path) -> None:
    (tmp_path / "log.nc").write_bytes(b"no netcdf")
    (tmp_path / "bytes.csv").write_bytes(b"\xff\xfe\x00")
    for name in ("log.nc", "bytes.csv", "missing.csv", "missing.nc"):
        with pytest.raises(DataError):
            read_tracks(tmp_path / name)


def run(*arguments: str) -> tuple[int, str]:
    result = CliRunner().invoke(cli, ["calibrate", *arguments], standalone_mode=False)
    if isinstance(result.exception, DataError):
        return 2, str(result.exception)
    assert result.exception is None, result.exception
    return int(result.return_value), result.output


def test_the_command_says_what_to_paste(tmp_path: Path) -> None:
    path = table(track(1, scale=0.9, position_sigma=0.1), tmp_path / "auv.csv", "time,percent,heading_deg,north,east")
    code, output = run(str(path))
    assert code == 0
    line = next(line for line in output.splitlines() if "thruster_speed: {scale:" in line)
    assert float(line.split("scale: ")[1].rstrip("}")) == pytest.approx(0.9, abs=0.01)
    code, output = run(str(path), "--json")
    (plain,) = json.loads(output)
    assert plain["is_usable"] is True
    assert plain["scale"]["value"] == pytest.approx(0.9, abs=0.01)
    assert run(str(path), "--quiet") == (0, "")


def test_the_command_says_what_the_data_cannot_tell(tmp_path: Path) -> None:
    path = table(track(legs=((1400.0, 30.0),) * 6), tmp_path / "auv.csv", "time,percent,heading_deg,north,east")
    code, output = run(str(path))
    assert code == 1
    assert "Paste" not in output
    assert "warning" in output
    assert json.loads(run(str(path), "--json")[1])[0]["scale"]["half_width"] is None


def test_the_command_refuses_what_is_not_there(tmp_path: Path) -> None:
    path = table(track(), tmp_path / "auv.csv", "time,percent,heading_deg,north,east")
    assert "there is no model 'medsua'" in run(str(path), "--model", "medsua")[1]
    assert "there is no vehicle 'port'" in run(str(path), "--vehicle", "port")[1]


def test_what_is_pasted_is_a_mission() -> None:
    pasted = "thruster_speed: {linear_drag: 3.012 N s/m, quadratic_drag: 21 N s^2/m^2, scale: 0.9}"
    text = SQUARE.replace("SEGMENTS", "{line: 40 m}").replace("thruster_speed: {scale: SCALE}", pasted)
    mission = parsed(text.replace("COEFFICIENT", "1.6e-4"))
    assert mission.vehicles[0].sensors.thruster_speed is not None
    assert mission.vehicles[0].sensors.thruster_speed.reader.parameters["quadratic_drag"] == 21.0
