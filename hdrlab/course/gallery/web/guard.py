"""Protect every page of the gallery: check hosts, forms and rates, and add security headers.

The guard uses the ASGI interface directly, so that a refused request costs next to nothing.
"""

import asyncio
import time
import tomllib
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import parse_qsl

from starlette.requests import Request
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

MAX_FORM_BYTES = 16_384  # a ballot has a few hundred
FORM_TIMEOUT_SECONDS = 10.0
MAX_FORM_FIELDS = 64
MAX_REMEMBERED_CLIENTS = 20_000
FORM_TYPE = "application/x-www-form-urlencoded"
HSTS_HEADER = (b"strict-transport-security", b"max-age=31536000")
SECURITY_HEADERS: dict[str, str] = tomllib.loads(
    Path(__file__).with_name("headers.toml").read_text("utf8")
)


class Refusal(Exception):
    """A request is refused, with an HTTP status and a sentence for the reader."""

    def __init__(self, status: int, message: str) -> None:
        super().__init__(message)
        self.status = status
        self.message = message


@dataclass(frozen=True)
class Rate:
    """A limit of a token bucket: so many requests at once, and so many a second after that."""

    burst: float
    per_second: float


class Rates:
    """Count the requests of each client; the clients that were idle longest are forgotten.

    Parameters
    ----------
    clock : function that returns the time in seconds
    most : number of clients that are remembered
    """

    def __init__(
        self,
        *,
        clock: Callable[[], float] = time.monotonic,
        most: int = MAX_REMEMBERED_CLIENTS,
    ) -> None:
        self._clock = clock
        self._most = most
        # (kind, client) -> requests left, and when that was; the client seen last is at the end
        self._buckets: OrderedDict[tuple[str, str], tuple[float, float]] = OrderedDict()

    def take(self, kind: str, client: str, rate: Rate) -> bool:
        """Count one more request of a client, and return whether the rate allows it."""
        now = self._clock()
        left, counted_at = self._buckets.pop((kind, client), (rate.burst, now))
        left = min(rate.burst, left + (now - counted_at) * rate.per_second)
        is_allowed = left >= 1
        if is_allowed:
            left -= 1
        self._buckets[kind, client] = (left, now)
        if len(self._buckets) > self._most:
            self._buckets.popitem(last=False)
        return is_allowed


class Guard:
    """Add `SECURITY_HEADERS` to every answer, and answer requests for one host name only."""

    def __init__(self, app: ASGIApp, *, host: str, secure: bool) -> None:
        self._app = app
        self._host = host.lower()
        self._headers = [
            (name.lower().encode(), value.encode()) for name, value in SECURITY_HEADERS.items()
        ]
        if secure:
            self._headers.append(HSTS_HEADER)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request."""
        if scope["type"] != "http":
            return await self._app(scope, receive, send)

        async def answer(message: Message) -> None:
            if message["type"] == "http.response.start":
                present = {name for name, _ in message["headers"]}
                extra = [(name, value) for name, value in self._headers if name not in present]
                message = {**message, "headers": [*message["headers"], *extra]}
            await send(message)

        hosts = [
            value.decode("latin-1").lower() for name, value in scope["headers"] if name == b"host"
        ]
        if hosts != [self._host]:
            refusal = PlainTextResponse("This gallery has another address.\n", 421)
            return await refusal(scope, receive, answer)
        await self._app(scope, receive, answer)


async def form(request: Request) -> list[tuple[str, str]]:
    """Read the fields of a form.

    Raises
    ------
    Refusal
        For a request that has no form, and for a form that is too large, takes too long to arrive,
        or cannot be read.
    """
    content_type = request.headers.get("content-type", "").split(";")[0].strip()
    if content_type != FORM_TYPE:
        raise Refusal(415, "This is not a form of the gallery.")
    try:
        async with asyncio.timeout(FORM_TIMEOUT_SECONDS):
            body = await _body(request)
    except TimeoutError:
        raise Refusal(408, "The form took too long to arrive.") from None
    try:
        return parse_qsl(
            body.decode("ascii"),
            keep_blank_values=True,
            max_num_fields=MAX_FORM_FIELDS,
            errors="strict",
        )
    except ValueError:
        raise Refusal(400, "This form cannot be read.") from None


async def _body(request: Request) -> bytes:
    """Read the body of a request, and refuse it once it is too large."""
    body = b""
    # the bytes are counted as they arrive, for the content-length header may be wrong
    async for piece in request.stream():
        body += piece
        if len(body) > MAX_FORM_BYTES:
            raise Refusal(413, "This form is too large.")
    return body


def same_origin(request: Request, origin: str) -> None:
    """Raise a Refusal for a form from another site; browsers state the origin of each form."""
    site = request.headers.get("sec-fetch-site", "same-origin")
    if request.headers.getlist("origin") != [origin] or site != "same-origin":
        raise Refusal(403, "This form did not come from the gallery.")
