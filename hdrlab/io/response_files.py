"""Response curves by their suffix: tables of our own, and the files of pfstools.

g  response  (n,) or (n, 3), ln exposure of each pixel level, g[n // 2] = 0
f  f^-1      exp g, the exposure of each level, in any unit

.csv  a line per level: the level, then g of red, green and blue, or of gray; the header says so
.m    pfstools, see `pfscurves`

The first keeps every bit, the second 10 digits.
"""

from pathlib import Path

import numpy as np

from hdrlab.core.arrays import F64, LARGEST_LN_EXPOSURE, ArrayLike, describe
from hdrlab.io import pfscurves
from hdrlab.io.files import replacing, require_suffix

# three channels of 65536 levels take 10 million
MAX_FILE_BYTES = 32 << 20
CHANNELS = {1: ("gray",), 3: ("red", "green", "blue")}
UNIT = " (ln exposure)"


def write_curve(path: str | Path, g: ArrayLike) -> None:
    """Write a response in the format that the file's suffix names, whole or not at all.

    Parameters
    ----------
    path : a .csv or .m file; what it held is replaced
    g : (n,) or (n, 3) float, n = 256 or 65536, ln exposure of each level

    Raises
    ------
    ValueError
        For another suffix, and for what is no response: not finite, or of another shape.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "gamma.csv"
    >>> write_curve(path, 2.2 * np.log(np.maximum(np.arange(256), 1) / 128))
    >>> read_curve(path)[[64, 128]].round(3)
    array([-1.525,  0.   ])
    """
    write, _ = FORMS[suffix_of(path)]
    g = as_curve(g)
    with replacing(path) as temporary:
        write(temporary, g)


def read_curve(path: str | Path) -> F64:
    """Read a response, in the format that the file's suffix names.

    Parameters
    ----------
    path : a .csv or .m file

    Returns
    -------
    (n,) or (n, 3) float64
        g, ln exposure of each level, 0 at level n // 2 in every channel: pfstools leaves the channels in
        other proportions. Levels of no exposure, where it found nothing, are filled from their neighbours.

    Raises
    ------
    ValueError
        For another suffix, and for a file that is damaged, cut short or not of its format.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "linear.m"
    >>> write_curve(path, np.log(np.arange(1, 257) / 129))
    >>> read_curve(path)[[0, 128, 255]].round(3)
    array([-4.86 ,  0.   ,  0.685])
    """
    _, read = FORMS[suffix_of(path)]
    size = Path(path).stat().st_size
    if size > MAX_FILE_BYTES:
        raise ValueError(f"{path}: expected a response of at most {MAX_FILE_BYTES} bytes, got {size}")
    try:
        g = as_curve(read(Path(path)))
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    return g - g[len(g) // 2]


def suffix_of(path: str | Path) -> str:
    """Return the suffix that names a file's format, or raise a ValueError."""
    return require_suffix(path, FORMS, "a response curve")


def as_curve(g: ArrayLike) -> F64:
    """Return g as float64 (n,) or (n, 3), n = 256 or 65536, within float32, or raise a ValueError."""
    curve = np.asarray(g)
    if curve.dtype.kind not in "iuf" or curve.ndim not in (1, 2) or curve.shape[1:] not in ((), (3,)):
        raise ValueError(f"expected a response (n,) or (n, 3), got {describe(curve)}")
    if len(curve) not in (256, 65536):
        raise ValueError(f"expected 256 or 65536 levels, got {len(curve)}: is it cut short?")
    if not np.all(np.abs(curve) <= LARGEST_LN_EXPOSURE):  # NaN neither
        limits = f"-{LARGEST_LN_EXPOSURE} to {LARGEST_LN_EXPOSURE}"
        raise ValueError(f"expected ln exposures from {limits}, got {describe(curve)}")
    return curve.astype(np.float64)


def _write_csv(path: Path, g: F64) -> None:
    columns = g.reshape(len(g), -1)
    header = ",".join(["level", *(name + UNIT for name in CHANNELS[columns.shape[1]])])
    lines = [",".join([str(z), *map(repr, row)]) for z, row in enumerate(columns.tolist())]
    path.write_text("\n".join([header, *lines, ""]), encoding="ascii")


def _read_csv(path: Path) -> F64:
    header, _, body = path.read_text(encoding="latin-1").partition("\n")
    names = [name.strip().removesuffix(UNIT) for name in header.split(",")]
    if tuple(names[1:]) not in CHANNELS.values() or names[0] != "level" or UNIT not in header:
        raise ValueError(f"expected the columns level, red, green and blue{UNIT}, got {header[:80]!r}")
    table = pfscurves.numbers(body, len(names), ",")
    if not np.array_equal(table[:, 0], np.arange(len(table))):
        raise ValueError(f"expected the levels from 0 on, one a line, got {table[:4, 0].tolist()} ...")
    return pfscurves.squeeze_gray(table[:, 1:])


# how each is written and read, by its suffix
FORMS = {".csv": (_write_csv, _read_csv), ".m": (pfscurves.write_pfstools, pfscurves.read_pfstools)}
