"""Make and check the tokens of personal links and sessions.

A token has a handle of 12 characters, by which the gallery finds it, and a secret of 43 characters
(256 random bits). The gallery stores only a digest of the secret, so that nobody who reads its
database can vote or enter. A plain SHA-256 suffices, because nobody can try a list of likely
secrets. A personal link opens one session, and works once.
"""

import hashlib
import hmac
import re
import secrets
import sqlite3
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from hdrlab.course.gallery import store
from hdrlab.errors import InputError

# a kind of token is also the name of the column that holds its handle
Kind = Literal["session", "link"]
LinkRow = tuple[str, str, str, str]
LINK_COLUMNS = ("student", "name", "email", "link")
TOKEN_PATTERN = re.compile(r"([A-Za-z0-9_-]{12})([A-Za-z0-9_-]{43})", re.ASCII)
# as bytes, before they become URL-safe text
HANDLE_BYTES = 9
SECRET_BYTES = 32
# the digest of no secret that anybody could find
IMPOSSIBLE_DIGEST = bytes(32)


@dataclass(frozen=True)
class Token:
    """A new token; its text goes to the bearer only, handle and digest into the database."""

    text: str
    handle: str
    digest: bytes


@dataclass(frozen=True)
class PresentedToken:
    """The parts of a token that a browser sends."""

    handle: str
    secret: str


def make() -> Token:
    """Return a new token."""
    handle = secrets.token_urlsafe(HANDLE_BYTES)
    secret = secrets.token_urlsafe(SECRET_BYTES)
    return Token(text=handle + secret, handle=handle, digest=digest(secret))


def digest(secret: str) -> bytes:
    """Return the digest of a secret, which the gallery stores."""
    return hashlib.sha256(secret.encode("ascii")).digest()


def read(text: str) -> PresentedToken | None:
    """Return the parts of a token, or None if the text is no token."""
    match = TOKEN_PATTERN.fullmatch(text)
    if match is None:
        return None
    return PresentedToken(handle=match[1], secret=match[2])


def proves(presented: PresentedToken, stored_digest: bytes | None) -> bool:
    """Return whether a token's secret has the stored digest.

    The check takes the same time if nothing is stored under the token's handle.

    Examples
    --------
    >>> token = make()
    >>> presented = read(token.text)
    >>> digests = (token.digest, None, make().digest)
    >>> [proves(presented, stored_digest) for stored_digest in digests]
    [True, False, False]
    """
    return hmac.compare_digest(digest(presented.secret), stored_digest or IMPOSSIBLE_DIGEST)


def form_key(session: PresentedToken) -> str:
    """Return the key that a session's forms carry, which no other site can know."""
    return hmac.new(session.secret.encode("ascii"), b"form", hashlib.sha256).hexdigest()


def shuffled(ids: list[str], secret: bytes, voter: str) -> list[str]:
    """Return ids in the order of one voter, which is the same at every visit.

    Examples
    --------
    >>> ids = list("abcdefgh")
    >>> anna = shuffled(ids, b"s", "anna")
    >>> anna == shuffled(ids[::-1], b"s", "anna"), anna == shuffled(ids, b"s", "ben")
    (True, False)
    """

    def sort_key(id: str) -> bytes:
        return hmac.new(secret, f"{voter}\0{id}".encode(), hashlib.sha256).digest()

    return sorted(ids, key=sort_key)


def new_link(db: sqlite3.Connection, voter: str) -> str:
    """Return a new personal token; the voter's older one and its session become invalid."""
    token = make()
    update = (
        "UPDATE voters SET link = ?, link_digest = ?, session = NULL, session_digest = NULL "
        "WHERE id = ?"
    )
    if not db.execute(update, (token.handle, token.digest, voter)).rowcount:
        raise InputError(f"expected a voter of this gallery, got {voter!r}")
    return token.text


def spend(db: sqlite3.Connection, text: str) -> tuple[store.Voter, str] | None:
    """Use up a personal token, and return its voter and the token of a new session.

    Return None if the text is no valid token, or one that has been used.
    """
    voter = whose(db, text, "link")
    if voter is None:
        return None
    session = make()
    update = (
        "UPDATE voters SET link_digest = NULL, session = ?, session_digest = ? "
        "WHERE id = ? AND link = ?"
    )
    link_handle = text[: len(session.handle)]
    db.execute(update, (session.handle, session.digest, voter.id, link_handle))
    return voter, session.text


def whose(db: sqlite3.Connection, text: str, kind: Kind = "session") -> store.Voter | None:
    """Return the voter of a session's or a link's token, or None if it is not valid."""
    presented = read(text)
    if presented is None:
        return None
    # `kind` is one of two names of columns, and never text from outside
    query = f"SELECT id, name, team, {kind}_digest FROM voters WHERE {kind} = ?"
    row = db.execute(query, (presented.handle,)).fetchone()
    stored_digest = row[3] if row else None
    # also without a row, so that an unknown handle takes the same time
    is_valid = proves(presented, stored_digest)
    if row is None or not is_valid:
        return None
    return store.Voter(id=row[0], name=row[1], team=row[2])


def spent_by(db: sqlite3.Connection, text: str) -> str | None:
    """Return the id of the voter whose personal link this was, used or not.

    The result is good enough to redirect a browser, and proves nothing.
    """
    presented = read(text)
    if presented is None:
        return None
    row = db.execute("SELECT id FROM voters WHERE link = ?", (presented.handle,)).fetchone()
    return row[0] if row else None


def links(
    db: sqlite3.Connection, address: str, ids: Sequence[str], emails: dict[str, str]
) -> list[LinkRow]:
    """Make new personal links for these voters, and return a row for each; their older links end.

    Parameters
    ----------
    db : connection to the database, within a transaction: commit it when the rows are safe
    address : where voters reach the gallery
    ids : the voters
    emails : their addresses, as far as they are known
    """
    name_of_id = {voter.id: voter.name for voter in store.voters(db)}
    token_of_id = {id: new_link(db, id) for id in ids}
    base = address.rstrip("/")
    return [
        (id, name_of_id[id], emails.get(id, ""), f"{base}/enter/{token}")
        for id, token in token_of_id.items()
    ]
