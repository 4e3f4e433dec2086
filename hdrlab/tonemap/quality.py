"""How good is a tone-mapped picture? TMQI (Yeganeh and Wang, IEEE Trans. Image Processing 22(2), 2013).

x      luminance of the scene, linearly from 0 to 2^32 - 1     (H, W) float64
y      gray level of the picture as it is shown, 0 to 255      (H, W) float64
nu     spatial frequency of a scale, cycles per degree         16, 8, 4, 2, 1
A      contrast sensitivity of the eye at nu
tau    standard deviation that is seen half of the time at nu
sigma  local standard deviation, under a Gaussian window of 11 x 11 pixels
S      structural fidelity                                     1 = every detail of the scene, and no other
N      statistical naturalness                                 1 = brightness and contrast of most photographs
Q      overall quality                                         1 = best

S asks whether what is visible in the one is visible in the other, and alike, at five scales of half
the size each. N knows nothing of the scene: it is how usual such a mean and such a contrast are in
3000 photographs. Both see luminance alone, so a false colour costs nothing.

The constants are those of the paper and, where it leaves one open, of its authors' program: the
range of x, and 1.4 for the square root of 2 in tau.
"""

from typing import NamedTuple

import numpy as np
from scipy.ndimage import correlate1d
from scipy.special import ndtr

from hdrlab.core.arrays import F64, ArrayLike, as_luminance, describe
from hdrlab.core.picture import gray
from hdrlab.errors import InputError

FREQUENCIES = (16.0, 8.0, 4.0, 2.0, 1.0)  # finest scale first
WEIGHTS = (
    0.0448,
    0.2856,
    0.3001,
    0.2363,
    0.1333,
)  # of the scales, from experiments on multi-scale SSIM
SIDE = 11  # pixels of the window, and of the blocks whose contrast is taken
WINDOW = np.exp(-0.5 * (np.arange(-5, 6) / 1.5) ** 2)
WINDOW /= WINDOW.sum()
C1, C2 = 0.01, 10.0
RANGE = 2.0**32 - 1
# of the squared mean: a smaller variance is that of float32's last bit, which is no structure
ROUNDING = 1e-14
ALPHA, BETA, SHARE = 0.3046, 0.7088, 0.8012  # alpha, beta and a of Q


class Quality(NamedTuple):
    """Overall quality Q, structural fidelity S and statistical naturalness N, each from 0 to 1."""

    Q: float
    S: float
    N: float


def sensitivity(nu: float) -> float:
    """Return A(nu) = 100 * 2.6 (0.0192 + 0.114 nu) exp(-(0.114 nu)^1.1) [Mannos74, in Yeganeh13]."""
    return float(260 * (0.0192 + 0.114 * nu) * np.exp(-((0.114 * nu) ** 1.1)))


def threshold(nu: float) -> float:
    """Return tau = 128 / (1.4 A(nu)), the mean gray level over the sensitivity [Yeganeh13]."""
    return 128 / (1.4 * sensitivity(nu))


def visible(sigma: F64, nu: float) -> F64:
    """Return sigma' = Phi((sigma - tau) / (tau / 3)), the chance to see a contrast [Yeganeh13]."""
    tau = threshold(nu)
    return ndtr((sigma - tau) / (tau / 3))


def window_means(image: F64) -> F64:
    """Return the means under the window, wherever it fits into the picture (H - 10, W - 10)."""
    rows = correlate1d(image, WINDOW, axis=0)[5:-5]
    return correlate1d(rows, WINDOW, axis=1)[:, 5:-5]


def deviations(x: F64, y: F64) -> tuple[F64, F64, F64]:
    """Return sigma_x, sigma_y and the covariance sigma_xy, all under the window."""
    mean_x, mean_y = window_means(x), window_means(y)
    variance_x, variance_y = window_means(x * x) - mean_x**2, window_means(y * y) - mean_y**2
    sigma_x = np.sqrt(np.where(variance_x > ROUNDING * mean_x**2, variance_x, 0))
    sigma_y = np.sqrt(np.where(variance_y > ROUNDING * mean_y**2, variance_y, 0))
    most = sigma_x * sigma_y  # by Cauchy and Schwarz; rounding knows nothing of them
    return sigma_x, sigma_y, np.clip(window_means(x * y) - mean_x * mean_y, -most, most)


def local_fidelity(x: F64, y: F64, nu: float) -> F64:
    """Return the map (H - 10, W - 10) of one scale [Yeganeh13].

    S_local = (2 sx' sy' + C1) / (sx'^2 + sy'^2 + C1) * (sigma_xy + C2) / (sigma_x sigma_y + C2):
    both are seen, or neither is; and they go together.
    """
    sigma_x, sigma_y, sigma_xy = deviations(x, y)
    sx, sy = visible(sigma_x, nu), visible(sigma_y, nu)
    return (2 * sx * sy + C1) / (sx**2 + sy**2 + C1) * (sigma_xy + C2) / (sigma_x * sigma_y + C2)


def halve(image: F64) -> F64:
    """Return the means of 2 x 2 pixels; of an odd side the last pixel is left out."""
    h, w = (side // 2 for side in image.shape)
    return image[: 2 * h, : 2 * w].reshape(h, 2, w, 2).mean(axis=(1, 3))


def scale_fidelities(x: F64, y: F64) -> list[float]:
    """Return the mean of S_local per scale [Yeganeh13]: five, or as many as the window fits into.

    A picture that is smaller than the window is continued by reflection, and has one scale. A mean
    below 0, as that of a negative, has no root and counts as 0.
    """
    if min(x.shape) < SIDE:
        ends = [(0, max(0, SIDE - side)) for side in x.shape]
        x, y = np.pad(x, ends, mode="symmetric"), np.pad(y, ends, mode="symmetric")
    found: list[float] = []
    while len(found) < len(FREQUENCIES) and min(x.shape) >= SIDE:
        found.append(max(0.0, float(local_fidelity(x, y, FREQUENCIES[len(found)]).mean())))
        x, y = halve(x), halve(y)
    return found


def structural_fidelity(x: F64, y: F64) -> float:
    """Return S = prod S_l^w_l over the scales, which share the weight if fewer [Yeganeh13]."""
    found = scale_fidelities(x, y)
    w = np.array(WEIGHTS[: len(found)])
    return float(np.prod(np.array(found) ** (w / w.sum() * sum(WEIGHTS))))


def brightness(y: F64) -> float:
    """Return P_m = exp(-(mean - 115.94)^2 / (2 * 27.99^2)), 1 at its peak [Yeganeh13]."""
    return float(np.exp(-(((y.mean() - 115.94) / 27.99) ** 2) / 2))


def contrast(y: F64) -> float:
    """Return P_d = d^3.4 (1 - d)^9.1, brought to 1 at its peak d = 3.4 / 12.5 [Yeganeh13].

    d is the mean standard deviation of blocks of 11 x 11 pixels over 64.29. Blocks that the edge
    cuts are left out, where the authors' program fills them with black; and a deviation is that of
    the block, where theirs is a sample's, 0.4 % more.
    """
    d = min(block_deviation(y) / 64.29, 1.0)
    peak = 3.4 / 12.5
    return float((d / peak) ** 3.4 * ((1 - d) / (1 - peak)) ** 9.1)


def block_deviation(y: F64) -> float:
    """Return the mean standard deviation of the whole blocks; a picture smaller than a block is one block."""
    down, across = (min(SIDE, side) for side in y.shape)
    h, w = y.shape[0] // down, y.shape[1] // across
    return float(y[: h * down, : w * across].reshape(h, down, w, across).std(axis=(1, 3)).mean())


def naturalness(y: F64) -> float:
    """Return N = P_m P_d, each of them at most 1 [Yeganeh13]."""
    return brightness(y) * contrast(y)


def overall(S: float, N: float) -> float:
    """Return Q = a S^alpha + (1 - a) N^beta, weighed by the votes of viewers [Yeganeh13]."""
    return SHARE * S**ALPHA + (1 - SHARE) * N**BETA


def scale_luminance(L: ArrayLike) -> F64:
    """Return x, the luminance L brought linearly to 0 ... 2^32 - 1; of a constant, zeros."""
    x = as_luminance(L).astype(np.float64)
    x -= x.min()
    return x * (RANGE / x.max()) if x.max() > 0 else x


def tmqi(L: ArrayLike, picture: ArrayLike) -> Quality:
    """Return how well a picture shows a scene: overall, in structure, and as a photograph.

    Parameters
    ----------
    L : (H, W) luminance of the scene, linear, any unit
    picture : (H, W) or (H, W, 3) uint8, as it is sent to the display, as of `pipeline.develop`

    Returns
    -------
    Quality (Q, S, N), each in [0, 1] and finite, whatever the scene

    Raises
    ------
    ValueError
        For luminance or a picture that is none, and for two that differ in size.

    References
    ----------
    Yeganeh and Wang, Objective quality assessment of tone-mapped images, IEEE TIP 22(2), 2013.

    Examples
    --------
    >>> L = np.geomspace(1, 1e4, 64 * 64).reshape(64, 64)
    >>> picture = (255 * np.log10(L) / 4).astype(np.uint8)
    >>> tmqi(L, picture).Q > tmqi(L, picture // 16).Q
    True
    """
    x, y = scale_luminance(L), gray(picture)
    if x.shape != y.shape:
        raise InputError(
            f"expected a picture of the scene's {x.shape} pixels, got {describe(picture)}"
        )
    S, N = structural_fidelity(x, y), naturalness(y)
    return Quality(overall(S, N), S, N)
