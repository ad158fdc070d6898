"""Who may speak to the laboratory: the browser of the person who started it, on this machine, and nobody else."""

import hmac
import secrets
from dataclasses import dataclass, field

from tornado.web import HTTPError, RequestHandler

ADDRESS = "127.0.0.1"
NAMES = (ADDRESS, "localhost")  # a tunnel or a person may call it either

# Nothing from elsewhere, and no script but our own; charts need inline styles.
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
    "connect-src 'self' {sockets}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
    "Server": "cardume",
}


@dataclass(frozen=True)
class Guard:
    """The secret in the address, and where it is served.

    Attributes:
        port: of this machine.
        token: of this laboratory alone.
    """

    port: int
    token: str = field(default_factory=lambda: secrets.token_urlsafe(32), repr=False)

    @property
    def address(self) -> str:
        """What a browser opens."""
        return f"http://{ADDRESS}:{self.port}/{self.token}/"

    @property
    def hosts(self) -> tuple[str, ...]:
        """What the Host header may say."""
        return tuple(f"{name}:{self.port}" for name in NAMES)

    def check(self, handler: RequestHandler, needs_origin: bool = False) -> None:
        """Refuse whoever does not come from the page itself.

        Args:
            handler: of a request.
            needs_origin: whether a browser always says where such a request comes from.

        Raises:
            HTTPError: 403, and why.
        """
        headers = handler.request.headers
        if headers.get("Host", "") not in self.hosts:
            raise HTTPError(403, reason="Foreign Host")
        origin = headers.get("Origin")
        if (origin is None and needs_origin) or (origin is not None and not self._is_own(origin, headers["Host"])):
            raise HTTPError(403, reason="Foreign Origin")
        given = handler.path_args[0] if handler.path_args else ""
        if not hmac.compare_digest(given.encode("utf-8", "replace"), self.token.encode("ascii")):
            raise HTTPError(403, reason="Wrong or missing token")

    def _is_own(self, origin: str, host: str) -> bool:
        return origin == f"http://{host}"

    def policy(self, host: str) -> str:
        """The content security policy of the page.

        Args:
            host: by which it was asked for.
        """
        return POLICY.format(sockets=f"ws://{host}")
