"""A class that is generated: what each team hands in of the second homework, and what is to become of it.

right       the library's functions, as a notebook, a Python file or an archive
equivalent  right, and written differently: the files of tests/equivalent
mistake     a file of hdrlab/course/checks/mistakes in place of a function, all others right
half        the first tasks alone
blank       the handout, an empty file, a notebook cut short, no notebook at all
attack      hostile: a file of tests/attacks in place of a function
trap        hostile: an archive of tests/support/malicious_archives.py

Kinds take turns, so that a smaller class has the same mixture.
"""

import re
from collections.abc import Iterable
from datetime import datetime, timedelta
from functools import cache
from importlib.util import module_from_spec, spec_from_file_location
from itertools import cycle, islice
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

from benchmarks.measure import ROOT
from hdrlab.course import plan
from hdrlab.course.authoring import solutions, term, toy_class
from hdrlab.course.checks import misconceptions
from hdrlab.course.plan import Homework
from hdrlab.course.students import csv_tables
from hdrlab.course.submissions.archives.packing import make_zip

TESTS = ROOT / "tests"
SHARES = {
    "right": 60,
    "equivalent": 30,
    "mistake": 96,
    "half": 15,
    "blank": 12,
    "attack": 42,
    "trap": 45,
}
HOSTILE = ("attack", "trap")
HOURS = (-30.0, -2.0, 5.0, 70.0, 276.0)  # after the end
PORT = 9  # where nobody answers
SECRET = "a secret of the course\n"


class Handed(NamedTuple):
    """What a team hands in: the file, its bytes, its kind, and which one of that kind."""

    team: str
    students: tuple[str, ...]
    file: str
    data: bytes
    hours: float
    kind: str
    which: str

    @property
    def hostile(self) -> bool:
        """Whether it is meant to do harm."""
        return self.kind in HOSTILE


def kinds(count: int) -> list[str]:
    """Return the kind of each hand-in: always the one that is furthest behind its share."""
    made = dict.fromkeys(SHARES, 0)
    order = []
    for n in range(1, count + 1):
        behind = {
            kind: share * n / sum(SHARES.values()) - made[kind] for kind, share in SHARES.items()
        }
        order.append(max(behind, key=lambda kind: behind[kind]))
        made[order[-1]] += 1
    return order


def handed(count: int, target: Path) -> list[Handed]:
    """Return what a class of so many teams hands in; attacks look for what they could harm in `target`."""
    homework = plan.read().homeworks["hw2"]
    order = kinds(count)
    makers = {kind: iter(_of(kind, order.count(kind), homework, target)) for kind in SHARES}
    made = []
    for k, kind in enumerate(order):
        which, ending, data = next(makers[kind])
        team = f"t{k:03d}" if k % 4 == 0 else f"s{k:03d}"
        students = (f"{team}a", f"{team}b") if k % 4 == 0 else (team,)
        file = f"{team}_hw2{ending}"
        made.append(Handed(team, students, file, data, HOURS[k % len(HOURS)], kind, which))
    return made


Made = tuple[str, str, bytes]  # which one, how its file's name ends, its bytes


def _of(kind: str, count: int, homework: Homework, target: Path) -> list[Made]:
    """Return so many hand-ins of a kind."""
    ids = [task.id for task in homework.tasks]
    if kind == "right":
        return list(islice(cycle(_right(homework)), count))
    if kind == "equivalent":
        ways = sorted((TESTS / "equivalent").glob("hw2_*.py"))
        return [(way.stem, ".py", way.read_bytes()) for way in islice(cycle(ways), count)]
    if kind == "mistake":
        names = [mistake.name for mistake in misconceptions.known() if mistake.task in ids]
        return [(name, ".ipynb", _mistaken(name)) for name in islice(cycle(names), count)]
    if kind == "half":
        some = [
            homework._replace(tasks=homework.tasks[: 1 + k % (len(ids) - 1)]) for k in range(count)
        ]
        return [(part.tasks[-1].id, ".ipynb", _filled(homework, part)) for part in some]
    if kind == "blank":
        blank = solutions.notebook(homework).encode()
        members = [
            ("handout", blank),
            ("cut short", blank[:3000]),
            ("no notebook", b"hello"),
            ("empty", b""),
        ]
        return [(which, ".ipynb", data) for which, data in islice(cycle(members), count)]
    if kind == "attack":
        attacks = tests("attack_fixtures")
        aims = zip(islice(cycle(attacks.ATTACK_NAMES), count), cycle(ids), strict=False)
        return [
            (name, ".py", attack(attacks.prepare_attack(name, target, PORT), id))
            for name, id in aims
        ]
    return [
        (name, ".zip", trap(name))
        for name in islice(cycle(tests("malicious_archives").MALICIOUS_ARCHIVES), count)
    ]


def _right(homework: Homework) -> list[Made]:
    cells = solutions.texts(homework)
    notebook = solutions.notebook(homework, cells).encode()
    script = solutions.script(cells).encode()
    archive = make_zip({"work/hw2.ipynb": notebook, "work/notes.txt": b"All of it.\n"})
    return [
        ("notebook", ".ipynb", notebook),
        ("script", ".py", script),
        ("archive", ".zip", archive),
    ]


@cache
def _mistaken(name: str) -> bytes:
    homework = plan.read().homeworks["hw2"]
    return solutions.notebook(homework, solutions.texts(homework, [name])).encode()


def _filled(homework: Homework, part: Homework) -> bytes:
    return solutions.notebook(homework, solutions.texts(part)).encode()


def attack(text: str, task: str) -> bytes:
    """Return an attack whose function, called double, has the name of a task."""
    return re.sub(
        r"^def double\(x\)", f"def {task}(x=0, *_, **__)", text, flags=re.MULTILINE
    ).encode()


@cache
def trap(name: str) -> bytes:
    """Return the bytes of an archive with a trap."""
    from tempfile import TemporaryDirectory

    with TemporaryDirectory() as folder:
        tests("malicious_archives").MALICIOUS_ARCHIVES[name](Path(folder) / "archive")
        return (Path(folder) / "archive").read_bytes()


@cache
def tests(name: str) -> ModuleType:
    """Return a module of tests/support, which is not on the path of Python."""
    spec = spec_from_file_location(name, TESTS / "support" / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def write(folder: Path, members: Iterable[Handed]) -> Path:
    """Write what was handed in, the roster, the times and the secret into a folder, and return it."""
    (folder / "submissions").mkdir(parents=True)
    text_of_plan = term.move(plan.PLAN.read_text(encoding="utf8"), toy_class.FIRST_DAY)
    (folder / "plan.toml").write_text(text_of_plan, encoding="utf8")
    due = plan.read(folder / "plan.toml").homeworks["hw2"].due
    assert isinstance(due, datetime)
    students = []
    times = []
    for member in members:
        (folder / "submissions" / member.file).write_bytes(member.data)
        students += [(who, f"Student {who}", member.team) for who in member.students]
        times.append((member.file, (due + timedelta(hours=member.hours)).isoformat()))
    csv_tables.write_csv(folder / "roster.csv", ("student", "name", "team"), students)
    csv_tables.write_csv(folder / "received.csv", ("file", "received"), times)
    (folder / "secret.txt").write_text(SECRET)
    return folder
