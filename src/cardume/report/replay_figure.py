"""The figure of a replay: where a vehicle was believed to be, and how far that is from the truth, or from fixes."""

from pathlib import Path
from typing import Any

import numpy as np

from cardume.missions.recordings.replaying import Part, Replay, errors_of
from cardume.report import style

HEIGHT = 3.7  # [inch]
FAINT_FIX = {"ls": "none", "marker": ".", "ms": 2.0, "alpha": 0.35, "zorder": 1}
NAMES = {".svg": {"Date": None}, ".png": {"Software": None}}
RESOLUTION = 150  # [dots per inch]


def save_replay(replay: Replay, folder: Path) -> None:
    """Draw a replay as SVG and PNG.

    Args:
        replay: what came out.
        folder: is made.
    """
    folder.mkdir(exist_ok=True)
    with style.styled():
        figure = draw_replay(replay)
        for kind, metadata in NAMES.items():
            figure.savefig(folder / f"replay{kind}", dpi=RESOLUTION, metadata=metadata)


def draw_replay(replay: Replay, width: float = style.WIDTH) -> Any:
    """Draw the plan view beside the errors over time.

    Args:
        replay: what came out.
        width: [inch] of the figure.

    Returns:
        A matplotlib figure.
    """
    with style.styled():
        figure = style.new_figure(width, HEIGHT)
        plan, error = figure.subplots(1, 2, width_ratios=(1.1, 1.0))
        for k, part in enumerate(replay.parts):
            _draw_plan(plan, part, style.color(k))
            _draw_errors(error, part, style.color(k))
        plan.set_xlabel("east [m]")
        plan.set_ylabel("north [m]")
        plan.set_aspect("equal", "datalim")
        error.set_xlabel("time [s]")
        error.set_ylabel("position error [m]" if _has_truth(replay) else "fix from where it was expected [m]")
        error.set_ylim(0.0, _top(error))
        names = tuple(part.believed.name for part in replay.parts)
        figure.legend(
            handles=[*style.vehicle_handles(names), *_meanings(replay)],
            loc="upper left",
            ncols=4,
            **style.TIGHT | {"borderaxespad": 0.6},
        )
        figure.subplots_adjust(left=0.08, right=0.985, bottom=0.12, top=0.86, wspace=0.22)
        return figure


def _has_truth(replay: Replay) -> bool:
    return any(np.isfinite(errors_of(part.believed)).any() for part in replay.parts)


def _draw_plan(axes: Any, part: Part, color: str) -> None:
    b = part.believed
    is_place = _places(part)
    axes.plot(b.fixes[is_place, 1], b.fixes[is_place, 0], color=color, **FAINT_FIX)
    rows = style.thinned(len(b.times))
    axes.plot(b.truth[rows, 1], b.truth[rows, 0], color=color, lw=1.2)
    axes.plot(b.position[rows, 1], b.position[rows, 0], color=style.INK, lw=0.8, dashes=(2, 1.2))
    if part.smoothed is not None:
        axes.plot(part.smoothed.means[:, 1], part.smoothed.means[:, 0], color=style.FAINT, lw=0.8)


def _places(part: Part) -> np.ndarray:
    """(tick,) where a fix came that is a position, not a range."""
    found: np.ndarray = np.isfinite(part.believed.fixes[:, 0]) & np.isnan(part.believed.fixes[:, -1])
    return found


def _draw_errors(axes: Any, part: Part, color: str) -> None:
    b, rows = part.believed, style.thinned(len(part.believed.times))
    away = errors_of(b)
    if np.isfinite(away).any():
        axes.plot(b.times[rows], away[rows], color=color, lw=0.8)
    else:
        times, apart = [i.time for i in part.innovations], [i.apart for i in part.innovations]
        axes.plot(times, apart, color=color, ls="none", marker=".", ms=3.0)
    sigma = np.sqrt(b.covariance[rows, 0] + b.covariance[rows, 2])
    axes.plot(b.times[rows], sigma, color=color, lw=0.7, dashes=(4, 1.5), alpha=0.8)


def _top(axes: Any) -> float:
    """Of the axis of errors: what is exceeded now and then does not hide the rest."""
    values = np.concatenate([np.asarray(line.get_ydata(), float) for line in axes.get_lines()] or [np.zeros(1)])
    values = values[np.isfinite(values)]
    if not len(values):
        return 1.0
    most = 1.05 * float(values.max())
    return min(most, 4.0 * float(np.percentile(values, 98))) or 1.0


def _meanings(replay: Replay) -> list[Any]:
    from matplotlib.lines import Line2D

    found = [Line2D([], [], color=style.INK, lw=0.8, dashes=(2, 1.2), label="believed")]
    if _has_truth(replay):
        found.insert(0, Line2D([], [], color=style.FAINT, lw=1.2, label="true"))
    if any(np.isfinite(part.believed.covariance).any() for part in replay.parts):
        found.append(Line2D([], [], color=style.FAINT, lw=0.7, dashes=(4, 1.5), label="1 sigma, believed"))
    if any(part.smoothed for part in replay.parts):
        found.append(Line2D([], [], color=style.FAINT, lw=0.8, label="smoothed"))
    if any(_places(part).any() for part in replay.parts):
        found.append(Line2D([], [], color=style.FAINT, ls="none", marker=".", ms=3.0, label="fixes"))
    return found
