"""What is served: the page and its parts, the report of what was flown last, and the line to the page."""

import asyncio
import html
import json
import logging
import secrets
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from importlib import resources
from pathlib import Path
from typing import Any

from tornado.web import HTTPError, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from cardume.lab.folder import Folder
from cardume.lab.guard import HEADERS, Guard
from cardume.lab.session import Session
from cardume.report.page.frame import library
from cardume.report.page.page import make_page

PARTS = {
    "": ("lab.html", "text/html; charset=utf-8"),
    "lab.css": ("lab.css", "text/css; charset=utf-8"),
    **{
        name: (name, "text/javascript; charset=utf-8")
        for name in ("lab.js", "link.js", "controls.js", "charts.js", "tables.js", "points.js", "study.js")
    },
}
MOST_PAGES = 20  # open at once
REFUSED = (
    "<!DOCTYPE html><title>{reason}</title><p>{reason}: open the address that <code>cardume lab</code> printed.</p>"
)


@dataclass(slots=True)
class Lab:
    """What all handlers share."""

    guard: Guard
    folder: Folder
    mission: str
    version: str
    allow_code: tuple[Path, ...] = ()
    sessions: dict[str, Session] = field(default_factory=dict)


class Guarded(RequestHandler):
    """Answers only whoever the guard lets in, and never with more than was asked for."""

    lab: Lab

    def initialize(self, lab: Lab) -> None:
        """Take what is shared."""
        self.lab = lab

    def set_default_headers(self) -> None:
        """Whatever is answered."""
        for name, value in HEADERS.items():
            self.set_header(name, value)

    def prepare(self) -> None:
        """Before anything is done.

        Raises:
            HTTPError: it is not the page that asks.
        """
        self.lab.guard.check(self)
        self.set_header("Content-Security-Policy", self.lab.guard.policy(self.request.host))

    def log_exception(self, typ: Any, value: Any, tb: Any) -> None:
        """A bug is told without the request, whose address holds the token."""
        if not isinstance(value, HTTPError):
            logging.getLogger("cardume.lab").error("a bug in cardume", exc_info=(typ, value, tb))

    def write_error(self, status_code: int, **_given: Any) -> None:
        """A word for people, and nothing of the inside."""
        self.set_header("Content-Security-Policy", "default-src 'none'")
        self.finish(REFUSED.format(reason=self._reason))


class Part(Guarded):
    """The page, its style, its scripts, and the library that draws."""

    def get(self, _token: str, name: str) -> None:
        """One part.

        Raises:
            HTTPError: there is no such part.
        """
        if name == "plotly.js":
            self.set_header("Content-Type", "text/javascript; charset=utf-8")
            self.set_header("Cache-Control", "private, max-age=3600")
            self.finish(library())
        elif name in PARTS:
            file, kind = PARTS[name]
            self.set_header("Content-Type", kind)
            text = (resources.files("cardume.lab.page") / file).read_text(encoding="utf-8")
            self.finish(text.replace("$mission", html.escape(self.lab.mission)) if name == "" else text)
        else:
            raise HTTPError(404, reason="No such page")


class Report(Guarded):
    """The report of what a page flew last, as `cardume run` would leave it."""

    async def get(self, _token: str, page: str) -> None:
        """One page's report.

        Raises:
            HTTPError: no such page, or it has flown nothing yet.
        """
        session = self.lab.sessions.get(page)
        run = session.last_run() if session is not None else None
        if run is None or run.mission is None:
            raise HTTPError(404, reason="Nothing was flown there yet")
        whole = replace(run, text=run.mission.to_yaml(self.lab.folder.root))
        text = await asyncio.get_running_loop().run_in_executor(None, make_page, whole)
        self.clear_header("Content-Security-Policy")  # it has its own, which allows its own scripts by their hashes
        self.set_header("Content-Type", "text/html; charset=utf-8")
        self.finish(text)


class Line(WebSocketHandler, Guarded):
    """The line to one page; what it says is done by a `Session`."""

    session: Session | None = None
    name = ""

    def prepare(self) -> None:
        """Before the line is open.

        Raises:
            HTTPError: it is not the page that asks, or too many pages are open.
        """
        self.lab.guard.check(self, needs_origin=True)
        if len(self.lab.sessions) >= MOST_PAGES:
            raise HTTPError(503, reason="Too many pages are open")

    def check_origin(self, origin: str) -> bool:
        """The guard did."""
        return True

    def open(self, *_given: str) -> None:
        """A page is there."""
        loop = asyncio.get_running_loop()

        def tell(answer: dict[str, Any]) -> None:
            text = json.dumps(answer, allow_nan=False, separators=(",", ":"))
            _call_soon(loop, lambda: self._send(text))

        self.name = secrets.token_urlsafe(12)
        self._send(json.dumps({"is": "named", "name": self.name}))
        self.session = Session(self.lab.folder, tell, self.lab.version, self.lab.allow_code)
        self.lab.sessions[self.name] = self.session

    def on_message(self, message: str | bytes) -> None:
        """The page asks for something."""
        try:
            asked = json.loads(message)
        except (ValueError, RecursionError):
            asked = None
        if not isinstance(asked, dict) or self.session is None:
            self.close(1003, "not understood")
            return
        self.session.ask(asked)

    def on_close(self) -> None:
        """The page is gone."""
        self.lab.sessions.pop(self.name, None)
        if self.session is not None:
            self.session.close()

    def _send(self, text: str) -> None:
        with suppress(WebSocketClosedError):  # it is gone already
            self.write_message(text)


def _call_soon(loop: asyncio.AbstractEventLoop, what: Callable[[], None]) -> None:
    with suppress(RuntimeError):  # the laboratory has ended meanwhile
        loop.call_soon_threadsafe(what)
