"""The smallest distance of two vehicles, which the engine looks for only when it can have fallen."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from flying import fly_text

HEAD = """
cardume: 1
name: crowd
seed: {seed}
duration: 60 s
log_period: 0.1 s
path: {{type: line, length: 60 m}}
formation: {{speed: 0.6 m/s}}
current: {{type: uniform, speed: 0.1 m/s, towards: 70 deg, variation_sigma: 0.05 m/s}}
model: {model}
vehicles:
"""
VEHICLE = (
    "  - {{name: v{number}, depth: {depth:.2f} m, offset: {{ahead: {ahead:.2f} m, starboard: {starboard:.2f} m}},"
    " start: {{along_track: {along:.2f} m, cross_track: {cross:.2f} m, speed: 0.3 m/s}}}}\n"
)


@pytest.mark.parametrize("model", ["kinematic", "medusa"])
@pytest.mark.parametrize(("size", "seed"), [(2, 1), (3, 2), (7, 3), (7, 4), (12, 5)])
def test_no_pair_is_missed(size: int, seed: int, model: str) -> None:
    """Vehicles that start across one another's way pass closely, one pair after the other."""
    rng = np.random.default_rng(seed)
    names = ("depth", "ahead", "starboard", "along", "cross")
    draws = zip(rng.uniform(0, 4, size), *(rng.uniform(-8, 8, (4, size))), strict=True)
    text = "".join(VEHICLE.format(number=k, **dict(zip(names, one, strict=True))) for k, one in enumerate(draws))
    flight = fly_text(HEAD.format(seed=seed, model=model) + text)
    north, east, depth = (flight.channels[name] for name in ("north", "east", "depth"))
    place = np.stack([north, east, depth])[:, np.isfinite(north[:, 0])]
    apart = [np.sqrt(((place[..., a] - place[..., b]) ** 2).sum(axis=0)) for a, b in combinations(range(size), 2)]
    nearest = np.min(apart, axis=0)
    found = flight.metrics.fleet["separation_min"]
    assert found == pytest.approx(nearest[: round(flight.flown / 0.1)].min(), abs=1e-12)
    assert nearest.argmin() > 0 or size == 2  # they come nearer than they start
