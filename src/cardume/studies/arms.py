"""The arms of a comparison: missions that differ in what is compared, and a short name for each."""

import itertools
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from cardume.errors import InputError, MissionError
from cardume.missions.available import catalog
from cardume.missions.drawing import sweeps_of, with_options
from cardume.missions.loading import parse_mission
from cardume.missions.mission import Mission
from cardume.missions.opening import open_mission
from cardume.missions.vehicle import LawChoice
from cardume.units import nearest, printable, show_quantity, show_text

MOST_ARMS = 200
OPENING, CLOSING, QUOTES = "([{", ")]}", "'\""

Given = str | Path | Mission


@dataclass(frozen=True)
class Arm:
    """One of the missions that are compared.

    Attributes:
        label: short, unlike every other arm's.
        mission: without sweeps; its distributions are drawn by each seed.
        given: what it was made from, as typed.
        changes: what `--set` gives to fly it alone.
        is_runnable: whether the command line can do that; not what a sweep or a program made.
    """

    label: str
    mission: Mission
    given: str
    changes: tuple[str, ...] = ()
    is_runnable: bool = True


def make_arms(
    missions: Sequence[Given],
    vary: Mapping[str, Sequence[str]],
    overrides: Sequence[str] = (),
    allow_code: Iterable[str | Path] = (),
) -> tuple[Arm, ...]:
    """Every mission with every value of every key, and every option of the sweeps in its file.

    Args:
        missions: files, built-in names, or missions already read.
        vary: keys of a mission file to the values they take, as `--set` takes them.
        overrides: what holds for all, as `--set` gives it.
        allow_code: folders from which laws may be imported.

    Raises:
        InputError: a mission or value that cannot be, too many arms, or fewer than two.
    """
    names = _short_names([_given(mission) for mission in missions])
    choices = list(itertools.product(*([(key, value) for value in values] for key, values in vary.items())))
    if len(missions) * len(choices) > MOST_ARMS:
        raise InputError(f"that makes {len(missions) * len(choices)} arms; compare at most {MOST_ARMS} at a time")
    arms = []
    for mission, name in zip(missions, names, strict=True):
        for choice in choices:
            changes = tuple(f"{key}={value}" for key, value in choice)
            found = open_given(mission, overrides, changes, tuple(allow_code))
            said = [name] if len(missions) > 1 else []
            label = ", ".join([*said, *(_value_words(key, value) for key, value in choice)])
            arms += [
                Arm(
                    label=", ".join(part for part in (label, words) if part),
                    mission=plain,
                    given=_given(mission),
                    changes=changes,
                    is_runnable=not words and not isinstance(mission, Mission),
                )
                for plain, words in _unswept(found)
            ]
            if len(arms) > MOST_ARMS:
                raise InputError(f"the sweeps make more than {MOST_ARMS} arms; compare fewer at a time")
    if len(arms) < 2:
        raise InputError(
            "there is one arm only, and nothing to compare it with: vary a key, as --vary guidance.law=line_of_sight"
            ",arcsine, name a second mission, or sweep a section in the file"
        )
    return _distinct(arms)


def parse_vary(texts: Iterable[str]) -> dict[str, list[str]]:
    """`key=value,value` of the command line as keys with their values.

    Args:
        texts: each as typed; commas inside brackets or quotes do not part values.

    Raises:
        InputError: no `=`, a key twice, or an empty or repeated value.
    """
    found: dict[str, list[str]] = {}
    for text in texts:
        key, equals, rest = text.partition("=")
        key, values = key.strip(), [value.strip() for value in split_values(rest)]
        said = f"--vary {printable(text)}"
        if not equals or not key or not all(values):
            raise InputError(f"{said}: write key=value,value, as --vary guidance.law=line_of_sight,arcsine")
        if key in found:
            raise InputError(f"{said}: {key} is varied already; give all of its values at once")
        if repeated := next((value for value in values if values.count(value) > 1), None):
            raise InputError(f"{said}: the value {show_text(repeated)} stands there twice; give different ones")
        found[key] = values
    return found


def split_values(text: str) -> list[str]:
    """The values that commas part, except commas inside brackets or quotes.

    Args:
        text: as `{law: arcsine, gain: 0.1},line_of_sight`.
    """
    parts, depth, quote = [""], 0, ""
    for character in text:
        if quote:
            quote = "" if character == quote else quote
        elif character in QUOTES:
            quote = character
        depth += (character in OPENING) - (character in CLOSING) if not quote else 0
        if character == "," and depth <= 0 and not quote:
            parts.append("")
        else:
            parts[-1] += character
    return parts


def as_text(value: object) -> str:
    """A value of Python's as a mission file writes it.

    Args:
        value: text, number, truth value, list or mapping.
    """
    return value if isinstance(value, str) else json.dumps(value)


def _given(mission: Given) -> str:
    return mission.name if isinstance(mission, Mission) else str(mission)


def open_given(
    given: Given, overrides: Sequence[str], changes: Sequence[str], allow_code: tuple[str | Path, ...]
) -> Mission:
    """A mission by whatever is given for it.

    Args:
        given: file, built-in name, or a mission already read.
        overrides: what `--set` gives.
        changes: what `--vary` gives.
        allow_code: folders from which laws may be imported.

    Raises:
        MissionError: nothing of that name, or a mission that cannot be read.
    """
    try:
        if not isinstance(given, Mission):
            return open_mission(given, [*overrides, *changes], allow_code=allow_code)
        if not overrides and not changes:
            return given
        return parse_mission(given.to_yaml(), catalog(allow_code), [*overrides, *changes], source=given.name)
    except MissionError as error:
        raise MissionError(_as_varied(problem, changes) for problem in error.problems) from None


def _as_varied(problem: Any, changes: Sequence[str]) -> Any:
    """A problem with the place where the user wrote it: in --vary, not in --set."""
    source = problem.position.source
    if any(source == f"--set {printable(change)}" for change in changes):
        return problem._replace(position=problem.position._replace(source=source.replace("--set", "--vary", 1)))
    if changes:
        return problem._replace(message=f"{problem.message} (in the arm {', '.join(map(printable, changes))})")
    return problem


def _unswept(mission: Mission) -> list[tuple[Mission, str]]:
    """The missions that the sweeps of one stand for, each with the words for what is special in it."""
    sweeps = sweeps_of(mission)
    words = {key: option_words(key, sweep.options) for key, sweep in sweeps.items()}
    number = 1
    for sweep in sweeps.values():
        number *= len(sweep.options)
    if number > MOST_ARMS:
        raise InputError(f"the sweeps make {number} arms; compare at most {MOST_ARMS} at a time")
    found = []
    for places in itertools.product(*(range(len(sweep.options)) for sweep in sweeps.values())):
        chosen = {key: sweeps[key].options[place] for key, place in zip(sweeps, places, strict=True)}
        label = ", ".join(words[key][place] for key, place in zip(sweeps, places, strict=True))
        found.append((with_options(mission, chosen) if chosen else mission, label))
    return found


def option_words(key: str, options: Sequence[Any]) -> list[str]:
    """A few words for each option of a sweep: a law by its name, and by its parameters where that says too little.

    Args:
        key: that is swept.
        options: its values.
    """
    laws = [getattr(option, "law", option) for option in options]
    if not all(isinstance(law, LawChoice) for law in laws):
        name = key.rpartition(".")[2]
        return [f"{name} {_shown(option)}" for option in options]
    names = [law.name for law in laws]
    words = []
    for law in laws:
        alike = [other for other in laws if other.name == law.name]
        told = [k for k, v in law.parameters.items() if any(other.parameters.get(k) != v for other in alike)]
        words.append(" ".join([law.name, *(f"{k} {_shown(law.parameters[k])}" for k in told)]))
    return words if len(set(words)) == len(words) else [f"{name} {k + 1}" for k, name in enumerate(names)]


def _shown(value: Any) -> str:
    return show_quantity(value, "", 4) if isinstance(value, float) else str(getattr(value, "name", value))


def _value_words(key: str, value: str) -> str:
    """A value as the name of an arm: a section without its brackets, a number with what it is."""
    if value[:1] == "{" and value[-1:] == "}":
        return value[1:-1].strip().removeprefix("law:").strip()
    return value if value[:1].isalpha() else f"{key.rpartition('.')[2]} {value}"


def _short_names(given: Sequence[str]) -> list[str]:
    """Names without the folder that all share, if they stay different."""
    if len(given) < 2:
        return list(given)
    parents = [Path(name).parent.parts for name in given]
    alike = itertools.takewhile(lambda parts: len(set(parts)) == 1, zip(*parents, strict=False))
    shared = Path(*(parts[0] for parts in alike)).as_posix()
    short = [name.removeprefix(f"{shared}/") for name in given]
    bare = [Path(name).with_suffix("").as_posix() if name.endswith((".yaml", ".yml")) else name for name in short]
    return bare if len(set(bare)) == len(bare) else short


def _distinct(arms: Sequence[Arm]) -> tuple[Arm, ...]:
    """Arms with different labels: a mission named twice gets a number."""
    labels = [arm.label or "arm" for arm in arms]
    told = [
        label if labels.count(label) == 1 else f"{label} ({labels[: k + 1].count(label)})"
        for k, label in enumerate(labels)
    ]
    return tuple(replace(arm, label=label) for label, arm in zip(told, arms, strict=True))


def check_metrics(metrics: Iterable[str], arms: Sequence[Arm], known: Iterable[str]) -> tuple[str, ...]:
    """The metrics that were asked for: `name`, of the fleet, or `vehicle.name`.

    Args:
        metrics: as typed.
        arms: whose vehicles count.
        known: names that exist.

    Raises:
        InputError: a metric that does not exist, or a vehicle that no arm has.
    """
    names, vehicles = list(known), list(dict.fromkeys(v.name for arm in arms for v in arm.mission.vehicles))
    for metric in metrics:
        vehicle, dot, name = metric.rpartition(".")
        if name not in names:
            alike = [known for known in names if name and name in known]
            hint = nearest(name, names) or (f"; like it are {', '.join(alike)}." if alike else "")
            advice = f"{hint or '.'} All of them: cardume list metrics"
            raise InputError(f"--for {printable(metric)}: there is no metric of that name{advice}")
        if dot and vehicle not in vehicles:
            listed = ", ".join(vehicles)
            raise InputError(
                f"--for {printable(metric)}: no vehicle is called {show_text(vehicle)}; there are {listed}"
            )
    return tuple(dict.fromkeys(metrics))
