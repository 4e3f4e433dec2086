"""How much light a photograph was given, as its EXIF says.

t   shutter time    seconds
N   f-number        focal length over aperture
S   ISO speed       what the sensor's signal was amplified by, 100 = 1
Tv, Av   the APEX values (EXIF 2.3, annex C), t = 2^-Tv and N = 2^(Av / 2)

The equivalent exposure t S / N^2 is given in seconds at the first photograph's S and N. The
exposure bias of EXIF is never used: it says what the photographer wished for, not what the camera
did.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from PIL import ExifTags, Image

from hdrlab.errors import InputError

HINT = "give them by --times FILE (times= in Python), or without a list by --stops 2 or --times estimate"
SHUTTER, SHUTTER_APEX = ExifTags.Base.ExposureTime, ExifTags.Base.ShutterSpeedValue
APERTURE, APERTURE_APEX = ExifTags.Base.FNumber, ExifTags.Base.ApertureValue
SPEEDS = (
    ExifTags.Base.ISOSpeedRatings,
    34867,
    34866,
    34865,
)  # and ISO speed, recommended index, output
UNKNOWN_SPEED = 65535  # what the first tag holds when the speed does not fit its 16 bits


class Exposure(NamedTuple):
    """What a photograph or a list says: seconds, f-number and ISO, each None where it says nothing."""

    seconds: float | None = None
    f_number: float | None = None
    iso: float | None = None


def exif_exposure(exif: Image.Exif) -> Exposure:
    """Return the Exposure that EXIF states; the APEX values serve where the plain ones are missing.

    An f-number of 0 is a lens without contacts, and its APEX value says nothing either.
    """
    tags = {**dict(exif), **dict(exif.get_ifd(ExifTags.IFD.Exif))}
    speeds = (positive(tags.get(tag)) for tag in SPEEDS)
    speed = next((speed for speed in speeds if speed and speed != UNKNOWN_SPEED), None)
    seconds = positive(tags.get(SHUTTER)) or _apex(tags.get(SHUTTER_APEX), lambda Tv: 2**-Tv)
    stated = APERTURE in tags
    N = (
        positive(tags[APERTURE])
        if stated
        else _apex(tags.get(APERTURE_APEX), lambda Av: 2 ** (Av / 2))
    )
    return Exposure(seconds, N, speed)


def equivalent(names: Sequence[str], exposures: Sequence[Exposure]) -> list[float]:
    """Return t S / N^2 in seconds, relative to the first photograph's S and N.

    Where no photograph states S, or none states N, it is taken to be the same in all.

    Raises
    ------
    ValueError
        Where a time is missing, or S or N is known of some photographs only.
    """
    if untimed := [name for name, one in zip(names, exposures, strict=True) if one.seconds is None]:
        raise InputError(
            f"{untimed[0]}: expected an exposure time in its EXIF, there is none; {HINT}"
        )
    seconds = [exposure.seconds for exposure in exposures if exposure.seconds is not None]
    stops = _alike(names, [exposure.f_number for exposure in exposures], "f-number")
    speeds = _alike(names, [exposure.iso for exposure in exposures], "ISO speed")
    return [
        t * (S / speeds[0]) * (stops[0] / N) ** 2
        for t, S, N in zip(seconds, speeds, stops, strict=True)
    ]


def _alike(names: Sequence[str], values: Sequence[float | None], what: str) -> list[float]:
    """Return the values where all are known, or 1 for each where none is."""
    known = [value for value in values if value is not None]
    if known and len(known) < len(values):
        missing = names[values.index(None)]
        raise InputError(
            f"{missing[:200]}: expected the {what}, which other photographs state; {HINT}"
        )
    return known or [1.0] * len(values)


def positive(value: Any) -> float | None:
    """Return a tag or a text as a number, or None where it is none, 0 (no contacts in the lens), or n/0.

    Examples
    --------
    >>> positive("0.5"), positive(0)
    (0.5, None)
    """
    number = _number(value[0] if isinstance(value, tuple | list) and value else value)
    return number if 1e-12 < number < 1e12 else None


def _apex(value: Any, meaning: Callable[[float], float]) -> float | None:
    """Return what an APEX value means, or None; 0 and negative ones are as good as others."""
    apex = _number(value)
    return meaning(apex) if abs(apex) < 40 else None


def _number(value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError, ArithmeticError):
        return math.nan
