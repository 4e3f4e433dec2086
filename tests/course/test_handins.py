"""Who owns a submitted file and when it was received."""

import hashlib
import os
import stat
from datetime import UTC, datetime, timedelta
from pathlib import Path
from types import SimpleNamespace

import pytest

from hdrlab.course.students.roster import Roster, Student
from hdrlab.course.submissions import class_folder

ROSTER = Roster(
    tuple(
        Student(id, id, "t1" if id in ("b01", "b02") else id) for id in ("b01", "b02", "b05", "b06")
    )
)
NOON = datetime(2026, 3, 1, 12, tzinfo=UTC)
LATE = NOON + timedelta(days=9)


@pytest.fixture
def find(tmp_path):
    """find({name: text}, rows) -> the scan of a folder with these files, whose own times are late."""

    def find(files, rows=None, roster=ROSTER):
        for name, text in files.items():
            path = tmp_path / "in" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
            os.utime(path, (LATE.timestamp(),) * 2)
        if rows is None:
            return class_folder.find(tmp_path / "in", roster)
        table = tmp_path / "times.csv"
        table.write_text(
            "\n".join(
                ["file,received", *(f"{name},{when.isoformat()}" for name, when in rows.items())]
            )
        )
        return class_folder.find(tmp_path / "in", roster, class_folder.read_times(table))

    return find


def received_times(scan):
    return {team: submission.received for team, submission in scan.submissions.items()}


def test_a_file_in_another_students_folder_does_not_get_a_received_time_by_its_name(find):
    scan = find({"b05_hw2.ipynb": "x", "b06/b05_hw2.ipynb": "y"}, {"b05_hw2.ipynb": NOON})
    assert received_times(scan) == {"b05": NOON, "b06": LATE}
    assert any("b06/b05_hw2.ipynb" in note and "not in the table" in note for note in scan.notes)
    assert "not in the table" in scan.submissions["b06"].note and not scan.submissions["b05"].note


@pytest.mark.parametrize("name", ["b05/hw2.ipynb", "./b05/hw2.ipynb", "b05\\hw2.ipynb"])
def test_received_times_are_found_with_one_folder_per_student(find, name):
    scan = find({"b05/hw2.ipynb": "x", "b06/hw2.ipynb": "y"}, {name: NOON, "b06/hw2.ipynb": NOON})
    assert received_times(scan) == {"b05": NOON, "b06": NOON} and scan.notes == ()


@pytest.mark.parametrize(
    "theirs", ["b05_hw2.ipynb", "B05_hw2.ipynb", "b05.ipynb", "hw2.ipynb", "t1_hw2.ipynb"]
)
def test_a_file_name_cannot_claim_the_received_time_of_another_student(find, theirs):
    scan = find({f"b06/{theirs}": "y"}, {theirs: NOON})
    assert received_times(scan) == {"b06": LATE}
    assert any("there is no such file" in note for note in scan.notes)


def test_a_received_time_without_a_folder_applies_to_the_file_in_the_folder_of_its_owner(find):
    scan = find({"b05/b05_hw2.ipynb": "x"}, {"b05_hw2.ipynb": NOON})
    assert received_times(scan) == {"b05": NOON} and scan.notes == ()


def test_received_times_without_a_file_and_files_without_a_time_are_noted(find):
    scan = find({"b05.py": "x", "b06.py": "y"}, {"b05.py": NOON, "b02.py": NOON})
    assert any(note.startswith("b02.py") and "no such file" in note for note in scan.notes)
    assert any(note.startswith("b06.py") and "not in the table" in note for note in scan.notes)
    assert len(scan.notes) == 2


def test_without_a_table_of_received_times_there_is_no_note(find):
    assert find({"b05.py": "x"}).notes == ()


def test_two_received_times_for_one_file_are_an_error(find):
    with pytest.raises(ValueError, match="each file once"):
        find({"b05.py": "x"}, {"b05.py": NOON, "./b05.py": LATE})


def test_file_names_match_in_any_unicode_normalization(find):
    roster = Roster((Student("zo\u00e9", "Z", "zo\u00e9"),))
    scan = find({"zoe\u0301_hw2.py": "x"}, {"zo\u00e9_hw2.py": NOON}, roster)
    assert received_times(scan) == {"zo\u00e9": NOON}


@pytest.mark.parametrize("name", ["b05", "B05", "\uff22\uff10\uff15"])
@pytest.mark.parametrize("rest", ["_hw2.py", "-b06.py", ".py", " (1).py", "/b06.py", "/t1_hw2.py"])
def test_a_file_belongs_to_the_student_that_its_name_or_folder_starts_with(find, name, rest):
    assert set(find({f"{name}{rest}": "x"}).submissions) == {"b05"}


@pytest.mark.parametrize(
    "name", ["b055.py", "b0.py", "xb05.py", "\u200bb05.py", "b05\u0301.py", "nobody/b05.py"]
)
def test_a_name_that_only_resembles_a_student_is_not_assigned(find, name):
    scan = find({name: "x"})
    assert scan.submissions == {} and "no student or team" in scan.notes[0]


def awkward(kind, path):
    """Make something that is not a file, or a file that cannot be graded."""
    path.parent.mkdir(exist_ok=True)
    if kind == "link":
        path.symlink_to("/etc/passwd")
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
        (path / "hw2.py").write_text("x")
    elif kind == "sparse":
        with open(path, "wb") as file:
            file.truncate(200 << 30)
    else:
        path.write_text("x")


@pytest.mark.parametrize("kind", ["link", "pipe", "folder", "sparse", "document"])
def test_an_ungradable_file_is_noted_and_other_submissions_are_found(find, tmp_path, kind):
    if kind == "pipe" and not hasattr(os, "mkfifo"):
        pytest.skip("this system has no named pipes")
    odd = tmp_path / "in" / "b05" / ("hw2.docx" if kind == "document" else "hw2.py")
    odd.parent.mkdir(parents=True)
    awkward(kind, odd)
    scan = find({"b06.py": "y"})
    assert set(scan.submissions) == {"b06"} and set(scan.refused) == {"b05"}
    assert scan.refused["b05"] == scan.notes[0] and scan.notes[0].startswith("b05/hw2")


def test_a_folder_with_too_many_files_gives_one_note(find, tmp_path):
    (tmp_path / "in" / "b05").mkdir(parents=True)
    for k in range(class_folder.MAX_FILES_PER_FOLDER + 1):
        (tmp_path / "in" / "b05" / f"{k}.py").touch()
    scan = find({"b06.py": "y"})
    (note,) = scan.notes
    assert note.startswith("b05") and "1000 files" in note
    assert set(scan.submissions) == {"b06"} and scan.refused == {"b05": scan.notes[0]}


def test_an_unreadable_file_is_noted(find, monkeypatch):
    real = os.access
    monkeypatch.setattr(
        os, "access", lambda path, mode: "b05" not in str(path) and real(path, mode)
    )
    scan = find({"b05.py": "x", "b06.py": "y"})
    assert scan.refused == {"b05": "b05.py: a file that cannot be read"}
    assert set(scan.submissions) == {"b06"}


def test_only_the_file_that_counts_is_read(find, monkeypatch):
    read = []

    def file_digest(file, algorithm):
        read.append(Path(file.name).name)
        return hashlib.new(algorithm)

    monkeypatch.setattr(hashlib, "file_digest", file_digest)
    find({f"b05/{k}.py": "x" for k in range(9)} | {"b06.py": "y"})
    assert read == ["8.py", "b06.py"]


@pytest.mark.parametrize("seconds", [316_000_000_000, 1e30, -1e15])
def test_an_impossible_modification_time_is_noted(seconds, monkeypatch):
    status = SimpleNamespace(st_mode=stat.S_IFREG, st_size=1, st_mtime=seconds)
    monkeypatch.setattr(os, "access", lambda *arguments: True)
    odd = SimpleNamespace(name="b05.py", lstat=lambda: status)
    assert "before the year 10000" in class_folder.find_problem(odd)


def test_an_ungradable_file_does_not_hide_an_earlier_valid_one(find, tmp_path):
    (tmp_path / "in" / "b05").mkdir(parents=True)
    awkward("link", tmp_path / "in" / "b05" / "later.py")
    scan = find({"b05/hw2.py": "x"})
    assert scan.submissions["b05"].path.name == "hw2.py"
    assert scan.refused == {}
    assert len(scan.notes) == 1


def test_a_file_without_a_received_time_cannot_be_late_unless_file_times_count(tmp_path):
    (tmp_path / "b05.py").write_text("x")
    for file_times in (False, True):
        scan = class_folder.find(tmp_path, ROSTER, file_times=file_times)
        assert scan.submissions["b05"].can_be_late == file_times
    timed = class_folder.find(tmp_path, ROSTER, {"b05.py": NOON})
    assert timed.submissions["b05"].can_be_late
