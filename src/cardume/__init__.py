"""Fleets of marine robots on coordinated paths: simulate them, study them, fly them.

    import cardume

    flight = cardume.fly(cardume.load("paper/figure-5"))
    flight.metrics.worst("cross_track_rms")        # (value in m, name of the vehicle)
    flight.channels["north"]                       # (time, vehicle) array, m

`load` takes a mission file, a path file or the name of a built-in mission, and raises `CardumeError`
with what is wrong and what to do; `fly` gives a `Flight`, of which `to_xarray` makes a data set;
`compare` flies missions side by side and gives a `Comparison`; `study` flies one with values that are
drawn or swept and gives an xarray data set, `open_study` one that was kept; `tune` looks for better
values of its numbers.  Each name is imported when it is used.
"""

import importlib
import typing

if typing.TYPE_CHECKING:
    from cardume.errors import CardumeError
    from cardume.missions.flying import fly_mission as fly
    from cardume.missions.log_dataset import to_xarray
    from cardume.missions.mission import Mission
    from cardume.missions.opening import open_mission as load
    from cardume.simulation.flight import Flight
    from cardume.studies.comparing import Comparison, compare
    from cardume.studies.store import open_study
    from cardume.studies.studying import study
    from cardume.studies.tuning.tune import Tuning, tune

    __version__: str

__all__ = [
    "CardumeError",
    "Comparison",
    "Flight",
    "Mission",
    "Tuning",
    "__version__",
    "compare",
    "fly",
    "load",
    "open_study",
    "study",
    "to_xarray",
    "tune",
]

_PLACES = {
    "CardumeError": ("cardume.errors", "CardumeError"),
    "Comparison": ("cardume.studies.comparing", "Comparison"),
    "Flight": ("cardume.simulation.flight", "Flight"),
    "Mission": ("cardume.missions.mission", "Mission"),
    "Tuning": ("cardume.studies.tuning.tune", "Tuning"),
    "compare": ("cardume.studies.comparing", "compare"),
    "fly": ("cardume.missions.flying", "fly_mission"),
    "load": ("cardume.missions.opening", "open_mission"),
    "open_study": ("cardume.studies.store", "open_study"),
    "study": ("cardume.studies.studying", "study"),
    "to_xarray": ("cardume.missions.log_dataset", "to_xarray"),
    "tune": ("cardume.studies.tuning.tune", "tune"),
}


def __getattr__(name: str) -> typing.Any:
    if name == "__version__":
        value: object = _installed_version()
    elif name in _PLACES:
        module, attribute = _PLACES[name]
        value = getattr(importlib.import_module(module), attribute)
    else:
        raise AttributeError(f"module 'cardume' has no attribute '{name}'; it offers {', '.join(__all__)}")
    globals()[name] = value  # found directly from now on
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def _installed_version() -> str:
    """The version in pyproject.toml, as it was installed."""
    from importlib import metadata

    try:
        return metadata.version("cardume")
    except metadata.PackageNotFoundError:  # sources that were never installed
        return "unknown"
