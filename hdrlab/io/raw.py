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
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hdrlab.core import arrays, optional
from hdrlab.errors import FileFormatError, InputError
from hdrlab.io.exif_exposure import Exposure
from hdrlab.io.files import check_size, replacing

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

# Photometric interpretation of a DNG whose pixels have one color filter each [DNG 1.7.1].
PHOTOMETRIC_CFA = 32803
# Numerator and denominator of the rational numbers that we write.
DENOMINATOR = 1_000_000

Balance = tuple[float, float, float, float]


@dataclass(frozen=True, kw_only=True)
class RawMosaic:
    """A RAW photo before demosaicing, and what its file says about it.

    Attributes
    ----------
    levels : (H, W) uint16, one color filter each; not rotated, whatever the file's orientation is
    pattern : (2, 2) int, channels of the filters at the top left corner: 0 red, 1 green, 2 blue
    black : level of no light; a number, or (H, W) where the four filters have different ones
    white : level at which a pixel is full
    gains : (3,) of the white balance that the camera chose, green 1
    conversion : (3, 3), from balanced channels of the camera to linear sRGB, as LibRaw computes it
    """

    levels: arrays.NDArray[np.uint16]
    pattern: arrays.Indices
    black: arrays.ArrayLike
    white: float
    gains: arrays.F64
    conversion: arrays.F64


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


def read_mosaic(path: str | Path) -> RawMosaic:
    """Read the levels of a RAW photo before demosaicing, with its pattern, gains and matrix.

    `capture.development.develop` makes an image of them.

    Raises
    ------
    FileFormatError
        For a file that LibRaw cannot read, or a sensor without a Bayer pattern.
    """
    white_balance = np.array(balance(path)[:3])
    with _open(path) as file:
        if file.num_colors != 3 or file.raw_pattern is None or file.raw_pattern.shape != (2, 2):
            raise FileFormatError(
                f"{path}: expected a Bayer pattern of red, green and blue; read it with read_photo"
            )
        filters = file.raw_colors_visible
        black_levels = np.array(file.black_level_per_channel, np.float32)
        has_one_black_level = np.ptp(black_levels) == 0
        channel_of_filter = np.array([0, 1, 2, 1])  # LibRaw counts the second green as 3
        return RawMosaic(
            levels=file.raw_image_visible.copy(),
            pattern=channel_of_filter[filters[:2, :2]],
            black=float(black_levels[0]) if has_one_black_level else black_levels[filters],
            white=float(file.white_level),
            gains=white_balance / white_balance[1],
            conversion=file.color_matrix[:, :3].astype(np.float64),
        )


def write_dng(
    path: str | Path,
    levels: arrays.NDArray[np.uint16],
    *,
    pattern: arrays.ArrayLike,
    black: int,
    white: int,
    gains: arrays.ArrayLike,
    matrix: arrays.ArrayLike,
    exposure: Exposure | None = None,
    camera: str = "hdrlab",
) -> None:
    """Write a RAW photo as a DNG, which LibRaw and RAW developers can open, whole or not at all.

    Parameters
    ----------
    path : the file; what it held is replaced
    levels : (H, W) uint16, one color filter each
    pattern : (2, 2) int, channels of the filters at the top left corner: 0 red, 1 green, 2 blue
    black, white : levels of no light and of full pixels
    gains : (3,) of white balance, only their ratios count
    matrix : (3, 3), from XYZ under D65 to the channels of the camera
    exposure : time, f-number and ISO speed that the file states, as far as they are known
    camera : model that the file states

    Raises
    ------
    InputError
        For levels of another kind.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "gray.dng"
    >>> levels = np.full((64, 64), 1000, np.uint16)
    >>> numbers = dict(pattern=[[0, 1], [1, 2]], black=64, white=4095, matrix=np.eye(3))
    >>> write_dng(path, levels, **numbers, gains=[2, 1, 1.5])
    >>> path.stat().st_size > levels.nbytes
    True
    """
    levels = np.asarray(levels)
    if levels.ndim != 2 or levels.dtype != np.uint16:
        raise InputError(f"expected RAW levels (H, W) uint16, got {arrays.describe(levels)}")
    gray = np.min(gains) / np.asarray(gains, np.float64)
    tags = [
        (33421, "H", 2, (2, 2), True),  # rows and columns of the pattern
        (33422, "B", 4, tuple(np.ravel(pattern).tolist()), True),  # the pattern
        (50706, "B", 4, (1, 4, 0, 0), True),  # version of DNG
        (272, "s", 0, camera, True),  # model of the camera
        (50708, "s", 0, camera, True),  # the same for programs that read DNG only
        (50714, "H", 1, black, True),
        (50717, "H", 1, white, True),
        (50721, "2i", 9, _as_rationals(matrix), True),
        (50728, "2I", 3, _as_rationals(gray), True),  # a gray card in the camera's channels
        (50778, "H", 1, 21, True),  # the light of the matrix, D65
        *_exposure_tags(exposure or Exposure()),
    ]
    with replacing(path) as name:
        optional.tifffile.imwrite(
            name,
            levels,
            photometric=PHOTOMETRIC_CFA,
            extratags=tags,
            metadata=None,
            software=False,
        )


def _exposure_tags(exposure: Exposure) -> list[tuple[int, str, int, object, bool]]:
    """Return the tags for the parts of an exposure that are known [TIFF/EP]."""
    tags: list[tuple[int, str, int, object, bool]] = []
    if exposure.seconds is not None:
        tags.append((33434, "2I", 1, _as_rationals([exposure.seconds]), True))
    if exposure.f_number is not None:
        tags.append((33437, "2I", 1, _as_rationals([exposure.f_number]), True))
    if exposure.iso is not None:
        tags.append((34855, "H", 1, round(exposure.iso), True))
    return tags


def _as_rationals(values: arrays.ArrayLike) -> tuple[int, ...]:
    """Return numerators and denominators, one after the other, as TIFF stores numbers."""
    pairs = [(round(float(value) * DENOMINATOR), DENOMINATOR) for value in np.ravel(values)]
    return tuple(number for pair in pairs for number in pair)


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
