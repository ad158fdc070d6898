"""What runs are judged by is decided by the mission, however the work is cut."""

import numpy as np
import pytest

import cardume
from cardume.errors import InputError
from cardume.missions.available import catalog
from cardume.missions.drawing import draw
from cardume.missions.loading import parse_mission
from cardume.missions.mission import Mission
from cardume.missions.summary import judge
from cardume.studies import layout
from cardume.studies.flying import fly_seeds
from cardume.studies.required import wanted_of
from studies.missions import NOISY

DIVED = NOISY.replace(
    "vehicles: [{name: a,", "vehicles: [{name: b, depth: 4 m, model: kinematic}, {name: a, depth: 5 m,"
)
SHORT = "duration=8 s"
DRAWN_LIMIT = "limits.depth={uniform: [3 m, 7 m]}"


def read(*overrides: str) -> Mission:
    return parse_mission(DIVED, catalog(), [SHORT, *overrides])


def names(*overrides: str) -> list[str]:
    return [one.name for one in wanted_of(read(*overrides))]


@pytest.mark.parametrize(
    ("overrides", "told"),
    [
        (["limits={depth: 6 m}"], ["depth_max <= 6 m"]),
        (["limits={depth: 6 m}", "require={depth_max: 6 m}"], ["depth_max <= 6 m"]),
        (["vehicles.a.limits={depth: 6 m}"], ["a: depth_max <= 6 m"]),
        ([DRAWN_LIMIT], ["depth_max <= its limit"]),
        (["limits.depth={sweep: [3 m, 7 m]}"], ["depth_max <= its limit"]),
        (["limits.depth={uniform: [6 m, 6 m]}"], ["depth_max <= 6 m"]),
        (["limits.depth={uniform: [3 m, 7 m], per: vehicle}"],
         ["b: depth_max <= its limit", "a: depth_max <= its limit"]),
        (["vehicles.a.limits={depth: {choose: [3 m, 7 m]}}"], ["a: depth_max <= its limit"]),
        (["vehicles.a.limits={depth: {choose: [3 m, 7 m]}}", "limits={depth: 6 m}"],
         ["b: depth_max <= 6 m", "a: depth_max <= its limit"]),
        ([DRAWN_LIMIT, "require={depth_max: 2 m}"], ["depth_max <= 2 m"]),  # is stricter than whatever is drawn
        ([DRAWN_LIMIT, "require={depth_max: 4 m}"], ["depth_max <= 4 m", "depth_max <= its limit"]),
        (["limits={choose: [none, {depth: 6 m, geofence: {radius: 50 m}}]}"],
         ["depth_max <= its limit", "geofence_margin_min >= its limit"]),
        (["limits={geofence: {radius: {uniform: [40 m, 50 m]}}}"], ["geofence_margin_min >= 0 m"]),
    ],
)  # fmt: skip
def test_a_limit_is_fixed_where_nothing_can_change_it(overrides: list[str], told: list[str]) -> None:
    assert names(*overrides) == told


def test_requirements_that_read_alike_are_refused() -> None:
    with pytest.raises(InputError, match="two requirements read alike, depth_max <= 6 m"):
        names("limits={depth: 5.99999999999999 m}", "require={depth_max: 6 m}")


@pytest.mark.parametrize("limits", [DRAWN_LIMIT, "limits={choose: [none, {depth: 4.5 m}]}"])
def test_verdicts_do_not_depend_on_the_number_of_threads(limits: str) -> None:
    """Five runs by one thread are cut into two, two and one; the last portion has nothing to differ from."""
    mission = read(limits)
    tables = [fly_seeds(mission, range(1, 6), threads=threads) for threads in (1, 2, 3)]
    for table in tables:
        assert table.requirements == ("depth_max <= its limit",)
        assert np.array_equal(table.met, tables[0].met)
        assert np.array_equal(table.got, tables[0].got, equal_nan=True)
        assert np.array_equal(table.violated_at, tables[0].violated_at, equal_nan=True)
    assert set(tables[0].met[:, 0]) == {False, True}
    for k, seed in enumerate(range(1, 6)):
        alone = draw(mission, seed)
        verdicts = judge(alone.require, cardume.fly(alone).metrics)
        assert tables[0].met[k, 0] == all(verdict.met for verdict in verdicts)  # of none at all, met


def test_a_limit_that_is_swept_is_judged_in_each_case_by_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(layout, "PORTION_WORK", 1.0)
    monkeypatch.setattr(layout, "SMALLEST_PORTION", 2)
    sweeps = [f"vehicles.{name}.limits={{depth: {{sweep: [4.5 m, 9 m]}}}}" for name in "ab"]
    found = cardume.study(read(*sweeps), 3)
    assert found["requirement"].values.tolist() == ["b: depth_max <= its limit", "a: depth_max <= its limit"]
    assert found["limit_metric"].values.tolist() == ["depth_max", "depth_max"]
    assert found["limit_vehicle"].values.tolist() == ["b", "a"]
    assert np.isnan(found["limit"].values).all()
    met = found["met"].transpose("vehicles.b.limits.depth", "vehicles.a.limits.depth", "run", "requirement").values
    assert met[..., 0].all()  # b keeps 4 m
    assert met[:, 1, :, 1].all()  # a keeps 5 m, and may go down to 9 m
    assert not met[:, 0, :, 1].any()
