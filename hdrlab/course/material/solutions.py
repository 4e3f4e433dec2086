"""The model solutions, for instructors: the library's lessons, in the place of each homework's stubs.

They are made of the library that is installed: neither the wheel nor the source distribution holds them.
"""

from collections.abc import Iterator
from pathlib import Path

from hdrlab.course.classroom import imitation
from hdrlab.course.material.handouts import write_text
from hdrlab.course.plan import Plan

HEAD = Path(__file__).with_name("solutions_head.md")  # of the table of what is in the pack


def write(plan: Plan, folder: Path) -> Iterator[Path]:
    """Write the pack into a folder, which is made where it is missing, and yield each file."""
    table = HEAD.read_text("utf8")
    for name, homework in plan.homeworks.items():
        cells = imitation.texts(homework)
        yield write_text(folder / f"{name}.py", imitation.script(cells))
        if not any(task.own for task in homework.tasks):  # whose sheet stands elsewhere
            yield write_text(folder / f"{name}.ipynb", imitation.notebook(homework, cells))
        for task in homework.tasks:
            lines = len(cells[task.id].splitlines())
            table += f"| {name} | `{task.id}` | {task.points:g} | {lines} | `{task.function}` |\n"
    yield write_text(folder / "README.md", table)
