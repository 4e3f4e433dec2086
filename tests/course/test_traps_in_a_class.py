"""Malicious archives among the submissions of a class: each is refused in one line, the others are graded."""

import pytest
from support.malicious_archives import MALICIOUS_ARCHIVES, write_zip
from support.one_task_homework import CORRECT_CODE, PLAN

from hdrlab import cli
from hdrlab.course.grading import results
from hdrlab.course.students import csv_tables
from hdrlab.course.submissions import reader

pytestmark = pytest.mark.grading

LISTED = (
    "link",
    "absolute",
    "drive",
    "climbs",
    "device",
    "pipe",
    "bomb",
    "share bytes",
    "larger than",
)
NAMES = [name for name in MALICIOUS_ARCHIVES if any(word in name for word in LISTED)]


def is_refused(message):
    return (
        message.startswith("The archive is refused: ")
        and message.isprintable()
        and len(message) < 250
    )


@pytest.mark.parametrize("name", NAMES)
def test_each_trap_is_refused_in_one_line_and_leaves_nothing(tmp_path, name):
    (tmp_path / "scratch").mkdir()
    MALICIOUS_ARCHIVES[name](tmp_path / "s01.zip")
    path, message = reader.extract_code_file(tmp_path / "s01.zip", tmp_path / "scratch", "hw2")
    assert path == tmp_path / "s01.zip" and is_refused(message)
    assert {file.name for file in tmp_path.rglob("*")} == {"s01.zip", "scratch"}


def test_a_class_with_traps_is_graded_and_each_trap_is_reported(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in").mkdir()
    trapped = {"s01": "a member that climbs out, zip", "s02": "a hard link"}
    who = [*trapped, "zip", "last"]
    (tmp_path / "roster.csv").write_text("student\n" + "\n".join(who))
    (tmp_path / "plan.toml").write_text(PLAN)
    for student, trap in trapped.items():
        MALICIOUS_ARCHIVES[trap](tmp_path / "in" / f"{student}.zip")
    (tmp_path / "in" / "last.py").write_text(CORRECT_CODE)
    write_zip(tmp_path / "in" / "zip.zip", {"mine/hat.py": CORRECT_CODE.encode()})
    words = ["grade", "in", "--homework", "hw2", "--roster", "roster.csv", "--plan", "plan.toml"]
    with pytest.raises(SystemExit) as ended:  # nothing of an archive runs before it is judged
        cli.run([*words, "--tier", "practice", "-o", "out", "--jobs", "2"])
    assert not ended.value.code
    rows = {row["student"]: row for row in csv_tables.read_csv(tmp_path / "out" / "gradebook.csv")}
    assert {student: float(row["work"]) for student, row in rows.items()} == dict(
        zip(who, (0, 0, 10, 10), strict=True)
    )
    for student in who:
        (file,) = (tmp_path / "out" / "results").glob(f"{student}.*")
        message = results.from_json(file.read_bytes()).problems
        assert len(message) == (student in trapped) and all(map(is_refused, message))
    assert {file.name for file in tmp_path.iterdir()} == {"in", "roster.csv", "plan.toml", "out"}


def test_the_class_contains_every_kind_of_trap():
    assert len(NAMES) >= 20
    assert all(any(word in name for name in NAMES) for word in LISTED)
