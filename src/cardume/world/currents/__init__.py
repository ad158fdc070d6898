"""Currents: `uniform`, `gridded`."""

from cardume.world.currents.base import current_law, flow
from cardume.world.currents.grid import pack_grid, water_at
from cardume.world.currents.gridded import gridded
from cardume.world.currents.uniform import uniform

__all__ = ["current_law", "flow", "gridded", "pack_grid", "uniform", "water_at"]
