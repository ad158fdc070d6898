"""MAVLink mission commands, as QGroundControl plans and WPL lists hold them, to waypoints.

The list is executed as an autopilot would: jumps are taken, and a change of speed holds from there on.

Source: MAVLink common message set, mavlink.io/en/messages/common.html#mav_commands.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from cardume.errors import MissionError, Position, Problem
from cardume.missions.formats.waypoints import DEEPEST, Waypoint, check_place, geo
from cardume.paths.table import MAX_SEGMENTS

WAYPOINT, JUMP, CHANGE_SPEED = 16, 177, 178
UNCHANGED, OWN_SPEED = -1.0, -2.0  # [m/s] as a speed to change to
PLACES = {
    16: "",
    17: "flown through, without staying there",
    18: "flown through, without circling there",
    19: "flown through, without staying there",
    21: "flown to, without landing",
    22: "flown to, without taking off",
    31: "flown through, without circling there",
    36: "flown to on a straight leg, not on an arc",
    82: "flown to on a straight leg, not on a spline",
    84: "flown to, without taking off",
    85: "flown to, without landing",
    94: "flown to, without placing anything",
}
"""Commands that lead to a place, and what is not done there."""

NAMES = {
    16: "NAV_WAYPOINT", 17: "NAV_LOITER_UNLIM", 18: "NAV_LOITER_TURNS", 19: "NAV_LOITER_TIME",
    20: "NAV_RETURN_TO_LAUNCH", 21: "NAV_LAND", 22: "NAV_TAKEOFF", 23: "NAV_LAND_LOCAL", 24: "NAV_TAKEOFF_LOCAL",
    25: "NAV_FOLLOW", 30: "NAV_CONTINUE_AND_CHANGE_ALT", 31: "NAV_LOITER_TO_ALT", 34: "DO_ORBIT",
    36: "NAV_ARC_WAYPOINT", 80: "NAV_ROI", 82: "NAV_SPLINE_WAYPOINT", 83: "NAV_ALTITUDE_WAIT",
    84: "NAV_VTOL_TAKEOFF", 85: "NAV_VTOL_LAND", 92: "NAV_GUIDED_ENABLE", 93: "NAV_DELAY", 94: "NAV_PAYLOAD_PLACE",
    112: "CONDITION_DELAY", 113: "CONDITION_CHANGE_ALT", 114: "CONDITION_DISTANCE", 115: "CONDITION_YAW",
    176: "DO_SET_MODE", 177: "DO_JUMP", 178: "DO_CHANGE_SPEED", 179: "DO_SET_HOME", 180: "DO_SET_PARAMETER",
    181: "DO_SET_RELAY", 182: "DO_REPEAT_RELAY", 183: "DO_SET_SERVO", 184: "DO_REPEAT_SERVO",
    186: "DO_CHANGE_ALTITUDE", 187: "DO_SET_ACTUATOR", 189: "DO_LAND_START", 191: "DO_GO_AROUND",
    192: "DO_REPOSITION", 193: "DO_PAUSE_CONTINUE", 194: "DO_SET_REVERSE", 195: "DO_SET_ROI_LOCATION",
    196: "DO_SET_ROI_WPNEXT_OFFSET", 197: "DO_SET_ROI_NONE", 200: "DO_CONTROL_VIDEO", 201: "DO_SET_ROI",
    202: "DO_DIGICAM_CONFIGURE", 203: "DO_DIGICAM_CONTROL", 204: "DO_MOUNT_CONFIGURE", 205: "DO_MOUNT_CONTROL",
    206: "DO_SET_CAM_TRIGG_DIST", 207: "DO_FENCE_ENABLE", 208: "DO_PARACHUTE", 211: "DO_GRIPPER",
    212: "DO_AUTOTUNE_ENABLE", 213: "NAV_SET_YAW_SPEED", 214: "DO_SET_CAM_TRIGG_INTERVAL",
    215: "DO_SET_RESUME_REPEAT_DIST", 216: "DO_SPRAYER", 217: "DO_SEND_SCRIPT_MESSAGE", 218: "DO_AUX_FUNCTION",
    222: "DO_GUIDED_LIMITS", 223: "DO_ENGINE_CONTROL", 224: "DO_SET_MISSION_CURRENT", 300: "MISSION_START",
    400: "COMPONENT_ARM_DISARM", 530: "SET_CAMERA_MODE", 531: "SET_CAMERA_ZOOM", 532: "SET_CAMERA_FOCUS",
    600: "JUMP_TAG", 601: "DO_JUMP_TAG", 1000: "DO_GIMBAL_MANAGER_PITCHYAW", 2000: "IMAGE_START_CAPTURE",
    2001: "IMAGE_STOP_CAPTURE", 2003: "DO_TRIGGER_CONTROL", 2500: "VIDEO_START_CAPTURE",
    2501: "VIDEO_STOP_CAPTURE", 5000: "NAV_FENCE_RETURN_POINT", 5001: "NAV_FENCE_POLYGON_VERTEX_INCLUSION",
    5002: "NAV_FENCE_POLYGON_VERTEX_EXCLUSION", 5003: "NAV_FENCE_CIRCLE_INCLUSION",
    5004: "NAV_FENCE_CIRCLE_EXCLUSION", 5100: "NAV_RALLY_POINT", 42600: "DO_WINCH", 42702: "NAV_SCRIPT_TIME",
}  # fmt: skip
"""What messages call the commands that missions commonly hold."""

SEA_FRAMES = {0: "above the sea", 3: "above home", 5: "above the sea", 6: "above home"}
TERRAIN_FRAMES = (10, 11)
OTHER_FRAMES = {1: "local NED", 4: "local ENU", 7: "NED from the vehicle", 8: "body NED", 9: "body offset NED"}
OTHER_FRAMES |= {2: "no place at all", 12: "body FRD", 20: "local FRD", 21: "local FLU"}
MOST_STEPS = 20 * MAX_SEGMENTS


@dataclass(frozen=True, kw_only=True, slots=True)
class Command:
    """One item of a mission list.

    Attributes:
        number: by which jumps name it.
        code: MAV_CMD.
        frame: MAV_FRAME, which says what its altitude is above.
        parameters: the seven, in the units of the command; NaN where the file leaves one open.
        label: what messages call it, such as "item 3".
        position: where in its file it stands.
    """

    number: int
    code: int
    frame: int
    parameters: tuple[float, float, float, float, float, float, float]
    label: str
    position: Position

    @property
    def name(self) -> str:
        """What the command is called."""
        return NAMES.get(self.code, f"command {self.code}")


def to_waypoints(commands: Sequence[Command]) -> tuple[list[Waypoint], list[str]]:
    """Execute a mission list.

    Args:
        commands: in the order of the file.

    Returns:
        The waypoints that it passes, and what of it is not flown.

    Raises:
        MissionError: a place that is none, a jump that leads nowhere, or a list that never ends.
    """
    return _Execution(commands).run()


def speed_changes(speeds: Sequence[float | None]) -> Iterator[float | None]:
    """For the waypoint at the end of each leg the DO_CHANGE_SPEED before it: None, where there is to be none.

    Args:
        speeds: [m/s] of the legs; None: not known, the vehicle's own.
    """
    before: float | None = None
    for speed in speeds:
        yield None if speed == before else OWN_SPEED if speed is None else speed
        before = speed


def written_place(degrees: tuple[float, float]) -> tuple[float, float]:
    """A place as a command gives it: 0, 0 would mean where the vehicle is, so one there is a centimeter beside it.

    Args:
        degrees: latitude and longitude.
    """
    return (0.0, 1e-7) if max(map(abs, degrees)) < 1e-7 else degrees


@dataclass(slots=True)
class _Execution:
    """Steps through a list, and keeps what it passes."""

    commands: Sequence[Command]
    waypoints: list[Waypoint] = field(default_factory=list)
    speed: float | None = None
    jumps: dict[int, int] = field(default_factory=dict)
    not_flown: dict[tuple[str, str], dict[str, None]] = field(default_factory=dict)

    def run(self) -> tuple[list[Waypoint], list[str]]:
        """Every step, from the first command on."""
        numbers: Mapping[int, int] = {command.number: index for index, command in enumerate(self.commands)}
        at = steps = 0
        while at < len(self.commands):
            command, steps = self.commands[at], steps + 1
            at = self._jump(command, at, numbers) if command.code == JUMP else at + 1
            if command.code == CHANGE_SPEED:
                self._change_speed(command)
            elif command.code in PLACES:
                self._pass(command)
            elif command.code != JUMP:
                self._note(command, "not flown")
            if self.jumps and (len(self.waypoints) > MAX_SEGMENTS + 1 or steps > MOST_STEPS):
                raise self._too_many()
        return self.waypoints, [_sentence(name, what, list(labels)) for (name, what), labels in self.not_flown.items()]

    def _note(self, command: Command, what: str) -> None:
        self.not_flown.setdefault((command.name, what), {})[command.label] = None

    def _jump(self, command: Command, at: int, numbers: Mapping[int, int]) -> int:
        target, repeats = command.parameters[:2]
        if target not in numbers:
            known = f"{min(numbers)} to {max(numbers)}"
            raise _error(command, f"{command.name} leads to {target:g}; the list has the numbers {known}")
        if repeats != repeats:
            raise _error(command, f"{command.name} does not say how often; give its second parameter, -1: without end")
        if repeats < 0.0:
            self._note(command, "repeats without end: taken once")
        limit, taken = 1.0 if repeats < 0.0 else repeats, self.jumps.get(at, 0)
        if taken >= limit:
            return at + 1
        self.jumps[at] = taken + 1
        return numbers[int(target)]

    def _too_many(self) -> MissionError:
        at = max(self.jumps, key=lambda index: self.jumps[index], default=0)
        command = self.commands[at]
        return _error(
            command,
            f"{command.name} repeats {command.parameters[1]:g} times; with it the path has more than"
            f" {MAX_SEGMENTS:,} legs: let it repeat less often",
        )

    def _change_speed(self, command: Command) -> None:
        kind, speed = command.parameters[:2]
        if kind in (2.0, 3.0):
            self._note(command, "climbing and diving speeds are not flown")
        elif speed > 0.0 and math.isfinite(speed):
            self.speed = speed
        elif speed == OWN_SPEED:
            self.speed = None
        elif speed != UNCHANGED:
            self._note(command, f"a speed of {speed:g} m/s is not flown")

    def _pass(self, command: Command) -> None:
        latitude, longitude, altitude = command.parameters[4:]
        if _is_open(latitude, longitude):
            self._note(command, "names no place: not flown")
            return
        if command.frame not in SEA_FRAMES and command.frame not in TERRAIN_FRAMES:
            meaning = OTHER_FRAMES.get(command.frame, "unknown")
            raise _error(
                command,
                f"{command.name} is in frame {command.frame}, {meaning}; a place on the Earth is needed: frames"
                f" {', '.join(map(str, (*SEA_FRAMES, *TERRAIN_FRAMES)))}",
            )
        problem = check_place(latitude, longitude)
        if problem:
            raise _error(command, problem)
        if PLACES[command.code]:
            self._note(command, PLACES[command.code])
        if command.code in (WAYPOINT, 82) and command.parameters[0] > 0.0:
            self._note(command, "flown through, without waiting there")
        self.waypoints.append(
            Waypoint(
                place=geo(latitude, longitude),
                speed=self.speed,
                depth=self._depth(command, altitude),
                label=command.label,
                position=command.position,
            )
        )

    def _depth(self, command: Command, altitude: float) -> float | None:
        """A negative altitude is a depth; home is taken to lie at the surface."""
        if altitude != altitude:
            return None
        if not abs(altitude) < math.inf:
            raise _error(command, f"altitude is {altitude:g} m; it must be finite")
        if command.frame in TERRAIN_FRAMES:
            self._note(command, "altitudes above the seabed are not flown")
            return None
        if -altitude > DEEPEST:
            raise _error(command, f"altitude is {altitude:g} m; no sea is deeper than {DEEPEST:g} m")
        if altitude > 0.0:
            self._note(command, "altitudes above the surface are not flown")
        return max(-altitude, 0.0)


def _is_open(latitude: float, longitude: float) -> bool:
    """Whether a command leaves its place open: 0, 0 is where the vehicle is."""
    return (latitude != latitude and longitude != longitude) or (latitude == 0.0 and longitude == 0.0)


def _error(command: Command, message: str) -> MissionError:
    return MissionError([Problem(command.position, message)])


def _sentence(name: str, what: str, labels: Sequence[str]) -> str:
    shown = ", ".join([labels[0], *(label.split()[-1] for label in labels[1:4])])
    more = f" and {len(labels) - 4} more" if len(labels) > 4 else ""
    return f"{name} ({shown}{more}): {what}"
