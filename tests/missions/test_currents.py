"""Currents from CF NetCDF files: every trait a real file may have, what is wrong explained, oracles for the rest."""

import itertools
import math
import os
import shutil
import warnings
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray
from hypothesis import given
from hypothesis import strategies as st
from netCDF4 import Dataset
from pyproj import Geod
from scipy.interpolate import RegularGridInterpolator
from scipy.io import netcdf_file

from cardume.errors import DataError
from cardume.missions.currents import CurrentField, Window, explain_coverage, read_current, synthetic_cadiz
from cardume.missions.currents.cf_units import length_factor, speed_factor
from cardume.missions.currents.classic import promised_size
from cardume.missions.currents.field import local_axes, meters_per_degree
from cardume.missions.geodesy import GeoPoint, to_geographic
from cardume.world.currents import water_at

REAL = Path("/work/shared/data/currents/cadiz_hf_radar_2013-10-31T22.nc")
