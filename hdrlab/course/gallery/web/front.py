"""The base of the gallery's application: voters, rates, pages and refusals."""

import time
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, Response

from hdrlab.course.gallery import store, tokens
from hdrlab.course.gallery.web import guard, writer
from hdrlab.errors import InputError
from hdrlab.show.pages.templates import templates

HERE = Path(__file__).parent
# kept in memory, for a class looks at them again and again
MAX_CACHED_FILES = 400
MAX_CACHED_CARDS = 4000
# of a voter: a wall of hundreds of pictures loads at once
REQUEST_RATE = guard.Rate(burst=600, per_second=20)
# of an address, with links or sessions that are not valid
FAILURE_RATE = guard.Rate(burst=30, per_second=0.5)
STATUS_MESSAGES = {404: "This page does not exist.", 405: "This page does not accept this request."}


class Front:
    """The gallery of one folder, served at one address."""

    def __init__(
        self, folder: str | Path, address: str, clock: Callable[[], float] = time.time
    ) -> None:
        parts = urlsplit(address)
        if parts.scheme not in ("http", "https") or not parts.netloc or parts.path not in ("", "/"):
            raise InputError(
                f"expected an address such as https://vote.example.edu, got {address!r}"
            )
        self.host = parts.netloc
        self.secure = parts.scheme == "https"
        self.origin = f"{parts.scheme}://{parts.netloc}"
        self.cookie = "__Host-gallery" if self.secure else "gallery"
        self.folder = Path(folder)
        self.clock = clock
        self.rates = guard.Rates()
        self.db = store.connect(folder)
        self.writer = writer.Writer(folder)
        self.pages = templates(HERE / "templates")
        self.bytes_of = lru_cache(MAX_CACHED_FILES)(Path.read_bytes)
        self.card = lru_cache(MAX_CACHED_CARDS)(self.pages.get_template("card.html").render)

    async def close(self) -> None:
        """Write what waits, and close the database."""
        await self.writer.close()
        self.db.close()

    def page(self, name: str, status: int = 200, **context: Any) -> HTMLResponse:
        """Render the template of a page."""
        settings = store.settings(self.db)
        shared = {
            "title": settings.title,
            "open": settings.is_open(self.clock()),
            "closes": store.format_time(settings.closes),
        }
        return HTMLResponse(self.pages.get_template(name).render(shared | context), status)

    def voter(self, request: Request) -> tuple[store.Voter, tokens.PresentedToken]:
        """Return the voter of a request, and the token of the session.

        Raises
        ------
        guard.Refusal
            For a request without a valid session, and after too many requests.
        """
        text = request.cookies.get(self.cookie, "")
        session = tokens.read(text)
        voter = tokens.whose(self.db, text)
        if voter is None or session is None:
            if text:
                self.count_failure(request)
            raise guard.Refusal(
                401, "To see the gallery, open the personal link that your course sent you."
            )
        if not self.rates.take("requests", voter.id, REQUEST_RATE):
            raise guard.Refusal(429, "Too many requests at once. Wait a moment, and try again.")
        return voter, session

    def count_failure(self, request: Request) -> None:
        """Count an invalid link or session of an address, and refuse the request after too many.

        Valid requests are never refused for it, so one student cannot lock out a class that has the
        same address.
        """
        address = request.client.host if request.client else ""
        if not self.rates.take("failures", address, FAILURE_RATE):
            raise guard.Refusal(
                429, "Too many attempts from this address. Wait a minute, and try again."
            )

    async def refused(self, request: Request, error: Exception) -> Response:
        """Answer a request that failed, with a page or with JSON that says why."""
        if isinstance(error, guard.Refusal):
            status = error.status
            message = error.message
        else:
            status = error.status_code if isinstance(error, HTTPException) else 500
            message = STATUS_MESSAGES.get(status, "Something went wrong. Your last ballot counts.")
        if "application/json" in request.headers.get("accept", ""):
            return JSONResponse({"error": message}, status)
        return self.page("word.html", status, why=message, known=status != 401)
