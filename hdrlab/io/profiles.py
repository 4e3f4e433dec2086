"""Colours by their ICC profile, through LittleCMS in imagecodecs.

A profile says how levels become linear light and which colours the primaries have. So levels of
Display P3 or of Adobe RGB become light by their own curve, that light is mixed anew for the
primaries of sRGB, and gets the curve of sRGB: the levels that the camera would have written had it
been set to sRGB. Where only the curve differs, or the picture is gray, the levels stay: a curve is
part of the response that a bracket shows.
"""

import io
from pathlib import Path
from typing import Any

import numpy as np
from PIL import ImageCms

from hdrlab.core import arrays, colour, optional
from hdrlab.errors import InputError

# stands for the profile of a camera that says Adobe RGB in EXIF, by R03, and holds none
ADOBE = b"adobergb"
# ... and for that of a JPEG XL, which says so by a number
DISPLAY_P3 = b"displayp3"
# x, y and Y of its red, green and blue, and of D65 [SMPTE EG 432-1]
PRIMARIES, WHITE = (0.68, 0.32, 1, 0.265, 0.69, 1, 0.15, 0.06, 1), (0.3127, 0.329, 1)
# XYZ of red, green and blue under D50, as profiles of sRGB have them [ICC.1:2022 annex E, IEC
# 61966-2-1]
SRGB = ((0.4361, 0.2225, 0.0139), (0.3851, 0.7169, 0.0971), (0.1431, 0.0606, 0.7141))


def to_srgb(path: str | Path, pixels: arrays.Array, icc: bytes) -> arrays.Array:
    """Return pixels (H, W, 3) uint8 or uint16 of that profile in sRGB; gray ones as they are.

    Raises
    ------
    ValueError
        For a profile that is damaged or not of RGB.
    """
    try:
        return pixels if pixels.ndim == 2 or _is_srgb(icc) else _convert(pixels, icc)
    except ModuleNotFoundError:
        raise
    except Exception as error:
        raise InputError(
            f"{path}: expected a colour profile of RGB, this one is damaged ({error})"
        ) from None


def _is_srgb(icc: bytes) -> bool:
    """Return whether a profile has the primaries of sRGB, whatever its curve."""
    if icc in (ADOBE, DISPLAY_P3):
        return False
    profile = ImageCms.ImageCmsProfile(io.BytesIO(icc)).profile
    colorants = (profile.red_colorant, profile.green_colorant, profile.blue_colorant)
    return all(colorants) and np.allclose([one[0] for one in colorants if one], SRGB, atol=0.005)


def _convert(pixels: arrays.Array, icc: bytes) -> arrays.Array:
    srgb = optional.imagecodecs.cms_profile("srgb")
    source = optional.imagecodecs.cms_profile("adobergb") if icc == ADOBE else icc
    if icc == DISPLAY_P3:
        curve = colour.decode_srgb(np.linspace(0, 1, 4096, dtype=np.float32))
        known: dict[str, Any] = {
            "whitepoint": WHITE,
            "primaries": PRIMARIES,
            "transferfunction": curve,
        }
        source = optional.imagecodecs.cms_profile("rgb", **known)
    # LittleCMS is quick by tables, which are right to a level of 255 for 8 bits, and off by 19 for
    # 16
    flags = 0 if pixels.dtype == np.uint8 else optional.imagecodecs.CMS.FLAGS.NOOPTIMIZE
    how = {"colorspace": "rgb", "outcolorspace": "rgb", "flags": flags}
    return optional.imagecodecs.cms_transform(np.ascontiguousarray(pixels), source, srgb, **how)
