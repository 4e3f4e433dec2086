"""The gallery's web application: the wall or a pair, artifacts in detail, the ballot, the results.

Every answer is a page, a picture or a line of JSON. Nobody uploads anything here or signs up:
instructors add artifacts and voters on the command line. Addresses hold no state, and pages have no
inline script or style.
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

from hdrlab.course.gallery import agreement, ballots, pairs, pictures, store, tokens
from hdrlab.course.gallery.web.front import HERE, STATUS_MESSAGES, Front
from hdrlab.course.gallery.web.guard import Guard, Rate, Refusal, form, same_origin

# for which a browser stays signed in
SESSION_SECONDS = 60 * 60 * 24 * 180
PICTURE_CACHE_CONTROL = "private, max-age=31536000, immutable"
STATIC_CACHE_CONTROL = "max-age=300"
# of a voter
BALLOT_RATE = Rate(burst=30, per_second=1)
USED_LINK_MESSAGE = (
    "This link has been used. It works once. "
    "If you cannot get in, ask your instructor for a new one."
)


class Gallery(Front):
    """The pages of the gallery."""

    async def home(self, request: Request) -> Response:
        """Show the next pair, in a gallery that asks about pairs; otherwise, the wall.

        With `again` in the address, the last pair is asked again.
        """
        voter, session = self.voter(request)
        settings = store.settings(self.db)
        if settings.pairs and settings.is_open(self.clock()):
            if "again" in request.query_params:
                question = pairs.last_question(self.db, voter)
            else:
                question = pairs.next_question(self.db, voter)
            if question is not None:
                return self.question(question, session)
        return self.wall(voter, session)

    def question(self, question: pairs.Question, session: tokens.PresentedToken) -> Response:
        """Show a pair of artifacts, with a button for each."""
        artifacts = store.artifacts(self.db)
        return self.page(
            "pair.html",
            shown=[artifacts[id] for id in question.pair],
            question=question,
            key=tokens.form_key(session),
        )

    async def answer(self, request: Request) -> Response:
        """Store the answer about a pair, and show the next pair once it is on the disk."""
        voter, fields = await self.signed_form(request)
        pair = [value for name, value in fields if name == "of"]
        winner = "".join(value for name, value in fields if name == "winner")
        try:
            await self.writer.do(lambda db: pairs.cast(db, voter, pair, winner, now=self.clock()))
        except ballots.NotAccepted as reason:
            raise Refusal(409, str(reason)) from None
        return RedirectResponse("/", 303)

    async def signed_form(self, request: Request) -> tuple[store.Voter, list[tuple[str, str]]]:
        """Return the voter and the fields of a form that was sent from one of our own pages."""
        same_origin(request, self.origin)
        voter, session = self.voter(request)
        if not self.rates.take("ballots", voter.id, BALLOT_RATE):
            raise Refusal(
                429, "Too many changes at once. Your last ballot counts. Try again later."
            )
        fields = await form(request)
        keys = [value for name, value in fields if name == "key"]
        if keys != [tokens.form_key(session)]:
            raise Refusal(403, "This form is too old, or it is not yours. Open the gallery again.")
        return voter, fields

    def wall(self, voter: store.Voter, session: tokens.PresentedToken) -> Response:
        """Show all artifacts, in the voter's own order, with the voter's ballot."""
        settings = store.settings(self.db)
        artifacts = store.artifacts(self.db)
        cast_at, chosen = ballots.read_ballot(self.db, voter.id)
        is_open = settings.is_open(self.clock())
        cards = []
        for id in tokens.shuffled(list(artifacts), settings.secret, voter.id):
            artifact = artifacts[id]
            card = self.card(
                one=artifact,
                open=is_open and settings.marks > 0,
                own=artifact.team == voter.team,
                chosen=id in chosen,
            )
            cards.append(Markup(card))
        when = None
        if cast_at is not None:
            when = store.format_time(datetime.fromtimestamp(cast_at, settings.closes.tzinfo))
        return self.page(
            "wall.html",
            cards=cards,
            marks=settings.marks,
            judged=len(pairs.read_answers(self.db, voter.id)),
            chosen=len(chosen),
            when=when,
            key=tokens.form_key(session),
        )

    async def ballot(self, request: Request) -> Response:
        """Store a ballot, which replaces the earlier one, and answer once it is on the disk."""
        voter, fields = await self.signed_form(request)
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
        """Show a button that opens a session.

        Opening the link itself does not use it up, because mail programs fetch links for previews.
        """
        token = request.path_params["token"]
        if tokens.whose(self.db, token, "link"):
            return self.page("enter.html", token=token)
        voter = tokens.whose(self.db, request.cookies.get(self.cookie, ""))
        if voter and voter.id == tokens.spent_by(self.db, token):
            return RedirectResponse("/", 303)
        self.count_failure(request)
        raise Refusal(404, USED_LINK_MESSAGE)

    async def enter(self, request: Request) -> Response:
        """Use up a personal link, and begin a session."""
        same_origin(request, self.origin)
        token = request.path_params["token"]
        entered = await self.writer.do(lambda db: tokens.spend(db, token))
        if entered is None:
            self.count_failure(request)
            raise Refusal(404, USED_LINK_MESSAGE)
        _, session_token = entered
        response = RedirectResponse("/", 303)
        response.set_cookie(
            self.cookie,
            session_token,
            max_age=SESSION_SECONDS,
            path="/",
            secure=self.secure,
            httponly=True,
            samesite="lax",
        )
        return response

    async def look(self, request: Request) -> Response:
        """Show one artifact in detail, with links to its neighbors in the voter's order."""
        voter, _ = self.voter(request)
        artifacts = store.artifacts(self.db)
        id = request.path_params["id"]
        if id not in artifacts:
            raise Refusal(404, STATUS_MESSAGES[404])
        order = tokens.shuffled(list(artifacts), store.settings(self.db).secret, voter.id)
        index = order.index(id)
        return self.page(
            "look.html",
            shown=[artifacts[id]],
            place=index + 1,
            count=len(order),
            before=order[index - 1],
            after=order[(index + 1) % len(order)],
        )

    async def compare(self, request: Request) -> Response:
        """Show two artifacts side by side."""
        self.voter(request)
        artifacts = store.artifacts(self.db)
        wanted = request.query_params.getlist("with")
        if len(set(wanted)) != 2 or not set(wanted) <= artifacts.keys():
            raise Refusal(400, "Choose two artifacts on the wall, and compare again.")
        shown = [artifacts[id] for id in wanted]
        return self.page("look.html", shown=shown, place=0, count=len(artifacts))

    async def picture(self, request: Request) -> Response:
        """Send a picture that the gallery has encoded."""
        self.voter(request)
        id = request.path_params["id"]
        size = request.path_params["size"]
        if size not in pictures.MAX_SIDE_PIXELS or not store.hangs(self.db, id):
            raise Refusal(404, STATUS_MESSAGES[404])
        data = self.bytes_of(pictures.place(self.folder / store.PICTURES, id, size))
        return Response(
            data, media_type="image/webp", headers={"Cache-Control": PICTURE_CACHE_CONTROL}
        )

    async def results(self, request: Request) -> Response:
        """Show the results once the vote has closed."""
        self.voter(request)
        settings = store.settings(self.db)
        artifacts = store.artifacts(self.db)
        if settings.is_open(self.clock()):
            closes = store.format_time(settings.closes)
            raise Refusal(403, f"The results are shown after the vote has closed: {closes}.")
        if settings.pairs:
            return self.pair_results(artifacts, settings.pairs)
        cast = [ballot for ballot in ballots.every(self.db).values() if ballot]
        standings = ballots.standings(artifacts, cast)
        return self.page(
            "results.html",
            rows=[(standing, artifacts[standing.artifact]) for standing in standings],
            cast=len(cast),
            voters=store.voters(self.db),
            method=ballots.METHOD.format(marks=settings.marks),
        )

    def pair_results(self, artifacts: Mapping[str, store.Artifact], asked: int) -> Response:
        """Show the strengths of the artifacts, and how often the class agrees with metrics."""
        ids, wins = pairs.count_wins(self.db)
        standings = pairs.standings(ids, wins)
        return self.page(
            "pair_results.html",
            rows=[(standing, artifacts[standing.artifact]) for standing in standings],
            agreements=agreement.agreements(ids, wins, agreement.read_scores(self.db)),
            answers=int(wins.sum()),
            cast=pairs.count_voters(self.db),
            voters=store.voters(self.db),
            method=pairs.METHOD.format(pairs=asked),
            agreement_method=agreement.METHOD,
        )

    async def static(self, request: Request) -> Response:
        """Send a style sheet or a script, also without a session."""
        file = HERE / "static" / request.path_params["name"]
        if not file.is_file():
            raise Refusal(404, STATUS_MESSAGES[404])
        kind, _ = mimetypes.guess_type(file.name)
        return Response(
            self.bytes_of(file), media_type=kind, headers={"Cache-Control": STATIC_CACHE_CONTROL}
        )


def application(gallery: Gallery) -> ASGIApp:
    """Return the gallery as an ASGI application, which closes the database at the end."""

    @asynccontextmanager
    async def close_at_end(app: Starlette) -> Any:
        yield
        await gallery.close()

    routes = [
        Route("/", gallery.home),
        Route("/ballot", gallery.ballot, methods=["POST"]),
        Route("/pair", gallery.answer, methods=["POST"]),
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
    app = Starlette(routes=routes, exception_handlers=handlers, lifespan=close_at_end)
    return Guard(app, host=gallery.host, secure=gallery.secure)
