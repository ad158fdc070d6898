"""What later fixes say of a recording: the smoother of missions/smoothing.py over what a vehicle was given."""

import math
from typing import NamedTuple

import numpy as np

from cardume.missions.recordings.playing import Believed
from cardume.missions.smoothing import Doubt, Seen, smooth
from cardume.signals import Fix, Motion
from cardume.simulation.plan import Choice


class Smoothed(NamedTuple):
    """Where a vehicle was, by all fixes before and after."""

    times: np.ndarray  # (row,) [s]
    means: np.ndarray  # (row, 4) [m], [m/s] position and current, north and east
    covariances: np.ndarray  # (row, 4, 4)
    position_error_rms: float  # [m] NaN: no truth
    left_out: int  # [-] ranges, of which a smoother of positions makes nothing


def look_back(believed: Believed, position: Choice, start: tuple[float, float], period: float) -> Smoothed:
    """Smooth a replay.

    Args:
        believed: what the vehicle was given, and how it moved.
        position: its law, whose thoughts of the noise are taken where it has any.
        start: [m] north and east where it began.
        period: [s] between rows, to which the moments of fixes are added.
    """
    b, dt = believed, believed.times[1] - believed.times[0]
    motion = Motion(*b.motion.T)
    heading = motion.heading + 0.5 * dt * motion.yaw_rate
    north = motion.surge * np.cos(heading) - motion.sway * np.sin(heading)
    east = motion.surge * np.sin(heading) + motion.sway * np.cos(heading)
    way = np.vstack([np.zeros(2), dt * np.cumsum(np.column_stack([north, east]), axis=0)[:-1]])
    sigma = position.value_or("fix_sigma", 1.0)
    fixes = [(int(row), Fix(*b.fixes[row])) for row in np.flatnonzero(np.isfinite(b.fixes[:, 0]))]
    places = [(max(0, round(row - fix.age / dt)), fix) for row, fix in fixes if math.isnan(fix.level_range)]
    rows = np.unique([*range(0, len(b.times), max(1, round(period / dt))), *(row for row, _ in places)])
    seen = [Seen(int(np.searchsorted(rows, row)), np.array([f.north, f.east]), _noise(f, sigma)) for row, f in places]
    usual = Doubt()
    doubt = Doubt(*(position.value_or(name, getattr(usual, name)) for name in Doubt._fields))
    track = smooth(b.times[rows], way[rows], seen, start=np.array(start), doubt=doubt)
    away = np.hypot(*(track.means[:, :2] - b.truth[rows]).T)
    known = away[np.isfinite(away)]
    rms = math.sqrt(float(np.mean(known**2))) if len(known) else math.nan
    return Smoothed(b.times[rows], track.means, track.covariances, rms, len(fixes) - len(places))


def _noise(fix: Fix, sigma: float) -> np.ndarray:
    """(2, 2) [m^2] covariance of a fix, of one that does not tell it that which is thought of all."""
    told = np.array([[fix.north_variance, fix.covariance], [fix.covariance, fix.east_variance]])
    return told + 1e-6 * np.eye(2) if np.isfinite(told).all() else sigma**2 * np.eye(2)
