"""Must show 4, noise-free: nature knows no north, no origin, no starboard and no noon, and neither does cardume."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings, strategies as st

from cardume.laws import laws_of
from cardume.simulation.engine import advance
from cardume.simulation.fleet import NUM_SENSORS, TIMING, Tables, Timing
from cardume.simulation.flight import CHANNELS, METRICS, Flight
from cardume.simulation.fly import Flown, fly
from cardume.simulation.recording import MESSAGE_LOG, MESSAGES, MessageRow
from cardume.simulation.results import metrics_of
from cardume.simulation.tables import make_tables
from flying import fly_text
from properties.flown import plan_of
from properties.scenes import BELOW, EXACT, HEAD, Scene, formation, turn

CLOSE = 1e-9
PLACES = (("north", "east"), ("north_estimate", "east_estimate"))
VECTORS = (("current_north", "current_east"), ("current_north_estimate", "current_east_estimate"))
ANGLES = ("heading", "path_course", "course_desired", "heading_desired")
SIDED = ("sway", "yaw_rate", "cross_track", "curvature", "cross_track_estimate", "yaw_moment")
PLAIN = set(CHANNELS) - {"course", *ANGLES, *SIDED, *(c for pair in (*PLACES, *VECTORS) for c in pair)}

LAWS = sorted(laws_of("guidance"))

kinematic = Scene(formation(["ideal"] * 3, [0.0, 0.0, 0.0]), model="kinematic")
medusa = Scene(formation([EXACT] * 3, [0.0, 2.1, 0.0]))
guided = Scene(formation([HEAD, BELOW, BELOW], [0.0, 5.3, 7.1]))  # the first tells the others where they are
scenes = st.builds(
    lambda scene, shape, guidance, current, towards, course: Scene(
        scene.members, scene.model, shape, 3.7, -8.9, course, 1.0, current, towards, guidance
    ),
    st.sampled_from([kinematic, medusa, guided]),
    st.sampled_from(["lawnmower", "circle", "segments"]),
    st.sampled_from(LAWS),
    st.floats(0.013, 0.09),  # slow: near u = |V_perp| the crab angle is singular, and rounding grows
    st.floats(-3.1, 3.1),
    st.floats(-3.1, 3.1),
)
angles = st.floats(-6.2, 6.2)
distances = st.floats(-300.0, 300.0)
few = settings(max_examples=12, suppress_health_check=list(HealthCheck), phases=(Phase.reuse, Phase.generate))


@few
@given(scene=scenes, angle=angles)
def test_a_turned_scene_gives_the_turned_flight(scene: Scene, angle: float) -> None:
    compare(fly_text(scene.text()), fly_text(scene.turned(angle).text()), angle=angle)


@few
@given(scene=scenes, north=distances, east=distances)
def test_a_moved_scene_gives_the_moved_flight(scene: Scene, north: float, east: float) -> None:
    compare(fly_text(scene.text()), fly_text(scene.moved(north, east).text()), north=north, east=east)


@few
@given(scene=scenes)
def test_a_mirrored_scene_gives_the_mirrored_flight(scene: Scene) -> None:
    compare(fly_text(scene.text()), fly_text(scene.mirrored().text()), side=-1.0)


@settings(few, max_examples=2)
@pytest.mark.parametrize("law", LAWS)
@given(scene=scenes, angle=angles, north=distances, east=distances)
def test_every_guidance_law_knows_no_place_no_direction_and_no_side(
    law: str, scene: Scene, angle: float, north: float, east: float
) -> None:
    here = replace(scene, guidance=law)
    there = here.mirrored().turned(angle).moved(north, east)
    compare(fly_text(here.text()), fly_text(there.text()), angle, north, east, side=-1.0)


@settings(few, max_examples=3)
@given(
    shape=st.sampled_from(["lemniscate", "spline"]),
    reference=st.sampled_from(["projection", "virtual_target"]),
    course=st.floats(-3.1, 3.1),
    angle=angles,
)
def test_scenes_on_curves_turned_and_mirrored(shape: str, reference: str, course: float, angle: float) -> None:
    law = f"line_of_sight, reference_point: {reference}"
    scene = Scene(kinematic.members, "kinematic", shape, 3.7, -8.9, course, guidance=law, duration=60.0)
    flight = fly_text(scene.text())
    compare(flight, fly_text(scene.turned(angle).text()), angle=angle)
    compare(flight, fly_text(scene.mirrored().text()), side=-1.0)


def compare(one: Flight, other: Flight, angle: float = 0.0, north: float = 0.0, east: float = 0.0, side: float = 1.0):
    """Check that `other` is `one`, mirrored, turned and moved."""
    assert one.reason == other.reason == "completed"
    a, b = one.channels, other.channels
    for names, at in [*[(p, (north, east)) for p in PLACES], *[(v, (0.0, 0.0)) for v in VECTORS]]:
        there = turn(a[names[0]], side * a[names[1]], angle)
        close(there[0] + at[0], b[names[0]], names[0])
        close(there[1] + at[1], b[names[1]], names[1])
    # the course of a vehicle that hardly moves has no meaning; its velocity has
    velocity = turn(a["speed"] * np.cos(a["course"]), side * a["speed"] * np.sin(a["course"]), angle)
    close(velocity[0], b["speed"] * np.cos(b["course"]), "course")
    close(velocity[1], b["speed"] * np.sin(b["course"]), "course")
    for name in ANGLES:
        apart = side * a[name] + angle - b[name]
        close(np.remainder(apart + math.pi, 2.0 * math.pi), np.full_like(apart, math.pi), name)
    for name in SIDED:
        close(side * a[name], b[name], name)
    for name in PLAIN:
        close(a[name], b[name], name)
    close(one.neighbor_state_estimate, other.neighbor_state_estimate, "neighbor_state_estimate")
    for column, values in one.messages.items():
        close(values, other.messages[column], column)
    compare_metrics(one.metrics.vehicles, other.metrics.vehicles)
    compare_metrics({"fleet": one.metrics.fleet}, {"fleet": other.metrics.fleet})


def close(one: np.ndarray, other: np.ndarray, name: str) -> None:
    one, other = np.asarray(one, float), np.asarray(other, float)
    scale = max(1.0, np.nanmax(np.abs(one), initial=0.0))
    assert np.array_equal(np.isnan(one), np.isnan(other)), name
    assert np.nanmax(np.abs(one - other), initial=0.0) <= CLOSE * scale, name


def compare_metrics(one: Mapping[str, Mapping[str, float]], other: Mapping[str, Mapping[str, float]]) -> None:
    assert one.keys() == other.keys()
    for vehicle, found in one.items():
        assert found.keys() == other[vehicle].keys() <= METRICS.keys()
        for name, value in found.items():
            close(np.array([value]), np.array([other[vehicle][name]]), name)


# ---- time ------------------------------------------------------------------------------------------------------------


@few
@given(scene=scenes, tens=st.integers(1, 100_000))
def test_a_mission_at_another_time_of_day_gives_the_same_flight(scene: Scene, tens: int) -> None:
    """The engine's clock begins at tick 10 n (the log's period is 10 ticks) instead of 0."""
    plan = plan_of(scene.text())
    now, later = fly(plan), begun_at(make_tables(plan), 10 * tens)
    assert int(advance(later, 10 * tens, 10 * tens + plan.num_ticks)) == 10 * tens + plan.num_ticks
    close(now.tables.log, later.log, "log")
    close(now.tables.predictions, later.predictions, "predictions")
    seconds = 10 * tens * plan.tick
    for column in ("time_sent", "time_received", "time_of_validity"):
        close(messages(now.tables, column) + seconds, messages(later, column), column)
    one, other = metrics_of(now), metrics_of(Flown(plan, later, plan.num_ticks))
    for found in other.vehicles.values():
        found["settling_time"] -= seconds  # type: ignore[index]
    compare_metrics(one.vehicles, other.vehicles)


def begun_at(tables: Tables, start: int) -> Tables:
    """Sensors that read at `start` for the first time."""
    timings = tables.timings.reshape(-1, NUM_SENSORS, TIMING.width)
    timings[..., TIMING.column(Timing, "next_sample")] += start
    return tables


def messages(tables: Tables, column: str) -> np.ndarray:
    rows = tables.messages.reshape(-1, MESSAGE_LOG.width)[: tables.counts[MESSAGES]]
    return rows[:, MessageRow._fields.index(column)]


# ---- the comparison itself -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("what", [{"angle": 0.3}, {"north": 1.0}, {"side": -1.0}, {}])
def test_the_comparison_notices_a_scene_that_is_not_the_same(what: dict[str, float]) -> None:
    one = fly_text(kinematic.text())
    other = fly_text(kinematic.turned(1e-6).text()) if not what else one
    with pytest.raises(AssertionError):
        compare(one, other, **what)
