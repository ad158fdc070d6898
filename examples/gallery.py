"""Draw the pictures of docs/theory/gallery.md from the built-in missions of the paper.

python examples/gallery.py [FOLDER]        FOLDER: docs/pictures, as make pictures does, unless another is given
"""

import math
import sys
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image

import cardume
from cardume.report import style
from cardume.report.plan import draw_plan
from cardume.report.space import draw_space
from cardume.simulation.flight import Flight

FOLDER = Path(__file__).parents[1] / "docs" / "pictures"
RESOLUTION = 130  # [dots per inch]
WIDTH = 7.2  # [inch]
COLORS = 64  # of a picture
DRIFT = "±0.18 m: 10 s of sway in the arc"
LAWS = {"sight": "line of sight (3)", "arcsine": "arcsine (4)", "along": "along the path (18)"}


def fly(name: str, *overrides: str) -> Flight:
    """One of the paper's missions."""
    return cardume.fly(cardume.load(f"paper/{name}", overrides))


def panels(rows: int, columns: int, height: float, **how: Any) -> tuple[Any, Any]:
    """A figure and its axes, (rows, columns)."""
    figure = style.new_figure(WIDTH, height)
    figure.set_layout_engine("constrained")
    return figure, figure.subplots(rows, columns, squeeze=False, **how)


def dress(axes: Any, title: str, x: str, y: str) -> None:
    """Title, names of the axes, a faint grid."""
    axes.set_title(title, fontsize=8.0, loc="left")
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(color="#EEEEEE", lw=0.6)
    axes.set_axisbelow(True)


def map_of(axes: Any, flight: Flight, names: dict[str, str]) -> None:
    """Path and true tracks, north up."""
    path = flight.reference_path
    axes.plot(path[:, 1], path[:, 0], color=style.PATH, lw=4.0, solid_capstyle="butt", label="path")
    for k, name in enumerate(flight.vehicle_names):
        if name in names:
            east, north = flight.channels["east"][:, k], flight.channels["north"][:, k]
            axes.plot(east, north, color=style.color(k), lw=1.1, label=names[name])
    axes.set_aspect("equal", adjustable="datalim")
    dress(axes, "", "east [m]", "north [m]")


def figure_3() -> Any:
    """Two vehicles in a current: plan, and the error over time beside the closed form."""
    flight = fly("figure-3")
    figure, ((left, right),) = panels(1, 2, 3.1, width_ratios=(1.0, 1.6))
    names = {"with": "observer and crab", "without": "neither"}
    map_of(left, flight, names)
    left.annotate("", (32.0, 30.0), (17.0, 30.0), arrowprops={"arrowstyle": "-|>", "color": style.INK, "lw": 1.0})
    left.text(24.5, 31.5, "0.15 m/s", ha="center", fontsize=7.0)
    offset = 5.0 * 0.15 / math.sqrt(0.5**2 - 0.15**2)
    for sign in (1.0, -1.0):
        right.axhline(sign * offset, color=style.FAINT, lw=0.8, dashes=(4, 2))
    right.text(345.0, offset + 0.1, "d V / sqrt(u² - V²) = 1.572 m", ha="right", fontsize=7.0)
    for k, name in enumerate(flight.vehicle_names):
        right.plot(flight.times, flight.channels["cross_track"][:, k], color=style.color(k), lw=1.2, label=names[name])
    shade_arcs(right, flight, 0)
    right.legend(loc="upper right", fontsize=7.0, frameon=False)
    dress(right, "shaded: the vehicle with crab is in the arc", "time [s]", "cross-track error [m]")
    right.set_xlim(0.0, flight.times[-1])
    return figure


def shade_arcs(axes: Any, flight: Flight, vehicle: int) -> None:
    """Mark when a vehicle is in an arc."""
    in_arc = flight.channels["curvature"][:, vehicle] != 0.0
    axes.fill_between(
        flight.times, 0.0, 1.0, where=in_arc, transform=axes.get_xaxis_transform(), color="#F2F2F2", lw=0.0, zorder=0
    )


def figure_4() -> Any:
    """Dead reckoning between fixes: plan, and the components of the estimation error."""
    flight, diver = fly("figure-4"), 1
    figure = style.new_figure(WIDTH, 3.9)
    figure.set_layout_engine("constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(1.0, 2.0))
    plan = figure.add_subplot(grid[:, 0])
    map_of(plan, flight, {"diver": "true"})
    channels = {name: values[:, diver] for name, values in flight.channels.items()}
    plan.plot(
        channels["east_estimate"],
        channels["north_estimate"],
        color=style.color(2),
        lw=0.9,
        dashes=(3, 1),
        label="believed",
    )
    plan.legend(loc="lower right", fontsize=7.0, frameon=False)
    messages = flight.messages
    heard = messages["time_received"][(messages["receiver"] == diver) & ~messages["lost"]]
    for row, (axis, letter) in enumerate((("north", "x"), ("east", "y"))):
        axes = figure.add_subplot(grid[row, 1])
        shade_arcs(axes, flight, diver)
        for k, time in enumerate(heard):
            axes.axvline(time, color=style.FAINT, lw=0.5, dashes=(1, 2), label="a fix is heard" if k == 0 else None)
        for level in (0.18, -0.18):
            axes.axhline(level, color=style.color(1), lw=0.7, dashes=(4, 2), label=DRIFT if level > 0 else None)
        axes.plot(flight.times, channels[f"{axis}_estimate"] - channels[axis], color=style.color(0), lw=1.1)
        axes.set_ylim(-0.5, 0.5)
        axes.set_xlim(0.0, flight.times[-1])
        start = channels[f"{axis}_estimate"][0] - channels[axis][0]
        note = f"{letter}: before the first fix {start:+.0f} m; shaded: in the arc"
        dress(axes, note, "time [s]" if row else "", f"{axis}, believed\nless true [m]")
        if row == 0:
            axes.legend(loc="upper right", fontsize=6.5, frameon=False, ncols=2)
    return figure


def figure_5_coordination() -> Any:
    """What one lossy message a second costs beside communication that never fails, and what late fixes cost."""
    figure, axes = panels(3, 1, 4.4, sharex=True, sharey=True)
    told = {
        "a message a second, a fifth of them lost": ("figure-5",),
        "the same, fixes moved on by their age": ("figure-5", "position.law=reset_compensated"),
        "continuous communication": ("figure-5-continuous",),
    }
    for (title, mission), row in zip(told.items(), axes[:, 0], strict=True):
        flight = fly(*mission)
        state = flight.channels["coordination_state"]
        for k, vehicle in enumerate(flight.vehicle_names):
            row.plot(flight.times, state[:, k] - state.mean(axis=1), color=style.color(k), lw=1.0, label=vehicle)
        rms = flight.metrics.fleet["coordination_error_rms"]
        title = f"{title}: largest difference {rms:.2f} m rms"
        dress(row, title, "time [s]" if row is axes[-1, 0] else "", "coordination state\nless mean [m]")
    axes[0, 0].set_ylim(-1.0, 1.0)
    axes[0, 0].set_xlim(0.0, 760.0)
    axes[0, 0].legend(loc="lower right", fontsize=7.0, frameon=False, ncols=3)
    return figure


def guidance_times_compensation() -> Any:
    """Three laws in one current, with crab and without."""
    figure, axes = panels(3, 1, 4.6, sharex=True)
    waters = {
        "with observer and crab": (),
        "the same in still water": ("current=none",),
        "with neither": ("compensation=none", "current_observer=none"),
    }
    for (title, overrides), row in zip(waters.items(), axes[:, 0], strict=True):
        flight = fly("guidance-times-compensation", *overrides)
        shade_arcs(row, flight, 0)
        for k, vehicle in enumerate(flight.vehicle_names):
            row.plot(
                flight.times, flight.channels["cross_track"][:, k], color=style.color(k), lw=1.0, label=LAWS[vehicle]
            )
        row.set_ylim(*((-1.5, 1.5) if title == "with neither" else (-0.75, 0.75)))
        dress(row, title, "time [s]" if row is axes[-1, 0] else "", "cross-track\nerror [m]")
    axes[0, 0].set_xlim(0.0, flight.times[-1])
    axes[0, 0].legend(loc="upper right", fontsize=7.0, frameon=False, ncols=3)
    return figure


PICTURES = {
    "figure-3": figure_3,
    "figure-4": figure_4,
    "figure-5": lambda: draw_plan(fly("figure-5")),
    "figure-5-space": lambda: draw_space(fly("figure-5")),
    "figure-5-coordination": figure_5_coordination,
    "guidance-times-compensation": guidance_times_compensation,
}


def main(folder: Path = FOLDER) -> None:
    """Draw them all; the same missions give the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, draw in PICTURES.items():
        with style.styled(), BytesIO() as drawn:
            draw().savefig(drawn, dpi=RESOLUTION)
            # Lines on white need few colors: a third of the size.
            Image.open(drawn).convert("RGB").quantize(COLORS).save(folder / f"{name}.png", optimize=True)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
