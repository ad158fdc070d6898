"""A laboratory served from a thread of the test, and people of all kinds who speak to it."""

import asyncio
import http.client
import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tornado.httpclient import HTTPRequest
from tornado.websocket import WebSocketClientConnection, websocket_connect

from cardume.lab.folder import open_folder
from cardume.lab.guard import Guard
from cardume.lab.handlers import Lab
from cardume.lab.server import running

PATIENCE = 200.0  # [s] the first law may have to be compiled


@contextmanager
def serving(folder: Path, mission: str = "kinematic/line", allow_code: tuple[Path, ...] = ()) -> Iterator[Lab]:
    """A laboratory that ends with the block."""
    lab = Lab(Guard(0), open_folder(folder), mission, "1.2.3", allow_code)
    begun, loop, over = threading.Event(), asyncio.new_event_loop(), asyncio.Event()

    async def serve() -> None:
        async with running(lab):
            begun.set()
            await over.wait()

    thread = threading.Thread(target=loop.run_until_complete, args=(serve(),), daemon=True)
    thread.start()
    assert begun.wait(30.0)
    try:
        yield lab
    finally:
        loop.call_soon_threadsafe(over.set)
        thread.join(30.0)
        loop.close()


def get(lab: Lab, path: str, method: str = "GET", **headers: str) -> tuple[int, str, dict[str, str]]:
    """Status, text and headers of what is answered; `Host` is right unless given."""
    connection = http.client.HTTPConnection("127.0.0.1", lab.guard.port, timeout=30)
    connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
    for name, value in ({"Host": f"127.0.0.1:{lab.guard.port}"} | headers).items():
        connection.putheader(name.replace("_", "-"), value)
    connection.endheaders()
    answer = connection.getresponse()
    text = answer.read().decode("utf-8", "replace")
    connection.close()
    return answer.status, text, dict(answer.getheaders())


class Caller:
    """Speaks over the line as the page does.

    Args:
        lab: that serves.
        headers: of the request that opens the line; `Origin` is right unless given.
    """

    def __init__(self, lab: Lab, token: str | None = None, **headers: str) -> None:
        port = lab.guard.port
        address = f"ws://127.0.0.1:{port}/{lab.guard.token if token is None else token}/line"
        headers = {"Origin": f"http://127.0.0.1:{port}"} | headers
        self.loop = asyncio.new_event_loop()
        request = HTTPRequest(address, headers={name: value for name, value in headers.items() if value})
        self.line: WebSocketClientConnection = self.loop.run_until_complete(_connect(request))

    def say(self, **message: Any) -> None:
        """Ask for something."""
        self.send(json.dumps(message))

    def send(self, text: str) -> None:
        """Send a text as it is."""

        async def send() -> None:
            await self.line.write_message(text)

        self.loop.run_until_complete(send())

    def hear(self, *kinds: str) -> dict[str, Any]:
        """The next answer of one of these kinds; others are passed over."""
        while True:
            told = self.loop.run_until_complete(asyncio.wait_for(_read(self.line), PATIENCE))
            assert told is not None, "the line was closed"
            answer: dict[str, Any] = json.loads(told)
            if answer["is"] in kinds:
                return answer

    def ends(self) -> int | None:
        """How the line was closed, once it is."""
        while self.loop.run_until_complete(asyncio.wait_for(_read(self.line), PATIENCE)) is not None:
            pass
        return self.line.close_code

    def close(self) -> None:
        """Leave."""
        self.line.close()
        self.loop.run_until_complete(asyncio.sleep(0.05))
        self.loop.close()


async def _connect(request: HTTPRequest) -> WebSocketClientConnection:
    return await websocket_connect(request)


async def _read(line: WebSocketClientConnection) -> Any:
    return await line.read_message()


@contextmanager
def calling(lab: Lab, **headers: str) -> Iterator[Caller]:
    """A caller that leaves when the block ends."""
    caller = Caller(lab, **headers)
    try:
        yield caller
    finally:
        caller.close()
