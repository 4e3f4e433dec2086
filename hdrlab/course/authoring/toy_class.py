"""A toy class: a dozen hand-ins of the second homework, good, late, wrong and hostile, to try grading on.

FOLDER/
  submissions/    what was handed in
  roster.csv      fourteen students, two of them a team, one of whom nothing came
  received.csv    when each file came
  README.md       what each file is, and what is to be expected of it

Nobody in it is a person: the students are called by their numbers.
"""

import tomllib
from collections.abc import Iterator, Sequence
from datetime import timedelta
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course import plan
from hdrlab.course.authoring import solutions
from hdrlab.course.students import csv_tables
from hdrlab.course.submissions.archives.packing import make_zip
from hdrlab.errors import InputError
from hdrlab.show.pages.templates import render_page

HOMEWORK = "hw2"
TEAM, MEMBERS = "t1", ("s03", "s04")
STUDENTS = tuple(f"s{k:02d}" for k in range(1, 15))
ATTACKS = Path(__file__).parent / "toy_attacks.py"
TOY: dict[str, Any] = tomllib.loads(Path(__file__).with_name("toy_class.toml").read_text("utf8"))
COMMAND, HANDED = TOY["command"], TOY["handed"]


class Handed(NamedTuple):
    """A file that was handed in: its name, its bytes, how many hours after the end, and what it is."""

    name: str
    data: bytes
    hours: float
    about: str


def hand_ins(homework: plan.Homework) -> Iterator[Handed]:
    """Yield what the toy class has handed in: what toy_class.toml says of each file."""
    for name, one in HANDED.items():
        done = [task for task in homework.tasks if "done" not in one or task.id in one["done"]]
        cells = solutions.texts(homework._replace(tasks=tuple(done)), one.get("mistakes", ()))
        text = (
            solutions.script(cells) if name.endswith(".py") else solutions.notebook(homework, cells)
        )
        data = ATTACKS.read_bytes() if one.get("attacks") else text.encode()
        if beside := one.get("beside"):
            data = make_zip(
                {"hw2.ipynb": data, **{other: held.encode() for other, held in beside.items()}}
            )
        yield Handed(name, data, one["hours"], one["about"])


def write(folder: Path) -> list[Path]:
    """Write the toy class into a folder, and return the files that were handed in.

    Raises
    ------
    ValueError
        Where something is in the folder: it might be a real class.
    """
    if folder.is_dir() and any(folder.iterdir()) or folder.is_file():
        raise InputError(f"{folder}: expected a new folder for the toy class, something is there")
    homework = plan.read().homeworks[HOMEWORK]
    (folder / "submissions").mkdir(parents=True, exist_ok=True)
    each = list(hand_ins(homework))
    for one in each:
        (folder / "submissions" / one.name).write_bytes(one.data)
    roster = [(who, f"Student {who[1:]}", TEAM if who in MEMBERS else "") for who in STUDENTS]
    csv_tables.write_csv(folder / "roster.csv", ("student", "name", "team"), roster)
    csv_tables.write_csv(folder / "received.csv", ("file", "received"), received(each, homework))
    text = render_page(
        Path(__file__).parent, "toy_class.plain", command=COMMAND.format(folder=folder), each=each
    )
    (folder / "README.md").write_text(text + "\n", encoding="utf8")
    return [folder / "submissions" / one.name for one in each]


def received(each: Sequence[Handed], homework: plan.Homework) -> list[tuple[str, str]]:
    """Return when each file came, as the rows of a table."""
    return [(one.name, (homework.due + timedelta(hours=one.hours)).isoformat()) for one in each]
