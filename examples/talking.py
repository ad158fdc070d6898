"""Fly figure 5 of the paper with ever fewer messages, and draw what they save and cost.

python examples/talking.py [FOLDER]     FOLDER: docs/pictures, as make pictures does, unless another is given
"""

import sys
from functools import lru_cache
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL import Image

import cardume
from cardume.report import style
from cardume.studies.comparing import values_of
from cardume.studies.flying import fly_seeds
from cardume.studies.statistics import paired_difference

FOLDER = Path(__file__).parents[1] / "docs" / "pictures"
RESOLUTION, WIDTH, COLORS = 130, 7.2, 96  # [dots per inch], [inch], of a picture
MISSION, SEEDS = "acoustics/figure-5-events", tuple(range(1001, 1201))
SURFACE, BELOW = "vehicles.surface.messaging=", "messaging="
EVERY, MIXED, EVENTS = "all every", "surface every", "all by events,"


def by_clock(period: float) -> str:
    """A schedule."""
    return f"{{schedule: periodic, period: {period} s, offset: 0.1 s}}"


def by_events(floor: float, heartbeat: float = 20.0) -> str:
    """A schedule."""
    return f"{{schedule: event_triggered, trigger_floor: {floor} m, heartbeat: {heartbeat} s}}"


CLOCKS = {f"{EVERY} {t:g} s": (SURFACE + by_clock(t), BELOW + by_clock(t)) for t in (1.0, 2.0, 3.0, 5.0, 10.0, 20.0)}
MIXTURES = {f"{MIXED} {t:g} s, the others by events": (SURFACE + by_clock(t),) for t in (1.0, 2.0, 3.0, 4.0, 5.0, 10.0)}
ALL_EVENTS = {f"{EVENTS} {c:g} m": (SURFACE + by_events(c), BELOW + by_events(c)) for c in (0.1, 0.25, 0.5)}
ARMS = CLOCKS | MIXTURES | ALL_EVENTS
FULL, TENTH = f"{EVERY} 1 s", f"{MIXED} 4 s, the others by events"


class Runs(NamedTuple):
    """(seed,) of one arm."""

    sent: np.ndarray  # [-] messages of the fleet
    coordination: np.ndarray  # [m] RMS
    position: np.ndarray  # [m] RMS, of the worst vehicle


@lru_cache
def flown(arm: str, seeds: tuple[int, ...] = SEEDS) -> Runs:
    """All missions of an arm; the same noise and draws for all arms."""
    mission = cardume.load(MISSION, overrides=ARMS[arm])
    runs = fly_seeds(mission, seeds)
    sent = sum(values_of(runs, f"{vehicle.name}.messages_sent", mission) for vehicle in mission.vehicles)
    return Runs(
        np.asarray(sent),
        values_of(runs, "coordination_error_rms", mission),
        values_of(runs, "position_error_rms", mission),
    )


def traffic(arm: str) -> float:
    """Messages over those of everybody every second [-]."""
    return float(flown(arm).sent.mean() / flown(FULL).sent.mean())


def costs(arm: str) -> tuple[float, float, float]:
    """How much more the coordination error is than with full traffic [-]: mean, and the 95 % interval in pairs."""
    full = flown(FULL).coordination
    found = paired_difference(flown(arm).coordination, full)
    return found.mean / full.mean(), found.low / full.mean(), found.high / full.mean()


def table_rows() -> list[str]:
    """For each arm: traffic, coordination error, how much more that is, and the position error."""
    rows = []
    for arm in ARMS:
        runs = flown(arm)
        mean, low, high = (100.0 * cost for cost in costs(arm))
        more = "" if arm == FULL else f"{mean:+.1f} % ({low:+.1f} to {high:+.1f})"
        numbers = (f"{100.0 * traffic(arm):.1f} %", f"{runs.coordination.mean():.3f} m", more)
        rows.append("| " + " | ".join((arm, *numbers, f"{runs.position.mean():.2f} m")) + " |")
    return rows


def draw() -> Any:
    """Error against traffic, for the three ways to talk."""
    figure = style.new_figure(WIDTH, 2.9)
    figure.set_layout_engine("constrained")
    axes = figure.subplots()
    families = {"by the clock": CLOCKS, "surface by the clock, divers by events": MIXTURES, "all by events": ALL_EVENTS}
    for k, (label, arms) in enumerate(families.items()):
        points = np.array([(100.0 * traffic(arm), *np.multiply(100.0, costs(arm))) for arm in arms])
        share, mean, low, high = points[np.argsort(points[:, 0])].T
        axes.vlines(share, low, high, color=style.color(k), lw=1.2)
        axes.plot(share, mean, "-o", color=style.color(k), mfc="white", ms=4.0, lw=0.9, label=label)
    axes.axhline(10.0, color=style.FAINT, lw=0.8, dashes=(4, 2))
    axes.axvline(10.0, color=style.FAINT, lw=0.8, dashes=(4, 2))
    axes.set_xscale("log")
    axes.set_xticks([5.0, 10.0, 20.0, 50.0, 100.0], ["5", "10", "20", "50", "100"])
    axes.minorticks_off()
    axes.set_ylim(-5.0, 80.0)
    axes.set_xlabel("messages, of all every second [%]")
    axes.set_ylabel("coordination error, more by [%]")
    axes.grid(color="#EEEEEE", lw=0.6)
    axes.legend(fontsize=7.0, frameon=False)
    return figure


def main(folder: Path = FOLDER) -> None:
    """Draw it; the same missions give the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    with style.styled(), BytesIO() as drawn:
        draw().savefig(drawn, dpi=RESOLUTION)
        Image.open(drawn).convert("RGB").quantize(COLORS).save(folder / "talk-by-events.png", optimize=True)
    print("\n".join(table_rows()))


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
