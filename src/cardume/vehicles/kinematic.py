"""The paper's vehicle: it has the heading, speed and depth that are asked of it, at once or after a lag."""

from cardume.compiler import compiled, some, where
from cardume.laws import NotNegative, Positive, RadiansPerSecond, Seconds
from cardume.maths import clip, maximum, to_ned, unwrap_near
from cardume.maths.integrators import remaining, simpson_mean
from cardume.signals import Reference, VesselState, Water
from cardume.vehicles.base import vehicle_model

UNLIMITED = 1e9  # [rad/s]


@compiled
def approached(value: float, target: float, time_constant: float, dt: float) -> tuple[float, float, float]:
    """A first-order approach at the start, the middle and the end of a step; without a lag it is over at the start.

    x(t) = target - (target - x) exp(-t / T)

    Args:
        value: [any] x before the step.
        target: [any] where x goes.
        time_constant: [s] T >= 0.
        dt: [s] step.

    Returns:
        Three values of x.
    """
    gap = target - value
    half = remaining(time_constant, 0.5 * dt)
    return where(time_constant > 0.0, value, target), target - gap * half, target - gap * half * half


@compiled
def mean_velocity(headings: tuple[float, float, float], speeds: tuple[float, float, float]) -> tuple[float, float]:
    """Mean of R(psi) (u, 0) over a step, by Simpson's rule: exact for a held heading, else of fourth order.

    Args:
        headings: [rad] psi at the start, the middle and the end.
        speeds: [m/s] u then.

    Returns:
        (north, east) [m/s].
    """
    north_0, east_0 = to_ned(headings[0], speeds[0], 0.0)
    north_1, east_1 = to_ned(headings[1], speeds[1], 0.0)
    north_2, east_2 = to_ned(headings[2], speeds[2], 0.0)
    return simpson_mean(north_0, north_1, north_2), simpson_mean(east_0, east_1, east_2)


@vehicle_model
def kinematic(
    vessel: VesselState,
    reference: Reference,
    water: Water,
    dt: Seconds,
    heading_time_constant: NotNegative[Seconds] = 0.0,
    speed_time_constant: NotNegative[Seconds] = 0.0,
    yaw_rate_max: Positive[RadiansPerSecond] = UNLIMITED,
) -> VesselState:
    """One plant step of a vehicle without dynamics.

    p' = R(psi) (u, 0) + Vc,   T psi' = psi_ref - psi,   T_u u' = u_ref - u,   z = z_ref
    psi' = r_ref  where a yaw rate is asked for instead of a heading;   |psi'| <= yaw_rate_max

    With T = T_u = 0, the paper's vehicle, heading and speed are the references from the start of the
    step on. It turns the shorter way round, and its heading is never wrapped. yaw_rate and heave are
    the changes over the step divided by dt. There are no thrusters: shaft_speed is the surge, so
    that `proportional` reads it, and thrust, moment and power are zero.

    Args:
        vessel: state before the step.
        reference: heading [rad] or yaw rate [rad/s], speed through the water [m/s], depth [m]; the surface
            stops a climb.
        water: current [m/s], held over the step.
        dt: [s] plant step.
        heading_time_constant: [s] T >= 0, lag of the heading behind its command.
        speed_time_constant: [s] T_u >= 0, lag of the speed behind its command.
        yaw_rate_max: [rad/s] how fast it can turn; a step is turned evenly where that limits it.

    Returns:
        The state after the step.

    Source: paper eq. (1). A lag in heading shifts an arc flown by line of sight outwards by the e of
    e = -sigma d tan(T u |c| / (1 - c e)).
    """
    wanted = unwrap_near(reference.heading, vessel.heading)
    headings = approached(vessel.heading, wanted, heading_time_constant, dt)
    turns, is_limited = reference.yaw_rate == reference.yaw_rate, yaw_rate_max < UNLIMITED
    if some(turns | is_limited):
        turned = where(turns, dt * reference.yaw_rate, headings[2] - vessel.heading)
        slowed = clip(turned, -dt * yaw_rate_max, dt * yaw_rate_max)
        evenly = turns | (slowed != turned)
        middle = where(evenly, vessel.heading + 0.5 * slowed, headings[1])
        headings = (
            where(evenly, vessel.heading, headings[0]),
            middle,
            where(evenly, vessel.heading + slowed, headings[2]),
        )
    speeds = approached(vessel.surge, reference.speed, speed_time_constant, dt)
    north, east = mean_velocity(headings, speeds)
    depth = maximum(reference.depth, 0.0)
    return VesselState(
        vessel.north + dt * (north + water.north),
        vessel.east + dt * (east + water.east),
        depth,
        headings[2],
        speeds[2],
        0.0,
        (depth - vessel.depth) / dt,
        (headings[2] - vessel.heading) / dt,
        speeds[2],
        0.0,
        0.0,
        0.0,
    )
