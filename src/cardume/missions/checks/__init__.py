"""`check`: what theory knows about a mission before it flies, one file per subject.

for finding in check_mission(mission):
    print(finding.level, finding.key, finding.message, finding.suggestion)
"""

from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path

from cardume.missions.available import catalog
from cardume.missions.catalog import Catalog
from cardume.missions.checks import (
    coordination,
    current,
    depths,
    faults,
    geometry,
    guidance,
    medium,
    messages,
    observer,
    path_file,
    sensing,
    speeds,
    timing,
)
from cardume.missions.checks.finding import LEVELS, Finding
from cardume.missions.checks.scene import Scene, make_scene
from cardume.missions.checks.variants import is_too_varied, variants
from cardume.missions.mission import Mission
from cardume.missions.planning import make_plan
from cardume.missions.schema import Profile

__all__ = ["CHECKS", "Finding", "check_mission"]

Check = Callable[[Scene], Iterable[Finding]]

CHECKS: tuple[Check, ...] = (
    geometry.check_separation,
    geometry.check_aim,
    current.check_beaten,
    current.check_drift,
    current.check_end,
    speeds.check_fastest,
    speeds.check_slowest,
    speeds.check_overtaken,
    observer.check_euler,
    observer.check_gaps,
    observer.check_scale,
    observer.check_source,
    guidance.check_lag,
    guidance.check_delay,
    guidance.check_tick,
    guidance.check_compensation,
    coordination.check_agreement,
    coordination.check_prediction,
    coordination.check_late_rates,
    sensing.check_senses,
    sensing.check_lost,
    sensing.check_lateness,
    sensing.check_memory,
    messages.check_waiting,
    messages.check_load,
    messages.check_slots,
    medium.check_cycle,
    medium.check_slot,
    medium.check_talking_at_once,
    medium.check_noise,
    medium.check_codec,
    depths.check_slope,
    depths.check_aground,
    depths.check_echo,
    depths.check_bottom_track,
    depths.check_limits,
    depths.check_dive,
    timing.check_duration,
    timing.check_steps,
    faults.check_after_the_end,
    faults.check_of_the_lost,
    path_file.check_path_file,
)


def check_mission(mission: Mission, allow_code: Iterable[str | Path] = ()) -> list[Finding]:
    """Apply what theory knows to a mission, without flying it.

    Of a mission whose values vary the middle is looked at, and each value at its extremes, one at a time.

    Args:
        mission: as read; it may hold distributions and sweeps.
        allow_code: folders from which the mission's own laws may be imported.

    Returns:
        Findings, errors first. What planning refuses is among them, not raised.
    """
    known, found = catalog(allow_code), list[Finding]()
    told: set[tuple[str, str, str]] = set()
    for plain, circumstance in variants(mission):
        for name, finding in _check(plain, known):
            if (name, finding.level, finding.key) not in told:
                told.add((name, finding.level, finding.key))
                message = finding.message + circumstance
                found.append(Finding(finding.level, finding.key, message, finding.suggestion))
    if is_too_varied(mission):
        found.append(Finding("note", "", "more values vary than were looked at; the others stayed in their middle"))
    return sorted(found, key=lambda finding: LEVELS.index(finding.level))


def _check(mission: Mission, known: Catalog) -> list[tuple[str, Finding]]:
    """The findings of a mission with plain values, each with the check it comes from."""
    planned, problems = geometry.plan_or_problems(mission, known)
    if planned is None:
        return [("planning", finding) for finding in problems]
    scene = make_scene(mission, planned)
    found = [(check.__qualname__ + check.__module__, finding) for check in CHECKS for finding in check(scene)]
    return [*found, *_at_extremes(mission, known)]


def _at_extremes(mission: Mission, known: Catalog) -> list[tuple[str, Finding]]:
    """What is too fast or too slow at the fastest and the slowest of a profile of v_L; else its mean is looked at."""
    profile, found = mission.formation.speed, list[tuple[str, Finding]]()
    if not isinstance(profile, Profile):
        return found
    for speed, word in ((max(profile.values), "fastest"), (min(profile.values), "slowest")):
        steady = replace(mission, formation=replace(mission.formation, speed=speed))
        scene = make_scene(steady, make_plan(steady, known))
        for check in (speeds.check_fastest, speeds.check_slowest, speeds.check_overtaken):
            told = [replace(f, message=f"{f.message} (at the {word} of formation.speed)") for f in check(scene)]
            found += [(check.__qualname__ + word, replace(finding, suggestion="")) for finding in told]
    return found
