"""Files of measured camera responses: EMoR's components, and collections of curves.

axis        (n,)       exposure 0 to 1 in `emor.txt`, brightness in `invemor.txt`
mean        (n,)       of the curves over that axis
components  (K, n)     the directions along which they spread, orthonormal

A text file has blocks, `name =` and then numbers, four a line, exponents with three digits. The first block
is the axis, the second the mean, and the others are the components in order.
"""

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from hdrlab.core.types import F64

# bytes: far beyond any such file
MAX_FILE_BYTES = 64 << 20


class Emor(NamedTuple):
    """axis (n,), mean (n,) and components (K, n)."""

    axis: F64
    mean: F64
    components: F64


def read_emor(path: str | Path) -> Emor:
    """Read the empirical model of response, `emor.txt` or `invemor.txt`.

    Parameters
    ----------
    path : path

    Returns
    -------
    Emor

    Raises
    ------
    ValueError
        For a file of another kind, or blocks of different length.

    References
    ----------
    Grossberg and Nayar, Modeling the space of camera response functions, PAMI 2004.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "emor.txt"
    >>> _ = path.write_text("E =\\n 0.0e+000 1.0e+000\\nf0 =\\n0 1\\nh(1)=\\n 1.0e+000 -5.0e-001\\n")
    >>> read_emor(path).components
    array([[ 1. , -0.5]])
    """
    if (size := Path(path).stat().st_size) > MAX_FILE_BYTES:
        raise ValueError(f"{path}: expected a file of response curves, this one has {size} bytes")
    text = Path(path).read_text(encoding="latin-1")
    parts = re.split(r"^\s*([A-Za-z]\w*(?:\(\d+\))?)\s*=", text, flags=re.MULTILINE)
    try:
        blocks = [np.array(numbers.split(), np.float64) for numbers in parts[2::2]]
    except ValueError as error:
        raise ValueError(f"{path}: expected blocks of numbers, {error}") from error
    sizes = {len(block) for block in blocks}
    if parts[0].strip() or len(blocks) < 3 or len(sizes) != 1 or min(sizes) < 2:
        got = f"{len(blocks)} blocks of {sorted(sizes)} numbers"
        raise ValueError(f"{path}: expected an axis, a mean and components of one length, got {got}")
    if not all(np.isfinite(block).all() for block in blocks) or np.any(np.diff(blocks[0]) <= 0):
        raise ValueError(f"{path}: expected finite numbers and an axis that rises")
    return Emor(blocks[0], blocks[1], np.stack(blocks[2:]))


def read_curves(path: str | Path) -> tuple[F64, F64]:
    """Read measured response curves from an NPZ file: `irradiance` and `brightness`, (C, n) each.

    Raises
    ------
    ValueError
        For a file that is none, or arrays that do not go together.
    """
    try:
        with np.load(path, allow_pickle=False) as file:
            E, M = (np.asarray(file[name], np.float64) for name in ("irradiance", "brightness"))
    except FileNotFoundError:
        raise
    except Exception as error:  # a damaged zip, a missing name, objects instead of numbers
        raise ValueError(f"{path}: expected an NPZ file with irradiance and brightness, {error}") from error
    if E.ndim != 2 or E.shape != M.shape or not (np.isfinite(E).all() and np.isfinite(M).all()):
        raise ValueError(f"{path}: expected curves (C, n) twice, got shapes {E.shape} and {M.shape}")
    return E, M
