"""Ocean currents from CF NetCDF files.

field = read_current("cadiz.nc", window=Window(origin=GeoPoint(latitude, longitude)))
problem = explain_coverage(field, origin, points)   # "" where the mission can be flown
rows = field.to_rows(origin)                         # for the law `gridded`
"""

from cardume.missions.currents.axes import Window
from cardume.missions.currents.coverage import explain_coverage
from cardume.missions.currents.field import CurrentField
from cardume.missions.currents.netcdf import read_current
from cardume.missions.currents.synthetic import synthetic_cadiz

__all__ = ["CurrentField", "Window", "explain_coverage", "read_current", "synthetic_cadiz"]
