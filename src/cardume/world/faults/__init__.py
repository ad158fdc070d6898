"""Faults: what goes wrong with sensors, thrusters, clocks, modems and the sea, and when."""

from cardume.world.faults.base import (
    BIASED,
    BLANK,
    CLOCK,
    FORGED,
    FROZEN,
    LOST,
    OUTLIER,
    REPLAYED,
    SILENT,
    STIRRED,
    WEAK,
    Fault,
    Kept,
    beats,
    is_active,
)
from cardume.world.faults.clock import shifted
from cardume.world.faults.current_step import stirred
from cardume.world.faults.forged_packets import forged_report, forged_sighting
from cardume.world.faults.thruster_weak import Weakness, weakened
from cardume.world.faults.usbl_outlier import displaced
from cardume.world.faults.vehicle_lost import adrift

__all__ = [
    "BIASED",
    "BLANK",
    "CLOCK",
    "FORGED",
    "FROZEN",
    "LOST",
    "OUTLIER",
    "REPLAYED",
    "SILENT",
    "STIRRED",
    "WEAK",
    "Fault",
    "Kept",
    "Weakness",
    "adrift",
    "beats",
    "displaced",
    "forged_report",
    "forged_sighting",
    "is_active",
    "shifted",
    "stirred",
    "weakened",
]
