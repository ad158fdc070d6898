"""What the actuators of each vehicle can give, as far as a mission says it."""

from cardume.missions.mission import Mission

RPM = 30.0 / 3.141592653589793  # [rpm s/rad]
# channel of the log: section of the vehicle, parameter of its law, factor to the channel's unit
PLACES = {
    "thrust": ("autopilot", "thrust_max", 1.0),
    "yaw_moment": ("autopilot", "yaw_moment_max", 1.0),
    "shaft_speed_rpm": ("model", "max_shaft_speed", RPM),
}


def limits_of(mission: Mission | None) -> dict[str, tuple[float, ...]]:
    """The largest value, either way, of channels of the log: one per vehicle.

    Args:
        mission: as flown; None where it could not be read.

    Returns:
        Channels that have a limit on every vehicle, in the channel's unit.
    """
    found = {}
    for channel, (section, parameter, factor) in PLACES.items():
        laws = [getattr(vehicle, section) for vehicle in (mission.vehicles if mission else ())]
        values = [law.parameters.get(parameter) for law in laws]
        if values and all(isinstance(value, float) for value in values):
            found[channel] = tuple(factor * value for value in values)
    return found
