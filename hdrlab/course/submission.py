"""What a student handed in, read and never run: the cells of the tasks, with what they need of other cells.

A notebook or a Python file is text. Its cells are found, and `closure` finds in them what each task needs.
"""

import hashlib
import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course.code.closure import Cell, closed

LARGEST = 50_000_000  # bytes: a notebook with pictures has a few
MOST_CODE = 1_000_000  # characters in all cells
FENCE = re.compile(r"^# %%(?P<kind> \[markdown\]| \[raw\])?(?P<rest>.*)$", re.MULTILINE)


class Submission(NamedTuple):
    """The text of each task's function with all that it needs, what is wrong, and a digest of the file."""

    sources: dict[str, str]
    problems: tuple[str, ...]
    hash: str


def tasks_of(path: str | Path, tasks: Sequence[str], given: Sequence[Cell] = ()) -> Submission:
    """Return what a file holds of the tasks; what cannot be read is told, and the rest is still there.

    Parameters
    ----------
    path : path
        A notebook, or a Python file in the percent form.
    tasks : sequence of str
        Their ids, which are the names of their functions.
    given : sequence of Cell
        The handout's own cells that are given; they take the place of the student's copies.
    """
    data, problems = _bytes_of(Path(path))
    cells, told = cells_of(data, Path(path).name) if data else ([], [])
    sources, said = closed(cells, tasks, given) if cells else ({}, [])
    return Submission(sources, (*problems, *told, *said), hashlib.sha256(data).hexdigest())


def _bytes_of(path: Path) -> tuple[bytes, list[str]]:
    if not path.is_file():  # a folder, a device, a pipe that never ends
        return b"", [f"{path.name} is not a file"]
    if path.stat().st_size > LARGEST:
        return b"", [f"{path.name} has more than {LARGEST // 1_000_000} MB; clear its outputs"]
    data = path.read_bytes()
    return data, [] if data.strip() else [f"{path.name} is empty"]


def cells_of(data: bytes, name: str) -> tuple[list[Cell], list[str]]:
    """Return the code cells of a file's bytes, and what is wrong with it, in words."""
    try:
        text = data.decode("utf8")
    except UnicodeDecodeError:
        return [], [f"{name} is neither a notebook nor Python text"]
    looks_like = text.lstrip()[:1] == "{"
    if not looks_like and len(text) > MOST_CODE:
        return [], [f"{name} holds more than {MOST_CODE:,} characters of code"]
    cells, problems = _notebook(text, name) if looks_like else (_percent(text), [])
    if name.endswith(".ipynb") and not looks_like:
        problems = [f"{name} is not a notebook, and was read as Python text"]
    if sum(len(cell.text) for cell in cells) > MOST_CODE:
        return [], [f"{name} holds more than {MOST_CODE:,} characters of code"]
    return cells, problems


def _notebook(text: str, name: str) -> tuple[list[Cell], list[str]]:
    try:
        read = json.loads(text)
    except (ValueError, RecursionError):
        return [], [f"{name} cannot be read as a notebook: it is cut short or damaged"]
    listed = read.get("cells") if isinstance(read, dict) else None
    if not isinstance(listed, list):
        return [], [f"{name} has no cells; a notebook of version 4 is expected"]
    code = [(n, one) for n, one in enumerate(listed, 1) if isinstance(one, dict)]
    return [_cell(n, one) for n, one in code if one.get("cell_type") == "code"], []


def _cell(n: int, read: dict[str, Any]) -> Cell:
    """Return a cell out of JSON, of which nothing is believed."""
    source = read.get("source", "")
    lines = source if isinstance(source, list) else [source]
    text = "".join(one for one in lines if isinstance(one, str))
    metadata = read.get("metadata")
    marked = metadata.get("hdrlab") if isinstance(metadata, dict) else None
    marked = marked if isinstance(marked, dict) else {}
    task = marked.get("task")
    return Cell(text, task if isinstance(task, str) else "", marked.get("given") is True, f"cell {n}")


def _percent(text: str) -> list[Cell]:
    """Return the cells of a Python file; one without fences is one cell."""
    fences = list(FENCE.finditer(text))
    ends = [*(one.start() for one in fences), len(text)]
    cells = [Cell(text[: ends[0]], where="the file's beginning")]
    line, counted = 1, 0
    for fence, start, end in zip(fences, (one.end() for one in fences), ends[1:], strict=True):
        if not fence["kind"]:
            task = re.search(r'task="(\w+)"', fence["rest"])
            line, counted = line + text.count("\n", counted, start), start
            cells.append(
                Cell(text[start:end], task[1] if task else "", "given=" in fence["rest"], f"line {line}")
            )
    return [cell for cell in cells if cell.text.strip()]
