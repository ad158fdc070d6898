"""What of a mission's path file is not flown."""

from pathlib import Path

from cardume.missions.formats import read_plan
from cardume.missions.geodesy import GeoPoint
from cardume.missions.mission import Mission
from cardume.missions.route import FilePath


def notes_of(mission: Mission) -> tuple[str, ...]:
    """What of a mission's path file is not flown, one sentence each; nothing where it has no path file.

    Args:
        mission: without sweeps.

    Raises:
        MissionError: the path file cannot be read.
    """
    if not isinstance(mission.path, FilePath):
        return ()
    origin = GeoPoint(mission.origin.latitude, mission.origin.longitude) if mission.origin else None
    plan = read_plan(Path(mission.path.file), origin)
    is_limited = any(vehicle.limits is not None and vehicle.limits.geofence is not None for vehicle in mission.vehicles)
    unused = ("geofence of the file: not used; limits.geofence says where vehicles are to stay",)
    return plan.notes if plan.region is None or is_limited else (*plan.notes, *unused)
