"""Who bears which token: personal links, which open a session once, and sessions."""

import sqlite3
from typing import Literal

from hdrlab.course.gallery import store, tokens

Kind = Literal["session", "link"]  # of a token, and the column of its handle


def new_link(db: sqlite3.Connection, voter: str) -> str:
    """Return a new personal token; an older one, and a session that it began, end."""
    token = tokens.make()
    update = "UPDATE voters SET link = ?, link_digest = ?, session = NULL, session_digest = NULL WHERE id = ?"
    if not db.execute(update, (token.handle, token.digest, voter)).rowcount:
        raise ValueError(f"expected a voter of this gallery, got {voter!r}")
    return token.text


def spend(db: sqlite3.Connection, text: str) -> tuple[store.Voter, str] | None:
    """Return the voter of a personal token and a session's token, once; None for what is none, or spent."""
    voter = whose(db, text, "link")
    if voter is None:
        return None
    session = tokens.make()
    update = "UPDATE voters SET link_digest = NULL, session = ?, session_digest = ? WHERE id = ? AND link = ?"
    row = (session.handle, session.digest, voter.id, text[: len(session.handle)])
    db.execute(update, row)
    return voter, session.text


def whose(db: sqlite3.Connection, text: str, kind: Kind = "session") -> store.Voter | None:
    """Return the voter of a session's or a link's token, or None."""
    shown = tokens.read(text)
    if shown is None:
        return None
    query = f"SELECT id, name, team, {kind}_digest FROM voters WHERE {kind} = ?"  # a column, nobody's text
    row = db.execute(query, (shown.handle,)).fetchone()
    proven = tokens.proves(shown, row[3] if row else None)
    return store.Voter(*row[:3]) if row and proven else None


def spent_by(db: sqlite3.Connection, text: str) -> str | None:
    """Return the id of the voter whose link this was: it leads a browser on, and proves nothing."""
    shown = tokens.read(text)
    row = db.execute("SELECT id FROM voters WHERE link = ?", (shown.handle,)).fetchone() if shown else None
    return row[0] if row else None
