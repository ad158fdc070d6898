"""Guidance against what is late: the heading, the fixes, and the tick; and beside a compensation it does not use."""

import math
from collections.abc import Iterator

import numpy as np

from cardume.missions.checks.abilities import heading_lag
from cardume.missions.checks.finding import Finding, Ranked, largest, setting_word, show, worst
from cardume.missions.checks.observer import spectral_radius
from cardume.missions.checks.scene import Craft, Scene
from cardume.missions.checks.steering import Setting, demand_of, guidance_rate

SLACK = 1.02
MOST_GAPS = 50.0


def check_lag(scene: Scene) -> list[Finding]:
    """Steering too hard for a heading that follows late: T s^2 + s + u / d has complex poles.

    critical at d = 4 u T; of `arcsine` at k1 = 1 / (4 T)

    Source: closed form F2 (docs/theory/closed-forms.md).
    """
    return worst(ranked for craft in scene.crafts for ranked in _late_heading(scene, craft))


def _late_heading(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    rate, speed = guidance_rate(craft), float(craft.path_speed().max())
    lag = heading_lag(craft.plan, float(craft.through_water(craft.path_speed()).max()))
    if not lag or rate <= 0.0 or rate * lag <= 0.25:
        return
    given = Setting(scene, craft)
    damping = 0.5 / math.sqrt(rate * lag)
    message = (
        f"{craft.name}: its heading follows with a lag of about {show(lag, 's')} at {show(speed, 'm/s')}; with"
        f" {given} it overshoots (damping {damping:.2g} of the critical one)"
        f"{', and the delays beside that lag may keep it weaving' if damping < 0.6 else ''}"
    )
    yield Ranked(rate * lag, Finding("warning", given.key, message, given.gentler(0.25 / lag, speed, SLACK)))


def check_delay(scene: Scene) -> list[Finding]:
    """Fixes so late, or held so long, that following them weaves ever more.

    `reset` believes a fix to be of now: unstable from u tau / d = pi / 2 on. `direct` besides holds it for T:
    e_(k+1) = e_k - (u / d) ((T - tau) e_k + tau e_(k-1)), without tau unstable from u T / d = 2 on.

    Source: closed form F2 (docs/theory/closed-forms.md), a late position; the held one derived.
    """
    return worst(ranked for craft in scene.crafts for ranked in _late_fixes(scene, craft))


def _late_fixes(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    law, fixes, rate = craft.law("position").law.name, craft.fixes, guidance_rate(craft)
    if law not in ("reset", "direct") or fixes.source is None or not math.isfinite(fixes.period) or rate <= 0.0:
        return
    gap = fixes.expected_gap if law == "direct" else 0.0
    if _settles(rate, fixes.age, gap):
        return
    calm = largest(lambda r: _settles(r, fixes.age, gap), 1e-3 * rate, rate)
    given, speed = Setting(scene, craft), float(craft.path_speed().max())
    held = f" and held for {show(gap, 's')}" if gap else ""
    message = (
        f"{craft.name}: fixes are {show(fixes.age, 's')} old{held} when {law} takes them for where it is; with {given}"
        f" it weaves ever more about its path"
    )
    yield Ranked(rate / calm, Finding("error", given.key, message, given.gentler(0.3 * calm, speed, SLACK)))


def _settles(rate: float, age: float, gap: float) -> bool:
    """Whether an error is closed at a rate [1/s] by positions of an age [s] that are held for a gap [s]; 0 for none."""
    if gap <= 0.0 or age > MOST_GAPS * gap:  # held for so short that it is as good as not held
        return rate * (age + 0.5 * gap) < 0.5 * math.pi
    whole = math.floor(age / gap)
    late = age - whole * gap
    step = np.eye(whole + 2, k=-1)
    step[0, 0] = 1.0
    step[0, whole] -= rate * (gap - late)
    step[0, whole + 1] -= rate * late
    return spectral_radius(step) < 1.0


def check_tick(scene: Scene) -> list[Finding]:
    """Steering so hard that a heading held over a tick carries the vehicle across the path and as far beyond.

    unstable from u dt / d = 2 on
    """
    return worst(ranked for craft in scene.crafts for ranked in _long_tick(scene, craft))


def _long_tick(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    rate, tick = guidance_rate(craft), scene.mission.tick
    if rate * tick < 2.0:
        return
    given, speed = Setting(scene, craft), float(craft.path_speed().max())
    message = (
        f"{craft.name}: in one tick of {show(tick, 's')} it goes {show(speed * tick, 'm')}; with {given} it crosses its"
        " path at every tick and never settles"
    )
    yield Ranked(rate * tick, Finding("warning", given.key, message, given.gentler(0.5 / tick, speed, SLACK)))


def check_compensation(scene: Scene) -> list[Finding]:
    """A compensation beside a guidance law that asks for a heading, a yaw rate or a speed of its own: past it."""
    return worst(ranked for craft in scene.crafts for ranked in _idle_compensation(scene, craft))


def _idle_compensation(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    compensation, demand = craft.law("compensation").law.name, demand_of(craft)
    if compensation == "none" or demand is None:
        return
    turns, has_heading, has_speed = (math.isfinite(x) for x in (demand.yaw_rate, demand.heading, demand.speed))
    if not (turns or has_heading):
        return
    law, key = craft.law("guidance").law.name, scene.key(craft, "compensation.law")
    asked = "yaw rates" if turns else "headings"
    left = "nothing" if has_speed else "only the speed"
    message = (
        f"{craft.name}: {law} asks for {asked}{' and speeds' if has_speed else ''} itself, past compensation; of"
        f" {compensation} {left} is used"
    )
    yield Ranked(1.0, Finding("note", key, message, setting_word(key, "none") if has_speed else ""))
