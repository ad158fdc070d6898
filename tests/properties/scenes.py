"""Scenes for properties: missions as text, in which every place and direction can be moved, turned or mirrored."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

EXACT = (
    "{gnss: {sigma: 0 m, deepest: 100 m}, ahrs: {heading_sigma: 0 rad, yaw_rate_sigma: 0 rad/s, attitude_sigma: 0 rad},"
    " depth: {sigma: 0 m}, thruster_speed: {sigma: 0}}"
)
BELOW = EXACT.replace("gnss: {sigma: 0 m, deepest: 100 m}, ", "")  # knows its position from the others only
HEAD = BELOW.replace("{ahrs", "{gnss: {sigma: 0 m}, usbl: {range_sigma: 0 m, angle_sigma: 0 rad}, ahrs")


@dataclass(frozen=True)
class Member:
    """One vehicle: an absolute start and belief, so that a scene has places to transform."""

    name: str
    starboard: float = 0.0  # [m]
    ahead: float = 0.0  # [m]
    north: float = 0.0  # [m] start, from the path's start
    east: float = 0.0
    heading: float = 0.0  # [rad]
    misbelief: tuple[float, float] = (0.0, 0.0)  # [m] initial estimate less the start
    depth: float = 0.0
    sensors: str = "ideal"


@dataclass(frozen=True)
class Scene:
    """What a mission holds that has a place, a direction or a side."""

    members: tuple[Member, ...]
    model: str = "medusa"
    shape: str = "lawnmower"
    north: float = 0.0  # [m] the path's start
    east: float = 0.0
    course: float = 0.0  # [rad]
    side: float = 1.0  # +1: the first turn is to starboard
    current: float = 0.07  # [m/s]
    towards: float = 0.8  # [rad]
    guidance: str = "line_of_sight"
    duration: float = 150.0  # [s]

    def moved(self, north: float, east: float) -> Scene:
        """The scene elsewhere."""
        members = [replace(m, north=m.north + north, east=m.east + east) for m in self.members]
        return replace(self, north=self.north + north, east=self.east + east, members=tuple(members))

    def turned(self, angle: float) -> Scene:
        """The scene turned clockwise about the origin."""
        north, east = turn(self.north, self.east, angle)
        members = []
        for m in self.members:
            there = turn(m.north, m.east, angle)
            misbelief = turn(*m.misbelief, angle)
            members.append(replace(m, north=there[0], east=there[1], heading=m.heading + angle, misbelief=misbelief))
        return replace(
            self,
            north=north,
            east=east,
            course=self.course + angle,
            towards=self.towards + angle,
            members=tuple(members),
        )

    def mirrored(self) -> Scene:
        """The scene in a mirror that stands along the north axis: east is west, starboard is port."""
        members = [
            replace(
                m,
                starboard=-m.starboard,
                east=-m.east,
                heading=-m.heading,
                misbelief=(m.misbelief[0], -m.misbelief[1]),
            )
            for m in self.members
        ]
        return replace(
            self,
            east=-self.east,
            course=-self.course,
            side=-self.side,
            towards=-self.towards,
            members=tuple(members),
        )

    def text(self) -> str:
        """The mission file."""
        return "\n".join(
            [
                "cardume: 1",
                "name: scene",
                f"duration: {self.duration!r} s",
                f"path: {self._path()}",
                "formation: {speed: 0.47 m/s}",
                f"current: {{type: uniform, speed: {self.current!r} m/s, towards: {self.towards!r} rad}}",
                f"model: {self.model}",
                f"guidance: {{law: {self.guidance}}}",
                "compensation: {law: crab}",
                "current_observer: {law: complementary}",
                "position: {law: reset_compensated}",
                "coordination: {law: laplacian_tanh, gain: 0.1 m/s, topology: complete}",
                "messaging: {schedule: periodic, period: 1 s}",
                "acoustics: {channel: bernoulli, loss: 0, delay: 0.3 s}",
                "vehicles:",
                *[self._member(m) for m in self.members],
            ]
        )

    def _path(self) -> str:
        turn_word = "starboard" if self.side > 0.0 else "port"
        start = f"start: {{north: {self.north!r} m, east: {self.east!r} m, course: {self.course!r} rad}}"
        if self.shape == "circle":
            # the centre lies abeam of the start, 14.3 m to the side of the turn
            north, east = turn(0.0, 14.3 * self.side, self.course)
            centre = f"centre: {{north: {self.north + north!r} m, east: {self.east + east!r} m}}"
            bearing = self.course - self.side * 0.5 * math.pi
            return f"{{type: circle, {centre}, radius: 14.3 m, turn: {turn_word}, start_bearing: {bearing!r} rad}}"
        if self.shape == "segments":
            arc = f"{{arc: 11.3 m, turn: {turn_word}, angle: 1.1 rad}}"
            return f"{{type: segments, {start}, segments: [{{line: 17.3 m}}, {arc}, {{line: 80.1 m}}]}}"
        if self.shape == "lemniscate":
            # the path starts at the first tip, across the axis
            axis = self.course - self.side * 0.5 * math.pi
            north, east = turn(-25.7, 0.0, axis)
            centre = f"centre: {{north: {self.north + north!r} m, east: {self.east + east!r} m}}"
            return f"{{type: lemniscate, {centre}, half_width: 25.7 m, axis: {axis!r} rad, turn: {turn_word}}}"
        if self.shape == "spline":
            places = [
                turn(n, self.side * e, self.course) for n, e in ((0.0, 0.0), (21.3, 9.7), (43.1, -8.9), (90.3, 4.1))
            ]
            points = ", ".join(f"{{north: {self.north + n!r}, east: {self.east + e!r}}}" for n, e in places)
            return f"{{type: spline, points: [{points}]}}"
        return f"{{type: lawnmower, {start}, leg: 23.7 m, legs: 3, spacing: 21.9 m, turn: {turn_word}}}"

    def _member(self, m: Member) -> str:
        north, east = m.north + m.misbelief[0], m.east + m.misbelief[1]
        lines = [
            f"  - name: {m.name}",
            f"    depth: {m.depth!r} m",
            f"    offset: {{starboard: {m.starboard!r} m, ahead: {m.ahead!r} m}}",
            f"    start: {{north: {m.north!r} m, east: {m.east!r} m, heading: {m.heading!r} rad, speed: 0.1 m/s}}",
            f"    sensors: {m.sensors}",
        ]
        if m.misbelief != (0.0, 0.0):
            lines.append(f"    initial_estimate: {{north: {north!r} m, east: {east!r} m}}")
        return "\n".join(lines)


def turn(north: Any, east: Any, angle: float) -> tuple[Any, Any]:
    """A vector, or many, turned clockwise."""
    s, c = math.sin(angle), math.cos(angle)
    return c * north - s * east, s * north + c * east


def formation(sensors: Sequence[str], depths: Sequence[float]) -> tuple[Member, ...]:
    """Three vehicles that start off their paths, with wrong headings; one believes that it is elsewhere."""
    return (
        Member("alpha", 0.0, 0.7, -2.1, 1.3, 0.4, (0.0, 0.0), depths[0], sensors[0]),
        Member("bravo", -3.1, 0.0, -4.7, -5.3, -0.3, (1.9, -2.3), depths[1], sensors[1]),
        Member("charlie", 2.9, -0.4, 0.6, 4.1, 0.2, (0.0, 0.0), depths[2], sensors[2]),
    )
