"""Position laws that add a known disturbance to the fixes, so that a test sees what an observer makes of it."""

from typing import NamedTuple

from cardume.compiler import where
from cardume.laws import Meters, MetersPerSecond, Seconds
from cardume.onboard.estimation.position import position_law
from cardume.signals import Fix, NavigationEstimate


class Ticks(NamedTuple):
    """How many ticks there were."""

    count: float = 0.0


@position_law
def disturbed(
    fix: Fix, memory: Ticks, dt: Seconds, area: float = 0.0, step: Meters = 0.0, ramp: MetersPerSecond = 0.0
) -> tuple[NavigationEstimate, Ticks]:
    """From the second tick on: an impulse of that area [m s], a step, and a ramp, added to the north of every fix."""
    after = memory.count - 1.0
    impulse = where(abs(after) < 0.5, area / dt, 0.0)
    lasting = where(after > -0.5, step + ramp * dt * after, 0.0)
    return NavigationEstimate(fix.north + impulse + lasting, fix.east), Ticks(memory.count + 1.0)
