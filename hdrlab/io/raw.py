"""RAW photographs, through LibRaw: linear, so that there is no response to recover.

    raw    sensor values of one colour per pixel, above the black level, proportional to exposure
    Z      (H, W, 3) uint16, linear RGB with the primaries of sRGB

All frames of a bracket must be developed alike: LibRaw's brightening, which looks at the picture,
is off; the white level is the camera's, not the brightest value found; one white balance, of the
shortest exposure, serves all. Once the camera's colours are mixed into those of sRGB, clipped ones
are no longer known: so a pixel that is clipped in any colour is made white in all.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from hdrlab.core import arrays, optional
from hdrlab.errors import InputError
from hdrlab.io.exif_exposure import Exposure
from hdrlab.io.files import check_size

SUFFIXES = frozenset({".cr2", ".cr3", ".nef", ".arw", ".dng", ".raf", ".rw2", ".orf", ".pef"})
# of a clipped pixel
WHITE_LEVEL = 65535
# compression 52546 of a DNG, as an entry of TIFF says it [DNG 1.7.1]; LibRaw does not decode it
JPEG_XL = re.compile(rb"\x03\x01\x03\0\x01\0\0\0\x42\xcd|\x01\x03\0\x03\0\0\0\x01\xcd\x42")
# rows
BAND_ROWS = 64

Balance = tuple[float, float, float, float]


def look(path: str | Path) -> tuple[tuple[int, int, int], Exposure]:
    """Return the upright shape (H, W, 3) and the Exposure of the RAW file at `path`."""
    with _open(path) as file:
        sizes, other = file.sizes, file.other
        if file.num_colors != 3:
            raise InputError(f"{path}: expected a sensor of three colours, got {file.num_colors}")
        # by 5 and 6 it is turned by a quarter
        height, width = (sizes.iheight, sizes.iwidth)[:: -1 if sizes.flip in (5, 6) else 1]
        values = (other.shutter_speed, other.aperture, other.iso_speed)
    check_size(path, height, width, height * width // 64)
    return (height, width, 3), Exposure(
        *(float(value) if 0 < value < np.inf else None for value in values)
    )


def balance(path: str | Path) -> Balance:
    """Return the white balance that the camera chose, or that of daylight where it chose none."""
    with _open(path) as file:
        chosen = list(file.camera_whitebalance)
        if not all(np.isfinite(chosen)) or min(chosen[:3]) <= 0:
            chosen = list(file.daylight_whitebalance)
    red, green, blue, green2 = chosen
    return red, green, blue, green2 or green


def decode(path: str | Path, white_balance: Balance | None = None) -> arrays.NDArray[np.uint16]:
    """Return Z, linear sRGB (H, W, 3); the photograph's own white balance serves where none is given."""
    white_balance = balance(path) if white_balance is None else white_balance
    with _open(path) as file:
        matrix = file.color_matrix[:, :3].astype(np.float32)
        alike = {
            "gamma": (1, 1),
            "no_auto_bright": True,
            "adjust_maximum_thr": 0.0,
            "output_bps": 16,
        }
        sensor = optional.rawpy.ColorSpace.raw
        camera = file.postprocess(output_color=sensor, user_wb=list(white_balance), **alike)
    return to_srgb(camera, matrix)


def to_srgb(camera: arrays.NDArray[np.uint16], matrix: arrays.F32) -> arrays.NDArray[np.uint16]:
    """Return the camera's colours as sRGB's, Z = M camera, and white where any of them is clipped."""
    Z = np.empty_like(camera)
    for y in range(
        0, len(camera), BAND_ROWS
    ):  # of a whole photograph the float values would fill the memory
        band = camera[y : y + BAND_ROWS]
        mixed = np.clip(np.rint(band @ matrix.T), 0, WHITE_LEVEL)
        Z[y : y + BAND_ROWS] = np.where(
            (band == WHITE_LEVEL).any(axis=-1, keepdims=True), WHITE_LEVEL, mixed
        )
    return Z


@contextmanager
def _open(path: str | Path) -> Iterator[Any]:
    with open(path, "rb") as stream:  # a missing file is a FileNotFoundError here as elsewhere
        packed = JPEG_XL.search(stream.read(1 << 18))
    try:
        with optional.rawpy.imread(str(path)) as file:
            yield file
    except (optional.rawpy.LibRawError, optional.rawpy.NotSupportedError) as error:
        reason = error.args[0].decode() if isinstance(error.args[0], bytes) else error
        reason = "it does not read JPEG XL, set the camera to lossless JPEG" if packed else reason
        raise InputError(f"{path}: expected a RAW photograph, LibRaw says: {reason}") from None
