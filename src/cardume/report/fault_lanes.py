"""Faults over time: from when to when something went wrong with whom."""

from typing import Any, NamedTuple

import numpy as np

from cardume.report import style
from cardume.simulation.flight import FAULT, Flight

MOST_LANES = 12
SHADE = 0.10  # opacity of a fault behind the curves


class Span(NamedTuple):
    """One fault, as far as it was flown."""

    vehicle: int | None  # its place in the fleet; None: of all, as of the water
    begin: float  # [s]
    end: float  # [s]
    words: str

    @property
    def color(self) -> str:
        """The vehicle's; gray where it is of all."""
        return style.FAINT if self.vehicle is None else style.color(self.vehicle)


def fault_spans(flight: Flight) -> tuple[Span, ...]:
    """The faults of a flight, in the order of their beginning.

    Args:
        flight: what was flown.
    """
    names = list(flight.vehicle_names)
    return tuple(
        Span(
            names.index(event.vehicle) if event.vehicle in names else None,
            event.time,
            min(event.until, flight.flown),
            event.what.removeprefix(FAULT),
        )
        for event in flight.events
        if event.what.startswith(FAULT) and np.isfinite(event.until) and event.time < flight.flown
    )


def span_words(flight: Flight, span: Span) -> str:
    """What went wrong with whom, and when.

    Args:
        flight: what was flown.
        span: one of its faults.
    """
    who = "" if span.vehicle is None else f"{flight.vehicle_names[span.vehicle]}: "
    return f"{who}{span.words} ({lasting(span.begin, span.end, flight.flown)})"


def lasting(begin: float, end: float, flown: float) -> str:
    """From when to when, in words.

    Args:
        begin: [s]
        end: [s]
        flown: [s] of the mission.
    """
    return f"{begin:g} to {end:g} s" if end < flown else f"from {begin:g} s on"


def shade_faults(axes: Any, flight: Flight) -> None:
    """Shade a panel of a figure while a fault lasts, in the color of its vehicle.

    Args:
        axes: of the panel, over time.
        flight: what was flown.
    """
    for span in fault_spans(flight):
        axes.axvspan(span.begin, span.end, color=span.color, alpha=SHADE, lw=0, zorder=0)


def fault_handles(flight: Flight) -> list[Any]:
    """The legend's entry for what `shade_faults` draws; none where there was no fault.

    Args:
        flight: what was flown.
    """
    from matplotlib.patches import Patch

    return [Patch(color=style.FAINT, alpha=0.3, lw=0, label="while a fault lasts")] if fault_spans(flight) else []
