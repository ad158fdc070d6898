"""Current observers: from position and velocity through the water to the current.

A law gets the believed position and `Motion`, and gives the current [m/s].
"""

from cardume.laws import law_family
from cardume.signals import Motion, NavigationEstimate, Water

current_observer_law, observe = law_family("current_observer", (NavigationEstimate, Motion), Water)
