"""Ballots in the database, one of each voter, and how they become places: approval voting.

b   ballots   a set of artifacts each: those that the voter marks, at most so many, none of the own team
v   votes     v_a = the number of ballots that mark a
p   places    p_a = 1 + the number of artifacts with more votes than a

Nobody's order of their favourites is asked. Equal votes share a place, and ties are not broken: 1,
2, 2, 4. With marks of one weight nobody gains by marking a favourite lower than it is liked, and
who marks fewer gives away nothing.
"""

import sqlite3
from collections import Counter
from collections.abc import Iterable, Iterator, Set
from typing import NamedTuple

from hdrlab.course.gallery import store
from hdrlab.errors import InputError

GRADEBOOK = ("student", "name", "team", "voted", "artifact", "votes", "place", "shared with")
METHOD = (
    "Each voter chooses up to {marks} artifacts of other teams, and every choice is one vote. "
    "Equal votes share a place, and the place after them counts them all: 1, 2, 2, 4. Ties are not broken."
)


class Standing(NamedTuple):
    """An artifact's votes and place, and with how many others it shares that place."""

    artifact: str
    votes: int
    place: int
    shared: int


class NotAccepted(InputError):
    """Why a ballot is not taken."""


def cast(db: sqlite3.Connection, voter: str, chosen: Iterable[str], now: float) -> int:
    """Put a ballot in the place of the voter's earlier one, within a transaction, and return its votes.

    Raises
    ------
    NotAccepted
        After the end, for the own team's artifact, for one that is not there, and for too many.
    """
    set_up = store.settings(db)
    chosen = sorted(set(chosen))
    if not set_up.is_open(now):
        raise NotAccepted("The vote is closed. Your last ballot counts.")
    update = "ON CONFLICT (voter) DO UPDATE SET cast_at = excluded.cast_at"
    db.execute("SAVEPOINT ballot")
    try:
        db.execute(f"INSERT INTO ballots VALUES (?, ?) {update}", (voter, now))
        db.execute("DELETE FROM votes WHERE voter = ?", (voter,))
        db.executemany("INSERT INTO votes VALUES (?, ?)", [(voter, one) for one in chosen])
    except sqlite3.IntegrityError as error:
        db.execute("ROLLBACK TO ballot")
        many = f"A ballot has {set_up.marks} votes."
        reasons = {"own team": "You cannot vote for your own team.", "too many": many}
        raise NotAccepted(reasons.get(str(error), "This artifact does not exist.")) from None
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
    found: dict[str, set[str]] = {
        voter: set() for (voter,) in db.execute("SELECT voter FROM ballots")
    }
    for voter, artifact in db.execute("SELECT voter, artifact FROM votes"):
        found[voter].add(artifact)
    return {voter: frozenset(one) for voter, one in found.items()}


def standings(artifacts: Iterable[str], ballots: Iterable[Set[str]]) -> list[Standing]:
    """Return the artifacts from the first place to the last; those of one place in the order of their ids.

    Examples
    --------
    >>> [(row.artifact, row.votes, row.place) for row in standings("abcd", [{"a", "b"}, {"b", "c"}, set()])]
    [('b', 2, 1), ('a', 1, 2), ('c', 1, 2), ('d', 0, 4)]
    """
    votes = Counter(dict.fromkeys(artifacts, 0))
    for ballot in ballots:
        votes.update(ballot & votes.keys())
    ranks = Counter(votes.values())
    place = {v: 1 + sum(count for more, count in ranks.items() if more > v) for v in ranks}
    rows = [Standing(one, v, place[v], ranks[v] - 1) for one, v in votes.items()]
    return sorted(rows, key=lambda row: (row.place, row.artifact))


def gradebook(db: sqlite3.Connection) -> Iterator[tuple[str | int, ...]]:
    """Yield a row for each voter: whether they voted, never for what, and how their artifact fared."""
    hung = store.artifacts(db)
    cast = every(db)
    rows = {hung[row.artifact].team: row for row in standings(hung, cast.values())}
    for id, name, team in store.voters(db):
        voted = "yes" if cast.get(id) else "no"
        row = rows.get(team)
        fared = (
            (hung[row.artifact].title, row.votes, row.place, row.shared)
            if row
            else ("", "", "", "")
        )
        yield (id, name, team, voted, *fared)
