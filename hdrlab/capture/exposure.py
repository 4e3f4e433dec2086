"""Exposure: what shutter, aperture, speed and filters do to the light (Battiato et al. 2008).

T   shutter time     s
F   f-number         focal length over aperture; the light that passes goes with 1 / F^2
S   ISO speed        100 is the reference
D   optical density  of a filter, which lets 10^-D of the light through
L   luminance        cd/m^2: of a surface, in one direction; the same from near and far
E   irradiance       lx: what the sensor gets of it, from the whole aperture
EV  exposure value   stops: one more is half the light

A dial says 1/60 and the shutter opens for 1/64 s: the series is one of powers of two, and its names
are rounded so that people can say them. Times taken from names are wrong by up to 7 %, and a
calibration sees it.
"""

from collections.abc import Iterable
from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np

from hdrlab.core.arrays import F64, NDArray
from hdrlab.errors import InputError

Real = float | NDArray[np.floating[Any]]

# What the dial says, from bright to dark in thirds of a stop; every third one is a full stop.
SHUTTER = """
    30 25 20 15 13 10 8 6 5 4 3.2 2.5 2 1.6 1.3 1 0.8 0.6 1/2 0.4 0.3 1/4 1/5 1/6 1/8 1/10 1/13 1/15
    1/20 1/25 1/30 1/40 1/50 1/60 1/80 1/100 1/125 1/160 1/200 1/250 1/320 1/400 1/500 1/640 1/800
    1/1000 1/1250 1/1600 1/2000 1/2500 1/3200 1/4000 1/5000 1/6400 1/8000
"""
# stops: the dial's 30 is 2^5 s
LONGEST_STOP = 5
# lx s at ISO 1 [ISO 12232]
SATURATION_EXPOSURE = 78.0
# of the light, through a usual lens
LENS_TRANSMITTANCE = 0.65


class Dial(NamedTuple):
    """A series of settings: what is written on the dial, and what it does."""

    names: tuple[str, ...]
    values: F64


def shutter_series(per_stop: int = 1) -> Dial:
    """Return the shutter times of a dial, long to short: names, and true seconds 2^(5 - k / per_stop).

    Examples
    --------
    >>> dial = shutter_series()
    >>> dial.names[11], float(1 / dial.values[11])
    ('1/60', 64.0)
    """
    if per_stop not in (1, 3):
        raise InputError(f"expected a dial of 1 or 3 settings per stop, got {per_stop}")
    chosen = tuple(SHUTTER.split()[:: 3 // per_stop])
    return Dial(chosen, 2.0 ** (LONGEST_STOP - np.arange(len(chosen)) / per_stop))


def seconds(name: str) -> float:
    """Return what a shutter's name says, 1/60 or 0.6 or 30, as a number of seconds.

    Raises
    ------
    ValueError
        For a text that is no positive time.
    """
    over, slash, under = name.strip().removesuffix("s").partition("/")
    try:
        time = float(over) / (float(under) if slash else 1.0)
    except (ValueError, ZeroDivisionError):
        time = 0.0
    if not 0 < time < np.inf:
        raise InputError(f"expected a shutter time such as 1/60 or 2, got {name!r}")
    return time


def true_time(nominal: float) -> float:
    """Return how long a shutter marked `nominal` seconds is open: the power 2^(k/3) whose name is nearest.

    Examples
    --------
    >>> 1 / true_time(1 / 60), 1 / true_time(1 / 125), true_time(30)
    (64.0, 128.0, 32.0)
    """
    require_positive(("shutter time", nominal))
    dial = shutter_series(3)
    marked = np.array([seconds(name) for name in dial.names])
    return float(dial.values[np.argmin(np.abs(np.log(marked / nominal)))])


def read_dial(names: Iterable[str]) -> Dial:
    """Return the shutter times among the settings of a camera, and their true seconds.

    Examples
    --------
    >>> dial = read_dial(["bulb", "1/60", "0.25s"])
    >>> dial.names, dial.values.tolist()
    (('1/60', '0.25s'), [0.015625, 0.25])
    """
    marked = dict[str, float]()
    for name in names:
        with suppress(ValueError):
            marked[name] = seconds(name)
    true = [(t, true_time(t)) for t in marked.values()]
    return Dial(tuple(marked), np.array([T if abs(np.log2(T / t)) < 1 / 6 else t for t, T in true]))


def ev(F: Real, T: Real, *, S: Real = 100.0) -> Real:
    """Return EV = 2 log2 F - log2 T - log2(S / 100) [Battiato08 eq. 1.1; the speed as a third setting].

    Parameters
    ----------
    F, T, S : f-number, seconds, ISO speed

    Returns
    -------
    EV, stops: of the settings at ISO 100, or of the scene that they suit (its EV at ISO 100)

    Raises
    ------
    ValueError
        For a setting that is not positive.

    Examples
    --------
    >>> float(ev(1, 1)), float(ev(8, 1 / 64)), float(ev(8, 1 / 64, S=400))
    (0.0, 12.0, 10.0)
    """
    require_positive(("f-number", F), ("shutter time", T), ("ISO speed", S))
    return 2 * np.log2(F) - np.log2(T) - np.log2(S / 100)


def stops(more: Real, less: Real) -> Real:
    """Return log2(more / less): by how many stops one amount of light exceeds another."""
    require_positive(("amount", more), ("amount", less))
    return np.log2(more / less)


def equivalent_time(T: Real, F: Real, F_new: Real, *, S: float = 100, S_new: float = 100) -> Real:
    """Return T' = T (F' / F)^2 S / S': the time that gives the same exposure with other settings.

    Examples
    --------
    >>> float(equivalent_time(1 / 64, 8, 16))
    0.0625
    """
    require_positive(("shutter time", T), ("f-number", F), ("f-number", F_new))
    require_positive(("ISO speed", S), ("ISO speed", S_new))
    return T * (F_new / F) ** 2 * S / S_new


def irradiance(L: Real, F: Real, *, angle: Real = 0.0) -> Real:
    """Return E = L (pi / 4) (d / h)^2 cos^4 phi: what a surface of luminance L gives the sensor.

    Parameters
    ----------
    L, F : cd/m^2, and the f-number h / d, focal length over the width of the aperture
    angle : phi, radians, between the ray through the middle of the lens and its axis

    Returns
    -------
    E : lx, of a lens that swallows nothing

    Raises
    ------
    ValueError
        For an f-number that is not positive.

    References
    ----------
    Mitsunaga and Nayar, Radiometric self calibration, CVPR 1999, eq. 1.

    Examples
    --------
    >>> float(irradiance(1000, 1).round()), float(irradiance(1000, 1, angle=np.pi / 4).round())
    (785.0, 196.0)
    """
    require_positive(("f-number", F))
    return np.asarray(L) * np.pi / 4 / np.asarray(F) ** 2 * np.cos(angle) ** 4


def transmittance(D: Real) -> Real:
    """Return 10^-D, the share of the light that a neutral density filter passes: ND 0.3 passes a half."""
    return 10.0 ** -np.asarray(D, np.float64)


def density(stops: Real) -> Real:
    """Return D = n log10 2, the density of a filter that takes n stops."""
    return np.asarray(stops, np.float64) * np.log10(2)


def saturating_luminance(T: Real, *, F: float = 8.0, S: Real = 100.0) -> Real:
    """Return L = 78 F^2 / (0.65 S T), cd/m^2, which just fills the levels [ISO 12232, saturation speed].

    Examples
    --------
    >>> round(float(saturating_luminance(1 / 128, F=8, S=100)))
    9830
    """
    require_positive(("shutter time", T), ("f-number", F), ("ISO speed", S))
    return SATURATION_EXPOSURE * F**2 / (LENS_TRANSMITTANCE * S * T)


def require_positive(*settings: tuple[str, Real]) -> None:
    """Raise a ValueError that names the first setting that is not positive and finite."""
    for what, value in settings:
        if not np.all(np.greater(value, 0) & np.isfinite(value)):
            raise InputError(f"expected a positive {what}, got {value}")
