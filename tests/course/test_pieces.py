"""Pieces of work, by the book: which is begun when, how often, what is written, and what is removed."""

import hashlib
import os
import stat
from collections import deque
from pathlib import Path

import pytest

from hdrlab.course.classroom import journal
from hdrlab.course.classroom.journal import Done, Ending, Piece


def pieces(*owners, key="k"):
    return [Piece(owner, Path(f"{owner}.py"), key) for owner in owners]


class Book:
    """An executor with so much room, each of whose tries ends as the book says."""

    def __init__(self, room=1, **book):
        self.room, self.begun, self.running = room, [], deque()
        self.book = {owner: list(endings) for owner, endings in book.items()}

    def start(self, piece, *, alone=False):
        assert piece not in self.running
        if len(self.running) >= self.room or (alone and self.running):
            return False
        self.running.append(piece)
        self.begun.append(piece.owner + "!" * alone)
        return True

    def endings(self):
        assert self.running, "nothing runs, and it is waited for"
        piece = self.running.popleft()
        said = self.book.get(piece.owner) or [b"right"]
        end = said.pop(0) if len(said) > 1 else said[0]
        if isinstance(end, bytes):
            return [Ending(piece, end)]
        return [Ending(piece, None, end.rstrip("?"), blamed=not end.endswith("?"))]


def test_a_piece_is_tried_three_times_and_its_defaults_blame_it():
    assert journal.TRIES == 3
    (piece,) = pieces("a")
    assert Ending(piece, None) == (piece, None, "", True) and Done(piece, None) == (
        piece,
        None,
        "",
        True,
    )


def test_each_result_is_written_for_its_owner_alone_as_soon_as_it_is_there(tmp_path):
    folder, wanted = tmp_path / "new" / "results", pieces("a", "b")
    steps = journal.done_steps(wanted, Book(2, a=[b"one"], b=[b"two"]), folder)
    assert next(steps) == (wanted[0], folder / "a.k.json", "", True)
    assert [path.name for path in folder.iterdir()] == ["a.k.json"]
    assert next(steps) == (wanted[1], folder / "b.k.json", "", True) and next(steps, None) is None
    assert [(folder / f"{name}.k.json").read_bytes() for name in "ab"] == [b"one", b"two"]
    assert stat.S_IMODE((folder / "a.k.json").stat().st_mode) == 0o600
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700


@pytest.mark.parametrize(
    ("room", "book", "begun", "done"),
    [
        (1, {}, "a b c", "a b c"),
        (9, {}, "a b c", "a b c"),
        (2, {"a": ["no", b"yes"]}, "a b c a", "b c a"),
        (1, {"a": ["no", "no", b"yes"]}, "a b c a a", "b c a"),
        (1, {"a": ["no"]}, "a b c a a", "b c -a"),
        (3, {"a": ["lost?", b"yes"]}, "a b c a!", "b c a"),
        (1, {"a": ["lost?", b"yes"]}, "a a! b c", "a b c"),
        (1, {"a": ["lost?"] * 5 + [b"yes"]}, "a a! a! a! a! a! b c", "a b c"),
        (1, {"a": ["lost?", "no", "lost?", "no", "no"]}, "a a! b c a! a! a!", "b c -a"),
        (3, {"b": ["lost?", b"yes"], "c": ["lost?", b"yes"]}, "a b c c! b!", "a c b"),
    ],
)
def test_who_is_blamed_waits_and_who_is_not_is_next_and_alone(room, book, begun, done, tmp_path):
    executor = Book(room, **book)
    found = list(journal.done_steps(pieces("a", "b", "c"), executor, tmp_path))
    assert " ".join(executor.begun) == begun
    assert " ".join(("" if one.result else "-") + one.piece.owner for one in found) == done
    whys = {one.why for one in found if not one.result}
    assert whys <= {"it ended 3 times without a result: no"} and bool(whys) is ("-" in done)


def test_why_there_is_no_result_is_told_in_four_hundred_characters(tmp_path):
    (found,) = journal.done_steps(pieces("a"), Book(a=["n" * 500]), tmp_path)
    assert len(found.why) == 400 and found.why.startswith("it ended 3 times without a result: nnn")


def test_older_results_of_an_owner_go_when_the_new_one_is_there_and_those_of_others_stay(tmp_path):
    old, other, dotted = (tmp_path / name for name in ("a.1.json", "b.1.json", "a.b.1.json"))
    for path in (old, other, dotted, tmp_path / "a.txt"):
        path.write_bytes(b"old")
    wanted = pieces("a")
    assert journal.older(tmp_path, wanted) == {"a": [old]}
    assert journal.older(tmp_path, pieces("a.b", key="2")) == {"a.b": [dotted]}
    assert (
        journal.older(tmp_path, pieces("a", key="1")) == {} == journal.older(tmp_path, pieces("x"))
    )
    (failed,) = journal.done_steps(wanted, Book(a=["no"]), tmp_path)
    assert failed.result is None and old.exists()
    steps = journal.done_steps(wanted, Book(), tmp_path)
    old.unlink()
    assert next(steps).result == tmp_path / "a.k.json"
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "a.b.1.json",
        "a.k.json",
        "a.txt",
        "b.1.json",
    ]
    old.write_bytes(b"old")
    list(journal.done_steps(wanted, Book(), tmp_path))
    assert not old.exists() and other.exists() and dotted.exists()


def test_what_is_there_is_done_and_the_rest_is_to_be_done_and_may_be_forgotten(tmp_path):
    a, b = wanted = pieces("a", "b")
    journal.write(journal.place(tmp_path, b), b"x")
    assert journal.parted(tmp_path, wanted) == ([Done(b, tmp_path / "b.k.json", "", False)], [a])
    journal.forget(tmp_path, wanted)
    assert journal.parted(tmp_path, wanted) == ([], wanted)
    assert journal.parted(tmp_path, []) == ([], [])
    with pytest.raises(ValueError, match="expected each owner once"):
        journal.parted(tmp_path, [a, b, a._replace(key="other")])


def test_a_key_is_a_digest_of_its_parts_and_their_lengths():
    assert journal.key("a", "bc") == hashlib.sha256(b"1:a2:bc").hexdigest()[:16]
    assert len({journal.key(), journal.key(""), journal.key("", ""), journal.key("1:")}) == 4


def test_a_file_is_on_the_disk_before_it_has_its_name_and_then_its_folder_is(tmp_path, monkeypatch):
    synced, handles, real = [], [], os.fsync

    def fsync(handle):
        handles.append(handle)
        kind = os.fstat(handle)
        synced.append(
            ("folder" if stat.S_ISDIR(kind.st_mode) else kind.st_size, (tmp_path / "a").exists())
        )
        real(handle)

    monkeypatch.setattr(os, "fsync", fsync)
    journal.write(tmp_path / "a", b"data")
    assert [one for one in synced if one[0] != "folder"][0] == (4, False)
    assert synced[-1] == ("folder", True) and (tmp_path / "a").read_bytes() == b"data"
    assert stat.S_IMODE((tmp_path / "a").stat().st_mode) == 0o600
    with pytest.raises(OSError, match="."):
        os.fstat(handles[-1])
    monkeypatch.delattr(os, "O_DIRECTORY")
    journal.write(tmp_path / "a", b"more")
    assert (tmp_path / "a").read_bytes() == b"more"


def test_a_private_folder_is_its_owners_also_where_it_was_everybodys(tmp_path):
    (tmp_path / "open").mkdir(mode=0o755)
    for folder in (tmp_path / "open", tmp_path / "a" / "b"):
        assert journal.make_private(folder) == folder
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700


def test_a_folder_is_held_by_one_run_and_cleared_of_what_is_half_written(tmp_path):
    folder = tmp_path / "a" / "results"
    with journal.lock_folder(folder):
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
        with (
            pytest.raises(ValueError, match="results: another run is writing to it"),
            journal.lock_folder(folder),
        ):
            pass
        (folder / "in").mkdir()
        for name in (".hdrlab-1", "in/.hdrlab-2", "kept.json"):
            (folder / name).touch()
    with journal.lock_folder(folder):
        assert sorted(path.name for path in folder.rglob("*")) == ["in", "kept.json"]
