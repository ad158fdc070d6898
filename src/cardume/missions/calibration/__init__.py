"""Calibration: from a run's log, or a table from the sea, to how fast the vehicle goes at which shaft speed.

for track in read_tracks(Path("log.nc")):
    print(calibrate(track).scale)
"""

from cardume.missions.calibration.calibrating import Calibration, calibrate
from cardume.missions.calibration.reading import read_tracks
from cardume.missions.calibration.track import Numbers, Track

__all__ = ["Calibration", "Numbers", "Track", "calibrate", "read_tracks"]
