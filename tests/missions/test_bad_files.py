"""Missions that people will write one day, each refused with its line, its key, and what to do."""

from typing import NamedTuple

import pytest

from missions.helpers import refused

HEAD = """\
cardume: 1
name: bad
duration: 60 s
path: {type: line, length: 200 m}
formation: {speed: 0.5 m/s}
"""
FLEET = "vehicles:\n  - name: port\n  - name: starboard\n"
GOOD = HEAD + FLEET


class Bad(NamedTuple):
    """A file, the line and key that must be named, and words that the message must hold."""

    text: str
    line: int
    key: str
    words: tuple[str, ...]


def after(extra: str, line: int, key: str, *words: str) -> Bad:
    """A good mission followed by one wrong section; lines count from that section's first."""
    return Bad(GOOD + extra, GOOD.count("\n") + line, key, words)


def instead(old: str, new: str, line: int, key: str, *words: str) -> Bad:
    """A good mission with one text replaced."""
    assert old in GOOD
    return Bad(GOOD.replace(old, new), line, key, words)


BAD = {
    # the whole file
    "a list": Bad("- cardume: 1\n", 1, "", ("given a list", "a mission is a mapping")),
    "a word": Bad("mission\n", 1, "", ("given 'mission'",)),
    "a number": Bad("42\n", 1, "", ("given 42",)),
    "only dashes": Bad("---\n", 2, "", ("given nothing",)),
    "json with a trailing brace": Bad('{"cardume": 1}}\n', 1, "syntax", ("not valid YAML",)),
    "a path file": Bad("3\n491854.338 4290819.848 29S\nLINE 0 0 60 0 0.5 -1\n", 1, "", ("a mission is a mapping",)),
    "a python file": Bad("import os\nprint(os.name)\n", 1, "", ("a mission is a mapping",)),
    "an XML file": Bad("<?xml version='1.0'?>\n<gpx/>\n", 1, "", ("a mission is a mapping",)),
    "a merge conflict": after(
        "<<<<<<< HEAD\nseed: 1\n=======\nseed: 2\n>>>>>>> theirs\n", 2, "syntax", "not valid YAML"
    ),
    "an indented section": after("  seed: 7\n", 1, "syntax", "not valid YAML"),
    "a tab": after("current:\n\ttype: uniform\n", 2, "syntax", "indent with spaces"),
    "a colon forgotten": after("seed 7\n", 2, "syntax", "not valid YAML"),
    "a bracket forgotten": after("origin: {latitude: 1 deg\nseed: 3\n", 2, "syntax", "not valid YAML"),
    "a merge key": after("<<: {seed: 3}\n", 1, "<<", "there is no key '<<'"),
    "an alias": after("compensation: &c {law: crab}\nguidance: *c\n", 2, "guidance", "alias", "write the value out"),
    "a tag that runs code": after("seed: !!python/object/apply:os.getpid []\n", 1, "seed", "tag"),
    "the same section twice": after("seed: 1\nend: hold\nseed: 2\n", 3, "seed", "given twice, on lines 9 and 11"),
    "a whole mission swept": Bad("sweep: [{cardume: 1}]\n", 1, "", ("cannot vary as a whole",)),
    # version, name, numbers
    "no version": instead("cardume: 1\n", "", 1, "cardume", "missing", "must be 1"),
    "a later version": instead("cardume: 1", "cardume: 2", 1, "cardume", "given 2", "must be 1"),
    "a version in words": instead("cardume: 1", "cardume: '1'", 1, "cardume", "given '1'"),
    "a name that leaves the folder": instead(
        "name: bad", "name: ../../etc/passwd", 2, "name", "letters, digits, - and _"
    ),
    "an absolute name": instead("name: bad", "name: /tmp/x", 2, "name", "letters, digits"),
    "a hidden name": instead("name: bad", "name: .bashrc", 2, "name", "letters, digits"),
    "a name that is a number": instead("name: bad", "name: 7", 2, "name", "given 7", "a number in quotes"),
    "a name with a newline": instead("name: bad", 'name: "a\\nb"', 2, "name", r"given 'a\nb'"),
    "a name of 65 letters": instead("name: bad", f"name: {'x' * 65}", 2, "name", "1 to 64"),
    "no duration": instead("duration: 60 s\n", "", 1, "duration", "missing", "as '1 s'"),
    "a duration of zero": instead("60 s", "0 s", 3, "duration", "given '0 s'", "above 0 s"),
    "a negative duration": instead("60 s", "-60 s", 3, "duration", "above 0 s"),
    "an endless duration": instead("60 s", ".inf", 3, "duration", "finite"),
    "a duration of years": instead("60 s", "1e9 s", 3, "duration", "at most 2592000 s"),
    "a duration in meters": instead("60 s", "60 m", 3, "duration", "length", "time", "s, min, h"),
    "a duration in minutes, misspelt": instead("60 s", "1 minute", 3, "duration", "Did you mean 'min'?"),
    "a duration as a list": instead("60 s", "[60 s]", 3, "duration", "given a list"),
    "a duration as true": instead("60 s", "true", 3, "duration", "given true"),
    "a duration left empty": instead("duration: 60 s", "duration:", 3, "duration", "no value is given"),
    "a decimal comma": instead("60 s", "60,5 s", 3, "duration", "the decimal sign is a point"),
    "a seed below zero": after("seed: -1\n", 1, "seed", "given -1", "from 0 to"),
    "a seed with a fraction": after("seed: 1.5\n", 1, "seed", "whole number"),
    "a seed too large": after("seed: 9223372036854775808\n", 1, "seed", "9223372036854775807"),
    "a tick of zero": after("tick: 0 s\n", 1, "tick", "at least 0.0001 s"),
    "a plant step above the tick": after("tick: 0.1 s\nplant_step: 0.2 s\n", 2, "plant_step", "nearest", "0.1 s"),
    "a log period between ticks": after("log_period: 0.25 s\n", 1, "log_period", "0.2 s and 0.3 s"),
    "a bare angle in degrees": after(
        "origin: {latitude: 36.8, longitude: 0}\n", 1, "origin.latitude", "did you mean '36.8 deg'"
    ),
    "a latitude beyond the pole": after(
        "origin: {latitude: 91 deg, longitude: 0}\n", 1, "origin.latitude", "at most 90 deg"
    ),
    "half an origin": after("origin: {latitude: 36 deg}\n", 1, "origin.longitude", "missing"),
    # path and formation
    "no path": instead("path: {type: line, length: 200 m}\n", "", 1, "path.type", "missing", "line, arc, circle"),
    "a path without type": instead("type: line, ", "", 4, "path.type", "missing"),
    "a path that there is not": instead("type: line", "type: lime", 4, "path.type", "Did you mean 'line'?", "segments"),
    "a path of type null": instead("type: line", "type: ~", 4, "path.type", "of type nothing"),
    "a line without length": instead(", length: 200 m", "", 4, "path.length", "missing"),
    "a line of no length": instead("200 m", "0 m", 4, "path.length", "above 0 m"),
    "another path's key": instead(
        "length: 200 m", "length: 9, radius: 5 m", 4, "path.radius", "there is no key 'radius'"
    ),
    "a path as a word": instead("{type: line, length: 200 m}", "line", 4, "path", "given 'line'"),
    "an arc of negative radius": instead(
        "line, length: 200 m", "arc, radius: -5 m, angle: 1", 4, "path.radius", "above 0 m"
    ),
    "a turn to the left": instead(
        "line, length: 200 m", "arc, radius: 5 m, angle: 1, turn: left", 4, "path.turn", "Valid here: starboard, port"
    ),
    "half a leg": instead(
        "line, length: 200 m", "lawnmower, leg: 5, legs: 2.5, spacing: 3", 4, "path.legs", "whole number"
    ),
    "no segments": instead("line, length: 200 m", "segments, segments: []", 4, "path.segments", "at least one"),
    "a segment that is neither": instead(
        "line, length: 200 m",
        "segments, segments: [{line: 3}, {lne: 4}]",
        4,
        "path.segments.1.lne",
        "Did you mean 'line'?",
    ),
    "a segment that is both": instead(
        "line, length: 200 m",
        "segments, segments: [{line: 3, arc: 4}]",
        4,
        "path.segments.0.arc",
        "does not go with line",
    ),
    "a path file that is not there": instead(
        "line, length: 200 m", "file, file: x.txt", 4, "path.file", "no such file"
    ),
    "a path file that is a folder": instead(
        "line, length: 200 m", "file, file: .", 4, "path.file", "not a regular file"
    ),
    "no formation speed": instead("formation: {speed: 0.5 m/s}\n", "", 1, "formation.speed", "missing"),
    "a formation that stands still": instead("0.5 m/s", "0 m/s", 5, "formation.speed", "above 0 m/s"),
    "a formation in degrees": instead("0.5 m/s", "20 deg", 5, "formation.speed", "angle", "speed"),
    # the fleet
    "no vehicles": Bad(HEAD, 1, "vehicles", ("missing",)),
    "an empty fleet": Bad(HEAD + "vehicles: []\n", 6, "vehicles", ("given an empty list", "at least one")),
    "an empty fleet, unsaid": Bad(HEAD + "vehicles:\n", 6, "vehicles", ("no value is given",)),
    "a fleet by name": Bad(HEAD + "vehicles: {port: {}}\n", 6, "vehicles", ("given a mapping", "'- '")),
    "a fleet by number": Bad(HEAD + "vehicles: 3\n", 6, "vehicles", ("given 3",)),
    "vehicles as words": Bad(HEAD + "vehicles: [port]\n", 6, "vehicles.0", ("given 'port'", "keys name")),
    "a vehicle without a name": Bad(HEAD + "vehicles:\n  - depth: 3 m\n", 7, "vehicles.0.name", ("missing",)),
    "equal names": instead("starboard", "port", 8, "vehicles.port", "on lines 7 and 8"),
    "a vehicle's name with a slash": instead("starboard", "a/b", 8, "vehicles.1.name", "letters, digits"),
    "a vehicle's name that is true": instead("starboard", "true", 8, "vehicles.1.name", "given true"),
    "a vehicle in the air": instead(
        "name: port", "{name: port, depth: -3 m}", 7, "vehicles.port.depth", "at least 0 m"
    ),
    "two starts at once": instead(
        "name: port",
        "{name: port, start: {north: 3, east: 1, cross_track: 2}}",
        7,
        "vehicles.port.start.cross_track",
        "does not go with",
    ),
    "half a start": instead(
        "name: port", "{name: port, start: {north: 3, heading: 1}}", 7, "vehicles.port.start.east", "missing"
    ),
    "a vehicle's own graph": instead(
        "name: starboard",
        "{name: starboard, coordination: {topology: star}}",
        8,
        "vehicles.starboard.coordination.topology",
        "the fleet has one graph",
    ),
    "a vehicle's own path": instead(
        "name: port", "{name: port, path: {}}", 7, "vehicles.port.path", "there is no key 'path'"
    ),
    # laws
    "a section misspelt": after("guidanse: {lookahead: 5 m}\n", 1, "guidanse", "Did you mean 'guidance'?"),
    "a law misspelt": after("guidance:\n  law: line_of_site\n", 2, "guidance.law", "Did you mean 'line_of_sight'?"),
    "a law that is a number": after("guidance: {law: 3}\n", 1, "guidance.law", "there is no guidance law 3"),
    "a law's key misspelt": after("guidance: {lookahed: 5 m}\n", 1, "guidance.lookahed", "Did you mean 'lookahead'?"),
    "another law's key": after("guidance: {law: arcsine, lookahead: 5 m}\n", 1, "guidance.lookahead", "gain, law"),
    "a gain out of range": after("acoustics: {channel: bernoulli, loss: 120 %}\n", 1, "acoustics.loss", "at most 1"),
    "another section's selector": after("acoustics: {law: bernoulli}\n", 1, "acoustics.law", "channel"),
    "a sensor that does not exist": after("sensors: {sonar: {}}\n", 1, "sensors.sonar", "gnss, thruster_speed, usbl"),
    "a user's law without leave": after("guidance: {law: 'other:law'}\n", 1, "guidance.law", "cannot be used"),
    "a user's law without function": after("guidance: {law: 'other:'}\n", 1, "guidance.law", "cannot be used"),
    "a graph that does not exist": after(
        "coordination: {topology: chain}\n", 1, "coordination.topology", "complete, star"
    ),
    "a matrix of the wrong size": after("coordination: {topology: [[0]]}\n", 1, "coordination.topology", "here 2 x 2"),
    "a metric misspelt": after("require: {cross_track_rsm: 1 m}\n", 1, "require.cross_track_rsm", "cross_track_rms"),
    "a requirement of nobody": after(
        "require: {prot: {settling_time: 1 s}}\n", 1, "require.prot", "Did you mean 'port'?"
    ),
    "a requirement in the wrong unit": after("require: {settling_time: 1 m}\n", 1, "require.settling_time", "time"),
    "requirements as a list": after("require: [cross_track_rms]\n", 1, "require", "given a list"),
    # values that vary
    "a distribution of nothing": after("swath: {uniform: []}\n", 1, "swath.uniform", "needs a list"),
    "a distribution upside down": after("swath: {uniform: [9, 3]}\n", 1, "swath.uniform", "the higher end first"),
    "a seed by lot": after("seed: {choose: [1, 2]}\n", 1, "seed", "may not vary"),
    "a law by lot without its keys": after("guidance: {law: {choose: [arcsine]}}\n", 1, "guidance.law", "carries"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_file_is_refused_with_line_key_and_what_to_do(name: str) -> None:
    text, line, key, words = BAD[name]
    problems = refused(text)
    here = [problem for problem in problems if (problem.position.line, problem.position.key) == (line, key)]
    assert here, f"line {line}, {key} is not among {[str(problem) for problem in problems]}"
    for word in words:
        assert word in here[0].message
    for problem in problems:
        assert problem.position.source == "m.yaml"
        assert "Error" not in problem.message
        assert len(problem.message) < 600
        assert str(problem).isprintable()


def test_the_good_file_is_good() -> None:
    from missions.helpers import parse

    assert len(parse(GOOD).vehicles) == 2


def test_problems_are_told_together() -> None:
    text = GOOD.replace("60 s", "60 m").replace("0.5 m/s", "fast").replace("200 m", "-1").replace("bad", "a/b")
    text += "seed: -1\nguidnce: {}\nend: stop\ntick: 0\nswath: [1]\nsensors: {gnss: {sgma: 1}, ahrs: {sigma: 5 m}}\n"
    keys = {problem.position.key for problem in refused(text)}
    assert keys == {
        "duration", "formation.speed", "path.length", "name", "seed", "guidnce", "end", "tick", "swath",
        "sensors.gnss.sgma", "sensors.ahrs.sigma",
    }  # fmt: skip
