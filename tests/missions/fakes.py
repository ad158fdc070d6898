"""A catalog with made-up laws under the contract's names, so that these tests need no compiled code."""

import math
from dataclasses import dataclass

from cardume.errors import LawError
from cardume.missions import Catalog


@dataclass(frozen=True)
class FakeParameter:
    name: str
    default: float
    unit: str = ""
    low: float = -math.inf
    high: float = math.inf
    low_open: bool = False
    high_open: bool = False
    words: tuple[str, ...] = ()


@dataclass(frozen=True)
class FakeLaw:
    family: str
    name: str
    parameters: tuple[FakeParameter, ...] = ()
    doc: str = "A made-up law."


P = FakeParameter
PERIOD = P("period", 0.2, "s", 0.0, math.inf, low_open=True)
SENSED = (PERIOD, P("latency", 0.0, "s", 0.0, 60.0))
LOOKAHEAD = P("lookahead", 5.0, "m", 0.0, math.inf, low_open=True)

LAWS = (
    FakeLaw("guidance", "line_of_sight", (LOOKAHEAD,)),
    FakeLaw("guidance", "arcsine", (P("gain", 0.1, "1/s", 0.0), P("saturation", 0.99, "", 0.0, 1.0))),
    FakeLaw("guidance", "along_path", (LOOKAHEAD,)),
    FakeLaw("reference_point", "projection"),
    FakeLaw("reference_point", "virtual_target", (P("target_gain", 0.5, "1/s", 0.0),)),
    FakeLaw("compensation", "none"),
    FakeLaw("compensation", "crab"),
    FakeLaw("current_observer", "none"),
    FakeLaw("current_observer", "complementary", (P("k1", 0.2, "1/s"), P("k2", 0.01, "1/s^2"))),
    FakeLaw("position", "direct"),
    FakeLaw("position", "reset"),
    FakeLaw("neighbors", "coordinated"),
    FakeLaw("coordination", "none"),
    FakeLaw(
        "coordination", "laplacian_tanh", (P("gain", 0.2, "m/s", 0.0), P("length_scale", 1.0, "m", 0.0, 1e3, True))
    ),
    FakeLaw("messaging", "silent"),
    FakeLaw("messaging", "periodic", (P("period", 1.0, "s", 0.0, math.inf, low_open=True),)),
    FakeLaw("speed", "from_shaft", (P("scale", 1.0, "", 0.0, 10.0),)),
    FakeLaw("autopilot", "pid", (P("heading_gain", 2.0, "N m"),)),
    FakeLaw("model", "medusa"),
    FakeLaw("model", "kinematic", (P("heading_time_constant", 0.0, "s", 0.0),)),
    FakeLaw("current", "uniform", (P("speed", 0.0, "m/s", 0.0, 20.0), P("towards", 0.0, "rad"))),
    FakeLaw("current", "gridded", (P("variation", 0.0, "m/s", 0.0),)),
    FakeLaw("acoustics", "ideal"),
    FakeLaw("acoustics", "bernoulli", (P("loss", 0.0, "", 0.0, 1.0), P("delay", 0.0, "s", 0.0))),
    FakeLaw("gnss", "gnss", (P("sigma", 0.5, "m", 0.0), *SENSED)),
    FakeLaw("ahrs", "ahrs", (P("sigma", 0.01, "rad", 0.0), *SENSED)),
    FakeLaw("depth", "pressure", SENSED),
    FakeLaw("usbl", "usbl", SENSED),
    FakeLaw("dvl", "dvl", SENSED),
    FakeLaw("altimeter", "altimeter", (P("sigma", 0.1, "m", 0.0), *SENSED)),
    FakeLaw("bathymetry", "flat", (P("depth", 30.0, "m", 0.0, math.inf, low_open=True),)),
    FakeLaw("thruster_speed", "tachometer", (P("scale", 1.0, "", 0.0, 10.0), P("noise", 0.0, "rad/s", 0.0), *SENSED)),
)
METRICS = {"cross_track_rms": "m", "coordination_error_max": "m", "settling_time": "s", "swath_coverage": ""}


def laws_of(family: str) -> dict[str, FakeLaw]:
    return {law.name: law for law in LAWS if law.family == family}


def resolve_law(family: str, name: str) -> FakeLaw:
    """`mine:pure_pursuit` is a good law; the others fail, each in its own way."""
    if name == "mine:pure_pursuit":
        return FakeLaw("guidance", name.split(":")[1], (P("radius", 7.0, "m", 0.0),))
    if name == "mine:broken":
        raise SyntaxError("invalid syntax\n(mine.py, line 3)")
    raise LawError(f"there is no {name.split(':')[1]} in {name.split(':')[0]}.py")


CATALOG = Catalog(laws_of=laws_of, resolve_law=resolve_law, metrics=METRICS)
