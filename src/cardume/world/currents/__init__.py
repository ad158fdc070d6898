"""Currents: `uniform`, `sheared`, `power_law`, `ekman`, `step`, `tidal`, `gauss_markov`, `gridded`."""

from cardume.world.currents.base import current_law, flow
from cardume.world.currents.ekman import ekman
from cardume.world.currents.gauss_markov import gauss_markov
from cardume.world.currents.grid import pack_grid, water_at
from cardume.world.currents.gridded import gridded
from cardume.world.currents.power_law import power_law
from cardume.world.currents.profile import ProfilePoint, pack_profile
from cardume.world.currents.sheared import sheared
from cardume.world.currents.step import step
from cardume.world.currents.tidal import tidal
from cardume.world.currents.uniform import uniform

__all__ = [
    "ProfilePoint",
    "current_law",
    "ekman",
    "flow",
    "gauss_markov",
    "gridded",
    "pack_grid",
    "pack_profile",
    "power_law",
    "sheared",
    "step",
    "tidal",
    "uniform",
    "water_at",
]
