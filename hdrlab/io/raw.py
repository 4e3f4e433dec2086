"""Read RAW photos through LibRaw. They are linear, so there is no response to recover.

    raw    sensor values of one color per pixel, above the black level, proportional to exposure
    Z      (H, W, 3) uint16, linear RGB with the primaries of sRGB

All frames of a bracket must be developed alike. LibRaw's automatic brightening is off. The white
level is the camera's, not the brightest value of the photo. All frames get the white balance of the
shortest exposure. After the conversion to sRGB one cannot see which colors of a pixel were clipped,
so a pixel that is clipped in any color becomes white.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from hdrlab.core import arrays, optional
from hdrlab.errors import FileFormatError
from hdrlab.io.exif_exposure import Exposure
from hdrlab.io.files import check_size

SUFFIXES = frozenset({".cr2", ".cr3", ".nef", ".arw", ".dng", ".raf", ".rw2", ".orf", ".pef"})
# The value of a clipped pixel.
WHITE_LEVEL = 65535
# Compression 52546 of a DNG, as an entry of TIFF in either byte order [DNG 1.7.1]. LibRaw does not
# decode it.
JPEG_XL = re.compile(rb"\x03\x01\x03\0\x01\0\0\0\x42\xcd|\x01\x03\0\x03\0\0\0\x01\xcd\x42")
# Rows that are converted at a time: the floats of a whole photo would fill the memory.
BAND_ROWS = 64
HEADER_BYTES = 2**18
# LibRaw's orientations that turn by a quarter.
QUARTER_TURNS = (5, 6)
# Bytes of pixels for one byte of the file, at most.
BEST_COMPRESSION_RATIO = 64

Balance = tuple[float, float, float, float]


def read_shape_and_exposure(path: str | Path) -> tuple[tuple[int, int, int], Exposure]:
    """Return the upright shape (H, W, 3) and the exposure of a RAW file."""
    with _open(path) as file:
        if file.num_colors != 3:
            raise FileFormatError(
                f"{path}: expected a sensor of three colors, got {file.num_colors}"
            )
        height = file.sizes.iheight
        width = file.sizes.iwidth
        if file.sizes.flip in QUARTER_TURNS:
            height, width = width, height
        exposure = _read_exposure(file)
    check_size(path, height, width, height * width // BEST_COMPRESSION_RATIO)
    return (height, width, 3), exposure


def _read_exposure(file: Any) -> Exposure:
    """Return the exposure that LibRaw found. rawpy before 0.27 does not pass it on."""
    if not hasattr(file, "other"):
        return Exposure()
    return Exposure(
        seconds=_positive_or_none(file.other.shutter_speed),
        f_number=_positive_or_none(file.other.aperture),
        iso=_positive_or_none(file.other.iso_speed),
    )


def _positive_or_none(value: float) -> float | None:
    return float(value) if 0 < value < np.inf else None


def balance(path: str | Path) -> Balance:
    """Return the white balance that the camera chose, or that of daylight if it chose none."""
    with _open(path) as file:
        chosen = list(file.camera_whitebalance)
        if not all(np.isfinite(chosen)) or min(chosen[:3]) <= 0:
            chosen = list(file.daylight_whitebalance)
    red, green, blue, green2 = chosen
    return red, green, blue, green2 or green


def decode(path: str | Path, white_balance: Balance | None = None) -> arrays.NDArray[np.uint16]:
    """Return Z, linear sRGB (H, W, 3), by default with the photo's own white balance."""
    if white_balance is None:
        white_balance = balance(path)
    with _open(path) as file:
        matrix = file.color_matrix[:, :3].astype(np.float32)
        camera = file.postprocess(
            output_color=optional.rawpy.ColorSpace.raw,
            user_wb=list(white_balance),
            gamma=(1, 1),
            no_auto_bright=True,
            adjust_maximum_thr=0.0,
            output_bps=16,
        )
    return to_srgb(camera, matrix)


def to_srgb(camera: arrays.NDArray[np.uint16], matrix: arrays.F32) -> arrays.NDArray[np.uint16]:
    """Return the camera's colors in sRGB, Z = M camera, and white where any of them is clipped."""
    Z = np.empty_like(camera)
    for y in range(0, len(camera), BAND_ROWS):
        band = camera[y : y + BAND_ROWS]
        mixed = np.clip(np.rint(band @ matrix.T), 0, WHITE_LEVEL)
        is_clipped = (band == WHITE_LEVEL).any(axis=-1, keepdims=True)
        Z[y : y + BAND_ROWS] = np.where(is_clipped, WHITE_LEVEL, mixed)
    return Z


@contextmanager
def _open(path: str | Path) -> Iterator[Any]:
    """Open a RAW file, and turn LibRaw's errors into a FileFormatError that names it."""
    with open(path, "rb") as stream:  # a missing file raises FileNotFoundError, as elsewhere
        is_jpeg_xl = JPEG_XL.search(stream.read(HEADER_BYTES)) is not None
    try:
        with optional.rawpy.imread(str(path)) as file:
            yield file
    except (optional.rawpy.LibRawError, optional.rawpy.NotSupportedError) as error:
        reason = error.args[0].decode() if isinstance(error.args[0], bytes) else error
        if is_jpeg_xl:
            reason = "it does not read JPEG XL, set the camera to lossless JPEG"
        raise FileFormatError(f"{path}: LibRaw cannot read this RAW photo: {reason}") from None
