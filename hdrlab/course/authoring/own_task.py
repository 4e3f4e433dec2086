"""Write the files of an instructor's own task: a complete example that works, to be changed file by file.

The function need not be in the library. The example has the function, its assignment, its checks
with hints, two known mistakes, hidden checks, and tests of all of these.
"""

import keyword
from collections.abc import Iterator
from pathlib import Path

from hdrlab.course.authoring.handouts import write_text
from hdrlab.errors import InputError

# a text for each file; TASK and HOMEWORK in names and texts are replaced
TEMPLATES = Path(__file__).parent / "new_task"
# the start of the part of an assignment that is about one task
TASK_PART = "# %% [markdown] about="


def write(folder: Path, task: str, homework: str) -> Iterator[Path]:
    """Write the example into a folder, beside other tasks if there are any, and yield each new file.

    Parameters
    ----------
    folder : created if it does not exist
    task : the task's id, which is the name of its function
    homework : the homework that the task belongs to, new or not

    Raises
    ------
    InputError
        For a name that no function can have, or a task that exists already.
    """
    for name in (task, homework):
        if not (name.isidentifier() and name.islower()) or keyword.iskeyword(name):
            raise InputError(f"expected a name of lower-case letters, digits and _, got {name!r}")
    if (folder / f"{task}.py").exists() or task == homework:
        raise InputError(
            f"expected a new task, got {task!r}: change {folder / task}.py, or choose another"
        )
    templates = [path for path in TEMPLATES.rglob("*") if path.is_file() and path.suffix != ".pyc"]
    # the function comes last: a folder without it has no such task yet, if this is interrupted
    for template in sorted(templates, key=lambda path: (path.name == "TASK.py", path)):
        name = template.relative_to(TEMPLATES).as_posix()
        path = folder / _fill_in(name, task, homework)
        text = _fill_in(template.read_text(encoding="utf8"), task, homework)
        present = path.read_text(encoding="utf8") if path.exists() else ""
        if not present:
            yield write_text(path, text)
        elif path.name == "plan.toml" or path.parent.name == "sheets":
            if f'"{task}"' in present:  # of a run that was interrupted
                continue
            yield write_text(path, append_task(present, text, homework))


def _fill_in(text: str, task: str, homework: str) -> str:
    """Return a template with the names of the task and of its homework."""
    return text.replace("TASK", task).replace("HOMEWORK", homework)


def append_task(present: str, text: str, homework: str) -> str:
    """Return a plan or an assignment with one more task."""
    if TASK_PART in text:
        return f"{present}\n{text[text.index(TASK_PART) :]}"
    before, section, rest = present.partition(f"[{homework}]\n")
    if not section:
        return f"{present}\n{text[text.index(f'[{homework}]') :]}"
    line = text.partition("tasks = [")[2].splitlines()[1]
    return before + section + rest.replace("\n]\n", f"\n{line}\n]\n", 1)
