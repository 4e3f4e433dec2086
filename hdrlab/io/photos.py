"""Read photos as arrays, and write pictures.

The headers of a bracket are read first. They tell whether the frames go together, and in which
order. Then each frame is decoded once, straight into its place, several at a time.
"""

import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeGuard

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from hdrlab.core.arrays import Array, ArrayLike, Mask, as_picture
from hdrlab.core.bracket import Bracket, bracket
from hdrlab.core.optional import imagecodecs
from hdrlab.core.threads import map_in_threads
from hdrlab.errors import FileFormatError, InputError
from hdrlab.io import album, damaged_bands, files, raw, white_level
from hdrlab.io.decode import PhotoHeader, decode_photo, read_header
from hdrlab.io.exif_exposure import (
    Exposure,
    fill_missing,
    luminance_of_unit,
    max_luminance_of_unit,
)
from hdrlab.io.own_pictures import SOFTWARE, make_exif, mark_png
from hdrlab.io.times import (
    Times,
    are_inverse,
    bracket_times,
    read_bare_numbers,
    times_in_names,
)

JPEG_OPTIONS = {"quality": 95, "subsampling": 0}
TIFF_OPTIONS = {"compression": "tiff_deflate"}
# Pillow's options by the suffix of the picture.
PICTURES: dict[str, dict[str, Any]] = {
    ".png": {"compress_level": 1},
    ".jpg": JPEG_OPTIONS,
    ".jpeg": JPEG_OPTIONS,
    ".tif": TIFF_OPTIONS,
    ".tiff": TIFF_OPTIONS,
}
# imagecodecs' options for PNG: no search for repetitions, of which photos have hardly any.
PNG_OPTIONS = {"level": 1, "strategy": 2, "filter": 128}
# Every so many rows and columns of a photo serve to measure its brightness.
BRIGHTNESS_STEP = 8
# Formats whose decoders find shifted and overwritten rows.
CHECKED_KINDS = frozenset({"JPEG", "PNG", "JXL"})


def read_photo(path: str | Path) -> Array:
    """Read one photo, upright.

    Parameters
    ----------
    path : a JPEG, PNG, TIFF, WebP, AVIF, HEIC or JPEG XL file, gray or RGB, of 8 to 16 bits, or a
        RAW file; colors of another space than sRGB are converted by the file's profile

    Returns
    -------
    (H, W) or (H, W, 3), uint8 or uint16

    Raises
    ------
    FileFormatError
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
    paths: album.Paths | album.Selection,
    times: Times | None = None,
    *,
    mask: tuple[int, int, int] | None = None,
    note: Callable[[str], object] = warnings.warn,
    warn: Callable[[str], object] = warnings.warn,
    detail: Callable[[str], object] | None = None,
    progress: Callable[[Sequence[Path]], Iterable[Path]] = iter,
) -> Bracket:
    """Read a bracket of photos, with their exposure times.

    A damaged photo is left out, if two or more others remain; the field `damaged` of the bracket
    names it. Where 16-bit photos are clipped at a lower value than 65535, such as 4095, this value
    becomes 65535, see `hdrlab.io.white_level`.

    Parameters
    ----------
    paths : the photos, or one folder, from which hdrlab uses the photos that form one bracket; see
        `hdrlab.io.album.select`, whose result can be passed instead
    times : None for the times in EXIF, or in file names such as 1_250.jpg; without either, all times
        are 1, and `pipeline.assemble` estimates relative ones. Else seconds of equivalent exposure,
        in the order of the photos or by file name, or the path of a list (see
        `hdrlab.io.times.read_times`). Numbers of a list without a unit are seconds or 1/seconds,
        whichever fits the brightness of the photos
    mask : the color (R, G, B) of pixels to ignore, such as the border of a registered scan
    note : called with each note: which photos were skipped, and what the camera had changed
    warn : called with a sentence on each damaged photo that was left out
    detail : called with a sentence on each picture that was skipped because hdrlab made it, and
        on missing times, which `pipeline.assemble` reports, too; without it, `note` gets the latter
    progress : wraps the paths while they are decoded, such as tqdm

    Returns
    -------
    Bracket, sorted from short to long

    Raises
    ------
    InputError
        For photos that do not go together, and for times that are not positive.
    FileFormatError
        For files that are damaged or no photos, if fewer than two others remain.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> for name, level in ("a.png", 200), ("b.png", 50):
    ...     write_picture(folder / name, np.full((2, 3), level, np.uint8))
    >>> read_bracket(folder, {"a.png": 1.0, "b.png": 0.25}).names
    ('b.png', 'a.png')
    """
    selection, times = _select_photos(paths, times)
    headers, notes_on_orientation = album.turn_alike(selection.headers)
    require_alike(headers)
    if detail is not None:
        for sentence in selection.details:
            detail(sentence)
    for sentence in (*selection.notes, *notes_on_orientation, *_processing_notes(headers)):
        note(sentence)
    frames = _sort_by_time(headers, times, note=note, detail=detail or note)
    photos = _decode_photos(frames.headers, mask, progress)
    errors = photos.errors or _find_damaged_rows(frames.headers, photos)
    damaged = [*selection.damaged, *(errors[j] for j in sorted(errors))]
    album.require_enough_sound(damaged, len(frames.headers) - len(errors))
    warnings_of_damage = [f"{error}; it was left out" for error in damaged]
    for sentence in warnings_of_damage:
        warn(sentence)
    if errors:
        sound = [j for j in range(len(frames.headers)) if j not in errors]
        frames = frames.select(sound)
        photos = photos.select(sound)
    is_raw = frames.headers[0].kind == "RAW"
    if not is_raw:
        white = white_level.find_white_level(photos.images, valid=photos.valid)
        if white is not None:
            white_level.scale_to_full_white(photos.images, white)
            note(white_level.describe_white_level(white))
    return bracket(
        photos.images,
        _choose_seconds(frames, photos.images),
        [header.path.name for header in frames.headers],
        valid=photos.valid,
        linear=is_raw,
        luminance_of_unit=frames.luminance_of_unit,
        max_luminance_of_unit=frames.max_luminance_of_unit,
        damaged=warnings_of_damage,
    )


@dataclass(frozen=True)
class _SortedFrames:
    """The headers and exposure times of a bracket, from short to long.

    `inverse_seconds` are the times if the numbers of a list are 1/seconds, and None unless the list
    leaves that open.
    """

    headers: list[PhotoHeader]
    seconds: list[float]
    inverse_seconds: list[float] | None
    luminance_of_unit: float | None
    max_luminance_of_unit: float | None

    def select(self, indices: list[int]) -> "_SortedFrames":
        """Return the frames with these indices."""
        inverse_seconds = None
        if self.inverse_seconds is not None:
            inverse_seconds = [self.inverse_seconds[j] for j in indices]
        return replace(
            self,
            headers=[self.headers[j] for j in indices],
            seconds=[self.seconds[j] for j in indices],
            inverse_seconds=inverse_seconds,
        )


@dataclass(frozen=True)
class _DecodedPhotos:
    """Pixels of a bracket (P, H, W[, 3]), where they are valid (P, H, W), and errors by frame."""

    images: Array
    valid: Mask | None
    errors: dict[int, FileFormatError]

    def select(self, indices: list[int]) -> "_DecodedPhotos":
        """Return a copy of the photos with these indices, which have no errors."""
        valid = None if self.valid is None else self.valid[indices]
        return _DecodedPhotos(images=self.images[indices], valid=valid, errors={})


def _select_photos(
    paths: album.Paths | album.Selection, times: Times | None
) -> tuple[album.Selection, Times | None]:
    """Select the photos of a bracket, and leave out the times of damaged ones."""
    if isinstance(paths, album.Selection):
        return paths, times
    selection = album.select(paths)
    if _are_in_order(times) and len(times) > len(selection.headers):
        # the caller knows that all photos of the folder are one bracket
        selection = album.select(paths, split=False)
    return selection, _drop_times_of_damaged(times, paths, selection)


def _sort_by_time(
    headers: list[PhotoHeader],
    times: Times | None,
    *,
    note: Callable[[str], object],
    detail: Callable[[str], object],
) -> _SortedFrames:
    """Find the exposure time of each photo, and sort the photos from short to long exposures."""
    names = [header.path.name for header in headers]
    exposures, fill_notes = fill_missing(names, [header.exposure for header in headers])
    times_source, times_notes = _find_source_of_times(names, exposures, times)
    if times is None:
        for sentence in fill_notes:
            note(sentence)
    for sentence in times_notes:
        note(sentence)
    if times is None and times_source is not None and not times_notes:
        detail(_describe_missing_times(names, exposures))
    seconds, inverse_seconds = bracket_times(names, exposures, times_source)
    order = np.argsort(seconds, kind="stable").tolist()
    frames = _SortedFrames(
        headers=headers,
        seconds=seconds,
        inverse_seconds=inverse_seconds,
        luminance_of_unit=luminance_of_unit(exposures) if times_source is None else None,
        max_luminance_of_unit=max_luminance_of_unit(exposures) if times_source is None else None,
    )
    return frames.select(order)


def _decode_photos(
    headers: list[PhotoHeader],
    mask: tuple[int, int, int] | None,
    progress: Callable[[Sequence[Path]], Iterable[Path]],
) -> _DecodedPhotos:
    """Decode photos of one shape, several at a time. A damaged file gives an error of its frame."""
    first = headers[0]
    balance = raw.balance(first.path) if first.kind == "RAW" else None
    images = np.empty((len(headers), *first.shape), first.dtype)
    if mask is not None and images.ndim != 4:
        raise InputError(
            f"the mask color {mask} needs RGB photos, but these are gray; leave out the mask"
        )
    valid = None if mask is None else np.empty(images.shape[:3], bool)
    errors: dict[int, FileFormatError] = {}

    def decode_frame(j: int) -> None:
        try:
            decode_photo(headers[j], images[j], balance=balance)
        except FileFormatError as error:
            errors[j] = error
            return
        if valid is not None:
            valid[j] = (images[j] != np.asarray(mask)).any(axis=-1)

    with closing(map_in_threads(decode_frame, range(len(headers)))) as decoded:
        for _ in progress([header.path for header in headers]):
            next(decoded)
    return _DecodedPhotos(images=images, valid=valid, errors=errors)


def _find_damaged_rows(
    headers: list[PhotoHeader], photos: _DecodedPhotos
) -> dict[int, FileFormatError]:
    """Return an error for each photo with rows that differ from those of all other photos."""
    only_constant = all(header.kind in CHECKED_KINDS for header in headers)
    bands = damaged_bands.find_damaged_bands(
        photos.images, valid=photos.valid, only_constant=only_constant
    )
    errors = {}
    for band in bands:
        path = headers[band.frame].path
        shows = "have one color" if band.is_constant else "show something else"
        errors[band.frame] = FileFormatError(
            f"{path}: its rows {band.start} to {band.stop - 1} {shows}, unlike those of "
            "the other photos, so the file is damaged"
        )
    return errors


def _choose_seconds(frames: _SortedFrames, images: Array) -> list[float]:
    """Return the exposure times; numbers of a list may be seconds or 1/seconds, as the photos show."""
    if frames.inverse_seconds is None:
        return frames.seconds
    brightness = [image[::BRIGHTNESS_STEP, ::BRIGHTNESS_STEP].mean() for image in images]
    if are_inverse(frames.seconds, brightness):
        return frames.inverse_seconds
    return frames.seconds


def _are_in_order(times: Times | None) -> TypeGuard[Sequence[float] | NDArray[np.floating]]:
    """Return whether times are given in the order of the photos, and not by their names."""
    return times is not None and not isinstance(times, str | Path | Mapping)


def _drop_times_of_damaged(
    times: Times | None, paths: album.Paths, selection: album.Selection
) -> Times | None:
    """Return times in the order of the photos without those of photos that were left out."""
    if not _are_in_order(times) or not selection.damaged:
        return times
    listed = album.photographs(paths)
    if len(times) != len(listed) or len(selection.paths) == len(times):
        return times
    kept = set(selection.paths)
    return [seconds for path, seconds in zip(listed, times, strict=True) if path in kept]


def _find_source_of_times(
    names: list[str], exposures: list[Exposure], times: Times | None
) -> tuple[Times | None, list[str]]:
    """Return where the times come from, with a note: given ones, EXIF, file names, or nowhere.

    Without any times, all are 1 second. The pipeline replaces equal times by relative ones.
    """
    if isinstance(times, str | Path) and read_bare_numbers(times) is not None:
        return times, [f"{times} names no photos: its times belong to the photos sorted by name"]
    if times is not None:
        return times, []
    if all(exposure.seconds is not None for exposure in exposures):
        return None, []
    named = times_in_names(names)
    if named is not None:
        return named, ["no exposure times in EXIF; hdrlab reads them from the file names"]
    return [1.0] * len(names), []


def _describe_missing_times(names: list[str], exposures: list[Exposure]) -> str:
    """Return a note on the photos without a time, and what to do."""
    without_time = [
        name for name, exposure in zip(names, exposures, strict=True) if exposure.seconds is None
    ]
    return (
        f"no exposure time in EXIF of {', '.join(without_time)}; hdrlab estimates all times from the "
        "pixels. If you know the times, pass --times FILE (times= in Python), or --stops 2"
    )


def write_picture(path: str | Path, image: ArrayLike, *, is_result: bool = False) -> None:
    """Write a picture as PNG, JPEG or TIFF, by its suffix.

    If writing fails, an existing file stays as it was.

    Parameters
    ----------
    path : the file; what it held is replaced
    image : (H, W) or (H, W, 3) uint8
    is_result : whether the file is a result, not a photo; it then names hdrlab as its software, and
        hdrlab skips it in a folder of photos

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
    suffix = require_writable(path)
    picture = as_picture(image)
    with files.replacing(path) as name:
        if suffix == ".png" and imagecodecs.has_codec("PNG"):
            data = imagecodecs.png_encode(np.ascontiguousarray(picture), **PNG_OPTIONS)
            name.write_bytes(mark_png(data) if is_result else data)
        else:
            options = PICTURES[suffix] | (_mark(suffix) if is_result else {})
            Image.fromarray(picture).save(name, **options)


def _mark(suffix: str) -> dict[str, Any]:
    """Return Pillow's options that mark a picture as written by hdrlab."""
    if suffix == ".png":
        text = PngInfo()
        text.add_text("Software", SOFTWARE)
        return {"pnginfo": text}
    if suffix in (".tif", ".tiff"):
        return {"software": SOFTWARE}
    return {"exif": make_exif()}


def require_writable(path: str | Path) -> str:
    """Return the suffix of a picture's name, or raise an InputError if hdrlab cannot write it."""
    return files.require_suffix(path, PICTURES, "a picture file")


def require_alike(headers: list[PhotoHeader]) -> None:
    """Raise an InputError that names the first photo and one that does not go with it."""
    first = headers[0]
    for other in headers[1:]:
        if (first.kind == "RAW") != (other.kind == "RAW"):
            reason = "RAW photographs and others cannot be mixed"
        elif first.shape[:2] != other.shape[:2]:
            reason = "expected frames of one size"
        elif (first.shape, first.dtype) != (other.shape, other.dtype):
            reason = "expected frames all gray or all RGB, all of 8 or all of 16 bits"
        else:
            continue
        raise InputError(f"{reason}: {_describe(first)}, {_describe(other)}")


def _processing_notes(headers: list[PhotoHeader]) -> list[str]:
    """Return a note on the photos that no single response curve describes."""
    processed = [header for header in headers if header.processing]
    if not processed:
        return []
    first = processed[0]
    more = f" (and {len(processed) - 1} more)" if len(processed) > 1 else ""
    return [
        f"{first.path.name}{more} {first.processing}, so no one curve describes it: "
        "for a bracket switch HDR off, or take RAW"
    ]


def _describe(header: PhotoHeader) -> str:
    height, width = header.shape[:2]
    channels = "RGB" if len(header.shape) == 3 else "gray"
    bits = 8 * header.dtype.itemsize
    return f"{header.path.name} is {width} x {height}, {channels}, {bits} bits, {header.kind}"
