"""Many seeds of one mission: every number is that of the mission flown alone."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cardume
from cardume.errors import MissionError
from cardume.missions.available import catalog
from cardume.missions.drawing import draw
from cardume.missions.loading import parse_mission
from cardume.missions.mission import Mission
from cardume.missions.summary import judge
from cardume.studies import flying
from cardume.studies.flying import RunTable, fly_seeds
from studies.missions import NOISY

DRAWN = NOISY.replace("speed: 0.1 m/s, towards", "speed: {uniform: [0 m/s, 0.2 m/s]}, towards")


def read(text: str, *overrides: str) -> Mission:
    return parse_mission(text, catalog(), overrides)


def check_alone(mission: Mission, table: RunTable) -> None:
    """Every row against the mission flown by itself."""
    for k, seed in enumerate(table.seeds):
        alone = cardume.fly(draw(mission, int(seed))).metrics
        for name in alone.fleet | next(iter(alone.vehicles.values())):
            assert np.array_equal(table.metrics[f"fleet_{name}"][k], alone.worst(name)[0], equal_nan=True), name
            if name in table.metrics:
                own = [alone.vehicles[v.name][name] for v in mission.vehicles]
                assert np.array_equal(table.metrics[name][k], own, equal_nan=True), name


@pytest.mark.parametrize("lanes", [False, True])
def test_a_row_is_the_mission_flown_alone(lanes: bool) -> None:
    mission = read(DRAWN, "require={cross_track_max: 1 m}")
    table = fly_seeds(mission, [4, 2, 11], lanes=lanes)
    assert table.seeds.tolist() == [4, 2, 11]
    assert table.requirements == ("cross_track_max <= 1 m",)
    assert (table.got[:, 0] == table.metrics["fleet_cross_track_max"]).all()
    assert (table.met[:, 0] == (table.got[:, 0] <= 1.0)).all()
    assert table.failure == ("", "", "")
    assert np.isnan(table.failed_at).all()
    speeds = [draw(mission, seed).current.parameters["speed"] for seed in (4, 2, 11)]
    assert table.drawn["current.speed"].tolist() == speeds
    check_alone(mission, table)


def test_chances_take_the_place_of_those_that_the_seed_gives() -> None:
    mission = read(DRAWN)
    table = fly_seeds(mission, [1, 2], chances={"current.speed": np.array([0.25, 0.75])})
    assert table.drawn["current.speed"].tolist() == [0.05, pytest.approx(0.15)]
    other = fly_seeds(mission, [1, 2])
    assert not (table.metrics["cross_track_max"] == other.metrics["cross_track_max"]).any()


def test_laws_that_are_drawn_are_told_by_name() -> None:
    laws = "guidance={choose: [{law: arcsine}, {law: line_of_sight, lookahead: {uniform: [2 m, 4 m]}}]}"
    mission = read(DRAWN, laws)
    table = fly_seeds(mission, range(1, 7))
    assert set(table.drawn["guidance"]) == {"arcsine", "line_of_sight"}
    assert (np.isnan(table.drawn["guidance.lookahead"]) == (table.drawn["guidance"] == "arcsine")).all()
    check_alone(mission, table)


def test_nothing_is_required_and_nothing_flown() -> None:
    table = fly_seeds(read(NOISY), [])
    assert (len(table), table.requirements, table.got.shape) == (0, (), (0, 0))
    told: list[tuple[str, int, int]] = []
    stopped = fly_seeds(
        read(NOISY),
        range(40),
        progress=lambda *what: told.append(what),
        should_stop=lambda: bool(told) and told[-1][0] == "fly" and told[-1][1] >= 8,
    )
    assert 8 <= len(stopped) < 40
    assert math.isfinite(stopped.metrics["fleet_energy"][-1])


EVERY_KIND = (
    "guidance={choose: [{law: arcsine, gain: {uniform: [0.05 1/s, 0.2 1/s]}}, {law: line_of_sight, lookahead: 3 m}]}",
    "path.length={uniform: [90 m, 110 m]}",
    "path.start={course: {normal: [10 deg, 5 deg]}}",
    "current={choose: [none, {type: uniform, speed: {uniform: [0 m/s, 0.2 m/s]}, towards: 40 deg}]}",
    "vehicles.a.start.cross_track={normal: [3 m, 1 m]}",
    "vehicles.a.sensors.gnss={sigma: {choose: [0 m, 0.2 m]}, period: {choose: [0.5 s, 1 s]}, latency: 0.2 s}",
    "vehicles.b.depth={uniform: [2 m, 8 m]}",
    "messaging.period={choose: [1 s, 2 s]}",
    "acoustics={channel: bernoulli, loss: {uniform: [0, 0.9]}, delay: {uniform: [0.1 s, 0.6 s]}}",
    "duration={choose: [15 s, 20 s, 25.5 s]}",
    "transient.threshold={uniform: [1 m, 3 m]}",
    "limits.depth={uniform: [3 m, 9 m]}",
    "formation.speed={choose: [0.4 m/s, {profile: time, points: [[0 s, 0.3 m/s], [20 s, 0.5 m/s]]}]}",
)
TWO = DRAWN.replace("vehicles: [", "vehicles: [{name: b, model: kinematic, offset: {starboard: 3 m}}, ")


@pytest.mark.parametrize("lanes", [False, True])
def test_whatever_is_drawn_a_row_is_the_mission_flown_alone(lanes: bool) -> None:
    mission = read(TWO, *EVERY_KIND)
    table = fly_seeds(mission, range(24), lanes=lanes)
    check_alone(mission, table)
    assert set(table.drawn) >= {"guidance", "current", "path.length", "duration", "vehicles.a.sensors.gnss.sigma"}
    assert len(set(table.drawn["duration"])) == 3
    for k, seed in enumerate(table.seeds):
        flight = cardume.fly(draw(mission, int(seed)))
        told = {
            f"{v.vehicle}: {v.metric}" if v.vehicle else v.metric: v
            for v in judge(draw(mission, int(seed)).require, flight.metrics)
        }
        for j, name in enumerate(table.requirements):
            verdict = told[name.partition(" <= ")[0]]
            assert (table.got[k, j], table.met[k, j]) == (verdict.got, verdict.met)
            when = np.nan if verdict.first_violated is None else verdict.first_violated
            assert np.array_equal(table.violated_at[k, j], when, equal_nan=True)


def test_a_run_that_cannot_be_drawn_costs_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    """A tick of 0.05 s is no whole multiple of a plant step of 0.1 s: a quarter of the draws; each flies once."""
    mission = read(NOISY, "tick={choose: [0.1 s, 0.05 s]}", "plant_step={choose: [0.05 s, 0.1 s]}", "duration=6 s")
    flown: list[int] = []
    real = flying.fly_alone

    def spy(plan, *rest):  # type: ignore[no-untyped-def]
        flown.append(plan.seed)
        return real(plan, *rest)

    monkeypatch.setattr(flying, "fly_alone", spy)
    with pytest.raises(MissionError, match="must be a whole multiple"):
        fly_seeds(mission, range(20))
    flown.clear()
    for lanes in (False, True):
        table = fly_seeds(mission, range(20), is_lenient=True, lanes=lanes)
        assert table.seeds.tolist() == list(range(20))
        assert 0 < table.is_refused.sum() < 20
        assert all(
            ("must be a whole multiple" in why) == no for why, no in zip(table.failure, table.is_refused, strict=True)
        )
        assert (np.isnan(table.metrics["fleet_energy"]) == table.is_refused).all()
        if not lanes:
            assert sorted(flown) == table.seeds[~table.is_refused].tolist()
