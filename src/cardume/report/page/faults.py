"""The faults on the page: a lane for each above the message timeline, and a shade behind all panels."""

from typing import Any

from cardume.report.fault_lanes import MOST_LANES, SHADE, Span, fault_spans, span_words
from cardume.report.page.store import plotly_text
from cardume.simulation.flight import Flight

BAR, LABEL = 0.22, -0.22  # [lane] where the bar stands, and the words above it


def fault_annotations(flight: Flight, place: int) -> list[dict[str, Any]]:
    """What the lanes show, above them.

    Args:
        flight: what was flown.
        place: of the panel, from 1.
    """
    count = len(fault_spans(flight))
    text = "<b>Faults</b>, from when to when; shaded in all panels"
    if count > MOST_LANES:
        text += f"; the first {MOST_LANES} of {count}"
    where = {"xref": "paper", "yref": f"y{place} domain", "x": 0, "y": 1, "xanchor": "left", "yanchor": "bottom"}
    return [{"text": text, "showarrow": False, "font": {"size": 11}} | where]


def fault_shapes(flight: Flight) -> list[dict[str, Any]]:
    """A shade over the height of the chart while each fault lasts.

    Args:
        flight: what was flown.
    """
    shared = {"type": "rect", "xref": "x", "yref": "paper", "y0": 0, "y1": 1, "layer": "below", "line": {"width": 0}}
    return [
        shared | {"x0": span.begin, "x1": span.end, "fillcolor": span.color, "opacity": SHADE}
        for span in fault_spans(flight)
    ]


def fault_traces(flight: Flight, y: str) -> list[dict[str, Any]]:
    """A bar per fault, and what it is in words.

    Args:
        flight: what was flown.
        y: name of the axis.
    """
    return [
        trace
        for lane, span in enumerate(fault_spans(flight)[:MOST_LANES])
        for trace in (_bar(span, lane, y), _words(flight, span, lane, y))
    ]


def fault_marks(flight: Flight) -> list[dict[str, Any]]:
    """What the replay tells of the faults at an instant.

    Args:
        flight: what was flown.
    """
    return [
        {"begin": span.begin, "end": span.end, "color": span.color, "words": span_words(flight, span)}
        for span in fault_spans(flight)
    ]


def _bar(span: Span, lane: int, y: str) -> dict[str, Any]:
    line = {"color": span.color, "width": 5}
    where = {"x": [span.begin, span.end], "y": [lane + BAR, lane + BAR], "yaxis": y}
    return {"type": "scatter", "mode": "lines", "line": line, "showlegend": False, "hoverinfo": "skip"} | where


def _words(flight: Flight, span: Span, lane: int, y: str) -> dict[str, Any]:
    return {
        "type": "scatter",
        "mode": "text",
        "x": [0.0],
        "y": [lane + LABEL],
        "text": [f" {plotly_text(span_words(flight, span))}"],
        "textposition": "middle right",
        "textfont": {"size": 11},
        "yaxis": y,
        "showlegend": False,
        "hoverinfo": "skip",
        "cliponaxis": False,
    }
