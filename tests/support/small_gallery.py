"""A small class with a gallery, and a browser that sends requests to its ASGI application."""

import asyncio
import re
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from http.cookies import SimpleCookie
from pathlib import Path
from urllib.parse import unquote_to_bytes, urlencode, urlsplit

import numpy as np

from hdrlab.course.gallery import collect, store, tokens
from hdrlab.io import photos

ADDRESS = "http://vote.test"
START = datetime(2026, 12, 1, 12, tzinfo=UTC)
CLOSES = START + timedelta(days=2)
# two teams of two students, and two students who work alone
TEAMS = {"team1": ("ann", "ben"), "team2": ("cy", "dee"), "eve": ("eve",), "fay": ("fay",)}


class Clock:
    """A clock that a test sets: `now` in seconds since 1970."""

    def __init__(self):
        self.now = START.timestamp()

    def __call__(self):
        return self.now


@dataclass(frozen=True)
class SmallGallery:
    """A gallery.

    Attributes
    ----------
    folder : its folder
    artifacts : the id of the artifact of each team
    links : the token of the link of each student
    clock : the clock of its pages
    """

    folder: Path
    artifacts: dict
    links: dict
    clock: Clock


def write_photo(path, seed=0, shape=(60, 90, 3)):
    """Write a picture of noise and return its path."""
    rng = np.random.default_rng(seed)
    photos.write_picture(path, rng.integers(0, 256, shape, dtype=np.uint8))
    return path


def make_gallery(
    folder,
    teams=TEAMS,
    *,
    marks=2,
    pairs=0,
    closes=CLOSES,
    names=None,
    title="{team}'s view",
    caption="",
):
    """Make a gallery with one artifact of each team.

    Parameters
    ----------
    folder : the gallery is made in `folder / "gallery"`
    teams : the students of each team
    marks : how many votes a student has
    pairs : how many pairs a student is asked about, instead of votes
    closes : when the vote ends
    names : the names of students; by default, the id with a capital letter
    title, caption : of each artifact
    """
    names = names or {}
    gallery = folder / "gallery"
    students = [student for members in teams.values() for student in members]
    store.create(gallery, "Spring", closes, 0 if pairs else marks, pairs=pairs)
    with closing(store.connect(gallery)) as db:
        with store.transaction(db):
            for team, members in teams.items():
                for student in members:
                    name = names.get(student, student.title())
                    store.admit(db, store.Voter(student, name, team))
        for seed, team in enumerate(teams):
            path = write_photo(folder / f"{team}.png", seed)
            entry = collect.Entry(team, title.format(team=team), caption, path)
            collect.hang(db, gallery, entry)
        with store.transaction(db):
            links = {student: tokens.new_link(db, student) for student in students}
        artifacts = {artifact.team: artifact.id for artifact in store.artifacts(db).values()}
    return SmallGallery(gallery, artifacts, links, Clock())


def form_key(page):
    """Return the key of the form in a page."""
    return re.search(r'name="key" value="([0-9a-f]{64})"', page)[1]


@dataclass(frozen=True)
class Answer:
    """The answer to a request."""

    status: int
    headers: dict
    content: bytes

    @property
    def text(self):
        return self.content.decode()


class Browser:
    """A browser without a network: it calls an ASGI application, keeps cookies, and changes no address."""

    def __init__(self, application, address=ADDRESS):
        self.application = application
        self.address = urlsplit(address)
        self.cookies = {}

    def get(self, path, headers=None):
        return self.ask("GET", path, headers)

    def post(self, path, form=None, headers=None, body=None):
        """Post a form, or the pieces of a body."""
        all_headers = {"content-type": "application/x-www-form-urlencoded"} | (headers or {})
        pieces = [urlencode(form or {}, doseq=True).encode()] if body is None else body
        return self.ask("POST", path, all_headers, pieces)

    def ask(self, method, path, headers=None, pieces=(b"",)):
        """Send a request whose body comes in pieces, and return the Answer."""
        all_headers = {"host": self.address.netloc}
        if self.cookies:
            cookies = [f"{name}={value}" for name, value in self.cookies.items()]
            all_headers["cookie"] = "; ".join(cookies)
        all_headers |= headers or {}
        target, _, query = path.partition("?")
        scope = {
            "type": "http",
            "method": method,
            "http_version": "1.1",
            "scheme": self.address.scheme,
            "path": unquote_to_bytes(target).decode("latin-1"),
            "raw_path": target.encode(),
            "query_string": query.encode(),
            "client": ("192.0.2.1", 5000),
            "root_path": "",
            "headers": [
                (name.encode(), value.encode("latin-1")) for name, value in all_headers.items()
            ],
        }
        # in a thread of its own: an earlier test in a browser may have left a loop running in this one
        with ThreadPoolExecutor(1) as executor:
            request = send_request(self.application, scope, pieces)
            answer = executor.submit(asyncio.run, request).result()
        for cookie in SimpleCookie(answer.headers.get("set-cookie", "")).values():
            self.cookies[cookie.key] = cookie.value
        return answer


async def send_request(application, scope, pieces):
    """Return the Answer to one request, whose body comes in pieces."""
    remaining = iter([*[(piece, True) for piece in pieces], (b"", False)])
    messages = []

    async def receive():
        body, has_more = next(remaining, (None, False))
        if body is None:
            await asyncio.Event().wait()  # the client never disconnects
        return {"type": "http.request", "body": body, "more_body": has_more}

    async def send(message):
        messages.append(message)

    await application(scope, receive, send)
    start, *rest = messages
    headers = {name.decode(): value.decode("latin-1") for name, value in start["headers"]}
    content = b"".join(message.get("body", b"") for message in rest)
    return Answer(start["status"], headers, content)
