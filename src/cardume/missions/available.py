"""The laws that a mission may name: ours, and the user's where the command line allows it."""

import importlib
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, cast

from cardume.errors import LawError
from cardume.laws import Law, all_families, laws_of
from cardume.missions.catalog import Catalog
from cardume.onboard import compensation, control, coordination, guidance, messaging
from cardume.onboard.estimation import current, neighbors, position, speed
from cardume.paths import projection, virtual_target
from cardume.simulation.flight import METRICS
from cardume.vehicles import kinematic, medusa, medusa_2013
from cardume.world import acoustics, bathymetry, currents, sensors

# Importing a room registers its laws.
ROOMS = (
    acoustics,
    bathymetry,
    compensation,
    control,
    coordination,
    current,
    currents,
    guidance,
    kinematic,
    medusa,
    medusa_2013,
    messaging,
    neighbors,
    position,
    projection,
    sensors,
    speed,
    virtual_target,
)


def default_sensors(model: str, is_submerged: bool) -> Sequence[str] | str:
    """The sensors that a vehicle has unless its mission says otherwise.

    Args:
        model: name of the vehicle model.
        is_submerged: whether it is to keep a depth below the surface.

    Returns:
        Kinds of sensors, or "ideal".
    """
    if model == "kinematic":
        return "ideal"
    below = ("ahrs", "depth", "thruster_speed")
    return below if is_submerged else ("gnss", *below)


def catalog(allow_code: Iterable[str | Path] = (), readable: Iterable[Path] | None = None) -> Catalog:
    """What missions may name.

    Args:
        allow_code: folders from which laws written as `module:function` may be imported.
        readable: folders and files that may be read; None for all.
    """
    folders = [Path(folder).resolve() for folder in allow_code]

    def resolve(family: str, name: str) -> Law:
        return users_law(family, name, folders)

    return Catalog(
        laws_of=cast(Any, laws_of),  # the catalog asks for less than a law has
        resolve_law=cast(Any, resolve),
        metrics={name: metric.unit for name, metric in METRICS.items()},
        default_sensors=default_sensors,
        readable=None if readable is None else tuple(path.resolve() for path in readable),
    )


def every_law() -> dict[str, dict[str, Law]]:
    """The built-in laws of every family."""
    return all_families()


def users_law(family: str, name: str, folders: Sequence[Path]) -> Law:
    """Import a user's law of a family.

    Args:
        family: that it must belong to.
        name: `module:function`, the module inside one of the folders.
        folders: from which code may be imported.

    Raises:
        LawError: not allowed, not found, not a law, or of another family.
    """
    law = any_users_law(name, folders)
    if law.family != family:
        raise LawError(f"{name} is a law of the family {law.family}; here one of the family {family} is wanted")
    return law


def any_users_law(name: str, folders: Sequence[Path]) -> Law:
    """Import a user's law of whatever family.

    Args:
        name: `module:function`, the module inside one of the folders.
        folders: from which code may be imported.

    Raises:
        LawError: not allowed, not found, or not a law.
    """
    module_name, _, function = name.partition(":")
    if not folders:
        raise LawError(
            f"'{name}' is code of yours, and code is run only where the command line allows it:"
            f" add --allow-code DIR, DIR being the folder in which {module_name.split('.')[0]} lies"
        )
    parts = module_name.split(".")
    if not all(part.isidentifier() for part in parts) or not function.isidentifier():
        raise LawError(f"'{name}' is no module:function, such as my_lab.laws:my_law")
    if not any(_is_inside(folder, parts) for folder in folders):
        searched = ", ".join(str(folder) for folder in folders)
        raise LawError(f"there is no module {module_name} in {searched}; check its name and --allow-code")
    law = getattr(_imported(module_name, folders), function, None)
    if law is None:
        raise LawError(f"module {module_name} has no '{function}'; check its spelling")
    if not isinstance(law, Law):
        raise LawError(f"{name} is no law: mark the function with the decorator of its family, such as @guidance_law")
    return law


def _is_inside(folder: Path, parts: Sequence[str]) -> bool:
    place = folder.joinpath(*parts)
    return place.with_suffix(".py").is_file() or (place / "__init__.py").is_file()


def _imported(module_name: str, folders: Sequence[Path]) -> object:
    added = [str(folder) for folder in folders if str(folder) not in sys.path]
    sys.path[:0] = added
    try:
        return importlib.import_module(module_name)
    except Exception as problem:  # whatever the user's file raises
        raise LawError(f"module {module_name} failed on import: {type(problem).__name__}: {problem}") from problem
