"""What all charts of the page share."""

from typing import Any

FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"
NEUTRAL = "#808080"  # read on white and on black; the page's own style sharpens it
CLEAR = "rgba(0,0,0,0)"


def base_layout() -> dict[str, Any]:
    """A new layout without a background, so that the page's own shows, light or dark."""
    return {
        "paper_bgcolor": CLEAR,
        "plot_bgcolor": CLEAR,
        "font": {"family": FONT, "size": 12, "color": NEUTRAL},
        "hoverlabel": {"font": {"size": 12}, "namelength": -1},
        "template": {"layout": {"xaxis": axis(), "yaxis": axis()}},
        "modebar": {"bgcolor": CLEAR, "color": NEUTRAL, "activecolor": "#0072B2"},
        "autosize": True,
    }


def axis() -> dict[str, Any]:
    """How axes look."""
    return {
        "gridcolor": "rgba(128,128,128,0.25)",
        "zerolinecolor": "rgba(128,128,128,0.5)",
        "linecolor": NEUTRAL,
        "ticks": "outside",
        "tickcolor": NEUTRAL,
        "automargin": True,
        "title": {"standoff": 6},
    }
