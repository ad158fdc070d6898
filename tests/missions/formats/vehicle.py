"""A boat of a few lines that speaks MAVLink on loopback, so that MAVSDK has a system to import missions for."""

import socket
import threading
from types import TracebackType
from typing import Any

BOAT, BASE_MODE, STANDBY = 11, 1, 3  # MAV_TYPE_SURFACE_BOAT, custom mode enabled, MAV_STATE_STANDBY
REQUEST_MESSAGE, REQUEST_CAPABILITIES = 512, 520
CAN_MISSION_INT = 4  # MAV_PROTOCOL_CAPABILITY_MISSION_INT
ACCEPTED = 0
PX4, ARDUPILOT = 12, 3  # MAV_AUTOPILOT


def free_port() -> int:
    """A UDP port of loopback that nobody uses."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


class Boat:
    """Sends heartbeats, says what it can do, and takes missions that are uploaded to it."""

    def __init__(self, port: int, autopilot: int = PX4) -> None:
        from pymavlink import mavutil
        from pymavlink.dialects.v20 import common

        self.dialect, self.autopilot = common, autopilot
        mavutil.set_dialect("common")
        self.link = mavutil.mavlink_connection(f"udpout:127.0.0.1:{port}", source_system=1, source_component=1)
        self.mission: list[Any] = []
        self.expected = 0
        self.is_done = threading.Event()
        self.is_stopped = threading.Event()
        self.thread = threading.Thread(target=self._sail, daemon=True)

    def __enter__(self) -> "Boat":
        self.thread.start()
        return self

    def __exit__(self, _kind: type | None, _error: BaseException | None, _trace: TracebackType | None) -> None:
        self.is_stopped.set()
        self.thread.join()
        self.link.close()

    def _sail(self) -> None:
        while not self.is_stopped.is_set():
            self.link.mav.heartbeat_send(BOAT, self.autopilot, BASE_MODE, 0, STANDBY)
            while (message := self.link.recv_match(blocking=True, timeout=0.1)) is not None:
                self._answer(message)

    def _answer(self, message: Any) -> None:
        kind, send = message.get_type(), self.link.mav
        if kind in ("COMMAND_LONG", "COMMAND_INT"):
            send.command_ack_send(message.command, ACCEPTED)
            if message.command in (REQUEST_MESSAGE, REQUEST_CAPABILITIES):
                send.autopilot_version_send(CAN_MISSION_INT, 1, 1, 1, 1, bytes(8), bytes(8), bytes(8), 0, 0, 0)
        elif kind == "MISSION_COUNT":
            self.mission, self.expected = [], message.count
            self._request(message)
        elif kind == "MISSION_ITEM_INT" and message.seq == len(self.mission):
            self.mission.append(message)
            self._request(message)

    def _request(self, message: Any) -> None:
        """Ask for the next item, or say that all are here."""
        sender = (message.get_srcSystem(), message.get_srcComponent())
        if len(self.mission) < self.expected:
            self.link.mav.mission_request_int_send(*sender, len(self.mission), message.mission_type)
        else:
            self.link.mav.mission_ack_send(*sender, ACCEPTED, message.mission_type)
            self.is_done.set()
