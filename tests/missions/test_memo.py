"""What is remembered of missions that are nearly the same changes no number of their tables."""

import numpy as np
import pytest

from cardume.missions.available import catalog
from cardume.missions.drawing import Drawer, draw
from cardume.missions.mission import Mission
from cardume.missions.opening import open_mission
from cardume.missions.planning import make_plan
from cardume.simulation.fleet import Tables
from cardume.simulation.memo import Memo
from cardume.simulation.tables import make_tables

DRAWN = {
    "paper/figure-5": [
        "current.speed={uniform: [0 m/s, 0.2 m/s]}",
        "acoustics.loss={uniform: [0, 0.5]}",
        "guidance={choose: [{law: arcsine}, {law: line_of_sight, lookahead: {uniform: [3 m, 8 m]}}]}",
        "vehicles.port.start.north={normal: [-8 m, 2 m]}",
        "vehicles.surface.sensors.gnss.sigma={choose: [0 m, 0.5 m]}",
        "messaging.period={choose: [1 s, 2 s]}",
    ],
    "gather-and-go": [
        "vehicles.port.start.north={uniform: [-30 m, -20 m]}",
        "limits.depth={uniform: [13 m, 15 m]}",
        "phases.hold={choose: [10 s, 30 s]}",
        "path.leg={uniform: [45 m, 55 m]}",
    ],
    "survey-at-altitude": ["bathymetry.depth={uniform: [12 m, 15 m]}", "vehicles.port.altitude={uniform: [3 m, 5 m]}"],
}


def plain(mission: Mission, seed: int) -> Tables:
    return make_tables(make_plan(draw(mission, seed), catalog()).plan, with_laws=False)


@pytest.mark.parametrize("name", DRAWN)
@pytest.mark.parametrize("most", [40, 4096], ids=["forgetful", "roomy"])
def test_tables_are_the_same_with_a_memory(name: str, most: int) -> None:
    mission, known = open_mission(name, DRAWN[name]), catalog()
    drawer, memo = Drawer(mission), Memo(most)
    for seed in range(12):
        remembered = make_tables(make_plan(drawer.draw(seed)[0], known, memo).plan, with_laws=False, memo=memo)
        for field, one, other in zip(Tables._fields, remembered, plain(mission, seed), strict=True):
            assert np.array_equal(one, other, equal_nan=field != "whole"), (seed, field)


def test_what_did_not_change_is_the_same_object() -> None:
    mission, known, memo = open_mission("paper/figure-5", DRAWN["paper/figure-5"][:1]), catalog(), Memo()
    drawer = Drawer(mission)
    one, other = (make_plan(drawer.draw(seed)[0], known, memo).plan for seed in (1, 2))
    assert [a.path is b.path for a, b in zip(one.vehicles, other.vehicles, strict=True)] == [True] * 3
    laws = [(a.laws, b.laws) for a, b in zip(one.vehicles, other.vehicles, strict=True)]
    changed = {family for a, b in laws for family in a if a[family] is not b[family]}
    assert changed == {"current"}
