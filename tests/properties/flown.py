"""Missions from text to plans, and what two flights have in common."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from cardume.missions.available import catalog
from cardume.missions.drawing import draw
from cardume.missions.loading import parse_mission
from cardume.missions.planning import make_plan
from cardume.simulation.fleet import Tables
from cardume.simulation.flight import CHANNELS, Flight
from cardume.simulation.plan import Plan
from cardume.simulation.score import SCORES, Deviation
from flying import LAWS

LOCAL = ("handles", "noise", "aside")  # addresses of this process; draws that one mission makes ahead, and eight do not


def plan_of(text: str, overrides: Sequence[str] = (), seed: int | None = None) -> Plan:
    """The plan of the mission in a text, drawn by a seed."""
    mission = parse_mission(text, catalog([LAWS]), overrides)
    return make_plan(draw(mission, mission.seed if seed is None else seed), catalog([LAWS])).plan


def same_bits(one: np.ndarray, other: np.ndarray) -> bool:
    """Equal to the last bit, NaN where NaN."""
    return one.shape == other.shape and one.tobytes() == other.tobytes()


def kept(tables: Tables) -> Tables:
    """The tables without the scratch pad that `score_formation` leaves: lanes write it when any lane counts."""
    scores = tables.scores.reshape(-1, SCORES.width).copy()
    start = SCORES.offsets[Deviation]
    scores[:, start : start + len(Deviation._fields)] = 0.0
    return tables._replace(scores=scores)


def different_tables(one: Tables, other: Tables, apart_from: Iterable[str] = LOCAL) -> list[str]:
    """The names of the tables in which two missions differ."""
    one, other = kept(one), kept(other)
    names = [name for name in Tables._fields if name not in apart_from]
    arrays = [n for n in names if isinstance(getattr(one, n), np.ndarray)]
    found = [n for n in arrays if not same_bits(getattr(one, n), getattr(other, n))]
    return found + [n for n in names if n not in arrays and getattr(one, n) != getattr(other, n)]


def write_tables(file: Path, tables: Tables) -> None:
    """Keep the numbers of a mission for another process."""
    np.savez(file, **{n: a for n, a in kept(tables)._asdict().items() if isinstance(a, np.ndarray) and n not in LOCAL})


def far_tables(one: Tables, file: Path) -> list[str]:
    """The names of the tables that are farther than 1e-12 from those in a file: what plain Python may differ by."""
    with np.load(file) as other:
        return [n for n, a in other.items() if not np.allclose(getattr(kept(one), n), a, 1e-12, 1e-12, equal_nan=True)]


def different_channels(one: Flight, other: Flight, names: Iterable[str]) -> list[str]:
    """What two flights tell differently of the vehicles of these names, to the last bit."""
    found = []
    for name in names:
        here, there = one.vehicle_names.index(name), other.vehicle_names.index(name)
        for channel in CHANNELS:
            if not same_bits(one.channels[channel][:, here].copy(), other.channels[channel][:, there].copy()):
                found.append(f"{channel} of {name}")
    return found
