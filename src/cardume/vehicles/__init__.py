"""Vehicle models: what forces, or the reference itself, do to a vehicle in one plant step."""

from cardume.vehicles.base import announce, step_vehicle, variant_of, vehicle_model
from cardume.vehicles.kinematic import kinematic
from cardume.vehicles.medusa import medusa
from cardume.vehicles.medusa_2013 import medusa_2013

__all__ = ["announce", "kinematic", "medusa", "medusa_2013", "step_vehicle", "variant_of", "vehicle_model"]
