"""A toy class: a dozen hand-ins of the second homework, good, late, wrong and hostile, to try grading on.

FOLDER/
  submissions/    what was handed in
  roster.csv      fourteen students, two of them a team, one of whom nothing came
  received.csv    when each file came
  README.md       what each file is, and what is to be expected of it

Nobody in it is a person: the students are called by their numbers.
"""

from collections.abc import Iterator, Sequence
from datetime import timedelta
from pathlib import Path
from typing import NamedTuple

from hdrlab.course import plan
from hdrlab.course.archives.packing import packed
from hdrlab.course.classroom import imitation
from hdrlab.course.reports import sheets

HOMEWORK = "hw2"
TEAM, MEMBERS = "t1", ("s03", "s04")
STUDENTS = tuple(f"s{k:02d}" for k in range(1, 15))
DONE = ("hat", "irradiance", "update")  # of who has not come to the end
ATTACKS = Path(__file__).parent / "toy_attacks.txt"  # in place of functions
COMMAND = (
    "hdrlab grade {folder}/submissions --homework hw2 --roster {folder}/roster.csv"
    " --received {folder}/received.csv --secret-file {folder}/secret.txt -o {folder}/results"
)


class Handed(NamedTuple):
    """A file that was handed in: its name, its bytes, how many hours after the end, and what it is."""

    name: str
    data: bytes
    hours: float
    about: str


def hand_ins(homework: plan.Homework) -> Iterator[Handed]:
    """Yield what the toy class has handed in."""
    cells = imitation.texts(homework)
    right = imitation.notebook(homework, cells).encode()

    def wrong(*mistakes: str) -> bytes:
        return imitation.notebook(homework, imitation.texts(homework, mistakes)).encode()

    yield Handed("s01_hw2.ipynb", right, -30, "All right: 100 points.")
    yield Handed("s02_hw2.py", imitation.script(cells).encode(), -2, "The same as a Python file: 100 points.")
    yield Handed("t1_hw2.ipynb", right, 70, "A team of s03 and s04, three days late: 100 points, no penalty.")
    yield Handed("s05_hw2.ipynb", right, 11.5 * 24, "All right, two days beyond the ten that are free: 98.")
    yield Handed("s06_hw2.ipynb", wrong("gsolve_log2_of_the_times"), -9, "A well-known mistake in gsolve.")
    two = wrong("gsolve_log2_of_the_times", "hat_zero_in_the_middle")
    yield Handed("s07_hw2.ipynb", two, -8, "The same one, and another in hat.")
    two = wrong("irradiance_not_weighted", "recover_one_curve_for_all")
    yield Handed("s08_hw2.ipynb", two, 20, "Mistakes in irradiance and recover; a day late, no penalty.")
    begun = homework._replace(tasks=tuple(task for task in homework.tasks if task.id in DONE))
    half = imitation.notebook(homework, imitation.texts(begun)).encode()
    yield Handed("s09_hw2.ipynb", half, -1, f"Not finished: {', '.join(DONE)} are right, 30 points.")
    blank = imitation.notebook(homework).encode()
    yield Handed("s10_hw2.ipynb", blank, -3, "As it was handed out: 0 points.")
    archive = packed({"hw2.ipynb": right, "notes.txt": b"All tasks.\n"})
    yield Handed("s11_hw2.zip", archive, -5, "An archive: 100.")
    trap = packed({"hw2.ipynb": right, "../s01_hw2.ipynb": b"{}"})
    yield Handed("s12_hw2.zip", trap, -4, "An archive that would overwrite another's file: refused, 0.")
    yield Handed(
        "s13_hw2.py", ATTACKS.read_bytes(), -6, "Attacks on the grader in place of functions: 0 points."
    )


def write(folder: Path) -> list[Path]:
    """Write the toy class into a folder, and return the files that were handed in.

    Raises
    ------
    ValueError
        Where something is in the folder: it might be a real class.
    """
    if folder.is_dir() and any(folder.iterdir()) or folder.is_file():
        raise ValueError(f"{folder}: expected a new folder for the toy class, something is there")
    homework = plan.read().homeworks[HOMEWORK]
    (folder / "submissions").mkdir(parents=True, exist_ok=True)
    each = list(hand_ins(homework))
    for one in each:
        (folder / "submissions" / one.name).write_bytes(one.data)
    roster = [(who, f"Student {who[1:]}", TEAM if who in MEMBERS else "") for who in STUDENTS]
    sheets.write_csv(folder / "roster.csv", ("student", "name", "team"), roster)
    sheets.write_csv(folder / "received.csv", ("file", "received"), received(each, homework))
    (folder / "README.md").write_text(_about(folder, each), encoding="utf8")
    return [folder / "submissions" / one.name for one in each]


def received(each: Sequence[Handed], homework: plan.Homework) -> list[tuple[str, str]]:
    """Return when each file came, as the rows of a table."""
    return [(one.name, (homework.due + timedelta(hours=one.hours)).isoformat()) for one in each]


def _about(folder: Path, each: Sequence[Handed]) -> str:
    """Return what is in the folder, in words."""
    rows = [f"| {one.name} | {one.about} |" for one in each]
    head = ["| file | what it is |", "|---|---|"]
    return "\n".join(["# A toy class", "", f"    {COMMAND.format(folder=folder)}", "", *head, *rows, ""])
