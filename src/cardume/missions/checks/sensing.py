"""What a vehicle cannot do without: heading, speed, fixes; and what it makes of late ones."""

import math
from collections.abc import Iterator
from dataclasses import replace

from cardume.errors import MissionError
from cardume.missions.checks.abilities import MEDUSAS
from cardume.missions.checks.finding import Finding, Ranked, setting, setting_word, show, worst
from cardume.missions.checks.fixes import has_gnss
from cardume.missions.checks.scene import Craft, Scene
from cardume.missions.mission import Mission
from cardume.missions.rules import check_rules
from cardume.onboard.estimation.position.kalman_replay import REMEMBERED as REPLAYED
from cardume.onboard.estimation.position.reset_compensated import REMEMBERED

BIAS_SHOWN = 0.05  # [m]
MOST_TRIED = 100
LOOKING_BACK = {
    "reset_compensated": (REMEMBERED - 1, "taken for as old as that"),
    "kalman_replay": (REPLAYED - 1, "left out"),
}
KINDS = ("gnss", "ahrs", "depth", "usbl", "dvl", "thruster_speed", "altimeter")


def check_senses(scene: Scene) -> Iterator[Finding]:
    """A vehicle without a heading, a speed or a depth."""
    for craft in scene.crafts:
        laws = craft.plan.laws
        if "ahrs" not in laws:
            yield Finding(
                "error",
                scene.key(craft, "sensors.ahrs"),
                f"{craft.name} has no ahrs: without a heading nothing aboard works, and the mission stops at once",
                with_sensor(craft, "ahrs"),
            )
        if "thruster_speed" not in laws and "dvl" not in laws:
            yield Finding(
                "error",
                scene.key(craft, "sensors.thruster_speed"),
                f"{craft.name} has neither thruster_speed nor dvl: it takes its speed through the water for 0, so its"
                " speed, dead reckoning and current are all wrong",
                with_sensor(craft, "thruster_speed"),
            )
        is_diver = laws["model"].law.name in MEDUSAS and craft.plan.setup.depth > 0.0
        if is_diver and "depth" not in laws:
            yield Finding(
                "warning",
                scene.key(craft, "sensors.depth"),
                f"{craft.name} has no depth sensor: it neither keeps nor changes its depth, and stays at"
                f" {show(craft.plan.setup.depth, 'm')} only because the model floats neutrally",
                with_sensor(craft, "depth"),
            )


def with_sensor(craft: Craft, kind: str) -> str:
    """A setting that gives a vehicle one more sensor; ideal ones, being one word, are written out.

    Args:
        craft: the vehicle.
        kind: such as `usbl`.
    """
    own = f"vehicles.{craft.name}.sensors"
    if not craft.vehicle.sensors.ideal:
        return setting_word(f"{own}.{kind}", "{}")
    kinds = [k for k in KINDS if k == kind or k in craft.plan.laws]
    return setting_word(own, "{" + ", ".join(f"{k}: {{}}" for k in kinds) + "}")


def check_lost(scene: Scene) -> Iterator[Finding]:
    """A vehicle to which nobody ever tells where it is."""
    for craft in scene.crafts:
        if craft.fixes.source is not None:
            continue
        time = scene.mission.duration
        drift = float(craft.stations.current_speed.max())
        grows = f", here up to {show(drift, 'm/s')}, {show(drift * time, 'm')} by the end" if drift > 0.0 else ""
        below = "under water, where no GNSS reaches" if craft.plan.setup.depth > 0.0 else "without gnss"
        yield Finding(
            "warning",
            scene.key(craft, "sensors") if craft.plan.setup.depth == 0.0 else f"vehicles.{craft.name}.depth",
            f"{craft.name} is {below}, and no vehicle that knows its own place sees it by usbl and tells it: its"
            f" believed position drifts with the current, which it cannot observe{grows}, and with every error of"
            " speed and heading",
            _giver(scene, craft),
        )


def _giver(scene: Scene, craft: Craft) -> str:
    """Who could give fixes: the vehicle itself, or one that has GNSS and speaks."""
    if craft.plan.setup.depth == 0.0:
        return with_sensor(craft, "gnss")
    others = [c for c in scene.crafts if c is not craft and has_gnss(c.plan)]
    speaking = [c for c in others if c.law("messaging").law.name != "silent" and "usbl" not in c.plan.laws]
    if speaking:
        return with_sensor(speaking[0], "usbl")
    return setting_word(f"vehicles.{craft.name}.depth", "0 m") if "gnss" in craft.plan.laws else ""


def check_lateness(scene: Scene) -> list[Finding]:
    """Fixes taken for newer than they are: a bias of V tau along the path.

    Source: closed form S (docs/theory/closed-forms.md), a delay that is not compensated.
    """
    return worst(ranked for craft in scene.crafts for ranked in _lagging(scene, craft))


def _lagging(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    law, fixes, speed = craft.law("position").law.name, craft.fixes, float(craft.path_speed().max())
    key = scene.key(craft, "position.law")
    cure = setting_word(key, "reset_compensated")
    if law == "reset" and speed * fixes.age >= BIAS_SHOWN:
        message = (
            f"{craft.name} believes fixes from {fixes.source} that are {show(fixes.age, 's')} old to be of now: a bias"
            f" of up to {show(speed * fixes.age, 'm')} astern at {show(speed, 'm/s')}, and across the path in turns"
        )
        yield Ranked(speed * fixes.age, Finding("note", key, message, cure))
    if law == "direct" and math.isfinite(fixes.period) and fixes.source is not None:
        held = max(fixes.expected_gap - scene.mission.tick, 0.0)
        lag = speed * (fixes.age + held)
        if lag >= BIAS_SHOWN:
            message = (
                f"{craft.name} holds each fix from {fixes.source} until the next, {show(fixes.expected_gap, 's')} on,"
                f" and takes it for new at an age of {show(fixes.age, 's')}: it believes itself up to"
                f" {show(lag, 'm')} astern at {show(speed, 'm/s')}"
            )
            yield Ranked(lag, Finding("note", key, message, cure))


def check_memory(scene: Scene) -> list[Finding]:
    """Fixes older than what a position law that looks back remembers of its own way."""
    return worst(ranked for craft in scene.crafts for ranked in _forgotten(scene, craft))


def _forgotten(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    law = craft.law("position").law.name
    if law not in LOOKING_BACK:
        return
    ticks, consequence = LOOKING_BACK[law]
    remembered, age = ticks * scene.mission.tick, craft.fixes.age
    if age > remembered:
        message = (
            f"{craft.name}: fixes are {show(age, 's')} old, and {law} remembers {ticks} ticks,"
            f" {show(remembered, 's')}: what is older is {consequence}"
        )
        yield Ranked(age, Finding("warning", "tick", message, _longer_tick(scene.mission, age / ticks)))


def _longer_tick(mission: Mission, needed: float) -> str:
    """The next tick of which all that recurs in the mission stays a whole multiple."""
    first = math.ceil(needed / mission.tick)
    for count in range(first, first + MOST_TRIED):
        try:
            check_rules(replace(mission, tick=mission.tick * count))
        except MissionError:
            continue
        return setting("tick", round(mission.tick * count, 9), "s")
    return ""
