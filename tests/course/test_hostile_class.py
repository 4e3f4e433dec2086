"""A class with hostile submissions: honest results do not change, and each hostile one has a note."""

import os

import pytest
from support import hostile_submissions
from support.one_task_homework import CORRECT_CODE, PLAN

from hdrlab import cli
from hdrlab.course.grading import doctor
from hdrlab.course.students import csv_tables

pytestmark = pytest.mark.grading

HONEST = {"h1": ("h1_hw2.ipynb", hostile_submissions.notebook(CORRECT_CODE))}
CODE = ("ends by itself",)
FILES = ("NUL",)
TEXTS = ("half a character, raised",)
NAMES = ("not UTF-8",)
ODD = ("a huge sparse notebook", "a pipe", "a link to a device", "a folder in a folder")


def written(folder):
    """Write the submissions of hostile students, and return the name of the attack by student."""
    students = iter(f"x{k:02d}" for k in range(1, 99))
    submissions = {}
    for name in [*CODE, *TEXTS]:
        student = next(students)
        submissions[student] = name
        (folder / f"{student}_hw2.py").write_text(
            (hostile_submissions.HOSTILE_CODE | hostile_submissions.CODE_WITH_NASTY_TEXTS)[name]
        )
    for name in FILES:
        student = next(students)
        submissions[student] = name
        ending, made = hostile_submissions.UNREADABLE_FILES[name]
        (folder / f"{student}_hw2{ending}").write_bytes(made())
    for name in NAMES:
        student = next(students)
        submissions[student] = name
        with open(
            os.fsencode(folder / student) + hostile_submissions.NASTY_FILE_NAMES[name], "w"
        ) as file:
            file.write("def hat(n=256:\n")
    for name in ODD:
        student = next(students)
        submissions[student] = name
        ending, made = hostile_submissions.ODD_FILES[name]
        made(folder / f"{student}_hw2{ending}")
    return submissions


@pytest.fixture
def grade(tmp_path, monkeypatch):
    """grade(folder) -> the rows of its gradebook, and the files of each team, in the strict tier."""
    findings = doctor.examine("strict")
    if not findings.works:
        pytest.skip(findings.details)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plan.toml").write_text(PLAN)

    def run(folder, students):
        (tmp_path / "roster.csv").write_text("student\n" + "\n".join(students))
        words = [
            "grade",
            folder,
            "--homework",
            "hw2",
            "--roster",
            "roster.csv",
            "--plan",
            "plan.toml",
        ]
        with pytest.raises(SystemExit) as ended:
            cli.run(
                [*words, "--tier", "strict", "-o", f"{folder}-out", "--jobs", "2", "--timeout", "3"]
            )
        assert not ended.value.code
        files = {
            path: path.read_bytes()
            for path in (tmp_path / f"{folder}-out" / "feedback").rglob("*.*")
        }
        rows = csv_tables.read_csv(tmp_path / f"{folder}-out" / "gradebook.csv")
        return {row["student"]: row for row in rows}, {
            str(path.relative_to(tmp_path / f"{folder}-out")): data for path, data in files.items()
        }

    return run


def test_hostile_submissions_do_not_change_the_results_of_honest_ones(tmp_path, grade, monkeypatch):
    for folder in ("all", "honest"):
        (tmp_path / folder).mkdir()
        for name, data in HONEST.values():
            (tmp_path / folder / name).write_bytes(data)
            os.utime(tmp_path / folder / name, (1_700_000_000, 1_700_000_000))
    others = written(tmp_path / "all")
    rows, files = grade("all", [*HONEST, *others])
    alone, expected = grade("honest", HONEST)
    assert {name: files[name] for name in expected} == expected and len(expected) == 5 * len(HONEST)
    assert {student: rows[student] for student in HONEST} == alone
    for student, name in others.items():
        assert float(rows[student]["work"]) == 0, name
        assert name in (*CODE, *TEXTS) or rows[student]["note"], name
        assert rows[student]["note"].isprintable()
