"""Ballots in the database: one of each voter, a set of artifacts that takes the place of the set before."""

import sqlite3
from collections.abc import Iterable

from hdrlab.course.gallery import store


class NotAccepted(ValueError):
    """Why a ballot is not taken."""


def cast(db: sqlite3.Connection, voter: str, chosen: Iterable[str], now: float) -> int:
    """Put a ballot in the place of the voter's earlier one, within a transaction, and return its votes.

    Raises
    ------
    NotAccepted
        After the end, for the own team's artifact, for one that is not there, and for too many.
    """
    set_up, chosen = store.settings(db), sorted(set(chosen))
    if not set_up.is_open(now):
        raise NotAccepted("The vote is closed. Your ballot of before counts.")
    update = "ON CONFLICT (voter) DO UPDATE SET cast_at = excluded.cast_at"
    db.execute("SAVEPOINT ballot")
    try:
        db.execute(f"INSERT INTO ballots VALUES (?, ?) {update}", (voter, now))
        db.execute("DELETE FROM votes WHERE voter = ?", (voter,))
        db.executemany("INSERT INTO votes VALUES (?, ?)", [(voter, one) for one in chosen])
    except sqlite3.IntegrityError as error:
        db.execute("ROLLBACK TO ballot")
        many = f"A ballot has {set_up.marks} votes."
        reasons = {"own team": "Nobody votes for the own team.", "too many": many}
        raise NotAccepted(reasons.get(str(error), "There is no such artifact.")) from None
    finally:
        db.execute("RELEASE ballot")
    return len(chosen)


def read_ballot(db: sqlite3.Connection, voter: str) -> tuple[float | None, frozenset[str]]:
    """Return when a voter's ballot was cast, or None, and what it marks of what hangs."""
    row = db.execute("SELECT cast_at FROM ballots WHERE voter = ?", (voter,)).fetchone()
    hung = "SELECT artifact FROM votes JOIN artifacts ON artifact = id WHERE hangs AND voter = ?"
    found = db.execute(hung, (voter,))
    return (row[0] if row else None), frozenset(one for (one,) in found)


def every(db: sqlite3.Connection) -> dict[str, frozenset[str]]:
    """Return all ballots, by voter, with votes for what hangs no longer: for counting, and for no page."""
    found: dict[str, set[str]] = {voter: set() for (voter,) in db.execute("SELECT voter FROM ballots")}
    for voter, artifact in db.execute("SELECT voter, artifact FROM votes"):
        found[voter].add(artifact)
    return {voter: frozenset(one) for voter, one in found.items()}
