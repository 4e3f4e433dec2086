"""A task of an instructor's own: a folder beside the package, with an example in it that works.

The function need not be the library's. The example is complete, and is changed file by file: the
function, its sheet, its checks with hints, two mistakes, hidden checks, and tests of all of these.
"""

import keyword
from collections.abc import Iterator
from pathlib import Path

from hdrlab.course.authoring.handouts import write_text
from hdrlab.errors import InputError

# a text for each file; TASK and HOMEWORK in names and texts are replaced
TEMPLATES = Path(__file__).parent / "new_task"
# begins what a sheet says of one task
SHEET = "# %% [markdown] about="


def write(folder: Path, task: str, homework: str) -> Iterator[Path]:
    """Write the example into a folder, as one more task where there are some, and yield each new file.

    Parameters
    ----------
    folder : made where it is missing
    task : the task's id, which is the name of its function
    homework : the homework that the task belongs to, new or not

    Raises
    ------
    ValueError
        For a name that no function can have, or a task that is there.
    """
    for name in (task, homework):
        if not (name.isidentifier() and name.islower()) or keyword.iskeyword(name):
            raise InputError(f"expected a name of lower-case letters, digits and _, got {name!r}")
    if (folder / f"{task}.py").exists() or task == homework:
        raise InputError(
            f"expected a new task, got {task!r}: change {folder / task}.py, or choose another"
        )
    for template in sorted(TEMPLATES.rglob("*.txt")):
        name, text = template.relative_to(TEMPLATES).as_posix(), template.read_text(encoding="utf8")
        name, text = (
            one.replace("TASK", task).replace("HOMEWORK", homework) for one in (name, text)
        )
        file = folder / name.removesuffix(".txt")
        there = file.read_text(encoding="utf8") if file.exists() else ""
        if not there or file.name == "plan.toml" or file.parent.name == "sheets":
            yield write_text(file, joined(there, text, homework))


def joined(there: str, text: str, homework: str) -> str:
    """Return a plan or a sheet with one more task."""
    if not there:
        return text
    if SHEET in text:
        return f"{there}\n{text[text.index(SHEET) :]}"
    before, section, rest = there.partition(f"[{homework}]\n")
    if not section:
        return f"{there}\n{text[text.index(f'[{homework}]') :]}"
    line = text.partition("tasks = [")[2].splitlines()[1]
    return before + section + rest.replace("\n]\n", f"\n{line}\n]\n", 1)
