"""What stands before every page: sizes, hosts, rates and the headers that tell a browser what not to do.

It is written to the interface of ASGI itself, so that a request that is refused costs next to
nothing.
"""

import asyncio
import time
import tomllib
from collections import OrderedDict
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple
from urllib.parse import parse_qsl

from starlette.requests import Request
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

BODY = 16_384  # bytes of a form: a ballot has a few hundred
PATIENCE = 10.0  # seconds for a form to arrive
FIELDS = 64
HEADERS: dict[str, str] = tomllib.loads(Path(__file__).with_name("headers.toml").read_text("utf8"))


class Refusal(Exception):
    """A request that is not answered: the status, and a sentence for a person."""

    def __init__(self, status: int, said: str) -> None:
        super().__init__(said)
        self.status = status
        self.said = said


class Rate(NamedTuple):
    """So many at once, and then so many a second."""

    burst: float
    per_second: float


class Rates:
    """Who has done how much lately; the longest unseen are forgotten beyond `most` names."""

    def __init__(self, *, clock: Callable[[], float] = time.monotonic, most: int = 20_000) -> None:
        self._clock = clock
        self._most = most
        self._seen: OrderedDict[tuple[str, str], tuple[float, float]] = OrderedDict()

    def take(self, kind: str, who: str, rate: Rate) -> bool:
        """Return whether there is room for one more, and count it."""
        now = self._clock()
        left, then = self._seen.pop((kind, who), (rate.burst, now))
        left = min(rate.burst, left + (now - then) * rate.per_second)
        self._seen[kind, who] = (left - 1 if left >= 1 else left, now)
        if len(self._seen) > self._most:
            self._seen.popitem(last=False)
        return left >= 1


class Guard:
    """The application with `HEADERS` on every answer, for one host's name alone."""

    def __init__(self, app: ASGIApp, *, host: str, secure: bool) -> None:
        self._app = app
        self._host = host.lower()
        self._headers = [(name.lower().encode(), value.encode()) for name, value in HEADERS.items()]
        if secure:
            self._headers.append((b"strict-transport-security", b"max-age=31536000"))

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request."""
        if scope["type"] != "http":
            return await self._app(scope, receive, send)

        async def answer(message: Message) -> None:
            if message["type"] == "http.response.start":
                own = {name for name, _ in message["headers"]}
                extra = [one for one in self._headers if one[0] not in own]
                message = {**message, "headers": [*message["headers"], *extra]}
            await send(message)

        hosts = [
            value.decode("latin-1").lower() for name, value in scope["headers"] if name == b"host"
        ]
        if hosts != [self._host]:
            return await PlainTextResponse("This gallery has another address.\n", 421)(
                scope, receive, answer
            )
        await self._app(scope, receive, answer)


async def form(request: Request) -> list[tuple[str, str]]:
    """Return the fields of a form, or raise a Refusal for what is none, is too large, or takes too long."""
    if (
        request.headers.get("content-type", "").split(";")[0].strip()
        != "application/x-www-form-urlencoded"
    ):
        raise Refusal(415, "This is not a form of the gallery.")
    try:
        async with asyncio.timeout(PATIENCE):
            body = await _body(request)
    except TimeoutError:
        raise Refusal(408, "The form took too long to arrive.") from None
    try:
        return parse_qsl(
            body.decode("ascii"), keep_blank_values=True, max_num_fields=FIELDS, errors="strict"
        )
    except ValueError:
        raise Refusal(400, "This form cannot be read.") from None


async def _body(request: Request) -> bytes:
    body = b""
    # counted as it comes: a header may claim anything
    async for piece in request.stream():
        body += piece
        if len(body) > BODY:
            raise Refusal(413, "This form is too large.")
    return body


def same_origin(request: Request, origin: str) -> None:
    """Raise a Refusal for a form of another site: every browser names the origin of a form it posts."""
    site = request.headers.get("sec-fetch-site", "same-origin")
    if request.headers.getlist("origin") != [origin] or site != "same-origin":
        raise Refusal(403, "This form did not come from the gallery.")
