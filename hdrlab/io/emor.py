"""Files of measured camera responses, such as the 201 of DoRF (Grossberg and Nayar 2003)."""

from pathlib import Path

import numpy as np

from hdrlab.core.types import F64


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
