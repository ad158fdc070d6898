"""A vehicle that moves about the others: its own path, the maneuver that is chosen, and what is refused."""

import math

import numpy as np
import pytest

from cardume.errors import MissionError
from cardume.missions.available import catalog
from cardume.missions.geodesy import GeoPoint
from cardume.missions.loading import parse_mission
from cardume.missions.mission_path import plan_of_mission
from cardume.missions.planning import make_plan
from cardume.missions.ranging.choosing import Knowledge, most_telling
from cardume.missions.ranging.information import log_determinants_along, mission_information
from cardume.missions.ranging.maneuvers import circle
from cardume.missions.ranging.track import arcs_through
from cardume.paths import table
from cardume.paths.projection import point_of_formation
from cardume.paths.segment import end_of

TEXT = """
cardume: 1
name: about
duration: 900 s
path: {type: lawnmower, start: {course: 20 deg}, leg: 60 m, legs: 2, spacing: 30 m, turn: port}
formation: {speed: 0.3 m/s}
vehicles:
  - name: above
    maneuver: {type: circle, radius: 15 m, speed_max: 0.6 m/s, bearing: 40 deg}
    sensors: {gnss: {sigma: 0.3 m}, usbl: {}, ahrs: {}, depth: {}, thruster_speed: {}}
  - {name: port, depth: 8 m, offset: {starboard: -3 m}}
  - {name: starboard, depth: 8 m, offset: {starboard: 3 m, ahead: 2 m}}
"""
MANEUVER = "vehicles.above.maneuver"


def paths_of(*overrides: str) -> dict[str, np.ndarray]:
    mission = parse_mission(TEXT, catalog([]), overrides)
    return {vehicle.name: vehicle.path for vehicle in make_plan(mission, catalog([])).plan.vehicles}


def places(path: np.ndarray, gammas: np.ndarray) -> np.ndarray:
    return np.array([point_of_formation(path, float(gamma), 0.0)[:2] for gamma in gammas])


def test_it_is_in_its_place_when_the_formation_is_in_its() -> None:
    """At each coordination state 15 m from the middle of those below, at 0.6 m/s as long as these go at 0.3 m/s."""
    paths = paths_of()
    gammas = np.linspace(0.0, paths["above"][table.LENGTH_REFERENCE], 400)
    middle = 0.5 * (places(paths["port"], gammas) + places(paths["starboard"], gammas))
    away = places(paths["above"], gammas) - middle
    assert np.hypot(*away.T) == pytest.approx(np.full(400, 15.0), abs=0.05)
    assert math.atan2(away[0, 1], away[0, 0]) == pytest.approx(math.radians(40.0), abs=1e-9)
    assert paths["above"][table.LENGTH_REFERENCE] == pytest.approx(paths["port"][table.LENGTH_REFERENCE])
    stretch = table.rows_on_path(paths["above"])[:, table.STRETCH]
    assert 0.3 * stretch == pytest.approx(np.full(len(stretch), 0.6), rel=0.01)


def test_arcs_go_through_the_points_without_a_corner() -> None:
    gammas = np.linspace(0.0, 40.0, 60)
    points = np.stack([gammas + 6.0 * np.sin(gammas / 3.0), 5.0 * np.cos(gammas / 4.0)], axis=1)
    pieces = arcs_through(points, gammas, [None] * 60)
    assert sum(piece.reference_length for piece in pieces) == pytest.approx(40.0)
    for one, other in zip(pieces, pieces[1:], strict=False):
        end = end_of(one.shape)
        assert (end.north, end.east) == pytest.approx((other.shape.north, other.shape.east), abs=1e-9)
        assert math.remainder(end.course - other.shape.course, math.tau) == pytest.approx(0.0, abs=1e-9)
    ends = np.array([end_of(piece.shape)[:2] for piece in pieces[1::2]])
    assert ends == pytest.approx(points[1:], abs=1e-9)


def test_what_is_known_without_wandering_is_the_information() -> None:
    times = np.arange(0.0, 60.0, 2.0)
    target = 0.3 * times[:, None] * np.array([1.0, 0.5])
    offsets = target - circle(target, times, radius=12.0, speed_max=0.7)
    prior = np.diag([4.0, 4.0, 0.01, 0.01])
    found = log_determinants_along(times, offsets, 0.5, prior)
    onward = np.eye(4)
    onward[:2, 2:] = (times[-1] - times[0]) * np.eye(2)  # the prior is of the first moment, the information of the last
    back = np.linalg.inv(onward)
    told = mission_information(times, offsets, 0.5, back.T @ np.linalg.inv(prior) @ back)
    assert found[-1] == pytest.approx(np.linalg.slogdet(told)[1], rel=1e-9)


def test_a_range_from_above_tells_less_and_wandering_forgets() -> None:
    times = np.arange(0.0, 60.0, 2.0)
    target = 0.3 * times[:, None] * np.array([1.0, 0.5])
    offsets = target - circle(target, times, radius=12.0, speed_max=0.7)
    prior = np.diag([4.0, 4.0, 0.01, 0.01])
    level, below, shaken = (
        log_determinants_along(times, offsets, 0.5, prior, **options)[-1]
        for options in ({}, {"below": 12.0}, {"velocity_noise": 1e-2})
    )
    assert below < level - 1.0
    assert shaken < level - 1.0


def test_the_better_ranges_are_measured_the_nearer_it_circles() -> None:
    """What is forgotten between ranges asks for quick turns; what ranges err, for long lines of sight."""
    times = np.arange(0.0, 400.0, 2.0)
    target = 0.3 * times[:, None] * np.array([1.0, 0.0])
    options = {"speed_max": 0.6, "nearest": 4.0, "farthest": 60.0}
    sizes = [most_telling(target, times, known=Knowledge(s, 10.0), **options).size for s in (0.05, 0.5, 2.0)]
    assert sizes == sorted(sizes)
    assert sizes[0] < 0.7 * sizes[2]


def test_best_is_the_best_of_its_kinds() -> None:
    times = np.arange(0.0, 400.0, 2.0)
    target = 0.3 * times[:, None] * np.array([1.0, 0.0])
    known = Knowledge(0.5, 10.0)
    chosen = most_telling(target, times, speed_max=0.6, known=known, nearest=5.0, farthest=40.0)
    prior = np.diag([100.0, 100.0, 0.09, 0.09])
    for radius in (6.0, 20.0, 35.0):
        offsets = target - circle(target, times, radius=radius, speed_max=0.6)
        told = log_determinants_along(
            times, offsets, 0.5, prior, velocity_noise=3e-3, current_noise=1e-6, below=10.0
        ).mean()
        assert told < chosen.told


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        (["vehicles.port.sensors={gnss: {}}", "vehicles.starboard.sensors={gnss: {}}"], "nobody to move about"),
        (["vehicles.above.sensors.usbl=none"], "give the vehicle sensors"),
        (["vehicles.above.offset.starboard=2 m"], "a maneuver or an offset, not both"),
        ([f"{MANEUVER}.speed_max=0.2 m/s"], "the target goes at 0.3.*slower"),
        ([f"{MANEUVER}={{type: best, speed_max: 0.6 m/s, nearest: 30 m, farthest: 10 m}}"], "must not be less"),
        ([f"{MANEUVER}={{type: loop, speed_max: 0.6 m/s}}"], "circle"),
    ],
)
def test_what_cannot_be_flown_is_refused_with_its_place(overrides: list[str], words: str) -> None:
    with pytest.raises(MissionError, match=words) as told:
        paths_of(*overrides)
    assert "maneuver" in str(told.value)


def test_none_is_no_maneuver_and_a_saved_one_reads_back() -> None:
    mission = parse_mission(TEXT, catalog([]), [f"{MANEUVER}={{type: zigzag, width: 20 m, speed_max: 0.7 m/s}}"])
    again = parse_mission(mission.to_yaml(), catalog([]))
    assert again.vehicles[0].maneuver == mission.vehicles[0].maneuver
    assert again == mission
    without = paths_of(f"{MANEUVER}=none")["above"]
    assert without[table.LENGTH_OWN] == pytest.approx(without[table.LENGTH_REFERENCE])


def test_a_path_file_says_that_it_has_no_maneuver() -> None:
    plan, names, lost = plan_of_mission(parse_mission(TEXT, catalog([])), "about", GeoPoint(0.0, 0.0))
    assert plan.members[names.index("above")].starboard == 0.0
    assert any("above's maneuver" in what for what in lost)
