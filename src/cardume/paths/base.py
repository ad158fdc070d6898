"""Reference points: the point of the path that a vehicle is compared with.

A law gets a `Place` (position and path table) and the believed `Motion`, and gives a `PathError`; the
vehicle's speed and the end of the mission are filled in by the agent.  So is `path_speed`, where a
law leaves it NaN: the rate of gamma for the point abeam of the vehicle.
"""

from cardume.laws import law_family
from cardume.signals import Motion, PathError, Place

reference_point_law, find_reference_point = law_family("reference_point", (Place, Motion), PathError)
