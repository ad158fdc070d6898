"""Fly the worked mission by ranges of docs/tutorials, and draw its pictures and tables.

python examples/ranging.py [FOLDER]     FOLDER: docs/pictures, as make pictures does, unless another is given
"""

import sys
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL import Image

import cardume
from cardume.missions.flying import fly_mission
from cardume.report import style
from cardume.simulation.flight import Flight

FOLDER = Path(__file__).parents[1] / "docs" / "pictures"
RESOLUTION, WIDTH, COLORS = 130, 7.2, 96  # [dots per inch], [inch], of a picture
MISSION, SEEDS, LATE = "ranging/by-range", tuple(range(1, 61)), 300.0  # [s] from when errors count
LOST = 5.0  # [m] of error: the filter has settled on another place
MANEUVER = "vehicles.surface.maneuver="
BEHIND = (f"{MANEUVER}none", "vehicles.surface.offset.ahead=-20 m", "vehicles.surface.start.along_track=-20 m")
LINE = "path={type: line, start: {course: 30 deg}, length: 310 m}"
SHORT = "path={type: lawnmower, start: {course: 30 deg}, leg: 30 m, legs: 5, spacing: 24 m}"
ARMS = {  # what is said of an arm, and what is set for it
    "the maneuver that tells most": (),
    "circle of 20 m": (f"{MANEUVER}{{type: circle, radius: 20 m, speed_max: 0.6 m/s}}",),
    "zig-zag of 30 m": (f"{MANEUVER}{{type: zigzag, width: 30 m, astern: 15 m, speed_max: 0.6 m/s}}",),
    "rigid, 20 m behind, legs of 30 m": (*BEHIND, SHORT),
    "rigid, 20 m behind, on one line": (*BEHIND, LINE),
    "with bearings": ("vehicles.surface.sensors.usbl.bearing_loss=0",),
}


class Outcome(NamedTuple):
    """What became of the diver's position in one mission."""

    late: float  # [m] RMS of its error after LATE
    best: float  # [m] standard deviation by the filter at the end, along its shorter axis
    worst: float  # [m] and along its longer one
    fast: float  # [m/s] over ground of the surface vehicle, 95 % of the time below


def fly(arm: str, seed: int) -> Flight:
    """One mission of an arm."""
    return fly_mission(cardume.load(MISSION, overrides=[f"seed={seed}", *ARMS[arm]]))


def outcome(arm: str, seed: int) -> Outcome:
    """What became of one mission."""
    flight = fly(arm, seed)
    channel, names = flight.channels, list(flight.vehicle_names)
    diver, surface = names.index("diver"), names.index("surface")
    late = flight.times >= LATE
    errors = [channel[f"{axis}_estimate"][:, diver] - channel[axis][:, diver] for axis in ("north", "east")]
    nn, ne, ee = (channel[c][-1, diver] for c in ("north_variance", "north_east_covariance", "east_variance"))
    shorter, longer = np.sqrt(np.linalg.eigvalsh([[nn, ne], [ne, ee]]))
    fast = float(np.quantile(channel["speed"][:, surface], 0.95))
    return Outcome(float(np.sqrt(np.mean(np.sum(np.square(errors), axis=0)[late]))), shorter, longer, fast)


@lru_cache
def outcomes(arm: str, seeds: tuple[int, ...] = SEEDS) -> np.ndarray:
    """(seed, 4) of one arm; the same noise for all arms."""
    with ThreadPoolExecutor() as pool:
        return np.array(list(pool.map(lambda seed: outcome(arm, seed), seeds)))


def meters(value: float) -> str:
    """A length with as many digits as mean something."""
    return f"{value:.2f} m" if value < 9.995 else f"{value:.0f} m"


def table_rows() -> list[str]:
    """For each arm: error after 300 s of half of the missions; how many are lost; deviations at the end; speed."""
    rows = []
    for arm in ARMS:
        late, best, worst, fast = outcomes(arm).T
        numbers = (
            meters(np.median(late)),
            f"{np.count_nonzero(late > LOST)}",
            meters(np.median(best)),
            meters(np.median(worst)),
            f"{np.median(fast):.2f} m/s",
        )
        rows.append("| " + " | ".join((arm, *numbers)) + " |")
    return rows


def draw() -> Any:
    """Left one mission with the maneuver that tells most; right the errors of all missions of each arm."""
    figure = style.new_figure(WIDTH, 3.6)
    figure.set_layout_engine("constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.15))
    flight = fly("the maneuver that tells most", 1)
    for k, name in enumerate(flight.vehicle_names):
        north, east = flight.channels["north"][:, k], flight.channels["east"][:, k]
        left.plot(east, north, color=style.color(k), lw=1.0, label=name)
        if name == "diver":
            believed = [flight.channels[f"{axis}_estimate"][:, k] for axis in ("east", "north")]
            left.plot(*believed, color=style.INK, lw=0.7, dashes=(3, 2), label="diver, as it believes")
    left.set_aspect("equal")
    left.set_xlabel("east [m]")
    left.set_ylabel("north [m]")
    left.legend(fontsize=6.5, frameon=False, loc="lower right")
    arms = list(ARMS)
    for k, arm in enumerate(arms):
        late = np.sort(outcomes(arm)[:, 0])
        right.plot(
            late,
            np.full(len(late), -k) + 0.5 * (np.arange(len(late)) / len(late) - 0.5),
            ".",
            color=style.color(k),
            ms=2.5,
        )
    right.axvline(1.2, color=style.FAINT, lw=0.8, dashes=(4, 2))
    right.set_xscale("log")
    right.set_xticks([0.2, 1.0, 5.0, 20.0, 100.0], ["0.2", "1", "5", "20", "100"])
    right.minorticks_off()
    right.set_yticks(-np.arange(len(arms)), arms, fontsize=7.0)
    right.set_xlabel("position error of the diver after 300 s, RMS [m]")
    for axes in (left, right):
        axes.grid(color="#EEEEEE", lw=0.6)
    return figure


def main(folder: Path = FOLDER) -> None:
    """Draw it; the same missions give the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    with style.styled(), BytesIO() as drawn:
        draw().savefig(drawn, dpi=RESOLUTION)
        Image.open(drawn).convert("RGB").quantize(COLORS).save(folder / "by-range.png", optimize=True)
    print("\n".join(table_rows()))


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
