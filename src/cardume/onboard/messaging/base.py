"""Messaging: when a vehicle speaks.

A law gets its `Outbox` and gives 1 to send now, 0 to keep silent.  One that asks for a `Question` speaks in turn, asked
by the vehicle with the USBL head; for one that asks for a `Forecast` the vehicle follows what the others make of what
it last said.
"""

from cardume.laws import law_family
from cardume.signals import Forecast, Outbox, Question

messaging_law, decide_to_send = law_family("messaging", (Outbox, Question, Forecast))
