"""What a student handed in, read and never run: the cells of the tasks, with what they need of other cells.

A notebook or a Python file is text. Its cells are found, and `closure` finds in them what each task
needs. An archive is opened for the one file in it. `read` does so in a process with limits:
whatever is handed in costs the grader a few seconds at most.
"""

import hashlib
import io
import json
import re
import tempfile
import tokenize
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course import materials
from hdrlab.course.sandbox import subprocess_runner
from hdrlab.course.sanitize import sanitize_line
from hdrlab.course.source_code import closure, names
from hdrlab.course.submissions.archives import unpack
from hdrlab.course.submissions.archives.members import Limits, Refused
from hdrlab.errors import InputError

READ, PACKED = (".ipynb", ".py"), (".zip", ".tar", ".gz", ".tgz", ".xz", ".bz2")
LARGEST = 50_000_000  # bytes: a notebook with pictures has a few
MOST_CODE = 1_000_000  # characters in all cells
MOST_SOURCE = 900_000  # bytes of a task with all that it needs, on its way to the sandbox
UNPACKED = Limits(total=1 << 28)  # of an archive: a notebook, and the photographs that it reads
SECONDS, MEMORY = (
    2,
    500 << 20,
)  # of a processor, and bytes, to read a file in; a worked homework takes 0.1 s
UNPACKING = 3  # seconds more for an archive
TRIES = 3  # of a process that somebody else ends
PATIENCE = 25.0  # seconds by the clock: it is read twice, and costs 300 s at most with its checks
TOLD = 12  # problems that are told
VARIANT = re.compile(
    r'"(\w{1,40})":\s+"(\w+(?:/\w+)+)"'
)  # as a sheet names it in its call of use_plan
FENCE = re.compile(r"^# %%(?P<kind> \[markdown\]| \[raw\])?(?P<rest>.*)$", re.MULTILINE)


class SubmittedCode(NamedTuple):
    """The text of each task's function with all that it needs, what is wrong, a digest, and the imports.

    `variants` are what its sheet says that tasks ask, None of a file without a sheet's `use_plan`.
    """

    sources: dict[str, str]
    problems: tuple[str, ...]
    hash: str
    modules: tuple[str, ...] = ()
    variants: dict[str, str] | None = None


def read(
    path: Path, homework: str, tasks: Sequence[str], given: Sequence[closure.Cell] = ()
) -> SubmittedCode:
    """Return what a notebook, a Python file or an archive of one holds, read in a process with limits.

    Raises
    ------
    ValueError
        Where that process was ended from outside, again and again, of which nothing can be said.
    """
    limits = {"CPU": SECONDS + UNPACKING * (path.suffix.lower() in PACKED), "AS": MEMORY}
    for tried in range(1, TRIES + 1):
        try:
            with tempfile.TemporaryDirectory(
                prefix="hdrlab-read-", ignore_cleanup_errors=True
            ) as scratch:
                order = (path, Path(scratch), homework, tuple(tasks), tuple(given))
                said = json.loads(
                    subprocess_runner.run(_read, order, timeout=PATIENCE, limits=limits)
                )
            break
        except subprocess_runner.ProcessFailed as error:
            if error.is_own_fault:
                what = f"takes more than {limits['CPU']} s or {MEMORY >> 20} MB to read, as no homework does"
                return SubmittedCode({}, (f"{sanitize_line(path.name, 80)} {what}",), "")
            if tried == TRIES or not error.was_killed:
                raise InputError(f"it could not be read: {error}") from None
    return SubmittedCode(said[0], tuple(said[1]), said[2], tuple(said[3]), said[4])


def _read(order: tuple[Path, Path, str, Sequence[str], Sequence[closure.Cell]]) -> bytes:
    path, scratch, homework, tasks, given = order
    opened_path, refused = opened(path, scratch, homework)
    found = SubmittedCode({}, (refused,), "") if refused else tasks_of(opened_path, tasks, given)
    return json.dumps(
        found._replace(modules=tuple(names.imported_numpy_modules(found.sources.values())))
    ).encode()


def opened(path: Path, scratch: Path, homework: str) -> tuple[Path, str]:
    """Return the notebook or Python file of a submission, and why its archive was refused, or ""."""
    if path.suffix.lower() not in PACKED or not path.is_file():
        return path, ""
    try:
        members = unpack.unpack(path, scratch / "files", UNPACKED)
    except Refused as reason:
        return path, f"The archive is refused: {reason}."
    fitting = [member for member, _ in members if member.suffix.lower() in READ]
    named = [member for member in fitting if homework in member.name.lower()] or fitting
    if len(named) != 1:
        told = ", ".join(sanitize_line(member.name, 80) for member in named[:5]) or "none"
        return path, f"Expected one notebook or Python file in the archive, got {told}."
    return scratch / "files" / named[0], ""


def tasks_of(
    path: str | Path, tasks: Sequence[str], given: Sequence[closure.Cell] = ()
) -> SubmittedCode:
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
    sources, said = (
        closure.extract_sources(cells, tasks, given)
        if cells or not (problems or told)
        else ({}, [])
    )
    for task in [task for task, text in sources.items() if len(json.dumps(text)) > MOST_SOURCE]:
        del sources[task]
        said.append(f"{task} needs more than {MOST_SOURCE:,} characters of code")
    problems = [sanitize_line(one, 300) for one in [*problems, *told, *said]]
    if len(problems) > TOLD:
        problems[TOLD:] = [f"... and {len(problems) - TOLD} more of the kind"]
    sheets = [cell.text for cell in cells if "use_plan(" in cell.text]
    variants = dict(VARIANT.findall("".join(sheets))) if sheets else None
    return SubmittedCode(
        sources, tuple(problems), hashlib.sha256(data).hexdigest(), variants=variants
    )


def _bytes_of(path: Path) -> tuple[bytes, list[str]]:
    if not path.is_file():  # a folder, a device, a pipe that never ends
        return b"", [f"{path.name} is not a file"]
    if path.stat().st_size > LARGEST:
        return b"", [f"{path.name} has more than {LARGEST // 1_000_000} MB; clear its outputs"]
    data = path.read_bytes()
    return data, [] if data.strip() else [f"{path.name} is empty"]


def cells_of(data: bytes, name: str) -> tuple[list[closure.Cell], list[str]]:
    """Return the code cells of a file's bytes, and what is wrong with it, in words."""
    try:
        text = _decoded(data)
    except (UnicodeError, LookupError, SyntaxError):
        return [], [f"{name} is neither a notebook nor Python text; save it in UTF-8"]
    looks_like = text.lstrip()[:1] == "{"
    cells, problems = _notebook(text, name) if looks_like else (_percent(text), [])
    if name.lower().endswith(".ipynb") and not looks_like:
        problems = [f"{name} is not a notebook, and was read as Python text"]
    if sum(len(cell.text) for cell in cells) > MOST_CODE:
        return [], [f"{name} holds more than {MOST_CODE:,} characters of code"]
    return cells, problems


def _decoded(data: bytes) -> str:
    """Return a file's text as its author meant it: by its byte order mark, as Python does, or UTF-8."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16")
    if data.lstrip()[:1] == b"{":  # JSON, where a comment about coding would be something else
        return data.decode("utf-8")
    return data.decode(tokenize.detect_encoding(io.BytesIO(data).readline)[0])


def _notebook(text: str, name: str) -> tuple[list[closure.Cell], list[str]]:
    try:
        read = json.loads(text)
    except (ValueError, RecursionError):
        return [], [f"{name} cannot be read as a notebook: it is cut short or damaged"]
    listed = read.get("cells", read.get("worksheets")) if isinstance(read, dict) else None
    if not isinstance(listed, list):
        return [], [f"{name} has no cells; a notebook of version 4 is expected"]
    if "cells" not in read:  # version 3 has sheets of cells
        sheets = [one.get("cells") for one in listed if isinstance(one, dict)]
        listed = [cell for sheet in sheets if isinstance(sheet, list) for cell in sheet]
    code = [(n, one) for n, one in enumerate(listed, 1) if isinstance(one, dict)]
    return [_cell(n, one) for n, one in code if one.get("cell_type") == "code"], []


def _cell(n: int, read: dict[str, Any]) -> closure.Cell:
    """Return a cell out of JSON, of which nothing is believed."""
    source = read.get("source", read.get("input", ""))  # the latter in version 3
    lines = source if isinstance(source, list) else [source]
    text, metadata = "".join(one for one in lines if isinstance(one, str)), read.get("metadata")
    marked = metadata.get("hdrlab") if isinstance(metadata, dict) else None
    marked = marked if isinstance(marked, dict) else {}
    task = marked.get("task")
    return closure.Cell(
        text, task if isinstance(task, str) else "", marked.get("given") is True, f"cell {n}"
    )


def _percent(text: str) -> list[closure.Cell]:
    """Return the cells of a Python file; one without fences is one cell."""
    fences = list(FENCE.finditer(text))
    ends = [*(one.start() for one in fences), len(text)]
    cells = [closure.Cell(text[: ends[0]], where="the file's beginning")]
    line, counted = 1, 0
    for fence, start, end in zip(fences, (one.end() for one in fences), ends[1:], strict=True):
        if not fence["kind"]:
            marked = re.search(r'task="(\w+)"', fence["rest"])
            task, given = marked[1] if marked else "", "given=" in fence["rest"]
            line, counted = line + text.count("\n", counted, start), start
            cells.append(closure.Cell(text[start:end], task, given, f"line {line}"))
    return [cell for cell in cells if cell.text.strip()]


@cache
def assignment_cells(homework: str) -> tuple[closure.Cell, ...]:
    """Return the code cells of a homework's assignment that comes with hdrlab; () if there is none."""
    file = materials.folder("assignments") / f"{homework}.ipynb"
    return tuple(cells_of(file.read_bytes(), file.name)[0]) if file.is_file() else ()


def given_cells(homework: str) -> tuple[closure.Cell, ...]:
    """Return the code cells that a homework's assignment gives to the students."""
    return tuple(cell for cell in assignment_cells(homework) if cell.given)
