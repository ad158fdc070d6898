"""The mission file: text in, frozen records with every default out, and back.

catalog = Catalog(laws_of=..., metrics=...)
mission = draw(load_mission("figure-5.yaml", catalog))
"""

from cardume.missions.catalog import Catalog
from cardume.missions.distributions import Choose, Normal, Sweep, Uniform
from cardume.missions.drawing import draw, refuse_sweeps, sweeps_of, with_options
from cardume.missions.json_schema import json_schema
from cardume.missions.loading import load_mission, parse_mission
from cardume.missions.mission import Mission
from cardume.missions.vehicle import LawChoice, Vehicle

__all__ = [
    "Catalog",
    "Choose",
    "LawChoice",
    "Mission",
    "Normal",
    "Sweep",
    "Uniform",
    "Vehicle",
    "draw",
    "json_schema",
    "load_mission",
    "parse_mission",
    "refuse_sweeps",
    "sweeps_of",
    "with_options",
]
