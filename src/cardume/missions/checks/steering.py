"""How hard a guidance law steers, whichever law it is, and which of its numbers says so."""

import math

from cardume.missions.checks.finding import at_least, at_most, show
from cardume.missions.checks.scene import Craft, Scene
from cardume.signals import Demand

# Laws that close a small error at a rate [1/s] of their own, and over a length [m] of theirs: L = u / d.
BY_RATE = {"arcsine": "gain", "arcsine_integral": "gain"}
BY_LENGTH = {
    "line_of_sight": "lookahead",
    "along_path": "lookahead",
    "integral_line_of_sight": "lookahead",
    "adaptive_line_of_sight": "lookahead",
    "arcsine_with_current": "decay_length",
    "vector_field": "width",
}


def guidance_rate(craft: Craft) -> float:
    """L [1/s], how fast guidance closes a small error; 0 for a law of which that is not known.

    u / d of those that look a length d ahead, k1 of `arcsine`, u (2 / pi) chi_inf / w of `vector_field`
    """
    law = craft.law("guidance")
    if law.law.name in BY_RATE:
        return law.value(BY_RATE[law.law.name])
    if law.law.name not in BY_LENGTH:
        return 0.0
    return float(craft.path_speed().max()) * slope(craft) / law.value(BY_LENGTH[law.law.name])


def slope(craft: Craft) -> float:
    """Angle to the path [rad] per share of the law's length that the error is: 1, but of a vector field."""
    law = craft.law("guidance")
    return 2.0 / math.pi * law.value("approach") if law.law.name == "vector_field" else 1.0


def demand_of(craft: Craft) -> Demand | None:
    """What its guidance law asks for on plausible input; None where a user's law fails on it."""
    try:
        demand = craft.law("guidance").law.sample_answer()
    except Exception:  # it is told what is wrong when it is compiled
        return None
    return demand if isinstance(demand, Demand) else None


class Setting:
    """The number of a guidance law that says how hard it steers; only for laws with a `guidance_rate`."""

    def __init__(self, scene: Scene, craft: Craft) -> None:
        law = craft.law("guidance")
        self.is_rate = law.law.name in BY_RATE
        self.name = BY_RATE[law.law.name] if self.is_rate else BY_LENGTH[law.law.name]
        self.value, self.slope = law.value(self.name), slope(craft)
        self.unit = "1/s" if self.is_rate else "m"
        self.key = scene.key(craft, f"guidance.{self.name}")

    def gentler(self, rate: float, speed: float, slack: float) -> str:
        """The setting that closes small errors at a rate at most.

        Args:
            rate: [1/s]
            speed: [m/s] of the vehicle.
            slack: [-] how much gentler than that, > 1.
        """
        if self.is_rate:
            return at_most(self.key, rate / slack, self.unit)
        return at_least(self.key, speed * self.slope / rate * slack, self.unit)

    def __str__(self) -> str:
        return f"a {self.name.replace('_', ' ')} of {show(self.value, self.unit)}"
