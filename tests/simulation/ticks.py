"""Watch a mission tick by tick, through the tables that the engine leaves after each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cardume.simulation.engine import advance
from cardume.simulation.fleet import VEHICLE, Tables
from cardume.simulation.plan import Plan
from cardume.simulation.recording import MESSAGE_LOG, MESSAGES, MessageRow
from cardume.simulation.tables import make_tables


@dataclass(frozen=True)
class Watched:
    """A mission that was watched; vehicles in the engine's order, by name."""

    plan: Plan
    tables: Tables  # at the end
    truth: np.ndarray  # (tick, vehicle, records of VEHICLE) when the tick began
    after: np.ndarray  # the same when it was over
    usbl: np.ndarray  # (tick, vehicle, vehicle, 4)
    inbox: np.ndarray  # (tick, link, message)

    @property
    def names(self) -> list[str]:
        return [self.plan.vehicles[k].name for k in self.plan.order]

    @property
    def times(self) -> np.ndarray:
        """(tick,) [s]"""
        return np.arange(len(self.truth)) * self.plan.tick

    def at_start(self, record: Any, field: str) -> np.ndarray:
        """(tick, vehicle) of what was true as the tick began."""
        return self.truth[:, :, VEHICLE.column(record, field)]

    def in_tick(self, record: Any, field: str) -> np.ndarray:
        """(tick, vehicle) of what was measured, decided or found in the tick."""
        return self.after[:, :, VEHICLE.column(record, field)]

    def messages(self) -> dict[str, np.ndarray]:
        """The log of messages, by column; vehicles by their place in the engine."""
        rows = self.tables.messages.reshape(-1, MESSAGE_LOG.width)[: self.tables.counts[MESSAGES]]
        return {name: rows[:, k] for k, name in enumerate(MessageRow._fields)}


def watch(plan: Plan) -> Watched:
    """Fly a plan one tick at a time."""
    tables = make_tables(plan)
    size, width = tables.whole.size, tables.whole.message_width
    truth, after, usbl, inbox = [], [], [], []
    for now in range(plan.num_ticks):
        truth.append(tables.vehicles.copy())
        assert int(advance(tables, now, now + 1)) == now + 1
        after.append(tables.vehicles.copy())
        usbl.append(tables.usbl.copy())
        inbox.append(tables.inbox.copy())
    shape = (len(truth), size, VEHICLE.width)
    return Watched(
        plan,
        tables,
        np.array(truth).reshape(shape),
        np.array(after).reshape(shape),
        np.array(usbl).reshape(len(usbl), size, size, -1),
        np.array(inbox).reshape(len(inbox), -1, width),
    )
