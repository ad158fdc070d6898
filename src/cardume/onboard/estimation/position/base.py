"""Position: from fixes, now and then and late, and dead reckoning between them, to where we are.

A law gets this tick's `Fix` (NaN when there is none) and the believed `Motion`.  The memory's
fields `north` and `east` are set to the vehicle's initial estimate before the first tick.
"""

from cardume.laws import law_family
from cardume.signals import Fix, Motion, NavigationEstimate

position_law, estimate_position = law_family("position", (Fix, Motion), NavigationEstimate)
