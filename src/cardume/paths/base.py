"""Reference points: the point of the path that a vehicle is compared with.

A law gets a `Place` (position and path table) and gives a `PathError`; the vehicle's speed and the
end of the mission are filled in by the agent.
"""

from cardume.laws import law_family
from cardume.signals import PathError, Place

reference_point_law, find_reference_point = law_family("reference_point", (Place,), PathError)
