"""How figures look: a palette that the color-blind can tell apart, small type, no ornaments."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

# Okabe & Ito (2008), "Color Universal Design"; yellow, too light for lines, comes last.
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#F0E442")
INK, FAINT, PATH = "#333333", "#8A8A8A", "#B8B8B8"
WIDTH = 7.2  # [inch] two columns of a journal; one is 3.5
MOST_POINTS = 4000  # of one line: more cannot be seen, and makes an SVG slow to open
ROW = 0.165  # [inch] height of a line of a legend
MOST_NAMED = 8  # vehicles in a legend

RULES: dict[str, Any] = {
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "axes.edgecolor": FAINT,
    "axes.linewidth": 0.6,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "text.color": INK,
    "xtick.color": FAINT,
    "ytick.color": FAINT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "legend.frameon": False,
    "legend.handlelength": 1.8,
    "lines.solid_capstyle": "round",
    "pdf.fonttype": 42,  # fonts that a journal accepts and a reader can search
    "svg.hashsalt": "cardume",  # the same flight gives the same file
}

TIGHT: dict[str, Any] = {  # a legend that stands where it is put
    "borderaxespad": 0.0,
    "borderpad": 0.0,
    "columnspacing": 1.0,
    "labelspacing": 0.35,
    "fontsize": 7.5,
}


@contextmanager
def styled() -> Iterator[None]:
    """Draw and save in this style; whatever else the process draws keeps its own."""
    import matplotlib

    rules: Any = {key: value for key, value in matplotlib.rcParamsDefault.items() if "backend" not in key} | RULES
    with matplotlib.rc_context(rules):
        yield


def color(vehicle: int) -> str:
    """The color of a vehicle, by its place in the fleet."""
    return PALETTE[vehicle % len(PALETTE)]


def thinned(num_rows: int) -> np.ndarray:
    """Which rows to draw, evenly spaced, the last among them."""
    if num_rows <= MOST_POINTS:
        return np.arange(num_rows)
    return np.unique(np.linspace(0, num_rows - 1, MOST_POINTS).astype(int))


def new_figure(width: float, height: float) -> Any:
    """An empty figure without a window.

    Args:
        width: [inch] of the whole figure.
        height: [inch] of the whole figure.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    return figure


def vehicle_handles(names: tuple[str, ...]) -> list[Any]:
    """Legend entries for the vehicles; of a large fleet, for the first few."""
    from matplotlib.lines import Line2D

    shown = names if len(names) <= MOST_NAMED else names[: MOST_NAMED - 1]
    handles = [Line2D([], [], color=color(k), lw=1.6, label=shortened(name)) for k, name in enumerate(shown)]
    if len(shown) < len(names):
        handles.append(Line2D([], [], color="none", label=f"and {len(names) - len(shown)} more"))
    return handles


def shortened(name: str, longest: int = 18) -> str:
    """A name for a legend."""
    return name if len(name) <= longest else f"{name[: longest - 1]}…"


def columns(handles: list[Any], room: float) -> int:
    """How many legend entries fit beside one another.

    Args:
        handles: of the legend.
        room: [inch] for them.
    """
    widest = 0.38 + 0.056 * max(len(handle.get_label()) for handle in handles)
    return max(1, min(len(handles), int(room / widest)))
