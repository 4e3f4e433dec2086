"""Files that are hard to read, links, pipes and folders: each takes a few seconds at most and is reported."""

import codecs
import json
import os
import re
import zipfile
from pathlib import Path

import pytest
from support import hostile_submissions
from support.malicious_archives import MALICIOUS_ARCHIVES
from support.one_task_homework import CORRECT_CODE

from hdrlab.course.students.roster import Roster, Student
from hdrlab.course.submissions import class_folder, reader

pytestmark = pytest.mark.grading

resource = pytest.importorskip("resource", reason="this system counts no process's seconds")
LOST = {  # what can not be read; of the others the right function at the end is found
    *("empty dictionaries", "deep lists", "deep dictionaries", "a long number"),
    *(
        "many cells that are no Python",
        "sheets that are no lists",
        "a cell's source that is a number",
    ),
    *("names of cells", "NUL", "an unknown coding", "a coding that is slow", "UTF-16 cut short"),
    *(
        "brackets in brackets",
        "signs in a row",
        "too much code",
        "a task that is too long",
        "a long sum",
    ),
    "a long chain of attributes",
}
HAT = re.compile(r"import numpy as np\n.*", re.DOTALL)


def spent():
    """Return the processor time of all child processes that have ended, in seconds."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


@pytest.mark.parametrize("name", hostile_submissions.UNREADABLE_FILES)
def test_reading_a_hostile_file_is_limited_in_time_and_reported(name, tmp_path):
    ending, made = hostile_submissions.UNREADABLE_FILES[name]
    file = tmp_path / f"hat{ending}"
    file.write_bytes(made())
    before = spent()
    submission = reader.read(file, "hw2", ["hat"])
    assert spent() - before < reader.READING_CPU_SECONDS + 1.5
    assert all(problem.isprintable() and len(problem) <= 300 for problem in submission.problems)
    assert len(submission.problems) <= reader.MAX_SHOWN_PROBLEMS + 1
    assert submission.sources or submission.problems
    assert not (name in LOST and submission.sources)
    if submission.sources:  # the right function is at the end of each file
        scope = {}
        exec(HAT.search(submission.sources["hat"])[0], scope)
        assert scope["hat"](3).tolist() == [0, 2, 0]


RIGHT = {  # an honest file, as its author's editor has saved it
    "a byte order mark": (".py", codecs.BOM_UTF8 + CORRECT_CODE.encode()),
    "a byte order mark, notebook": (
        ".ipynb",
        codecs.BOM_UTF8 + hostile_submissions.notebook(CORRECT_CODE),
    ),
    "UTF-16": (".py", CORRECT_CODE.encode("utf-16")),
    "UTF-16, notebook": (
        ".ipynb",
        hostile_submissions.notebook(CORRECT_CODE).decode().encode("utf-16"),
    ),
    "Latin-1 with its coding": (
        ".py",
        ("# -*- coding: latin-1 -*-\n# für Müller\n" + CORRECT_CODE).encode("latin-1"),
    ),
    "version 3": (
        ".ipynb",
        json.dumps(
            {
                "worksheets": [{"cells": [{"cell_type": "code", "input": [CORRECT_CODE]}]}],
                "nbformat": 3,
            }
        ).encode(),
    ),
    "all of numpy": (
        ".py",
        b"from numpy import *\ndef hat(n=256):\n    return n - 1 - abs(2 * arange(n) - n + 1)\n",
    ),
    "pictures that are not there": (".py", b"from pylab import *\n" + CORRECT_CODE.encode()),
    "capitals": (".IPYNB", hostile_submissions.notebook(CORRECT_CODE)),
    "lines of a Macintosh": (".py", CORRECT_CODE.replace("\n", "\r").encode()),
}


@pytest.mark.parametrize("name", RIGHT)
def test_an_unusual_but_valid_file_is_read_correctly(name, tmp_path):
    ending, data = RIGHT[name]
    (tmp_path / f"hw2{ending}").write_bytes(data)
    submission = reader.tasks_of(tmp_path / f"hw2{ending}", ["hat"])
    scope = {}
    exec(submission.sources["hat"], scope)
    assert scope["hat"](3).tolist() == [0, 2, 0] and not submission.problems


def test_an_archive_is_read_within_the_same_limits(tmp_path):
    ending, made = hostile_submissions.UNREADABLE_FILES["blank lines"]
    with zipfile.ZipFile(tmp_path / "b1.zip", "w") as archive:
        archive.writestr("hw2.py", made())
    assert set(reader.read(tmp_path / "b1.zip", "hw2", ["hat"]).sources) == {"hat"}
    (problem,) = reader.read(
        MALICIOUS_ARCHIVES["a bomb in a tar.bz2"](tmp_path / "b2.tar"), "hw2", ["hat"]
    ).problems
    assert problem.startswith("The archive is refused: ")


def test_a_killed_reader_is_an_error_and_not_the_fault_of_the_file(tmp_path, monkeypatch):
    monkeypatch.setattr(reader, "_read_as_json", _killed)
    (tmp_path / "hw2.py").write_text(CORRECT_CODE)
    with pytest.raises(ValueError, match="could not be read"):
        reader.read(tmp_path / "hw2.py", "hw2", ["hat"])


def _killed(order):
    os.kill(os.getpid(), 9)


def test_a_killed_reader_is_restarted(tmp_path, monkeypatch):
    (tmp_path / "hw2.py").write_text(CORRECT_CODE)
    monkeypatch.setattr(reader, "_read_as_json", _killed_twice)
    assert set(reader.read(tmp_path / "hw2.py", "hw2", ["hat"]).sources) == {"hat"}
    assert len(list(tmp_path.glob("killed*"))) == 2


READ = reader._read_as_json


def _killed_twice(order):
    before = len(list(order[0].parent.glob("killed*")))
    if before < 2:
        (order[0].parent / f"killed{before}").touch()
        os.kill(os.getpid(), 9)
    return READ(order)


ROSTER = Roster((Student("b1", "Ada", "b1"), Student("b2", "Bo", "b2")))


@pytest.mark.parametrize("name", hostile_submissions.ODD_FILES)
def test_an_odd_file_is_noted_and_does_not_affect_others(name, tmp_path):
    ending, made = hostile_submissions.ODD_FILES[name]
    made(tmp_path / f"b1_hw2{ending}")
    (tmp_path / "b2_hw2.py").write_text(CORRECT_CODE)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_utime
    scan = class_folder.find(tmp_path, ROSTER)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_utime - before < 1
    assert "b2" in scan.submissions
    assert all(note.isprintable() and len(note) < 250 for note in scan.notes)
    if name in ("an empty file", "a notebook of 60 MB"):
        read = reader.tasks_of(scan.submissions["b1"].path, ["hat"])
        assert "is empty" in read.problems[0] or "is larger than 50 MB" in read.problems[0]
    else:
        assert "b1" not in scan.submissions and scan.refused["b1"] in scan.notes


def test_a_readable_file_counts_if_a_later_one_is_refused(tmp_path):
    (tmp_path / "b1_hw2.py").write_text(CORRECT_CODE)
    os.utime(tmp_path / "b1_hw2.py", (1, 1))
    hostile_submissions.make_sparse_file(tmp_path / "b1_later.ipynb")
    scan = class_folder.find(tmp_path, ROSTER)
    assert scan.submissions["b1"].path.name == "b1_hw2.py"
    assert "b1_later.ipynb: expected at most 256 MB, got 204800" in scan.notes


def test_a_modification_time_after_the_year_9999_is_noted(tmp_path, monkeypatch):
    (tmp_path / "b1_hw2.py").write_text(CORRECT_CODE)
    real = Path.lstat(tmp_path / "b1_hw2.py")
    monkeypatch.setattr(Path, "lstat", lambda path: os.stat_result(real[:7] + (0, 1 << 38, 0)))
    assert "before the year 10000" in class_folder.find(tmp_path, ROSTER).refused["b1"]
