"""The gallery as a web application: a wall, a closer look, two beside each other, a ballot, and results.

Every answer is a page, a picture or a line of JSON. Nothing is uploaded here and nobody signs up:
artifacts and voters come by the command line. Addresses hold no state, pages no inline script or
style.
"""

import mimetypes
import sqlite3
from collections.abc import Mapping
from contextlib import asynccontextmanager
from datetime import datetime
from typing import Any

from markupsafe import Markup
from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import JSONResponse, RedirectResponse, Response
from starlette.routing import Route
from starlette.types import ASGIApp

from hdrlab.course.gallery import ballots, pictures, store, tokens
from hdrlab.course.gallery.web.front import HERE, HINTS, Front
from hdrlab.course.gallery.web.guard import Guard, Rate, Refusal, form, same_origin

KEPT = 60 * 60 * 24 * 180  # seconds for which a browser stays signed in
FOREVER = "private, max-age=31536000, immutable"
BALLOTS = Rate(30, 1)  # of a voter
SPENT = "This link has been used. It works once. If you cannot get in, ask your instructor for a new one."


class Gallery(Front):
    """The pages."""

    async def wall(self, request: Request) -> Response:
        """Show all artifacts, in the voter's own order, with the voter's ballot."""
        voter, shown = self.voter(request)
        set_up = store.settings(self.db)
        hung = store.artifacts(self.db)
        when, chosen = ballots.read_ballot(self.db, voter.id)
        order = tokens.shuffled(list(hung), set_up.secret, voter.id)
        may = set_up.is_open(self.clock())
        key = tokens.form_key(shown)
        each = [
            (hung[id], {"own": hung[id].team == voter.team, "chosen": id in chosen}) for id in order
        ]
        cards = [Markup(self.card(one=one, open=may, **said)) for one, said in each]
        at = (
            None
            if when is None
            else store.format_time(datetime.fromtimestamp(when, set_up.closes.tzinfo))
        )
        marks = set_up.marks
        count = len(chosen)
        return self.page("wall.html", cards=cards, marks=marks, chosen=count, when=at, key=key)

    async def ballot(self, request: Request) -> Response:
        """Take a ballot, which replaces the one before, and answer when it is on the disk."""
        same_origin(request, self.origin)
        voter, shown = self.voter(request)
        if not self.rates.take("ballots", voter.id, BALLOTS):
            raise Refusal(
                429, "Too many changes at once. Your last ballot counts. Try again later."
            )
        fields = await form(request)
        keys = [value for name, value in fields if name == "key"]
        if keys != [tokens.form_key(shown)]:
            raise Refusal(403, "This form is too old, or it is not yours. Open the gallery again.")
        marked = [value for name, value in fields if name == "mark"]
        try:
            count = await self.writer.do(
                lambda db: ballots.cast(db, voter.id, marked, now=self.clock())
            )
        except ballots.NotAccepted as reason:
            raise Refusal(409, str(reason)) from None
        if "application/json" in request.headers.get("accept", ""):
            when = datetime.fromtimestamp(self.clock(), store.settings(self.db).closes.tzinfo)
            return JSONResponse({"votes": count, "when": f"{when:%H:%M:%S}"})
        return RedirectResponse("/", 303)

    async def link(self, request: Request) -> Response:
        """Show a button for a personal link: a mail's preview, which fetches links ahead, spends none."""
        token = request.path_params["token"]
        if tokens.whose(self.db, token, "link"):
            return self.page("enter.html", token=token)
        voter = tokens.whose(self.db, request.cookies.get(self.cookie, ""))
        if voter and voter.id == tokens.spent_by(self.db, token):
            return RedirectResponse("/", 303)
        self.failed(request)
        raise Refusal(404, SPENT)

    async def enter(self, request: Request) -> Response:
        """Take a personal link, once, and begin a session."""
        same_origin(request, self.origin)
        token = request.path_params["token"]
        entered = await self.writer.do(lambda db: tokens.spend(db, token))
        if entered is None:
            self.failed(request)
            raise Refusal(404, SPENT)
        response = RedirectResponse("/", 303)
        response.set_cookie(
            self.cookie,
            entered[1],
            max_age=KEPT,
            path="/",
            secure=self.secure,
            httponly=True,
            samesite="lax",
        )
        return response

    async def look(self, request: Request) -> Response:
        """Show one artifact closely, between its neighbours in the voter's order."""
        voter, _ = self.voter(request)
        hung = store.artifacts(self.db)
        order = tokens.shuffled(list(hung), store.settings(self.db).secret, voter.id)
        id = request.path_params["id"]
        if id not in hung:
            raise Refusal(404, HINTS[404])
        at = order.index(id)
        near: dict[str, Any] = {"before": order[at - 1], "after": order[(at + 1) % len(order)]}
        return self.page("look.html", shown=[hung[id]], place=at + 1, count=len(order), **near)

    async def compare(self, request: Request) -> Response:
        """Show two artifacts beside each other."""
        self.voter(request)
        hung = store.artifacts(self.db)
        wanted = request.query_params.getlist("with")
        if len(set(wanted)) != 2 or not set(wanted) <= hung.keys():
            raise Refusal(400, "Choose two artifacts on the wall, and compare again.")
        return self.page("look.html", shown=[hung[id] for id in wanted], place=0, count=len(hung))

    async def picture(self, request: Request) -> Response:
        """Send a picture that this program has encoded."""
        self.voter(request)
        id = request.path_params["id"]
        size = request.path_params["size"]
        if size not in pictures.SIZES or not store.hangs(self.db, id):
            raise Refusal(404, HINTS[404])
        data = self.bytes_of(pictures.place(self.folder / store.PICTURES, id, size))
        return Response(data, media_type="image/webp", headers={"Cache-Control": FOREVER})

    async def results(self, request: Request) -> Response:
        """Show the places, after the end and not before."""
        self.voter(request)
        set_up = store.settings(self.db)
        hung = store.artifacts(self.db)
        if set_up.is_open(self.clock()):
            closes = store.format_time(set_up.closes)
            raise Refusal(403, f"The results are shown after the vote has closed: {closes}.")
        cast = [one for one in ballots.every(self.db).values() if one]
        rows = [(row, hung[row.artifact]) for row in ballots.standings(hung, cast)]
        method = ballots.METHOD.format(marks=set_up.marks)
        voters = store.voters(self.db)
        return self.page("results.html", rows=rows, cast=len(cast), voters=voters, method=method)

    async def static(self, request: Request) -> Response:
        """Send a style sheet or a script; anybody may have them."""
        file = HERE / "static" / request.path_params["name"]
        if not file.is_file():
            raise Refusal(404, HINTS[404])
        kind, _ = mimetypes.guess_type(file.name)
        return Response(
            self.bytes_of(file), media_type=kind, headers={"Cache-Control": "max-age=300"}
        )


def application(gallery: Gallery) -> ASGIApp:
    """Return the pages as an ASGI application, which closes the gallery when it ends."""

    @asynccontextmanager
    async def life(app: Starlette) -> Any:
        yield
        await gallery.close()

    routes = [
        Route("/", gallery.wall),
        Route("/ballot", gallery.ballot, methods=["POST"]),
        Route("/enter/{token}", gallery.link),
        Route("/enter/{token}", gallery.enter, methods=["POST"]),
        Route("/look/{id}", gallery.look),
        Route("/compare", gallery.compare),
        Route("/picture/{id}/{size}", gallery.picture),
        Route("/results", gallery.results),
        Route("/static/{name}", gallery.static),
    ]
    handlers: Mapping[Any, Any] = dict.fromkeys(
        (Refusal, HTTPException, sqlite3.Error), gallery.refused
    )
    app = Starlette(routes=routes, exception_handlers=handlers, lifespan=life)
    return Guard(app, host=gallery.host, secure=gallery.secure)
