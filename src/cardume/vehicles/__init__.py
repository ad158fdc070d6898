"""Vehicle models: what forces, or the reference itself, do to a vehicle in one plant step."""

from cardume.vehicles.base import step_vehicle, vehicle_model
from cardume.vehicles.kinematic import kinematic
from cardume.vehicles.medusa import medusa

__all__ = ["kinematic", "medusa", "step_vehicle", "vehicle_model"]
