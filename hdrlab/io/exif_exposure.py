"""The exposure of a photo, as its EXIF states it.

t       exposure time, in seconds
N       f-number, focal length over aperture
S       ISO speed, 100 = 1
Tv, Av  APEX values (EXIF 2.3, annex C): t = 2^-Tv and N = 2^(Av / 2)

The equivalent exposure t S / N^2 is given in seconds at the S and N of the first photo. EXIF's
exposure bias is never used: it states what the photographer asked for, not what the camera did.
"""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from PIL import Image
from PIL.ExifTags import IFD, Base

from hdrlab.errors import InputError

HINT = "pass --times FILE (times= in Python), or, without a list, --stops 2 or --times estimate"
# The first of these that states a speed is used.
ISO_TAGS = (
    Base.ISOSpeedRatings,
    Base.ISOSpeed,
    Base.RecommendedExposureIndex,
    Base.StandardOutputSensitivity,
)
# What ISOSpeedRatings holds if the speed does not fit into its 16 bits.
UNKNOWN_ISO = 65535
MAX_APEX = 40
# cd/m^2: the calibration constant K of exposure meters for reflected light, ISO 2720
METER_CONSTANT = 12.5
# An upper bound of a scene's luminance assumes these where EXIF states no f-number or no ISO speed:
# smaller apertures blur by diffraction, and few cameras have a lower speed.
MAX_USUAL_F_NUMBER = 11.0
MIN_USUAL_ISO = 100.0
MIN_VALUE = 1e-12
MAX_VALUE = 1e12


class Exposure(NamedTuple):
    """The exposure that a photo or a list states: each value is None if it states none."""

    seconds: float | None = None
    f_number: float | None = None
    iso: float | None = None

    def fill_from(self, other: "Exposure") -> "Exposure":
        """Return this exposure with the missing values of another source."""
        return Exposure(
            *(
                mine if mine is not None else theirs
                for mine, theirs in zip(self, other, strict=True)
            )
        )


def read_exposure(exif: Image.Exif) -> Exposure:
    """Return the exposure that EXIF states; APEX values serve where the plain ones are missing.

    An f-number of 0 means a lens without contacts; its APEX value is not used either.
    """
    tags = {**dict(exif), **dict(exif.get_ifd(IFD.Exif))}
    seconds = positive(tags.get(Base.ExposureTime))
    if seconds is None:
        Tv = _apex(tags.get(Base.ShutterSpeedValue))
        seconds = None if Tv is None else 2**-Tv
    if Base.FNumber in tags:
        f_number = positive(tags[Base.FNumber])
    else:
        Av = _apex(tags.get(Base.ApertureValue))
        f_number = None if Av is None else 2 ** (Av / 2)
    return Exposure(seconds, f_number, _read_iso(tags))


def _read_iso(tags: dict[int, Any]) -> float | None:
    for tag in ISO_TAGS:
        speed = positive(tags.get(tag))
        if speed is not None and speed != UNKNOWN_ISO:
            return speed
    return None


def equivalent_seconds(names: Sequence[str], exposures: Sequence[Exposure]) -> list[float]:
    """Return t S / N^2 in seconds, relative to the S and N of the first photo.

    If no photo states S, or none states N, it is taken to be the same in all of them.

    Raises
    ------
    InputError
        If a time is missing, or if only some photos state S or N.
    """
    times = []
    for name, exposure in zip(names, exposures, strict=True):
        if exposure.seconds is None:
            raise InputError(f"{name}: no exposure time in EXIF; {HINT}")
        times.append(exposure.seconds)
    f_numbers = _all_or_none(names, [exposure.f_number for exposure in exposures], "f-number")
    speeds = _all_or_none(names, [exposure.iso for exposure in exposures], "ISO speed")
    return [
        t * (S / speeds[0]) * (f_numbers[0] / N) ** 2
        for t, S, N in zip(times, speeds, f_numbers, strict=True)
    ]


def fill_missing(
    names: Sequence[str], exposures: Sequence[Exposure]
) -> tuple[list[Exposure], list[str]]:
    """Give photos that state no f-number or no ISO speed the value that all others state, with a note.

    Where the others state different values, or none, nothing is filled.

    Examples
    --------
    >>> fill_missing(["a.jpg", "b.jpg"], [Exposure(1, 4, 100), Exposure(2, None, 100)])[0][1]
    Exposure(seconds=2, f_number=4, iso=100)
    """
    filled = list(exposures)
    notes = []
    for field, what in ("f_number", "f-number"), ("iso", "ISO speed"):
        values = [getattr(exposure, field) for exposure in exposures]
        stated = {value for value in values if value is not None}
        missing = [j for j, value in enumerate(values) if value is None]
        if len(stated) != 1 or not missing:
            continue
        value = stated.pop()
        for j in missing:
            filled[j] = filled[j]._replace(**{field: value})
        listed = ", ".join(names[j] for j in missing)
        notes.append(
            f"{listed}: no {what} in EXIF; hdrlab assumes {value:g}, as in all other photos"
        )
    return filled, notes


def luminance_of_unit(exposures: Sequence[Exposure]) -> float | None:
    """Return the luminance in cd/m^2 that gets a middle pixel value in one second, or None.

    The f-number N and the ISO speed S are those to which `equivalent_seconds` refers. An exposure
    meter gives a luminance L = K N^2 / (t S) a middle gray. Cameras depart from this by up to about
    one stop. The result is None if no photo states N, or none states S.

    Examples
    --------
    >>> luminance_of_unit([Exposure(1 / 60, 4, 200), Exposure(1 / 15, 4, 200)])
    1.0
    """
    f_number = _first_known([exposure.f_number for exposure in exposures])
    iso = _first_known([exposure.iso for exposure in exposures])
    if f_number is None or iso is None:
        return None
    return METER_CONSTANT * f_number**2 / iso


def max_luminance_of_unit(exposures: Sequence[Exposure]) -> float | None:
    """Return an upper bound of `luminance_of_unit` in cd/m^2 where N or S is unknown, or None.

    A photo of 30 seconds that is not white does not show a daylight scene, whatever its f-number and
    ISO speed are. An unknown f-number is at most MAX_USUAL_F_NUMBER, and an unknown speed at least
    MIN_USUAL_ISO. The result is None if `luminance_of_unit` is known.

    Examples
    --------
    >>> max_luminance_of_unit([Exposure(1 / 2, 4, None), Exposure(8, 4, None)])
    2.0
    """
    if luminance_of_unit(exposures) is not None:
        return None
    f_number = _first_known([exposure.f_number for exposure in exposures])
    iso = _first_known([exposure.iso for exposure in exposures])
    if f_number is None:
        f_number = MAX_USUAL_F_NUMBER
    if iso is None:
        iso = MIN_USUAL_ISO
    return METER_CONSTANT * f_number**2 / iso


def _first_known(values: Sequence[float | None]) -> float | None:
    return next((value for value in values if value is not None), None)


def _all_or_none(names: Sequence[str], values: Sequence[float | None], what: str) -> list[float]:
    """Return the values if all are known, or 1 for each if none is."""
    known = [value for value in values if value is not None]
    if not known:
        return [1.0] * len(values)
    if len(known) < len(values):
        name = names[values.index(None)]
        raise InputError(f"{name[:200]}: no {what} in EXIF, unlike the other photos; {HINT}")
    return known


def positive(value: Any) -> float | None:
    """Return a tag or a text as a positive number, or None if it is none.

    Examples
    --------
    >>> positive("0.5"), positive(0)
    (0.5, None)
    """
    if isinstance(value, tuple | list) and value:
        value = value[0]
    number = _as_float(value)
    return number if MIN_VALUE < number < MAX_VALUE else None


def _apex(value: Any) -> float | None:
    """Return an APEX value, which may be 0 or negative, or None if there is none."""
    apex = _as_float(value)
    return apex if abs(apex) < MAX_APEX else None


def _as_float(value: Any) -> float:
    """Return a value as a number, or NaN."""
    try:
        return float(value)
    except (TypeError, ValueError, ArithmeticError):
        return math.nan
