"""The time series of the page: one panel for each kind of number that matters in a flight, one axis of time."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from cardume.report.fault_lanes import MOST_LANES as MOST_FAULTS, fault_spans
from cardume.report.message_lanes import links
from cardume.report.page.faults import fault_annotations, fault_shapes, fault_traces
from cardume.report.page.layout import axis, base_layout
from cardume.report.page.store import GRAY, TIMES, Store, color, plotly_text
from cardume.report.page.talk import lane_annotations, lane_layout, lane_traces
from cardume.simulation.flight import Flight

PANEL, GAP, TOP, BOTTOM = 118, 40, 60, 50  # [pixel]
LANE = 52  # [pixel] of the message timeline, per link
FAULT_LANE = 34  # [pixel] per fault
MOST_LANES = 24
PRINTED = {"width": 680, "height": 925}  # [pixel] of the chart on a page of A4, 96 to the inch
LANE_PRINTED, LANES_PRINTED = 30, 0.35  # [pixel] of a lane on paper, as far as all take no larger share of the chart
FAR_LIMIT = 2.5  # a limit so many times beyond what was used is told, not drawn
CLIPPED = 2.0  # a transient so much larger than what follows runs out of its panel at first

Limits = Mapping[str, tuple[float, ...]]


class Curve(NamedTuple):
    """One line per vehicle."""

    column: str
    meaning: str
    dash: str = "solid"
    is_common: bool = False  # the same for all: drawn once, gray


class Panel(NamedTuple):
    """One quantity over time."""

    title: str
    unit: str
    curves: tuple[Curve, ...]
    limit: str = ""  # the channel whose limits are drawn


def series_view(store: Store, limits: Limits) -> dict[str, Any]:
    """The figure.

    Args:
        store: of the flight.
        limits: of the actuators, per channel and vehicle.

    Returns:
        `data` and `layout` as Plotly takes them, with references in place of columns; `height` [pixel]; `domains` of
        the axes from the top, and `printed`: width and height [pixel] and domains on paper.
    """
    flight = store.flight
    derive(store)
    panels = chosen_panels(flight)
    lanes, faults = links(flight)[:MOST_LANES], fault_spans(flight)[:MOST_FAULTS]
    heights: list[int] = [PANEL] * len(panels)
    heights += [FAULT_LANE * len(faults)] if faults else []
    heights += [LANE * len(lanes)] if lanes else []
    height = TOP + BOTTOM + sum(heights) + GAP * (len(heights) - 1)
    layout = base_layout() | {
        "height": height,
        "margin": {"l": 62, "r": 14, "t": TOP, "b": BOTTOM},
        "hovermode": "x",
        "hoversubplots": "axis",
        "dragmode": "zoom",
        "legend": {"orientation": "h", "x": 0, "y": 1 + 26 / (height - TOP - BOTTOM), "yanchor": "bottom"},
        "shapes": fault_shapes(flight),
        "annotations": [],
        "xaxis": _time_axis(store, len(heights)),
    }
    data: list[dict[str, Any]] = []
    domains = _domains(heights)
    for place, domain in enumerate(domains, start=1):
        if place <= len(panels):
            _add_panel(data, layout, store, (panels[place - 1], place, domain), limits)
        elif faults and place == len(panels) + 1:
            layout[_axis_name(place)] = lane_layout(len(faults)) | {"domain": domain}
            layout["annotations"] += fault_annotations(flight, place)
            data += fault_traces(flight, f"y{place}")
        else:
            layout[_axis_name(place)] = lane_layout(len(lanes)) | {"domain": domain}
            layout["annotations"] += lane_annotations(place)
            data += lane_traces(flight, lanes, f"y{place}")
    printed = PRINTED | {"domains": _domains(_heights_on_paper(heights, len(lanes)))}
    return {"data": data, "layout": layout, "height": height, "domains": domains, "printed": printed}


def _domains(heights: Sequence[float]) -> list[list[float]]:
    """The share of the chart that each axis has, from the top."""
    whole, top, found = sum(heights) + GAP * (len(heights) - 1), 1.0, []
    for height in heights:
        found.append([max(0.0, top - height / whole), top])
        top -= (height + GAP) / whole
    return found


def _heights_on_paper(heights: Sequence[float], num_lanes: int) -> Sequence[float]:
    """Heights in proportion to one another; a lane has to hold its words, which do not shrink with the chart."""
    room = PRINTED["height"] - TOP - BOTTOM
    wanted, others = LANE_PRINTED * num_lanes / room, sum(heights[:-1]) + GAP * (len(heights) - 1)
    if num_lanes == 0 or wanted > LANES_PRINTED or LANE * num_lanes > wanted * (others + LANE * num_lanes):
        return heights
    return [*heights[:-1], others * wanted / (1.0 - wanted)]


def _time_axis(store: Store, lowest: int) -> dict[str, Any]:
    last = float(store.times[-1]) if len(store.times) else 1.0
    spike = {"showspikes": True, "spikemode": "across", "spikesnap": "hovered data", "spikethickness": 1}
    return (
        axis()
        | spike
        | {
            "title": {"text": "time [s]"},
            "anchor": f"y{lowest}" if lowest > 1 else "y",
            "range": [0.0, max(last, 1e-9)],
            "spikecolor": GRAY,
            "spikedash": "dot",
            "hoverformat": ".4~g",
            "unifiedhovertitle": {"text": "%{x} s"},
        }
    )


def derive(store: Store) -> None:
    """Put into the store what the panels show and the log does not hold.

    Args:
        store: of the flight.
    """
    channels = store.flight.channels
    for name in ("north", "east"):
        store.add(f"{name}_error", channels[f"{name}_estimate"] - channels[name])
    state = channels["coordination_state"]
    store.add("ahead_of_mean", state - state.mean(axis=1, keepdims=True))
    store.add("heading_deg", np.degrees(channels["heading"]))
    store.add("heading_error_deg", np.degrees(_wrapped(channels["heading"] - channels["heading_desired"])))
    store.add("yaw_rate_deg", np.degrees(channels["yaw_rate"]))


def _wrapped(angles: np.ndarray) -> np.ndarray:
    wrapped: np.ndarray = (angles + np.pi) % (2.0 * np.pi) - np.pi
    return wrapped


PANELS: tuple[tuple[Panel, Callable[[Flight], bool]], ...] = (
    (
        Panel(
            "<b>Cross-track error</b>, dotted believed; positive to starboard",
            "m",
            (Curve("cross_track_estimate", "believed", "dot"), Curve("cross_track", "true")),
        ),
        lambda flight: True,
    ),
    (
        Panel("<b>Coordination</b>: ahead of the fleet's mean", "m", (Curve("ahead_of_mean", ""),)),
        lambda flight: len(flight.vehicle_names) > 1,
    ),
    (
        Panel("<b>Position, north</b>: believed less true", "m", (Curve("north_error", ""),)),
        lambda flight: _moves(flight.channels["north_estimate"] - flight.channels["north"]),
    ),
    (
        Panel("<b>Position, east</b>: believed less true", "m", (Curve("east_error", ""),)),
        lambda flight: _moves(flight.channels["east_estimate"] - flight.channels["east"]),
    ),
    (
        Panel(
            "<b>Current, north</b>: gray true, colored believed",
            "m/s",
            (Curve("current_north_estimate", "believed"), Curve("current_north", "true", "solid", True)),
        ),
        lambda flight: _has_current(flight),
    ),
    (
        Panel(
            "<b>Current, east</b>: gray true, colored believed",
            "m/s",
            (Curve("current_east_estimate", "believed"), Curve("current_east", "true", "solid", True)),
        ),
        lambda flight: _has_current(flight),
    ),
    (
        Panel(
            "<b>Speed</b> over ground; dotted asked for through the water",
            "m/s",
            (Curve("speed_desired", "asked for", "dot"), Curve("speed", "over ground")),
        ),
        lambda flight: True,
    ),
    (
        Panel("<b>Heading error</b>: heading less heading asked for", "deg", (Curve("heading_error_deg", ""),)),
        lambda flight: True,
    ),
    (
        Panel("<b>Thrust</b>, ahead", "N", (Curve("thrust", ""),), "thrust"),
        lambda flight: _moves(flight.channels["thrust"]),
    ),
    (
        Panel("<b>Yaw moment</b>, to starboard", "N m", (Curve("yaw_moment", ""),), "yaw_moment"),
        lambda flight: _moves(flight.channels["yaw_moment"]),
    ),
    (
        Panel(
            "<b>Shaft speed</b>, mean of the horizontal ones",
            "rpm",
            (Curve("shaft_speed_rpm", ""),),
            "shaft_speed_rpm",
        ),
        lambda flight: _moves(flight.channels["shaft_speed_rpm"]),
    ),
    (
        Panel("<b>Depth</b>, downwards", "m", (Curve("depth", ""),)),
        lambda flight: _moves(flight.channels["depth"], 0.05),
    ),
)


def _moves(values: np.ndarray, least: float = 1e-9) -> bool:
    return bool(np.any(np.abs(values) > least))


def _has_current(flight: Flight) -> bool:
    names = ("current_north", "current_east", "current_north_estimate", "current_east_estimate")
    return any(_moves(flight.channels[name]) for name in names)


def chosen_panels(flight: Flight) -> list[Panel]:
    """The panels that say something about this flight."""
    return [panel for panel, matters in PANELS if matters(flight)]


def _axis_name(place: int) -> str:
    return "yaxis" if place == 1 else f"yaxis{place}"


def _add_panel(
    data: list[dict[str, Any]],
    layout: dict[str, Any],
    store: Store,
    placed: tuple[Panel, int, list[float]],
    limits: Limits,
) -> None:
    panel, place, domain = placed
    y = f"y{place}" if place > 1 else "y"
    layout[_axis_name(place)] = axis() | {"title": {"text": f"[{panel.unit}]"}, "domain": domain, "nticks": 5}
    if panel.title.startswith("<b>Depth"):
        layout[_axis_name(place)]["autorange"] = "reversed"
    title = panel.title
    if panel.limit in limits:
        title += _add_limits(layout, store, panel, y, limits[panel.limit])
    if panel.title.startswith("<b>Cross") and (found := _clipped_range(store)):
        layout[_axis_name(place)]["range"], said = found
        title += said
    layout["annotations"].append(
        {
            "text": title,
            "xref": "paper",
            "yref": f"{y} domain",
            "x": 0,
            "y": 1,
            "xanchor": "left",
            "yanchor": "bottom",
            "showarrow": False,
            "align": "left",
            "font": {"size": 11},
        }
    )
    data += [trace for curve in panel.curves for trace in _traces(store, panel, curve, y)]


def _traces(store: Store, panel: Panel, curve: Curve, y: str) -> list[dict[str, Any]]:
    names = store.flight.vehicle_names
    traces = []
    for k, name in enumerate(names[:1] if curve.is_common else names):
        text = "true, at the first vehicle" if curve.is_common else f"{plotly_text(name)} {curve.meaning}".strip()
        is_main = curve.dash == "solid" and not curve.is_common
        traces.append(
            {
                "type": "scatter",
                "mode": "lines",
                "x": TIMES,
                "y": store.column(curve.column, k),
                "yaxis": y,
                "name": plotly_text(name),
                "legendgroup": "true" if curve.is_common else f"v{k}",
                "showlegend": y == "y" and is_main,
                "line": {
                    "color": GRAY if curve.is_common else color(k),
                    "width": 1.5 if is_main else 1.1,
                    "dash": curve.dash,
                },
                "hovertemplate": f"{text} %{{y:.3~g}} {panel.unit}<extra></extra>",
            }
        )
    return traces


def _add_limits(layout: dict[str, Any], store: Store, panel: Panel, y: str, limits: tuple[float, ...]) -> str:
    """Draw the limits that are near what was used, and put all of them into words."""
    values = store.values(panel.limit)
    known = values[np.isfinite(values)]
    used = float(np.max(np.abs(known))) if known.size else 0.0
    said = sorted(set(limits))
    words = " and ".join(f"{limit:.4g}" for limit in said)
    for limit in said:
        if limit <= FAR_LIMIT * used:
            layout["shapes"] += [
                {
                    "type": "line",
                    "xref": "paper",
                    "yref": y,
                    "x0": 0,
                    "x1": 1,
                    "y0": sign * limit,
                    "y1": sign * limit,
                    "line": {"color": GRAY, "width": 1.2, "dash": "dash"},
                }
                for sign in ((1, -1) if known.size and known.min() < -0.1 * limit else (1,))
            ]
    most = f", {100 * used / max(said):.0f} % used" if max(said) > 0 else ""
    return f"; limit {words} {panel.unit}{most}"


def _clipped_range(store: Store) -> tuple[list[float], str] | None:
    """A range in which what follows the transient can be seen, where the transient would hide it."""
    times = [found.get("settling_time", np.nan) for found in store.flight.metrics.vehicles.values()]
    if not times or not np.isfinite(times).all():
        return None
    values = np.concatenate([store.values("cross_track"), store.values("cross_track_estimate")], axis=1)
    after = values[store.times >= max(times)]
    most, later = (float(np.max(np.abs(v[np.isfinite(v)]), initial=0.0)) for v in (values, after))
    if later <= 0.0 or most <= CLIPPED * later:
        return None
    return [-1.35 * later, 1.35 * later], f"; before settling {most:.2g} m"
