"""The gallery on disk: one folder with its pictures and a database, in which a voter has one ballot.

What must never happen is forbidden by the database itself, whatever the program above it does: a
second ballot (its key is the voter), a vote for one's own team and a vote too many (triggers), a
vote for what is
not there (a foreign key) or hangs no longer (a trigger). A ballot is acknowledged after it is on the disk:
WAL with full synchronisation. An artifact that another replaces stays with its votes, which do not
count.
"""

import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from datetime import UTC, datetime
from pathlib import Path
from secrets import token_bytes
from typing import NamedTuple

from hdrlab.errors import InputError

DATABASE = "gallery.sqlite"
PICTURES = "pictures"
VERSION = 2  # of the tables


class Settings(NamedTuple):
    """What the gallery is called, until when it takes ballots, and how many votes are on one."""

    title: str
    closes: datetime
    marks: int
    secret: bytes

    def is_open(self, now: float) -> bool:
        """Return whether a ballot that arrives at this time (seconds of the epoch) counts."""
        return now < self.closes.timestamp()


class Artifact(NamedTuple):
    """What hangs on the wall; width and height are those of its large picture."""

    id: str
    team: str
    title: str
    caption: str
    width: int
    height: int


class Voter(NamedTuple):
    """Who may vote."""

    id: str
    name: str
    team: str


def create(folder: str | Path, title: str, closes: datetime, marks: int) -> None:
    """Make a gallery in a folder that holds none.

    Raises
    ------
    FileExistsError
        Where there is one.
    ValueError
        For an end without a time zone, or marks below 1.
    """
    folder = Path(folder)
    if closes.tzinfo is None:
        raise InputError(
            f"expected an end with its zone, such as 2026-12-01T23:59+01:00, got {closes}"
        )
    if marks < 1:
        raise InputError(f"expected at least 1 vote on a ballot, got {marks}")
    if (folder / DATABASE).exists():
        raise FileExistsError(f"{folder}: expected a folder without a gallery, there is one")
    (folder / PICTURES).mkdir(parents=True, exist_ok=True)
    (folder / DATABASE).touch(mode=0o600)
    with closing(_opened(folder / DATABASE)) as db:
        schema = (Path(__file__).parent / "schema.sql").read_text(encoding="utf8")
        db.executescript(f"BEGIN; {schema} PRAGMA user_version = {VERSION}; COMMIT;")
        row = (title, closes.isoformat(), marks, token_bytes(32))
        db.execute("INSERT INTO gallery VALUES (1, ?, ?, ?, ?)", row)


def connect(folder: str | Path) -> sqlite3.Connection:
    """Return a connection to the gallery of a folder.

    Raises
    ------
    ValueError
        Where there is none, a damaged one, or one that another hdrlab has made, whose tables are
        others.
    """
    path = Path(folder) / DATABASE
    if not path.is_file():
        raise InputError(
            f"{folder}: expected a gallery, there is none; `hdrlab gallery init` makes one"
        )
    try:
        db = _opened(path)
        (version,) = db.execute("PRAGMA user_version").fetchone()
    except sqlite3.DatabaseError as error:
        raise InputError(
            f"{path}: expected a gallery's database, it cannot be read: {error}"
        ) from None
    if version != VERSION:
        db.close()
        raise InputError(
            f"{folder}: expected a gallery of version {VERSION}, got {max(version, 1)}: end this vote with "
            "the hdrlab that made it, or make a new gallery by `hdrlab gallery init`"
        )
    return db


def _opened(path: Path) -> sqlite3.Connection:
    db = sqlite3.connect(path, timeout=10, isolation_level=None, check_same_thread=False)
    for pragma in (
        "journal_mode = WAL",
        "synchronous = FULL",
        "foreign_keys = ON",
        "trusted_schema = OFF",
    ):
        db.execute(f"PRAGMA {pragma}")
    return db


@contextmanager
def writing(folder: str | Path) -> Iterator[sqlite3.Connection]:
    """Yield a connection within a transaction, which counts when the block ends well."""
    with closing(connect(folder)) as db, transaction(db):
        yield db


@contextmanager
def transaction(db: sqlite3.Connection) -> Iterator[None]:
    """Take all that the block writes, or nothing."""
    with db:
        db.execute("BEGIN IMMEDIATE")
        yield


def settings(db: sqlite3.Connection) -> Settings:
    """Return the Settings as they are now."""
    title, closes, marks, secret = db.execute(
        "SELECT title, closes, marks, secret FROM gallery"
    ).fetchone()
    return Settings(title, datetime.fromisoformat(closes), marks, secret)


def close(db: sqlite3.Connection, now: datetime) -> None:
    """Let the time for ballots end now."""
    db.execute("UPDATE gallery SET closes = ?", (now.isoformat(),))


def artifacts(db: sqlite3.Connection) -> dict[str, Artifact]:
    """Return the artifacts that hang, by id."""
    rows = db.execute(
        "SELECT id, team, title, caption, width, height FROM artifacts WHERE hangs ORDER BY id"
    )
    return {row[0]: Artifact(*row) for row in rows}


def hangs(db: sqlite3.Connection, id: str) -> bool:
    """Return whether there is such an artifact."""
    return (
        db.execute("SELECT 1 FROM artifacts WHERE hangs AND id = ?", (id,)).fetchone() is not None
    )


def hang(db: sqlite3.Connection, artifact: Artifact, source: str = "") -> int:
    """Hang an artifact in the place of the team's earlier one, and return how many votes that one had.

    The earlier one keeps its votes, which count again if it is hung again; the change is written
    down.
    """
    before = db.execute(
        "SELECT id FROM artifacts WHERE hangs AND team = ?", (artifact.team,)
    ).fetchone()
    db.execute("UPDATE artifacts SET hangs = 0 WHERE team = ?", (artifact.team,))
    update = "ON CONFLICT (id) DO UPDATE SET title = excluded.title, caption = excluded.caption, hangs = 1"
    db.execute(f"INSERT INTO artifacts VALUES (?, ?, ?, ?, ?, ?, 1) {update}", artifact)
    if before is None or before[0] == artifact.id:
        return 0
    (votes,) = db.execute("SELECT count(*) FROM votes WHERE artifact = ?", before).fetchone()
    row = (datetime.now(UTC).isoformat(), artifact.team, source, before[0], artifact.id, votes)
    db.execute("INSERT INTO changes VALUES (?, ?, ?, ?, ?, ?)", row)
    return int(votes)


def changes(db: sqlite3.Connection) -> list[str]:
    """Return in words which artifacts took the place of another, from the first change on."""
    rows = db.execute("SELECT at, team, source, votes FROM changes ORDER BY at")
    return [
        f"{at[:19]} UTC: {team} has hung another picture ({source}); {votes} votes for the first do not count"
        for at, team, source, votes in rows
    ]


def voters(db: sqlite3.Connection) -> list[Voter]:
    """Return who may vote, by id."""
    return [Voter(*row) for row in db.execute("SELECT id, name, team FROM voters ORDER BY id")]


def admit(db: sqlite3.Connection, voter: Voter) -> None:
    """Let somebody vote; who is there already gets the new name and team."""
    update = "ON CONFLICT (id) DO UPDATE SET name = excluded.name, team = excluded.team"
    db.execute(f"INSERT INTO voters (id, name, team) VALUES (?, ?, ?) {update}", voter)


def format_time(when: datetime) -> str:
    """Return a time as a sentence has it, with its zone."""
    return f"{when:%A} {when.day} {when:%B %Y}, {when:%H:%M} ({when.tzname()})"
