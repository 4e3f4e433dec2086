"""What goes to the gradebook, and the links that go to the class."""

import sqlite3
from collections.abc import Iterator, Sequence

from hdrlab.course.gallery import access_tokens, ballots, counting, store

GRADEBOOK = ("student", "name", "team", "voted", "artifact", "votes", "place", "shared with")
LINKS = ("student", "name", "email", "link")
Row = tuple[str | int, ...]


def gradebook(db: sqlite3.Connection) -> Iterator[Row]:
    """Yield a row for each voter: whether they voted, never for what, and how their artifact fared."""
    hung, cast = store.artifacts(db), ballots.every(db)
    rows = {hung[row.artifact].team: row for row in counting.standings(hung, cast.values())}
    for id, name, team in store.voters(db):
        voted = "yes" if cast.get(id) else "no"
        row = rows.get(team)
        fared = (hung[row.artifact].title, row.votes, row.place, row.shared) if row else ("", "", "", "")
        yield (id, name, team, voted, *fared)


def links(db: sqlite3.Connection, address: str, ids: Sequence[str], emails: dict[str, str]) -> list[Row]:
    """Return new personal links of these voters; their older ones end."""
    names = {id: name for id, name, _ in store.voters(db)}
    with store.transaction(db):
        fresh = [(id, access_tokens.new_link(db, id)) for id in ids]
    return [(id, names[id], emails.get(id, ""), f"{address.rstrip('/')}/enter/{text}") for id, text in fresh]
