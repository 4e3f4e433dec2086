"""Links and sessions: what their bearer shows, and what the gallery keeps of it.

A token is 12 characters by which it is found, and 43 that prove it: 256 random bits. Of those the gallery
keeps a digest alone, so that whoever reads its database can neither vote nor enter. A plain SHA-256 does:
there is no list of likely secrets to try.
"""

import hashlib
import hmac
import re
import secrets
from typing import NamedTuple

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
    handle, secret = secrets.token_urlsafe(9), secrets.token_urlsafe(32)
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
    return sorted(ids, key=lambda id: hmac.new(secret, f"{voter}\0{id}".encode(), hashlib.sha256).digest())
