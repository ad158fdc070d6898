"""The log of a flight replayed: the same bits with the laws that flew, other numbers with others."""

from pathlib import Path

import netCDF4
import numpy as np
import pytest

from cardume.errors import DataError, InputError
from cardume.missions.recordings import log as flights
from cardume.missions.recordings.asking import Request
from cardume.missions.recordings.playing import play
from cardume.missions.recordings.replaying import replay
from recordings.flown import OVERRIDES, fly_to

FAULTS = """faults=[
  {kind: sensor_frozen, vehicle: port, sensor: ahrs, from: 5 s, lasts: 20 s},
  {kind: sensor_nan, vehicle: port, sensor: thruster_speed, from: 30 s, lasts: 5 s},
  {kind: sensor_frozen, vehicle: surface, sensor: gnss, from: 10 s, lasts: 8 s},
  {kind: gnss_lost, vehicle: surface, from: 30 s, lasts: 5 s},
  {kind: usbl_outlier, vehicle: surface, from: 0 s, probability: 0.1, size: 20 m},
  {kind: clock_drift, vehicle: starboard, drift: 0.01, from: 5 s},
  {kind: clock_offset, vehicle: port, offset: -3 s, from: 20 s, to: 40 s},
  {kind: current_step, speed: 0.1 m/s, towards: 90 deg, from: 25 s},
]"""


@pytest.mark.parametrize(
    ("mission", "overrides"),
    [
        ("paper/figure-5", (*OVERRIDES, FAULTS)),
        ("paper/figure-5", ("duration=60 s", FAULTS)),
        ("acoustics/figure-5-s2c", ("duration=60 s",)),
        ("paper/figure-5", OVERRIDES),
        ("paper/figure-5", ("duration=60 s",)),
        ("paper/figure-5", ("duration=40 s", "position={law: reset_compensated}")),
        ("cadiz", ("duration=30 s", "position={law: direct}")),
        ("gather-and-go", ("duration=60 s",)),
        ("survey-at-altitude", ("duration=40 s",)),
    ],
)
def test_the_laws_that_flew_give_the_same_bits(tmp_path: Path, mission: str, overrides: tuple[str, ...]) -> None:
    log = flights.read(fly_to(tmp_path, mission, overrides))
    flight = log.flight
    _, mets = flights.meet_again(log, [], lambda name: [], directory=tmp_path)
    assert [met.name for met in mets] == list(flight.vehicle_names)
    for k, met in enumerate(mets):
        believed = play(met)
        rows = np.round(flight.times / met.plan.tick).astype(int)
        is_inside = rows < len(believed.times)  # the last record may stand one tick past the end
        for name, column in (
            ("north_estimate", believed.position[:, 0]),
            ("east_estimate", believed.position[:, 1]),
            ("current_north_estimate", believed.current[:, 0]),
            ("current_east_estimate", believed.current[:, 1]),
            ("north_variance", believed.covariance[:, 0]),
        ):
            logged = flight.channels[name][is_inside, k]
            assert np.array_equal(logged, column[rows[is_inside]], equal_nan=True), (met.name, name)


def test_errors_are_those_of_the_flight(tmp_path: Path) -> None:
    """The score's numbers over all ticks are those that the engine kept while it flew."""
    from cardume.missions.drawing import draw
    from cardume.missions.flying import fly_mission
    from cardume.missions.opening import open_mission

    flight = fly_mission(draw(open_mission("paper/figure-5", list(OVERRIDES))))
    found = replay(Request(path=fly_to(tmp_path)))
    for part in found.parts:
        kept = flight.metrics.vehicles[part.believed.name]
        assert part.score.position_error_rms == pytest.approx(kept["position_error_rms"], rel=1e-9)
        assert part.score.current_error_rms == pytest.approx(kept["current_error_rms"], rel=1e-9)


def test_a_filter_does_better_over_the_same_readings_than_the_rule_that_flew(tmp_path: Path) -> None:
    path = fly_to(tmp_path, overrides=("duration=120 s",))
    flew = replay(Request(path=path))
    judged = replay(Request(path=path, position={"law": "kalman_replay"}, current_observer={"law": "from_position"}))
    surface, filtered = flew.parts[0], judged.parts[0]
    assert (surface.position, filtered.position) == ("reset", "kalman_replay")
    assert filtered.score.fixes == surface.score.fixes
    assert filtered.score.position_error_rms < 0.6 * surface.score.position_error_rms


def test_one_vehicle_with_its_parameters(tmp_path: Path) -> None:
    path = fly_to(tmp_path)
    found = replay(Request(path=path, vehicles=("port",), position={"law": "kalman_replay", "gate": "0.01"}))
    (part,) = found.parts
    assert part.believed.name == "port"
    assert part.score.believed < part.score.fixes  # such a gate lets few through


def test_a_fix_without_a_gate_is_where_it_was_expected_as_often_as_it_should(tmp_path: Path) -> None:
    part = replay(Request(path=fly_to(tmp_path, overrides=("duration=300 s", *OVERRIDES[1:])))).parts[0]
    assert part.score.fixes > 280
    assert part.score.nis == pytest.approx(1.0, abs=0.25)
    assert part.score.inside_95 > 0.9


@pytest.mark.parametrize("channel", ["north", "east_estimate"])
def test_a_log_that_its_mission_does_not_give_is_refused(tmp_path: Path, channel: str) -> None:
    path = fly_to(tmp_path)
    with netCDF4.Dataset(path, "a") as file:
        file[channel][20, 0] = file[channel][20, 0] + 1e-9
    with pytest.raises(DataError, match=f"{channel} differs from 20 s on"):
        replay(Request(path=path))


def test_what_cannot_be_asked_of_a_flight(tmp_path: Path) -> None:
    path = fly_to(tmp_path)
    for asked, message in (
        ({"vehicles": ("prot",)}, "no such vehicle.*'port'"),
        ({"position": {"law": "kalman"}}, "--position law=kalman: no such law.*kalman_replay"),
        ({"position": {"law": "range_filter"}}, "recordings of ranges"),
        ({"overrides": ("tick=0.2 s",)}, "tick"),
    ):
        with pytest.raises(InputError, match=message):
            replay(Request(path=path, **asked))  # type: ignore[arg-type]


def test_files_of_a_mission_are_found_from_the_log_wherever_one_stands(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan, run, elsewhere = (tmp_path / name for name in ("plan", "run/deep", "elsewhere"))
    for folder in (plan, run, elsewhere):
        folder.mkdir(parents=True)
    (plan / "path.geojson").write_text(
        '{"type": "LineString", "coordinates": [[-9.1, 38.7], [-9.1, 38.7004]]}', encoding="utf-8"
    )
    log = fly_to(run, "paper/figure-5", ("duration=5 s", f"path={{type: file, file: {plan / 'path.geojson'}}}"))
    monkeypatch.chdir(elsewhere)
    found = replay(Request(path=log))
    assert len(found.parts) == 3
