"""Lists of exposure times, and the times of a bracket: given ones come before those of EXIF."""

import csv
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.errors import FileFormatError, InputError
from hdrlab.io.exif_exposure import HINT, Exposure, equivalent_seconds, positive
from hdrlab.io.files import require_no_folder

Times = Sequence[float] | NDArray[np.floating] | Mapping[str, float] | str | Path

# A number (0.5 or 0,5), a fraction (1/60), each with or without the unit "s".
VALUE = re.compile(r"([\d.,]+(?:e[-+]?\d+)?)(?:/([\d.]+))?(s?)", re.IGNORECASE)
# A file name that is an exposure time: 1_250, 1-250s, 0.004s, 2 sec.
TIME_NAME = re.compile(r"(?:1[-_](\d+)\s*(?:s|sec)?|(\d+(?:[.,]\d+)?)\s*(?:s|sec))", re.IGNORECASE)
# Exposures of a bracket differ by a third of a stop or more.
MIN_EXPOSURE_RATIO = 1.25
# What a column holds, by its heading; the first pattern that fits decides. A "rate" is a number
# such as 60, which may mean 60 s or 1/60 s.
HEADINGS = {
    "inverse": r"^1\s*/|inverse",
    "iso": r"iso",
    "rate": r"speed",
    "seconds": r"time|second|exposure|shutter|^t$|^s$",
    "f_number": r"^f\b|f[-_ /]?(number|stop)|aperture",
    "file": r"file|name|image|photo|picture",
}
NUMBER_COLUMNS = ("inverse", "iso", "rate", "seconds", "f_number")
# What the columns hold if there is no heading, by their number. Six are Debevec's list.
COLUMNS = {
    2: ["file", "rate"],
    3: ["file", "rate", "f_number"],
    4: ["file", "rate", "f_number", "iso"],
    6: ["file", "", "inverse", "f_number", "gain", "filters"],
}
# The lowest ISO speed, which is above any f-number.
MIN_ISO = 50
# A weaker correlation between brightness and times does not tell seconds from 1/seconds.
MIN_CORRELATION = 0.5
# A time and its inverse, beside each other, multiply to 1 within this tolerance.
INVERSE_TOLERANCE = 0.05
MAX_LINE_LENGTH = 10_000


class TimeList(NamedTuple):
    """Equivalent exposures in seconds, by file name.

    `inverse` holds the exposures if the list's numbers are 1/seconds. It is None if the list says
    which they are.
    """

    seconds: dict[str, float]
    inverse: dict[str, float] | None = None


def bracket_times(
    names: Sequence[str], exposures: Sequence[Exposure], times: Times | None
) -> tuple[list[float], list[float] | None]:
    """Return the equivalent exposure of each photo: as given, else as its EXIF states.

    Parameters
    ----------
    names
        The file names of the photos.
    exposures
        What the EXIF of each photo states.
    times
        Times in the order of the photos or by name, the path of a list, or None for EXIF.

    Returns
    -------
    seconds
        The equivalent exposures.
    inverse
        The equivalent exposures if the list's numbers are 1/seconds; None unless that is open.

    Raises
    ------
    InputError
        Naming the photo whose time is missing or not positive.
    """
    if times is None:
        return equivalent_seconds(names, exposures), None
    source = "the given times"
    inverse = None
    if isinstance(times, str | Path):
        source = str(times)
        bare = read_bare_numbers(times)
        if bare is None:
            times, inverse = read_times(times)
        else:
            if len(bare) != len(names):
                raise InputError(
                    f"{source}: expected {len(names)} exposure times, one per photo, got {len(bare)}"
                )
            lines = "\n".join(f"{j} {number}" for j, number in enumerate(bare))
            times, inverse = _parse_times(source, _split_rows(source, lines))
            times = {name: times[str(j)] for j, name in enumerate(names)}
            if inverse is not None:
                inverse = {name: inverse[str(j)] for j, name in enumerate(names)}
    if isinstance(times, Mapping):
        times = _look_up_times(times, names, source)
    if len(times) != len(names):
        raise InputError(
            f"expected {len(names)} exposure times, one per photograph, got {len(times)}"
        )
    for name, seconds in zip(names, times, strict=True):
        if not 0 < seconds < np.inf:
            raise InputError(
                f"{name}: expected a positive exposure time in seconds, got {seconds}; {HINT}"
            )
    listed = [float(seconds) for seconds in times]
    if inverse is None:
        return listed, None
    inverted = _look_up_times(inverse, names, source)
    if any(exposure.seconds is None for exposure in exposures):
        return listed, inverted
    if are_inverse(listed, equivalent_seconds(names, exposures), source):
        return inverted, None
    return listed, None


def times_in_names(names: Sequence[str]) -> list[float] | None:
    """Return the exposure times that file names such as 1_250.jpg or 0.004s.jpg are, or None.

    All names must be times, and no two of them may be close to each other, as the numbers of photos
    are.

    Examples
    --------
    >>> times_in_names(["1_2.jpg", "1_8.jpg"]), times_in_names(["IMG_1.jpg", "IMG_2.jpg"])
    ([0.5, 0.125], None)
    """
    seconds = []
    for name in names:
        match = TIME_NAME.fullmatch(Path(name).stem)
        if not match:
            return None
        denominator = positive(match[1])
        time = positive((match[2] or "").replace(",", "."))
        if denominator is not None:
            time = 1 / denominator
        if time is None:
            return None
        seconds.append(time)
    ascending = np.sort(seconds)
    is_spaced = np.all(ascending[1:] >= MIN_EXPOSURE_RATIO * ascending[:-1])
    # 1_1, 1_2, 1_3 number the photos of a first series.
    is_numbered = len(seconds) > 2 and np.allclose(np.diff(1 / ascending), -1)
    return seconds if is_spaced and not is_numbered else None


def read_bare_numbers(path: str | Path) -> list[str] | None:
    """Return the numbers of a list that has one number or fraction a line and no file names, or None.

    Raises
    ------
    FileFormatError
        If the file is no text.
    """
    rows = _read_rows(path)
    numbers = [cells[0] for _, cells in rows if len(cells) == 1 and VALUE.fullmatch(cells[0])]
    return numbers if rows and len(numbers) == len(rows) else None


def are_inverse(
    seconds: Sequence[float], brightness: ArrayLike, where: str = "the list of times"
) -> bool:
    """Return whether numbers are 1/seconds, because the photos get darker as the numbers rise.

    Raises
    ------
    InputError
        If the brightness of the photos neither rises nor falls with the numbers.

    Examples
    --------
    >>> are_inverse([60, 30, 15], [20, 40, 80])
    True
    """
    if np.ptp(seconds) == 0 or np.ptp(brightness) == 0:
        return False
    correlation = float(np.corrcoef(_ranks(seconds), _ranks(brightness))[0, 1])
    if abs(correlation) < MIN_CORRELATION:
        raise InputError(
            f"{where}: the numbers neither rise nor fall with the photos' brightness, so they may be "
            "seconds or 1/seconds; write them as 1/60 or as 0.5 s"
        )
    return correlation < 0


def _ranks(values: ArrayLike) -> NDArray[np.intp]:
    return np.argsort(np.argsort(values))


def read_times(path: str | Path) -> TimeList:
    """Read a list of exposure times that comes with a bracket.

    Each line names a photo and its time, with a comma, a semicolon, a tab or a space between them.
    A time is 1/60, 1/60 s, 0.0166, or 60, which may mean 60 s or 1/60 s. There may be a heading
    (file, exposure_time_s or 1/seconds, f_number, iso), or the f-number and the ISO speed behind
    the time. Debevec's list (name, exposure, 1/seconds, f-stop, gain in dB, ND filters) is read,
    too. A # begins a comment.

    Parameters
    ----------
    path : str or Path
        A text file.

    Returns
    -------
    TimeList
        Exposures relative to the ISO speed and f-number of the first photo.

    Raises
    ------
    FileFormatError
        Naming the file, the line, and what was expected there.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "times.txt"
    >>> _ = file.write_text("night.png 1/2 s")
    >>> read_times(file)
    TimeList(seconds={'night.png': 0.5}, inverse=None)
    """
    return _parse_times(path, _read_rows(path))


def _parse_times(path: str | Path, rows: list[tuple[str, list[str]]]) -> TimeList:
    """Return the times in the rows of a list."""
    heading = _read_heading(rows[0][1]) if rows else None
    if heading:
        rows = rows[1:]
    exposures: dict[str, Exposure] = {}
    has_explicit_unit = False
    for where, cells in rows:
        columns = _name_cells(where, heading, cells)
        name = columns["file"]
        if name in exposures:
            raise FileFormatError(f"{where}: {name:.80} is listed twice")
        numbers = {}
        for column in NUMBER_COLUMNS:
            if columns.get(column):
                numbers[column] = parse_number(where, columns[column])
        seconds = numbers.get("seconds") or numbers.get("rate")
        if seconds is None:
            seconds = 1 / parse_number(where, columns.get("inverse", ""))
        exposures[name] = Exposure(seconds, numbers.get("f_number"), numbers.get("iso"))
        if "rate" not in numbers or _is_fraction_or_has_unit(columns["rate"]):
            has_explicit_unit = True
    if not exposures:
        raise FileFormatError(f"{path}: the list of exposure times is empty")
    listed = _equivalent_by_name(path, exposures)
    if has_explicit_unit:
        return TimeList(listed)
    inverted = {}
    for name, exposure in exposures.items():
        if exposure.seconds is not None:
            inverted[name] = exposure._replace(seconds=1 / exposure.seconds)
    return TimeList(listed, inverse=_equivalent_by_name(path, inverted))


def _equivalent_by_name(path: str | Path, exposures: dict[str, Exposure]) -> dict[str, float]:
    names_in_errors = [f"{path}: {name}" for name in exposures]
    seconds = equivalent_seconds(names_in_errors, list(exposures.values()))
    return dict(zip(exposures, seconds, strict=True))


def _is_fraction_or_has_unit(text: str) -> bool:
    """Return whether a time says itself that it is in seconds, as 1/60 and 0.5s do."""
    return "/" in text or not text[-1:].isdigit()


def _read_rows(path: str | Path) -> list[tuple[str, list[str]]]:
    """Return the cells of each line that is not empty, with the file and line for errors."""
    require_no_folder(path, "a list of exposure times")
    try:
        text = Path(path).read_text("utf-8-sig")
    except UnicodeDecodeError:
        raise FileFormatError(f"{path}: a list of exposure times must be a text file") from None
    return _split_rows(path, text)


def _split_rows(path: str | Path, text: str) -> list[tuple[str, list[str]]]:
    """Return the place and the cells of each line that has some."""
    rows = []
    for number, line in enumerate(text.splitlines(), 1):
        if len(line) > MAX_LINE_LENGTH:
            raise FileFormatError(
                f"{path}, line {number}: expected a file and its time, got {len(line)} characters"
            )
        cells = _split_line(line.partition("#")[0])
        if cells:
            rows.append((f"{path}, line {number}", cells))
    return rows


def _split_line(line: str) -> list[str]:
    """Return the cells of a line; those of `a b.png 1 / 60 s` are `a b.png` and `1/60s`."""
    line = re.sub(r"(?<=\d)\s*/\s*(?=\d)", "/", line.strip())
    line = re.sub(r"(?<=[\d.])\s*(?:s|sec|seconds?|\")(?=$|[\s,;])", "s", line, flags=re.IGNORECASE)
    for separator in "\t;,":
        if separator in line:
            row = next(csv.reader([line], delimiter=separator, skipinitialspace=True))
            return [cell.strip() for cell in row]
    words = line.split()
    # The numbers at the end are cells; the words before them are the name, which has one at least.
    name_length = len(words)
    while name_length > 1 and VALUE.fullmatch(words[name_length - 1]):
        name_length -= 1
    if name_length == len(words):
        return words
    return [" ".join(words[:name_length]), *words[name_length:]]


def _read_heading(cells: list[str]) -> list[str] | None:
    """Return what each column holds if these cells are the heading of a list, else None."""
    columns = [_column_of_heading(cell.lower()) for cell in cells]
    has_times = not {"seconds", "rate", "inverse"}.isdisjoint(columns)
    has_numbers = any(VALUE.fullmatch(cell) for cell in cells)
    is_heading = "file" in columns and has_times and not has_numbers
    return columns if is_heading else None


def _column_of_heading(cell: str) -> str:
    for column, pattern in HEADINGS.items():
        if re.search(pattern, cell):
            return column
    return ""


def _name_cells(where: str, heading: list[str] | None, cells: list[str]) -> dict[str, str]:
    """Return the cells of a line by what they hold; the size of a third one tells what it is."""
    columns = heading or COLUMNS.get(len(cells))
    if columns is None or len(columns) != len(cells):
        expected = "a file name and its time, such as 1/60"
        if heading:
            expected = f"{len(heading)} columns"
        raise FileFormatError(f"{where}: expected {expected}, got {' '.join(cells):.80}")
    named = dict(zip(columns, cells, strict=True))
    for column in ("gain", "filters"):
        if named.get(column, "0").strip("0."):
            raise FileFormatError(
                f"{where}: expected neither gain nor ND filters (0 0), got {' '.join(cells):.80}"
            )
    if heading or len(cells) != 3:
        return named
    name, time, third = cells
    time_value = parse_number(where, time)
    third_value = parse_number(where, third)
    if abs(time_value * third_value - 1) < INVERSE_TOLERANCE:
        return {"file": name, "seconds": time}
    third_column = "iso" if third_value >= MIN_ISO else "f_number"
    return {"file": name, "rate": time, third_column: third}


def parse_number(where: str, text: str) -> float:
    """Return a positive number that is written as 0.5, 0,5 or 1/60, with or without its unit "s".

    `where` is what the error message names: the file and its line, or the photo.

    Raises
    ------
    FileFormatError
        If the text is no such number.

    Examples
    --------
    >>> parse_number("a.jpg", "1/4s"), parse_number("a.jpg", "0,5")
    (0.25, 0.5)
    """
    match = VALUE.fullmatch(text)
    if match:
        numerator = positive(match[1].replace(",", "."))
        denominator = positive((match[2] or "1").replace(",", "."))
        if numerator is not None and denominator is not None:
            return numerator / denominator
    number = text[:80] or "nothing"
    raise FileFormatError(f"{where}: expected a positive number such as 0.5 or 1/60, got {number}")


def _look_up_times(times: Mapping[str, float], names: Sequence[str], source: str) -> list[float]:
    """Return the time of each name; a list may leave out folders and suffixes, and ignore case."""
    by_stem = {Path(name).stem.lower(): seconds for name, seconds in times.items()}
    by_name = {Path(name).name.lower(): seconds for name, seconds in times.items()}
    known = by_stem | by_name
    seconds = []
    missing = []
    for name in names:
        fallback = known.get(name.lower(), known.get(Path(name).stem.lower()))
        value = times.get(name, fallback)
        if value is None:
            missing.append(name)
        else:
            seconds.append(value)
    if missing:
        raise InputError(f"{source}: no exposure time for {', '.join(missing)}")
    return seconds
