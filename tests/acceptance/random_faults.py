"""Random schedules of faults for a fleet, as text for a mission file; a number gives the same one again."""

from __future__ import annotations

import numpy as np

from cardume.missions.faults import FAULTS
from cardume.missions.schema import Bounds, Member, Quantity, Word, fields_of

BIASES = {
    "gnss": "north: {:.3g} m",
    "ahrs": "heading: {:.3g} deg",
    "depth": "depth: {:.3g} m",
    "usbl": "azimuth: {:.3g} deg",
    "dvl": "surge: {:.2f} m/s",
    "thruster_speed": "shaft_speed: {:.3g} rpm",
    "altimeter": "altitude: {:.3g} m",
}
LARGEST = {"s": 90.0, "m": 30.0, "m/s": 0.5, "rad": 3.0, "": 1.0, "rad/s": 50.0}  # where bounds are wider


def random_faults(number: int, carried: dict[str, tuple[str, ...]], duration: float) -> list[str]:
    """One to five faults.

    Args:
        number: of the schedule.
        carried: by vehicle, its sensors.
        duration: [s] of the mission.
    """
    draw = np.random.default_rng([5, number])
    return [_random_fault(draw, carried, duration) for _ in range(draw.integers(1, 6))]


def _random_fault(draw: np.random.Generator, carried: dict[str, tuple[str, ...]], duration: float) -> str:
    kind = str(draw.choice(sorted(FAULTS)))
    fleet = sorted(carried)
    if kind == "gnss_lost":
        fleet = [name for name in fleet if "gnss" in carried[name]]
    elif kind == "usbl_outlier":
        fleet = [name for name in fleet if "usbl" in carried[name]]
    vehicle = str(draw.choice(fleet))
    keys = [f"kind: {kind}", f"vehicle: {vehicle}", f"from: {draw.uniform(0, duration):.1f} s"]
    if draw.random() < 0.8:
        keys.append(f"lasts: {draw.uniform(0.1, duration):.1f} s")
    for field in fields_of(FAULTS[kind]):
        if field.key in ("from", "to", "lasts") or isinstance(field.kind, Member):
            continue
        if field.key == "sensor":
            sensor = str(draw.choice(carried[vehicle]))
            keys.append(f"sensor: {sensor}")
            if kind == "sensor_biased":
                keys.append(BIASES[sensor].format(draw.normal(0, 0.3 if sensor == "dvl" else 20)))
        elif isinstance(field.kind, Word):
            keys.append(f"{field.key}: {draw.choice(field.kind.choices)}")
        elif isinstance(field.kind, Quantity) and kind != "sensor_biased":
            keys.append(f"{field.key}: {_random_number(draw, field.kind)} {field.kind.unit}".strip())
    return f"{{{', '.join(keys)}}}"


def _random_number(draw: np.random.Generator, kind: Quantity) -> str:
    bounds: Bounds = kind.bounds
    low, high = max(bounds.low, -LARGEST[kind.unit]), min(bounds.high, LARGEST[kind.unit])
    return f"{max(draw.uniform(low, high), 1e-3 if bounds.low_open else low):.4g}"
