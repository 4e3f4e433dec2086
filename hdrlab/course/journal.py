"""Work that is done once, whatever happens meanwhile: a file for each piece, written whole or not at all.

A piece is named by its owner and a key, which is a digest of all that its result rests on. What is there is
done; what is not will be done by the next run. Each piece runs in a process of its own: one that dies is
tried again, three times in all, and then told of. The run may be killed at any moment, and so may they.
"""

import hashlib
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from multiprocessing import connection, get_context
from pathlib import Path
from typing import Any, NamedTuple

TRIES = 3


class Piece(NamedTuple):
    """A submission to be graded: whose, where, and the key of what its result rests on."""

    owner: str
    path: Path
    key: str


Work = Callable[[Piece], bytes]  # a submission -> the bytes of its result; it can be sent to a process


class Done(NamedTuple):
    """What became of a piece: where its result is, or why there is none; `fresh` if it was done just now."""

    piece: Piece
    result: Path | None
    why: str = ""
    fresh: bool = True


class _Running(NamedTuple):
    piece: Piece
    process: Any
    until: float


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
    """Write a file so that after a power failure, too, it is there whole or not at all."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    with open(temporary, "wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    os.replace(temporary, path)
    if hasattr(os, "O_DIRECTORY"):
        handle = os.open(path.parent, os.O_DIRECTORY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def done_steps(
    pieces: Sequence[Piece],
    work: Work,
    folder: Path,
    *,
    jobs: int = 1,
    again: bool = False,
    patience: float = 1800.0,
) -> Iterator[Done]:
    """Yield what became of each piece, those first that were done before.

    Parameters
    ----------
    pieces : each owner once
    work : returns the bytes of a result; it runs in another process
    folder : of the results, made where it is missing
    jobs : processes at a time
    again : do what was done before, too
    patience : seconds for one try

    Raises
    ------
    ValueError
        For an owner who is there twice.
    """
    if len({piece.owner for piece in pieces}) < len(pieces):
        raise ValueError("expected each owner once")
    folder.mkdir(parents=True, exist_ok=True)
    waiting = []
    for piece in pieces:
        if place(folder, piece).is_file() and not again:
            yield Done(piece, place(folder, piece), fresh=False)
        else:
            waiting.append(piece)
    yield from _run(waiting, work, folder, jobs, patience)


def _run(waiting: list[Piece], work: Work, folder: Path, jobs: int, patience: float) -> Iterator[Done]:
    tries: dict[str, int] = {}
    running: list[_Running] = []
    try:
        while waiting or running:
            while waiting and len(running) < jobs:
                running.append(_start(waiting.pop(0), work, folder, patience))
            for one in _ended(running):
                running.remove(one)
                tries[one.piece.owner] = tries.get(one.piece.owner, 0) + 1
                code = one.process.exitcode
                if code == 0:
                    _forget_older(folder, one.piece)
                    yield Done(one.piece, place(folder, one.piece))
                elif tries[one.piece.owner] < TRIES:
                    waiting.append(one.piece)  # elsewhere, and after the others
                else:
                    yield Done(one.piece, None, f"its grading ended {TRIES} times without a result ({code})")
    finally:  # an error, or Ctrl-C: what runs would be done again by the next run
        for one in running:
            one.process.kill()
            one.process.join()


def _start(piece: Piece, work: Work, folder: Path, patience: float) -> _Running:
    process = get_context("spawn").Process(target=_do, args=(work, piece, place(folder, piece)))
    process.start()
    return _Running(piece, process, time.monotonic() + patience)


def _do(work: Work, piece: Piece, result: Path) -> None:
    """Grade one submission, in its own process."""
    write(result, work(piece))


def _ended(running: list[_Running]) -> list[_Running]:
    """Wait a little, end those that took too long, and return those that have ended."""
    connection.wait([one.process.sentinel for one in running], timeout=0.5)
    for one in running:
        if time.monotonic() > one.until:
            one.process.kill()
    ended = [one for one in running if not one.process.is_alive()]
    for one in ended:
        one.process.join()
    return ended


def _forget_older(folder: Path, piece: Piece) -> None:
    """Remove an owner's results of another key, and what a killed process left of this one."""
    for older in folder.glob(f"{_plain(piece.owner)}.*.json"):
        if older != place(folder, piece) and older.name.count(".") == piece.owner.count(".") + 2:
            older.unlink(missing_ok=True)
    for rest in folder.glob(f".{_plain(piece.owner)}.*.json.*"):
        rest.unlink(missing_ok=True)


def _plain(owner: str) -> str:
    """Return an owner's name for a pattern of file names."""
    return "".join(f"[{letter}]" if letter in "*?[" else letter for letter in owner)


def results(folder: Path, pieces: Mapping[str, Piece]) -> dict[str, bytes]:
    """Return the results that are there, by owner."""
    there = {owner: place(folder, piece) for owner, piece in pieces.items()}
    return {owner: path.read_bytes() for owner, path in there.items() if path.is_file()}
