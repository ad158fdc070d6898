"""Thrusters: from the wanted forces to shaft speeds, and from commanded to delivered shaft speeds."""

import math
from typing import Annotated, NamedTuple

import numpy as np

from cardume.compiler import Rows, at, compiled, gather, load, scatter, store, where
from cardume.laws import Length
from cardume.maths import clip, exp, floor, signed_root, signed_square
from cardume.signals import Command
from cardume.vehicles.medusa_data import NUM_VERTICAL_THRUSTERS

SLOTS = 64  # commands that can be on their way: the longest delay is SLOTS - 1 plant steps


class ShaftSpeeds(NamedTuple):
    """One number for each horizontal thruster, and one for each of the vertical ones alike."""

    port: float  # [rad/s] > 0 pushes ahead
    starboard: float  # [rad/s]
    vertical: float  # [rad/s] > 0 pushes down


class ThrusterPlant(NamedTuple):
    """What does not change about the thrusters during a mission."""

    coefficient: float  # [N s^2/rad^2] c of F = c n |n|
    per_coefficient: float  # [rad^2/(N s^2)] 1 / c
    most: float  # [N] largest force of one thruster
    dead_zone: float  # [rad/s] slower than this a thruster does not turn
    per_arm: float  # [1/m] 1 / (2 l), l the arm of each horizontal thruster
    behind: float  # [-] slots from the newest command back to the one in force when a step begins
    half: float  # [-] e^{-p dt / 2}
    late: float  # [-] e^{-p x}, x the time from the change of command to the end of a step
    late_half: float  # [-] the same to the middle of the step; 1 when the command changes after it


class Thrusters(NamedTuple):
    """Memory: how fast the shafts turn, and the commands still on their way."""

    started: float = 0.0  # [-] 1 after the first step
    port: float = 0.0  # [rad/s]
    starboard: float = 0.0  # [rad/s]
    vertical: float = 0.0  # [rad/s]
    newest: float = 0.0  # [-] slot of the last command
    commands: Annotated[Rows, Length(3 * SLOTS)] = np.zeros(3 * SLOTS)  # (thruster * SLOTS,) [rad/s]


def smallest_plant_step(delay: float) -> float:
    """The shortest plant step for which the ring of commands still spans the delay.

    Args:
        delay: [s] of the thrusters, >= 0.

    Returns:
        The step [s]; with a shorter one the shaft speeds turn NaN, which stops the mission.
    """
    return delay / (SLOTS - 1.0)


def thruster_plant(
    dt: float, coefficient: float, max_shaft_speed: float, dead_zone: float, pole: float, delay: float, arm: float
) -> ThrusterPlant:
    """What a plant step does to commands and shafts.

    Args:
        dt: [s] plant step, the same for the whole mission.
        coefficient: [N s^2/rad^2] of F = c n |n|.
        max_shaft_speed: [rad/s] of every thruster, either way.
        dead_zone: [-] of max_shaft_speed.
        pole: [1/s] of the first-order lag.
        delay: [s] >= 0, at most SLOTS - 1 plant steps: beyond that all shaft speeds become NaN.
        arm: [m] > 0, of each horizontal thruster.
    """
    steps = delay / dt
    whole = -floor(-steps)
    half, late = exp(-0.5 * dt * pole), exp((steps - whole) * dt * pole)
    if whole > SLOTS - 1.0:
        late = math.nan  # the ring is too short: let nobody miss it
    return ThrusterPlant(
        coefficient,
        1.0 / coefficient,
        thruster_force(max_shaft_speed, coefficient),
        dead_zone * max_shaft_speed,
        0.5 / arm,
        clip(whole, 0.0, SLOTS - 1.0),
        half,
        late,
        clip(late / half, 0.0, 1.0),
    )


@compiled
def thruster_force(shaft_speed: float, coefficient: float) -> float:
    """F = c n |n|.

    Args:
        shaft_speed: [rad/s] n.
        coefficient: [N s^2/rad^2] c.

    Returns:
        The force [N], of the sign of the shaft speed.
    """
    return coefficient * signed_square(shaft_speed)


@compiled
def shaft_speed_for(force: float, per_coefficient: float, dead_zone: float) -> float:
    """The shaft speed that gives a force: n = sign(F) sqrt(|F| / c), and 0 inside the dead zone.

    Args:
        force: [N] F.
        per_coefficient: [rad^2/(N s^2)] 1 / c.
        dead_zone: [rad/s] slower than this the thruster does not turn.

    Returns:
        The shaft speed [rad/s].
    """
    speed = signed_root(force * per_coefficient)
    return where(abs(speed) < dead_zone, 0.0, speed)


@compiled
def allocate(command: Command, plant: ThrusterPlant) -> ShaftSpeeds:
    """Share the wanted forces among the thrusters; what is too much is taken from thrust before yaw.

    F_port = X / 2 + N / (2 l),   F_starboard = X / 2 - N / (2 l),   each vertical one Z / 2

    A vehicle that cannot steer is lost sooner than one that is slow, so N is limited by the
    thrusters alone, and X to what N leaves.

    Args:
        command: X [N], N [N m], Z [N].
        plant: of the thrusters.

    Returns:
        Commanded shaft speeds [rad/s].
    """
    apart = clip(command.yaw_moment * plant.per_arm, -plant.most, plant.most)
    left = plant.most - abs(apart)
    together = clip(0.5 * command.thrust, -left, left)
    down = clip(command.heave_force * (1.0 / NUM_VERTICAL_THRUSTERS), -plant.most, plant.most)
    return ShaftSpeeds(
        shaft_speed_for(together + apart, plant.per_coefficient, plant.dead_zone),
        shaft_speed_for(together - apart, plant.per_coefficient, plant.dead_zone),
        shaft_speed_for(down, plant.per_coefficient, plant.dead_zone),
    )


@compiled
def started_thrusters(memory: Thrusters, shaft_speed: float) -> Thrusters:
    """At the first step of a mission: horizontal thrusters that turn, and are told to, as fast as the vehicle needs.

    Args:
        memory: left alone where the vehicle has started already; its commands are edited in place.
        shaft_speed: [rad/s] of each horizontal thruster, now and by the commands on their way.
    """
    new = memory.started < 0.5
    for slot in range(2 * SLOTS):
        store(memory.commands, slot, where(new, shaft_speed, load(memory.commands, slot)))
    fresh = Thrusters(1.0, shaft_speed, shaft_speed, 0.0 * shaft_speed, 0.0 * shaft_speed, memory.commands)
    return where(new, fresh, memory)


@compiled
def _turned(ring: Rows, speed: float, commanded: float, newest: float, plant: ThrusterPlant) -> tuple[float, float]:
    """One shaft: its speed halfway through the step and at the end."""
    older = newest - plant.behind
    older = where(older < 0.0, older + SLOTS, older)
    newer = where(older + 1.0 >= SLOTS, 0.0, older + 1.0)
    scatter(ring, newest, True, commanded)
    first, second = gather(ring, older), gather(ring, newer)
    half, full = plant.half, plant.half * plant.half
    middle = speed * half + first * (plant.late_half - half) + second * (1.0 - plant.late_half)
    return middle, speed * full + first * (plant.late - full) + second * (1.0 - plant.late)


@compiled
def turned_shafts(memory: Thrusters, commanded: ShaftSpeeds, plant: ThrusterPlant) -> tuple[ShaftSpeeds, Thrusters]:
    """One plant step of all shafts: a pure delay, then a first-order lag, both exact for any step.

    n' = p (n_c(t - delay) - n),   n_c held over each plant step

    The delayed command changes once within a step, x before its end, from `first` to `second`:
    n(dt) = n(0) e^{-p dt} + first (e^{-p x} - e^{-p dt}) + second (1 - e^{-p x})

    Args:
        memory: of thrusters that have started; the commands are edited in place.
        commanded: [rad/s] held over this step.
        plant: of the thrusters.

    Returns:
        Shaft speeds halfway through the step, and the memory at its end.
    """
    newest = where(memory.newest + 1.0 >= SLOTS, 0.0, memory.newest + 1.0)
    ring = memory.commands
    port_middle, port = _turned(ring, memory.port, commanded.port, newest, plant)
    starboard_middle, starboard = _turned(at(ring, SLOTS), memory.starboard, commanded.starboard, newest, plant)
    vertical_middle, vertical = _turned(at(ring, 2 * SLOTS), memory.vertical, commanded.vertical, newest, plant)
    after = Thrusters(1.0, port, starboard, vertical, newest, ring)
    return ShaftSpeeds(port_middle, starboard_middle, vertical_middle), after
