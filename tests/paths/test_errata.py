"""The paper's equations about the path: as corrected they hold, as printed they give the errata's wrong numbers."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from cardume.paths.arc import arc
from cardume.paths.line import line
from cardume.paths.offset import offset_path
from cardume.paths.projection import point_at, project
from cardume.paths.segment import Start
from cardume.paths.table import PathPlace, start_at
from cardume.signals import PathError, Place

CLOCKWISE = offset_path(arc(Start(), 12.0, "starboard", math.pi), speed=0.5)  # center 12 m east of the start


def on_arc(rho: float, progress: float, path: np.ndarray = CLOCKWISE, radius: float = 12.0) -> PathError:
    """Seen at distance rho from the center of a clockwise arc, an angle further on than its start."""
    place = Place(rho * math.sin(progress), radius - rho * math.cos(progress), path)
    return project(place, start_at(path, radius * progress))[0]


def test_5_and_8_need_the_starboard_error_and_the_sense_of_turn() -> None:
    """ds/dt = u cos / (1 - c e) with c = sigma / R: at rho = 12.5, R / rho = 0.96; with the e of (19), 1.0435."""
    error, step = on_arc(12.5, 0.3), 1e-6
    rate = (on_arc(12.5, 0.3 + step / 12.5).arc_length - error.arc_length) / step
    assert error.cross_track == pytest.approx(-0.5, abs=1e-12)
    assert rate == pytest.approx(0.96, abs=1e-8)
    assert 1.0 / (1.0 - error.curvature * error.cross_track) == pytest.approx(0.96, abs=1e-12)
    e_of_19 = 12.5 - 12.0
    assert 1.0 / (1.0 - error.curvature * e_of_19) == pytest.approx(1.04347826, abs=1e-8)


def test_51_counts_meters_and_does_not_wrap() -> None:
    """A half circle of 12 m is 37.699112 m, not 3.141593; the printed difference of bearings jumps by 6.283185."""
    assert on_arc(12.0, math.pi).path_parameter == pytest.approx(37.699112, abs=5e-7)
    path = offset_path(arc(Start(), 12.0, "starboard", 6.0), speed=0.5)
    around = 1.5 * math.pi + np.array([-1e-9, 1e-9])  # where the bearing from the center passes south
    bearings = [math.atan2(-12.0 * math.cos(p), 12.0 * math.sin(p)) for p in around]
    assert bearings[1] - bearings[0] == pytest.approx(-6.283185, abs=1e-6)
    seen = [on_arc(12.0, p, path).path_parameter for p in around]
    assert seen[1] - seen[0] == pytest.approx(24e-9, abs=1e-12)


def test_52_as_printed_turns_a_vehicle_on_the_path_by_67_degrees() -> None:
    """e = sigma (R - rho) is 0 on the path; without -R it is R, and line of sight steers atan(R / d) off."""
    assert on_arc(12.0, 1.0).cross_track == pytest.approx(0.0, abs=1e-12)
    printed = 12.0
    assert math.degrees(math.atan(printed / 5.0)) == pytest.approx(67.38013505, abs=1e-8)


@given(st.floats(-0.5, 0.5), st.floats(-6.0, 6.0), st.floats(-1.0, 1.0), st.booleans())
def test_53_the_rate_of_gamma_has_the_stretch_and_the_course_over_ground(
    off_course: float, e: float, offset: float, is_port: bool
) -> None:
    """dgamma/dt = U cos(chi - chi_p) / ((1 - c e) h), c and h those of the own path."""
    path = offset_path(arc(Start(), 20.0, "port" if is_port else "starboard", 3.0), 5.0 * offset, speed=0.5)
    there = point_at(path, 20.0)
    north, east = there.north - e * there.sin_course, there.east + e * there.cos_course
    error, memory = project(Place(north, east, path), start_at(path, 20.0))
    chi, step = error.path_course + off_course, 1e-5
    ends = [project(Place(north + d * math.cos(chi), east + d * math.sin(chi), path), memory)[0] for d in (-step, step)]
    rate = (ends[1].path_parameter - ends[0].path_parameter) / (2.0 * step)
    assert rate == pytest.approx(math.cos(off_course) / ((1.0 - error.curvature * e) * error.stretch), rel=1e-6)


def test_53_as_printed_is_15_percent_off_in_a_current() -> None:
    """u = 0.5, current 0.1 along and 0.15 across: over ground 0.57697 m/s along the path, not 0.5."""
    along = math.sqrt(0.5**2 - 0.15**2) + 0.1
    path = offset_path(line(Start(), 50.0), speed=0.5)
    moved = project(Place(10.0 + along, 0.0, path), PathPlace())[0].path_parameter - 10.0
    assert moved == pytest.approx(0.57696960, abs=1e-8)
    assert moved / 0.5 - 1.0 == pytest.approx(0.1539, abs=5e-5)


@pytest.mark.parametrize(
    ("radius", "lookahead", "settled"),
    [(12.0, 5.0, -1.0266832009), (20.0, 5.0, -0.6217515658), (12.0, 10.0, -3.9310530710), (30.0, 5.0, -0.4157030531)],
)
def test_c_steering_for_a_point_on_an_arc_settles_inside_it(radius: float, lookahead: float, settled: float) -> None:
    """At rho = R cos(d / R) the point one lookahead ahead on the arc lies on the vehicle's own tangent."""
    path = offset_path(arc(Start(), radius, "starboard", math.pi), speed=0.5)
    rho = radius + settled
    error = on_arc(rho, 0.4, path, radius)
    aim = point_at(path, error.arc_length + lookahead)
    bearing = math.atan2(aim.east - (radius - rho * math.cos(0.4)), aim.north - rho * math.sin(0.4))
    assert bearing == pytest.approx(error.path_course, abs=1e-10)


@pytest.mark.parametrize(
    ("curvature", "e0", "s", "e"),
    [(1.0 / 12.0, -10.0, 23.2171015925, -0.052729165165), (1.0 / 12.0, 6.0, 31.8853162096, 0.020366675719)],
)
def test_a2_the_way_of_line_of_sight_to_an_arc(curvature: float, e0: float, s: float, e: float) -> None:
    """60 s at 0.5 m/s with a lookahead of 5 m, by Runge-Kutta over the projection."""
    path = offset_path(arc(Start(), 1.0 / curvature, "starboard", 6.0), speed=0.5)
    place, memory, step = np.array([0.0, e0]), PathPlace(), 0.25

    def velocity(at: np.ndarray) -> np.ndarray:
        seen = project(Place(at[0], at[1], path), memory)[0]
        course = seen.path_course + math.atan(-seen.cross_track / 5.0)
        return 0.5 * np.array([math.cos(course), math.sin(course)])

    for _ in range(240):
        k1 = velocity(place)
        k2 = velocity(place + 0.5 * step * k1)
        k3 = velocity(place + 0.5 * step * k2)
        place = place + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + velocity(place + step * k3))
        error, memory = project(Place(place[0], place[1], path), memory)
    assert error.arc_length == pytest.approx(s, abs=2e-8)
    assert error.cross_track == pytest.approx(e, abs=2e-8)
