"""Cast and count the ballots of the class vote, which is an approval vote.

b   ballots   a set of artifacts each: those that the voter marks, up to a limit, none of the own team
v   votes     v_a = the number of ballots that mark a
p   places    p_a = 1 + the number of artifacts with more votes than a

Voters do not rank their favorites. Equal votes share a place, and ties are not broken: 1, 2, 2, 4.
All marks count the same, so nobody gains by leaving out a favorite, and a ballot with fewer marks is
not at a disadvantage.
"""

import sqlite3
from collections import Counter
from collections.abc import Iterable, Iterator, Set as AbstractSet
from dataclasses import dataclass

from hdrlab.course.gallery import store
from hdrlab.errors import InputError

GRADEBOOK_COLUMNS = (
    "student",
    "name",
    "team",
    "voted",
    "artifact",
    "votes",
    "place",
    "shared with",
)
METHOD = (
    "Each voter chooses up to {marks} artifacts of other teams, and every choice is one vote. "
    "Equal votes share a place, and the place after them counts them all: 1, 2, 2, 4. Ties are not broken."
)


@dataclass(frozen=True)
class Standing:
    """An artifact's votes and place, and the number of other artifacts that share the place."""

    artifact: str
    votes: int
    place: int
    shared: int


class NotAccepted(InputError):
    """A ballot is not accepted; the message says why."""


def cast(db: sqlite3.Connection, voter: str, chosen: Iterable[str], now: float) -> int:
    """Store a ballot, which replaces the voter's earlier one, and return its number of votes.

    Call this within a transaction. If the ballot is not accepted, the earlier one stays.

    Raises
    ------
    NotAccepted
        After the end of the vote, for the own team's artifact, for an artifact that does not exist,
        and for too many votes.
    """
    settings = store.settings(db)
    if not settings.is_open(now):
        raise NotAccepted("The vote is closed. Your last ballot counts.")
    if not settings.marks:
        raise NotAccepted("This gallery asks about pairs, and has no ballots.")
    votes = [(voter, artifact) for artifact in sorted(set(chosen))]
    update = "ON CONFLICT (voter) DO UPDATE SET cast_at = excluded.cast_at"
    db.execute("SAVEPOINT ballot")
    try:
        db.execute(f"INSERT INTO ballots VALUES (?, ?) {update}", (voter, now))
        db.execute("DELETE FROM votes WHERE voter = ?", (voter,))
        db.executemany("INSERT INTO votes VALUES (?, ?)", votes)
    except sqlite3.IntegrityError as error:
        db.execute("ROLLBACK TO ballot")
        raise NotAccepted(_rejection(error, settings.marks)) from None
    finally:
        db.execute("RELEASE ballot")
    return len(votes)


def _rejection(error: sqlite3.IntegrityError, marks: int) -> str:
    """Return why the database does not accept a ballot; the triggers in schema.sql say which rule."""
    rule = str(error)
    if rule == "own team":
        return "You cannot vote for your own team."
    if rule == "too many":
        return f"A ballot has {marks} votes."
    return "This artifact does not exist."


def read_ballot(db: sqlite3.Connection, voter: str) -> tuple[float | None, frozenset[str]]:
    """Return when a voter's ballot was cast, or None, and the artifacts on the wall that it marks."""
    row = db.execute("SELECT cast_at FROM ballots WHERE voter = ?", (voter,)).fetchone()
    query = "SELECT artifact FROM votes JOIN artifacts ON artifact = id WHERE hangs AND voter = ?"
    marked = frozenset(artifact for (artifact,) in db.execute(query, (voter,)))
    return (row[0] if row else None), marked


def every(db: sqlite3.Connection) -> dict[str, frozenset[str]]:
    """Return all ballots, by voter, with votes for replaced artifacts; use it for counting only."""
    marked: dict[str, set[str]] = {}
    for (voter,) in db.execute("SELECT voter FROM ballots"):
        marked[voter] = set()
    for voter, artifact in db.execute("SELECT voter, artifact FROM votes"):
        marked[voter].add(artifact)
    return {voter: frozenset(artifacts) for voter, artifacts in marked.items()}


def standings(artifacts: Iterable[str], ballots: Iterable[AbstractSet[str]]) -> list[Standing]:
    """Return the standings from the first place to the last, sorted by id within a place.

    Examples
    --------
    >>> rows = standings("abcd", [{"a", "b"}, {"b", "c"}, set()])
    >>> [(row.artifact, row.votes, row.place) for row in rows]
    [('b', 2, 1), ('a', 1, 2), ('c', 1, 2), ('d', 0, 4)]
    """
    votes_of = Counter(dict.fromkeys(artifacts, 0))
    for ballot in ballots:
        votes_of.update(ballot & votes_of.keys())
    # number of votes -> number of artifacts that have it
    artifacts_with = Counter(votes_of.values())
    place_with = {
        votes: 1 + sum(count for more, count in artifacts_with.items() if more > votes)
        for votes in artifacts_with
    }
    rows = [
        Standing(
            artifact=artifact,
            votes=votes,
            place=place_with[votes],
            shared=artifacts_with[votes] - 1,
        )
        for artifact, votes in votes_of.items()
    ]
    return sorted(rows, key=lambda row: (row.place, row.artifact))


def gradebook(db: sqlite3.Connection) -> Iterator[tuple[str | int, ...]]:
    """Yield a row for each voter: whether they voted, but not for what, and their artifact's result."""
    artifacts = store.artifacts(db)
    all_ballots = every(db)
    standing_of_team = {
        artifacts[row.artifact].team: row for row in standings(artifacts, all_ballots.values())
    }
    for voter in store.voters(db):
        voted = "yes" if all_ballots.get(voter.id) else "no"
        result: tuple[str | int, ...] = ("", "", "", "")
        standing = standing_of_team.get(voter.team)
        if standing is not None:
            title = artifacts[standing.artifact].title
            result = (title, standing.votes, standing.place, standing.shared)
        yield (voter.id, voter.name, voter.team, voted, *result)
