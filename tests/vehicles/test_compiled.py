"""A MEDUSA under its autopilot: the same bits for one mission and for eight, nearly in plain Python."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numba import config, njit

from cardume.compiler import WIDTH, at, load, rows_of, store
from cardume.laws import Law
from cardume.onboard.control import feedforward_pid, none
from cardume.onboard.control.feedforward_pid import Helm, pilot_of
from cardume.onboard.estimation.speed import proportional, thruster_calibration
from cardume.signals import NOTHING, Command, Feedback, Reference, ShaftReading, VesselState, Water
from cardume.vehicles import kinematic, medusa
from cardume.vehicles.medusa import medusa_plant
from cardume.vehicles.thrusters import SLOTS, Thrusters

VESSEL, HELM, RING = len(VesselState._fields), len(Helm._fields), len(Thrusters._fields) - 1
RING_AT = VESSEL + HELM + RING
WIDE = RING_AT + 3 * SLOTS
PILOT, PLANT = pilot_of(0.05), medusa_plant(0.05)


def records(name: str, width: int, first: int) -> str:
    return f"{name}({', '.join(f'load(rows, {first + k})' for k in range(width))}"


def flight(*compile_laws: Callable[..., Any]) -> Callable[..., None]:
    """fly(table, asked, num_steps): state, helm and thrusters live in one table, as they do in the engine."""
    steer, move, read = compile_laws
    fields = {"v": VesselState._fields, "h": Helm._fields, "t": Thrusters._fields[:-1]}
    stores = [f"{name}.{field}" for name, names in fields.items() for field in names]
    source = "\n".join(
        [
            "def fly(table, references, num_steps, pilot, plant):",
            "    rows, asked = rows_of(table), rows_of(references)",
            "    for step in range(num_steps):",
            f"        v = {records('VesselState', VESSEL, 0)})",
            f"        h = {records('Helm', HELM, VESSEL)})",
            f"        t = {records('Thrusters', RING, VESSEL + HELM)}, at(rows, {RING_AT}))",
            "        surge = read(ShaftReading(v.shaft_speed))",
            "        wanted = load(asked, 0), load(asked, 1), load(asked, 2)",
            "        f = Feedback(v.heading, v.yaw_rate, surge, v.depth, wanted[0], wanted[1], wanted[2], NOTHING)",
            "        command, h = steer(f, h, 0.05, pilot)",
            "        v, t = move(v, command, Water(load(asked, 3), load(asked, 4)), t, 0.05, plant)",
            *[f"        store(rows, {k}, {value})" for k, value in enumerate(stores)],
        ]
    )
    scope = {
        "rows_of": rows_of,
        "load": load,
        "store": store,
        "at": at,
        "steer": steer,
        "move": move,
        "read": read,
        "NOTHING": NOTHING,
        **{record.__name__: record for record in (VesselState, Helm, Thrusters, ShaftReading, Feedback, Water)},
    }
    exec(source, scope)
    return scope["fly"]


def missions() -> tuple[np.ndarray, np.ndarray]:
    """(WIDE, WIDTH) tables at the start, and (5, WIDTH) headings, speeds, depths and currents asked for."""
    rng = np.random.default_rng(4)
    table = np.zeros((WIDE, WIDTH))
    table[4] = rng.uniform(0.0, 0.8, WIDTH)  # surge
    table[3] = rng.uniform(-4.0, 4.0, WIDTH)
    asked = rng.uniform([-3.0, 0.0, 0.0, -0.2, -0.2], [3.0, 1.0, 20.0, 0.2, 0.2], (WIDTH, 5)).T
    return table, np.ascontiguousarray(asked)


@pytest.mark.slow
@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compares compiled code with plain Python")
def test_one_mission_and_lanes_agree_to_the_last_bit_and_python_nearly() -> None:
    laws = feedforward_pid, medusa, thruster_calibration
    plain = flight(*(law.function for law in laws))
    compiled = njit(error_model="numpy")(flight(*(njit(error_model="numpy")(law.function) for law in laws)))
    table, asked = missions()
    wide = table.copy()
    compiled(wide, asked, 300, PILOT, PLANT)
    assert np.isfinite(wide).all()
    assert np.ptp(wide[:VESSEL], axis=1).all()  # eight different missions
    for lane in range(WIDTH):
        one = np.ascontiguousarray(table[:, lane])
        compiled(one, np.ascontiguousarray(asked[:, lane]), 300, PILOT, PLANT)
        assert np.array_equal(one, wide[:, lane])
    interpreted = np.ascontiguousarray(table[:, lane])
    plain(interpreted, np.ascontiguousarray(asked[:, lane]), 300, PILOT, PLANT)
    assert np.allclose(one, interpreted, rtol=1e-12, atol=1e-12)


@pytest.mark.slow
@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="compiles the laws")
@pytest.mark.parametrize(
    "law", [kinematic, medusa, feedforward_pid, none, thruster_calibration, proportional], ids=lambda law: law.name
)
def test_the_law_compiles_for_one_mission_and_for_lanes(law: Law) -> None:
    assert law.handle() > 0
    assert law.handle(lanes=True) > 0


def test_laws_are_pure() -> None:
    feedback, helm = Feedback(0.1, 0.0, 0.4, 1.0, 0.3, 0.5, 2.0), Helm(started=1.0, sway=0.1)
    assert feedforward_pid(feedback, helm, 0.05) == feedforward_pid(feedback, helm, 0.05)
    wanted = Reference(heading=1.0, speed=0.5)
    assert kinematic(VesselState(), wanted, Water(), 0.1) == kinematic(VesselState(), wanted, Water(), 0.1)
    first = medusa(VesselState(), Command(5.0, 1.0, 2.0), Water(), Thrusters(commands=np.zeros(3 * SLOTS)), 0.05)[0]
    again = medusa(VesselState(), Command(5.0, 1.0, 2.0), Water(), Thrusters(commands=np.zeros(3 * SLOTS)), 0.05)[0]
    assert first == again
