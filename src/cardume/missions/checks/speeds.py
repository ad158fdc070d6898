"""The slowest and the fastest vehicle against what their thrusters can do, with and against the current."""

import math
from collections.abc import Iterator

import numpy as np

from cardume.missions.checks.current import FASTEST, knows, surplus, weaker
from cardume.missions.checks.finding import Finding, Ranked, at_least, at_most, largest, show, smallest, worst
from cardume.missions.checks.scene import Craft, Scene

MARGIN = 0.99
SPEED = "formation.speed"


def check_fastest(scene: Scene) -> list[Finding]:
    """Speeds through the water above what the thrusters give.

    u = hypot(h (v_L + k) - Vpar, Vperp) over ground, h (v_L + k) through the water; h is the local stretch.

    Source: closed forms H and Q (docs/theory/closed-forms.md).
    """
    return worst(ranked for craft in scene.crafts if knows(craft) for ranked in _too_fast(scene, craft))


def _too_fast(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    assert craft.limits is not None
    most = craft.limits.most
    wanted = fastest(craft)
    if surplus(craft, craft.path_speed()) <= 0.0:
        return  # the current beats it altogether, which is told already
    if wanted > most:
        message = (
            f"{craft.name} is to go {show(wanted, 'm/s')} through the water ({_why(craft)}); its thrusters give at most"
            f" {show(most, 'm/s')}, {show(wanted - most, 'm/s')} too little: it falls behind"
        )
        v = largest(lambda v: fastest(craft, profile=v) <= MARGIN * most, 0.0, FASTEST)
        yield Ranked(wanted - most, _about_speed(scene, message, at_most(SPEED, v, "m/s")))
    elif (hurried := fastest(craft, craft.correction)) > most:
        key = scene.key(craft, "coordination.gain")
        message = (
            f"{craft.name}, far behind the others, is to go {show(hurried, 'm/s')} through the water ({_why(craft)},"
            f" and {show(craft.correction, 'm/s')} to catch up); its thrusters give at most {show(most, 'm/s')},"
            f" {show(hurried - most, 'm/s')} too little"
        )
        k = largest(lambda k: fastest(craft, k) <= MARGIN * most, 0.0, craft.correction)
        yield Ranked(hurried - most, Finding("warning", key, message, at_most(key, k, "m/s")))


def _about_speed(scene: Scene, message: str, suggestion: str) -> Finding:
    """A warning about the formation's speed; where the path has speeds of its own there is not one that helps."""
    return Finding("warning", SPEED, message, suggestion) if scene.sets_speed else Finding("warning", "path", message)


def fastest(craft: Craft, correction: float = 0.0, profile: float | None = None) -> float:
    """Largest speed through the water [m/s] that a vehicle is asked for along its path.

    Args:
        craft: the vehicle.
        correction: [m/s] of the formation's speed.
        profile: [m/s] instead of v_L.
    """
    return float(craft.through_water(craft.path_speed(correction, profile)).max())


def slowest(craft: Craft, slowed: float = 0.0, profile: float | None = None) -> float:
    """Least speed through the water [m/s] that a vehicle is asked for along its path.

    Args:
        craft: the vehicle.
        slowed: [m/s] by how much at most coordination slows it: in between the speed may be less than at the ends.
        profile: [m/s] instead of v_L.
    """
    low, high = craft.path_speed(-slowed, profile), craft.path_speed(0.0, profile)
    worst_of_all = np.clip(craft.stations.along, low, high) if craft.meeting == "course and speed" else low
    return float(craft.through_water(worst_of_all).min())


def _why(craft: Craft) -> str:
    speed, stretch = craft.path_speed(), craft.stations.stretch
    parts = [f"{show(speed.max(), 'm/s')} along its path"]
    if stretch.max() > stretch.min():
        parts = [
            f"{show(speed.min(), 'm/s')} to {show(speed.max(), 'm/s')} along its path, which is {stretch.min():.3g} to"
            f" {stretch.max():.3g} times the formation's speed"
        ]
    if craft.meeting == "course and speed" and craft.stations.current_speed.max() > 0.0:
        parts.append(f"a current of up to {show(craft.stations.current_speed.max(), 'm/s')}")
    return ", ".join(parts)


def check_slowest(scene: Scene) -> list[Finding]:
    """Speeds through the water inside the dead zone of the thrusters, or of a vehicle that is to stop.

    u = hypot(h (v_L - k) - Vpar, Vperp) over ground, h (v_L - k) through the water

    Source: closed form H (docs/theory/closed-forms.md).
    """
    return worst(ranked for craft in scene.crafts if knows(craft) for ranked in _too_slow(scene, craft))


def _too_slow(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    assert craft.limits is not None
    least, most = craft.limits.least, min(craft.limits.most, FASTEST)
    wanted = slowest(craft)
    if wanted < least:
        message = (
            f"{craft.name} is to go {show(wanted, 'm/s')} through the water ({_why(craft)}); below"
            f" {show(least, 'm/s')} its thrusters are in their dead zone, {show(least - wanted, 'm/s')} away: they turn"
            " on and off, and its speed swings"
        )
        now, top = float(craft.stations.speed.min()), most / float(craft.stations.stretch.max())
        v = smallest(lambda v: slowest(craft, profile=v) >= least / MARGIN, now, top)
        yield Ranked(least - wanted, _about_speed(scene, message, at_least(SPEED, v, "m/s")))
    elif craft.correction and _halts(craft, craft.correction):
        yield Ranked(least - slowest(craft, craft.correction), _halt(scene, craft, least))


def _halts(craft: Craft, gain: float) -> bool:
    """Whether the correction, if it saturates, takes a vehicle into its dead zone or stops it."""
    assert craft.limits is not None
    stops = bool(np.any(craft.path_speed(-gain) <= 0.0))
    return stops or slowest(craft, gain) < craft.limits.least


def _halt(scene: Scene, craft: Craft, least: float) -> Finding:
    key, gain = scene.key(craft, "coordination.gain"), craft.correction
    harmless = largest(lambda k: not _halts(craft, k), 0.0, gain)
    ahead = craft.reach * math.atanh(min(harmless / gain, 1.0 - 1e-9)) if math.isfinite(harmless) else 0.0
    if np.any(craft.path_speed(-gain) <= 0.0):
        what = "it stops and cannot steer"
    else:
        what = (
            f"it is to go {show(slowest(craft, gain), 'm/s')} through the water, {show(least, 'm/s')} being where the"
            " dead zone of its thrusters ends"
        )
    message = (
        f"{craft.name}: coordination takes up to {show(gain, 'm/s')} from the formation's speed; more than"
        f" {show(ahead, 'm')} ahead of those it hears, {what}"
    )
    return Finding("warning", key, message, at_most(key, MARGIN * harmless, "m/s"))


def check_overtaken(scene: Scene) -> list[Finding]:
    """A current along the path that is faster than the vehicle is to go over ground.

    Heading along its path, it makes Vpar + |v - Vpar| = 2 Vpar - v, instead of v.
    """
    return worst(ranked for craft in scene.crafts if knows(craft) for ranked in _overtaken(scene, craft))


def _overtaken(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    along, speed = craft.stations.along, craft.path_speed()
    excess = along - speed
    place = int(np.argmax(excess))
    if craft.meeting != "course and speed" or excess[place] <= 0.0:
        return
    message = (
        f"{craft.name}: a current of {show(along[place], 'm/s')} along the path is faster than the"
        f" {show(speed[place], 'm/s')} over ground it is to make; heading along the path it makes"
        f" {show(2.0 * along[place] - speed[place], 'm/s')}"
    )
    yield Ranked(excess[place], _outrun(scene, craft, message))


def _outrun(scene: Scene, craft: Craft, message: str) -> Finding:
    """A faster formation, if the thrusters allow it, or a weaker current."""
    assert craft.limits is not None
    share = float((craft.path_speed() / np.maximum(craft.stations.along, 1e-9)).min()) * MARGIN
    needed = float(((craft.stations.along + craft.limits.least) / craft.stations.stretch).max()) / MARGIN
    if scene.current_factor and not (scene.sets_speed and fastest(craft, profile=needed) < craft.limits.most):
        key, suggestion = weaker(scene, share)
        return Finding("warning", key, message, suggestion)
    return _about_speed(scene, message, at_least(SPEED, needed, "m/s"))
