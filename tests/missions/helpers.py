"""Missions to start from, and what a test wants to know of a refused one."""

import copy
import json
from typing import Any

import pytest

from cardume.errors import MissionError, Problem
from cardume.missions import Catalog, Mission, parse_mission
from missions.fakes import CATALOG

SMALLEST = """\
cardume: 1
name: line
duration: 60 s
path: {type: line, start: {north: 0 m, east: 0 m, course: 30 deg}, length: 200 m}
formation: {speed: 0.5 m/s}
vehicles:
  - {name: alone, model: kinematic, sensors: ideal, start: {cross_track: 10 m}}
guidance: {law: line_of_sight, lookahead: 5 m}
"""

DESIGN = """\
cardume: 1                       # format version
name: figure-5
seed: 7
duration: 700 s
tick: 0.1 s
origin: {latitude: 36.80 deg, longitude: -7.24 deg}
path:
  type: lawnmower
  start: {north: 0 m, east: 0 m, course: 0 deg}
  leg: 60 m
  legs: 4
  spacing: 24 m
  turn: starboard
formation: {speed: 0.5 m/s}
current: {type: uniform, speed: 0.1 m/s, towards: 60 deg}
vehicles:
  - name: surface
    model: medusa
    depth: 0 m
    offset: {ahead: 0 m, starboard: 0 m}
    start: {north: -5 m, east: 3 m, heading: 20 deg, speed: 0 m/s}
    sensors: {gnss: {sigma: 0.5 m}, usbl: {}, ahrs: {}}
  - name: port
    model: medusa
    depth: 10 m
    offset: {starboard: -3 m}
    sensors: {ahrs: {}, depth: {}, thruster_speed: {scale: 1.1}}
    initial_estimate: {north: 4 m, east: -6 m}
  - name: starboard
    # any section below may be overridden per vehicle
guidance: {law: line_of_sight, lookahead: 5 m, reference_point: projection}
compensation: {law: crab}
current_observer: {law: complementary, k1: 0.2, k2: 0.01}
position: {law: reset}
coordination: {law: laplacian_tanh, gain: 0.15 m/s, length_scale: 1 m, topology: star}
speed_reference: ground
messaging: {schedule: periodic, period: 1 s}
acoustics: {channel: bernoulli, loss: 0.2, delay: 0.3 s}
require:
  cross_track_rms: 0.5 m
  coordination_error_max: 3 m
"""


def parse(text: str, *overrides: str, catalog: Catalog = CATALOG, **named: Any) -> Mission:
    return parse_mission(text, catalog, overrides, source="m.yaml", **named)


def tree() -> dict[str, Any]:
    """The smallest mission as plain data, to change."""
    return copy.deepcopy(
        {
            "cardume": 1,
            "name": "line",
            "duration": "60 s",
            "path": {"type": "line", "length": "200 m"},
            "formation": {"speed": "0.5 m/s"},
            "vehicles": [{"name": "port"}, {"name": "starboard"}],
        }
    )


def mission(*overrides: str, **sections: Any) -> Mission:
    """A mission of two vehicles with these sections; JSON is YAML too."""
    return parse(json.dumps({**tree(), **sections}), *overrides)


def refused(text: str, *overrides: str, **named: Any) -> tuple[Problem, ...]:
    """The problems for which a text is refused; each says where, what was given or is missing, and what to do."""
    with pytest.raises(MissionError) as caught:
        parse(text, *overrides, **named)
    assert caught.value.problems
    assert caught.value.exit_code == 2
    return caught.value.problems


def refused_mission(*overrides: str, **sections: Any) -> Problem:
    """The one problem of a mission of two vehicles with these sections."""
    (problem,) = refused(json.dumps({**tree(), **sections}), *overrides)
    return problem
