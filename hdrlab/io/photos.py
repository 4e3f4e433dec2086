"""Photographs in, as arrays, and pictures out.

A bracket's headers are read first: they say whether the frames go together and in which order. Then
each is decoded once, straight into its place, several at a time.
"""

import warnings
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from hdrlab.core.arrays import Array, ArrayLike, as_picture
from hdrlab.core.bracket import Bracket, bracket
from hdrlab.core.optional import imagecodecs
from hdrlab.core.threads import map_in_threads
from hdrlab.errors import InputError
from hdrlab.io import album, files, raw
from hdrlab.io.decode import PhotoHeader, decode_photo, read_header
from hdrlab.io.times import Times, are_inverse, bracket_times

PICTURES: dict[str, dict[str, Any]] = {".png": {"compress_level": 1}}
PICTURES |= dict.fromkeys((".jpg", ".jpeg"), {"quality": 95, "subsampling": 0})
PICTURES |= dict.fromkeys((".tif", ".tiff"), {"compression": "tiff_deflate"})


def read_photo(path: str | Path) -> Array:
    """Read one photograph, upright.

    Parameters
    ----------
    path : a JPEG, PNG, TIFF, WebP, AVIF, HEIC or JPEG XL file, gray or RGB, of 8 to 16 bits, or a
        RAW file;
        colours of another space than sRGB are converted by the file's profile

    Returns
    -------
    (H, W) or (H, W, 3), uint8 or uint16

    Raises
    ------
    ValueError
        For a file that is none of these, or is damaged.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "wall.png"
    >>> write_picture(path, np.full((2, 3), 128, np.uint8))
    >>> read_photo(path).tolist()
    [[128, 128, 128], [128, 128, 128]]
    """
    header = read_header(path)
    image = np.empty(header.shape, header.dtype)
    decode_photo(header, image)
    return image


def read_bracket(
    paths: album.Paths,
    times: Times | None = None,
    *,
    mask: tuple[int, int, int] | None = None,
    note: Callable[[str], object] = warnings.warn,
    progress: Callable[[Sequence[Path]], Iterable[Path]] = iter,
) -> Bracket:
    """Read a bracket of photographs, with their exposure times.

    Parameters
    ----------
    paths : the photographs, or one folder, of which all photographs are taken, sorted by name; see
        `select`
    times : None to take them from EXIF; else seconds of equivalent exposure, in the order of the
        photographs
        or by file name, or the path of a list (see `hdrlab.io.times.read_times`), of which numbers
        without a unit are seconds or 1/seconds, whichever the brightness of the photographs says
    mask : the colour (R, G, B) of pixels that are no photograph, such as the border of a registered
        scan
    note : what is called with each sentence to know: what was left out, and what the camera had
        changed
    progress : what to wrap the paths in while they are decoded, such as tqdm

    Returns
    -------
    Bracket, sorted from short to long

    Raises
    ------
    ValueError
        For files that are no photographs or do not go together, and for times missing or not
        positive.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> for name, level in ("a.png", 200), ("b.png", 50):
    ...     write_picture(folder / name, np.full((2, 3), level, np.uint8))
    >>> read_bracket(folder, {"a.png": 1.0, "b.png": 0.25}).names
    ('b.png', 'a.png')
    """
    found, notes = album.select(paths)
    headers, more = album.turn_alike([read_header(path) for path in found])
    _check_alike(headers)
    for said in (*notes, *more, *_processed(headers)):
        note(said)
    names, exposures = (
        [header.path.name for header in headers],
        [header.exposure for header in headers],
    )
    seconds, inverse = bracket_times(names, exposures, times)
    order = np.argsort(seconds, kind="stable")
    headers = [headers[j] for j in order]
    linear = headers[0].kind == "RAW"
    balance = raw.balance(headers[0].path) if linear else None
    images = np.empty((len(headers), *headers[0].shape), headers[0].dtype)
    if mask is not None and images.ndim != 4:
        raise InputError(f"expected RGB photographs for the mask colour {mask}, these are gray")
    valid = None if mask is None else np.empty(images.shape[:3], bool)

    def fill(j: int) -> None:
        decode_photo(headers[j], images[j], balance=balance)
        if valid is not None:
            valid[j] = (images[j] != np.asarray(mask)).any(axis=-1)

    filled = map_in_threads(fill, range(len(headers)))
    for _ in progress([header.path for header in headers]):
        next(filled)
    names = [header.path.name for header in headers]
    if inverse and are_inverse(sorted(seconds), [image[::8, ::8].mean() for image in images]):
        seconds = inverse
    return bracket(images, [seconds[j] for j in order], names, valid=valid, linear=linear)


def write_picture(path: str | Path, image: ArrayLike) -> None:
    """Write a picture for the eye, as PNG, JPEG or TIFF by suffix, whole or not at all.

    Parameters
    ----------
    path : the file; what it held is replaced
    image : (H, W) or (H, W, 3) uint8

    Raises
    ------
    ValueError
        For another suffix, shape or dtype.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "edge.tif"
    >>> write_picture(path, np.repeat(np.uint8([[0, 255]]), 2, axis=0))
    >>> read_photo(path).tolist()
    [[0, 255], [0, 255]]
    """
    suffix, picture = files.require_suffix(path, PICTURES, "a picture file"), as_picture(image)
    with files.replacing(path) as name:
        if (
            suffix == ".png" and imagecodecs
        ):  # no search for repetitions, which photographs hardly have
            name.write_bytes(imagecodecs.png_encode(picture, level=1, strategy=2, filter=128))
        else:
            Image.fromarray(picture).save(name, **PICTURES[suffix])


def _check_alike(headers: list[PhotoHeader]) -> None:
    """Raise a ValueError that names the first photograph and one that does not go with it."""
    first = headers[0]
    for other in headers[1:]:
        if (first.kind == "RAW") != (other.kind == "RAW"):
            what = "RAW photographs and others cannot be mixed"
        elif first.shape[:2] != other.shape[:2]:
            what = "expected frames of one size"
        elif (first.shape, first.dtype) != (other.shape, other.dtype):
            what = "expected frames all gray or all RGB, all of 8 or all of 16 bits"
        else:
            continue
        raise InputError(f"{what}: {_short(first)}, {_short(other)}")


def _processed(headers: list[PhotoHeader]) -> list[str]:
    """Return one sentence on photographs of which no single response can be recovered."""
    found = [header for header in headers if header.processing]
    more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
    why = "so no one curve describes it: for a bracket switch HDR off, or take RAW"
    return [f"{one.path.name}{more} {one.processing}, {why}" for one in found[:1]]


def _short(header: PhotoHeader) -> str:
    height, width = header.shape[:2]
    colour = "RGB" if len(header.shape) == 3 else "gray"
    bits = 8 * header.dtype.itemsize
    return f"{header.path.name} is {width} x {height}, {colour}, {bits} bits, {header.kind}"
