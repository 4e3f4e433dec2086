"""TIFF files of floating-point samples, .tif and .tiff, through tifffile.

16, 32 or 64 bits, gray or RGB; an alpha channel is left out. A TIFF of whole numbers holds the levels of a
photograph, and is read by `io.photos`.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from hdrlab.core.arrays import as_radiance
from hdrlab.core.optional import tifffile
from hdrlab.core.types import F32, ArrayLike
from hdrlab.io import codecs, decode
from hdrlab.io.files import check_size, replacing

KINDS = {1: "MINISBLACK", 3: "RGB"}  # channels without alpha, and what TIFF calls them


def read_header(path: str | Path) -> decode.TiffPage:
    """Return what the first page says, or raise a ValueError where it holds no radiance."""
    page = decode.tiff_page(path)
    if page.dtype.kind != "f" or KINDS.get(page.channels - page.alpha) != page.kind or page.depth != 1:
        found = f"{page.channels} x {page.dtype}, {page.kind}"
        raise ValueError(f"{path}: expected gray or RGB of floating-point samples, got {found}")
    size = page.height * page.width * page.channels * page.dtype.itemsize
    check_size(path, page.height, page.width, size // decode.BEST_COMPRESSION_RATIO)
    return page


def read(path: str | Path) -> F32:
    """Read a TIFF file of floating-point samples.

    Parameters
    ----------
    path : the file

    Returns
    -------
    (H, W, 3) or (H, W) float32

    Raises
    ------
    ValueError
        For a file that is not one, is damaged, or holds whole numbers.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "light.tif"
    >>> write(file, [[0.25, 1e6]])
    >>> read(file).tolist()
    [[0.25, 1000000.0]]
    """
    page, pixels = read_header(path), codecs.stored_pixels(Path(path), "TIFF")
    shape = (page.height, page.width, page.channels)
    if pixels.size != np.prod(shape):
        raise ValueError(f"{path}: it is damaged: expected {shape} samples, got {pixels.shape}")
    with np.errstate(over="ignore"):  # what is too large for 32 bits becomes infinite, and is told as such
        E = pixels.reshape(shape).astype(np.float32)
    return E[..., :3].copy() if page.kind == "RGB" else E[..., 0].copy()


def write(path: str | Path, E: ArrayLike, *, comments: Sequence[str] = ()) -> None:
    """Write radiance as a TIFF file of 32-bit floats, whole or not at all.

    Parameters
    ----------
    path : the file; what it held is replaced
    E : (H, W) or (H, W, 3) radiance, finite and not negative
    comments : sentences for its image description

    Raises
    ------
    ValueError
        For NaN, infinite or negative values.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "light.tif"
    >>> write(file, np.full((2, 3, 3), 0.5), comments=["unit: cd/m2"])
    >>> read(file).shape, read_header(file).description
    ((2, 3, 3), 'unit: cd/m2')
    """
    E, text = as_radiance(E), "\n".join(comments).encode()
    with replacing(path) as name:
        kind = KINDS[E.shape[2] if E.ndim == 3 else 1].lower()
        tifffile.imwrite(name, E, photometric=kind, metadata=None, description=text or None)
