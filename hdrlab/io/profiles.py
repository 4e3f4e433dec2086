"""Convert pixels to sRGB by their ICC profile, through LittleCMS in imagecodecs.

A profile states how pixel values become linear light, and which colors its primaries are. Values of
Display P3 or Adobe RGB become linear light by their own curve. A matrix converts that light to the
primaries of sRGB, and the curve of sRGB turns it into the values that the camera would have written
had it been set to sRGB. Where only the curve differs, and in gray photos, the values stay: a curve
is part of the response that a bracket shows.
"""

import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import ImageCms

from hdrlab.core import arrays, colour, optional
from hdrlab.errors import InputError

# Stands for the profile of a photo without one, whose EXIF states Adobe RGB (R03).
ADOBE = b"adobergb"
# Stands for the profile of a JPEG XL file that states Display P3 by a number.
DISPLAY_P3 = b"displayp3"
# x, y and Y of red, green and blue, and of white, which is D65 [SMPTE EG 432-1].
DISPLAY_P3_PRIMARIES = (0.68, 0.32, 1, 0.265, 0.69, 1, 0.15, 0.06, 1)
DISPLAY_P3_WHITE = (0.3127, 0.329, 1)
CURVE_SAMPLES = 4096
# XYZ of red, green and blue under D50, as in profiles of sRGB [ICC.1:2022 annex E, IEC 61966-2-1].
SRGB_COLORANTS = (
    (0.4361, 0.2225, 0.0139),
    (0.3851, 0.7169, 0.0971),
    (0.1431, 0.0606, 0.7141),
)
COLORANT_TOLERANCE = 0.005
# Values of each channel that are tried together, and how far from a product of curves and a matrix
# the light may be.
TESTED_VALUES = 5
TABLE_TOLERANCE = 1e-4
# Gray values, up to white, whose light shows whether a curve is a straight line.
TESTED_GRAYS = (0.18, 0.5, 1.0)
LINEARITY_TOLERANCE = 0.005
# Below this determinant of their XYZ, three colorants are no primaries: sRGB's have 0.2.
MIN_COLORANT_DETERMINANT = 1e-3


@dataclass(frozen=True)
class LinearPixels:
    """Linear light in the primaries that the pixels have in the file.

    Attributes
    ----------
    light
        (H, W, 3) or (H, W) float32, 1 = white.
    to_srgb
        (3, 3) the matrix from these primaries to those of sRGB.
    """

    light: arrays.F32
    to_srgb: arrays.F64


def to_srgb(path: str | Path, pixels: arrays.Array, icc: bytes) -> arrays.Array:
    """Return pixels (H, W, 3), uint8 or uint16, converted from a profile to sRGB; gray ones stay.

    Raises
    ------
    InputError
        Naming `path`, for a profile that is damaged or not of RGB.
    """
    try:
        if pixels.ndim == 2 or _is_srgb(icc):
            return pixels
        return _convert(pixels, icc)
    except ModuleNotFoundError:
        raise
    except Exception as error:  # on damaged profiles LittleCMS raises exceptions of any type
        raise InputError(f"{path}: its color profile is damaged or not for RGB ({error})") from None


def to_linear(path: str | Path, pixels: arrays.Array, icc: bytes) -> LinearPixels:
    """Return the linear light of pixels in their own primaries, which cuts no color.

    Gray pixels, and those with the primaries of sRGB, are decoded by the curve of sRGB, as `to_srgb`
    leaves them.

    Parameters
    ----------
    path
        The file, for messages.
    pixels
        (H, W, 3) or (H, W) uint8 or uint16.
    icc
        The profile of the pixels, empty for sRGB.

    Raises
    ------
    InputError
        Naming `path`, for a profile that is damaged or not of RGB.
    """
    matrix = np.eye(3) if pixels.ndim == 2 else primaries_to_srgb(path, icc)
    if np.array_equal(matrix, np.eye(3)):
        scale = np.float32(np.iinfo(pixels.dtype).max)
        return LinearPixels(colour.decode_srgb(pixels / scale), np.eye(3))
    tables = _make_tables(pixels.dtype, icc)
    if tables is None:
        return LinearPixels(_to_light(np.ascontiguousarray(pixels), icc), matrix)
    light = np.empty(pixels.shape, np.float32)
    for channel, table in enumerate(tables):
        light[..., channel] = table[pixels[..., channel]]
    return LinearPixels(light, matrix)


def primaries_to_srgb(path: str | Path, icc: bytes) -> arrays.F64:
    """Return the matrix (3, 3) from the primaries of a profile to those of sRGB.

    It is meant for columns (R, G, B) of linear light. No profile stands for sRGB.

    Raises
    ------
    InputError
        Naming `path`, for a profile that is damaged or not of RGB.
    """
    try:
        if not icc or _is_srgb(icc):
            return np.eye(3)
        srgb = optional.imagecodecs.cms_profile("srgb")
        matrix = np.linalg.solve(_colorants(srgb).T, _colorants(icc).T)
        return matrix.astype(np.float64)
    except ModuleNotFoundError:
        raise
    except Exception as error:  # on damaged profiles LittleCMS raises exceptions of any type
        raise InputError(f"{path}: its color profile is damaged or not for RGB ({error})") from None


def find_primaries(path: str | Path, icc: bytes) -> tuple[float, ...] | None:
    """Return x and y of red, green, blue and white of a profile, or None for those of sRGB.

    They are adapted to D50, the white of profiles.

    Raises
    ------
    InputError
        Naming `path`, for a profile that is damaged or not of RGB.
    """
    if np.array_equal(primaries_to_srgb(path, icc), np.eye(3)):
        return None
    colorants = _colorants(icc)
    XYZ = np.vstack([colorants, colorants.sum(axis=0)])
    xy = XYZ[:, :2] / XYZ.sum(axis=1, keepdims=True)
    return tuple(map(float, xy.ravel()))


def is_linear(icc: bytes) -> bool:
    """Return whether the curve of a profile of RGB is a straight line."""
    grays = np.array(TESTED_GRAYS, np.float32)
    pixels = np.repeat(grays[None, :, None], 3, axis=2)
    Y = _to_xyz(pixels, icc)[0, :, 1]
    return np.allclose(Y / Y[-1], grays, atol=LINEARITY_TOLERANCE)


def _make_tables(dtype: np.dtype[Any], icc: bytes) -> arrays.F32 | None:
    """Return the light (3, n) of each value of each channel, or None if channels influence each other.

    Most profiles are a curve for each channel and a matrix. For them tables are faster than
    LittleCMS.
    """
    count = np.iinfo(dtype).max + 1
    ramps = np.zeros((3, count, 3), dtype)
    for channel in range(3):
        ramps[channel, :, channel] = np.arange(count)
    light = _to_light(ramps, icc)
    tables = np.stack([light[channel, :, channel] for channel in range(3)])
    # A few colors show whether the channels are independent.
    values = np.linspace(0, count - 1, TESTED_VALUES).astype(dtype)
    colors = np.stack(np.meshgrid(values, values, values), axis=-1).reshape(1, -1, 3)
    by_tables = np.stack([tables[channel][colors[..., channel]] for channel in range(3)], axis=-1)
    return tables if np.allclose(by_tables, _to_light(colors, icc), atol=TABLE_TOLERANCE) else None


def _to_light(pixels: arrays.Array, icc: bytes) -> arrays.F32:
    """Return the linear light of RGB pixels (H, W, 3) in the primaries of their profile."""
    return _to_xyz(pixels, icc) @ np.linalg.inv(_colorants(icc)).astype(np.float32)


def _colorants(icc: bytes) -> arrays.F64:
    """Return XYZ (3, 3) under D50 of full red, green and blue, one a row."""
    primaries = np.eye(3, dtype=np.float32)[None]
    colorants = _to_xyz(primaries, icc)[0].astype(np.float64)
    if not abs(np.linalg.det(colorants)) > MIN_COLORANT_DETERMINANT:
        raise InputError("its red, green and blue are not independent")
    return colorants


def _to_xyz(pixels: arrays.Array, icc: bytes) -> arrays.F32:
    """Return XYZ (H, W, 3) float32 under D50 of RGB pixels."""
    cms = optional.imagecodecs
    return cms.cms_transform(
        pixels,
        _source_profile(icc),
        cms.cms_profile("xyz"),
        colorspace="rgb",
        outcolorspace="xyz",
        outdtype="float32",
        flags=cms.CMS.FLAGS.NOOPTIMIZE,
    )


def _is_srgb(icc: bytes) -> bool:
    """Return whether a profile has the primaries of sRGB, with any curve."""
    if icc in (ADOBE, DISPLAY_P3):
        return False
    profile = ImageCms.ImageCmsProfile(io.BytesIO(icc)).profile
    colorants = []
    for colorant in (profile.red_colorant, profile.green_colorant, profile.blue_colorant):
        if not colorant:
            return False
        xyz, _ = colorant
        colorants.append(xyz)
    return np.allclose(colorants, SRGB_COLORANTS, atol=COLORANT_TOLERANCE)


def _convert(pixels: arrays.Array, icc: bytes) -> arrays.Array:
    """Return RGB pixels converted to sRGB by LittleCMS."""
    # LittleCMS is quick with tables. They are right to one value of 255 for 8 bits, and off by up
    # to 19 values for 16 bits.
    flags = 0 if pixels.dtype == np.uint8 else optional.imagecodecs.CMS.FLAGS.NOOPTIMIZE
    return optional.imagecodecs.cms_transform(
        np.ascontiguousarray(pixels),
        _source_profile(icc),
        optional.imagecodecs.cms_profile("srgb"),
        colorspace="rgb",
        outcolorspace="rgb",
        flags=flags,
    )


def _source_profile(icc: bytes) -> bytes:
    """Return the profile itself, or the one for which ADOBE or DISPLAY_P3 stands."""
    if icc == ADOBE:
        return optional.imagecodecs.cms_profile("adobergb")
    if icc == DISPLAY_P3:
        values = np.linspace(0, 1, CURVE_SAMPLES, dtype=np.float32)
        return optional.imagecodecs.cms_profile(
            "rgb",
            whitepoint=DISPLAY_P3_WHITE,
            primaries=DISPLAY_P3_PRIMARIES,
            transferfunction=colour.decode_srgb(values),
        )
    return icc
