"""Position: from fixes, now and then and late, and dead reckoning between them, to where we are.

A law gets this tick's `Fix` (NaN when there is none) and the believed `Motion`.  The memory's
fields `north` and `east` are set to the vehicle's initial estimate before the first tick.  A fix that
was valid before the last one is kept from a law, unless its memory has a field `fixes`.
What of its estimate a law does not know may be left out: the current, and the covariance.
"""

from cardume.laws import law_family
from cardume.signals import Fix, Motion, NavigationEstimate

position_law, estimate_position = law_family("position", (Fix, Motion), NavigationEstimate, may_leave_out=True)
