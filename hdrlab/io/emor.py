"""Files of measured camera responses, such as the 201 of DoRF (Grossberg and Nayar 2003)."""

import zipfile
from pathlib import Path

import numpy as np

from hdrlab.core.types import F64

# bytes: three channels of 65536 levels take 10 million
MAX_FILE_BYTES = 32 << 20


def read_curves(path: str | Path) -> tuple[F64, F64]:
    """Read measured response curves from an NPZ file: `irradiance` and `brightness`, (C, n) each.

    Raises
    ------
    ValueError
        For a file that is none, or arrays that do not go together.
    """
    names = ("irradiance", "brightness")
    try:
        with zipfile.ZipFile(path) as archive:
            claimed = sum(archive.getinfo(f"{name}.npy").file_size for name in names)
        if claimed > MAX_FILE_BYTES:
            raise ValueError(f"which claims {claimed} bytes, more than {MAX_FILE_BYTES}")
        with np.load(path, allow_pickle=False) as file:
            E, M = (np.asarray(file[name]).astype(np.float64) for name in names)
    except FileNotFoundError:
        raise
    except Exception as error:  # a damaged zip, a missing name, objects instead of numbers
        said = f"expected an NPZ archive with {' and '.join(names)}, {error!s:.200}"
        raise ValueError(f"{path}: {said}") from error
    if E.ndim != 2 or E.shape != M.shape or not (np.isfinite(E).all() and np.isfinite(M).all()):
        raise ValueError(f"{path}: expected curves (C, n) twice, got shapes {E.shape} and {M.shape}")
    return E, M
