"""Acoustics: what becomes of a transmission on its way to one receiver.

A law gets a `Link` (range and two uniform draws) and gives an `Arrival`.
"""

from cardume.laws import law_family
from cardume.signals import Arrival, Link

acoustics_law, propagate = law_family("acoustics", (Link,), Arrival)
