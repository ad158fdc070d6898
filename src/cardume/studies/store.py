"""A study on the disk: one Zarr store that xarray opens, written portion by portion.

DIR/study.zarr      the data set, see `layout`
DIR/ledger.txt      which portions are complete, with their checksums
DIR/mission.yaml    the mission with every default written
"""

import glob
import hashlib
import json
import math
import os
import shutil
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from cardume.errors import DataError
from cardume.studies.cases import Cases
from cardume.studies.chunks import codecs, encoded, write_chunk
from cardume.studies.constants import CHANCE, LIMIT, LIMIT_METRIC, LIMIT_VEHICLE, REQUIREMENT, RUN, VEHICLE
from cardume.studies.layout import LAST, Layout, Portion, Variable
from cardume.studies.ledger import digest_of, write_ledger
from cardume.studies.required import Wanted, wanted_of
from cardume.studies.sampling import needed
from cardume.units import printable

if TYPE_CHECKING:
    import xarray

FORMAT_VERSION = 1
MARK = "cardume_study"
STORE_NAME = "study.zarr"
MISSION_NAME = "mission.yaml"
BLOCK = 4096  # [bytes] that a file takes at least
TEXT = 200  # [bytes] of a reason why a mission failed, mostly none
OF_REQUIREMENTS = (LIMIT, LIMIT_METRIC, LIMIT_VEHICLE)
SIZES = {"float64": 8, "bool": 1, "int8": 1, "str": 8}


def create_study(folder: Path, layout: Layout, mission: str) -> None:
    """Fill a new folder with a study in which nothing is flown yet.

    Args:
        folder: empty.
        layout: of the data set.
        mission: its text, as it is to stand beside the store.
    """
    _create_arrays(folder / STORE_NAME, layout)
    (folder / MISSION_NAME).write_text(mission, encoding="utf-8")
    write_ledger(folder, digest_of(describing_files(folder, layout)))


def write_block(directory: Path, layout: Layout, portion: Portion, block: Mapping[str, np.ndarray]) -> None:
    """Write a portion; each file appears complete or not at all, that of LAST after all others.

    Args:
        directory: of the study.
        layout: of the data set.
        portion: where.
        block: of each variable.

    Raises:
        OSError: the disk is full, or refused otherwise.
    """
    files = files_of(directory, layout, portion)
    for name in (*(name for name in files if name != LAST), LAST):
        variable = layout.variables[name]
        shape = (*layout.chunk, *layout.sizes_after(variable))
        write_chunk(files[name], encoded(block[name], shape, variable.fill))


def files_of(directory: Path, layout: Layout, portion: Portion) -> dict[str, Path]:
    """The file of each variable, those without a number excepted, in an order that does not change.

    Args:
        directory: of the study.
        layout: of the data set.
        portion: whose.
    """
    found = {}
    for name, variable in sorted(layout.variables.items()):
        after = layout.sizes_after(variable)
        if 0 not in after:
            place = (*portion.place, *(0 for _ in after))
            found[name] = Path(directory, STORE_NAME, name, "c", *map(str, place))
    return found


def describing_files(directory: Path, layout: Layout) -> list[Path]:
    """The files that say what the data set holds: not a number that was flown is among them.

    Args:
        directory: of the study.
        layout: of the data set.
    """
    store = directory / STORE_NAME
    names = [*(axis.key for axis in layout.axes), RUN, VEHICLE, *(CHANCE + key for key in layout.chances)]
    names += [REQUIREMENT, *OF_REQUIREMENTS] if layout.requirements else []
    chunks = [store / name / "c" / "0" for name in names]
    return [store / "zarr.json", *(store / name / "zarr.json" for name in sorted(layout.variables)), *chunks]


def layout_of(directory: Path, cases: Cases) -> Layout:
    """The layout of a study that was begun.

    Args:
        directory: of the study.
        cases: of its mission.

    Raises:
        DataError: it is damaged, not there, or of another version.
    """
    attrs = read_attributes(directory)
    zarr = needed("zarr", "zarr")
    try:
        group = dict(zarr.open_group(directory / STORE_NAME, mode="r", use_consolidated=False).arrays())
        swept = len(cases.axes)
        wanted = wanted_of(cases.mission)
        others = {RUN, VEHICLE, REQUIREMENT, *OF_REQUIREMENTS, *(axis.key for axis in cases.axes)}
        told = tuple(map(str, group[REQUIREMENT][:])) if group[REQUIREMENT].size else ()
        if told != tuple(one.name for one in wanted):
            raise damaged(directory, f"its requirements are {', '.join(told)}")
        names = [name for name in group if name not in others and not name.startswith(CHANCE)]
        variables = {name: _variable(name, group[name], swept) for name in names}
        chances = {name.removeprefix(CHANCE): group[name][:] for name in group if name.startswith(CHANCE)}
        return Layout(
            axes=cases.axes,
            seeds=group[RUN][:],
            vehicles=tuple(map(str, group[VEHICLE][:])),
            requirements=wanted,
            variables=variables,
            chunk=group[LAST].chunks,
            chances=chances,
            attrs=attrs,
        )
    except DataError:
        raise
    except Exception as problem:  # whatever zarr finds wrong in its files
        raise damaged(directory, problem) from None


def open_study(directory: str | Path) -> "xarray.Dataset":
    """The data set of a study, read when it is used; of one that was not finished as far as it came.

    Dimensions are the swept keys, `run` (its coordinate is the seed), `vehicle` and `requirement`.

        runs = cardume.open_study("runs/figure-5-study/001")
        runs["fleet_cross_track_rms"].mean("run")

    Args:
        directory: of the study.

    Raises:
        DataError: it is damaged, not there, or of another version.
    """
    directory = Path(directory)
    read_attributes(directory)
    opening = needed("xarray", "xarray")
    needed("zarr", "zarr")
    try:
        with _quiet():
            found = opening.open_zarr(directory / STORE_NAME, chunks=None, consolidated=True, zarr_format=3)
        texts = {name: values.values for name, values in found.coords.items() if values.dtype.kind not in "biuf"}
    except Exception as problem:  # whatever zarr or xarray find wrong
        raise damaged(directory, problem) from None
    # plain texts: not every tool knows the kind in which NumPy 2 gives texts of any length
    plain = {name: found[name].copy(data=np.array([str(text) for text in values])) for name, values in texts.items()}
    return cast("xarray.Dataset", found.assign_coords(plain))


# What a study says of itself, and of which kind each must be.
ATTRIBUTES: Mapping[str, type] = {
    "title": str,
    "version": str,
    "engine": str,
    "mission": str,
    "mission_hash": str,
    "swept": list,
    "sampling": str,
    "seed": int,
    "runs": int,
    "command": str,
    "files": dict,
}


def read_attributes(directory: Path) -> dict[str, Any]:
    """What a study says of itself: mission, sampling, seed, version; each of the kind that it must be.

    Args:
        directory: of the study.

    Raises:
        DataError: it is damaged, not there, or of another version.
    """
    name = printable(str(directory))
    file = directory / STORE_NAME / "zarr.json"
    if not file.is_file():
        what = "is a file" if directory.is_file() else "holds no study" if directory.is_dir() else "does not exist"
        raise DataError(f"{name} {what}; give the directory of a study, as runs/figure-5-study/001")
    try:
        found = json.loads(file.read_bytes())["attributes"]
        version = found[MARK]
    except OSError as problem:
        raise DataError(f"{printable(str(file))} cannot be read: {problem.strerror}") from None
    except (ValueError, RecursionError, LookupError, TypeError) as problem:
        raise damaged(directory, problem) from None
    if version != FORMAT_VERSION:
        raise DataError(
            f"{name} has format {printable(str(version))[:40]}; this cardume reads format {FORMAT_VERSION}: use the"
            f" version that wrote it, {printable(str(found.get('version', 'unknown')))[:40]}, or fly the study again"
        )
    for key, kind in ATTRIBUTES.items():
        if not isinstance(found.get(key), kind):
            raise damaged(directory, f"its {key} is {found[key]!r}" if key in found else f"its {key} is missing")
    if hashlib.sha256(found["mission"].encode()).hexdigest() != found["mission_hash"]:
        raise damaged(directory, "its mission is not the one of its mission_hash")
    return dict(found)


def damaged(directory: Path, problem: Exception | str) -> DataError:
    """The error that a study's description cannot be read, to raise.

    Args:
        directory: of the study.
        problem: what was found.
    """
    what = printable(problem if isinstance(problem, str) else f"{type(problem).__name__}: {problem}")[:200]
    return DataError(
        f"the study in {printable(str(directory))} is damaged ({what}): what it holds can no longer be told; bring"
        f" {STORE_NAME} back from a copy, or fly it again in a new directory"
    )


def bytes_needed(layout: Layout) -> int:
    """Bytes [-] that a study takes on the disk, at most.

    Args:
        layout: of the data set.
    """
    chunks = math.prod(math.ceil(size / step) for size, step in zip(layout.shape, layout.chunk, strict=True))
    total = 0
    for variable in layout.variables.values():
        values = math.prod(layout.chunk) * math.prod(layout.sizes_after(variable))
        size = values * SIZES[variable.type]
        total += chunks * BLOCK * math.ceil(size / BLOCK) + 2 * BLOCK
    coordinates = 8 * len(layout.seeds) * (1 + len(layout.chances)) + BLOCK * 3 * (4 + len(layout.axes))
    return total + coordinates + chunks * 100


def bytes_free(place: Path) -> int:
    """Bytes [-] that are free where a folder is or will be.

    Args:
        place: of the folder.
    """
    there = next(path for path in (place, *place.absolute().parents) if path.exists())
    return shutil.disk_usage(there).free


def remove_partial_files(directory: Path) -> None:
    """Remove what killed processes left half-written: files in the study, and studies that were not whole yet.

    Args:
        directory: of the study.
    """
    for file in (directory / STORE_NAME).rglob("*.partial"):
        file.unlink(missing_ok=True)
    for folder in directory.absolute().parent.glob(f".{glob.escape(directory.name)}.*.partial"):
        number = folder.name.split(".")[-2]
        if number.isascii() and number.isdigit() and not _is_alive(int(number)):
            shutil.rmtree(folder, ignore_errors=True)


def _create_arrays(store: Path, layout: Layout) -> None:
    """The arrays of a data set, coordinates filled, all else empty."""
    zarr = needed("zarr", "zarr")
    with _quiet():
        attrs = {MARK: FORMAT_VERSION, **layout.attrs, "coordinates": " ".join(OF_REQUIREMENTS)}
        group = zarr.open_group(store, mode="w", zarr_format=3, attributes=attrs)
        for axis in layout.axes:
            _fill(group, axis.key, axis.values, {"units": axis.unit, "long_name": axis.key, "role": "swept"})
        _fill(group, RUN, layout.seeds, {"long_name": "seed"})
        _fill(group, VEHICLE, np.array(layout.vehicles), {"long_name": "vehicle"})
        _fill_requirements(group, layout.requirements)
        for key, values in layout.chances.items():
            about = {"role": "chance", "key": key, "long_name": f"chance below which the value of {key} lies"}
            _fill(group, CHANCE + key, values, about, (RUN,))
        for variable in layout.variables.values():
            _create(zarr, group, layout, variable)
        zarr.consolidate_metadata(store)


def _fill_requirements(group: Any, wanted: Sequence[Wanted]) -> None:
    """What is required, for people, and beside it the same for programs."""
    columns = [
        (REQUIREMENT, [one.name for one in wanted], "U", "what is required"),
        (
            LIMIT,
            [one.limit for one in wanted],
            "f8",
            "limit, in the unit of its metric; NaN where each run has its own",
        ),
        (LIMIT_METRIC, [one.metric for one in wanted], "U", "metric that is limited"),
        (LIMIT_VEHICLE, [one.vehicle or "" for one in wanted], "U", "whose metric; empty: the fleet's"),
    ]
    for name, values, kind, meaning in columns:
        _fill(group, name, np.array(values, dtype=kind), {"long_name": meaning}, (REQUIREMENT,))


def _is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OverflowError:
        return False  # no process ever had such a number
    except OSError:
        pass  # somebody else's
    return True


def _fill(group: Any, name: str, values: np.ndarray, attrs: dict[str, Any], dims: tuple[str, ...] = ()) -> None:
    is_text = values.dtype.kind in "US"
    array = group.create_array(
        name,
        shape=values.shape,
        chunks=(max(1, len(values)),),
        dtype=str if is_text else values.dtype,
        dimension_names=list(dims or (name,)),
        compressors=codecs(),
        attributes={key: value for key, value in attrs.items() if value},
        config={"write_empty_chunks": True},
    )
    if values.size:
        array[:] = values.astype(object) if is_text else values


def _create(zarr: Any, group: Any, layout: Layout, variable: Variable) -> None:
    after = layout.sizes_after(variable)
    group.create_array(
        variable.name,
        shape=(*layout.shape, *after),
        chunks=(*layout.chunk, *(max(1, size) for size in after)),
        dtype=str if variable.type == "str" else variable.type,
        fill_value=variable.fill,
        dimension_names=[*layout.dims[:-1], *variable.dims],
        compressors=codecs(),
        attributes=dict(variable.attrs),
    )


def _variable(name: str, array: Any, swept: int) -> Variable:
    kind = str(array.dtype)
    kind = kind if kind in SIZES else "str"
    return Variable(name, tuple(array.metadata.dimension_names[swept:]), kind, array.fill_value, dict(array.attrs))


@contextmanager
def _quiet() -> Iterator[None]:
    """Without the warning that consolidated metadata is an extension of Zarr 3: who does not know it reads the rest."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*onsolidated metadata")
        yield
