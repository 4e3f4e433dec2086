"""The file from which `hdrlab why` explains the pixels of a map: the aligned photos, and the merge.

It is an .npz archive that NumPy reads. It holds whole numbers and floats, and no objects, so reading
it runs no code. Arrays with an element per pixel are divided into bands of rows, so that a pixel is
explained without reading the whole file. Photos are stored as the differences of neighbors in a row,
which compress better. The file is about as large as lossless photos are.
"""

import json
import struct
import tokenize
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from hdrlab.core.arrays import F32, Array, ArrayLike
from hdrlab.core.bracket import Bracket
from hdrlab.diagnostics.noise import Noise
from hdrlab.errors import FileFormatError, InputError
from hdrlab.io.files import replacing
from hdrlab.pipeline.assembly import Assembly
from hdrlab.pipeline.explanation import PixelExplanation, explain_pixel
from hdrlab.pipeline.merging import MergeRecord
from hdrlab.pipeline.pixel_claims import require_record

SUFFIX = ".why.npz"
FORMAT_VERSION = 1
ROWS_PER_BAND = 64
# zlib's fastest levels compress differences nearly as well as its slowest
COMPRESSION_LEVEL = 3
# pixels of the map, on an even grid, that show whether the file belongs to it
MAX_SAMPLED_PIXELS = 1024
# of the largest channel: .hdr stores 8 bits of it
MAP_ROUNDING = 2 / 256
# fraction of the sampled pixels that must fit
MIN_FITTING_FRACTION = 0.99
# what zipfile, zlib and NumPy raise for damaged archives, besides ValueError
DAMAGE_ERRORS = (
    zipfile.BadZipFile,
    zipfile.LargeZipFile,
    zlib.error,
    struct.error,
    EOFError,
    KeyError,
    TypeError,
    RuntimeError,
    SyntaxError,
    tokenize.TokenError,
)
# arrays with the photos on their first axis, and the rows on the second
PHOTO_ARRAYS = ("images", "valid", "used")
# arrays with the rows on their first axis
MAP_ARRAYS = ("quality", "moving", "glare", "certainty", "alpha")
# arrays without rows
SMALL_ARRAYS = ("times", "g", "pixel_weights", "neutral", "references", "noise", "sample")


@dataclass(frozen=True, kw_only=True)
class _Header:
    """What the file's header.json says."""

    version: int
    height: int
    width: int
    names: list[str]
    has_relative_times: bool
    method: str
    merge_noise: float
    unit_factor: float
    is_by_variance: bool
    arrays: list[str]


def evidence_path(map_path: Path) -> Path:
    """Return the path of the file that belongs to a map: `room.why.npz` for `room.exr`."""
    return map_path.with_name(map_path.stem + SUFFIX)


def write_evidence(path: str | Path, state: Assembly) -> Path:
    """Write what the explanation of each pixel of a map needs, and return the file's path.

    Parameters
    ----------
    path : path
        See `evidence_path`.
    state : Assembly
        A finished one, with its photos.

    Raises
    ------
    InputError
        If the photos were released.
    """
    record = require_record(state)
    per_row = _arrays_by_row(state, record)
    small: dict[str, ArrayLike | None] = {
        "times": state.bracket.times,
        "g": state.g,
        "pixel_weights": record.pixel_weights,
        "neutral": record.neutral,
        "references": record.references,
        "noise": None if state.sensor_noise is None else np.stack(state.sensor_noise),
        "sample": _sample(state.E),
    }
    height, width = state.quality.shape
    header = {
        "version": FORMAT_VERSION,
        "height": height,
        "width": width,
        "names": list(state.bracket.names),
        "has_relative_times": state.bracket.has_relative_times,
        "method": record.method,
        "merge_noise": record.noise,
        "unit_factor": record.unit_factor,
        "is_by_variance": state.s is not None,
        "arrays": [*per_row, *(name for name, array in small.items() if array is not None)],
    }
    with (
        replacing(path) as temporary,
        zipfile.ZipFile(
            temporary, "w", zipfile.ZIP_DEFLATED, compresslevel=COMPRESSION_LEVEL
        ) as archive,
    ):
        # the time of writing is no part of the content
        archive.writestr(zipfile.ZipInfo("header.json"), json.dumps(header))
        for name, array in small.items():
            if array is not None:
                _write_array(archive, name, np.asarray(array))
        for name, array in per_row.items():
            for band, start in enumerate(range(0, height, ROWS_PER_BAND)):
                rows = slice(start, start + ROWS_PER_BAND)
                part = array[:, rows] if name in PHOTO_ARRAYS else array[rows]
                if name == "images":
                    part = np.diff(part, axis=2, prepend=np.zeros_like(part[:, :, :1]))
                _write_array(archive, f"{name}-{band}", part)
    return Path(path)


def explain_map_pixel(
    path: str | Path, E: F32, y: int, x: int, *, map_name: str = "the map"
) -> PixelExplanation:
    """Return the explanation of the pixel E[y, x] of a map, from the file beside the map.

    Parameters
    ----------
    path : path
        The file that `write_evidence` wrote.
    E : (h, w) or (h, w, 3)
        The map, as it was read from its file.
    y, x : int
        Row and column.
    map_name : str
        What errors call the map.

    Raises
    ------
    FileFormatError
        If the file is damaged, or no such file.
    InputError
        If it belongs to another map, or the pixel is outside of the map.
    """
    with _reading(Path(path)) as archive:
        header = _Header(**json.loads(archive.read("header.json")))
        if header.version != FORMAT_VERSION:
            raise FileFormatError(
                f"{path}: version {header.version} of the format is not known; "
                "assemble the photos again, or update hdrlab"
            )
        sample = _read_array(archive, "sample")
        if E.shape[:2] != (header.height, header.width) or not _fits(_sample(E), sample):
            raise InputError(
                f"{path} belongs to another map than {map_name}; assemble the photos again with --why"
            )
        if not (0 <= y < header.height and 0 <= x < header.width):
            raise InputError(
                f"pixel {x},{y} is outside of {map_name}, which has {header.width} x "
                f"{header.height} pixels"
            )
        # the neighbors of a stuck pixel are in the next rows
        start = max(y - 1, 0)
        rows = slice(start, min(y + 2, header.height))
        state = _read_rows(archive, header, rows, E[rows])
    explanation = explain_pixel(state, y - start, x, require_record(state).sensor_noise)
    return replace(explanation, y=y)


def _arrays_by_row(state: Assembly, record: MergeRecord) -> dict[str, Array]:
    """Return the arrays of PHOTO_ARRAYS and MAP_ARRAYS that an Assembly has."""
    arrays = {
        "images": state.bracket.images,
        "valid": state.bracket.valid,
        "used": record.used,
        "quality": state.quality,
        "moving": state.moving,
        "glare": state.glare,
        "certainty": record.certainty,
        "alpha": record.alpha,
    }
    return {name: array for name, array in arrays.items() if array is not None}


def _sample(E: F32) -> Array:
    """Return some pixels of a map (h, w, C), on an even grid."""
    step = max(1, int(np.ceil(np.sqrt(E.shape[0] * E.shape[1] / MAX_SAMPLED_PIXELS))))
    return np.atleast_3d(E)[::step, ::step]


def _fits(sample: Array, expected: Array) -> bool:
    """Return whether a map can be the expected one, up to the rounding of its file."""
    channels = max(sample.shape[-1], expected.shape[-1])
    if sample.shape[:2] != expected.shape[:2]:
        return False
    # some formats have three channels only
    sample = np.broadcast_to(sample, (*sample.shape[:2], channels))
    expected = np.broadcast_to(expected, (*expected.shape[:2], channels))
    tolerance = MAP_ROUNDING * expected.max(axis=-1, keepdims=True) + np.float32(1e-30)
    is_fitting = (np.abs(sample - expected) <= tolerance).all(axis=-1)
    return bool(is_fitting.mean() >= MIN_FITTING_FRACTION)


def _write_array(archive: zipfile.ZipFile, name: str, array: Array) -> None:
    member = zipfile.ZipInfo(f"{name}.npy")
    member.compress_type = zipfile.ZIP_DEFLATED
    with archive.open(member, "w", force_zip64=True) as file:
        np.lib.format.write_array(file, np.ascontiguousarray(array), allow_pickle=False)


def _read_array(archive: zipfile.ZipFile, name: str) -> Array:
    with archive.open(f"{name}.npy") as file:
        return np.asarray(np.lib.format.read_array(file, allow_pickle=False))


@contextmanager
def _reading(path: Path) -> Iterator[zipfile.ZipFile]:
    """Open a file; whatever is wrong with its content becomes a FileFormatError."""
    try:
        with zipfile.ZipFile(path) as archive:
            yield archive
    except DAMAGE_ERRORS as error:
        raise _damaged(path) from error
    except ValueError as error:
        if isinstance(error, InputError | FileFormatError):
            raise
        raise _damaged(path) from error


def _damaged(path: Path) -> FileFormatError:
    return FileFormatError(
        f"{path}: this file is damaged, or `hdrlab assemble --why` did not write it; "
        "assemble the photos again"
    )


def _read_rows(archive: zipfile.ZipFile, header: _Header, rows: slice, E: F32) -> Assembly:
    """Return some rows of an Assembly, with the rows E of its map."""
    arrays: dict[str, Any] = {}
    for name in (*PHOTO_ARRAYS, *MAP_ARRAYS):
        if name in header.arrays:
            arrays[name] = _read_bands(archive, name, rows)
    for name in SMALL_ARRAYS:
        if name in header.arrays:
            arrays[name] = _read_array(archive, name)
    _require_shapes(arrays, header, rows)
    images = arrays["images"]
    channels = 1 if images.ndim == 3 else images.shape[3]
    # a gray map may have been stored in three channels
    gray = E[..., 0] if E.ndim == 3 else E
    radiance = gray if channels == 1 else np.broadcast_to(np.atleast_3d(E), images.shape[1:])
    noise = arrays.get("noise")
    record = MergeRecord(
        method=header.method,
        pixel_weights=arrays["pixel_weights"],
        noise=header.merge_noise,
        certainty=arrays.get("certainty"),
        neutral=arrays["neutral"],
        used=arrays.get("used"),
        references=arrays.get("references"),
        alpha=arrays.get("alpha"),
        sensor_noise=None if noise is None else Noise(*noise),
        unit_factor=header.unit_factor,
    )
    bracket = Bracket(
        images=images,
        times=arrays["times"],
        names=tuple(header.names),
        valid=arrays.get("valid"),
        has_relative_times=header.has_relative_times,
    )
    return Assembly(
        stage="compare",
        bracket=bracket,
        offsets=np.zeros((len(images), 2), np.int64),
        g=arrays["g"],
        E=np.ascontiguousarray(radiance),
        quality=arrays["quality"],
        moving=arrays.get("moving"),
        glare=arrays.get("glare"),
        s=np.full(radiance.shape, np.inf, np.float32) if header.is_by_variance else None,
        record=record,
    )


def _require_shapes(arrays: dict[str, Any], header: _Header, rows: slice) -> None:
    """Raise a ValueError if arrays do not fit together, as in a file that was changed."""
    count = len(header.names)
    area = (rows.stop - rows.start, header.width)
    for name, array in arrays.items():
        is_wrong = name in PHOTO_ARRAYS and array.shape[:3] != (count, *area)
        is_wrong |= name in MAP_ARRAYS and array.shape != area
        if is_wrong:
            raise ValueError(f"expected {name} of {area} pixels, got {array.shape}")
    if arrays["times"].shape != (count,):
        raise ValueError(f"expected {count} times, got {arrays['times'].shape}")


def _read_bands(archive: zipfile.ZipFile, name: str, rows: slice) -> Array:
    """Return some rows of an array, from one or two bands."""
    first = rows.start // ROWS_PER_BAND
    last = (rows.stop - 1) // ROWS_PER_BAND
    axis = 1 if name in PHOTO_ARRAYS else 0
    bands = [_read_array(archive, f"{name}-{band}") for band in range(first, last + 1)]
    array = np.concatenate(bands, axis=axis)
    local = slice(rows.start - first * ROWS_PER_BAND, rows.stop - first * ROWS_PER_BAND)
    part = array[:, local] if axis == 1 else array[local]
    if name == "images":
        part = np.cumsum(part, axis=2, dtype=part.dtype)
    return part
