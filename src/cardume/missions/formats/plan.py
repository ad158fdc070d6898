"""What every path file becomes, whatever its format."""

from dataclasses import dataclass

from cardume.missions.geodesy import GeoPoint
from cardume.paths.segment import ReferencePath


@dataclass(frozen=True, kw_only=True, slots=True)
class Member:
    """A vehicle of the formation, as a path file knows it.

    Attributes:
        id: its number in the file.
        ahead, starboard: [m] its offset from the reference path.
        depth: [m] that the file asks for; None: it asks for none.
        depths: arc length on the reference path and depth there [m], where the depth changes along it.
    """

    id: int
    ahead: float = 0.0
    starboard: float = 0.0
    depth: float | None = None
    depths: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True, kw_only=True, slots=True)
class Fence:
    """An area that a plan keeps to or keeps out of.

    Attributes:
        corners: of a polygon, or the center of a circle.
        radius: [m] of a circle; 0 for a polygon.
        is_inclusion: whether vehicles are to stay inside.
    """

    corners: tuple[GeoPoint, ...]
    radius: float = 0.0
    is_inclusion: bool = True


@dataclass(frozen=True, kw_only=True, slots=True)
class Plan:
    """A reference path on the Earth, and who flies beside it.

    Attributes:
        source: the file.
        origin: where north = east = 0 lies.
        segments: the reference path in local axes, with its speeds.
        members: of the formation.
        notes: what of the file is not flown, one sentence each.
        name: what the file calls it; may be empty.
        fences: areas that the file names.
    """

    source: str
    origin: GeoPoint
    segments: ReferencePath
    members: tuple[Member, ...]
    notes: tuple[str, ...] = ()
    name: str = ""
    fences: tuple[Fence, ...] = ()

    @property
    def region(self) -> Fence | None:
        """The area that is not to be left: the first that includes; the others nobody looks at."""
        areas = (fence for fence in self.fences if fence.radius > 0.0 or len(fence.corners) > 2)
        return next((fence for fence in areas if fence.is_inclusion), None)
