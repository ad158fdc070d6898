"""Acoustics: what becomes of a transmission on its way to one receiver.

A law gets a `Link` (range, two uniform draws, time and bytes) and gives an `Arrival`.  Each pair of listener and sender
has a memory of its own; one that changes it does so only where `sent` is 1.
"""

from cardume.laws import law_family
from cardume.signals import Arrival, Link

acoustics_law, propagate = law_family("acoustics", (Link,), Arrival)
