"""How a function becomes a law, and what is said of one that does not."""

from __future__ import annotations

import math
import pickle
import random
import re
from typing import Annotated, Any, NamedTuple

import numpy as np
import pytest
from numba import config, njit
from numba.core.errors import TypingError

from cardume.compiler import Rows, load, rows_of, store
from cardume.compiler.calls import FLAT, law_answer
from cardume.errors import CardumeError, LawError
from cardume.laws import (
    FAMILIES,
    Bounds,
    Law,
    LawBook,
    Length,
    Meters,
    NotNegative,
    Number,
    Once,
    Positive,
    Seconds,
    Unit,
    all_families,
    family as family_of,
    laws_of,
)
from cardume.maths import atan2
from cardume.onboard.compensation import compensation_law
from cardume.onboard.compensation.base import Steering
from cardume.onboard.guidance import guidance_law, guide, line_of_sight
from cardume.signals import (
    NOTHING,
    Course,
    Demand,
    GnssReading,
    Motion,
    NavigationEstimate,
    Pace,
    PathError,
    VesselState,
)
from cardume.world.sensors import gnss_sensor

KEPT = {"name": "mine"}


class Sum(NamedTuple):
    """A memory."""

    value: float = 0.25
    steps: float = 0.0


class Ring(NamedTuple):
    """A memory with a table amid it."""

    first: float = 1.0
    ring: Annotated[Rows, Length(4)] = np.arange(4.0)
    last: float = 2.0


class Undefaulted(NamedTuple):
    """A memory that does not say how it starts."""

    value: float


# ---- what a signature says -------------------------------------------------------------------------------------------


@guidance_law
def rich(
    error: PathError,
    memory: Sum,
    dt: Seconds,
    lookahead: Positive[Meters] = 5.0,
    share: Annotated[float, Unit(""), Bounds(0.0, 1.0, high_open=True)] = 0.5,
    plain: float = -1.0,
) -> tuple[float, Sum]:
    """Every kind of argument. Source: this test."""
    value = memory.value + dt * share * error.cross_track
    return error.path_course + plain * atan2(value, lookahead), Sum(value, memory.steps + 1.0)


def test_a_signature_is_the_only_definition() -> None:
    names = [(p.name, p.default, p.unit, p.low, p.high) for p in rich.parameters]
    inf = float("inf")
    assert names == [("lookahead", 5.0, "m", 0.0, inf), ("share", 0.5, "", 0.0, 1.0), ("plain", -1.0, "", -inf, inf)]
    assert rich.memory_type is Sum
    assert rich.initial_memory().tolist() == [0.25, 0.0]
    assert rich.family == "guidance"
    assert (rich.name, rich.__name__, rich.doc.split(".")[0]) == ("rich", "rich", "Every kind of argument")
    assert not rich.is_builtin
    assert line_of_sight.is_builtin
    assert "rich" not in laws_of("guidance")  # a user's law is found through its module
    assert laws_of("guidance")["line_of_sight"] is line_of_sight


def test_a_law_stays_callable_as_plain_python() -> None:
    course, after = rich(PathError(cross_track=2.0), Sum(), 0.1, plain=0.0)
    assert course == 0.0
    assert after == Sum(0.25 + 0.1 * 0.5 * 2.0, 1.0)


def test_a_sensor_has_a_period_and_a_latency_beside_its_own_parameters() -> None:
    @gnss_sensor(period=2.0, latency=0.3)
    def mine(truth: VesselState, sigma: NotNegative[Meters] = 1.0) -> GnssReading:
        return GnssReading(truth.north, truth.east)

    assert [(p.name, p.default) for p in mine.parameters] == [("sigma", 1.0), ("period", 2.0), ("latency", 0.3)]
    assert mine.gains(0.1, latency=0.0).tolist() == [1.0]  # the engine keeps the other two
    with pytest.raises(LawError, match=r"period = 0.0 s is outside"):
        mine.gains(0.1, period=0.0)


def test_every_family_has_a_place_and_at_least_one_law() -> None:
    import cardume.missions.available  # noqa: F401, importing it imports every family

    found = all_families()
    assert set(found) == set(FAMILIES)
    assert all(found.values())
    for family, laws in found.items():
        for name, law in laws.items():
            assert (law.family, law.name) == (family, name)


# ---- what is computed once -------------------------------------------------------------------------------------------


class Inner(NamedTuple):
    doubled: float
    halved: float


class Ready(NamedTuple):
    inner: Inner
    of_step: float


def ready(dt: float, width: Positive[Meters] = 4.0, rate: NotNegative[Number] = 3.0) -> Ready:
    return Ready(Inner(2.0 * width, 0.5 * width), rate * dt)


@guidance_law
def prepared(error: PathError, dt: Seconds, ready: Annotated[Ready, Once(ready)], plain: Number = 1.0) -> float:
    return error.cross_track * ready.inner.doubled + ready.inner.halved + ready.of_step + plain


def test_what_a_law_wants_computed_once_is_of_its_parameters() -> None:
    assert [(p.name, p.default, p.unit) for p in prepared.parameters] == [
        ("plain", 1.0, ""),
        ("width", 4.0, "m"),
        ("rate", 3.0, ""),
    ]
    assert prepared.gains(0.5).tolist() == [1.0, 8.0, 2.0, 1.5]
    assert prepared.gains(0.5, width=1.0, plain=7.0).tolist() == [7.0, 2.0, 0.5, 1.5]
    assert prepared.gains_width == 4
    with pytest.raises(LawError, match=r"'prepared': width = 0.0 m is outside"):
        prepared.gains(0.5, width=0.0)


def test_it_may_be_given_by_its_parameters_or_whole() -> None:
    error = PathError(cross_track=10.0)
    assert prepared(error, 0.5) == 10.0 * 8.0 + 2.0 + 1.5 + 1.0
    assert prepared(error, dt=0.5, width=1.0, plain=0.0) == 10.0 * 2.0 + 0.5 + 1.5
    assert prepared(error, 0.5, ready(0.5, rate=0.0)) == 10.0 * 8.0 + 2.0 + 1.0


# ---- gains -----------------------------------------------------------------------------------------------------------


def test_gains_are_the_defaults_overridden_by_name() -> None:
    assert rich.gains(0.1).tolist() == [5.0, 0.5, -1.0]
    assert rich.gains(0.1, plain=3.0, lookahead=1e-9).tolist() == [1e-9, 0.5, 3.0]


@pytest.mark.parametrize("values", [{"share": 1.0}, {"share": -1e-9}, {"lookahead": 0.0}, {"lookahead": float("nan")}])
def test_gains_out_of_bounds_are_refused(values: dict[str, float]) -> None:
    (name, value), *_ = values.items()
    with pytest.raises(LawError, match=rf"'rich': {name} = {re.escape(str(value))} .*is outside"):
        rich.gains(0.1, **values)


def test_gains_of_another_name_are_refused() -> None:
    with pytest.raises(
        LawError, match=r"'rich' has no parameter \['look_ahead'\]; it has \['lookahead', 'plain', 'share'\]"
    ):
        rich.gains(0.1, look_ahead=1.0)


# ---- what is no law --------------------------------------------------------------------------------------------------


def test_a_parameter_needs_a_default() -> None:
    with pytest.raises(LawError, match=r"guidance law 'mine': parameter 'gain' needs a default.*signals: PathError"):

        @guidance_law
        def mine(error: PathError, gain: Number) -> float:
            return gain


def test_a_law_has_one_memory() -> None:
    with pytest.raises(
        LawError, match=r"'mine' has two records.*Sum and Ring; signals are PathError, Motion, Pace, and one memory"
    ):

        @guidance_law
        def mine(error: PathError, one: Sum, two: Ring) -> float:
            return 0.0


def test_a_memory_says_how_it_starts() -> None:
    with pytest.raises(LawError, match=r"every field of its memory Undefaulted needs a default"):

        @guidance_law
        def mine(error: PathError, memory: Undefaulted) -> float:
            return 0.0


def unmindful(error: PathError, memory: Sum) -> Any:
    return error.path_course


def bare(error: PathError, memory: Sum) -> Any:
    return error.path_course, memory.value


def silent(error: PathError) -> Any:
    error.path_course + 1.0


def wordy(error: PathError) -> Any:
    return "north"


def truthful(error: PathError) -> Any:
    return error.cross_track > 0.0


def double(error: PathError) -> Any:
    return error.path_course, 1.0


def broken(error: PathError) -> Any:
    return error.path_course / (error.cross_track - 0.5)


def misspelt(error: PathError) -> Any:
    return error.crosstrack


def restless(error: PathError) -> Any:
    return random.random()


TRIED = {
    unmindful: r"returned 0\.5; it must return a number and the next Sum, as a pair",
    bare: r"returned \(0\.5, 0\.25\); it must return a number and the next Sum, as a pair",
    silent: r"returned None; it must return a number",
    wordy: r"returned 'north'; it must return a number",
    truthful: r"returned True; it must return a number",
    double: r"returned \(0\.5, 1\.0\); it must return a number",
    broken: r"failed on sample input: ZeroDivisionError: .*; it must return a number",
    misspelt: r"failed on sample input: AttributeError: .*crosstrack.*; it must return a number",
    restless: r"gave 0\.\d+, then 0\.\d+, for the same input: a law is a pure function",
}


@pytest.mark.parametrize("function", TRIED, ids=lambda f: f.__name__)
def test_a_law_is_tried_once_before_it_is_compiled(function: Any) -> None:
    with pytest.raises(LawError, match=rf"^guidance law '{function.__name__}' {TRIED[function]}"):
        guidance_law(function).handle()


def test_a_record_must_be_the_family_s() -> None:
    @compensation_law
    def mine(course: Course, motion: Motion) -> Any:
        return course.course, course.speed

    with pytest.raises(LawError, match=r"returned \(0\.5, 0\.5\); it must return Steering\(heading, speed\)"):
        mine.handle()


def test_what_numba_cannot_compile_is_said_in_a_sentence() -> None:
    @guidance_law
    def mine(error: PathError) -> float:
        return float({"a": error.path_course}.get("b", 1.0)) + len(f"{error.speed}")

    if not config.DISABLE_JIT:
        with pytest.raises(
            LawError, match=r"guidance law 'mine' does not compile: .*\nA law is plain scalar Python"
        ) as told:
            mine.handle()
        assert len(str(told.value)) < 1000


def test_a_law_error_is_one_of_ours() -> None:
    assert issubclass(LawError, CardumeError)


# ---- called by address -----------------------------------------------------------------------------------------------


@guidance_law
def remembering(error: PathError, memory: Ring, gain: Number = 10.0) -> tuple[float, Ring]:
    """Moves its ring on. Source: this test."""
    oldest = load(memory.ring, 0)
    for k in range(3):
        store(memory.ring, k, load(memory.ring, k + 1))
    store(memory.ring, 3, error.cross_track)
    return gain * oldest + memory.last, Ring(memory.first + 1.0, memory.ring, memory.last + 0.5)


@njit
def ask_once(handles: np.ndarray, gains: np.ndarray, memory: np.ndarray, slot: int, cross_track: float) -> Any:
    book = LawBook(rows_of(handles), rows_of(gains), rows_of(memory), 0.1)
    path = rows_of(gains)
    error = PathError(0.0, 0.0, cross_track, 0.0, 0.0, 1.0, 0.5, 0.0, 0.0, 0.5, 0.5, path)
    motion = Motion(0.3, 0.0, 0.5, 0.0, 0.5, 0.0, 0.0, 0.0)
    return guide(book, slot, error, motion, Pace(0.5))


def steer_once(handles: np.ndarray, gains: np.ndarray, memory: np.ndarray, slot: int, cross_track: float) -> float:
    return float(ask_once(handles, gains, memory, slot, cross_track).course)


def book_of(law: Law, slots: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Tables in which the law's gains begin at 2 and its memory at 3."""
    width = law.initial_memory().size
    handles = np.zeros(len(FAMILIES) * 4, np.int64)
    handles[:4] = law.handle(), 2, 3, width  # guidance is the first family
    memory = np.concatenate([np.full(3, np.nan), *[law.initial_memory()] * slots, np.full(3, np.nan)])
    return handles, np.concatenate([np.full(2, np.nan), law.gains(0.1), np.full(2, np.nan)]), memory


def test_a_law_with_a_ring_keeps_its_memory_in_the_table_slot_by_slot() -> None:
    handles, gains, memory = book_of(remembering, 3)
    answers = [steer_once(handles, gains, memory, 1, 7.0 + k) for k in range(6)]
    rings = [0.0, 1.0, 2.0, 3.0, 7.0, 8.0]
    assert answers == [10.0 * r + 2.0 + 0.5 * k for k, r in enumerate(rings)]
    assert memory[9:15].tolist() == [7.0, 9.0, 10.0, 11.0, 12.0, 5.0]
    untouched = [1.0, 0.0, 1.0, 2.0, 3.0, 2.0]
    assert memory[3:9].tolist() == memory[15:21].tolist() == untouched
    assert np.isnan(memory[[0, 1, 2, -1, -2, -3]]).all()


@guidance_law
def integer(error: PathError) -> float:
    """A whole number is a number. Source: this test."""
    return 2


@guidance_law
def raising(error: PathError) -> float:
    """Raises far to port. Source: this test."""
    if error.cross_track < -100.0:
        raise ValueError("too far to port")
    return error.path_course


def test_a_whole_number_is_widened() -> None:
    assert steer_once(*book_of(integer, 1), 0, 0.0) == 2.0


@guidance_law
def turning(motion: Motion, error: PathError, pace: Pace) -> Demand:
    """Asks for a yaw rate and a speed. Source: this test."""
    return Demand(NOTHING, NOTHING, -0.1 * error.cross_track - motion.heading, 2.0 * pace.speed)


def test_a_number_is_the_course_and_nothing_else_is_asked_for() -> None:
    demand = np.array(ask_once(*book_of(integer, 1), 0, 0.0))
    assert demand[0] == 2.0
    assert np.isnan(demand[1:]).all()
    assert integer.sample_answer() == pytest.approx((2.0, math.nan, math.nan, math.nan), nan_ok=True)


def test_a_law_may_ask_for_a_yaw_rate_and_a_speed() -> None:
    demand = tuple(ask_once(*book_of(turning, 1), 0, 2.0))
    assert demand[2:] == (-0.5, 1.0)
    assert np.isnan(demand[:2]).all()
    assert turning.handle(lanes=True) > 0
    assert turning.sample_answer().yaw_rate == -0.55


def test_an_exception_in_a_law_comes_out_as_it_is() -> None:
    tables = book_of(raising, 1)
    assert steer_once(*tables, 0, 0.0) == 0.0
    with pytest.raises(ValueError, match="too far to port"):
        steer_once(*tables, 0, -200.0)


def test_compiled_laws_do_as_plain_python() -> None:
    memory, table = Sum(), book_of(rich, 1)
    for k in range(20):
        error = PathError(cross_track=1.7 * (-1.1) ** k)
        course, memory = rich(error, memory, 0.1)
        assert steer_once(*table, 0, error.cross_track) == pytest.approx(course, rel=1e-14)
    assert table[2][3:5] == pytest.approx(list(memory), rel=1e-14)


whole_answer, part_answer = law_answer(Demand, "course"), law_answer(NavigationEstimate, None, True)


@njit
def in_whole(rows: np.ndarray) -> Any:
    return whole_answer(rows_of(rows), (1.0, 2.0))


@njit
def in_part(rows: np.ndarray) -> Any:
    return part_answer(rows_of(rows), (1.0, 2.0))


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="only compiled records can be short")
def test_only_laws_of_a_family_that_says_so_leave_something_out() -> None:
    """A position law need not know its error; a guidance law says of everything whether it asks for it."""
    import cardume.missions.available  # noqa: F401, importing it imports every family

    assert [name for name in FAMILIES if family_of(name).may_leave_out] == ["position"]
    found = in_part(np.zeros(1))
    assert tuple(found[:2]) == (1.0, 2.0)
    assert np.isnan(found[2:]).all()
    with pytest.raises(TypingError):
        in_whole(np.zeros(1))


# ---- pickling --------------------------------------------------------------------------------------------------------


def test_a_law_of_a_module_is_pickled_by_reference() -> None:
    data = pickle.dumps(line_of_sight)
    assert len(data) < 150
    assert pickle.loads(data) is line_of_sight


def test_a_handle_is_never_pickled() -> None:
    assert str(line_of_sight.handle()).encode() not in pickle.dumps(line_of_sight)


def test_the_name_of_a_law_in_the_cache_says_what_it_is() -> None:
    name = rich._wrapper(FLAT).__name__
    assert name.startswith("guidance_rich_")
    assert Steering._fields == ("heading", "speed")
