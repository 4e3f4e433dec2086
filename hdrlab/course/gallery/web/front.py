"""What every page of the gallery stands on: who asks, how fast, and how an answer is written."""

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
# in memory: what a class looks at again and again
KEPT_FILES = 400
KEPT_CARDS = 4000
REQUESTS = guard.Rate(600, 20)  # of a voter: a wall of hundreds of pictures, at once
FAILURES = guard.Rate(30, 0.5)  # of an address, with links or sessions that are none
HINTS = {404: "This page does not exist.", 405: "This page does not accept this request."}


class Front:
    """One folder's gallery at one address."""

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
        self.bytes_of = lru_cache(KEPT_FILES)(Path.read_bytes)
        self.card = lru_cache(KEPT_CARDS)(self.pages.get_template("card.html").render)

    async def close(self) -> None:
        """Write what waits, and let go of the database."""
        await self.writer.close()
        self.db.close()

    def page(self, name: str, status: int = 200, **words: Any) -> HTMLResponse:
        """Return a page."""
        set_up = store.settings(self.db)
        closes = store.format_time(set_up.closes)
        known = {"title": set_up.title, "open": set_up.is_open(self.clock()), "closes": closes}
        return HTMLResponse(self.pages.get_template(name).render(known | words), status)

    def voter(self, request: Request) -> tuple[store.Voter, tokens.Shown]:
        """Return who asks, or raise a Refusal."""
        text = request.cookies.get(self.cookie, "")
        shown = tokens.read(text)
        voter = tokens.whose(self.db, text)
        if voter is None or shown is None:
            if text:
                self.failed(request)
            raise guard.Refusal(
                401, "To see the gallery, open the personal link that your course sent you."
            )
        if not self.rates.take("requests", voter.id, REQUESTS):
            raise guard.Refusal(429, "Too many requests at once. Wait a moment, and try again.")
        return voter, shown

    def failed(self, request: Request) -> None:
        """Count a link or session that is none; after many of them raise another Refusal.

        What is good passes always: a class behind one address is not locked out by one of it.
        """
        if not self.rates.take("failures", request.client.host if request.client else "", FAILURES):
            raise guard.Refusal(
                429, "Too many attempts from this address. Wait a minute, and try again."
            )

    async def refused(self, request: Request, error: Exception) -> Response:
        """Say why, in a page or in JSON."""
        if isinstance(error, guard.Refusal):
            status = error.status
            why = error.said
        else:
            status = error.status_code if isinstance(error, HTTPException) else 500
            why = HINTS.get(status, "Something went wrong. Your last ballot counts.")
        if "application/json" in request.headers.get("accept", ""):
            return JSONResponse({"error": why}, status)
        return self.page("word.html", status, why=why, known=status != 401)
