"""From a track to what may be written into a mission, and how far to trust it."""

import math
from dataclasses import dataclass

import numpy as np

from cardume.errors import DataError
from cardume.missions.calibration.fit import Fit, calibrated_speed, fit
from cardume.missions.calibration.legs import SETTLING, SHORTEST, legs_of
from cardume.missions.calibration.track import Track

TOO_WIDE = 0.1  # of the scale: wider, the data do not tell it
ENOUGH_SPEEDS = 1.3  # [-] fastest over slowest leg, for drag beside the scale
ENOUGH_TURN = math.radians(60.0)  # between the two most different headings of the legs
FEW_LEGS = 4


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """A value and the half width of its 95 % interval.

    The interval is that of noise. What (37) leaves out, the sway and the accelerations of a vehicle that wanders about
    its path, comes on top: 0.1 to 1 % of the scale in flights of `medusa` with noisy fixes.
    """

    value: float
    half_width: float

    @property
    def is_known(self) -> bool:
        """Whether the data tell it at all."""
        return math.isfinite(self.half_width)

    def holds(self, truth: float) -> bool:
        """Whether a value lies in the interval."""
        return abs(self.value - truth) <= self.half_width


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """What a track says of its vehicle's calibration.

    Attributes:
        name: of the vehicle.
        num_legs: [-] steady parts.
        used: [s] of the way.
        total: [s] all of it.
        slowest, fastest: [m/s] legs, by the believed numbers.
        headings: [rad] between the two most different legs; NaN without headings.
        scale: [-] to write as `thruster_speed.scale`; true over believed speed.
        speed_factor: [-] a of (38) as the mission had it, believed over true speed; 1 is right.
        current_north, current_east: [m/s] none for a measured speed.
        linear_drag, quadratic_drag: [N s/m], [N s^2/m^2] for the believed thrust; none where the speeds are too alike.
        residual, drag_residual: [m], or [m/s] for a measured speed; root mean square of what each fit leaves.
        explained: [-] share of the variance that the scale explains.
        warnings: what the data cannot tell, and why.
    """

    name: str
    num_legs: int
    used: float
    total: float
    slowest: float
    fastest: float
    headings: float
    scale: Estimate
    speed_factor: float
    current_north: Estimate | None
    current_east: Estimate | None
    linear_drag: Estimate | None
    quadratic_drag: Estimate | None
    residual: float
    drag_residual: float
    explained: float
    warnings: tuple[str, ...]

    @property
    def is_usable(self) -> bool:
        """Whether the scale is known well enough to be written into a mission."""
        return self.scale.half_width <= TOO_WIDE * abs(self.scale.value)


def calibrate(track: Track) -> Calibration:
    """Fit a track.

    Args:
        track: of one vehicle.

    Raises:
        DataError: no part of it is steady.
    """
    legs = legs_of(track) if len(track.time) > 3 else []
    if not legs:
        raise DataError(
            f"{track.name} has no steady part: at least {SETTLING + SHORTEST:g} s at one shaft speed and, where there"
            " are headings, without a turn; a calibration wants some of these, at several speeds and headings"
        )
    speeds = np.array([_mean_speed(leg) for leg in legs])
    slowest, fastest = float(np.abs(speeds).min()), float(np.abs(speeds).max())
    by_scale = fit(legs, "scale")
    by_drag: Fit | None = fit(legs, "drag") if fastest >= ENOUGH_SPEEDS * slowest else None
    headings = _spread(legs)
    scale = _estimate(by_scale, 0)
    return Calibration(
        name=track.name,
        num_legs=len(legs),
        used=float(sum(leg.time[-1] - leg.time[0] for leg in legs)),
        total=float(track.time[-1] - track.time[0]),
        slowest=slowest,
        fastest=fastest,
        headings=headings,
        scale=scale,
        speed_factor=track.numbers.scale / scale.value if scale.value else math.inf,
        current_north=_estimate(by_scale, 1) if len(by_scale.values) > 1 else None,
        current_east=_estimate(by_scale, 2) if len(by_scale.values) > 1 else None,
        linear_drag=_estimate(by_drag, 0) if by_drag else None,
        quadratic_drag=_estimate(by_drag, 1) if by_drag else None,
        residual=by_scale.residual,
        drag_residual=by_drag.residual if by_drag else math.nan,
        explained=by_scale.explained,
        warnings=tuple(_warnings(legs, scale, slowest, fastest, headings)),
    )


def _estimate(of: Fit, place: int) -> Estimate:
    return Estimate(value=float(of.values[place]), half_width=float(of.half_widths[place]))


def _mean_speed(leg: Track) -> float:
    numbers = leg.numbers
    thrust = numbers.thrust(leg.shaft_speed)
    return float(calibrated_speed(thrust, numbers.linear_drag, numbers.quadratic_drag).mean())


def _spread(legs: list[Track]) -> float:
    """The largest angle [rad] between the mean headings of two legs."""
    if legs[0].speed is not None or any(leg.heading is None for leg in legs):
        return math.nan
    means = np.array([np.mean(np.exp(1j * leg.heading)) for leg in legs if leg.heading is not None])
    return float(np.abs(np.angle(means[:, None] / means[None, :])).max())


def _warnings(legs: list[Track], scale: Estimate, slowest: float, fastest: float, headings: float) -> list[str]:
    alike = fastest < ENOUGH_SPEEDS * slowest
    found = []
    if math.isfinite(headings) and headings < ENOUGH_TURN:
        found.append(
            f"all legs head within {math.degrees(headings):.0f} deg of each other, so speed and current are hard to"
            " tell apart; fly legs there and back, or round a square"
        )
    if alike:
        found.append(
            f"all legs have nearly the same speed, {slowest:.2g} to {fastest:.2g} m/s, so the drag cannot be told, and"
            " the scale holds at that speed only; fly some legs at half or twice the speed"
        )
    if len(legs) < FEW_LEGS:
        found.append(f"only {len(legs)} steady legs: the intervals may be too narrow; {FEW_LEGS} or more are better")
    if not scale.half_width <= TOO_WIDE * abs(scale.value):
        width = "without limit" if not scale.is_known else f"+-{100.0 * scale.half_width / abs(scale.value):.0f} %"
        found.append(f"the scale is not known well enough to be used: {width}")
    return found
