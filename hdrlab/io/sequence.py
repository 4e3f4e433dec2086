"""Frames in and out: a folder of photographs, a film, an animation.

Films are read and written through imageio by PyAV, which is an extra (`pip install hdrlab[video]`),
for it brings 35 MB of codecs that no still picture needs. PyAV rather than an ffmpeg program beside
Python: frames come as arrays without a pipe, an error has a name, and there is nothing to find on
the path. An animation, .gif, is written by Pillow, and is not read: its 256 colours are no
exposures.

Frames are decoded one at a time: a film need not fit into memory.
"""

from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, cast

import numpy as np

from hdrlab.core.arrays import F32, Array, as_picture
from hdrlab.core.optional import imageio_v3 as iio
from hdrlab.errors import InputError
from hdrlab.io import album, photos, radiance, web
from hdrlab.io.files import MAX_PIXELS, replacing, require_suffix

FILMS = {".mp4", ".mov", ".mkv", ".avi", ".webm"}  # by PyAV
WRITTEN = (".gif", ".mp4")
MISSING = "films need the extra `video` (pip install hdrlab[video]); folders of frames and .gif do without"


def read(path: str | Path) -> Iterator[Array]:
    """Yield the frames of a film, or of a folder of photographs sorted by name.

    Parameters
    ----------
    path : a folder, or a .mp4, .mov, .mkv, .avi or .webm

    Returns
    -------
    frames (H, W) or (H, W, 3) uint8, or uint16 from photographs of 16 bits, all of one size, one at
    a time

    Raises
    ------
    ValueError
        For something else, a damaged file, no frames, or frames that do not go together. What is
        wrong with a file's beginning is said at once, what is wrong later when it is reached.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> for level in (0, 255):
    ...     photos.write_picture(folder / f"{level}.png", np.full((8, 8, 3), level, np.uint8))
    >>> [frame.max() for frame in read(folder)]
    [np.uint8(0), np.uint8(255)]
    """
    path = Path(path)
    if path.is_dir():
        files = album.photographs(path)
        return require_alike((photos.read_photo(file) for file in files), path)
    if path.suffix.lower() not in FILMS:
        raise InputError(
            f"{path}: expected a folder of frames, or a film ({', '.join(sorted(FILMS))})"
        )
    if not path.is_file():
        raise FileNotFoundError(f"{path}: there is no such file")
    frames = require_alike(decode_frames(path), path)
    first = next(frames)  # an unreadable file is found before anything is done with it
    return chain([first], frames)


def count(path: str | Path) -> int | None:
    """Return how many frames there are, where that is known without decoding them: in a folder."""
    return len(album.photographs(path)) if Path(path).is_dir() else None


def require_films(path: Path) -> None:
    """Raise a ValueError where PyAV is not installed."""
    import importlib.util

    if importlib.util.find_spec("av") is None:
        raise InputError(f"{path}: {MISSING}")


def decode_frames(path: Path) -> Iterator[Array]:
    """Yield the frames of a film, (H, W, 3) uint8."""
    require_films(path)
    try:
        with iio.imopen(path, "r", plugin="pyav") as file:
            source: Any = file  # what its plug-in takes beyond the common type
            height, width = source.properties(index=0).shape[:2]
            if height * width > MAX_PIXELS:
                raise InputError(f"its header claims {width} x {height} pixels")
            for frame in source.iter():
                yield np.asarray(frame)[..., :3]
    except GeneratorExit:
        raise
    except Exception as error:  # on damaged files the codecs raise what they like
        raise InputError(f"{path}: it is cut short or damaged ({error})") from None


def require_alike(frames: Iterable[Array], path: Path) -> Iterator[Array]:
    """Yield the frames; raise a ValueError where there is none, or one that differs from the first."""
    first = None
    for number, frame in enumerate(frames, 1):
        first = frame if first is None else first
        if (frame.shape, frame.dtype) != (first.shape, first.dtype):
            got = f"{first.shape} {first.dtype} and, number {number}, {frame.shape} {frame.dtype}"
            raise InputError(f"{path}: expected frames of one size and depth, got {got}")
        yield frame
    if first is None:
        raise InputError(f"{path}: expected at least one frame, got none")


def write(path: str | Path, frames: Iterable[Array], *, rate: float = 25.0) -> int:
    """Write frames as an animation or a film, whole or not at all, as they come.

    Parameters
    ----------
    path : .gif, or .mp4 (H.264, whose sides are even: an odd row or column is cut off)
    frames : (H, W) or (H, W, 3) uint8, all of one size
    rate : frames a second; a .gif knows only hundredths of a second

    Returns
    -------
    count : how many they were

    Raises
    ------
    ValueError
        For another suffix, a rate that is not positive, or frames that are not pictures of one
        size.

    Examples
    --------
    >>> import tempfile
    >>> write(Path(tempfile.mkdtemp()) / "blink.gif", np.uint8([[[0, 0]], [[255, 255]]]))
    2
    """
    path = Path(path)
    require_writable(path)
    if not 0 < rate <= 1000:
        raise InputError(f"expected a rate above 0 and at most 1000 frames a second, got {rate}")
    pictures = require_alike((web.as_rgb(as_picture(frame)) for frame in frames), path)
    with replacing(path) as name:
        return (_write_film if path.suffix.lower() in FILMS else _write_gif)(name, pictures, rate)


def _write_film(path: Path, frames: Iterator[Array], rate: float) -> int:
    first, written = next(frames), 0  # which may be none
    with iio.imopen(path, "w", plugin="pyav") as file:
        film: Any = file
        film.init_video_stream("libx264", fps=float(rate))
        for frame in chain([first], frames):
            even = frame[: len(frame) // 2 * 2, : frame.shape[1] // 2 * 2]
            film.write_frame(np.ascontiguousarray(even))
            written += 1
    return written


def _write_gif(path: Path, frames: Iterable[Array], rate: float) -> int:
    """Write them all at once: of an animation the frames are small."""
    shown = np.stack(list(frames))
    with iio.imopen(path, "w", plugin="pillow") as file:
        cast(Any, file).write(shown, duration=1000 / rate, loop=0)
    return len(shown)


def write_maps(folder: str | Path, maps: Iterable[F32], *, suffix: str = ".exr") -> int:
    """Write radiance maps as 0001.exr, 0002.exr, ... into a new folder, all of them or none.

    Raises
    ------
    ValueError
        Where the folder is there and holds something, and for another suffix than a radiance map's.
    """
    folder, number = Path(folder).resolve(), 0
    require_new(folder)
    with TemporaryDirectory(prefix=".hdrlab-", dir=folder.parent) as scratch:
        made = Path(scratch) / "maps"
        made.mkdir()
        for number, E in enumerate(maps, 1):
            radiance.write_radiance(made / f"{number:04d}{suffix}", E)
        if not number:
            raise InputError(f"{folder}: expected at least one map, got none")
        made.replace(folder)
    return number


def require_new(folder: Path) -> None:
    """Raise a ValueError where a folder cannot be made, or holds something already."""
    folder = folder.resolve()
    if not folder.parent.is_dir():
        raise FileNotFoundError(f"cannot write {folder.name}: there is no folder {folder.parent}")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(f"{folder}: expected a folder that is new or empty, it holds something")


def require_writable(path: Path) -> None:
    """Raise a ValueError for a suffix that is not written, or for films where PyAV is not installed."""
    if require_suffix(path, WRITTEN, "a film") in FILMS:
        require_films(path)
