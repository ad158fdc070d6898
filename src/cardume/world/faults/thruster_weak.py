"""Thrusters that push less than they are told to: motors that turn too slowly, or not at all."""

from typing import NamedTuple

from cardume.compiler import compiled
from cardume.maths import clip
from cardume.signals import Command


class Weakness(NamedTuple):
    """What is left of the force of each thruster, and what must be known of the healthy ones."""

    port: float = 1.0  # [-] share of the force; 0: dead
    starboard: float = 1.0  # [-]
    vertical: float = 1.0  # [-]
    arm: float = 1.0  # [m] of each horizontal thruster
    most: float = 0.0  # [N] largest force of one


@compiled
def weakened(command: Command, weak: Weakness) -> Command:
    """The command of which healthy thrusters would make what weak ones make of the one that is given.

    F_port = e_port (X / 2 + N / (2 l)),   F_starboard = e_starboard (X / 2 - N / (2 l))
    X' = F_port + F_starboard,   N' = l (F_port - F_starboard),   Z' = e_vertical Z

    Forces are limited, thrust before yaw, as `allocate` limits them, so that a weak thruster is weak at its limit too.
    The shafts turn as slowly as the force says, and the sensor of their speed says so.

    Args:
        command: X [N], N [N m], Z [N] of the autopilot.
        weak: shares e, arm l and limit.
    """
    apart = clip(0.5 * command.yaw_moment / weak.arm, -weak.most, weak.most)
    left = weak.most - abs(apart)
    together = clip(0.5 * command.thrust, -left, left)
    port, starboard = weak.port * (together + apart), weak.starboard * (together - apart)
    return Command(port + starboard, weak.arm * (port - starboard), weak.vertical * command.heave_force)
