"""Links and sessions: what their bearer shows, and what the gallery keeps of it.

A token is 12 characters by which it is found, and 43 that prove it: 256 random bits. Of those the
gallery
keeps a digest alone, so that whoever reads its database can neither vote nor enter. A plain SHA-256 does:
there is no list of likely secrets to try. A personal link opens a session once.
"""

import hashlib
import hmac
import re
import secrets
import sqlite3
from collections.abc import Sequence
from typing import Literal, NamedTuple

from hdrlab.course.gallery import store
from hdrlab.errors import InputError

Kind = Literal["session", "link"]  # of a token, and the column of its handle
Row = tuple[str, ...]
LINKS = ("student", "name", "email", "link")
TOKEN = re.compile(r"([A-Za-z0-9_-]{12})([A-Za-z0-9_-]{43})", re.ASCII)


class Token(NamedTuple):
    """A new token: its text goes to the bearer and nowhere else."""

    text: str
    handle: str
    digest: bytes


class Shown(NamedTuple):
    """A token that somebody shows."""

    handle: str
    secret: str


NOBODY = bytes(32)  # the digest of no secret that could be found


def make() -> Token:
    """Return a new token."""
    handle = secrets.token_urlsafe(9)
    secret = secrets.token_urlsafe(32)
    return Token(handle + secret, handle, digest(secret))


def digest(secret: str) -> bytes:
    """Return what is kept of a secret."""
    return hashlib.sha256(secret.encode("ascii")).digest()


def read(text: str) -> Shown | None:
    """Return the parts of a token, or None for what is none."""
    found = TOKEN.fullmatch(text)
    return Shown(*found.groups()) if found else None


def proves(shown: Shown, kept: bytes | None) -> bool:
    """Return whether a secret is the one whose digest is kept.

    It takes as long where nothing is kept under its handle.

    Examples
    --------
    >>> token = make()
    >>> shown = read(token.text)
    >>> proves(shown, token.digest), proves(shown, None), proves(shown, make().digest)
    (True, False, False)
    """
    return hmac.compare_digest(digest(shown.secret), kept or NOBODY)


def form_key(session: Shown) -> str:
    """Return what a form of this session carries, and no other site can know."""
    return hmac.new(session.secret.encode("ascii"), b"form", hashlib.sha256).hexdigest()


def shuffled(ids: list[str], secret: bytes, voter: str) -> list[str]:
    """Return ids in an order of the voter's own, the same at every visit.

    Examples
    --------
    >>> ids = list("abcdefgh")
    >>> shuffled(ids, b"s", "anna") == shuffled(ids[::-1], b"s", "anna") != shuffled(ids, b"s", "ben")
    True
    """
    return sorted(
        ids, key=lambda id: hmac.new(secret, f"{voter}\0{id}".encode(), hashlib.sha256).digest()
    )


def new_link(db: sqlite3.Connection, voter: str) -> str:
    """Return a new personal token; an older one, and a session that it began, end."""
    token = make()
    update = "UPDATE voters SET link = ?, link_digest = ?, session = NULL, session_digest = NULL WHERE id = ?"
    if not db.execute(update, (token.handle, token.digest, voter)).rowcount:
        raise InputError(f"expected a voter of this gallery, got {voter!r}")
    return token.text


def spend(db: sqlite3.Connection, text: str) -> tuple[store.Voter, str] | None:
    """Return the voter of a personal token and a session's token, once; None for what is none, or spent."""
    voter = whose(db, text, "link")
    if voter is None:
        return None
    session = make()
    update = "UPDATE voters SET link_digest = NULL, session = ?, session_digest = ? WHERE id = ? AND link = ?"
    row = (session.handle, session.digest, voter.id, text[: len(session.handle)])
    db.execute(update, row)
    return voter, session.text


def whose(db: sqlite3.Connection, text: str, kind: Kind = "session") -> store.Voter | None:
    """Return the voter of a session's or a link's token, or None."""
    shown = read(text)
    if shown is None:
        return None
    # a column, nobody's text
    query = f"SELECT id, name, team, {kind}_digest FROM voters WHERE {kind} = ?"
    row = db.execute(query, (shown.handle,)).fetchone()
    proven = proves(shown, row[3] if row else None)
    return store.Voter(*row[:3]) if row and proven else None


def spent_by(db: sqlite3.Connection, text: str) -> str | None:
    """Return the id of the voter whose link this was: it leads a browser on, and proves nothing."""
    shown = read(text)
    row = (
        db.execute("SELECT id FROM voters WHERE link = ?", (shown.handle,)).fetchone()
        if shown
        else None
    )
    return row[0] if row else None


def links(
    db: sqlite3.Connection, address: str, ids: Sequence[str], emails: dict[str, str]
) -> list[Row]:
    """Return new personal links of these voters; their older ones end."""
    names = {id: name for id, name, _ in store.voters(db)}
    with store.transaction(db):
        fresh = [(id, new_link(db, id)) for id in ids]
    return [
        (id, names[id], emails.get(id, ""), f"{address.rstrip('/')}/enter/{text}")
        for id, text in fresh
    ]
