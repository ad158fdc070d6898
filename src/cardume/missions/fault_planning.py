"""From the faults of a mission, as written, to those of a plan."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from cardume.missions.faults import FAULTS
from cardume.missions.mission import Mission
from cardume.missions.vehicle import Vehicle
from cardume.simulation.fleet import SENSORS
from cardume.simulation.plan import FaultPlan, VehiclePlan
from cardume.units import show_quantity
from cardume.world import faults as engine
from cardume.world.faults import Fault, Weakness

NAMES = {record: kind for kind, record in FAULTS.items()}
QUANTITIES: Mapping[str, tuple[str, ...]] = {
    "gnss": ("north", "east"),
    "ahrs": ("heading",),
    "depth": ("depth",),
    "usbl": ("range", "azimuth"),
    "dvl": ("surge",),
    "thruster_speed": ("shaft_speed",),
    "altimeter": ("altitude",),
}
SIDES = {
    "port": ("port",),
    "starboard": ("starboard",),
    "horizontal": ("port", "starboard"),
    "vertical": ("vertical",),
    "all": ("port", "starboard", "vertical"),
}
DEVICES = {
    "gnss": "GNSS",
    "ahrs": "AHRS",
    "depth": "depth sensor",
    "usbl": "USBL",
    "dvl": "DVL",
    "thruster_speed": "sensor of shaft speed",
    "altimeter": "altimeter",
}


def plan_faults(mission: Mission, fleet: tuple[VehiclePlan, ...]) -> tuple[FaultPlan, ...]:
    """What goes wrong in a mission, as the engine takes it.

    Args:
        mission: with every value fixed.
        fleet: its vehicles, planned.

    Raises:
        MissionError: a fault that ends before it begins, or of something that the vehicle does not have.
    """
    plans = {plan.name: plan for plan in fleet}
    return tuple(
        plan for number, fault in enumerate(mission.faults) for plan in _Planner(mission, number, fault, plans).plans()
    )


class _Planner:
    """Plans one fault."""

    def __init__(self, mission: Mission, number: int, fault: Any, plans: Mapping[str, VehiclePlan]) -> None:
        self.mission, self.fault, self.kind = mission, fault, NAMES[type(fault)]
        self.key, self.plan = f"faults.{number}", plans.get(fault.vehicle or "")
        self.told: Vehicle | None = next((v for v in mission.vehicles if v.name == fault.vehicle), None)

    def plans(self) -> list[FaultPlan]:
        """The rows that it is in the engine."""
        make: Mapping[str, Callable[[], list[FaultPlan]]] = {
            "modem_silent": lambda: [self._row(engine.SILENT, "its modem falls silent")],
            "gnss_lost": lambda: [self._row(engine.BLANK, "its GNSS is lost", sensor=self._carried("gnss", "vehicle"))],
            "usbl_outlier": self._outlier,
            "sensor_frozen": lambda: self._sensor(engine.FROZEN, "freezes"),
            "sensor_biased": self._biased,
            "sensor_nan": lambda: self._sensor(engine.BLANK, "says NaN"),
            "thruster_weak": self._weak,
            "vehicle_lost": lambda: [
                self._row(engine.LOST, "it is lost: no thrust, no modem"),
                self._row(engine.SILENT, ""),
            ],
            "clock_offset": lambda: [self._row(engine.CLOCK, self._clock("offset", "s"), size=self.fault.offset)],
            "clock_drift": lambda: [self._row(engine.CLOCK, self._clock("drift", ""), more=self.fault.drift)],
            "current_step": self._step,
            "forged_packets": lambda: self._packets(engine.FORGED, "somebody forges its packets", self.fault.size),
            "replayed_packets": lambda: self._packets(engine.REPLAYED, "somebody replays its packets", 0.0),
        }
        return make[self.kind]()

    def _row(
        self, kind: int, says: str, sensor: int = -1, weakness: Weakness = Weakness(), **numbers: float
    ) -> FaultPlan:
        begin, end, tick = self.fault.from_, self._end(), self.mission.tick
        # as the engine counts time, so that begin and end fall on ticks
        window = {"begin": round(begin / tick) * tick, "end": round(end / tick) * tick}
        return FaultPlan(kind, self.fault.vehicle, Fault(**window, **numbers), sensor, weakness, says)

    def _end(self) -> float:
        begin, end, lasts = self.fault.from_, self.fault.to, self.fault.lasts
        if end is not None and lasts is not None:
            raise self.mission.error(f"{self.key}.lasts", "stands beside to; give one of them")
        if end is not None and not end > begin:
            given, first = show_quantity(end, "s"), show_quantity(begin, "s")
            raise self.mission.error(
                f"{self.key}.to", f"given {given}; must be later than from, {first}; where they are drawn, give lasts"
            )
        if lasts is not None:
            return float(begin + lasts)
        return float(end) if end is not None else 2.0 * self.mission.duration

    def _carried(self, sensor: str, key: str) -> int:
        """The place of a sensor that the vehicle carries."""
        if self.plan is None or sensor not in self.plan.laws:
            known = ", ".join(s for s in SENSORS if self.plan is not None and s in self.plan.laws)
            raise self.mission.error(
                f"{self.key}.{key}", f"{self.fault.vehicle} carries no {sensor}; it carries {known or 'no sensor'}"
            )
        return SENSORS.index(sensor)

    def _sensor(self, kind: int, does: str) -> list[FaultPlan]:
        place = self._carried(self.fault.sensor, "sensor")
        return [self._row(kind, f"its {DEVICES[self.fault.sensor]} {does}", place)]

    def _biased(self) -> list[FaultPlan]:
        sensor, place = self.fault.sensor, self._carried(self.fault.sensor, "sensor")
        own, every = QUANTITIES[sensor], [name for names in QUANTITIES.values() for name in names]
        given = {name: getattr(self.fault, name) for name in every if getattr(self.fault, name) is not None}
        for name in given:
            if name not in own:
                raise self.mission.error(
                    f"{self.key}.{name}", f"is not measured by {sensor}; of that give {' or '.join(own)}"
                )
        if not given:
            raise self.mission.error(f"{self.key}.sensor", f"the bias is missing; of {sensor} give {' or '.join(own)}")
        numbers = dict(zip(("size", "more"), (given.get(name, 0.0) for name in own), strict=False))
        says = " and ".join(f"{name} {value:+.4g}" for name, value in given.items())
        return [self._row(engine.BIASED, f"its {DEVICES[sensor]} has a bias of {says} (SI)", place, **numbers)]

    def _outlier(self) -> list[FaultPlan]:
        place, f = self._carried("usbl", "vehicle"), self.fault
        says = f"{100 * f.probability:.3g} % of its USBL readings are {f.size:g} m beside the target"
        return [self._row(engine.OUTLIER, says, place, size=f.size, chance=f.probability)]

    def _weak(self) -> list[FaultPlan]:
        assert self.plan is not None
        model, f = self.plan.laws["model"], self.fault
        arm, c, most = (model.value_or(n, math.nan) for n in ("thruster_arm", "thrust_coefficient", "max_shaft_speed"))
        if math.isnan(arm + c + most):
            raise self.mission.error(
                f"{self.key}.vehicle", f"its model, {model.law.name}, has no thrusters; take medusa, or vehicle_lost"
            )
        shares = dict.fromkeys(SIDES[f.thruster], f.efficiency)
        which = {"all": "thrusters", "horizontal": "horizontal thrusters", "vertical": "vertical thrusters"}
        name = which.get(f.thruster, f"{f.thruster} thruster")
        state = f"{name} push with {100 * f.efficiency:.3g} % of the force" if f.efficiency else f"{name} die"
        state = state if name.endswith("s") else state.replace("push", "pushes").replace("die", "dies")
        return [self._row(engine.WEAK, f"its {state}", weakness=Weakness(**shares, arm=arm, most=c * most * most))]

    def _clock(self, name: str, unit: str) -> str:
        return (
            f"its clock has {'an' if name == 'offset' else 'a'} {name} of {getattr(self.fault, name):g} {unit}".strip()
        )

    def _step(self) -> list[FaultPlan]:
        speed, towards = self.fault.speed, self.fault.towards
        says = f"the current changes by {show_quantity(speed, 'm/s')} towards {show_quantity(towards, 'rad')}"
        return [self._row(engine.STIRRED, says, size=speed * math.cos(towards), more=speed * math.sin(towards))]

    def _packets(self, kind: int, says: str, size: float) -> list[FaultPlan]:
        """Packets that are taken for genuine: all, or with authentication one forged one in 2^(8 n), none replayed."""
        assert self.plan is not None
        code = self.plan.medium.code if self.plan.medium is not None else 0.0
        chance = 1.0 if code < 0.5 else 2.0 ** (-8.0 * code) if kind == engine.FORGED else 0.0
        period = max(self.mission.tick, self.fault.period)
        return [self._row(kind, says, size=size, chance=chance, period=period)]
