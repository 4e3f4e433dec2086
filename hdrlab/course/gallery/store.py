"""Store the gallery in one folder: its pictures, and a database in which each voter has one ballot.

In a gallery that asks about pairs, a voter has one answer for each pair instead. The database itself
forbids what must never happen, whatever the program does: a second ballot (its key is the voter), a
second answer about a pair (its key is the voter and the pair), a vote for one's own team, too many
votes, or a vote for a replaced artifact (triggers), and a vote for an artifact that does not exist
(a foreign key). A ballot is acknowledged once it is on the disk: WAL with full synchronization. A
replaced artifact keeps its votes, which do not count.
"""

import errno
import os
import secrets
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path

from hdrlab.errors import InputError
from hdrlab.io import temporary

DATABASE = "gallery.sqlite"
PICTURES = "pictures"
SCHEMA_FILE = Path(__file__).parent / "schema.sql"
SCHEMA_VERSION = 3
SECRET_BYTES = 32
# seconds to wait while another process writes
LOCK_TIMEOUT_SECONDS = 10
# what SQLite's errors mean, by their primary code
ERRNO_OF_CODE = {
    sqlite3.SQLITE_FULL: errno.ENOSPC,
    sqlite3.SQLITE_READONLY: errno.EACCES,
    sqlite3.SQLITE_PERM: errno.EACCES,
    sqlite3.SQLITE_CANTOPEN: errno.EACCES,
    sqlite3.SQLITE_IOERR: errno.EIO,
}
PRIMARY_CODE_MASK = 0xFF
# readable by the owner only
DATABASE_MODE = 0o600
PRAGMAS = ("journal_mode = WAL", "synchronous = FULL", "foreign_keys = ON", "trusted_schema = OFF")


@dataclass(frozen=True)
class Settings:
    """The settings of a gallery.

    Attributes
    ----------
    title : its title
    closes : the end of the vote
    marks : the largest number of votes on a ballot; 0 in a gallery that asks about pairs
    secret : the key for artifacts' ids, and for the order on the wall and of the pairs
    pairs : the largest number of pairs that a voter is asked about; 0 in a gallery with ballots
    """

    title: str
    closes: datetime
    marks: int
    secret: bytes
    pairs: int = 0

    def is_open(self, now: float) -> bool:
        """Return whether a ballot counts that arrives at this time, in seconds since the epoch."""
        return now < self.closes.timestamp()


@dataclass(frozen=True)
class Artifact:
    """An artifact on the wall; width and height are the pixels of its large picture."""

    id: str
    team: str
    title: str
    caption: str
    width: int
    height: int


@dataclass(frozen=True)
class Voter:
    """A student who may vote."""

    id: str
    name: str
    team: str


def create(
    folder: str | Path, title: str, closes: datetime, marks: int = 0, *, pairs: int = 0
) -> None:
    """Make a gallery in a folder that has none, completely or not at all.

    Parameters
    ----------
    folder : the folder, which is made if it is missing
    title : the gallery's title
    closes : the end of the vote, with its time zone
    marks : the largest number of votes on a ballot
    pairs : the largest number of pairs that a voter is asked about, instead of a ballot

    Raises
    ------
    FileExistsError
        If the folder has a gallery.
    InputError
        For an end without a time zone, and unless one of `marks` and `pairs` is at least 1 and the
        other 0.
    """
    folder = Path(folder)
    database = folder / DATABASE
    if closes.tzinfo is None:
        raise InputError(
            f"expected an end with its zone, such as 2026-12-01T23:59+01:00, got {closes}"
        )
    if min(marks, pairs) != 0 or max(marks, pairs) < 1:
        raise InputError(
            f"expected at least 1 vote on a ballot or at least 1 pair, got {marks} and {pairs}"
        )
    temporary.remove_leftovers(folder)
    if database.exists():
        raise _another_gallery(folder)
    row = (title, closes.isoformat(), marks, secrets.token_bytes(SECRET_BYTES), pairs)
    with (
        _new_folders(folder / PICTURES, database),
        temporary.temporary_folder(folder, target=database) as scratch,
    ):
        # SQLite's journal is in this folder, too
        unfinished = scratch / DATABASE
        unfinished.touch(mode=DATABASE_MODE)
        _write_tables(unfinished, row)
        try:
            temporary.move_new(unfinished, database)
        except FileExistsError:
            raise _another_gallery(folder) from None


@contextmanager
def _new_folders(folder: Path, database: Path) -> Iterator[None]:
    """Make a folder and its parents; if the block makes no database, remove those that were made."""
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        yield
    except BaseException:  # Ctrl-C as well
        if not database.exists():
            for path in missing:
                with suppress(OSError):
                    path.rmdir()
        raise


def _write_tables(path: Path, row: tuple[str, str, int, bytes, int]) -> None:
    """Write the tables of a new gallery, with its settings, into an empty file."""
    schema = SCHEMA_FILE.read_text(encoding="utf8")
    with _disk_errors(path), closing(sqlite3.connect(path, isolation_level=None)) as db:
        db.executescript(f"BEGIN; {schema} PRAGMA user_version = {SCHEMA_VERSION};")
        db.execute("INSERT INTO gallery VALUES (1, ?, ?, ?, ?, ?)", row)
        db.execute("COMMIT")


def _another_gallery(folder: Path) -> FileExistsError:
    return FileExistsError(f"{folder}: expected a folder without a gallery, there is one")


@contextmanager
def _disk_errors(path: Path) -> Iterator[None]:
    """Turn SQLite's errors of the disk and of its locks into an OSError or an InputError."""
    try:
        yield
    except sqlite3.OperationalError as error:
        code = getattr(error, "sqlite_errorcode", 0) & PRIMARY_CODE_MASK
        if code == sqlite3.SQLITE_BUSY:
            raise InputError(
                f"{path}: another process is writing to this gallery; try again"
            ) from None
        if code not in ERRNO_OF_CODE:
            raise
        number = errno.ENOSPC if temporary.is_disk_full(path.parent) else ERRNO_OF_CODE[code]
        raise OSError(number, os.strerror(number), str(path)) from None


def connect(folder: str | Path) -> sqlite3.Connection:
    """Open the gallery of a folder.

    Raises
    ------
    InputError
        If there is no gallery, its database is damaged, or it has the tables of another version of
        hdrlab.
    """
    path = Path(folder) / DATABASE
    if not path.is_file():
        raise InputError(
            f"{folder}: expected a gallery, there is none; `hdrlab gallery init` makes one"
        )
    try:
        with _disk_errors(path):
            db = _open(path)
            (version,) = db.execute("PRAGMA user_version").fetchone()
    except sqlite3.DatabaseError as error:
        raise InputError(
            f"{path}: expected a gallery's database, it cannot be read: {error}"
        ) from None
    if version != SCHEMA_VERSION:
        db.close()
        raise InputError(
            f"{folder}: expected a gallery of version {SCHEMA_VERSION}, got {max(version, 1)}; end "
            "this vote with the hdrlab that made it, or make a new gallery with `hdrlab gallery init`"
        )
    return db


def _open(path: Path) -> sqlite3.Connection:
    """Return a connection without implicit transactions, on which ballots are safe."""
    db = sqlite3.connect(
        path, timeout=LOCK_TIMEOUT_SECONDS, isolation_level=None, check_same_thread=False
    )
    try:
        for pragma in PRAGMAS:
            db.execute(f"PRAGMA {pragma}")
        # a file that is no database, or is damaged, is found here
        db.execute("PRAGMA user_version")
    except BaseException:
        db.close()
        raise
    return db


@contextmanager
def writing(folder: str | Path) -> Iterator[sqlite3.Connection]:
    """Yield a connection within a transaction, which is committed if the block raises nothing."""
    with closing(connect(folder)) as db, transaction(db):
        yield db


@contextmanager
def transaction(db: sqlite3.Connection) -> Iterator[None]:
    """Commit everything that the block writes, or nothing if it raises.

    Raises
    ------
    OSError
        If the disk is full or refuses to write.
    InputError
        If another process writes for longer than `LOCK_TIMEOUT_SECONDS`.
    """
    (_, _, path) = db.execute("PRAGMA database_list").fetchone()
    with _disk_errors(Path(path)), db:
        db.execute("BEGIN IMMEDIATE")
        yield


def settings(db: sqlite3.Connection) -> Settings:
    """Read the settings of a gallery."""
    row = db.execute("SELECT title, closes, marks, secret, pairs FROM gallery").fetchone()
    title, closes, marks, secret, pairs = row
    return Settings(
        title=title,
        closes=datetime.fromisoformat(closes),
        marks=marks,
        secret=secret,
        pairs=pairs,
    )


def close(db: sqlite3.Connection, now: datetime) -> None:
    """Set the end of the vote to now."""
    db.execute("UPDATE gallery SET closes = ?", (now.isoformat(),))


def artifacts(db: sqlite3.Connection) -> dict[str, Artifact]:
    """Return the artifacts on the wall, by id."""
    rows = db.execute(
        "SELECT id, team, title, caption, width, height FROM artifacts WHERE hangs ORDER BY id"
    )
    return {
        id: Artifact(id=id, team=team, title=title, caption=caption, width=width, height=height)
        for id, team, title, caption, width, height in rows
    }


def hangs(db: sqlite3.Connection, id: str) -> bool:
    """Return whether an artifact is on the wall."""
    row = db.execute("SELECT 1 FROM artifacts WHERE hangs AND id = ?", (id,)).fetchone()
    return row is not None


def hang(db: sqlite3.Connection, artifact: Artifact, source: str = "") -> int:
    """Put an artifact on the wall in place of the team's earlier one.

    The earlier one keeps its votes, which count again if the team hands it in again. The database
    records the change.

    Parameters
    ----------
    db : connection to the database, within a transaction
    artifact : the new artifact
    source : name of the file that was handed in

    Returns
    -------
    int
        The number of votes of the earlier artifact, which do not count any more.
    """
    earlier = db.execute(
        "SELECT id FROM artifacts WHERE hangs AND team = ?", (artifact.team,)
    ).fetchone()
    db.execute("UPDATE artifacts SET hangs = 0 WHERE team = ?", (artifact.team,))
    insert = (
        "INSERT INTO artifacts VALUES (:id, :team, :title, :caption, :width, :height, 1) "
        "ON CONFLICT (id) DO UPDATE SET title = excluded.title, caption = excluded.caption, hangs = 1"
    )
    db.execute(insert, asdict(artifact))
    if earlier is None or earlier[0] == artifact.id:
        return 0
    query = (
        "SELECT (SELECT count(*) FROM votes WHERE artifact = :id) "
        "+ (SELECT count(*) FROM comparisons WHERE :id IN (first, second))"
    )
    (votes,) = db.execute(query, {"id": earlier[0]}).fetchone()
    now = datetime.now(UTC).isoformat()
    change = (now, artifact.team, source, earlier[0], artifact.id, votes)
    db.execute("INSERT INTO changes VALUES (?, ?, ?, ?, ?, ?)", change)
    return int(votes)


def changes(db: sqlite3.Connection) -> list[str]:
    """Return a sentence for each artifact that replaced another, the first change first."""
    rows = db.execute("SELECT at, team, source, votes FROM changes ORDER BY at")
    return [
        f"{at[:19]} UTC: {team} has hung another picture ({source}); "
        f"{votes} votes for the first do not count"
        for at, team, source, votes in rows
    ]


def voters(db: sqlite3.Connection) -> list[Voter]:
    """Return the voters, sorted by id."""
    rows = db.execute("SELECT id, name, team FROM voters ORDER BY id")
    return [Voter(id=id, name=name, team=team) for id, name, team in rows]


def admit(db: sqlite3.Connection, voter: Voter) -> None:
    """Add a voter, or change the name and team of one that is there."""
    insert = (
        "INSERT INTO voters (id, name, team) VALUES (:id, :name, :team) "
        "ON CONFLICT (id) DO UPDATE SET name = excluded.name, team = excluded.team"
    )
    db.execute(insert, asdict(voter))


def format_time(when: datetime) -> str:
    """Return a time as it is written in a sentence, with its time zone."""
    return f"{when:%A} {when.day} {when:%B %Y}, {when:%H:%M} ({when.tzname()})"
