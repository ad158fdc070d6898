"""From one kind of file to another: missions and path files to path files, path files to missions.

Whoever adds a way, such as from a log to tracks, adds its kinds of file to `KINDS` and a `Converter` to
`CONVERTERS`; the command line needs no change.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from cardume.errors import InputError
from cardume.missions import library
from cardume.missions.formats import parse_plan
from cardume.missions.formats.content import FORMATS, format_of, read_text
from cardume.missions.formats.plan import Plan
from cardume.missions.geodesy import GeoPoint
from cardume.units import printable

if TYPE_CHECKING:
    from cardume.missions.mission import Mission

MISSION = "mission"
LOG = "log"


class Viewed(NamedTuple):
    """A kind of file that is made of a log, for other people's programs."""

    suffixes: tuple[str, ...]
    holds: str


VIEWERS = {
    "kml": Viewed((".kml",), "of a run, for Google Earth: tracks with times"),
    "csv": Viewed((".csv",), "of a run, for spreadsheets and pandas: all channels"),
    "parquet": Viewed((".parquet",), "of a run, for pandas and R: all channels with units; cardume[parquet]"),
    "mcap": Viewed((".mcap",), "of a run, for Foxglove, RViz and ros2 bag: ROS 2 messages; cardume[ros]"),
    "rrd": Viewed((".rrd",), "of a run, for Rerun: tracks, paths, currents, channels, messages; cardume[rerun]"),
}
KINDS: dict[str, tuple[str, ...]] = {
    MISSION: (".yaml", ".yml"),
    LOG: (".nc",),
    **{name: f.suffixes for name, f in FORMATS.items()},
    **{name: v.suffixes for name, v in VIEWERS.items()},
}
"""Kinds of file, by the endings of their names."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Request:
    """What is to be converted.

    Attributes:
        source: a file, or the name of a built-in mission.
        source_kind: one of KINDS; empty: to be found out.
        target: the file to be written.
        target_kind: one of KINDS; empty: what its name says.
        origin: where local axes begin; None: where the source says.
        speed: [m/s] where the source has none; None: left open.
        tolerance: [m] how far straight legs may lie from the arcs that they stand for.
        vehicle: whose own path is wanted; empty: the reference path.
        overrides: what `--set` gives, for a mission.
        seed: instead of the mission's own.
        allow_code: folders from which the mission's own laws may be imported.
    """

    source: str
    source_kind: str = ""
    target: Path
    target_kind: str = ""
    origin: GeoPoint | None = None
    speed: float | None = None
    tolerance: float = 0.05
    vehicle: str = ""
    overrides: Sequence[str] = ()
    seed: int | None = None
    allow_code: Sequence[Path] = ()


@dataclass(frozen=True, kw_only=True, slots=True)
class Conversion:
    """What came out.

    Attributes:
        content: of the file to be written.
        holds: what is in it, in a few words.
        lost: what the target does not keep, one sentence each.
        notes: what of the source is not flown, one sentence each.
        is_flyable: whether `cardume check` and `run` take what came out.
    """

    content: bytes
    holds: str
    lost: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    is_flyable: bool = True


@dataclass(frozen=True, kw_only=True, slots=True)
class Converter:
    """A way from some kinds of file to others."""

    sources: frozenset[str]
    targets: frozenset[str]
    convert: Callable[[Request], Conversion]


def convert(request: Request) -> Conversion:
    """Convert a file.

    Args:
        request: what, and into what.

    Raises:
        InputError: a source that cannot be read, a target that is not known, or no way between them.
    """
    target_kind = request.target_kind or _kind_of_name(str(request.target))
    if not target_kind:
        endings = ", ".join(f"{suffixes[0]} ({kind})" for kind, suffixes in KINDS.items())
        raise InputError(
            f"{printable(str(request.target))}: the name does not say what to write; end it in one of {endings},"
            " or give --to"
        )
    request = replace(
        request, source_kind=request.source_kind or _kind_of_source(request.source), target_kind=target_kind
    )
    for converter in CONVERTERS:
        if request.source_kind in converter.sources and target_kind in converter.targets:
            return converter.convert(request)
    ways = sorted(set().union(*(c.targets for c in CONVERTERS if request.source_kind in c.sources)))
    raise InputError(
        f"there is no way from {request.source_kind} to {target_kind}; from {request.source_kind} there are"
        f" {', '.join(ways) or 'none'}"
    )


def _kind_of_name(name: str) -> str:
    lowered = name.lower()
    return next((kind for kind, suffixes in KINDS.items() if lowered.endswith(suffixes)), "")


def _kind_of_source(source: str) -> str:
    """By its contents where that is a path file, else by its name; the directory of a run stands for its log."""
    if (Path(source) / "log.nc").is_file():
        return LOG
    kind = _kind_of_name(source)
    if (source in library.names() and not Path(source).is_file()) or (kind and kind not in FORMATS):
        return kind or MISSION
    if not Path(source).exists():
        from cardume.missions.opening import nothing_there

        raise nothing_there(source)
    return format_of(read_text(Path(source)), source)


def _to_path_file(request: Request) -> Conversion:
    from cardume.missions.formats.writing import with_speed, write_plan

    plan, lost = _plan_of(request)
    written = write_plan(with_speed(plan, request.speed), request.target_kind, plan.name, request.tolerance)
    length = sum(segment.length for segment in plan.segments)
    what = "lines and arcs" if request.target_kind == "medusa" else "points"
    return Conversion(
        content=written.content,
        holds=f"{FORMATS[request.target_kind].title}: {written.points} {what}, {length:.6g} m",
        lost=(*written.lost, *lost),
        notes=plan.notes,
    )


def _plan_of(request: Request) -> tuple[Plan, list[str]]:
    """The path that a source holds, and what of the source beside it is not kept."""
    from cardume.missions.mission_path import own_plan, plan_of_mission

    if request.source_kind == MISSION:
        plan, names, lost = plan_of_mission(opened(request), request.source, request.origin)
    else:
        path = Path(request.source)
        text, source = read_text(path), printable(str(path))
        plan = parse_plan(text, source, named=request.source_kind, origin=request.origin)
        plan = replace(plan, name=plan.name or path.name.split(".")[0])
        names, lost = [str(member.id) for member in plan.members], []
    if request.vehicle:
        plan = own_plan(plan, names, request.vehicle)
    elif request.source_kind == MISSION and request.target_kind == "medusa" and len(names) > 1:
        numbered = ", ".join(f"{name} is {number}" for number, name in enumerate(names, 1))
        lost.append(f"the names of the vehicles: {numbered}")
    return plan, lost


def opened(request: Request) -> Mission:
    """The mission that a request names."""
    from cardume.missions.opening import open_mission

    return open_mission(request.source, list(request.overrides), request.seed, list(request.allow_code))


def _resolve(request: Request) -> Conversion:
    """A mission with every default written."""
    mission = opened(request)
    text = mission.to_yaml(request.target.resolve().parent)
    return Conversion(content=text.encode(), holds="mission: every default written")


def _to_mission(request: Request) -> Conversion:
    from cardume.missions.drafting import draft_mission, is_smooth, segments_section

    plan, _ = _plan_of(request)
    if is_smooth(plan.segments):
        path, what = segments_section(plan.segments), f"{len(plan.segments)} lines and arcs, to be edited"
    else:
        path, what = _cornered(request, plan)
    text = draft_mission(plan, path, plan.name, request.speed)
    return Conversion(content=text.encode(), holds=f"mission: {what}", notes=plan.notes)


def _cornered(request: Request, plan: Plan) -> tuple[list[str], str]:
    """The section of a path with corners: its points, or where its legs have speeds of their own its file."""
    from cardume.missions.drafting import file_section, waypoints_section
    from cardume.missions.route import PATHS

    has_more = len({s.speed for s in plan.segments}) > 1 or any(s.curvature or s.curve for s in plan.segments)
    if not has_more and "waypoints" in PATHS:
        return waypoints_section(plan.segments), f"{len(plan.segments) + 1} points, to be edited"
    if request.vehicle:
        raise InputError(
            f"the own path of {printable(request.vehicle)} has corners, and more than points and one speed: a mission"
            " cannot hold it by itself; convert it to .medusa.txt"
        )
    file = os.path.relpath(request.source, request.target.resolve().parent)
    return file_section(file), f"{len(plan.segments)} pieces of path, which stay in {printable(request.source)}"


def _from_log(request: Request) -> Conversion:
    from cardume.missions.exports.from_log import convert_log

    return convert_log(request)


PATH_FILES = frozenset(FORMATS)
CONVERTERS: tuple[Converter, ...] = (
    Converter(sources=PATH_FILES | {MISSION}, targets=PATH_FILES, convert=_to_path_file),
    Converter(sources=PATH_FILES, targets=frozenset({MISSION}), convert=_to_mission),
    Converter(sources=frozenset({MISSION}), targets=frozenset({MISSION}), convert=_resolve),
    Converter(sources=frozenset({LOG}), targets=frozenset({"gpx", "geojson", *VIEWERS}), convert=_from_log),
)
