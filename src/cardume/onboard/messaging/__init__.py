"""Messaging schedules."""

from cardume.onboard.messaging.base import decide_to_send, messaging_law
from cardume.onboard.messaging.event_triggered import event_triggered
from cardume.onboard.messaging.periodic import periodic
from cardume.onboard.messaging.polling import polling
from cardume.onboard.messaging.silent import silent
from cardume.onboard.messaging.tdma import tdma

__all__ = ["decide_to_send", "event_triggered", "messaging_law", "periodic", "polling", "silent", "tdma"]
