"""Quality of a tone-mapped picture: TMQI (Yeganeh and Wang, IEEE Trans. Image Processing 22(2), 2013).

x      luminance of the scene, linearly from 0 to 2^32 - 1     (H, W) float64
y      gray level of the picture as it is shown, 0 to 255      (H, W) float64
nu     spatial frequency of a scale, cycles per degree         16, 8, 4, 2, 1
A      contrast sensitivity of the eye at nu
tau    standard deviation that is seen half of the time at nu
sigma  local standard deviation, under a Gaussian window of 11 x 11 pixels
S      structural fidelity                                     1 = every detail of the scene, and no other
N      statistical naturalness                                 1 = brightness and contrast of most photographs
Q      overall quality                                         1 = best

S compares the visible structure of scene and picture at five scales, each half the size of the one
before. N does not depend on the scene: it is how common the picture's mean and contrast are among
3000 photographs. Both use luminance only, so wrong colours do not lower them.

What S cannot see: tau is a threshold in gray levels, 0.9 to 2.9, but x goes up to 2^32 - 1. So in
the scene nearly every difference counts as visible, even one far below what an eye sees. S
therefore lowers a picture that leaves a flat dark wall flat, and rewards one that amplifies its
noise. Compare Q of pictures of one scene, and look at them.

The constants are those of the paper and, where it leaves one open, of its authors' program: the
range of x, and 1.4 for the square root of 2 in tau.
"""

from typing import NamedTuple

import numpy as np
from scipy.ndimage import correlate1d
from scipy.special import ndtr

from hdrlab.core.arrays import F64, ArrayLike, as_luminance, describe
from hdrlab.core.choices import require_choice
from hdrlab.core.picture import gray
from hdrlab.errors import InputError

# cycles per degree, finest scale first
FREQUENCIES = (16.0, 8.0, 4.0, 2.0, 1.0)
# of the scales, from experiments on multi-scale SSIM
WEIGHTS = (0.0448, 0.2856, 0.3001, 0.2363, 0.1333)
# pixels along a side of the window, and of the blocks that contrast is computed from
WINDOW_SIDE = 11
# what N does with incomplete blocks at the edge of the picture
EDGE_BLOCKS = ("omit", "pad")
WINDOW = np.exp(-0.5 * (np.arange(-5, 6) / 1.5) ** 2)
WINDOW /= WINDOW.sum()
# C1 and C2 of the local fidelity
C1 = 0.01
C2 = 10.0
MAX_SCENE_LUMINANCE = 2.0**32 - 1
# relative to the squared mean; a smaller variance comes from rounding to float32
MIN_RELATIVE_VARIANCE = 1e-14
# alpha, beta and a of Q
STRUCTURE_POWER = 0.3046
NATURALNESS_POWER = 0.7088
STRUCTURE_WEIGHT = 0.8012


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
    """Return sigma' = Phi((sigma - tau) / (tau / 3)), the probability of seeing a contrast [Yeganeh13]."""
    tau = threshold(nu)
    return ndtr((sigma - tau) / (tau / 3))


def window_means(image: F64) -> F64:
    """Return the weighted means under the window, where it fits into the picture: (H - 10, W - 10)."""
    rows = correlate1d(image, WINDOW, axis=0)[5:-5]
    return correlate1d(rows, WINDOW, axis=1)[:, 5:-5]


def deviations(x: F64, y: F64) -> tuple[F64, F64, F64]:
    """Return sigma_x, sigma_y and the covariance sigma_xy, all under the window."""
    mean_x = window_means(x)
    mean_y = window_means(y)
    sigma_x = _deviation(x, mean_x)
    sigma_y = _deviation(y, mean_y)
    # without rounding, the covariance would be within this by the Cauchy-Schwarz inequality
    limit = sigma_x * sigma_y
    sigma_xy = np.clip(window_means(x * y) - mean_x * mean_y, -limit, limit)
    return sigma_x, sigma_y, sigma_xy


def _deviation(image: F64, mean: F64) -> F64:
    """Return the standard deviation under the window, 0 where it is only rounding."""
    variance = window_means(image * image) - mean**2
    return np.sqrt(np.where(variance > MIN_RELATIVE_VARIANCE * mean**2, variance, 0))


def local_fidelity(x: F64, y: F64, nu: float) -> F64:
    """Return the map (H - 10, W - 10) of one scale [Yeganeh13].

    S_local = (2 sx' sy' + C1) / (sx'^2 + sy'^2 + C1) * (sigma_xy + C2) / (sigma_x sigma_y + C2). The
    first factor is high where both contrasts are visible or both invisible, the second where they
    are correlated.
    """
    sigma_x, sigma_y, sigma_xy = deviations(x, y)
    sx = visible(sigma_x, nu)
    sy = visible(sigma_y, nu)
    return (2 * sx * sy + C1) / (sx**2 + sy**2 + C1) * (sigma_xy + C2) / (sigma_x * sigma_y + C2)


def halve(image: F64) -> F64:
    """Return the means of 2 x 2 pixels; the last pixel of an odd side is left out."""
    h = image.shape[0] // 2
    w = image.shape[1] // 2
    return image[: 2 * h, : 2 * w].reshape(h, 2, w, 2).mean(axis=(1, 3))


def scale_fidelities(x: F64, y: F64) -> list[float]:
    """Return the mean of S_local per scale [Yeganeh13]: five, or as many as the window fits into.

    A picture that is smaller than the window is extended by reflection, and has one scale. A
    negative mean, as of an inverted picture, has no root and counts as 0.
    """
    if min(x.shape) < WINDOW_SIDE:
        ends = [(0, max(0, WINDOW_SIDE - side)) for side in x.shape]
        x = np.pad(x, ends, mode="symmetric")
        y = np.pad(y, ends, mode="symmetric")
    fidelities: list[float] = []
    for nu in FREQUENCIES:
        if min(x.shape) < WINDOW_SIDE:
            break
        fidelities.append(max(0.0, float(local_fidelity(x, y, nu).mean())))
        x = halve(x)
        y = halve(y)
    return fidelities


def structural_fidelity(x: F64, y: F64) -> float:
    """Return S = prod S_l^w_l over the scales [Yeganeh13]; fewer scales have weights of the same sum."""
    fidelities = np.array(scale_fidelities(x, y))
    w = np.array(WEIGHTS[: len(fidelities)])
    return float(np.prod(fidelities ** (w / w.sum() * sum(WEIGHTS))))


def brightness(y: F64) -> float:
    """Return P_m = exp(-(mean - 115.94)^2 / (2 * 27.99^2)), 1 at its peak [Yeganeh13]."""
    return float(np.exp(-(((y.mean() - 115.94) / 27.99) ** 2) / 2))


def contrast(y: F64, *, edge_blocks: str = "omit") -> float:
    """Return P_d = d^3.4 (1 - d)^9.1, scaled to 1 at its peak d = 3.4 / 12.5 [Yeganeh13].

    d is the mean standard deviation of blocks of 11 x 11 pixels over 64.29, see `block_deviation`.
    """
    d = min(block_deviation(y, edge_blocks=edge_blocks) / 64.29, 1.0)
    peak = 3.4 / 12.5
    return float((d / peak) ** 3.4 * ((1 - d) / (1 - peak)) ** 9.1)


def block_deviation(y: F64, *, edge_blocks: str = "omit") -> float:
    """Return the mean standard deviation of blocks of 11 x 11 pixels.

    Where a side of the picture is no multiple of 11, the blocks at the right and lower edge are
    incomplete. The paper does not say what to do with them:

    - "omit" leaves them out, so that only the picture counts. A picture smaller than a block is
      one block.
    - "pad" does as the authors' program: it fills them with black, and weights each block by the
      pixels of the picture in it. Black next to the picture counts as contrast. That program also
      divides the squares by 120 and not by 121.
    """
    require_choice("edge_blocks", edge_blocks, EDGE_BLOCKS)
    if edge_blocks == "pad":
        return _padded_block_deviation(y)
    rows = min(WINDOW_SIDE, y.shape[0])
    columns = min(WINDOW_SIDE, y.shape[1])
    h = y.shape[0] // rows
    w = y.shape[1] // columns
    blocks = y[: h * rows, : w * columns].reshape(h, rows, w, columns)
    return float(blocks.std(axis=(1, 3)).mean())


def _padded_block_deviation(y: F64) -> float:
    """Return the mean over the pixels of the deviation of their block, filled up with black."""
    height, width = y.shape
    h = -(-height // WINDOW_SIDE)
    w = -(-width // WINDOW_SIDE)
    padded = np.pad(y, [(0, h * WINDOW_SIDE - height), (0, w * WINDOW_SIDE - width)])
    blocks = padded.reshape(h, WINDOW_SIDE, w, WINDOW_SIDE)
    deviations = blocks.std(axis=(1, 3), ddof=1)
    block_rows = np.arange(height) // WINDOW_SIDE
    block_columns = np.arange(width) // WINDOW_SIDE
    return float(deviations[np.ix_(block_rows, block_columns)].mean())


def naturalness(y: F64, *, edge_blocks: str = "omit") -> float:
    """Return N = P_m P_d, each of them at most 1 [Yeganeh13]."""
    return brightness(y) * contrast(y, edge_blocks=edge_blocks)


def overall(S: float, N: float) -> float:
    """Return Q = a S^alpha + (1 - a) N^beta, fitted to the ratings of viewers [Yeganeh13]."""
    return STRUCTURE_WEIGHT * S**STRUCTURE_POWER + (1 - STRUCTURE_WEIGHT) * N**NATURALNESS_POWER


def scale_luminance(L: ArrayLike) -> F64:
    """Return x, the luminance L scaled linearly to 0 ... 2^32 - 1; zeros if L is constant."""
    x = as_luminance(L).astype(np.float64)
    x -= x.min()
    return x * (MAX_SCENE_LUMINANCE / x.max()) if x.max() > 0 else x


def tmqi(L: ArrayLike, picture: ArrayLike, *, edge_blocks: str = "omit") -> Quality:
    """Return the tone-mapped image quality index: overall, structural fidelity, and naturalness.

    Parameters
    ----------
    L : (H, W) luminance of the scene, linear, any unit
    picture : (H, W) or (H, W, 3) uint8, encoded for the display, for example by `pipeline.develop`
    edge_blocks : "omit" or "pad"
        What N does with incomplete blocks at the edge. "pad" is for comparisons with published
        figures: see `block_deviation`.

    Returns
    -------
    Quality (Q, S, N), each in [0, 1] and finite for every scene

    Raises
    ------
    ValueError
        For an array that is no luminance or no picture, and for two that differ in size.

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
    x = scale_luminance(L)
    y = gray(picture)
    if x.shape != y.shape:
        raise InputError(
            f"expected a picture of the scene's {x.shape} pixels, got {describe(picture)}"
        )
    S = structural_fidelity(x, y)
    N = naturalness(y, edge_blocks=edge_blocks)
    return Quality(overall(S, N), S, N)
