"""The current observer: Euler steps, gaps between fixes, and a wrong scale of speed."""

import math
from collections.abc import Iterator

import numpy as np

from cardume.missions.checks.finding import Finding, Ranked, at_least, at_most, both, setting_word, show, worst
from cardume.missions.checks.fixes import has_parameter
from cardume.missions.checks.scene import Craft, Scene
from cardume.missions.checks.steering import guidance_rate

NEAR = 0.6  # of the gap at which it turns unstable
SAFE = 0.3
CONTINUOUS = 0.1  # of the fastest time constant: fixes this frequent are as good as continuous
MOST_LOST = 400  # fixes in a row that may be lost
LONGEST_GAP = 1e6  # [s]
CURRENTLESS = ("direct", "reset", "reset_compensated")  # position laws that give no current


def gains(craft: Craft) -> tuple[float, float] | None:
    """k1 [1/s] and k2 [1/s^2] of our observer; None for another or none."""
    law = craft.law("current_observer")
    return (law.value("k1"), law.value("k2")) if law.law.name == "complementary" else None


def spectral_radius(matrix: np.ndarray) -> float:
    """Largest absolute eigenvalue.

    Args:
        matrix: (n, n) [any]
    """
    return float(np.abs(np.linalg.eigvals(matrix)).max())


def euler_step(k1: float, k2: float, dt: float) -> np.ndarray:
    """One tick of (33) by itself, on its errors: e = p_m - p_hat and w = Vc_hat - Vc.

    e' = -k1 e - w,   w' = k2 e

    Args:
        k1: [1/s]
        k2: [1/s^2]
        dt: [s] tick.
    """
    return np.array([[1.0 - k1 * dt, -dt], [k2 * dt, 1.0]])


def obeyed_step(k1: float, k2: float, dt: float) -> np.ndarray:
    """The same where a vehicle without inertia obeys what w makes of its reference, and measures what it did.

    Heading and speed of a tick follow the estimate of the tick before, and are measured one tick later:
    e+ = e + dt (-k1 e - w - w_1 + w_2), w_1 and w_2 the errors of one and two ticks before.

    Args:
        k1: [1/s]
        k2: [1/s^2]
        dt: [s] tick.
    """
    return np.array(
        [[1.0 - k1 * dt, -dt, -dt, dt], [k2 * dt, 1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]
    )


def check_euler(scene: Scene) -> list[Finding]:
    """Ticks too long for the gains.

    Source: closed form J4 (docs/theory/closed-forms.md): Ts < k1 / k2 with complex poles, 2 / |s_max| with real ones;
    with the loop closed, derived.
    """
    return worst(ranked for craft in scene.crafts for ranked in _too_coarse(scene, craft))


def _too_coarse(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    found, tick = gains(craft), scene.mission.tick
    if found is None:
        return
    k1, k2 = found
    alone = spectral_radius(euler_step(k1, k2, tick))
    is_obeyed = craft.meeting in ("course", "course and speed")
    obeyed = spectral_radius(obeyed_step(k1, k2, tick)) if is_obeyed else 0.0
    if max(alone, obeyed) < 1.0:
        return
    # thrusters and a hull soften what comes of the second condition, not of the first
    is_sure = alone >= 1.0 or craft.law("model").law.name == "kinematic"
    key = scene.key(craft, "current_observer.k1")
    limit = k1 / k2 if k1 * k1 < 4.0 * k2 else 4.0 / (k1 + math.sqrt(k1 * k1 - 4.0 * k2))
    message = (
        f"{craft.name}: with k1 = {show(k1, '1/s')} and k2 = {show(k2, '1/s^2')} the observer is unstable in ticks of"
        f" {show(tick, 's')}: alone it needs less than {show(limit, 's')}"
        f"{', and less again where the vehicle obeys what it says' if is_obeyed else ''}"
    )
    suggestion = critically_damped(scene, craft, min(k1, 0.4 / tick))
    yield Ranked(max(alone, obeyed), Finding("error" if is_sure else "warning", key, message, suggestion))


def critically_damped(scene: Scene, craft: Craft, k1: float) -> str:
    """A setting of both gains: this k1, and k2 = k1^2 / 4 or less.

    Args:
        scene: of the vehicle.
        craft: the vehicle.
        k1: [1/s]
    """
    found = gains(craft)
    k2 = min(0.25 * k1 * k1, found[1] if found else math.inf)
    one, two = scene.key(craft, "current_observer.k1"), scene.key(craft, "current_observer.k2")
    return both(at_most(one, k1, "1/s"), at_most(two, 0.9 * k2, "1/s^2"))


def gap_map(k1: float, k2: float, gap: float) -> np.ndarray:
    """From fix to fix: what a gap makes of the observer's errors when dead reckoning drives it.

    Between fixes e = p_dr - p_hat decays as exp(-k1 t) and w = Vc_hat - Vc changes by k2 e; meanwhile dead reckoning,
    which uses Vc_hat, goes wrong by the integral of w, and the fix puts all of that into e.

    Args:
        k1: [1/s]
        k2: [1/s^2]
        gap: [s] T.

    Returns:
        (2, 2) map of (e, w); at the gap where its radius is 1 the observer turns unstable, 2.5 k1 / k2 for k1 T >> 1.

    Source: derived; gives the simulated limits of closed form J5 (docs/theory/closed-forms.md), 10.0, 2.5, 2.2 and
    50 s, to their digits.
    """
    decay = math.exp(-k1 * gap)
    filled = (1.0 - decay) / k1
    return np.array([[decay - k2 / k1 * (gap - filled), -gap], [k2 * filled, 1.0]])


def mean_square_radius(k1: float, k2: float, period: float, loss: float) -> float:
    """By how much the mean square of the errors grows from one fix that arrives to the next.

    rho(sum of (1 - p) p^(n-1) M(n T) x M(n T)), n T the gap when n - 1 fixes in a row are lost

    Args:
        k1: [1/s]
        k2: [1/s^2]
        period: [s] T.
        loss: [-] p < 1.
    """
    total = np.zeros((4, 4))
    for n in range(1, MOST_LOST + 1):
        weight = (1.0 - loss) * loss ** (n - 1)
        if n > 1 and weight * (n * period) ** 4 < 1e-9:
            break
        once = gap_map(k1, k2, n * period)
        total += weight * np.kron(once, once)
    return spectral_radius(total)


def longest_gap(k1: float, k2: float) -> float:
    """The gap between fixes [s] at which an observer driven by dead reckoning turns unstable."""
    low = high = 1.0 / k1
    while spectral_radius(gap_map(k1, k2, high)) < 1.0 and high < LONGEST_GAP:
        low, high = high, 1.1 * high
    while spectral_radius(gap_map(k1, k2, low)) >= 1.0 and low > 1e-6:
        low, high = 0.9 * low, low
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if spectral_radius(gap_map(k1, k2, middle)) < 1.0 else (low, middle)
    return low


def check_gaps(scene: Scene) -> list[Finding]:
    """An observer driven by dead reckoning, with gaps between fixes near its limit.

    Source: closed form J5 (docs/theory/closed-forms.md).
    """
    return worst(ranked for craft in scene.crafts for ranked in _too_rare(scene, craft))


def _too_rare(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    found, fixes = gains(craft), craft.fixes
    reckons = craft.law("position").law.name in ("reset", "reset_compensated")
    if found is None or not reckons or fixes.source is None or not math.isfinite(fixes.period):
        return
    k1, k2 = found
    limit, gap = longest_gap(k1, k2), fixes.expected_gap
    is_sure = fixes.period >= limit
    spreads = mean_square_radius(k1, k2, fixes.period, fixes.loss) >= 1.0
    if not (is_sure or spreads or gap >= NEAR * limit):
        return
    lost = f" and {100.0 * fixes.loss:.3g} % of them lost" if fixes.loss else ""
    what = "it diverges" if is_sure else "the gaps that losses leave make it diverge" if spreads else "that is near"
    key = scene.key(craft, "current_observer.k2")
    message = (
        f"{craft.name}: dead reckoning drives its observer, with a fix every {show(fixes.period, 's')}{lost};"
        f" with k1 = {show(k1, '1/s')} and k2 = {show(k2, '1/s^2')} it is unstable from gaps of {show(limit, 's')} on"
        f" (about 2 k1 / k2): {what}"
    )
    suggestion = _calmer(scene, craft, k1, limit)
    yield Ranked(gap / limit, Finding("error" if is_sure else "warning", key, message, suggestion))


def _calmer(scene: Scene, craft: Craft, k1: float, limit: float) -> str:
    """Critically damped gains whose limit is well above the gaps: 10 / k1."""
    fixes = craft.fixes
    calm = min(k1, SAFE * 10.0 / fixes.expected_gap)
    while mean_square_radius(calm, 0.225 * calm * calm, fixes.period, fixes.loss) >= 1.0 and calm > 1e-6:
        calm *= 0.8
    return critically_damped(scene, craft, calm)


def check_source(scene: Scene) -> list[Finding]:
    """A current taken from a position law that estimates none."""
    return worst(ranked for craft in scene.crafts for ranked in _from_nothing(scene, craft))


def _from_nothing(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    position = craft.law("position").law
    if craft.law("current_observer").law.name == "from_position" and position.name in CURRENTLESS:
        key = scene.key(craft, "current_observer.law")
        message = (
            f"{craft.name} takes the current from its position law, and {position.name} estimates none:"
            " it steers as if the water stood still"
        )
        cure = setting_word(scene.key(craft, "position.law"), "kalman_replay")
        yield Ranked(1.0, Finding("warning", key, message, cure))


def check_scale(scene: Scene) -> list[Finding]:
    """A wrong scale of speed that guidance and observer together do not stand.

    s^3 + (k1 + L / a) s^2 + (k2 + k1 L) / a s + L k2 / a,  L = V / d

    Source: closed form K2 (docs/theory/closed-forms.md).
    """
    return worst(ranked for craft in scene.crafts for ranked in _mistaken(scene, craft))


def _mistaken(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    found, scale = gains(craft), believed_scale(craft)
    if found is None or scale == 1.0 or craft.meeting not in ("course", "course and speed"):
        return
    k1, k2 = found
    pull = guidance_rate(craft)
    quickest = max(k1, math.sqrt(k2), pull)
    if not craft.fixes.period * quickest <= CONTINUOUS or pull <= 0.0:
        return  # the loop was analyzed with position known all the time
    poles = np.roots([1.0, k1 + pull / scale, (k2 + k1 * pull) / scale, pull * k2 / scale])
    growth = float(poles.real.max())
    if growth < 0.0:
        return
    key = scene.key(craft, "current_observer.k1")
    edge = pull * (k2 + k1 * pull) / (pull * k2 - k1 * (k2 + k1 * pull))
    message = (
        f"{craft.name} believes its speed to be {scale:.3g} times what it is; guidance (L = {show(pull, '1/s')}) and"
        f" observer together turn unstable from {edge:.4g} on: k1 of at least L or sqrt(k2) stands any scale"
    )
    yield Ranked(growth, Finding("error", key, message, at_least(key, 1.01 * min(pull, math.sqrt(k2)), "1/s")))


def believed_scale(craft: Craft) -> float:
    """a of eq. (38): believed over true speed."""
    source = craft.plan.laws.get("dvl") or craft.plan.laws.get("speed")
    return source.value("scale") if source is not None and has_parameter(source, "scale") else 1.0
