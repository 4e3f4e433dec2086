"""Read the code that a team wrote itself: each task's function with its helpers, without the handout.

The code is read, and never run. Code that is longer than any assignment, or nested too deep, is
skipped with a note: it is read in the process that holds the whole class.
"""

import ast
import re
import warnings
from collections.abc import Collection, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

from hdrlab.course.source_code import names
from hdrlab.course.submissions import reader
from hdrlab.errors import InputError

MAX_TASK_CHARACTERS = 30_000
MAX_ALL_CHARACTERS = 100_000
NAMES_AND_STRINGS = re.compile(r"""\w+|'[^']*'|"[^"]*\"""")


class TeamCode(NamedTuple):
    """The code of a team.

    Attributes
    ----------
    team : its name
    texts : the text of each task
    notes : what could not be read, as sentences
    variants : the variants that its sheet asks for
    """

    team: str
    texts: dict[str, str]
    notes: tuple[str, ...] = ()
    variants: dict[str, str] | None = None


def read(team: str, path: Path, homework: str, tasks: Sequence[str]) -> TeamCode:
    r"""Read the functions that a team wrote for these tasks from a notebook or a Python file.

    Parameters
    ----------
    team : name of the team
    path : the file, which may hold anything, or an archive
    homework : name of the assignment, whose handout every team was given
    tasks : the names of their functions

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "hw2.py"
    >>> _ = path.write_text("import numpy as np\ndef hat(n=256):\n    return tent(n)\ntent = np.hanning")
    >>> print(read("t7", path, "hw2", ["hat"]).texts["hat"])
    tent = np.hanning
    def hat(n=256):
        return tent(n)
    """
    try:
        work = reader.read(path, homework, tasks, reader.given_cells(homework))
    except InputError as error:
        return TeamCode(team, {}, (str(error),))
    texts: dict[str, str] = {}
    notes = []
    if not work.sources:
        notes = [*work.problems, "none of the tasks can be read in it"]
    for task, text in work.sources.items():
        characters_so_far = sum(len(other) for other in texts.values())
        is_too_long = len(text) > MAX_TASK_CHARACTERS
        if is_too_long or characters_so_far + len(text) > MAX_ALL_CHARACTERS:
            limit = f"{MAX_TASK_CHARACTERS:,} characters, or {MAX_ALL_CHARACTERS:,} with the tasks before it"
            notes.append(f"{task} has more than {limit}, and is not compared")
            continue
        try:
            texts[task] = own_code(text, homework, {*tasks} - {task})
        except names.PARSE_ERRORS:
            notes.append(f"{task} is nested too deep and is not compared")
    return TeamCode(team, texts, tuple(notes), work.variants)


def own_code(text: str, homework: str, others: Collection[str]) -> str:
    """Return the statements of a task without imports, the handout's code and the other tasks.

    The statements are sorted by their form, so that two texts with the same statements become one
    text, in any order and under any names. Empty lines are dropped: copydetect takes a time that is
    quadratic in them.
    """
    with warnings.catch_warnings(action="ignore"):  # the parser warns of odd literals
        parts = sorted(_own_statements(text, _given(homework), others), key=_form)
    return "\n".join(line for part in parts for line in part.split("\n") if line.strip())


def _form(part: str) -> str:
    """Return a statement without names, strings and comments."""
    return NAMES_AND_STRINGS.sub("V", ast.unparse(ast.parse(part)))


def _own_statements(text: str, given: Collection[str], others: Collection[str]) -> Iterator[str]:
    """Yield the statements that are neither imports, nor in the handout, nor another task."""
    for node, part in _statements(text):
        if isinstance(node, ast.Import | ast.ImportFrom) or part in given:
            continue
        if not set(names.bound_names(node)) & set(others):
            yield part


def _statements(text: str) -> Iterator[tuple[ast.stmt, str]]:
    """Yield each top-level statement of a text, with its lines."""
    text = re.sub(r"\r\n?", "\n", text)
    lines = text.split("\n")  # as the parser counts them: a form feed ends no line
    for node in ast.parse(text).body:
        decorators = getattr(node, "decorator_list", ())
        start = min([node.lineno, *(decorator.lineno for decorator in decorators)])
        yield node, "\n".join(lines[start - 1 : node.end_lineno])


@cache
def _given(homework: str) -> frozenset[str]:
    """Return the statements of an assignment's handout."""
    return frozenset(
        part for cell in reader.given_cells(homework) for _, part in _statements(cell.text)
    )


def handout_code(homework: str) -> tuple[str, ...]:
    """Return the code cells of an assignment's handout, stubs included."""
    return tuple(cell.text for cell in reader.assignment_cells(homework))
