"""What `import cardume` offers is what it says it offers."""

import inspect
import subprocess
import sys
import types
from importlib.metadata import version

import cardume


def test_every_listed_name_can_be_imported() -> None:
    assert cardume.__all__, "cardume.__all__ lists the public names"
    missing = [name for name in cardume.__all__ if not hasattr(cardume, name)]
    assert not missing, f"listed in cardume.__all__ but not there: {missing}"


def test_names_are_listed_once() -> None:
    assert len(cardume.__all__) == len(set(cardume.__all__)), "cardume.__all__ lists a name twice"


def test_every_public_name_is_listed() -> None:
    there = {name for name, value in vars(cardume).items() if not isinstance(value, types.ModuleType)}
    unlisted = {name for name in there if not name.startswith("_")} - set(cardume.__all__)
    assert not unlisted, f"public in cardume but not in __all__: {sorted(unlisted)}"


def test_listed_functions_and_classes_are_documented() -> None:
    offered = [getattr(cardume, name) for name in cardume.__all__]
    bare = [value for value in offered if callable(value) and not inspect.getdoc(value)]
    assert not bare, f"without a docstring: {bare}"


def test_star_import_gives_the_listed_names() -> None:
    names: dict[str, object] = {}
    exec("from cardume import *", names)
    assert set(cardume.__all__) <= set(names)


def test_the_version_is_the_installed_one() -> None:
    assert cardume.__version__ == version("cardume")


def test_importing_cardume_loads_no_plotting_or_file_format() -> None:
    """The command line starts quickly because each of these is loaded where it is used."""
    heavy = {"matplotlib", "netCDF4", "pyproj", "scipy", "xarray"}
    code = f"import sys, cardume; print(*{heavy} & set(sys.modules))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert loaded == []
