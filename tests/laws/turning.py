"""A vehicle that turns for ever, exactly: what dead reckoning and the observer are held against."""

from cardume.laws import MetersPerSecond, RadiansPerSecond, Seconds
from cardume.maths import sin, sincos
from cardume.signals import VesselState, Water
from cardume.vehicles.base import vehicle_model


@vehicle_model
def turning(
    vessel: VesselState,
    water: Water,
    dt: Seconds,
    speed: MetersPerSecond = 0.5,
    yaw_rate: RadiansPerSecond = 0.04,
    sway: MetersPerSecond = 0.0,
) -> VesselState:
    """p' = R(psi) (u, v) + Vc, psi' = r, integrated exactly: the chord of the arc points along psi + r dt / 2."""
    half = 0.5 * yaw_rate * dt
    chord = dt * sin(half) / half
    sine, cosine = sincos(vessel.heading + half)
    return VesselState(
        vessel.north + chord * (cosine * speed - sine * sway) + dt * water.north,
        vessel.east + chord * (sine * speed + cosine * sway) + dt * water.east,
        vessel.depth,
        vessel.heading + yaw_rate * dt,
        speed,
        sway,
        0.0,
        yaw_rate,
        speed,  # as `kinematic`: the reader `proportional` makes a speed of it
        0.0,
        0.0,
        0.0,
    )
