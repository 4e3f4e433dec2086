"""Read one submission without running it: find the code of each task in a notebook or Python file.

A notebook or a Python file is text. hdrlab finds its code cells, and `closure` finds in them
everything that each task needs. From an archive, hdrlab reads the one notebook or Python file in
it. All this happens in a process with limits, so that a malicious file costs the grader a few
seconds at most.
"""

import hashlib
import io
import json
import re
import tempfile
import tokenize
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course import materials
from hdrlab.course.sandbox import in_process, subprocess_runner
from hdrlab.course.sanitize import sanitize_line
from hdrlab.course.source_code import closure, names
from hdrlab.course.submissions.archives import unpack
from hdrlab.course.submissions.archives.members import ArchiveLimits, ArchiveRejected
from hdrlab.errors import InputError

CODE_SUFFIXES = (".ipynb", ".py")
ARCHIVE_SUFFIXES = (".zip", ".tar", ".gz", ".tgz", ".xz", ".bz2")
MAX_FILE_BYTES = 50_000_000  # a notebook with images has a few million
MAX_CODE_CHARACTERS = 1_000_000  # in all cells
MAX_SOURCE_CHARACTERS = 900_000  # of a task with everything that it needs
# an archive may hold the notebook and the photos that it reads
ARCHIVE_LIMITS = ArchiveLimits(max_total_bytes=256 * 2**20)
READING_CPU_SECONDS = 2  # a finished homework takes 0.1 s
UNPACKING_CPU_SECONDS = 3  # in addition, for an archive
READING_MEMORY_BYTES = 500 * 2**20
# a submission is read twice, so that it costs at most 2 x 25 s beside its checks
READING_TIMEOUT_SECONDS = 25.0
MAX_ATTEMPTS = 3  # for a process that something else kills
MAX_SHOWN_PROBLEMS = 12
MAX_PROBLEM_LENGTH = 300
MAX_NAME_LENGTH = 80
MAX_SHOWN_NAMES = 5
# "exclusion": "compared/above/four", or "display": "factor", in a sheet's call of use_plan
VARIANT = re.compile(r'"(\w{1,40})":\s+"(\w+(?:/\w+)*)"')
FENCE = re.compile(r"^# %%(?P<kind> \[markdown\]| \[raw\])?(?P<rest>.*)$", re.MULTILINE)


class TextCell(NamedTuple):
    """A cell of a submission as a Python file in the percent format has it.

    Attributes
    ----------
    header : the line before the cell, such as "# %% [markdown]", or ""
    text : its code, or its text as a comment
    is_code : whether it is code
    """

    header: str
    text: str
    is_code: bool


@dataclass(frozen=True)
class SubmittedCode:
    """The code of a submission.

    Attributes
    ----------
    sources : of each task, its function's text with everything that it needs
    problems : what is wrong with the submission, as sentences
    hash : SHA-256 of the file
    modules : the modules of NumPy and SciPy that the sources import
    variants : the variants of tasks that its sheet names; None if the file has no `use_plan`
    """

    sources: dict[str, str]
    problems: tuple[str, ...]
    hash: str
    modules: tuple[str, ...] = ()
    variants: dict[str, str] | None = None


def read(
    path: Path, homework: str, tasks: Sequence[str], given: Sequence[closure.Cell] = ()
) -> SubmittedCode:
    """Return the code of a notebook, a Python file or an archive of one, read in a process with limits.

    Parameters
    ----------
    path : path
        The file that was handed in.
    homework : str
        Name of the homework; it tells which file of an archive is meant.
    tasks : sequence of str
        Ids of the tasks, which are the names of their functions.
    given : sequence of Cell
        Code cells that the assignment gives; they replace the student's copies.

    Raises
    ------
    InputError
        If something outside kills that process again and again, so that nothing is known about the
        submission, and in a browser, where there are no processes.
    """
    if in_process.IS_BROWSER:
        raise InputError(
            "grading a file needs processes, which a page in a browser does not have; "
            'here, run the cells and call check("gsolve"), or grade the file with hdrlab '
            "on a computer"
        )
    cpu_seconds = READING_CPU_SECONDS
    if path.suffix.lower() in ARCHIVE_SUFFIXES:
        cpu_seconds += UNPACKING_CPU_SECONDS
    limits = {"CPU": cpu_seconds, "AS": READING_MEMORY_BYTES}
    attempts = 1
    while True:
        try:
            return _read_in_subprocess(path, homework, tasks, given, limits)
        except subprocess_runner.ProcessFailed as error:
            if error.is_own_fault:
                name = sanitize_line(path.name, MAX_NAME_LENGTH)
                megabytes = READING_MEMORY_BYTES // 2**20
                problem = (
                    f"{name} takes more than {cpu_seconds} s or {megabytes} MB to read; "
                    "no homework needs that much"
                )
                return SubmittedCode({}, (problem,), "")
            if attempts == MAX_ATTEMPTS or not error.was_killed:
                raise InputError(f"the submission could not be read: {error}") from None
            attempts += 1


def _read_in_subprocess(
    path: Path,
    homework: str,
    tasks: Sequence[str],
    given: Sequence[closure.Cell],
    limits: dict[str, int],
) -> SubmittedCode:
    """Read a submission in a process with limits, and return its code."""
    with tempfile.TemporaryDirectory(prefix="hdrlab-read-", ignore_cleanup_errors=True) as scratch:
        order = (path, Path(scratch), homework, tuple(tasks), tuple(given))
        answer = json.loads(
            subprocess_runner.run(
                _read_as_json, order, timeout=READING_TIMEOUT_SECONDS, limits=limits
            )
        )
    return SubmittedCode(
        sources=answer["sources"],
        problems=tuple(answer["problems"]),
        hash=answer["hash"],
        modules=tuple(answer["modules"]),
        variants=answer["variants"],
    )


def _read_as_json(order: tuple[Path, Path, str, Sequence[str], Sequence[closure.Cell]]) -> bytes:
    """Read a submission, and return its code as JSON: what the process with limits runs."""
    path, scratch, homework, tasks, given = order
    code_path, refusal = extract_code_file(path, scratch, homework)
    code = SubmittedCode({}, (refusal,), "") if refusal else tasks_of(code_path, tasks, given)
    modules = names.imported_numpy_modules(code.sources.values())
    answer = {
        "sources": code.sources,
        "problems": code.problems,
        "hash": code.hash,
        "modules": list(modules),
        "variants": code.variants,
    }
    return json.dumps(answer).encode()


def read_text(path: Path, homework: str) -> list[TextCell]:
    """Return all cells of a submission, code and text, without outputs and attached files.

    They are read in a process with limits. A submission that cannot be read has no cells; `read`
    says why.

    Parameters
    ----------
    path : the file that was handed in
    homework : name of the homework; it tells which file of an archive is meant
    """
    limits = {"CPU": READING_CPU_SECONDS + UNPACKING_CPU_SECONDS, "AS": READING_MEMORY_BYTES}
    with tempfile.TemporaryDirectory(prefix="hdrlab-read-", ignore_cleanup_errors=True) as scratch:
        order = (path, Path(scratch), homework)
        try:
            answer = subprocess_runner.run(
                _read_text_as_json, order, timeout=READING_TIMEOUT_SECONDS, limits=limits
            )
        except subprocess_runner.ProcessFailed:
            return []
    return [TextCell(*cell) for cell in json.loads(answer)]


def _read_text_as_json(order: tuple[Path, Path, str]) -> bytes:
    """Return all cells of a submission as JSON: what the process with limits runs."""
    path, scratch, homework = order
    code_path, refusal = extract_code_file(path, scratch, homework)
    data, problems = _bytes_of(code_path)
    cells: list[TextCell] = []
    if not (refusal or problems):
        try:
            cells = _text_cells(_decode(data))
        except (UnicodeError, LookupError, SyntaxError, ValueError, RecursionError):
            cells = []
    if sum(len(cell.text) for cell in cells) > MAX_CODE_CHARACTERS:
        cells = []
    return json.dumps(cells).encode()


def _text_cells(text: str) -> list[TextCell]:
    """Return the cells of a notebook; a Python file is one cell."""
    if text.lstrip()[:1] != "{":
        return [TextCell("", text, is_code=True)]
    cells = []
    for number, cell in enumerate(_cells_as_json(json.loads(text)) or (), 1):
        if not isinstance(cell, dict):
            continue
        read = _code_cell(number, cell)
        if cell.get("cell_type") == "code":
            task = f' task="{read.task}"' if re.fullmatch(r"\w+", read.task) else ""
            given = " given=true" if read.given else ""
            cells.append(TextCell(f"# %%{task}{given}", read.text, is_code=True))
        else:
            comment = "\n".join(f"# {line}".rstrip() for line in read.text.splitlines())
            cells.append(TextCell("# %% [markdown]", comment, is_code=False))
    return cells


def extract_code_file(path: Path, scratch: Path, homework: str) -> tuple[Path, str]:
    """Return the notebook or Python file of a submission, and why its archive was refused, or "".

    An archive is unpacked into a folder of `scratch`.
    """
    if path.suffix.lower() not in ARCHIVE_SUFFIXES or not path.is_file():
        return path, ""
    try:
        members = unpack.unpack(path, scratch / "files", ARCHIVE_LIMITS)
    except ArchiveRejected as reason:
        return path, f"The archive is refused: {reason}."
    code_files = [member for member, _ in members if member.suffix.lower() in CODE_SUFFIXES]
    of_homework = [member for member in code_files if homework in member.name.lower()]
    candidates = of_homework or code_files
    if len(candidates) != 1:
        shown = [
            sanitize_line(member.name, MAX_NAME_LENGTH) for member in candidates[:MAX_SHOWN_NAMES]
        ]
        listed = ", ".join(shown) or "none"
        return path, f"Expected one notebook or Python file in the archive, got {listed}."
    return scratch / "files" / candidates[0], ""


def tasks_of(
    path: str | Path, tasks: Sequence[str], given: Sequence[closure.Cell] = ()
) -> SubmittedCode:
    """Return the code of each task in a file, with a problem for everything that cannot be read.

    Parameters
    ----------
    path : path
        A notebook, or a Python file in the percent format.
    tasks : sequence of str
        Ids of the tasks, which are the names of their functions.
    given : sequence of Cell
        Code cells that the assignment gives; they replace the student's copies.
    """
    path = Path(path)
    data, problems = _bytes_of(path)
    cells: list[closure.Cell] = []
    if data:
        cells, cell_problems = cells_of(data, path.name)
        problems += cell_problems
    sources: dict[str, str] = {}
    if cells or not problems:
        sources, source_problems = closure.extract_sources(cells, tasks, given)
        problems += source_problems
    for task, text in list(sources.items()):
        if len(json.dumps(text)) > MAX_SOURCE_CHARACTERS:
            del sources[task]
            problems.append(f"{task} needs more than {MAX_SOURCE_CHARACTERS:,} characters of code")
    shown = [
        sanitize_line(problem, MAX_PROBLEM_LENGTH) for problem in problems[:MAX_SHOWN_PROBLEMS]
    ]
    if len(problems) > MAX_SHOWN_PROBLEMS:
        shown.append(f"... and {len(problems) - MAX_SHOWN_PROBLEMS} more problems of this kind")
    return SubmittedCode(
        sources=sources,
        problems=tuple(shown),
        hash=hashlib.sha256(data).hexdigest(),
        variants=_variants_on_sheet(cells),
    )


def _variants_on_sheet(cells: Sequence[closure.Cell]) -> dict[str, str] | None:
    """Return the variants by task that calls of `use_plan` name; None if there is no such call."""
    plan_cells = [cell.text for cell in cells if "use_plan(" in cell.text]
    if not plan_cells:
        return None
    return dict(VARIANT.findall("".join(plan_cells)))


def _bytes_of(path: Path) -> tuple[bytes, list[str]]:
    """Return the bytes of a file, and what is wrong with it."""
    if not path.is_file():  # a folder, a device, a pipe that never ends
        return b"", [f"{path.name} is not a file"]
    if path.stat().st_size > MAX_FILE_BYTES:
        megabytes = MAX_FILE_BYTES // 1_000_000
        return b"", [f"{path.name} is larger than {megabytes} MB; clear its outputs"]
    data = path.read_bytes()
    return data, [] if data.strip() else [f"{path.name} is empty"]


def cells_of(data: bytes, name: str) -> tuple[list[closure.Cell], list[str]]:
    """Return the code cells of a file's bytes, and what is wrong with it, in words."""
    try:
        text = _decode(data)
    except (UnicodeError, LookupError, SyntaxError):
        return [], [f"{name} is neither a notebook nor Python text; save it in UTF-8"]
    if text.lstrip()[:1] == "{":
        cells, problems = _notebook_cells(text, name)
    else:
        cells = _percent_cells(text)
        problems = []
        if name.lower().endswith(".ipynb"):
            problems = [f"{name} is not a notebook; hdrlab read it as Python text"]
    if sum(len(cell.text) for cell in cells) > MAX_CODE_CHARACTERS:
        return [], [f"{name} has more than {MAX_CODE_CHARACTERS:,} characters of code"]
    return cells, problems


def _decode(data: bytes) -> str:
    """Return the text of a file: by its byte order mark, its coding comment as in Python, or UTF-8."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16")
    if data.lstrip()[:1] == b"{":  # in JSON, the word "coding" is no coding comment
        return data.decode("utf-8")
    encoding, _ = tokenize.detect_encoding(io.BytesIO(data).readline)
    return data.decode(encoding)


def _notebook_cells(text: str, name: str) -> tuple[list[closure.Cell], list[str]]:
    """Return the code cells of a notebook of version 3 or 4, and what is wrong with it."""
    try:
        notebook = json.loads(text)
    except (ValueError, RecursionError):
        return [], [f"{name} cannot be read as a notebook: it is cut short or damaged"]
    cells = _cells_as_json(notebook)
    if cells is None:
        return [], [f"{name} has no cells; expected a notebook of version 4"]
    code_cells = [
        _code_cell(number, cell)
        for number, cell in enumerate(cells, 1)
        if isinstance(cell, dict) and cell.get("cell_type") == "code"
    ]
    return code_cells, []


def _cells_as_json(notebook: Any) -> list[Any] | None:
    """Return the cells of a notebook as JSON; None if this is no notebook."""
    if not isinstance(notebook, dict):
        return None
    if "cells" in notebook:
        cells = notebook["cells"]
        return cells if isinstance(cells, list) else None
    worksheets = notebook.get("worksheets")  # of version 3
    if not isinstance(worksheets, list):
        return None
    cells = []
    for worksheet in worksheets:
        if isinstance(worksheet, dict) and isinstance(worksheet.get("cells"), list):
            cells += worksheet["cells"]
    return cells


def _code_cell(number: int, cell: dict[str, Any]) -> closure.Cell:
    """Return a code cell from JSON in which any value may have any type."""
    source = cell.get("source", cell.get("input", ""))  # version 3 has "input"
    lines = source if isinstance(source, list) else [source]
    text = "".join(line for line in lines if isinstance(line, str))
    # JSON may hold half of a character, which no Python file can; in a comment it does no harm
    text = text.encode("utf-16", "surrogatepass").decode("utf-16", "replace")
    metadata = cell.get("metadata")
    marks = metadata.get("hdrlab") if isinstance(metadata, dict) else None
    if not isinstance(marks, dict):
        marks = {}
    task = marks.get("task")
    return closure.Cell(
        text=text,
        task=task if isinstance(task, str) else "",
        given=marks.get("given") is True,
        where=f"cell {number}",
    )


def _percent_cells(text: str) -> list[closure.Cell]:
    """Return the code cells of a Python file; a file without `# %%` is one cell."""
    fences = list(FENCE.finditer(text))
    starts = [fence.end() for fence in fences]
    ends = [*(fence.start() for fence in fences), len(text)]
    cells = [closure.Cell(text[: ends[0]], where="the beginning of the file")]
    line = 1
    counted = 0  # characters of the text whose lines are counted
    for fence, start, end in zip(fences, starts, ends[1:], strict=True):
        if fence["kind"]:  # text, not code
            continue
        line += text.count("\n", counted, start)
        counted = start
        task = re.search(r'task="(\w+)"', fence["rest"])
        cells.append(
            closure.Cell(
                text=text[start:end],
                task=task[1] if task else "",
                given="given=" in fence["rest"],
                where=f"line {line}",
            )
        )
    return [cell for cell in cells if cell.text.strip()]


@cache
def assignment_cells(homework: str) -> tuple[closure.Cell, ...]:
    """Return the code cells of a homework's assignment that comes with hdrlab; () if there is none."""
    path = materials.folder("assignments") / f"{homework}.ipynb"
    if not path.is_file():
        return ()
    cells, _ = cells_of(path.read_bytes(), path.name)
    return tuple(cells)


def given_cells(homework: str) -> tuple[closure.Cell, ...]:
    """Return the code cells that a homework's assignment gives to the students."""
    return tuple(cell for cell in assignment_cells(homework) if cell.given)
