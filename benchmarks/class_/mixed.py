"""Every kind of hostile hand-in that the tests have, each by a student of its own, beside an honest class.

attack  a file of tests/attacks in place of a function
trap    an archive of tests/support/malicious_archives.py
code    a function that takes time, memory or patience    } of tests/support/hostile_submissions.py
text    what breaks a page, a terminal or a table         }
file    a notebook or a Python file that is hard to read  }
name    a file's name that is no text, or no honest one   }
odd     what is no file, or has an odd size               }
taken   another's file name in one's own folder, and that of the table of times
"""

import os
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import NamedTuple

from benchmarks.class_ import handed
from benchmarks.class_.handed import Handed
from hdrlab.course import plan
from hdrlab.course.students import csv_tables

Put = Callable[[Path, str], object]  # into a folder, for a student


class Hostile(NamedTuple):
    """What a hostile student hands in: who, of which kind and which one of it, and how it is put there."""

    student: str
    kind: str
    which: str
    put: Put


def honest(count: int, target: Path) -> list[Handed]:
    """Return so many hand-ins, right, wrong, half done and blank, without the hostile ones of `handed`."""
    return [member for member in handed.handed(2 * count, target) if not member.hostile][:count]


def hostile(target: Path, victim: Handed) -> list[Hostile]:
    """Return a hand-in of each kind and sort; attacks look around in `target`, names take the victim's."""
    return [Hostile(f"x{k:03d}", *fields) for k, fields in enumerate(_each(target, victim))]


def _each(target: Path, victim: Handed) -> Iterator[tuple[str, str, Put]]:
    bad = handed.tests("hostile_submissions")
    attacks = handed.tests("attack_fixtures")
    archives = handed.tests("malicious_archives")
    tasks = [task.id for task in plan.read().homeworks["hw2"].tasks]
    for k, name in enumerate(attacks.ATTACK_NAMES):
        text = handed.attack(
            attacks.prepare_attack(name, target, handed.PORT), tasks[k % len(tasks)]
        )
        yield "attack", name, partial(_put, ".py", text)
    for name in archives.MALICIOUS_ARCHIVES:
        yield "trap", name, partial(_put, ".zip", handed.trap(name))
    for kind, attacks_of_kind in (("code", bad.HOSTILE_CODE), ("text", bad.CODE_WITH_NASTY_TEXTS)):
        yield from (
            (kind, name, partial(_put, ".py", text.encode()))
            for name, text in attacks_of_kind.items()
        )
    for name, (ending, made) in bad.UNREADABLE_FILES.items():
        yield "file", name, partial(_put, ending, made())
    for name, ending in bad.NASTY_FILE_NAMES.items():
        yield "name", name, partial(_name, ending, bad.CORRECT_CODE.encode())
    for name, (ending, made) in bad.ODD_FILES.items():
        yield "odd", name, partial(_odd, ending, made)
    for name in (victim.file, victim.file.upper(), f"{victim.team}.py"):
        yield "taken", name, partial(_inside, name, bad.CORRECT_CODE.encode())


def _put(ending: str, data: bytes, folder: Path, student: str) -> None:
    (folder / f"{student}_hw2{ending}").write_bytes(data)


def _name(ending: bytes, data: bytes, folder: Path, student: str) -> None:
    with open(os.fsencode(folder / student) + ending, "wb") as file:
        file.write(data)


def _odd(ending: str, made: Callable[[Path], object], folder: Path, student: str) -> None:
    made(folder / f"{student}_hw2{ending}")


def _inside(name: str, data: bytes, folder: Path, student: str) -> None:
    (folder / student).mkdir()
    (folder / student / name).write_bytes(data)


def write(folder: Path, members: list[Handed], others: list[Hostile]) -> Path:
    """Write an honest class with others among it: their files, and their lines in the roster."""
    handed.write(folder, members)
    for student in others:
        student.put(folder / "submissions", student.student)
    rows = [tuple(row.values()) for row in csv_tables.read_csv(folder / "roster.csv")]
    names = [(student.student, f"Student {student.student}", "") for student in others]
    csv_tables.write_csv(folder / "roster.csv", ("student", "name", "team"), [*rows, *names])
    return folder


def untold(out: Path, others: list[Hostile]) -> list[Hostile]:
    """Return those of whom a gradebook says neither points nor why there are none."""
    rows = {row["student"]: row for row in csv_tables.read_csv(out / "gradebook.csv")}
    there = {file.name.partition(".")[0] for file in (out / "results").glob("*.json")}
    return [
        student
        for student in others
        if student.student not in there and not rows[student.student]["note"]
    ]
