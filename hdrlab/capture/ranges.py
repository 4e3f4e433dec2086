"""Dynamic range: how much of a scene fits into one photograph (Battiato et al. 2008, sec. 1.4.1).

L    luminance   of the scene, any linear unit; X = s t L, exposure, 1 fills the well
N    electrons   full_well X;  FWC, full well capacity;  NF, noise floor: the noise of a dark pixel
SNR  N over its noise; below 1 a pixel measures nothing
Z    level       of the converter
DR   log10(FWC / NF), decades: a decade is 3.32 stops, and 20 dB

A longer exposure does not widen the range, it moves it down: the shadows come out finer, and more
of the highlights are full. A shorter one loses the shadows, in noise and in steps that are too
coarse for them.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hdrlab.capture.sensor import Sensor, as_sensor, full_electrons
from hdrlab.core.arrays import F64, ArrayLike, Mask, NDArray, describe
from hdrlab.errors import InputError


class Range(NamedTuple):
    """One ratio in three units."""

    decades: float
    stops: float
    decibels: float


@dataclass(frozen=True, kw_only=True, eq=False)
class ExposedLevels:
    """What one exposure makes of each of K luminances.

    Attributes
    ----------
    Z : (K,) level
    snr : (K,) signal-to-noise ratio
    full : (K,) True where the pixel is full
    noise : (K,) True where the signal-to-noise ratio is below 1
    """

    Z: NDArray[np.int64]
    snr: F64
    full: Mask
    noise: Mask


def dynamic_range(high: float, low: float) -> Range:
    """Return DR = log10(high / low) [Battiato08 eq. 1.12], in decades, stops and decibels (20 per decade).

    Examples
    --------
    >>> dynamic_range(1000, 0.01)
    Range(decades=5.0, stops=16.609640474436812, decibels=100.0)
    """
    if not 0 < low <= high < np.inf:
        raise InputError(f"expected 0 < low <= high, got high {high} and low {low}")
    decades = float(np.log10(high) - np.log10(low))
    return Range(decades, decades / float(np.log10(2)), 20 * decades)


def noise_floor(sensor: Sensor) -> float:
    """Return NF = sqrt(read_noise^2 + K^2 / 12), electrons: what the amplifier and the rounding add."""
    sensor = as_sensor(sensor)
    return float(np.hypot(sensor.read_noise, sensor.gain / np.sqrt(12)))


def sensor_range(sensor: Sensor) -> Range:
    """Return the dynamic range of a sensor, FWC / NF.

    Examples
    --------
    >>> round(sensor_range(Sensor(full_well=20_000, read_noise=2, gain=5)).decades, 2)
    3.91
    """
    return dynamic_range(full_electrons(as_sensor(sensor)), noise_floor(sensor))


def snr(X: ArrayLike, sensor: Sensor) -> F64:
    """Return N / sqrt(N + NF^2), N = full_well X: photons, which come by chance, and the noise floor."""
    N = sensor.full_well * np.asarray(X, np.float64)
    return N / np.sqrt(N + noise_floor(sensor) ** 2)


def expose_levels(
    L: ArrayLike, time: float, sensor: Sensor, *, sensitivity: float = 1.0
) -> ExposedLevels:
    """Return what an exposure holds of luminances L (K,) [Battiato08 figures 1.10 to 1.12, as data].

    Levels are those without noise. Lost are luminances that are full, and those whose SNR is below
    1.

    Raises
    ------
    ValueError
        For luminances, a time or a sensor that mean nothing.
    """
    L = np.asarray(L, np.float64)
    sensor = as_sensor(sensor)
    if not np.all((L >= 0) & np.isfinite(L)) or not (
        0 < time < np.inf and 0 < sensitivity < np.inf
    ):
        raise InputError(
            f"expected luminances, a time and a sensitivity, got {describe(L)} and {time} s"
        )
    X = sensitivity * time * L
    N = np.minimum(sensor.full_well * X, full_electrons(sensor))
    Z = np.floor(N / sensor.gain + 0.5).astype(np.int64) + sensor.black
    ratio = snr(X, sensor)
    full = sensor.full_well * X >= full_electrons(sensor)
    return ExposedLevels(Z=Z, snr=ratio, full=full, noise=ratio < 1)


def levels_per_stop(bits: int) -> NDArray[np.int64]:
    """Return how many levels (bits,) of a linear converter lie in each stop, from the brightest down.

    Half of all levels serve the uppermost stop. The eighth stop of 8 bits has one; of 12 bits it
    has 16.

    Examples
    --------
    >>> levels_per_stop(8), int(levels_per_stop(12)[7])
    (array([128,  64,  32,  16,   8,   4,   2,   1]), 16)
    """
    if bits not in range(1, 33):
        raise InputError(f"expected 1 to 32 bits, got {bits}")
    return 2 ** np.arange(bits - 1, -1, -1)
