"""Lists of exposure times, and which times a bracket takes: those given explicitly before those of EXIF."""

import csv
import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.errors import InputError
from hdrlab.io.exif_exposure import HINT, Exposure, equivalent, positive
from hdrlab.io.files import require_no_folder

Times = Sequence[float] | NDArray[np.floating] | Mapping[str, float] | str | Path

# 0.5, 1/60, 0,5 and each of them with a unit, as `_tidy` writes them
VALUE = re.compile(r"([\d.,]+(?:e[-+]?\d+)?)(?:/([\d.]+))?(s?)", re.IGNORECASE)
KNOWN = tomllib.loads(Path(__file__).with_name("times.toml").read_text("utf8"))
HEADINGS, COLUMNS = KNOWN["headings"], KNOWN["columns"]
# the least ISO speed, and more than any f-number
LEAST_ISO = 50
# of the brightness of the photographs with the times of a list: less decides nothing
CORRELATION = 0.5
# letters: a name and a few numbers
LONGEST_LINE = 10_000


class TimeList(NamedTuple):
    """Equivalent exposure in seconds of each file name; and the same of numbers that may be 1/seconds."""

    seconds: dict[str, float]
    inverse: dict[str, float] | None = None


def bracket_times(
    names: Sequence[str], exposures: Sequence[Exposure], times: Times | None
) -> tuple[list[float], list[float] | None]:
    """Return the equivalent exposure of each photograph: what was given, else what its EXIF says.

    The second list is there where a list of numbers may as well be 1/seconds, and EXIF does not
    decide it.

    Raises
    ------
    ValueError
        Naming the photograph whose time is missing or not positive.
    """
    if times is None:
        return equivalent(names, exposures), None
    where, inverse = "the times given", None
    if isinstance(times, str | Path):
        where, (times, inverse) = str(times), read_times(times)
    if isinstance(times, Mapping):
        times = _look_up(times, names, where)
    if len(times) != len(names):
        raise InputError(
            f"expected {len(names)} exposure times, one per photograph, got {len(times)}"
        )
    for name, t in zip(names, times, strict=True):
        if not 0 < t < np.inf:
            raise InputError(
                f"{name}: expected a positive exposure time in seconds, got {t}; {HINT}"
            )
    seconds = [float(t) for t in times]
    if inverse is None:
        return seconds, None
    other = _look_up(inverse, names, where)
    if any(one.seconds is None for one in exposures):
        return seconds, other
    return (other if are_inverse(seconds, equivalent(names, exposures), where) else seconds), None


def are_inverse(
    seconds: Sequence[float], brightness: ArrayLike, where: str = "the list of times"
) -> bool:
    """Return whether numbers are 1/seconds: where the photographs get darker as they rise.

    Examples
    --------
    >>> are_inverse([60, 30, 15], [20, 40, 80])
    True
    """
    if np.ptp(seconds) == 0 or np.ptp(brightness) == 0:
        return False
    r = float(
        np.corrcoef(np.argsort(np.argsort(seconds)), np.argsort(np.argsort(brightness)))[0, 1]
    )
    if abs(r) < CORRELATION:
        why = "to distinguish seconds from 1/seconds; write them as 1/60 or as 0.5 s"
        raise InputError(
            f"{where}: expected numbers that rise or fall with the photographs' brightness, {why}"
        )
    return r < 0


def read_times(path: str | Path) -> TimeList:
    """Read a list of exposure times that comes with a bracket.

    Parameters
    ----------
    path : a text file, a photograph a line: its name and its time, between them a comma, semicolon,
        tab or
        space. A time is 1/60, 1/60 s, 0.0166, or 60, which may mean either 60 s or 1/60 s. There
        may be a heading (file, exposure_time_s or 1/seconds, f_number, iso), or the f-number and
        the ISO speed behind the time. Debevec's list (name, exposure, 1/seconds, f-stop, gain in
        dB, ND filters) is read, too. # begins a comment.

    Returns
    -------
    TimeList : exposures relative to the first one's ISO and f-number

    Raises
    ------
    ValueError
        Naming the file, the line, and what was expected there.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "times.txt"
    >>> _ = file.write_text("night.png 1/2 s")
    >>> read_times(file)
    TimeList(seconds={'night.png': 0.5}, inverse=None)
    """
    require_no_folder(path, "a list of exposure times")
    try:
        text = Path(path).read_text("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(
            f"{path}: expected a list of exposure times, this is not a text file"
        ) from None
    lines = text.splitlines()
    if (longest := max(map(len, lines), default=0)) > LONGEST_LINE:
        raise InputError(
            f"{path}: expected lines with a file and its time, got one of {longest} letters"
        )
    numbered = [(n, _split(line.partition("#")[0])) for n, line in enumerate(lines, 1)]
    rows = [(f"{path}, line {n}", cells) for n, cells in numbered if cells]
    heading = _heading(rows[0][1]) if rows else None
    read, certain = dict[str, Exposure](), False
    for where, cells in rows[bool(heading) :]:
        cell = _named_cells(where, heading, cells)
        if cell["file"] in read:
            raise InputError(f"{where}: expected each file once, got {cell['file']:.80} again")
        number = {
            what: _number(where, cell[what]) for what in list(HEADINGS)[:-1] if cell.get(what)
        }
        certain |= "rate" not in number or not cell["rate"][-1:].isdigit() or "/" in cell["rate"]
        seconds = (
            number.get("seconds")
            or number.get("rate")
            or 1 / _number(where, cell.get("inverse", ""))
        )
        read[cell["file"]] = Exposure(seconds, number.get("f_number"), number.get("iso"))
    if not read:
        raise InputError(f"{path}: expected a list of exposure times, it is empty")
    each = list(read.values())
    given, inverted = (
        dict(zip(read, equivalent([f"{path}: {name}" for name in read], one), strict=True))
        for one in (each, [one._replace(seconds=1 / one.seconds) for one in each if one.seconds])
    )
    return TimeList(given, None if certain else inverted)


def _look_up(times: Mapping[str, float], names: Sequence[str], where: str) -> list[float]:
    """Return the time of each name; the list may leave out folders and suffixes, and differ in case."""
    known = {Path(name).stem.lower(): t for name, t in times.items()}
    known |= {Path(name).name.lower(): t for name, t in times.items()}
    found = [
        times.get(name, known.get(name.lower(), known.get(Path(name).stem.lower())))
        for name in names
    ]
    if missing := [name for name, t in zip(names, found, strict=True) if t is None]:
        raise InputError(
            f"{where}: expected a time for each photograph, none for {', '.join(missing)}"
        )
    return [t for t in found if t is not None]


def _split(line: str) -> list[str]:
    """Return the cells of a line; those of `a b.png 1 / 60 s` are a b.png and 1/60s."""
    line = re.sub(r"(?<=\d)\s*/\s*(?=\d)", "/", line.strip())
    line = re.sub(r"(?<=[\d.])\s*(?:s|sec|seconds?|\")(?=$|[\s,;])", "s", line, flags=re.IGNORECASE)
    for separator in "\t;,":
        if separator in line:
            row = next(csv.reader([line], delimiter=separator, skipinitialspace=True))
            return [cell.strip() for cell in row]
    words = line.split()
    count = next((j for j in range(len(words), 1, -1) if not VALUE.fullmatch(words[j - 1])), 1)
    return [" ".join(words[:count]), *words[count:]] if count < len(words) else words


def _heading(cells: list[str]) -> list[str] | None:
    """Return what each column holds, where these cells head a table of times."""
    found = [
        next((key for key, how in HEADINGS.items() if re.search(how, one.lower())), "")
        for one in cells
    ]
    timed = {"seconds", "rate", "inverse"} & set(found) and not any(map(VALUE.fullmatch, cells))
    return found if "file" in found and timed else None


def _named_cells(where: str, heading: list[str] | None, cells: list[str]) -> dict[str, str]:
    """Return the cells of a line by what they hold; of three, the last is found by its size."""
    columns = heading or COLUMNS.get(str(len(cells)), COLUMNS["3"])
    if len(columns) != len(cells):
        what = f"{len(heading)} columns" if heading else "a file name and its time, such as 1/60"
        raise InputError(f"{where}: expected {what}, got {' '.join(cells):.80}")
    cell = dict(zip(columns, cells, strict=True))
    if cell.get("gain", "0").strip("0.") or cell.get("filters", "0").strip("0."):
        raise InputError(
            f"{where}: expected neither gain nor ND filters (0 0), got {' '.join(cells):.80}"
        )
    if not heading and len(cells) == 3:
        t, other = (_number(where, one) for one in cells[1:])
        if abs(t * other - 1) < 0.05:  # the beginning of Debevec's list: a time and its inverse
            return {"file": cells[0], "seconds": cells[1]}
        return {
            "file": cells[0],
            "rate": cells[1],
            "iso" if other >= LEAST_ISO else "f_number": cells[2],
        }
    return cell


def _number(where: str, text: str) -> float:
    """Return the positive number that a cell holds: 0.5, 0,5, 1/60 or one of them with its unit."""
    found = VALUE.fullmatch(text)
    parts = (found[1], found[2] or "1") if found else ("", "1")
    value, below = (positive(one.replace(",", ".")) for one in parts)
    if value is None or below is None:
        got = text[:80] or "nothing"
        raise InputError(f"{where}: expected a positive number such as 0.5 or 1/60, got {got}")
    return value / below
