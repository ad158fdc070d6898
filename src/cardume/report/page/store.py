"""The numbers of a flight as the page carries them: few enough rows, each once, in binary."""

import base64
import html
from typing import Any

import numpy as np

from cardume.report import style
from cardume.simulation.flight import Flight

MOST_ROWS, FEWEST_ROWS = 2000, 200
MOST_CELLS = 11_000  # rows times vehicles: keeps a page of three vehicles near 6 MB, the library included
MOST_MESSAGES = 10_000
BLACK, GRAY = "#000000", "#8C8C8C"


def packed(values: np.ndarray, kind: str = "f4") -> dict[str, str]:
    """An array in Plotly's own notation, `{dtype, bdata}`.

    Args:
        values: (n,) numbers.
        kind: as NumPy and Plotly write it.
    """
    little = np.ascontiguousarray(values, dtype=f"<{kind}")
    return {"dtype": kind, "bdata": base64.b64encode(little.tobytes()).decode("ascii")}


def plotly_text(text: str) -> str:
    """Text that Plotly shows as it is, and does not read as markup."""
    return html.escape(text, quote=False)


def color(vehicle: int) -> str:
    """The color of a vehicle; black cannot be seen on a dark page."""
    found = style.color(vehicle)
    return GRAY if found == BLACK else found


class Store:
    """Columns of a flight, each kept once; figures name them by reference.

    Attributes:
        flight: what was flown.
        stride: every so manieth record of the log is kept.
        rows: (n,) of the log.
    """

    def __init__(self, flight: Flight) -> None:
        self.flight = flight
        size = max(1, len(flight.vehicle_names))
        most = min(MOST_ROWS, max(FEWEST_ROWS, MOST_CELLS // size))
        self.stride = max(1, -(-len(flight.times) // most))
        self.rows = np.arange(0, len(flight.times), self.stride)
        self.times = np.asarray(flight.times, float)[self.rows]
        self._derived: dict[str, np.ndarray] = {}
        self._columns: dict[str, list[dict[str, str] | None]] = {}

    def add(self, name: str, values: np.ndarray) -> None:
        """Keep something computed from the log.

        Args:
            name: unlike the log's channels.
            values: (time, vehicle) for every record of the log.
        """
        self._derived[name] = values

    def values(self, name: str) -> np.ndarray:
        """(time, vehicle) at the rows that are kept."""
        found = self._derived[name] if name in self._derived else self.flight.channels[name]
        rows: np.ndarray = np.asarray(found, float)[self.rows]
        return rows

    def column(self, name: str, vehicle: int) -> dict[str, Any]:
        """A reference to one vehicle's column, for a figure.

        Args:
            name: a channel of the log, or of `add`.
            vehicle: place in the fleet.
        """
        columns = self._columns.setdefault(name, [None] * len(self.flight.vehicle_names))
        if columns[vehicle] is None:
            columns[vehicle] = packed(self.values(name)[:, vehicle])
        return {"from": name, "vehicle": vehicle}

    def keep(self, name: str) -> None:
        """Keep a channel of every vehicle, for the page itself."""
        for vehicle in range(len(self.flight.vehicle_names)):
            self.column(name, vehicle)

    def contents(self) -> dict[str, Any]:
        """All that was referred to."""
        return {"times": packed(self.times, "f8"), "columns": self._columns}


TIMES = {"from": "times"}  # a reference to the times of the rows


def shown_messages(flight: Flight) -> np.ndarray:
    """Which messages the page carries: all, or evenly chosen ones where they are too many."""
    count = len(flight.messages["time_sent"])
    return np.arange(0, count, max(1, -(-count // MOST_MESSAGES)))


def pack_messages(flight: Flight) -> dict[str, Any]:
    """The messages, for the page to let them fly."""
    chosen = shown_messages(flight)
    table = {name: np.asarray(flight.messages[name], float)[chosen] for name in flight.messages}
    return {
        "sent": packed(table["time_sent"], "f8"),
        "received": packed(table["time_received"], "f8"),
        "sender": packed(table["sender"], "i4"),
        "receiver": packed(table["receiver"], "i4"),
        "lost": packed(table["lost"], "u1"),
    }
