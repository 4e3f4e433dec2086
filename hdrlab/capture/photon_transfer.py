"""Photon transfer: a sensor's gain and read noise, from photographs of a white wall (Janesick, 2007).

Z    RAW levels   (M, 2, H, W): M exposures of an even surface, two photographs of each; the first one dark
S    signal       (M,) levels: the mean of a pair, less that of the dark pair
V    variance     (M,) levels^2: half the variance of the difference of a pair
K    gain         electrons per level;  R  read noise, electrons

Photons come by chance: of N electrons the variance is N. Counted in levels, N / K, it is N / K^2 =
S / K, so

    V = S / K + (R / K)^2 + 1 / 12

is a straight line, whose slope is 1 / K, and the dark pair lies where it begins. The difference of
two photographs is taken because dust, vignetting and unlike pixels are the same in both: they
cancel.

Two conditions hold for the read noise. Rounding adds 1 / 12 only to noise of about half a level or
more; the variance of less noise depends on where black lies between two levels, and tells nothing.
And the levels must not be cut off at 0, where they lose the lower half of the noise: there, the
levels above the median give black and noise.
"""

from dataclasses import dataclass

import numpy as np

from hdrlab.core.arrays import F64, Array, ArrayLike, Mask, describe
from hdrlab.errors import InputError

# levels^2: what rounding to whole levels adds
ROUNDING_VARIANCE = 1 / 12
# Less noise is hidden by rounding: its variance depends on where black lies between two levels.
MAX_HIDDEN_NOISE_LEVELS = 0.5
MIN_DARK_VARIANCE = MAX_HIDDEN_NOISE_LEVELS**2 + ROUNDING_VARIANCE
# fraction of the dark pair at level 0 beyond which its noise is cut off
MAX_CUT_FRACTION = 0.01
# standard deviations of a normal distribution on either side that hold 95 %
DEVIATIONS_OF_95_PERCENT = 1.96
# of the highest signal: above it a full well may cut the noise off
SAFE_SIGNAL_SHARE = 0.8


@dataclass(frozen=True, kw_only=True, eq=False)
class Transfer:
    """A sensor, from its own noise.

    Attributes
    ----------
    gain : K, electrons per level
    read_noise : R, electrons; NaN where rounding hides it
    read_noise_interval : 95 % interval of R, electrons, from the number of pixels; where rounding
        hides R, from 0 to half a level
    black : level of no light
    full_well : electrons at the highest measured signal; the well, where the brightest pair is full
    S, V : (M,) levels and levels^2, the photon transfer curve
    used : (M,) bool, the pairs that the line was drawn through
    """

    gain: float
    read_noise: float
    read_noise_interval: tuple[float, float]
    black: float
    full_well: float
    S: F64
    V: F64
    used: Mask


def variance(pair: Array) -> float:
    """Return V = var(Z_1 - Z_2) / 2 of two photographs (2, H, W): of their noise, and of nothing else."""
    return float((pair[0].astype(np.float64) - pair[1]).var() / 2)


def dark_level(pair: Array) -> tuple[float, float]:
    """Return black and V_0 of the dark pair: its mean and `variance`, if no levels are cut off at 0.

    Otherwise black is the median, and V_0 the mean square of the distance of the brighter half.
    """
    if (pair == 0).mean() <= MAX_CUT_FRACTION:
        return float(pair.mean()), variance(pair)
    black = float(np.median(pair))
    above = pair[pair > black] - black
    return black, float(np.sum(above**2) / (pair.size / 2))


def line(S: F64, V: F64) -> float:
    """Return the slope 1 / K of V - V_0 = S / K, V_0 that of the dark pair, by weighted least squares.

    A variance of n pixels errs by V sqrt(2 / n), so the weights are 1 / V^2; the first pair is the
    dark one.
    """
    w = 1 / np.maximum(V, ROUNDING_VARIANCE) ** 2
    return float((w * S * (V - V[0])).sum() / (w * S**2).sum())


def calibrate(Z: ArrayLike) -> Transfer:
    """Calibrate a sensor by photon transfer.

    Parameters
    ----------
    Z : (M, 2, H, W) RAW levels, whole numbers, from dark to bright: Z[0] with the lens cap on, the
        others of an evenly lit surface. At least three brighter pairs; with ten, up to a full well,
        that too. Of a sensor with filters, the pixels of one colour. One dark pair stands for all
        exposures. So change the light and keep the time, or keep all times so short that there is
        no dark current.

    Returns
    -------
    transfer : Transfer

        `read_noise` is NaN if the dark pair has noise of less than half a level: use a camera
        setting with a lower gain K, such as a higher ISO speed.

    Raises
    ------
    InputError
        For levels that are no pairs, or fewer than two bright pairs below the full ones, or no
        noise to read.

    References
    ----------
    Janesick, Photon Transfer: DN -> lambda, SPIE Press 2007.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> N = np.array([0, 500, 1000, 2000, 4000])[:, None, None, None] * np.ones((5, 2, 64, 64))
    >>> Z = np.round((rng.poisson(N) + rng.normal(0, 6, N.shape)) / 2 + 100).astype(np.uint16)
    >>> found = calibrate(Z)
    >>> round(found.gain, 1), round(found.read_noise), round(found.black)
    (2.0, 6, 100)
    """
    Z = np.asarray(Z)
    if (
        Z.ndim != 4
        or Z.shape[1] != 2
        or Z.dtype.kind not in "iu"
        or len(Z) < 4
        or Z[0, 0].size < 100
    ):
        raise InputError(
            f"expected levels (M, 2, H, W), a dark pair and three more, got {describe(Z)}"
        )
    black, dark_variance = dark_level(Z[0])
    S = np.concatenate([[0], Z[1:].mean(axis=(1, 2, 3)) - black])
    V = np.array([dark_variance, *(variance(pair) for pair in Z[1:])])
    used = (S <= SAFE_SIGNAL_SHARE * S.max()) & (S >= 0)
    if used.sum() < 3 or not S.max() > 0:
        got = S.round(1).tolist()
        raise InputError(
            f"expected two pairs between the dark and the brightest, got signals {got}"
        )
    slope = line(S[used], V[used])
    if not slope > 0:
        raise InputError(
            "expected noise that grows with the light, as in RAW photos; use RAW pixel values"
        )
    R, interval = _read_noise(dark_variance, Z[0, 0].size)
    return Transfer(
        gain=1 / slope,
        read_noise=R / slope,
        read_noise_interval=(interval[0] / slope, interval[1] / slope),
        black=black,
        full_well=float(S.max() / slope),
        S=S,
        V=V,
        used=used,
    )


def _read_noise(V_0: float, n: int) -> tuple[float, tuple[float, float]]:
    """Return R / K in levels and its 95 % interval, from the variance of a dark pair of n pixels."""
    if V_0 < MIN_DARK_VARIANCE:
        return np.nan, (0.0, MAX_HIDDEN_NOISE_LEVELS)
    error = DEVIATIONS_OF_95_PERCENT * V_0 * np.sqrt(2 / n)
    variances = np.array([V_0, V_0 - error, V_0 + error]) - ROUNDING_VARIANCE
    noise, low, high = np.sqrt(np.maximum(variances, 0)).tolist()
    return noise, (low, high)
