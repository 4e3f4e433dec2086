"""Tables for a spreadsheet: CSV whose cells are text, whatever a student put into a name or a title.

A spreadsheet takes a cell that begins with =, +, - or @ for a formula and runs it when the file is
opened. Such a cell is written with an apostrophe before it, which spreadsheets show as the text
that follows. Numbers, negative ones too, stay numbers.
"""

import csv
import io
import re
from collections.abc import Iterable, Sequence
from itertools import zip_longest
from pathlib import Path

from hdrlab.errors import InputError
from hdrlab.io.files import write

Cell = str | int | float | None
FORMULA = re.compile(
    r"^\s*[=+\-@\uFF0B\uFF0D\uFF1D\uFF20|%]"
)  # the wide forms are taken for the narrow ones
NUMBER = re.compile(r"^[+-]?\d+(\.\d+)?([eE][+-]?\d+)?$", re.ASCII)
CONTROLS = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028\u2029]+")


def safe(cell: Cell) -> str:
    r"""Return a cell as text on one line that no spreadsheet takes for a formula.

    Examples
    --------
    >>> safe('=HYPERLINK("http://a")'), safe("-2"), safe(-2), safe(None)
    ('\'=HYPERLINK("http://a")', '-2', '-2', '')
    """
    if cell is None:
        return ""
    text = CONTROLS.sub(" ", str(cell)).strip()
    return "'" + text if FORMULA.match(text) and not NUMBER.match(text) else text


def csv_text(header: Sequence[str], rows: Iterable[Sequence[Cell]]) -> str:
    """Return a table as CSV, with lines that end as RFC 4180 says."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\r\n")
    writer.writerow([safe(one) for one in header])
    writer.writerows([safe(one) for one in row] for row in rows)
    return file.getvalue()


def write_csv(
    path: str | Path,
    header: Sequence[str],
    rows: Iterable[Sequence[Cell]],
    *,
    private: bool = False,
) -> Path:
    """Write a table whole or not at all, in UTF-8 with the mark that spreadsheets ask for.

    A private one is for its owner's eyes from the first byte on: links that vote, grades.
    """
    return write(path, csv_text(header, rows).encode("utf-8-sig"), private=private)


def read_csv(path: str | Path, *, most: int = 5_000_000) -> list[dict[str, str]]:
    """Return the rows of a CSV file by the names of its header, in lower case; empty lines are left out.

    Raises
    ------
    ValueError
        For a file that is larger than `most` bytes, is not UTF-8, or has a row longer than its
        header.
    """
    path = Path(path)
    if path.stat().st_size > most:
        raise InputError(
            f"{path}: expected a table of at most {most} bytes, got {path.stat().st_size}"
        )
    try:
        text = path.read_text(encoding="utf-8-sig")
        lines = [
            line for line in csv.reader(io.StringIO(text)) if any(cell.strip() for cell in line)
        ]
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: expected a table in UTF-8 ({error})") from None
    if not lines:
        raise InputError(f"{path}: expected a header and rows, it is empty")
    header = [name.strip().lower() for name in lines[0]]
    if (longest := max(map(len, lines))) > len(header):
        raise InputError(
            f"{path}: expected {len(header)} cells a row, as in its header, got {longest}"
        )
    return [dict(zip_longest(header, map(str.strip, line), fillvalue="")) for line in lines[1:]]
