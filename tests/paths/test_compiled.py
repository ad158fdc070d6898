"""The same source gives the same bits in plain Python, compiled for one mission, and for eight at once."""

import math

import numpy as np
import pytest
from numba import config, njit

from cardume.compiler import WIDTH, load, rows_of, store
from cardume.paths.along import arc_length_at, path_parameter_at
from cardume.paths.circle import Center
from cardume.paths.lawnmower import lawnmower
from cardume.paths.lemniscate import lemniscate
from cardume.paths.offset import offset_path
from cardume.paths.projection import point_at, project, projection
from cardume.paths.segment import Start
from cardume.paths.table import LENGTH_OWN, PathPlace
from cardume.paths.virtual_target import virtual_target
from cardume.signals import Place

NUM_OUT = 10
PATHS = {
    "lines and arcs": offset_path(lawnmower(Start(1.0, 2.0, 0.3), 30.0, 3, 24.0), -3.0, -2.0, 0.5),
    "curves": offset_path(lemniscate(Center(1.0, 2.0), 20.0, 0.3, parameter_rate=0.02), -3.0, -2.0, 0.5),
}


def fly(path: np.ndarray, places: np.ndarray, seen: np.ndarray, memory: np.ndarray, num_places: int) -> None:
    """Project place after place, and write down what is seen."""
    table, at, out, was = rows_of(path), rows_of(places), rows_of(seen), rows_of(memory)
    for k in range(num_places):
        place = Place(load(at, 2 * k), load(at, 2 * k + 1), table)
        error, now = project(place, PathPlace(load(was, 0), load(was, 1)))
        store(was, 0, now.segment)
        store(was, 1, now.arc_length)
        aim = point_at(table, error.arc_length + 5.0)
        store(out, NUM_OUT * k, error.path_course)
        store(out, NUM_OUT * k + 1, error.cross_track)
        store(out, NUM_OUT * k + 2, error.path_parameter)
        store(out, NUM_OUT * k + 3, error.stretch)
        store(out, NUM_OUT * k + 4, error.speed_profile)
        store(out, NUM_OUT * k + 5, error.finished)
        store(out, NUM_OUT * k + 6, aim.north)
        store(out, NUM_OUT * k + 7, aim.course)
        store(out, NUM_OUT * k + 8, arc_length_at(table, error.path_parameter))
        store(out, NUM_OUT * k + 9, path_parameter_at(table, error.arc_length))


def missions(path: np.ndarray) -> np.ndarray:
    """(places, 2, WIDTH): eight vehicles along the path, each with its own error and its own start."""
    s = np.linspace(-10.0, path[LENGTH_OWN] + 10.0, 120)
    points = np.array([point_at(path, x) for x in s])
    errors = np.array([[(lane - 3.0) * math.sin(x / 9.0 + lane) for lane in range(WIDTH)] for x in s])
    north = points[:, :1] - errors * points[:, 3:4]
    east = points[:, 1:2] + errors * points[:, 4:5]
    rolled = [np.roll(np.stack([north[:, k], east[:, k]], axis=1), -3 * k, axis=0) for k in range(WIDTH)]
    return np.stack(rolled, axis=-1)


compiled = njit(nogil=True, error_model="numpy")(fly)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compares compiled code with plain Python")
@pytest.mark.parametrize("kind", PATHS)
def test_one_mission_and_lanes_agree_to_the_last_bit_and_python_nearly(kind: str) -> None:
    path, places = PATHS[kind], missions(PATHS[kind])
    count = len(places)
    lanes = np.zeros((count * NUM_OUT, WIDTH))
    wide = np.ascontiguousarray(np.repeat(path[:, None], WIDTH, axis=1))
    compiled(wide, np.ascontiguousarray(places.reshape(-1, WIDTH)), lanes, np.zeros((2, WIDTH)), count)
    assert np.isfinite(lanes).all()
    for lane in range(WIDTH):
        own, one = np.ascontiguousarray(places[:, :, lane]).ravel(), np.zeros(count * NUM_OUT)
        compiled(path, own, one, np.zeros(2), count)
        assert np.array_equal(one, lanes[:, lane])
    plain = np.zeros(count * NUM_OUT)
    fly(path, own, plain, np.zeros(2), count)
    assert np.allclose(one, plain, rtol=1e-12, atol=1e-12)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compiles the law")
def test_the_laws_compile_for_one_mission_and_for_lanes() -> None:
    for law in (projection, virtual_target):
        assert law.handle() > 0
        assert law.handle(lanes=True) > 0
