"""A small class with a gallery, for the tests of the gallery: teams of two, and two who work alone."""

import asyncio
import re
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from datetime import UTC, datetime, timedelta
from http.cookies import SimpleCookie
from typing import NamedTuple
from urllib.parse import unquote_to_bytes, urlencode, urlsplit

import numpy as np

from hdrlab.course.gallery import collect, store, tokens
from hdrlab.io import photos

ADDRESS = "http://vote.test"
START = datetime(2026, 12, 1, 12, tzinfo=UTC)
CLOSES = START + timedelta(days=2)
TEAMS = {"team1": ("ann", "ben"), "team2": ("cy", "dee"), "eve": ("eve",), "fay": ("fay",)}


class Clock:
    """A clock that a test sets."""

    def __init__(self):
        self.now = START.timestamp()

    def __call__(self):
        return self.now


class Class(NamedTuple):
    """A gallery's folder, its artifacts by team, its voters' links by student, and its clock."""

    folder: object
    artifacts: dict
    links: dict
    clock: Clock


def picture(path, seed=0, shape=(60, 90, 3)):
    """Write a picture of noise and return its path."""
    photos.write_picture(path, np.random.default_rng(seed).integers(0, 256, shape, dtype=np.uint8))
    return path


def make(
    folder, teams=TEAMS, *, marks=2, closes=CLOSES, names=None, title="{team}'s view", caption=""
):
    """Make a gallery of these teams."""
    store.create(folder / "gallery", "Spring", closes, marks)
    with closing(store.connect(folder / "gallery")) as db:
        with store.transaction(db):
            for team, members in teams.items():
                for one in members:
                    store.admit(db, store.Voter(one, (names or {}).get(one, one.title()), team))
        for seed, team in enumerate(teams):
            path = picture(folder / f"{team}.png", seed)
            entry = collect.Entry(team, title.format(team=team), caption, path)
            collect.hang(db, folder / "gallery", entry)
        with store.transaction(db):
            links = {one: tokens.new_link(db, one) for members in teams.values() for one in members}
        artifacts = {one.team: one.id for one in store.artifacts(db).values()}
    return Class(folder / "gallery", artifacts, links, Clock())


def key(page):
    """Return the key of the form in a page."""
    return re.search(r'name="key" value="([0-9a-f]{64})"', page)[1]


class Answer(NamedTuple):
    """What came back."""

    status: int
    headers: dict
    content: bytes

    @property
    def text(self):
        return self.content.decode()


class Browser:
    """A program that asks an ASGI application, keeps cookies, and takes an address as it stands."""

    def __init__(self, application, address=ADDRESS):
        self.application, self.address, self.cookies = application, urlsplit(address), {}

    def get(self, path, headers=None):
        return self.ask("GET", path, headers)

    def post(self, path, form=None, headers=None, body=None):
        kind = {"content-type": "application/x-www-form-urlencoded"}
        pieces = [urlencode(form or {}, doseq=True).encode()] if body is None else body
        return self.ask("POST", path, kind | (headers or {}), pieces)

    def ask(self, method, path, headers=None, pieces=(b"",)):
        cookies = "; ".join(f"{name}={value}" for name, value in self.cookies.items())
        sent = (
            {"host": self.address.netloc}
            | ({"cookie": cookies} if cookies else {})
            | (headers or {})
        )
        target, _, query = path.partition("?")
        scope = {
            **{
                "type": "http",
                "method": method,
                "http_version": "1.1",
                "scheme": self.address.scheme,
            },
            **{"path": unquote_to_bytes(target).decode("latin-1"), "raw_path": target.encode()},
            **{"query_string": query.encode(), "client": ("192.0.2.1", 5000), "root_path": ""},
            "headers": [(name.encode(), value.encode("latin-1")) for name, value in sent.items()],
        }
        with ThreadPoolExecutor(
            1
        ) as apart:  # a browser test before may have left a loop running in this one
            answer = apart.submit(asyncio.run, asked(self.application, scope, pieces)).result()
        for made in SimpleCookie(answer.headers.get("set-cookie", "")).values():
            self.cookies[made.key] = made.value
        return answer


async def asked(application, scope, pieces):
    """Return the answer to one request, whose body comes in pieces."""
    waiting = iter([*[(one, True) for one in pieces], (b"", False)])
    messages = []

    async def receive():
        body, more = next(waiting, (None, False))
        if body is None:
            await asyncio.Event().wait()  # nobody goes away
        return {"type": "http.request", "body": body, "more_body": more}

    async def send(message):
        messages.append(message)

    await application(scope, receive, send)
    headers = {name.decode(): value.decode("latin-1") for name, value in messages[0]["headers"]}
    return Answer(
        messages[0]["status"], headers, b"".join(one.get("body", b"") for one in messages[1:])
    )
