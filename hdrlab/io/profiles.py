"""Convert pixels to sRGB by their ICC profile, through LittleCMS in imagecodecs.

A profile states how pixel values become linear light, and which colors its primaries are. Values of
Display P3 or Adobe RGB become linear light by their own curve. A matrix converts that light to the
primaries of sRGB, and the curve of sRGB turns it into the values that the camera would have written
had it been set to sRGB. Where only the curve differs, and in gray photos, the values stay: a curve
is part of the response that a bracket shows.
"""

import io
from pathlib import Path

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
