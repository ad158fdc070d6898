"""A short flight and what one of its vehicles met, for others to write down in their own formats."""

import functools
from pathlib import Path
from typing import NamedTuple

import numpy as np

from cardume.missions.drawing import draw
from cardume.missions.flying import fly_mission
from cardume.missions.log import Log, write_log
from cardume.missions.opening import open_mission
from cardume.missions.recordings import log as flights
from cardume.missions.recordings.playing import Believed, play
from cardume.simulation.fleet import Held

DURATION = 60.0  # [s]
OVERRIDES = (
    f"duration={DURATION} s",
    "position={law: kalman_replay}",
    "current_observer={law: from_position}",
)
PLACES = {name: k for k, name in enumerate(Held._fields)}


class Reading(NamedTuple):
    """What a vehicle measured in a tick."""

    time: float  # [s]
    heading: float  # [rad]
    yaw_rate: float  # [rad/s]
    surge: float  # [m/s]
    north: float  # [m] of a fix; NaN: none
    east: float  # [m]
    age: float  # [s]
    variance: float  # [m^2]


class Flown(NamedTuple):
    """A vehicle's own readings, and what it made of them in flight."""

    readings: list[Reading]
    believed: Believed
    log: Log

    @property
    def start(self) -> str:
        """Where it believed it was at first, as --start takes it."""
        north, east = self.believed.before[0, :2].tolist()
        return f"{north!r},{east!r}"


def fly_to(folder: Path, mission: str = "paper/figure-5", overrides: tuple[str, ...] = OVERRIDES) -> Path:
    """Fly a mission and write its log."""
    drawn = draw(open_mission(mission, list(overrides)))
    path = folder / "log.nc"
    write_log(path, fly_mission(drawn), mission=drawn.to_yaml(folder), version="test")
    return path


@functools.cache
def surface() -> Flown:
    """The surface vehicle of figure 5, which has GNSS."""
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        log = flights.read(fly_to(Path(folder)))
    _, (met,) = flights.meet_again(log, ["surface"], lambda name: [], directory=Path())
    believed = play(met)
    held = met.readings[:, : len(Held._fields)]
    readings = [
        Reading(
            float(time),
            float(held[k, PLACES["heading"]]),
            float(held[k, PLACES["yaw_rate"]]),
            float(believed.motion[k, 2]),
            *(float(x) for x in believed.fixes[k, :4]),
        )
        for k, time in enumerate(believed.times)
    ]
    return Flown(readings, believed, log)


def apart(believed: Believed, other: Believed) -> float:
    """[m] the largest distance of two tracks over the ticks that both have."""
    size = min(len(believed.times), len(other.times))
    return float(np.max(np.hypot(*(believed.position[:size] - other.position[:size]).T)))
