"""Fly the worked studies of docs/tutorials, and draw their pictures and tables.

python examples/studies.py [FOLDER [KEPT]]     FOLDER: docs/pictures, as make pictures does, unless another is given
                                               KEPT: where the studies are, or will be, kept; runs/worked
"""

import math
import sys
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

import cardume
from cardume.report import style
from cardume.report.study.curves import MARKERS
from cardume.report.study.maps import draw_map
from cardume.studies.answers.distributions import mean_of

FOLDER = Path(__file__).parents[1] / "docs" / "pictures"
KEPT = Path("runs") / "worked"
RESOLUTION, WIDTH, COLORS = 130, 7.2, 96  # [dots per inch], [inch], of a picture
RUNS = {"row-s": 20, "row-k2": 1, "how-often-to-talk": 80}
DRIFT = 0.05  # [m/s] b, the current that the diver does not know
PERIOD, LOSS, DELAY = "messaging.period", "acoustics.loss", "acoustics.delay"
SCALE, GAIN = "vehicles.alone.sensors.thruster_speed.scale", "current_observer.k1"


def flown(name: str, kept: Path) -> Any:
    """A worked study: read back, or flown, which takes minutes."""
    directory = kept / name
    if not directory.exists():
        cardume.study(f"study/{name}", RUNS[name], directory=directory)
    return cardume.open_study(directory)


def drift_rms(period: Any, loss: Any, delay: Any) -> Any:
    """Row S: b sqrt(tau^2 + tau T (1 + p) / (1 - p) + T^2 (1 + 4 p + p^2) / (3 (1 - p)^2))."""
    lost = (1.0 + loss) / (1.0 - loss)
    third = (1.0 + 4.0 * loss + loss**2) / (3.0 * (1.0 - loss) ** 2)
    return DRIFT * np.sqrt(delay**2 + delay * period * lost + period**2 * third)


def measured(runs: Any, **options: float) -> tuple[float, float, float]:
    """Root mean square over all runs of one case, with the interval of the mean square."""
    values = runs["fleet_position_error_rms"].sel(
        {PERIOD: options["period"], LOSS: options["loss"], DELAY: options["delay"]}
    )
    found = mean_of(values.to_numpy().ravel() ** 2)
    return math.sqrt(found.mean), math.sqrt(found.low), math.sqrt(found.high)


def row_s(runs: Any) -> Any:
    """Measured points with their intervals, and the formula's curves through them."""
    figure = style.new_figure(WIDTH, 2.9)
    figure.set_layout_engine("constrained")
    panels = figure.subplots(1, 2, sharey=True)
    fine = np.geomspace(0.9, 11.0, 200)
    for axes, delay in zip(panels, runs[DELAY].to_numpy(), strict=True):
        for k, loss in enumerate(np.sort(runs[LOSS].to_numpy())):
            axes.plot(fine, drift_rms(fine, loss, delay), color=style.color(k), lw=1.0)
            for period in runs[PERIOD].to_numpy():
                middle, low, high = measured(runs, period=period, loss=loss, delay=delay)
                axes.plot([period, period], [low, high], color=style.color(k), lw=1.6)
                axes.plot(period, middle, MARKERS[k], color=style.color(k), mfc="white", ms=4.5)
            axes.plot([], [], f"-{MARKERS[k]}", color=style.color(k), mfc="white", ms=4.5, label=f"p = {loss:g}")
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xticks([1, 2, 5, 10], ["1", "2", "5", "10"])
        axes.minorticks_off()
        axes.set_yticks([0.03, 0.1, 0.3, 1.0], ["0.03", "0.1", "0.3", "1"])
        axes.set_xlabel("period of the fixes T [s]")
        axes.set_title(f"delay {delay:g} s", fontsize=8.0, loc="left")
        axes.grid(color="#EEEEEE", lw=0.6)
    panels[0].set_ylabel("position error, RMS [m]")
    panels[0].legend(fontsize=7.0, frameon=False)
    return figure


def largest_scale(k1: Any, rate: float = 0.5, k2: float = 1.0) -> Any:
    """Row K2: a* = L (k2 + k1 L) / (L k2 - k1 (k2 + k1 L))."""
    return rate * (k2 + k1 * rate) / (rate * k2 - k1 * (k2 + k1 * rate))


def limits(runs: Any) -> dict[float, tuple[float, float]]:
    """For each gain the largest scale at which the error died out, and the smallest at which it grew."""
    found = {}
    for gain in runs[GAIN].to_numpy():
        met = runs["met"].sel({GAIN: gain}).to_numpy().ravel().astype(bool)
        scales = runs[SCALE].to_numpy()
        found[float(gain)] = float(scales[met].max()), float(scales[~met].min())
    return found


def row_k2(runs: Any) -> Any:
    """What is left of the error, for every scale and gain, and where theory says that it grows."""
    figure = style.new_figure(WIDTH, 2.8)
    figure.set_layout_engine("constrained")
    axes = figure.subplots()
    for k, gain in enumerate(runs[GAIN].to_numpy()):
        errors = runs["fleet_cross_track_max"].sel({GAIN: gain}).to_numpy().ravel()
        axes.plot(
            runs[SCALE],
            errors,
            f"-{MARKERS[k]}",
            color=style.color(k),
            mfc="white",
            ms=3.5,
            lw=0.8,
            label=f"k1 = {gain:g} 1/s",
        )
        axes.axvline(largest_scale(gain), color=style.color(k), lw=1.0, dashes=(4, 2))
    axes.set_yscale("log")
    axes.set_xlabel("scale of the speed measured, a")
    axes.set_ylabel("largest error after 300 s [m]")
    axes.set_title("dashed: a* of theory", fontsize=8.0, loc="left")
    axes.grid(color="#EEEEEE", lw=0.6)
    axes.legend(fontsize=7.0, frameon=False)
    return figure


def tables(kept: Path) -> str:
    """The tables of the pages, in Markdown."""
    runs, lines = (
        flown("row-s", kept),
        ["| T | p | tau | measured | 95 % interval | formula |", "|---|---|---|---|---|---|"],
    )
    for period in runs[PERIOD].to_numpy():
        for loss in np.sort(runs[LOSS].to_numpy()):
            for delay in runs[DELAY].to_numpy():
                middle, low, high = measured(runs, period=period, loss=loss, delay=delay)
                theory = drift_rms(period, loss, delay)
                lines.append(
                    f"| {period:g} s | {loss:g} | {delay:g} s | {middle:.4f} | {low:.4f} to {high:.4f} | {theory:.4f} |"
                )
    lines += ["", "| k1 | dies out up to | grows from | theory a* |", "|---|---|---|---|"]
    for gain, (last, first) in limits(flown("row-k2", kept)).items():
        lines.append(f"| {gain:g} 1/s | {last:g} | {first:g} | {largest_scale(gain):.4f} |")
    return "\n".join(lines)


def main(folder: Path = FOLDER, kept: Path = KEPT) -> None:
    """Draw them all; the same studies give the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    talk = flown("how-often-to-talk", kept)
    pictures = {
        "study-row-s": lambda: row_s(flown("row-s", kept)),
        "study-row-k2": lambda: row_k2(flown("row-k2", kept)),
        "study-talk": lambda: draw_map(talk, WIDTH, (LOSS, PERIOD)),
    }
    for name, draw in pictures.items():
        with style.styled(), BytesIO() as drawn:
            draw().savefig(drawn, dpi=RESOLUTION)
            Image.open(drawn).convert("RGB").quantize(COLORS).save(folder / f"{name}.png", optimize=True)
    print(tables(kept))


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:3]))
