"""Work that is done once, whatever happens meanwhile: a file for each piece, written whole or not at all.

A piece is named by its owner and a key, which is a digest of all that its result rests on. What is
there is done; what is not will be done by the next run. Pieces are done by an executor, on this
machine (`processes`) or on many (`cluster`), and written here. One that ends without a result is
tried again, three times in all, and then told of. The run may be killed at any moment, and so may
those of its executor.
"""

import contextlib
import hashlib
import os
from collections import Counter, deque
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple, Protocol, Self

from hdrlab.course import scratch
from hdrlab.course.wording import plain
from hdrlab.errors import InputError
from hdrlab.io.files import replacing

TRIES = 3


class Piece(NamedTuple):
    """A submission to be graded: whose, where, and the key of what its result rests on."""

    owner: str
    path: Path
    key: str


Work = Callable[[Piece], bytes]  # what is done of a piece


class Done(NamedTuple):
    """What became of a piece: where its result is, or why there is none; `fresh` if it was done just now."""

    piece: Piece
    result: Path | None
    why: str = ""
    fresh: bool = True


class Ending(NamedTuple):
    """How one try of a piece ended.

    Attributes
    ----------
    piece : Piece
    result : its bytes, or None
    why : there is none
    blamed : whether that is the piece's own doing, as far as can be told; else it is tried again
        alone
    """

    piece: Piece
    result: bytes | None
    why: str = ""
    blamed: bool = True


class Executor(Protocol):
    """Those who do the pieces, each in a process of its own; used in a with statement."""

    def start(self, piece: Piece, *, alone: bool = False) -> bool:
        """Begin a piece if there is room for it, with no other beside it where it is to be `alone`."""

    def endings(self) -> Sequence[Ending]:
        """Wait a little, and return what has ended."""

    def __enter__(self) -> Self:
        """Make ready."""

    def __exit__(self, *error: object) -> None:
        """End what runs."""


def key(*parts: str) -> str:
    """Return the key of what a result rests on.

    Examples
    --------
    >>> key("a", "bc") != key("ab", "c")
    True
    """
    digest = hashlib.sha256()
    for part in parts:
        digest.update(f"{len(part)}:{part}".encode())
    return digest.hexdigest()[:16]


def place(folder: Path, piece: Piece) -> Path:
    """Return where the result of a piece is kept."""
    return folder / f"{piece.owner}.{piece.key}.json"


def write(path: Path, data: bytes) -> None:
    """Write a file for its owner's eyes; after a power failure, too, it is there whole or not at all."""
    with replacing(path, private=True) as temporary, open(temporary, "wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    if hasattr(os, "O_DIRECTORY"):
        handle = os.open(path.parent, os.O_DIRECTORY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def make_private(folder: Path) -> Path:
    """Make a folder that nobody but its owner can open, also where it is there already; return it."""
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    folder.chmod(0o700)
    return folder


@contextlib.contextmanager
def lock_folder(folder: Path) -> Iterator[None]:
    """Make a folder and hold it for one run; what a killed one left half written in it is removed.

    Raises
    ------
    ValueError
        Where another run holds it. Who is killed holds nothing.
    """
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    with contextlib.ExitStack() as held:
        try:
            held.enter_context(scratch.locked(folder.resolve()))
        except BlockingIOError:
            raise InputError(f"{folder}: another run is writing to it") from None
        for rest in folder.rglob(".hdrlab-*"):
            rest.unlink(missing_ok=True)
        yield


def forget(folder: Path, pieces: Sequence[Piece]) -> None:
    """Remove the results of pieces, which are then to be done again, by this run or the next."""
    for piece in pieces:
        place(folder, piece).unlink(missing_ok=True)


def parted(folder: Path, pieces: Sequence[Piece]) -> tuple[list[Done], list[Piece]]:
    """Return what was done before, and what is to be done.

    Raises
    ------
    ValueError
        For an owner who is there twice.
    """
    if len({piece.owner for piece in pieces}) < len(pieces):
        raise InputError("expected each owner once")
    there = set(folder.glob("*.json"))
    before = [Done(piece, place(folder, piece), fresh=False) for piece in pieces]
    rest = [one.piece for one in before if one.result not in there]
    return [one for one in before if one.result in there], rest


def done_steps(pieces: Sequence[Piece], executor: Executor, folder: Path) -> Iterator[Done]:
    """Yield what became of each piece, as soon as it is known; an owner's older results are removed.

    Parameters
    ----------
    pieces : what is to be done, each owner once
    executor : does it
    folder : of the results, made where it is missing
    """
    make_private(folder)
    former = older(folder, pieces)
    for ending in _endings(pieces, executor):
        piece, result = ending.piece, ending.result
        if result is None:
            yield Done(
                piece, None, plain(f"it ended {TRIES} times without a result: {ending.why}", 400)
            )
            continue
        write(place(folder, piece), result)
        for path in former.get(piece.owner, ()):
            path.unlink(missing_ok=True)
        yield Done(piece, place(folder, piece))


def _endings(pieces: Sequence[Piece], executor: Executor) -> Iterator[Ending]:
    """Yield the last ending of each piece: with a result, or the third without."""
    waiting, doubted, running = deque(pieces), set(), 0
    tries: Counter[str] = Counter()
    while waiting or running:
        while waiting and executor.start(waiting[0], alone=waiting[0].owner in doubted):
            waiting.popleft()
            running += 1
        for ending in executor.endings():
            running -= 1
            owner = ending.piece.owner
            tries[owner] += ending.blamed
            if ending.result is not None or tries[owner] == TRIES:
                yield ending
            elif ending.blamed:
                waiting.append(ending.piece)  # elsewhere, and after the others
            else:
                doubted.add(owner)
                waiting.appendleft(ending.piece)


def older(folder: Path, pieces: Sequence[Piece]) -> dict[str, list[Path]]:
    """Return the results of other keys, by owner."""
    names = {piece.owner: place(folder, piece).name for piece in pieces}
    found: dict[str, list[Path]] = {}
    for path in folder.glob("*.json"):
        owner = path.name.rsplit(".", 2)[0]
        if owner in names and path.name != names[owner]:
            found.setdefault(owner, []).append(path)
    return found
