"""What a page asks and is told, without a browser."""

import math
import os
import queue
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("tornado", reason="pip install 'cardume[lab]'")

from cardume.lab.folder import open_folder
from cardume.lab.handlers import Lab
from cardume.lab.session import LARGEST_SEED, Session
from cardume.missions.flying import fly_mission
from cardume.missions.opening import open_mission
from cardume.studies.constants import FLEET
from cardume.studies.flying import fly_seeds
from lab.serving import calling, get, serving
from report.packs import unpacked


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    with serving(tmp_path_factory.mktemp("work")) as served:
        yield served


def test_what_the_page_draws_is_what_run_flies(lab: Lab) -> None:
    with calling(lab) as page:
        page.say(do="open", name="kinematic/line")
        page.hear("flown")
        page.say(do="fly", id=5, values={"vehicles.alone.guidance.lookahead": "9 m"})
        told = page.hear("flown")
    assert told["id"] == 5
    assert "groups" not in told  # the same controls as before
    flight = fly_mission(open_mission("kinematic/line", ["guidance.lookahead=9"]))
    for name in ("north", "east", "cross_track"):
        np.testing.assert_allclose(
            unpacked(told["flight"]["lines"][name][0]), flight.channels[name][:, 0], rtol=1e-6, atol=1e-6
        )


def test_of_flights_that_wait_only_the_last_is_flown(lab: Lab) -> None:
    with calling(lab) as page:
        page.say(do="open", name="kinematic/line")
        page.hear("flown")
        for number in range(30):
            page.say(do="fly", id=number, values={"vehicles.alone.guidance.lookahead": f"{number + 1} m"})
        heard = []
        while not heard or heard[-1] != 29:
            heard.append(page.hear("flown")["id"])
    assert heard == sorted(heard)
    assert len(heard) < 30


def test_laws_are_switched_and_their_controls_come(lab: Lab) -> None:
    with calling(lab) as page:
        page.say(do="open", name="kinematic/line")
        page.hear("flown")
        page.say(
            do="fly",
            id=1,
            laws={"vehicles.alone.guidance.law": "arcsine"},
            values={"vehicles.alone.guidance.gain": "0.2 1/s"},
        )
        told = page.hear("flown", "refused")
    assert told["is"] == "flown"
    keys = [key for group in told["groups"] for control in group["controls"] for key in control["keys"]]
    assert "vehicles.alone.guidance.gain" in keys
    assert "vehicles.alone.guidance.lookahead" not in keys


def test_what_is_wrong_is_told_with_its_key(lab: Lab) -> None:
    with calling(lab) as page:
        page.say(do="open", name="kinematic/line")
        page.hear("flown")
        page.say(do="fly", id=1, values={"vehicles.alone.guidance.lookahead": "-3 m"})
        (problem,) = page.hear("refused", "flown")["problems"]
        assert problem["key"] == "vehicles.alone.guidance.lookahead"
        assert "above 0 m" in problem["message"]
        page.say(do="fly", id=2, values={"duration": "29 d"})
        assert "not a unit" in page.hear("refused")["problems"][0]["message"]
        page.say(do="fly", id=3, values={"duration": "2000000 s"})
        assert "too much" in page.hear("refused")["problems"][0]["message"]


def test_saving_writes_a_mission_that_flies_the_same(lab: Lab) -> None:
    changed = {"values": {"vehicles.alone.guidance.lookahead": "9 m"}, "seed": 12}
    with calling(lab) as page:
        page.say(do="open", name="kinematic/line")
        page.hear("flown")
        page.say(do="save", name="mine", **changed)
        assert page.hear("saved", "refused")["files"] == ["mine.yaml"]
        page.say(do="save", name="mine", **changed)
        assert page.hear("saved", "refused", "taken")["is"] == "taken"
        page.say(do="save", name="mine.yaml", replace=True, **changed)
        assert page.hear("saved", "refused", "taken")["is"] == "saved"
        page.say(do="open", name="mine.yaml")
        again = page.hear("flown")["flight"]
    file = lab.folder.root / "mine.yaml"
    mission = open_mission(file)
    assert (mission.name, mission.seed) == ("mine", 12)
    assert mission.vehicles[0].guidance.law.parameters["lookahead"] == 9.0
    assert again["seed"] == 12
    assert os.listdir(lab.folder.root) == ["mine.yaml"]  # nothing half written


def test_the_report_is_of_what_was_flown_last(lab: Lab) -> None:
    with calling(lab) as page:
        name = page.hear("named")["name"]
        assert get(lab, f"/{lab.guard.token}/report/{name}")[0] == 404
        page.say(do="open", name="kinematic/line")
        page.say(do="fly", id=1, values={"duration": "33 s"})
        while page.hear("flown").get("id") != 1:
            pass
        status, text, headers = get(lab, f"/{lab.guard.token}/report/{name}")
    assert status == 200
    assert "duration: 33 s" in text
    assert "Content-Security-Policy" not in headers  # the report brings its own
    assert get(lab, f"/{lab.guard.token}/report/{name}")[0] == 404  # the page is gone


def test_any_path_becomes_waypoints_that_keep_to_it(lab: Lab) -> None:
    with calling(lab) as page:
        page.say(do="open", name="paper/figure-5")
        page.hear("flown", "refused")
        page.say(do="points")
        points = page.hear("points", "refused")["points"]
    assert 8 <= len(points) <= 12
    assert points[0] == pytest.approx([0.0, 0.0], abs=0.01)
    assert max(north for north, _ in points) == pytest.approx(72.0, abs=1.0)  # 60 m of leg, and the half circle


def test_a_study_tells_its_numbers_as_they_come_and_stops(lab: Lab) -> None:
    wind = {"values": {"current": "{type: uniform, speed: {uniform: [0 m/s, 0.2 m/s]}}"}}
    with calling(lab) as page:
        page.say(do="open", name="kinematic/line")
        page.hear("flown")
        page.say(do="study", runs=30, **wind)
        done, values = 0, []
        while done < 30:
            told = page.hear("study")
            assert told["total"] == 30
            values += told["metrics"]["cross_track_rms"]
            assert len(values) == told["done"] > done
            done = told["done"]
        assert len({value for value in values if value is not None and math.isfinite(value)}) > 10
        page.say(do="study", id=2, runs=100_000, **wind)
        told = page.hear("study")
        assert told["done"] < 100
        assert told["id"] == 2  # by which the page knows portions of the study before
        page.say(do="stop")
        page.say(do="fly", id=9)
        page.hear("flown")  # the page goes on


def test_a_study_flies_the_seeds_that_cardume_study_does(lab: Lab) -> None:
    wind = ["current={type: uniform, speed: {uniform: [0 m/s, 0.2 m/s]}}"]
    with calling(lab) as page:
        page.say(do="open", name="kinematic/line")
        page.hear("flown")
        page.say(do="study", runs=3, seed=40, values=dict(text.split("=", 1) for text in wind))
        told = page.hear("study", "refused")
        assert told["met"] is None  # nothing is required of it
        page.say(do="study", runs=4, values={"require": "{cross_track_rms: 100 m}"})
        assert page.hear("study", "refused")["met"] == "100 % (51 to 100 %)"
        page.say(do="study", runs=3, seed=LARGEST_SEED)
        assert "smaller seed" in page.hear("refused")["problems"][0]["message"]
    table = fly_seeds(open_mission("kinematic/line", wind), [40, 41, 42])
    assert told["metrics"]["cross_track_rms"] == list(table.metrics[FLEET + "cross_track_rms"])


def flying_studies() -> list[threading.Thread]:
    return [thread for thread in threading.enumerate() if thread.name == "study"]


def ends(condition: Callable[[], bool], seconds: float = 30.0) -> bool:
    """Whether something comes about in time."""
    until = time.monotonic() + seconds
    while not condition() and time.monotonic() < until:
        time.sleep(0.02)
    return condition()


def test_a_study_ends_with_its_mission(lab: Lab) -> None:
    with calling(lab) as page:
        page.say(do="open", name="kinematic/line")
        page.hear("flown")
        page.say(do="study", runs=100_000)
        page.hear("study")
        assert flying_studies()
        page.say(do="open", name="no/such/mission")
        page.hear("refused")
        assert flying_studies()  # its mission is still there
        page.say(do="open", name="kinematic/circle")
        page.hear("opened")
        assert not flying_studies()


def test_a_study_ends_with_its_page_even_if_it_had_not_begun(tmp_path: Path) -> None:
    told: queue.Queue[dict[str, Any]] = queue.Queue()
    session = Session(open_folder(tmp_path), told.put, "1.2.3")
    session.ask({"do": "open", "name": "kinematic/line"})
    session.ask({"do": "study", "runs": 100_000})
    while told.get(timeout=200)["is"] != "opened":
        pass
    session.close()  # while the mission flies: the study still waits for its turn
    assert ends(lambda: not session.is_working, 200.0)  # its laws may have to be compiled
    assert ends(lambda: not flying_studies(), 2.0)


def test_a_line_that_was_lost_brings_back_what_was_changed(lab: Lab) -> None:
    changed = {"laws": {"vehicles.alone.guidance.law": "arcsine"}, "values": {"duration": "33 s"}, "seed": 12}
    with calling(lab) as page:
        page.say(do="open", name="kinematic/line", again=True, **changed)
        assert page.hear("opened")["again"] is True
        told = page.hear("flown", "refused")
        assert (told["flight"]["seed"], told["seed"]) == (12, 12)
        assert 30.0 < unpacked(told["flight"]["times"])[-1] <= 33.0
        keys = [key for group in told["groups"] for control in group["controls"] for key in control["keys"]]
        assert "vehicles.alone.guidance.gain" in keys
        page.say(do="open", name="kinematic/line", **changed)  # chosen by hand: as it is in its file
        assert page.hear("opened")["again"] is False
        assert page.hear("flown")["flight"]["seed"] != 12


def test_two_pages_do_not_disturb_each_other(lab: Lab) -> None:
    with calling(lab) as one, calling(lab) as other:
        one.say(do="open", name="kinematic/line")
        other.say(do="open", name="kinematic/circle")
        assert one.hear("opened")["name"] == "kinematic/line"
        assert other.hear("opened")["name"] == "kinematic/circle"
        one.hear("flown")
        other.hear("flown")
        one.say(do="fly", id=1, values={"vehicles.alone.guidance.lookahead": "9 m"})
        other.say(do="fly", id=1)
        assert one.hear("flown")["flight"]["name"] != other.hear("flown")["flight"]["name"]
