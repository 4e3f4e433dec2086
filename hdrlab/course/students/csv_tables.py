"""Read and write CSV tables that are safe to open in a spreadsheet.

A spreadsheet takes a cell that starts with =, +, - or @ for a formula and runs it when the file is
opened. Text from students may start so. Such a cell is written with an apostrophe before it, which
spreadsheets hide. Numbers, including negative ones, stay numbers.
"""

import csv
import io
import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import NamedTuple

from hdrlab.errors import InputError
from hdrlab.io.files import write

Cell = str | int | float | None
MAX_TABLE_BYTES = 5_000_000
# The last four are full-width forms, which spreadsheets take for the usual ones.
FORMULA = re.compile(r"^\s*[=+\-@\uFF0B\uFF0D\uFF1D\uFF20|%]")
NUMBER = re.compile(r"^[+-]?\d+(\.\d+)?([eE][+-]?\d+)?$", re.ASCII)
CONTROL_CHARACTERS = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028\u2029]+")
ESCAPE = "'"


class CsvRow(NamedTuple):
    """A row of a table: the line of the file where it begins, and its cells by column."""

    line: int
    cells: dict[str, str]


class CsvTable(NamedTuple):
    """The lower-case names of a table's columns, as often as they occur, and its rows."""

    columns: list[str]
    rows: list[CsvRow]


def escape_cell(cell: Cell) -> str:
    r"""Return a cell as one line of text that no spreadsheet takes for a formula.

    Examples
    --------
    >>> escape_cell('=HYPERLINK("http://a")'), escape_cell("-2"), escape_cell(-2), escape_cell(None)
    ('\'=HYPERLINK("http://a")', '-2', '-2', '')
    """
    if cell is None:
        return ""
    text = CONTROL_CHARACTERS.sub(" ", str(cell)).strip()
    return ESCAPE + text if _is_escaped(text) else text


def _is_escaped(text: str) -> bool:
    """Return whether a text gets an apostrophe: a formula, or an apostrophe before such a text."""
    formula = text.lstrip(ESCAPE)
    return bool(FORMULA.match(formula) and not NUMBER.match(formula))


def unescape_cell(text: str) -> str:
    """Return the text of a cell that `escape_cell` wrote.

    An apostrophe that belongs to the text stays.

    Examples
    --------
    >>> unescape_cell("'=b2"), unescape_cell("b2"), unescape_cell("'b2")
    ('=b2', 'b2', "'b2")
    """
    is_escaped = text.startswith(ESCAPE) and _is_escaped(text)
    return text.removeprefix(ESCAPE) if is_escaped else text


def csv_text(header: Sequence[str], rows: Iterable[Sequence[Cell]]) -> str:
    """Return a table as CSV, with the line ends of RFC 4180."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\r\n")
    for row in [header, *rows]:
        writer.writerow([escape_cell(cell) for cell in row])
    return file.getvalue()


def write_csv(
    path: str | Path,
    header: Sequence[str],
    rows: Iterable[Sequence[Cell]],
    *,
    private: bool = False,
) -> Path:
    """Write a table completely or not at all, in UTF-8 with the byte order mark of spreadsheets.

    With `private`, only the owner of the file can read it, from the first byte on. Use it for
    grades and for links that allow voting.
    """
    return write(path, csv_text(header, rows).encode("utf-8-sig"), private=private)


def read_csv(path: str | Path, *, max_bytes: int = MAX_TABLE_BYTES) -> list[dict[str, str]]:
    """Read the rows of a CSV file, each by the lower-case names of its header.

    Empty lines are left out.

    Raises
    ------
    InputError
        As `read_table` does.
    """
    return [row.cells for row in read_table(path, max_bytes=max_bytes).rows]


def read_table(path: str | Path, *, max_bytes: int = MAX_TABLE_BYTES) -> CsvTable:
    """Read a CSV file with the line of each row, for messages that name it.

    Empty lines are left out.

    Raises
    ------
    InputError
        For a file of more than `max_bytes`, that is not UTF-8, or with a row longer than its
        header.
    """
    path = Path(path)
    size = path.stat().st_size
    if size > max_bytes:
        raise InputError(f"{path}: expected a table of at most {max_bytes} bytes, got {size}")
    try:
        text = path.read_text(encoding="utf-8-sig")
        rows = list(_nonempty_rows(text))
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: expected a table in UTF-8 ({error})") from None
    if not rows:
        raise InputError(f"{path}: expected a header and rows, but it is empty")
    header = [name.strip().lower() for name in rows[0][1]]
    max_cells = max(len(cells) for _, cells in rows)
    if max_cells > len(header):
        raise InputError(
            f"{path}: expected {len(header)} cells in each row, as in its header, got {max_cells}"
        )
    table = []
    for line, row in rows[1:]:
        cells = [cell.strip() for cell in row]
        table.append(CsvRow(line, dict(zip_longest(header, cells, fillvalue=""))))
    return CsvTable(header, table)


def _nonempty_rows(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the rows of a table that have a cell with text, each with the line where it begins."""
    reader = csv.reader(io.StringIO(text))
    line = 1
    for row in reader:
        if any(cell.strip() for cell in row):
            yield line, row
        line = reader.line_num + 1
