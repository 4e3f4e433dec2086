"""Read and write sequences of frames: folders of photos, films, animations and radiance maps.

Films are read and written by PyAV through imageio. PyAV is an extra (`pip install hdrlab[video]`),
because it brings 35 MB of codecs that photos do not need. It is used instead of an ffmpeg program
because frames come as arrays without a pipe, errors are Python exceptions, and there is no program
to find on the path. Animations (.gif) are written by Pillow. They are not read, because their 256
colors are no exposures.

Frames are decoded one at a time, so that a film need not fit into memory.
"""

import io
from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path
from typing import Any, cast

import numpy as np

from hdrlab.core.arrays import F32, Array, as_picture
from hdrlab.core.optional import imageio_v3 as iio
from hdrlab.errors import InputError
from hdrlab.io import album, files, photos, radiance, web
from hdrlab.io.files import MAX_PIXELS, require_replaceable, require_suffix
from hdrlab.io.temporary import new_folder

FILM_SUFFIXES = {".mp4", ".mov", ".mkv", ".avi", ".webm"}
WRITABLE_SUFFIXES = (".gif", ".mp4")
MAX_FRAMES_PER_SECOND = 1000


def read(path: str | Path) -> Iterator[Array]:
    """Yield the frames of a film, or of a folder of photos in the order of their names.

    Parameters
    ----------
    path : a folder, or a .mp4, .mov, .mkv, .avi or .webm

    Returns
    -------
    frames (H, W) or (H, W, 3) uint8, or uint16 from photos of 16 bits, all of one size, one at a
    time

    Raises
    ------
    InputError
        For another kind of file, a damaged file, no frames, or frames that differ in size or depth.
        If the beginning of a film is damaged, `read` itself raises it. If a later part is, the
        iterator raises it there.

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
    if path.suffix.lower() not in FILM_SUFFIXES:
        raise InputError(
            f"{path}: expected a folder of frames, or a video ({', '.join(sorted(FILM_SUFFIXES))})"
        )
    if not path.is_file():
        raise FileNotFoundError(f"{path}: no such file")
    frames = require_alike(decode_frames(path), path)
    # Decoding the first frame now finds an unreadable file before the caller does any work.
    first = next(frames)
    return chain([first], frames)


def count(path: str | Path) -> int | None:
    """Return the number of frames in a folder, or None for a film, which stores no exact number."""
    if not Path(path).is_dir():
        return None
    return len(album.photographs(path))


def require_pyav(path: Path) -> None:
    """Raise an InputError if PyAV is not installed, which `path` needs."""
    import importlib.util

    if importlib.util.find_spec("av") is None:
        raise InputError(
            f"{path}: reading a video needs the extra `video` (pip install hdrlab[video]); "
            "install it, or use a folder of frames or a .gif"
        )


def decode_frames(path: Path) -> Iterator[Array]:
    """Yield the frames of a film, (H, W, 3) uint8."""
    require_pyav(path)
    try:
        with iio.imopen(path, "r", plugin="pyav") as file:
            source: Any = file  # the plug-in has methods that the common type does not declare
            height, width = source.properties(index=0).shape[:2]
            if height * width > MAX_PIXELS:
                raise InputError(f"its header claims {width} x {height} pixels")
            for frame in source.iter():
                yield np.asarray(frame)[..., :3]
    except GeneratorExit:
        raise
    except Exception as error:  # on damaged files the codecs raise exceptions of any type
        raise InputError(f"{path}: it is cut short or damaged ({error})") from None


def require_alike(frames: Iterable[Array], path: Path) -> Iterator[Array]:
    """Yield the frames; raise an InputError if there is none, or if one differs from the first."""
    first = None
    for number, frame in enumerate(frames, 1):
        if first is None:
            first = frame
        if (frame.shape, frame.dtype) != (first.shape, first.dtype):
            raise InputError(
                f"{path}: expected frames of one size and depth, got {first.shape} {first.dtype}, "
                f"and {frame.shape} {frame.dtype} in frame {number}"
            )
        yield frame
    if first is None:
        raise InputError(f"{path}: expected at least one frame, got none")


def write(path: str | Path, frames: Iterable[Array], *, rate: float = 25.0) -> int:
    """Write frames as an animation or a film, completely or not at all, while they are computed.

    Parameters
    ----------
    path : .gif, or .mp4 (H.264, whose sides are even: an odd row or column is cut off)
    frames : (H, W) or (H, W, 3) uint8, all of one size
    rate : frames per second; a .gif stores the time of a frame in hundredths of a second

    Returns
    -------
    count : the number of frames

    Raises
    ------
    InputError
        For another suffix, a rate that is not positive, or frames that are not images of one size.

    Examples
    --------
    >>> import tempfile
    >>> write(Path(tempfile.mkdtemp()) / "blink.gif", np.uint8([[[0, 0]], [[255, 255]]]))
    2
    """
    path = Path(path)
    require_writable(path)
    if not 0 < rate <= MAX_FRAMES_PER_SECOND:
        raise InputError(
            f"expected a rate above 0 and at most {MAX_FRAMES_PER_SECOND} frames a second, "
            f"got {rate}"
        )
    pictures = require_alike((web.as_rgb(as_picture(frame)) for frame in frames), path)
    # In memory, because ImageIO tries to complete a file on a full disk again and again.
    buffer = io.BytesIO()
    if path.suffix.lower() in FILM_SUFFIXES:
        count = _encode_film(buffer, pictures, rate, path.suffix.lower())
    else:
        count = _encode_gif(buffer, pictures, rate)
    files.write(path, buffer.getvalue())
    return count


def _encode_film(buffer: io.BytesIO, frames: Iterator[Array], rate: float, suffix: str) -> int:
    """Encode a film frame by frame, and return the number of frames."""
    # Without any frame, `next` raises before the encoder starts.
    first = next(frames)
    written = 0
    with iio.imopen(buffer, "w", plugin="pyav", extension=suffix) as file:
        film: Any = file
        film.init_video_stream("libx264", fps=float(rate))
        for frame in chain([first], frames):
            height, width = frame.shape[:2]
            even = frame[: height // 2 * 2, : width // 2 * 2]
            film.write_frame(np.ascontiguousarray(even))
            written += 1
    return written


def _encode_gif(buffer: io.BytesIO, frames: Iterable[Array], rate: float) -> int:
    """Encode an animation in one piece, because its frames are small, and return their number."""
    images = np.stack(list(frames))
    milliseconds = 1000 / rate
    with iio.imopen(buffer, "w", plugin="pillow", extension=".gif") as file:
        cast(Any, file).write(images, duration=milliseconds, loop=0)
    return len(images)


def write_maps(folder: str | Path, maps: Iterable[F32], *, suffix: str = ".exr") -> int:
    """Write radiance maps as 0001.exr, 0002.exr, ... into a new folder, all of them or none.

    Returns
    -------
    count : the number of maps

    Raises
    ------
    InputError
        For a folder that exists and is not empty, for no maps, and for a suffix that is not a
        radiance map's.
    """
    folder = Path(folder).resolve()
    require_new(folder)
    count = 0
    with new_folder(folder) as unfinished:
        for E in maps:
            count += 1
            radiance.write_radiance(unfinished / f"{count:04d}{suffix}", E)
        if count == 0:
            raise InputError(f"{folder}: expected at least one map, got none")
    return count


def require_new(folder: Path) -> None:
    """Raise an InputError if a folder cannot be created, or exists and is not empty."""
    folder = folder.resolve()
    if not folder.parent.is_dir():
        raise FileNotFoundError(f"cannot write {folder.name}: there is no folder {folder.parent}")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(f"{folder}: this folder is not empty; pass a new or empty one")


def require_writable(path: Path) -> None:
    """Raise an error for another suffix, for films without PyAV, and if the folder is missing."""
    if require_suffix(path, WRITABLE_SUFFIXES, "a video") in FILM_SUFFIXES:
        require_pyav(path)
    require_replaceable(path)
