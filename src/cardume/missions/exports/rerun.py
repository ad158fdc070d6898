"""A recording for the Rerun viewer: tracks, paths and currents in three dimensions, channels over time, messages.

Axes are our own, x north, y east, z down, and are declared as such (`FRD`: x forward, y to the right, z down), so the
viewer shows the sea from above. Time is that of the mission, from 0, on the timeline `mission_time`. Rerun keeps places
in 32 bits; the channels have all 64. The believed place has the true depth, for a log has no other.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from cardume.errors import InputError
from cardume.missions.exports.tracks import KINDS, TRUE
from cardume.simulation.flight import CHANNELS, MESSAGE_KINDS, Flight

TIMELINE = "mission_time"
WORLD, SCALARS, MESSAGES = "world", "channels", "messages"
COORDINATION = "coordination_error"
DRIFT = 10.0  # [s] an arrow of the current is as long as what drifts in that time
LENGTH = 2.0  # [m] of the arrow that stands for a vehicle
# Okabe and Ito (2008), of 255
COLORS = ((0, 114, 178), (213, 94, 0), (0, 158, 115), (204, 121, 167), (230, 159, 0))
WATER, GRAY, FAINT = (86, 180, 233), (160, 160, 160), 100


def rrd_of(flight: Flight) -> bytes:
    """The flight as a recording with its layout.

    Under `world/NAME`: the moving frames `true` and `believed`, `track_true` and `track_believed`, `path`, `current`
    and `current_estimate`. Then `channels/NAME/CHANNEL`, `channels/coordination_error`, and `messages`.

    Args:
        flight: what was flown.

    Raises:
        InputError: the library is not installed, or the environment has switched it off.
    """
    try:
        import rerun
    except ModuleNotFoundError:
        raise InputError("Rerun needs rerun-sdk: pip install 'cardume[rerun]'") from None
    recording = rerun.RecordingStream("cardume", send_properties=False)
    if not recording.is_enabled():
        raise InputError("the environment variable RERUN switches recording off; unset it, or set it to on")
    memory = recording.memory_recording()
    recording.send_recording_name(flight.mission_name)
    _write_still(recording, WORLD, rerun.ViewCoordinates.FRD)
    for k in range(len(flight.vehicle_names)):
        _write_vehicle(recording, flight, k)
        _write_channels(recording, flight, k)
    if len(flight.vehicle_names) > 1:
        apart = np.ptp(flight.channels["coordination_state"], axis=1)
        _write_scalars(recording, (SCALARS, COORDINATION), flight.times, apart)
    _write_messages(recording, flight)
    recording.send_blueprint(_layout(flight.vehicle_names))
    content: bytes = memory.drain_as_bytes()
    return content


def _entity(*parts: str) -> str:
    """Where something stands in the recording; any name of a vehicle is one part of it."""
    import rerun

    path: str = rerun.new_entity_path(list(parts))
    return path


def _write_still(recording: Any, entity: str, what: Any) -> None:
    """What is so at all times."""
    recording.log(entity, what, static=True, strict=True)


def _write_moving(recording: Any, entity: str, times: np.ndarray, columns: Any) -> None:
    """What has a row for each time."""
    import rerun

    clock = rerun.TimeColumn(TIMELINE, duration=np.asarray(times, float))
    recording.send_columns(entity, [clock], columns, strict=True)


def _write_vehicle(recording: Any, flight: Flight, vehicle: int) -> None:
    """What of one vehicle is seen in three dimensions."""
    import rerun

    name, depths = flight.vehicle_names[vehicle], flight.channels["depth"][:, vehicle]
    for kind, ending in KINDS.items():
        _write_track(recording, flight, vehicle, kind)
        _write_current(recording, flight, vehicle, ending)
    line = flight.own_paths[vehicle]
    if len(line):
        level = float(np.nanmedian(depths)) if np.isfinite(depths).any() else 0.0
        strip = np.column_stack([line, np.full(len(line), level)])
        _write_still(recording, _entity(WORLD, name, "path"), rerun.LineStrips3D([strip], colors=[GRAY]))


def _write_track(recording: Any, flight: Flight, vehicle: int, kind: str) -> None:
    """A frame that moves with a vehicle, what is drawn in it, and a point for each place on its way."""
    import rerun

    name = flight.vehicle_names[vehicle]
    color: tuple[int, ...] = COLORS[vehicle % len(COLORS)]
    places, headings = _places(flight, vehicle, KINDS[kind]), flight.channels["heading"][:, vehicle]
    known = np.isfinite(places).all(axis=1) & np.isfinite(headings)
    if not known.any():
        return
    half = 0.5 * headings[known]  # about the axis z, which points down: clockwise seen from above
    turns = np.column_stack([0.0 * half, 0.0 * half, np.sin(half), np.cos(half)])
    frames = rerun.Transform3D.columns(translation=places[known], quaternion=turns)
    _write_moving(recording, _entity(WORLD, name, kind), flight.times[known], frames)
    if kind == TRUE:
        shape = rerun.Arrows3D(vectors=[[LENGTH, 0.0, 0.0]], radii=[0.2], colors=[color], labels=[name])
    else:
        color = (*color, FAINT)
        shape = rerun.Points3D([[0.0, 0.0, 0.0]], radii=[0.4], colors=[color])
    _write_still(recording, _entity(WORLD, name, kind, "shape"), shape)
    number = int(known.sum())
    points = rerun.Points3D.columns(positions=places[known], colors=[color] * number, radii=[0.1] * number)
    _write_moving(recording, _entity(WORLD, name, f"track_{kind}"), flight.times[known], points)


def _write_current(recording: Any, flight: Flight, vehicle: int, ending: str) -> None:
    """An arrow of the current at a vehicle, or of what it believes of it where it believes to be."""
    import rerun

    north, east = (flight.channels[f"current_{axis}{ending}"][:, vehicle] for axis in ("north", "east"))
    flows, places = np.column_stack([north, east, 0.0 * north]), _places(flight, vehicle, ending)
    known = np.isfinite(flows).all(axis=1) & np.isfinite(places).all(axis=1)
    if known.any():
        colors = [WATER if not ending else (*WATER, FAINT)] * int(known.sum())
        arrows = rerun.Arrows3D.columns(vectors=DRIFT * flows[known], origins=places[known], colors=colors)
        entity = _entity(WORLD, flight.vehicle_names[vehicle], f"current{ending}")
        _write_moving(recording, entity, flight.times[known], arrows)


def _places(flight: Flight, vehicle: int, ending: str) -> np.ndarray:
    """Where a vehicle was or is believed to have been, (time, 3) [m] NED."""
    names = (f"north{ending}", f"east{ending}", "depth")
    return np.column_stack([flight.channels[name][:, vehicle] for name in names])


def _write_channels(recording: Any, flight: Flight, vehicle: int) -> None:
    import rerun

    look = rerun.SeriesLines(colors=[COLORS[vehicle % len(COLORS)]], names=[flight.vehicle_names[vehicle]])
    for channel in CHANNELS:
        parts = (SCALARS, flight.vehicle_names[vehicle], channel)
        if np.isfinite(flight.channels[channel][:, vehicle]).any():
            _write_still(recording, _entity(*parts), look)
        _write_scalars(recording, parts, flight.times, flight.channels[channel][:, vehicle])


def _write_scalars(recording: Any, parts: Sequence[str], times: np.ndarray, values: np.ndarray) -> None:
    """A number over time, where there is one."""
    import rerun

    known = np.isfinite(values)
    if known.any():
        _write_moving(recording, _entity(*parts), times[known], rerun.Scalars.columns(scalars=values[known]))


def _write_messages(recording: Any, flight: Flight) -> None:
    """Each message as a line of text when it was sent."""
    import rerun

    sent = flight.messages["time_sent"]
    if not len(sent):
        return
    texts, levels = [], []
    for message in range(len(sent)):
        sender, receiver, kind = (int(flight.messages[column][message]) for column in ("sender", "receiver", "kind"))
        is_lost = flight.messages["lost"][message] > 0.5
        travel = flight.messages["time_received"][message] - sent[message]
        fate = "lost" if is_lost else f"arrived after {travel:.3f} s"
        names = flight.vehicle_names
        texts.append(f"{names[sender]} to {names[receiver]}: {MESSAGE_KINDS[kind]}, {fate}")
        levels.append("WARN" if is_lost else "INFO")
    _write_moving(recording, MESSAGES, sent, rerun.TextLog.columns(text=texts, level=levels))


def _layout(names: Sequence[str]) -> Any:
    """The sea at the left, with tracks up to the time shown; errors over time and messages at the right."""
    import rerun.blueprint as layout

    past = layout.VisibleTimeRanges(
        timeline=TIMELINE, start=layout.TimeRangeBoundary.infinite(), end=layout.TimeRangeBoundary.cursor_relative()
    )
    tracks = {_entity(WORLD, name, f"track_{kind}"): past for name in names for kind in KINDS}
    errors = [_entity(SCALARS, name, "cross_track") for name in names]
    curves = [layout.TimeSeriesView(name="Cross-track error [m]", origin=SCALARS, contents=errors)]
    if len(names) > 1:
        entity = _entity(SCALARS, COORDINATION)
        curves.append(layout.TimeSeriesView(name="Coordination error [m]", origin=SCALARS, contents=[entity]))
    sea = layout.Spatial3DView(name="Sea", origin=WORLD, overrides=tracks)
    events = layout.TextLogView(name="Messages", origin=MESSAGES)
    return layout.Blueprint(
        layout.Horizontal(sea, layout.Vertical(*curves, events), column_shares=[3, 2]),
        layout.TimePanel(timeline=TIMELINE, state="collapsed"),
    )
