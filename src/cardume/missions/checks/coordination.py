"""Whether a fleet can come to agree, and whether predictions of the others stay calm."""

from collections.abc import Iterator, Sequence

import numpy as np

from cardume.maths.graphs import adjacency_of, can_agree, spectrum
from cardume.missions.checks.finding import Finding, Ranked, at_least, at_most, setting_word, show, worst
from cardume.missions.checks.fixes import can_hear, has_parameter, speaking, travel_time
from cardume.missions.checks.scene import Craft, Scene


def check_agreement(scene: Scene) -> Iterator[Finding]:
    """A graph, silence, a deaf channel or laws that let no news from one vehicle reach all others."""
    if all(_corrects_nothing(craft) for craft in scene.crafts) or len(scene.crafts) < 2:
        return
    names = [craft.name for craft in scene.crafts]
    graph = np.array(scene.mission.adjacency)
    told = can_agree(graph, names)
    if not told.possible:
        key = "coordination.topology"
        yield Finding(
            "error",
            key,
            f"the fleet cannot agree: {told.reason}",
            setting_word(key, "complete"),
        )
        return
    informed = graph * _news(scene)
    told = can_agree(informed, names)
    if not told.possible:
        key, suggestion = _what_is_missing(scene, graph, names)
        yield Finding(
            "error", key, f"the fleet cannot agree, for too few hear of one another: {told.reason}", suggestion
        )
        return
    following = informed * np.array([[0.0 if _corrects_nothing(craft) else 1.0] for craft in scene.crafts])
    told = can_agree(following, names)
    if not told.possible:
        idle = [craft for craft in scene.crafts if _corrects_nothing(craft)]
        yield Finding(
            "warning",
            scene.key(idle[-1], "coordination.law"),
            f"{', '.join(craft.name for craft in idle)} correct nothing, and a fleet can follow one such vehicle only:"
            f" {told.reason}",
            setting_word(f"vehicles.{idle[-1].name}.coordination.law", "laplacian_tanh"),
        )


def _corrects_nothing(craft: Craft) -> bool:
    law = craft.law("coordination")
    return law.law.is_builtin and (law.law.name == "none" or (has_parameter(law, "gain") and law.value("gain") == 0.0))


def _news(scene: Scene) -> np.ndarray:
    """(listener, of whom) 1 where a vehicle ever learns how far another is: from it, or by somebody's USBL."""
    count, distances = len(scene.crafts), scene.distances
    hears, sees = np.zeros((count, count)), np.zeros((count, count))
    for i, listener in enumerate(scene.crafts):
        for j, speaker in enumerate(scene.crafts):
            if i != j:
                hears[i, j] = can_hear(speaker.plan, listener.plan, distances[i, j])
                sees[i, j] = _sees(listener, distances[i, j])
    told = np.array([[hears[i] @ sees[:, j] for j in range(count)] for i in range(count)])
    return np.asarray(hears + sees + told > 0.0, float)


def _sees(craft: Craft, distance: float) -> bool:
    usbl = craft.plan.laws.get("usbl")
    return usbl is not None and (not has_parameter(usbl, "max_range") or distance <= usbl.value("max_range"))


def _what_is_missing(scene: Scene, graph: np.ndarray, names: Sequence[str]) -> tuple[str, str]:
    """The key that keeps news away: of a vehicle that is silent, or else of the channel."""
    silent = [craft for craft in scene.crafts if craft.law("messaging").law.name == "silent"]
    speaking = np.array([[0.0 if craft in silent else 1.0 for craft in scene.crafts]])
    if silent and not can_agree(graph * speaking, names).possible:
        key = scene.key(silent[-1], "messaging")
        return key, setting_word(key, "{schedule: periodic}")
    channel = scene.crafts[0].law("acoustics")
    if has_parameter(channel, "loss") and channel.value("loss") >= 1.0:
        return "acoustics.loss", setting_word("acoustics.loss", "0.2")
    return "acoustics.max_range", at_least("acoustics.max_range", 1.05 * float(scene.distances.max()), "m")


def check_prediction(scene: Scene) -> list[Finding]:
    """Prediction (55) in steps of dt: gamma+ = gamma + dt (v_L - k tanh(L_D gamma / gamma_0)).

    stable while |1 - (k dt / gamma_0) lambda| < 1 for every eigenvalue of L_D; k dt / gamma_0 < 1 on any graph

    Source: theory, verdict on eq. (55).
    """
    return worst(ranked for craft in scene.crafts for ranked in _restless(scene, craft))


def _restless(scene: Scene, craft: Craft) -> Iterator[Ranked]:
    if not craft.correction:
        return
    tick, gain = scene.mission.tick, craft.correction
    step = gain * tick / craft.reach
    adjacency = adjacency_of(scene.mission.adjacency, len(scene.crafts))
    shrinks = np.abs(1.0 - step * spectrum(adjacency))
    if step < 1.0 and np.all(shrinks < 1.0 + 1e-9):
        return
    key = scene.key(craft, "coordination.length_scale")
    message = (
        f"k dt / gamma_0 = {step:.3g} with gain {show(gain, 'm/s')}, tick {show(tick, 's')} and length_scale"
        f" {show(craft.reach, 'm')}; from 1 on, states that are predicted or corrected in such steps overshoot and"
        f" chatter by up to {show(gain * tick, 'm')}"
    )
    yield Ranked(step, Finding("warning", key, message, at_least(key, 2.0 * gain * tick, "m")))


def check_late_rates(scene: Scene) -> list[Finding]:
    """Late reports that are carried on by the path speed in them, gamma_j + gamma_j' age, in a fast coordination.

    x' = -(k / gamma_0) (x - mu (x(t - age) + age x'(t - age))), mu an eigenvalue of D^-1 A, 1 among them

    The rate comes back through the others: of neutral type, stable iff k age / gamma_0 < 1.
    `coordinated` does so at each report, and then goes on by the others' own law: it matters where the next
    report is on its way before the last has come. `reported_speed` does so until the next report.

    Source: tests/oracles/test_stale_neighbors.py, which flies it to both sides of the limit.
    """
    return worst(ranked for place in range(len(scene.crafts)) for ranked in _hurried(scene, place))


def _hurried(scene: Scene, place: int) -> Iterator[Ranked]:
    craft = scene.crafts[place]
    if not craft.correction:
        return
    for k, speaker in enumerate(scene.crafts):
        if k == place or not scene.mission.adjacency[place][k]:
            continue
        age = _age_carried_on(scene, craft, speaker, scene.distances[place, k])
        if craft.correction * age < craft.reach:
            continue
        key = scene.key(craft, "coordination.gain")
        message = (
            f"{craft.name} hears {speaker.name} {show(age, 's')} late and carries that on by the speed it was told:"
            f" k age / gamma_0 = {craft.correction * age / craft.reach:.3g} at gain {show(craft.correction, 'm/s')},"
            f" length_scale {show(craft.reach, 'm')}; from 1 on the fleet swings and never settles"
        )
        yield Ranked(age, Finding("warning", key, message, at_most(key, 0.8 * craft.reach / age, "m/s")))


def _age_carried_on(scene: Scene, listener: Craft, speaker: Craft, distance: float) -> float:
    """[s] for which a report is carried on by its own path speed; 0 where that does no harm."""
    law, tick = listener.law("neighbors").law.name, scene.mission.tick
    spoken = speaking(speaker.plan, scene.plan.vehicles, tick)
    if spoken is None or not can_hear(speaker.plan, listener.plan, distance):
        return 0.0
    way, period = travel_time(listener.plan, distance, tick), spoken[0]
    if law == "reported_speed":
        return way + period
    return way if law == "coordinated" and period < way else 0.0
