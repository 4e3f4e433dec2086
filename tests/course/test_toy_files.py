"""The files of the toy class: its students, their submissions and dates, and where it may be written."""

import csv
from datetime import datetime, timedelta

import pytest

from hdrlab.course import plan
from hdrlab.course.authoring import solutions, toy_class

DUE = datetime.fromisoformat("2026-10-23T23:59:00Z")
HOMEWORK = plan.read().homeworks["hw2"]._replace(due=DUE)


@pytest.fixture
def short(monkeypatch):
    """Replace the texts of solutions by short ones: the ids of the tasks, and the mistakes."""

    def texts(homework, mistakes=()):
        return {"tasks": [task.id for task in homework.tasks], "m": [*mistakes]}

    monkeypatch.setattr(solutions, "texts", texts)
    monkeypatch.setattr(solutions, "script", lambda cells: f"script {cells}")
    monkeypatch.setattr(
        solutions, "notebook", lambda homework, cells: f"notebook {homework.name} {cells}"
    )


def test_there_are_fourteen_students_two_of_them_a_team():
    assert toy_class.STUDENTS[0] == "s01"
    assert toy_class.STUDENTS[-1] == "s14"
    assert len(toy_class.STUDENTS) == 14
    assert toy_class.ATTACKS.is_file()


def test_each_toy_student_submits_the_listed_file(short, monkeypatch):
    tasks = [task.id for task in HOMEWORK.tasks]
    listed = {
        "s01.py": {"hours": 1, "about": "a", "mistakes": ["m"]},
        "s02.ipynb": {"hours": -2, "about": "b", "done": tasks[:1]},
        "s03.py": {"hours": 0, "about": "c", "attacks": True},
        "s04.zip": {"hours": 0, "about": "d", "beside": {"other.txt": "x"}},
    }
    monkeypatch.setattr(toy_class, "FILES", listed)
    hand_ins = {task.name: task for task in toy_class.hand_ins(HOMEWORK)}
    assert list(hand_ins) == list(listed)
    assert hand_ins["s01.py"] == (
        "s01.py",
        f"script {{'tasks': {tasks}, 'm': ['m']}}".encode(),
        1,
        "a",
    )
    assert hand_ins["s02.ipynb"].data == f"notebook hw2 {{'tasks': {tasks[:1]}, 'm': []}}".encode()
    assert hand_ins["s03.py"].data == toy_class.ATTACKS.read_bytes()
    assert hand_ins["s04.zip"].data == toy_class.make_zip(
        {"hw2.ipynb": f"notebook hw2 {{'tasks': {tasks}, 'm': []}}".encode(), "other.txt": b"x"}
    )
    times = [(HOMEWORK.due + timedelta(hours=hours)).isoformat() for hours in (1, -2)]
    assert toy_class.received(list(hand_ins.values())[:2], HOMEWORK) == [
        ("s01.py", times[0]),
        ("s02.ipynb", times[1]),
    ]


@pytest.mark.parametrize("made", [True, False])
def test_a_toy_class_is_written_only_to_a_new_or_empty_folder(made, short, tmp_path):
    folder = tmp_path / "in" / "class"
    if made:
        folder.mkdir(parents=True)
    files = toy_class.write(folder)
    assert files == [folder / "submissions" / name for name in toy_class.FILES]
    assert all(file.is_file() and file.stat().st_size for file in files)
    rows = [*csv.DictReader((folder / "roster.csv").read_text("utf-8-sig").splitlines())]
    assert [row["student"] for row in rows] == list(toy_class.STUDENTS)
    assert rows[4]["name"] == "Student 05"
    assert [row["student"] for row in rows if row["team"] == "t1"] == ["s03", "s04"]
    assert {row["team"] for row in rows} == {"t1", ""}
    received = [*csv.DictReader((folder / "received.csv").read_text("utf-8-sig").splitlines())]
    assert [row["file"] for row in received] == list(toy_class.FILES)
    assert all(datetime.fromisoformat(row["received"]).tzinfo for row in received)
    text = (folder / "README.md").read_text("utf8")
    assert text.endswith("\n")
    assert str(folder) in text
    assert all(name in text for name in toy_class.FILES)
    for taken in (folder, folder / "README.md"):
        with pytest.raises(ValueError, match="new folder .*toy class, something is there"):
            toy_class.write(taken)
