"""What a mission file says of a current beside a law's numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from cardume.missions.schema import NOT_NEGATIVE, Bounds, Quantity


@dataclass(frozen=True, slots=True, kw_only=True)
class CurrentPoint:
    """The current at one depth of a `sheared` one; fixed, because missions in one batch share the table."""

    depth: Annotated[float, Quantity("m", Bounds(0.0, 12_000.0), fixed=True), "below the surface"]
    speed: Annotated[float, Quantity("m/s", NOT_NEGATIVE, fixed=True), "of the water"]
    towards: Annotated[float, Quantity("rad", fixed=True), "where it flows to, clockwise from north"] = 0.0
