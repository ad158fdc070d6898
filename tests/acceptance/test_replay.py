"""Must show 5: what a vehicle measured and heard, played into `decide` with no world around, gives the same bits.

Truth leaking into a controller is the classic silent flaw of simulation studies.  Here everything that is not aboard a
vehicle is NaN while it thinks: every state, current, path error, message under way, random key, timing and score, the
other vehicles' minds, and the gains and memories of the laws that belong to the world.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
import pytest

from cardume.laws import COLUMNS, FAMILIES
from cardume.missions.available import catalog
from cardume.missions.drawing import draw
from cardume.missions.opening import open_mission
from cardume.missions.planning import make_plan
from cardume.onboard.mind import ENVELOPE, OTHERS_WIDTH, OWN_WIDTH
from cardume.signals import Reference, Report
from cardume.simulation.engine import advance, think
from cardume.simulation.fleet import VEHICLE, Held, Satellite, Tables
from cardume.simulation.law_tables import PER_OTHER
from cardume.simulation.plan import Plan
from cardume.simulation.tables import USBL_COLUMNS, make_tables
from flying import LAWS
from properties.flown import plan_of, same_bits
from properties.test_independence import MEMBERS, mission

ABOARD = FAMILIES[: FAMILIES.index("autopilot")]  # what `decide` calls
WORLD = (
    "vehicles",
    "usbl",
    "inbox",
    "past",
    "keys",
    "noise",
    "timings",
    "field",
    "seabed",
    "outbox",
    "sending",
    "due",
    "arrivals",
)
UNSEEN = (*WORLD, "scores", "fleet_score", "histograms", "log", "predictions", "messages", "requirements", "trouble")


class Moment(NamedTuple):
    """What one vehicle met in one tick, and what it made of it."""

    vehicle: int
    time: float
    held: np.ndarray
    satellite: np.ndarray
    usbl: np.ndarray
    inbox: np.ndarray
    reference: np.ndarray
    said: np.ndarray  # a Report, or empty when it kept silent


def test_decide_needs_nothing_but_measurements_and_packets() -> None:
    replay(plan_of(mission(list(MEMBERS))), at_least=200)


@pytest.mark.parametrize(
    ("name", "overrides"),
    [
        ("paper/figure-5", ["duration=240 s"]),
        ("cadiz", ["duration=120 s"]),
        ("kinematic/circle", ["duration=60 s"]),
        ("paper/figure-5", ["duration=60 s", "guidance.law=along_path", "neighbors.law=reported_speed", "end=surface"]),
        ("paper/figure-5", ["duration=60 s", "speed_reference=water", "position.law=direct"]),
        ("gather-and-go", ["duration=100 s"]),
        ("survey-at-altitude", ["duration=100 s", "abort.time=90 s"]),
    ],
)
def test_built_in_missions(name: str, overrides: Sequence[str]) -> None:
    replay(make_plan(draw(open_mission(name, overrides)), catalog([LAWS])).plan)


def test_the_replay_notices_a_measurement_that_was_not_made() -> None:
    plan = plan_of(mission(list(MEMBERS)), ["duration=10 s"])
    tables = blind(plan)
    moments = [m._replace(held=m.held + 1e-12) if m.time > 5.0 else m for m in recorded(plan)]
    references = [same_bits(answer(tables, m)[0], m.reference) for m in moments]
    assert all(references[: len(references) // 2])
    assert not any(references[-len(MEMBERS) :])


def replay(plan: Plan, at_least: int = 0) -> None:
    tables, messages = blind(plan), 0
    for moment in recorded(plan):
        reference, said = answer(tables, moment)
        assert np.isfinite(reference[: Reference._fields.index("yaw_rate")]).all()  # of a yaw rate it may ask none
        assert same_bits(reference, moment.reference), (moment.vehicle, moment.time)
        assert (said[0] > 0.5) == (moment.said.size > 0)
        if moment.said.size:
            assert same_bits(said, moment.said), (moment.vehicle, moment.time)
            messages += 1
    assert messages >= at_least


def recorded(plan: Plan) -> Iterator[Moment]:
    """Fly a mission tick by tick, and note what each vehicle met."""
    tables = make_tables(plan)
    size, whole = len(plan.vehicles), tables.whole
    for now in range(plan.num_ticks):
        assert int(advance(tables, now, now + 1)) == now + 1
        rows = tables.vehicles.reshape(size, VEHICLE.width)
        inboxes = tables.inbox.reshape(-1, max(1, whole.widest) * whole.message_width)
        outbox = tables.outbox.reshape(size, whole.slots, whole.message_width)
        for k in range(size):
            said = outbox[k, (tables.sent[k] - 1) % whole.slots, 1 : 1 + ENVELOPE.width]
            yield Moment(
                k,
                now * plan.tick,
                part(rows[k], Held).copy(),
                part(rows[k], Satellite).copy(),
                tables.usbl.reshape(size, -1)[k].copy(),
                inboxes[k].copy() if whole.widest else np.zeros(0),
                part(rows[k], Reference).copy(),
                said.copy() if tables.sending[k] > 0.5 else np.zeros(0),
            )


def part(row: np.ndarray, record: Any) -> np.ndarray:
    start = VEHICLE.offsets[record]
    return row[start : start + len(record._fields)]


def blind(plan: Plan) -> Tables:
    """Fresh tables in which only what is aboard is a number."""
    tables = make_tables(plan)
    tables = tables._replace(**{name: np.full(getattr(tables, name).shape, np.nan) for name in UNSEEN})
    tables.sent[:], tables.counts[:] = -(2**40), -(2**40)
    size = len(plan.vehicles)
    gains = tables.gains.reshape(size, -1)
    memory = tables.memory.reshape(size, -1)
    handles = tables.handles.reshape(size, len(FAMILIES), COLUMNS)
    for k, vehicle in enumerate(plan.vehicles[j] for j in plan.order):
        for place, family in enumerate(FAMILIES):
            if family in vehicle.laws and family not in ABOARD:
                _, gain, first, width = handles[k, place]
                gains[k, gain : gain + len(vehicle.laws[family].law.parameters)] = np.nan
                memory[k, first : first + width * (size if family in PER_OTHER else 1)] = np.nan
                handles[k, place] = -1
    return tables


def answer(tables: Tables, moment: Moment) -> tuple[np.ndarray, np.ndarray]:
    """Let a vehicle think in tables that hold its readings and its inbox, and nothing of the others."""
    size, k = tables.whole.size, moment.vehicle
    row = tables.vehicles.reshape(size, VEHICLE.width)[k]
    part(row, Held)[:], part(row, Satellite)[:] = moment.held, moment.satellite
    tables.usbl.reshape(size, size * USBL_COLUMNS)[k] = moment.usbl
    if moment.inbox.size:
        tables.inbox.reshape(-1, moment.inbox.size)[k] = moment.inbox
    hidden = others_hidden(tables, k)
    reference, said = think(tables, k, moment.time)
    assert type(reference).__name__ == Reference.__name__
    assert type(said).__name__ == Report.__name__
    for table, mine, kept in hidden:
        table[~mine] = kept
    row[:] = np.nan
    return np.array(reference), np.array(said)


def others_hidden(tables: Tables, vehicle: int) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Make the other vehicles' minds, what they know, gains and memories NaN, and say how to bring them back."""
    size, found = tables.whole.size, []
    widths = {"minds": OWN_WIDTH, "others": size * OTHERS_WIDTH, "gains": -1, "memory": -1}
    for name, width in widths.items():
        table = getattr(tables, name).reshape(size, width)
        mine = np.arange(size) == vehicle
        found.append((table, mine, table[~mine].copy()))
        table[~mine] = np.nan
    return found
