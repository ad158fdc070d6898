"""The same work in C: built by the gcc that is here, called through ctypes."""

import ctypes
import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from cardume.maths.random import stream_id, vehicle_id
from cardume.paths.table import (
    ARC_START,
    COS_COURSE,
    CURVATURE,
    LENGTH,
    REFERENCE_RATE,
    REFERENCE_START,
    SIN_COURSE,
    START_COURSE,
    START_EAST,
    START_NORTH,
    STRETCH,
    rows_on_path,
)
from cardume.simulation.plan import Plan

SOURCES = Path(__file__).with_name("c")
COMPILER = "gcc"
SEGMENT = [START_NORTH, START_EAST, START_COURSE, SIN_COURSE, COS_COURSE, CURVATURE]
SEGMENT += [LENGTH, ARC_START, REFERENCE_START, STRETCH, REFERENCE_RATE]
SURFACE = "surface"
TICKS_PER_RECORD = 10
HISTOGRAM_BINS = 512
MESSAGE_COLUMNS = 6
# As in workload.h.
VEHICLE_SUMS = (
    *("north", "east", "heading", "settled", "settling_time", "line_time", "line_squares", "arc_time", "arc_squares"),
    *("cross_track_max", "flown", "position_squares", "current_squares", "progress", "energy", "yaw_effort"),
    *("absolute_error", "time", "squares", "relative_squares", "sent", "delivered", "age_sum", "age_max"),
)
LOG = (
    *(
        "north",
        "east",
        "depth",
        "heading",
        "surge",
        "sway",
        "yaw_rate",
        "course",
        "speed",
        "current_north",
        "current_east",
    ),
    *(
        "cross_track",
        "along_track",
        "path_course",
        "curvature",
        "coordination_state",
        "shaft_speed",
        "thrust",
        "yaw_moment",
    ),
    *("altitude", "north_estimate", "east_estimate", "current_north_estimate", "current_east_estimate"),
    *("cross_track_estimate", "coordination_state_estimate", "course_desired", "heading_desired", "speed_desired"),
    *("speed_correction", "depth_desired", "phase"),
)
FLEET_SUMS = ("time", "coordination_squares", "coordination_max", "separation_squared", "failed_at")
MISSION = np.dtype(
    [(name, float) for name in ("current_speed", "current_towards", "loss", "lookahead")] + [("seed", "u8")]
)


@dataclass(frozen=True)
class Program:
    """A C program for the workload.

    Attributes:
        name: readable.
        source: file in the folder c.
        flags: for the compiler.
        width: missions that it flies side by side.
    """

    name: str
    source: str
    flags: tuple[str, ...]
    width: int = 1


SCALAR = Program("C, one mission after the other", "scalar.c", ("-O3", "-march=native"))
# Without -fno-builtin gcc merges sine and cosine into one call, which libmvec does not have.
VECTOR_FLAGS = ("-O3", "-ffast-math", "-march=native", "-fno-builtin-sin", "-fno-builtin-cos")
VECTOR_256, VECTOR_512 = (
    Program(f"C, 8 missions side by side, {bits} bits", "lanes.c", (*VECTOR_FLAGS, f"-mprefer-vector-width={bits}"), 8)
    for bits in (256, 512)
)
CPU_INFO = Path("/proc/cpuinfo")


def vector_programs() -> dict[int, Program]:
    """The programs that fly missions side by side, by the width in bits that this processor has."""
    is_wide = CPU_INFO.is_file() and "avx512f" in CPU_INFO.read_text(encoding="utf-8")
    return {256: VECTOR_256} | ({512: VECTOR_512} if is_wide else {})


class Results(ctypes.Structure):
    """Where a program writes, as in workload.h."""

    _fields_ = [
        *((name, ctypes.POINTER(ctypes.c_double)) for name in ("vehicles", "fleet", "histograms")),
        *((name, ctypes.POINTER(ctypes.c_double)) for name in ("log", "predictions", "messages")),
        ("num_records", ctypes.c_long),
        ("num_messages", ctypes.c_long),
    ]


def why_not() -> str | None:
    """Why no C program can be built here; None: it can."""
    return None if shutil.which(COMPILER) else f"there is no {COMPILER} here"


def _run(command: list[str]) -> None:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)} failed:\n{done.stderr}")


@cache
def build(program: Program) -> ctypes.CDLL:
    """Compile a program and load it.

    Raises:
        RuntimeError: the compiler refuses it, in its words.
    """
    with tempfile.TemporaryDirectory() as folder:
        target, compiled = Path(folder, "workload.so"), str(Path(folder, "workload.o"))
        _run([COMPILER, *program.flags, "-fopenmp", "-fPIC", "-c", str(SOURCES / program.source), "-o", compiled])
        # Linked with -ffast-math it would switch subnormal numbers off in the whole process that loads it.
        _run([COMPILER, "-fopenmp", "-shared", compiled, "-o", str(target), "-lmvec", "-lm"])
        os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # a thread that waits is not to burn processor time
        return ctypes.CDLL(str(target))


def names_of(plan: Plan) -> list[str]:
    """The vehicles in the order of the engine, which is that of the C programs."""
    return [plan.vehicles[k].name for k in plan.order]


def common_of(plan: Plan) -> np.ndarray:
    """What all missions share, as the bytes that C reads."""
    vehicles = [plan.vehicles[k] for k in plan.order]
    paths = np.stack([rows_on_path(v.path)[:, SEGMENT] for v in vehicles])
    starts = np.array([[v.state.north, v.state.east, v.state.heading, v.state.surge] for v in vehicles])
    ids = np.array(
        [*(word for v in vehicles for word in vehicle_id(v.name)), *map(stream_id, ("usbl", "dvl", "link")), 0]
    )
    parts = (paths, starts, ids.astype("u4"), np.array([np.nan]))
    return np.concatenate([np.ascontiguousarray(part).view(np.uint8).ravel() for part in parts])


def missions_of(plans: Sequence[Plan]) -> np.ndarray:
    """What each mission draws, as the records that C reads."""
    return np.array([_drawn(plan) for plan in plans], MISSION)


def _drawn(plan: Plan) -> tuple[float, float, float, float, int]:
    laws = plan.vehicles[0].laws
    current = laws["current"]
    loss, lookahead = laws["acoustics"].value("loss"), laws["guidance"].value("lookahead")
    return current.value("speed"), current.value("towards"), loss, lookahead, plan.seed


class Flying:
    """A program with the missions that it is to fly, and room for what they leave."""

    def __init__(self, program: Program, plans: Sequence[Plan]) -> None:
        self.program, self.count, self.ticks = program, len(plans), plans[0].num_ticks
        self._common, self._missions = common_of(plans[0]), missions_of(plans)
        size, records = len(plans[0].vehicles), -(-self.ticks // TICKS_PER_RECORD)
        self._room = size * (size - 1) * (records + 1)
        shapes = {
            "vehicles": (size, len(VEHICLE_SUMS)),
            "fleet": (len(FLEET_SUMS),),
            "histograms": (size, 2, HISTOGRAM_BINS),
            "log": (records, size, len(LOG)),
            "predictions": (records, size, size),
            "messages": (self._room, MESSAGE_COLUMNS),
        }
        groups, width = -(-self.count // program.width), program.width
        self._kept = {name: np.full((groups, *shape, width), np.nan) for name, shape in shapes.items()}
        pointers = (kept.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) for kept in self._kept.values())
        self._results = Results(*pointers, 0, 0)
        self._library = build(program)

    def fly(self, threads: int) -> None:
        """Fly all missions.

        Args:
            threads: [-] that share them.
        """
        long = ctypes.c_long
        numbers = long(self.count), ctypes.c_int(threads), long(self.ticks), long(self._room)
        pointers = self._common.ctypes.data_as(ctypes.c_void_p), self._missions.ctypes.data_as(ctypes.c_void_p)
        self._library.fly_all(*numbers, *pointers, self._results)
        if (self["fleet"][:, FLEET_SUMS.index("failed_at")] >= 0.0).any():
            raise RuntimeError("a mission of the C program failed: time means nothing")

    def __getitem__(self, name: str) -> np.ndarray:
        """What the missions left under a name of `Results`: the mission first."""
        kept = np.moveaxis(self._kept[name], -1, 1)
        return kept.reshape(-1, *kept.shape[2:])[: self.count]
