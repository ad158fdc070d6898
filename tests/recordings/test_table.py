"""A recording as CSV: what a vehicle measured comes back to the bit, and what is wrong is told with its place."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest

from cardume.errors import DataError, InputError
from cardume.missions.recordings.asking import Request, read_start
from cardume.missions.recordings.replaying import replay
from cardume.signals import Fix
from recordings.flown import apart, surface


def written(path: Path, thinned: int = 1) -> Path:
    """The surface vehicle's readings as a table, by Python's own writer."""
    flown = surface()
    truth = flown.believed.truth
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        names = ["heading_deg", "yaw_rate", "surge", "fix_north", "fix_east", "fix_sigma", "fix_time"]
        writer.writerow(["time", *names, "truth_north", "truth_east"])
        for k, r in enumerate(flown.readings):
            fix = ["", "", "", ""]
            if math.isfinite(r.north):
                fix = [repr(r.north), repr(r.east), repr(math.sqrt(r.variance)), repr(r.time - r.age)]
            if k % thinned == 0 or fix[0]:
                values = [math.degrees(r.heading), r.yaw_rate, r.surge]
                writer.writerow([repr(r.time), *map(repr, values), *fix, *map(repr, map(float, truth[k]))])
    return path


def test_a_flight_written_down_gives_the_flights_own_track(tmp_path: Path) -> None:
    flown = surface()
    found = replay(Request(path=written(tmp_path / "boat.csv"), start=read_start(flown.start)))
    (part,) = found.parts
    assert part.position == "kalman_replay"
    assert part.score.fixes == sum(math.isfinite(r.north) for r in flown.readings)
    assert apart(part.believed, flown.believed) < 1e-9  # degrees and back: the last bits of the heading
    away = np.hypot(*(flown.believed.position - flown.believed.truth).T)
    assert part.score.position_error_rms == pytest.approx(math.sqrt(np.mean(away**2)), rel=1e-6)


@pytest.mark.parametrize("law", ["direct", "reset", "reset_compensated"])
def test_every_position_law_takes_it(tmp_path: Path, law: str) -> None:
    (part,) = replay(Request(path=written(tmp_path / "boat.csv"), position={"law": law})).parts
    assert part.score.fixes > 50
    assert 0.1 < part.score.position_error_rms < 1.5
    assert math.isnan(part.score.anees)  # such a law says nothing of its errors


def simulated(path: Path, seed: int, delay: float) -> Path:
    """A vehicle with the noise that kalman_replay thinks of: white velocity, a constant current, fixes of 1 m."""
    draw, dt, seconds = np.random.default_rng([7, seed]), 0.1, 300.0
    position, current = draw.normal(size=2) * 3.0, 0.1 * draw.normal(size=2)
    steps, past = round(seconds / dt), []
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        fix_names = ["fix_time", "fix_north", "fix_east", "fix_sigma"]
        writer.writerow(["time", "heading_deg", "surge", *fix_names, "truth_north", "truth_east"])
        for k in range(steps):
            past.append(position.copy())
            then, fix = k - round(delay / dt), ["", "", "", ""]
            if k % 20 == 0 and then >= 0:
                fix = [repr(then * dt), *map(repr, (past[then] + draw.normal(size=2)).tolist()), "1.0"]
            writer.writerow([repr(k * dt), "30.0", "0.5", *fix, *map(repr, position.tolist())])
            way = 0.5 * dt * np.array([math.cos(math.radians(30.0)), math.sin(math.radians(30.0))])
            position = position + way + dt * current + math.sqrt(1e-3 * dt) * draw.normal(size=2)
    return path


@pytest.mark.parametrize("delay", [0.0, 1.5])
def test_nis_and_anees_are_one_where_the_filter_knows_its_noise(tmp_path: Path, delay: float) -> None:
    """Averages over 30 records, within 3.5 of their standard errors: late fixes are judged where they were true."""
    law = {"law": "kalman_replay", "velocity_noise": "1e-3", "current_noise": "0", "initial_sigma": "3 m"}
    law |= {"current_sigma": "0.1 m/s"}
    nis, anees = [], []
    for seed in range(30):
        path = simulated(tmp_path / f"{seed}.csv", seed, delay)
        (part,) = replay(Request(path=path, position=law, start=(0.0, 0.0))).parts
        nis.append(part.score.nis)
        anees.append(part.score.anees)
    for name, values in (("NIS", nis), ("ANEES", anees)):
        limit = 3.5 * np.std(values, ddof=1) / math.sqrt(len(values))
        print(f"{name} {np.mean(values):.4f} of 1 +- {limit:.4f}")
        assert abs(np.mean(values) - 1.0) < limit < 0.4


def test_smoothing_is_nearer_than_filtering(tmp_path: Path) -> None:
    errors = []
    for seed in range(5):
        path = simulated(tmp_path / "one.csv", seed, 0.5)
        law = {"law": "kalman_replay", "velocity_noise": "1e-3"}
        (part,) = replay(Request(path=path, position=law, looks_back=True)).parts
        assert part.smoothed is not None
        errors.append((part.smoothed.position_error_rms, part.score.position_error_rms))
    smoothed, filtered = np.array(errors).T
    assert (smoothed < filtered).all()
    assert smoothed.mean() < 0.75 * filtered.mean()


def test_ranges_from_two_places(tmp_path: Path) -> None:
    """Ranges are worked in by kalman_replay as the engine does it: slant, where both depths are known."""
    path = tmp_path / "ranges.csv"
    rows = [
        "time,heading_deg,surge,depth,range,range_sigma,source_north,source_east,source_depth,truth_north,truth_east"
    ]
    for k in range(600):
        time, north, depth = 0.1 * k, 0.05 * k, 12.0
        told = ",,,,"
        if k % 10 == 0:
            source = (20.0, 40.0) if k % 20 else (20.0, -30.0)
            slant = math.sqrt((north - source[0]) ** 2 + source[1] ** 2 + depth**2)
            told = f"{slant!r},0.1,{source[0]},{source[1]},0.0"
        rows.append(f"{time!r},0.0,0.5,{depth},{told},{north!r},0.0")
    path.write_text("\n".join(rows) + "\n")
    request = Request(path=path, position={"law": "kalman_replay"}, start=(3.0, 4.0))
    (part,) = replay(request).parts
    away = np.hypot(*(part.believed.position - part.believed.truth).T)
    assert np.hypot(*(part.believed.before[0, :2] - part.believed.truth[0])) == pytest.approx(5.0)
    assert away[-100:].max() < 0.1
    first = Fix(*part.believed.fixes[np.isfinite(part.believed.fixes[:, 0])][0])
    assert first.level_range == pytest.approx(math.hypot(20.0, 30.0))
    assert first.north_variance == pytest.approx(0.1**2 * (20.0**2 + 30.0**2 + 12.0**2) / (20.0**2 + 30.0**2))
    by_bank = replay(
        Request(path=path, start=(3.0, 4.0), position={"law": "range_filter", "position": "5 m", "range_scale": "0"})
    )
    assert np.hypot(*(by_bank.parts[0].believed.position - by_bank.parts[0].believed.truth).T)[-100:].max() < 0.2


GOOD = "time,heading_deg,surge,fix_north,fix_east\n0,10,0.5,1,2\n1,10,0.5,,\n2,10,0.5,3,4\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (GOOD.replace("surge", "speed"), r":1: there is no column 'speed'"),
        (GOOD.replace("time", "depth"), r":1: has no column time"),
        (GOOD.replace("surge", "heading_deg"), r":1: a column is there twice"),
        (GOOD.replace("1,10", "1,ten"), r":3:heading_deg: 'ten' is no number"),
        (GOOD.replace("1,10", "1,inf"), r":3:heading_deg: 'inf' is no number"),
        (GOOD.replace("1,10,0.5,,", "1,10,0.5"), r":3: has 3 values, the header 5"),
        (GOOD.replace("2,10", "0.5,10"), r":4:time: is 0.5 s, earlier"),
        (GOOD.replace("1,10", ",10"), r":3:time: is empty"),
        ("time,range\n0,5\n1,6\n", r":2:range: needs source_north"),
        ("time,fix_time,fix_north,fix_east\n0,3,1,1\n", r":2:fix_time: is 3 s after"),
        ("time,surge\n0,0.5\n0,0.5\n", r"times reach over 0 s"),
        ("time,surge\n0,0.5\n1e9,0.5\n", r"times reach over 1e\+09 s"),
        ("time,surge\n0,0.5\n9,0.5\n", r"nothing says where it starts; give --start"),
        ("time,surge\n", r"has 0 rows"),
        ("", r"is empty"),
        ("\0\1\2", r"is binary"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        replay(Request(path=path, kind="csv"))


def test_a_table_that_was_cut_off_gives_what_was_read(tmp_path: Path) -> None:
    path = tmp_path / "cut.csv"
    path.write_text(GOOD + "3,10,0.")
    found = replay(Request(path=path))
    assert any("line 5, is cut off" in note for note in found.notes)
    assert found.parts[0].score.fixes == 2


def test_no_garbage_gives_anything_but_an_error_of_ours(tmp_path: Path) -> None:
    draw, whole = np.random.default_rng(11), written(tmp_path / "whole.csv", thinned=20).read_bytes()
    path, said = tmp_path / "torn.csv", list[str]()
    for _ in range(150):
        data = bytearray(whole[: draw.integers(1, len(whole))])
        for _ in range(draw.integers(0, 6)):
            data[draw.integers(len(data))] = draw.integers(256)
        path.write_bytes(bytes(data))
        try:
            replay(Request(path=path, kind="csv", position={"law": "reset"}))
        except DataError as problem:
            said.append(str(problem))
        except InputError:  # as of a start that nothing says
            continue
    assert len(said) > 20
    assert all(str(path) in text for text in said)


def test_vehicles_of_one_table_share_their_time(tmp_path: Path) -> None:
    path = tmp_path / "two.csv"
    rows = ["time,vehicle,surge,heading_deg,fix_north,fix_east"]
    rows += [f"{1000 + k},late,0.5,0,{k},0" for k in range(5, 9)] + [f"{1000 + k},early,0.5,0,{k},0" for k in range(9)]
    path.write_text("\n".join(rows) + "\n")
    found = replay(Request(path=path, position={"law": "direct"}))
    assert found.began == "at 1000.000 s"
    late = found.parts[0].believed
    assert late.name == "late"
    first = int(np.flatnonzero(np.isfinite(late.fixes[:, 0]))[0])
    assert late.times[first] == pytest.approx(5.0)


def test_a_range_filter_starts_where_the_truth_does(tmp_path: Path) -> None:
    path = tmp_path / "ranges.csv"
    rows = ["time,heading_deg,surge,range,source_north,source_east,truth_north,truth_east"]
    rows += [f"{k},90,0.5,{math.hypot(30.0, 0.5 * k)!r},30,0,0,{0.5 * k}" for k in range(40)]
    path.write_text("\n".join(rows) + "\n")
    (part,) = replay(Request(path=path, position={"law": "range_filter", "range_scale": "0"})).parts
    assert part.score.fixes == 40
    assert part.score.position_error_rms < 0.5
