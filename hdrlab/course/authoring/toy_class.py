"""Write a toy class to try grading on: a dozen submissions of the second homework, good, late and hostile.

FOLDER/
  submissions/    the submissions
  roster.csv      fourteen students, two of them a team; one has handed in nothing
  received.csv    when each file was received
  plan.toml       the plan with the dates of a term in the past
  README.md       what each file is, and what result to expect

The students are no real people; they are called by numbers.
"""

import tomllib
from collections.abc import Iterator, Sequence
from datetime import date, datetime, timedelta
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course import plan
from hdrlab.course.authoring import solutions, term
from hdrlab.course.students import csv_tables
from hdrlab.course.submissions.archives.packing import make_zip
from hdrlab.errors import InputError
from hdrlab.io.temporary import new_folder
from hdrlab.show.pages.templates import render_page

HOMEWORK = "hw2"
FIRST_DAY = date(2026, 9, 21)
TEAM = "t1"
TEAM_MEMBERS = ("s03", "s04")
STUDENTS = tuple(f"s{k:02d}" for k in range(1, 15))
ATTACKS = Path(__file__).parent / "toy_attacks.py"
TOY: dict[str, Any] = tomllib.loads(Path(__file__).with_name("toy_class.toml").read_text("utf8"))
COMMAND = TOY["command"]
FILES = TOY["handed"]


class ToyFile(NamedTuple):
    """A file of the toy class: its name, its bytes, hours after the deadline, and a description."""

    name: str
    data: bytes
    hours: float
    about: str


def hand_ins(homework: plan.Homework) -> Iterator[ToyFile]:
    """Yield the files that the toy class hands in, as toy_class.toml describes them."""
    for name, description in FILES.items():
        data = _code_bytes(name, description, homework)
        if "beside" in description:
            others = {other: text.encode() for other, text in description["beside"].items()}
            data = make_zip({"hw2.ipynb": data, **others})
        yield ToyFile(name, data, description["hours"], description["about"])


def _code_bytes(name: str, description: dict[str, Any], homework: plan.Homework) -> bytes:
    """Return the notebook or Python file of a submission, right, with mistakes, or an attack."""
    if description.get("attacks"):
        return ATTACKS.read_bytes()
    done = description.get("done", [task.id for task in homework.tasks])
    tasks = tuple(task for task in homework.tasks if task.id in done)
    cells = solutions.texts(homework._replace(tasks=tasks), description.get("mistakes", ()))
    if name.endswith(".py"):
        return solutions.script(cells).encode()
    return solutions.notebook(homework, cells).encode()


def write(folder: Path) -> list[Path]:
    """Write the toy class into a folder, and return the submissions.

    Raises
    ------
    InputError
        If the folder is not empty: it might be a real class.
    """
    if folder.is_dir() and any(folder.iterdir()) or folder.is_file():
        raise InputError(f"{folder}: expected a new folder for the toy class, something is there")
    folder.resolve().parent.mkdir(parents=True, exist_ok=True)
    with new_folder(folder.resolve()) as unfinished:
        (unfinished / "submissions").mkdir()
        text_of_plan = term.move(plan.PLAN.read_text(encoding="utf8"), FIRST_DAY)
        (unfinished / "plan.toml").write_text(text_of_plan, encoding="utf8")
        homework = plan.read(unfinished / "plan.toml").homeworks[HOMEWORK]
        files = list(hand_ins(homework))
        for file in files:
            (unfinished / "submissions" / file.name).write_bytes(file.data)
        roster = [
            (student, f"Student {student[1:]}", TEAM if student in TEAM_MEMBERS else "")
            for student in STUDENTS
        ]
        csv_tables.write_csv(unfinished / "roster.csv", ("student", "name", "team"), roster)
        csv_tables.write_csv(
            unfinished / "received.csv", ("file", "received"), received(files, homework)
        )
        text = render_page(
            Path(__file__).parent,
            "toy_class.plain",
            command=COMMAND.format(folder=folder),
            each=files,
        )
        (unfinished / "README.md").write_text(text + "\n", encoding="utf8")
    return [folder / "submissions" / file.name for file in files]


def received(files: Sequence[ToyFile], homework: plan.Homework) -> list[tuple[str, str]]:
    """Return the table of the files and the times when they were received."""
    assert isinstance(homework.due, datetime)
    return [(file.name, (homework.due + timedelta(hours=file.hours)).isoformat()) for file in files]
