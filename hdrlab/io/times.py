"""Lists of exposure times, and which times a bracket takes: those given explicitly before those of EXIF."""

import csv
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hdrlab.io.exif_exposure import HINT, Exposure, equivalent, positive

Times = Sequence[float] | NDArray[np.floating] | Mapping[str, float] | str | Path


def bracket_times(names: Sequence[str], exposures: Sequence[Exposure], times: Times | None) -> list[float]:
    """Return the equivalent exposure of each photograph: what was given, else what its EXIF says.

    Raises
    ------
    ValueError
        Naming the photograph whose time is missing or not positive.
    """
    if times is None:
        return equivalent(names, exposures)
    where = "the times given"
    if isinstance(times, str | Path):
        where, times = str(times), read_times(times)
    if isinstance(times, Mapping):
        if missing := [name for name in names if name not in times]:
            raise ValueError(f"{where}: expected a time for each photograph, none for {', '.join(missing)}")
        times = [times[name] for name in names]
    if len(times) != len(names):
        raise ValueError(f"expected {len(names)} exposure times, one per photograph, got {len(times)}")
    for name, t in zip(names, times, strict=True):
        if not 0 < t < np.inf:
            raise ValueError(f"{name}: expected a positive exposure time in seconds, got {t}; {HINT}")
    return [float(t) for t in times]


def read_times(path: str | Path) -> dict[str, float]:
    """Read a list of exposure times that comes with a bracket.

    Parameters
    ----------
    path : a text file of one of three kinds, in which # begins a comment:
        a CSV file whose header names `file` and `exposure_time_s`, and if known `f_number` and `iso`;
        `name 1/seconds`, two columns, as in many course archives: the second is 1 for 1 s, 1000 for 1 ms;
        Debevec's list: name, exposure, 1/seconds, f-stop, gain in dB, ND filters.

    Returns
    -------
    equivalent exposure in seconds of each file name, relative to the first one's ISO and f-number.

    Raises
    ------
    ValueError
        Naming the file, the line, and what was expected there.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "times.txt"
    >>> _ = file.write_text("night.png 0.5")
    >>> read_times(file)
    {'night.png': 2.0}
    """
    try:
        text = Path(path).read_text("utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError(f"{path}: expected a list of exposure times, this is not a text file") from None
    numbered = [(n, line.partition("#")[0].strip()) for n, line in enumerate(text.splitlines(), 1)]
    lines = [(n, line) for n, line in numbered if line]
    if not lines:
        raise ValueError(f"{path}: expected a list of exposure times, it is empty")
    table = "exposure_time_s" in lines[0][1]
    rows = _table(path, lines) if table else [_columns(path, *line) for line in lines]
    names = [name for _, name, _ in rows]
    for n, name, _ in rows:
        if names.count(name) > 1:
            raise ValueError(f"{path}, line {n}: expected each file once, got {name} again")
    exposures = [exposure for _, _, exposure in rows]
    return dict(zip(names, equivalent([f"{path}: {name}" for name in names], exposures), strict=True))


def _table(path: str | Path, lines: list[tuple[int, str]]) -> list[tuple[int, str, Exposure]]:
    """Return line number, name and Exposure of each row of a CSV list."""
    header, *cells = csv.reader(line for _, line in lines)
    header = [column.strip() for column in header]
    if not {"file", "exposure_time_s"} <= set(header):
        where = f"{path}, line {lines[0][0]}"
        raise ValueError(f"{where}: expected the columns file and exposure_time_s, got {header}")
    rows = []
    for (n, line), row in zip(lines[1:], cells, strict=False):
        if len(row) != len(header):
            raise ValueError(f"{path}, line {n}: expected {len(header)} columns, got {len(row)} ({line})")
        cell = dict(zip(header, map(str.strip, row), strict=True))
        seconds = _number(path, n, cell["exposure_time_s"])
        f_number, iso = (
            _number(path, n, cell[key]) if cell.get(key) else None for key in ("f_number", "iso")
        )
        rows.append((n, cell["file"], Exposure(seconds, f_number, iso)))
    return rows


def _columns(path: str | Path, n: int, line: str) -> tuple[int, str, Exposure]:
    """Return line number, name and Exposure of a line of one of the lists in columns."""
    parts = line.rsplit(maxsplit=5)
    if len(parts) == 6 and all(positive(part) is not None or part.strip("0.") == "" for part in parts[1:]):
        name, _, inverse, stop, gain, filters = parts
        if gain.strip("0.") or filters.strip("0."):
            raise ValueError(f"{path}, line {n}: expected neither gain nor ND filters (0 0), got {line}")
        return n, name, Exposure(1 / _number(path, n, inverse), _number(path, n, stop))
    name, *rest = line.rsplit(maxsplit=1)
    if not rest:
        raise ValueError(f"{path}, line {n}: expected a file name and 1/seconds, got {line}")
    return n, name, Exposure(1 / _number(path, n, rest[0]))


def _number(path: str | Path, n: int, text: str) -> float:
    value = positive(text)
    if value is None:
        raise ValueError(f"{path}, line {n}: expected a positive number, got {text or 'nothing'}")
    return value
