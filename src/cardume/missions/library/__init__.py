"""Built-in missions, by name: `paper/figure-5`, `cadiz`, `kinematic/line` …"""

import os
from functools import cache
from pathlib import Path

from cardume.errors import InputError

HERE = Path(__file__).parent
RADAR = Path("currents") / "cadiz_hf_radar_2013-10-31T22.nc"
LAWNMOWER = Path("missions") / "lawnmower_3vehicles.medusa.txt"


def names() -> tuple[str, ...]:
    """The names of the built-in missions."""
    return tuple(sorted(p.relative_to(HERE).with_suffix("").as_posix() for p in HERE.rglob("*.yaml")))


def path(name: str) -> Path:
    """The file of a built-in mission.

    Args:
        name: one of `names`.

    Raises:
        InputError: there is no such mission.
    """
    if name not in names():
        raise InputError(f"there is no built-in mission '{name}'; there are {', '.join(names())}")
    return HERE / f"{name}.yaml"


def describe(name: str) -> str:
    """What a built-in mission shows, in a line: the first comment of its file."""
    first = path(name).read_text(encoding="utf-8").splitlines()[0]
    return first.lstrip("# ").strip()


def overrides(name: str) -> list[str]:
    """Values of a built-in mission that depend on what data this machine has.

    `cadiz` flies in a radar current where the file is there: in the folder that CARDUME_DATA names, or
    in `shared/data` beside a checkout.  Elsewhere it flies in a generated field of the same form.
    """
    if name != "cadiz":
        return []
    found = [f"path.file={_quoted(file)}" for file in [data_file(LAWNMOWER)] if file]
    return [*found, f"current.file={_quoted(data_file(RADAR) or synthetic_radar())}"]


def _quoted(file: Path) -> str:
    text = str(file).replace("'", "''")
    return f"'{text}'"


def data_file(relative: Path) -> Path | None:
    """A file of the data that this package does not ship, if it is here."""
    folders = [Path(os.environ["CARDUME_DATA"])] if os.environ.get("CARDUME_DATA") else []
    if len(HERE.parents) > 4:
        folders.append(HERE.parents[4] / "shared" / "data")  # beside a checkout
    return next((f / relative for f in folders if (f / relative).is_file()), None)


def own_data() -> list[Path]:
    """The files outside of this package that built-in missions read on this machine."""
    return [*filter(None, map(data_file, (LAWNMOWER, RADAR))), _synthetic_file()]


@cache
def synthetic_radar() -> Path:
    """A generated field in the place of the radar's, labelled synthetic; written once per user."""
    from cardume.missions.currents import synthetic_cadiz

    file = _synthetic_file()
    if not file.is_file():
        file.parent.mkdir(parents=True, exist_ok=True)
        draft = file.with_suffix(f".{os.getpid()}.nc")
        synthetic_cadiz(draft)
        draft.replace(file)
    return file


def _synthetic_file() -> Path:
    root = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return root / "cardume" / "synthetic_cadiz.nc"
