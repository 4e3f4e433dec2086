"""What of a homework a team wrote itself: each task's function with its helpers, without what all were given.

It is read and never run, and within bounds, since it is read where the whole class is at hand: what
is longer than any homework, or nested too deep, is left out, and it is said.
"""

import ast
import re
import warnings
from collections.abc import Collection, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

from hdrlab.course import submission
from hdrlab.course.code import names
from hdrlab.course.material import handouts

# characters of one task, and of all
TASK = 30_000
ALL = 100_000
WORDS = re.compile(r"""\w+|'[^']*'|"[^"]*\"""")


class Work(NamedTuple):
    """What a team wrote: the text of each task, what could not be read, and its sheet's variants."""

    team: str
    texts: dict[str, str]
    notes: tuple[str, ...] = ()
    variants: dict[str, str] | None = None


def read(team: str, path: Path, homework: str, tasks: Sequence[str]) -> Work:
    r"""Return what a team wrote of these tasks, out of a notebook or a Python file.

    Parameters
    ----------
    team : whose it is
    path : the file, which may hold anything, or an archive of it
    homework : its handout is given
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
        found = submission.read(path, homework, tasks, handouts.given_cells(homework))
    except ValueError as error:
        return Work(team, {}, (str(error),))
    texts: dict[str, str] = {}
    notes = [] if found.sources else [*found.problems, "none of the tasks can be read in it"]
    for task, text in found.sources.items():
        if len(text) > TASK or sum(map(len, texts.values())) + len(text) > ALL:
            over = f"{TASK:,} characters, or {ALL:,} with the tasks before it"
            notes.append(f"{task} has more than {over}, and is not compared")
            continue
        try:
            texts[task] = own(text, homework, {*tasks} - {task})
        except names.BROKEN:
            notes.append(f"{task} is nested too deep and is not compared")
    return Work(team, texts, tuple(notes), found.variants)


def own(text: str, homework: str, others: Collection[str]) -> str:
    """Return the statements of a task that are neither imports, nor given, nor other tasks, by their shape.

    So two texts that hold the same statements are one text, in whatever order, under whatever
    names. It has no empty lines: copydetect takes a time that is quadratic in them.
    """
    with warnings.catch_warnings(
        action="ignore"
    ):  # of the parser, which every odd number has one of
        parts = sorted(_own(text, _given(homework), others), key=_shape)
    return "\n".join(line for part in parts for line in part.split("\n") if line.strip())


def _shape(part: str) -> str:
    """Return a statement without names, strings and comments."""
    return WORDS.sub("V", ast.unparse(ast.parse(part)))


def _own(text: str, given: Collection[str], others: Collection[str]) -> Iterator[str]:
    """Yield the statements of a task that are neither imports, nor given, nor other tasks."""
    for node, part in _statements(text):
        if isinstance(node, ast.Import | ast.ImportFrom) or part in given:
            continue
        if not set(names.bound(node)) & set(others):
            yield part


def _statements(text: str) -> Iterator[tuple[ast.stmt, str]]:
    """Yield each statement at the top of a text, with its own lines."""
    text = re.sub(r"\r\n?", "\n", text)
    lines = text.split("\n")  # as the parser counts them: a form feed ends no line
    for node in ast.parse(text).body:
        start = min([node.lineno, *(one.lineno for one in getattr(node, "decorator_list", ()))])
        yield node, "\n".join(lines[start - 1 : node.end_lineno])


@cache
def _given(homework: str) -> frozenset[str]:
    """Return the statements that a homework's handout gives."""
    return frozenset(
        part for cell in handouts.given_cells(homework) for _, part in _statements(cell.text)
    )


def handout_code(homework: str) -> tuple[str, ...]:
    """Return the code of a homework's handout: what is given, and the beginnings of the tasks."""
    return tuple(cell.text for cell in handouts.cells(homework))
