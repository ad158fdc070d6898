"""Messaging: when a vehicle speaks.

A law gets its `Outbox` and gives 1 to send now, 0 to keep silent.
"""

from cardume.laws import law_family
from cardume.signals import Outbox

messaging_law, decide_to_send = law_family("messaging", (Outbox,))
