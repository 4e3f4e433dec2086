"""The sensor, stage by stage: light becomes exposure, electrons, RAW levels, and a picture again.

E    radiance    (H, W[, 3]) float32, any linear unit
t    exposure time, s;  s  sensitivity, exposure per (unit of E x second)
X    exposure    at the sensor, float32: 1 fills the well
N    electrons   in the well, 0 to full_well
K    gain        electrons per level of the converter (ADC); a higher ISO speed is a smaller K
Z    RAW level   uint16, round(N / K) + black, 0 to 2^bits - 1
M    brightness  0 to 1, after the response

    E -> falloff -> exposure -> (mosaic) -> photons -> readout -> digitise -> Z      `raw`
    Z -> less black, times K -> (demosaic) -> white balance -> X                     `develop`

The black level is there for the noise: in the dark N + noise is negative half of the time, and cut
off at 0 its mean would be too high. So the converter adds a little, and what develops the levels
takes it off.
"""

from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, F64, Array, ArrayLike, NDArray, as_radiance, describe
from hdrlab.core.filters import mosaic
from hdrlab.errors import InputError

Seed = int | np.random.Generator
# An exposure of four full wells fills the well whatever the photons' chance.
_CERTAINLY_FULL = 4.0


class Sensor(NamedTuple):
    """What a data sheet says of a sensor; the numbers here are those of a good camera's."""

    full_well: float = 20_000.0  # electrons a pixel holds
    read_noise: float = 5.0  # electrons, standard deviation
    gain: float = 5.0  # K, electrons per level
    bits: int = 12  # of the converter
    black: int = 64  # level of no light


def falloff(shape: tuple[int, ...], loss: float) -> F32:
    """Return 1 - loss r^2 (H, W), r the distance from the middle, 1 in the corners: vignetting."""
    y, x = [np.linspace(-1, 1, n) if n > 1 else np.zeros(1) for n in shape[:2]]
    return (1 - loss * (y[:, None] ** 2 + x**2) / 2).astype(np.float32)


def vignette(E: F32, loss: float) -> F32:
    """Return E times the falloff."""
    bright = falloff(E.shape, loss)
    return E * (bright if E.ndim == 2 else bright[..., None])


def filter_bayer(X: F32) -> F32:
    """Return the mosaic (H, W) of exposures (H, W, 3) behind filters R G / G B."""
    return mosaic.sample(X, mosaic.tile(mosaic.BAYER, X.shape[:2]))


def exposure(E: F32, time: float, *, sensitivity: float = 1.0) -> F32:
    """Return X = s E t: light, times how long it was let in, times how strongly the sensor answers."""
    with np.errstate(over="ignore"):  # an infinite exposure fills the well as any long one does
        return np.float32(sensitivity) * (E * np.float32(time))


def photons(X: F32, *, full_well: float, rng: np.random.Generator) -> F32:
    """Return N ~ Poisson(full_well X), at most full_well: light comes in photons, and a full well spills."""
    arriving = full_well * np.minimum(X, _CERTAINLY_FULL)
    return np.minimum(rng.poisson(arriving), full_well).astype(np.float32)


def readout(N: F32, *, read_noise: float, rng: np.random.Generator) -> F32:
    """Return N + Normal(0, read_noise), electrons: what the amplifier adds, in the dark too."""
    return N + np.float32(read_noise) * rng.standard_normal(N.shape, np.float32)


def digitise(N: F32, sensor: Sensor) -> NDArray[np.uint16]:
    """Return Z = round(N / K) + black, clamped to the converter's levels."""
    Z = np.floor(N / np.float32(sensor.gain) + np.float32(sensor.black + 0.5))
    return np.clip(Z, 0, 2**sensor.bits - 1).astype(np.uint16)


def full_electrons(sensor: Sensor) -> float:
    """Return the electrons at which a pixel is full: its well is, or the converter has no level above."""
    return min(sensor.full_well, sensor.gain * (2**sensor.bits - 1 - sensor.black))


def balance(gray: ArrayLike) -> F64:
    """Return gains (3,), the least of them 1, that make a gray card of these channels (3,) gray."""
    gray = np.asarray(gray, np.float64)
    if gray.shape != (3,) or not np.all((gray > 0) & np.isfinite(gray)):
        raise InputError(f"expected three positive channels of a gray card, got {describe(gray)}")
    return gray.max() / gray


def grain(M: Array, *, gray_noise: float, bits: int, rng: np.random.Generator) -> Array:
    """Return M + Normal(0, gray_noise) levels: noise after the response, the same at every brightness."""
    return M + np.float32(gray_noise / (2**bits - 1)) * rng.standard_normal(M.shape, np.float32)


def quantise(M: Array, *, bits: int = 8) -> Array:
    """Return Z = round((2^bits - 1) M), clamped to the levels there are: uint8 or uint16."""
    top = 2**bits - 1
    return np.floor(np.clip(M, 0, 1) * top + 0.5).astype(np.uint8 if bits == 8 else np.uint16)


def read(X: F32, sensor: Sensor, *, rng: np.random.Generator) -> NDArray[np.uint16]:
    """Return the RAW levels Z of exposures X: photons counted, amplified and digitised."""
    N = photons(X, full_well=sensor.full_well, rng=rng)
    return digitise(readout(N, read_noise=sensor.read_noise, rng=rng), sensor)


def raw(
    E: ArrayLike,
    time: float,
    sensor: Sensor = Sensor(),  # noqa: B008  a NamedTuple of numbers does not change
    *,
    sensitivity: float = 1.0,
    vignetting: float = 0.0,
    bayer: bool = False,
    rng: Seed = 0,
) -> NDArray[np.uint16]:
    """Take one RAW photograph.

    Parameters
    ----------
    E : (H, W) or (H, W, 3), radiance, any linear unit
    time : t, s
    sensor : Sensor
    sensitivity : s: E t = 1 / s fills the well
    vignetting : share of the light that the corners lose, 0 to 1
    bayer : the sensor has filters R G / G B; else all three channels are read at every pixel
    rng : seed, or a generator, which is advanced

    Returns
    -------
    Z : (H, W) or (H, W, 3) uint16, levels of the converter; (H, W) with `bayer`

    Raises
    ------
    ValueError
        For radiance, a time, a sensor or a vignetting that mean nothing.

    Examples
    --------
    >>> raw(np.full((1, 3), [0.0, 0.5, 2.0]), 1.0, Sensor(read_noise=0))[0, [0, 2]]
    array([  64, 4064], dtype=uint16)
    """
    E = as_radiance(E)
    sensor = as_sensor(sensor)
    if not (0 <= time < np.inf and 0 < sensitivity < np.inf and 0 <= vignetting <= 1):
        got = f"{time} s, {sensitivity} and {vignetting}"
        raise InputError(
            f"expected a time, a positive sensitivity and a vignetting from 0 to 1, got {got}"
        )
    X = exposure(vignette(E, vignetting), time, sensitivity=sensitivity)
    return read(filter_bayer(X) if bayer else X, sensor, rng=np.random.default_rng(rng))


def develop(
    Z: ArrayLike,
    sensor: Sensor = Sensor(),  # noqa: B008
    *,
    white: ArrayLike = (1.0, 1.0, 1.0),
    bayer: bool = False,
) -> F32:
    """Return the exposure X of RAW levels, 0 to 1 where 1 is full, in three channels of balanced white.

    The gains are divided by the least of them, and what exceeds 1 is cut off: a pixel that is full
    in all channels is white. With gains below 1, or without the cut, burnt-out highlights come out
    magenta.

    Parameters
    ----------
    Z : (H, W), (H, W, 3) uint16; with `bayer` a mosaic (H, W), which gets three channels
    sensor : Sensor that they come from
    white : gains (3,) of the channels, as of `balance`; only their ratios count
    bayer : Z is a mosaic R G / G B

    Raises
    ------
    ValueError
        For levels of another kind, or gains that are not positive.

    Examples
    --------
    >>> develop(np.uint16([[64, 2064, 4064]]), Sensor(full_well=20_000, gain=5, black=64)).tolist()
    [[0.0, 0.5, 1.0]]
    """
    Z = np.asarray(Z)
    gains = np.asarray(white, np.float64)
    sensor = as_sensor(sensor)
    if Z.dtype != np.uint16 or Z.ndim not in (2, 3) or Z.size == 0 or (bayer and Z.ndim == 3):
        raise InputError(f"expected RAW levels uint16, (H, W) of a mosaic, got {describe(Z)}")
    if gains.shape != (3,) or not np.all((gains > 0) & np.isfinite(gains)):
        raise InputError(f"expected three positive gains, got {describe(gains)}")
    X = np.float32(sensor.gain / full_electrons(sensor)) * (
        Z.astype(np.float32) - np.float32(sensor.black)
    )
    if bayer:
        X = mosaic.demosaic(X, mosaic.tile(mosaic.BAYER, Z.shape)).astype(np.float32)
    if X.ndim == 3:
        X = X * (gains / gains.min()).astype(np.float32)
    return np.clip(X, 0, 1)


def as_sensor(sensor: Sensor) -> Sensor:
    """Return the sensor, or raise a ValueError where its numbers mean nothing."""
    full_well, read_noise, gain, bits, black = sensor
    positive = 0 < full_well < np.inf and 0 < gain < np.inf and 0 <= read_noise < np.inf
    if not (positive and bits in range(1, 17) and 0 <= black < 2**bits - 1):
        raise InputError(
            f"expected a well, a gain and 1 to 16 bits that hold the black level, got {sensor}"
        )
    return sensor
