"""Whether heading and speed can beat the current, worst along the path."""

import math
from collections.abc import Iterator

import numpy as np

from cardume.missions.checks.finding import (
    Finding,
    Ranked,
    at_least,
    at_most,
    both,
    largest,
    setting_word,
    show,
    smallest,
    worst,
)
from cardume.missions.checks.scene import Craft, Scene
from cardume.missions.checks.stations import fastest_after, spread_of

# Of a right angle's sine: where these laws saturate.
STEEPEST = {"crab": 0.98, "arcsine": 0.99, "arcsine_integral": 0.99, "arcsine_with_current": 0.99}
OFFSET_SHOWN = 0.05  # [m]
FASTEST = 100.0  # [m/s] for a vehicle without limits


def check_beaten(scene: Scene) -> list[Finding]:
    """A current across that heading cannot cancel, |Vperp| > u, or against, that leaves no headway.

    Source: closed form H (docs/theory/closed-forms.md) and the domain of eq. (36).
    """
    return worst(ranked for craft in scene.crafts if knows(craft) for ranked in _beaten(scene, craft))


def knows(craft: Craft) -> bool:
    """Whether the current, its compensation and the vehicle's speeds are all ours to judge."""
    return craft.knows_current and craft.meeting is not None and craft.limits is not None


def available_speed(craft: Craft, path_speed: np.ndarray) -> np.ndarray:
    """The speed through the water with which a vehicle can meet the current.

    Args:
        craft: holds its speed over ground by its actuators, or has the speed it was told.
        path_speed: (n,) [m/s] that it was told.
    """
    most = FASTEST if craft.limits is None else min(craft.limits.most, FASTEST)
    if craft.meeting == "course and speed":
        return np.full_like(path_speed, most)
    limited: np.ndarray = np.minimum(path_speed, most)
    return limited


def steepest(craft: Craft) -> float:
    """Largest Vperp / u that the laws aboard still cancel."""
    if craft.meeting != "nothing":
        return STEEPEST["crab"]
    return STEEPEST.get(craft.law("guidance").law.name, 1.0)


def surplus(craft: Craft, path_speed: np.ndarray, current: float = 1.0, doubt: float = 0.0) -> float:
    """How much speed is left, worst along the path: of what across needs, and over ground; < 0 is not enough.

    min(u - |Vperp|, sqrt(u^2 - Vperp^2) + Vpar)

    Args:
        craft: the vehicle.
        path_speed: (n,) [m/s] that it is told at each station.
        current: [-] factor on the mean current.
        doubt: [m/s] added to it, from the worst side.
    """
    speed = available_speed(craft, path_speed) * steepest(craft)
    across = np.abs(current * craft.stations.across) + doubt
    ahead = np.sqrt(np.maximum(speed**2 - across**2, 0.0)) + current * craft.stations.along - doubt
    return float(np.minimum(speed - across, ahead).min())


def _beaten(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    nominal = surplus(craft, craft.path_speed())
    if nominal <= 0.0:
        yield Ranked(-nominal, _defeat(scene, craft))
        return
    slowed = craft.path_speed(-craft.correction)
    doubt = craft.stations.doubt
    left = surplus(craft, slowed if craft.meeting != "course and speed" else craft.path_speed(), doubt=doubt)
    if left <= 0.0 and np.any(slowed > 0.0) and (doubt > 0.0 or craft.stations.current_speed.max() > 0.0):
        yield Ranked(-left, _doubt(scene, craft))


def _defeat(scene: Scene, craft: Craft) -> Finding:
    stations, speed = craft.stations, available_speed(craft, craft.path_speed())
    across, along = np.abs(stations.across), stations.along
    place = int(np.argmin(speed * steepest(craft) - across))
    headway = np.sqrt(np.maximum(speed**2 - across**2, 0.0)) + along
    if across[place] < speed[place] * steepest(craft):
        place = int(np.argmin(headway))
        what = f"the current against the path, {show(-along[place], 'm/s')}, leaves no way ahead"
    else:
        what = f"the current across the path, {show(across[place], 'm/s')}, cannot be cancelled by heading"
    reason = "at most" if craft.meeting == "course and speed" else "only"
    message = (
        f"{craft.name}: {what}: through the water it makes {reason} {show(speed[place], 'm/s')}"
        f" (on course {math.degrees(stations.course[place]) % 360.0:.0f} deg, after {show(stations.time[place], 's')})"
    )
    key, suggestion = _remedy(scene, craft)
    return Finding("error", key, message, suggestion)


def _remedy(scene: Scene, craft: Craft) -> tuple[str, str]:
    """A faster formation where that helps, else a weaker current where it is a number, else nothing."""
    if scene.sets_speed and craft.meeting != "course and speed":
        most = available_speed(craft, craft.path_speed(profile=FASTEST)).min() / craft.stations.stretch.max()
        speed = smallest(lambda v: surplus(craft, 0.99 * craft.path_speed(profile=v)) > 0.0, 0.0, float(most))
        if math.isfinite(speed):
            return "formation.speed", at_least("formation.speed", speed, "m/s")
    if scene.current_factor:
        return weaker(scene, largest(lambda s: surplus(craft, 0.95 * craft.path_speed(), s) > 0.0, 0.0, 1.0))
    return ("current.file" if scene.mission.current.name == "gridded" else "current"), ""


def weaker(scene: Scene, share: float) -> tuple[str, str]:
    """The key that sets how fast the current is, and the setting that makes it weaker.

    Args:
        scene: whose current has a factor.
        share: [-] of its speed that would pass.
    """
    key, unit = f"current.{scene.current_factor}", "m/s" if scene.current_factor == "speed" else ""
    return key, at_most(key, share * scene.mission.current.parameters[scene.current_factor], unit)


def _doubt(scene: Scene, craft: Craft) -> Finding:
    slow = craft.correction if craft.meeting != "course and speed" else 0.0
    u = float(available_speed(craft, craft.path_speed(-slow)).min())
    causes = [f"coordination slows it by {show(slow, 'm/s')}"] if slow else []
    causes += [f"the current varies by {show(craft.stations.doubt, 'm/s')} (2 sigma)"] if craft.stations.doubt else []
    message = (
        f"{craft.name}: the mean current, up to {show(craft.stations.current_speed.max(), 'm/s')}, can be met, but not"
        f" while {' and '.join(causes)}: then {show(u, 'm/s')} through the water is not enough"
    )
    key = scene.key(craft, "coordination.gain")
    still = largest(lambda k: surplus(craft, craft.path_speed(-k), doubt=craft.stations.doubt) > 0.0, 0.0, slow)
    if slow and math.isfinite(still):
        return Finding("warning", key, message, at_most(key, 0.99 * still, "m/s"))
    if craft.stations.doubt:
        name, sigma = spread_of(craft.law("current"))
        share = largest(
            lambda s: surplus(craft, craft.path_speed(-slow), doubt=s * craft.stations.doubt) > 0.0, 0.0, 1.0
        )
        key = f"current.{name}"
        return Finding("warning", key, message, at_most(key, 0.99 * share * sigma, "m/s"))
    return Finding("warning", key, message)


def check_drift(scene: Scene) -> list[Finding]:
    """A current that nothing cancels leaves a steady cross-track error.

    line of sight: d V / sqrt(u^2 - V^2);   arcsine: V / k1;   vector field: w tan(pi asin(V / u) / (2 chi_inf))

    Laws with an integral leave none, and one with the current inside none where the current is observed.

    Source: closed form D (docs/theory/closed-forms.md); the vector field's derived from u sin(chi_d - chi_p) = -V.
    """
    return worst(ranked for craft in scene.crafts if knows(craft) for ranked in _drift(scene, craft))


def _drift(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    speed = craft.path_speed()
    if craft.meeting != "nothing" or surplus(craft, speed) <= 0.0:
        return
    offset = steady_offset(craft, speed)
    if offset < OFFSET_SHOWN:
        return
    threshold = scene.mission.transient.threshold
    endless = offset >= threshold
    if craft.tracks_bottom:
        yield Ranked(offset, _unused_track(scene, craft, offset))
        return
    crab, observer = scene.key(craft, "compensation.law"), scene.key(craft, "current_observer.law")
    is_blind = craft.law("compensation").law.name != "none"
    message = (
        f"{craft.name} steers as if the water stood still: a current of up to"
        f" {show(np.abs(craft.stations.across).max(), 'm/s')} across holds it up to {show(offset, 'm')} off its path"
    )
    message += f" (beyond transient.threshold, {show(threshold, 'm')}: it never counts as settled)" if endless else ""
    message += "; crab without a current_observer cancels nothing" if is_blind else ""
    blind = craft.law("current_observer").law.name == "none"
    words = [setting_word(observer, "complementary")] if blind else []
    words += [] if is_blind else [setting_word(crab, "crab")]
    key = observer if is_blind else crab
    yield Ranked(offset, Finding("warning" if endless else "note", key, message, both(*words)))


def _unused_track(scene: Scene, craft: Craft, offset: float) -> Finding:
    key = scene.key(craft, "compensation.law")
    message = (
        f"{craft.name} measures over ground how it drifts, and does not steer by it: a current of up to"
        f" {show(np.abs(craft.stations.across).max(), 'm/s')} across holds it up to {show(offset, 'm')} off its path;"
        " crab with use_sway: 1 turns the heading by the drift angle"
    )
    sway = scene.key(craft, "compensation.use_sway")
    return Finding("warning", key, message, both(setting_word(key, "crab"), setting_word(sway, "1")))


def steady_offset(craft: Craft, speed: np.ndarray) -> float:
    """Steady cross-track error [m] on a long line of the worst course.

    Args:
        craft: without compensation.
        speed: (n,) [m/s] through the water, at each station.
    """
    law, across = craft.law("guidance"), np.abs(craft.stations.across)
    if law.law.name == "arcsine":
        return float(across.max()) / law.value("gain")
    if law.law.name == "arcsine_with_current":
        observed = craft.law("current_observer").law.name != "none"
        return 0.0 if observed else float((law.value("decay_length") * across / speed).max())
    if law.law.name == "vector_field":
        share = np.arcsin(across / speed) / law.value("approach")
        return float((law.value("width") * np.tan(0.5 * np.pi * share)).max()) if share.max() < 1.0 else math.inf
    if law.law.name not in ("line_of_sight", "along_path"):
        return 0.0
    return float((law.value("lookahead") * across / np.sqrt(speed**2 - across**2)).max())


def check_end(scene: Scene) -> Iterator[Finding]:
    """A vehicle that is to hold the end point in a current faster than it can go against it."""
    for craft in scene.crafts:
        stations = craft.stations
        arrives = stations.time[-1] < scene.mission.duration and craft.plan.setup.stays > 0.5
        if not (knows(craft) and arrives):
            continue
        speed = float(available_speed(craft, craft.path_speed())[-1])
        current = fastest_after(stations, scene.plan, craft.law("current"), craft.plan.setup.depth)
        if current + stations.doubt >= speed > 0.0:
            key = scene.key(craft, "end")
            message = (
                f"{craft.name} is to hold the end of its path in a current of {show(current, 'm/s')}, against which it"
                f" makes {show(speed, 'm/s')} through the water: it is carried off"
            )
            yield Finding("warning", key, message, setting_word(key, "continue"))
