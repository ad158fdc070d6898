"""Messaging schedules."""

from cardume.onboard.messaging.base import decide_to_send, messaging_law
from cardume.onboard.messaging.periodic import periodic
from cardume.onboard.messaging.silent import silent

__all__ = ["decide_to_send", "messaging_law", "periodic", "silent"]
