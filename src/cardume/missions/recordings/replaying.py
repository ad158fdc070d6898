"""Replay a recording: read it, let each vehicle navigate through it, and hold that against the truth."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cardume.errors import InputError
from cardume.missions.geodesy import GeoPoint
from cardume.missions.log import Log
from cardume.missions.mission import Mission
from cardume.missions.recordings import log as flights
from cardume.missions.recordings.asking import Request, check_law, name_of
from cardume.missions.recordings.base import Recorded, check_length
from cardume.missions.recordings.by_ranges import LAW, doubt_of, play_ranges
from cardume.missions.recordings.later import Smoothed, look_back
from cardume.missions.recordings.meeting import Met, draft, meet
from cardume.missions.recordings.playing import Believed, Innovation, Score, innovations_of, play, score
from cardume.missions.recordings.reading import LOG, kind_of, read_recording
from cardume.missions.wording import unknown
from cardume.units import printable

Progress = Callable[[str, int, int], None]
USUAL = "kalman_replay"
MOST_TICKS = 1_000_000


@dataclass(frozen=True, kw_only=True)
class Part:
    """One vehicle of a replay.

    Attributes:
        believed: tick by tick.
        innovations: of its fixes.
        score: of all that.
        position: the law that was judged.
        smoothed: what later fixes say; None: not asked for.
        found: more that the law found, as the scale of the ranges.
    """

    believed: Believed
    innovations: tuple[Innovation, ...]
    score: Score
    position: str
    smoothed: Smoothed | None = None
    found: Mapping[str, float] | None = None


@dataclass(frozen=True, kw_only=True)
class Replay:
    """A recording replayed.

    Attributes:
        name: safe as the name of a folder.
        kind: the format.
        parts: one for each vehicle.
        mission: that stood around the vehicles; None where no engine's law was judged.
        log: of the flight, where the recording is one.
        log_period: [s] between rows of the log.
        origin: where north = east = 0 lies.
        began: when, as text.
        notes: what a person must know.
    """

    name: str
    kind: str
    parts: tuple[Part, ...]
    mission: Mission | None = None
    log: Log | None = None
    log_period: float = 1.0
    origin: GeoPoint | None = None
    began: str = ""
    notes: tuple[str, ...] = ()


def replay(request: Request, progress: Progress = lambda stage, done, total: None) -> Replay:
    """Replay a recording.

    Args:
        request: which, and how.
        progress: called with "compile" or "fly", how much is done, and how much there is.

    Raises:
        InputError: a recording that cannot be read, laws that do not exist, or no start where one is needed.
    """
    for family, given in (("position", request.position), ("current_observer", request.current_observer)):
        check_law(family, given or {})
    kind = request.kind or kind_of(request.path)
    return _replay_log(request, progress) if kind == LOG else _replay_recording(request, kind)


def _settings(key: str, given: Mapping[str, str] | None) -> list[str]:
    """`--position law=direct` as overrides of a mission."""
    return [f"{key}.{name}={value}" for name, value in (given or {}).items()]


# ---- a flight --------------------------------------------------------------------------------------------------------


def _replay_log(request: Request, progress: Progress) -> Replay:
    if request.position and request.position.get("law") == LAW:
        raise InputError(f"--position law={LAW} is for recordings of ranges; a flight is replayed with the laws aboard")
    log = flights.read(request.path)

    def overrides(name: str) -> list[str]:
        keys = f"vehicles.{name}.position", f"vehicles.{name}.current_observer"
        return _settings(keys[0], request.position) + _settings(keys[1], request.current_observer)

    mission, mets = flights.meet_again(
        log,
        request.vehicles,
        overrides,
        directory=flights.directory_of(request.path),
        more=request.overrides,
        allow_code=request.allow_code,
        progress=progress,
    )
    return Replay(
        name=name_of(request.path),
        kind=LOG,
        parts=tuple(_part(met, request, mission.log_period) for met in mets),
        mission=mission,
        log=log,
        log_period=mission.log_period,
        origin=GeoPoint(mission.origin.latitude, mission.origin.longitude) if mission.origin else None,
    )


def _part(met: Met, request: Request, period: float) -> Part:
    believed = play(met)
    vehicle = met.plan.vehicles[met.vehicle]
    law = vehicle.laws["position"]
    innovations = innovations_of(believed, law.value_or("fix_sigma", math.nan))
    return Part(
        believed=believed,
        innovations=tuple(innovations),
        score=score(believed, innovations),
        position=law.law.name,
        smoothed=look_back(believed, law, vehicle.believed_start, period) if request.looks_back else None,
    )


# ---- a recording -----------------------------------------------------------------------------------------------------


def _replay_recording(request: Request, kind: str) -> Replay:
    recording, name = read_recording(request.path, kind, request.options), printable(str(request.path))
    vehicles = [_with_start(vehicle, request) for vehicle in _chosen(recording.vehicles, request)]
    notes, parts = [*recording.notes], []
    mission: Mission | None = None
    for vehicle in vehicles:
        check_length(vehicle.last, name)
        if vehicle.last / request.tick > MOST_TICKS:
            raise InputError(f"{name}: {vehicle.last:g} s are more than {MOST_TICKS:,} ticks; give a longer --tick")
        if not vehicle.sighted:
            notes.append(f"{vehicle.name}: has no fix, only dead reckoning is left")
        by_ranges = (request.position or {}).get("law") == LAW or (
            not request.position and bool(vehicle.sighted) and not vehicle.has_positions
        )
        if by_ranges:
            parts.append(_part_by_ranges(vehicle, request))
        else:
            mission, part = _part_by_engine(vehicle, request, recording.origin)
            parts.append(part)
            notes += _lacks(vehicle)
    return Replay(
        name=name_of(request.path),
        kind=kind,
        parts=tuple(parts),
        mission=mission,
        log_period=max(1.0, request.tick),
        origin=recording.origin,
        began=recording.began,
        notes=tuple(dict.fromkeys(notes)),
    )


def _chosen(vehicles: Sequence[Recorded], request: Request) -> list[Recorded]:
    names = [vehicle.name for vehicle in vehicles]
    for name in request.vehicles:
        if name not in names:
            raise InputError(f"--vehicle {printable(name)}: {unknown('no such vehicle', name, names)}")
    return [vehicle for vehicle in vehicles if vehicle.name in request.vehicles or not request.vehicles]


def _with_start(vehicle: Recorded, request: Request) -> Recorded:
    return replace(vehicle, start=request.start) if isinstance(request.start, tuple) else vehicle


def _part_by_ranges(vehicle: Recorded, request: Request) -> Part:
    given = {key: value for key, value in (request.position or {}).items() if key != "law"}
    if request.start != "unknown":
        vehicle = replace(vehicle, start=_start_of(vehicle))
    believed, innovations, found = play_ranges(vehicle, doubt_of(given), request.tick, request.start != "unknown")
    return Part(
        believed=believed,
        innovations=tuple(innovations),
        score=score(believed, innovations),
        position=LAW,
        found=found,
    )


def _part_by_engine(vehicle: Recorded, request: Request, origin: GeoPoint | None) -> tuple[Mission, Part]:
    position = {"law": USUAL, **(request.position or {})}
    observer = {
        "law": "from_position" if position["law"] == USUAL else "complementary",
        **(request.current_observer or {}),
    }
    settings = _settings("vehicles.recorded.position", position) + _settings(
        "vehicles.recorded.current_observer", observer
    )
    if math.isfinite(request.options.fix_sigma) and position["law"] == USUAL and "fix_sigma" not in position:
        settings.append(f"vehicles.recorded.position.fix_sigma={request.options.fix_sigma!r} m")
    text = draft(name_of(request.path), vehicle, request.tick, _start_of(vehicle), origin)
    mission, met = meet(vehicle, text, [*settings, *request.overrides], request.allow_code)
    return mission, _part(met, request, max(1.0, request.tick))


def _start_of(vehicle: Recorded) -> tuple[float, float]:
    """Where a vehicle begins: where the recording says, else its first fix, else its first true position."""
    if vehicle.start is not None:
        return vehicle.start
    positions = [s for s in vehicle.sighted if math.isnan(s.range)]
    if positions:
        first = min(positions, key=lambda s: s.valid)
        return first.north, first.east
    if vehicle.truth.is_there:
        north, east = vehicle.truth.values[0, :2]
        return float(north), float(east)
    name = printable(vehicle.name)
    raise InputError(f"{name}: nothing says where it starts; give --start NORTH,EAST in meters; of ranges, or unknown")


def _lacks(vehicle: Recorded) -> list[str]:
    if vehicle.velocity.is_there and not vehicle.attitude.is_there:
        return [f"{vehicle.name}: no heading was recorded; it is taken to head north"]
    if not vehicle.velocity.is_there:
        return [
            f"{vehicle.name}: no speed through the water was recorded; it is taken to be 0, and what moves it to be a"
            " current"
        ]
    return []


def errors_of(believed: Believed) -> np.ndarray:
    """(tick,) [m] distance of what was believed from the truth, NaN where that is not known.

    Args:
        believed: by one vehicle.
    """
    away: np.ndarray = np.hypot(*(believed.position - believed.truth).T)
    return away
