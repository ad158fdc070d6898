"""The laboratory's server: one process, this machine only, until Ctrl-C."""

import asyncio
import logging
import signal
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path

from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets
from tornado.web import Application

from cardume.errors import InputError
from cardume.lab.folder import Folder
from cardume.lab.guard import ADDRESS, Guard
from cardume.lab.handlers import Lab, Line, Part, Report
from cardume.missions.source import MAX_BYTES

LARGEST_MESSAGE = MAX_BYTES + 500_000  # a mission file, and what was changed in it
LARGEST_BODY = 0  # everything that a page says goes over its line
LARGEST_HEAD = 16_384
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
FAREWELL = 2.0  # [s] for what flies to end


def serve(
    folder: Folder,
    mission: str,
    version: str,
    *,
    port: int = 0,
    allow_code: tuple[Path, ...] = (),
    ready: Callable[[str], None] = lambda address: None,
) -> None:
    """Serve until a signal ends it.

    Args:
        folder: that may be read and written.
        mission: that pages open first.
        version: of cardume.
        port: 0 for any that is free.
        allow_code: folders from which laws may be imported.
        ready: called once with the address, when pages can be opened.

    Raises:
        InputError: the port is taken.
    """
    asyncio.run(_serve(Lab(Guard(port), folder, mission, version, allow_code), ready))


async def _serve(lab: Lab, ready: Callable[[str], None]) -> None:
    stopped, loop = asyncio.Event(), asyncio.get_running_loop()
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:  # as nohup wants it
            loop.add_signal_handler(number, stopped.set)
    async with running(lab):
        ready(lab.guard.address)
        await stopped.wait()


@asynccontextmanager
async def running(lab: Lab) -> AsyncIterator[None]:
    """Serve while a block runs; what flies then ends with it.

    Args:
        lab: what to serve; its guard learns the port.

    Raises:
        InputError: the port is taken.
    """
    for name in ("tornado.access", "tornado.general"):
        logging.getLogger(name).setLevel(logging.CRITICAL)  # their lines would hold the token
    try:
        sockets = bind_sockets(lab.guard.port, ADDRESS)
    except OSError as problem:
        raise InputError(f"port {lab.guard.port} cannot be used: {problem.strerror}; leave --port out") from None
    lab.guard = Guard(sockets[0].getsockname()[1], lab.guard.token)
    server = HTTPServer(
        application(lab), max_body_size=LARGEST_BODY, max_header_size=LARGEST_HEAD, idle_connection_timeout=600
    )
    server.add_sockets(sockets)
    loop = asyncio.get_running_loop()
    try:
        yield
    finally:
        server.stop()
        sessions = list(lab.sessions.values())
        for session in sessions:
            session.close()
        await asyncio.gather(*(loop.run_in_executor(None, session.close, FAREWELL) for session in sessions))
        await server.close_all_connections()


def application(lab: Lab) -> Application:
    """What answers at each address.

    Args:
        lab: what all share.
    """
    given = {"lab": lab}
    return Application(
        [
            (r"/([^/]*)/line", Line, given),
            (r"/([^/]*)/report/([\w-]*)", Report, given),
            (r"/([^/]*)/(.*)", Part, given),
            (r"/()(.*)", Part, given),
        ],
        websocket_max_message_size=LARGEST_MESSAGE,
        websocket_ping_interval=20,
    )
