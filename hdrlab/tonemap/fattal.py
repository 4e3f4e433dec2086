"""Gradient domain compression (Fattal, Lischinski, Werman, SIGGRAPH 2002).

lL      ln luminance, 0 at white           (H, W); H in the paper
lL_k    level k of its Gaussian pyramid    (ceil(H / 2^k), ceil(W / 2^k)), k = 0 ... d, none of them below 32
slope   |grad lL_k|                        same, nats per pixel of the picture
phi_k   attenuation by the slope there     same, 1 where the slope is alpha times its mean
Phi_k   attenuation by all levels >= k     same; Phi = Phi_0
G       attenuated gradient, (Gy, Gx)      (2, H, W)
lLd     the picture with this gradient     (H, W), ln display luminance but for a constant; I in the paper
Ld      display luminance                  (H, W) in [0, 1]
beta    power                              each level raises a slope to the power of beta

Large contrasts have steep slopes at some level. Only slopes are attenuated, never single pixels. A
larger picture has more levels. Each of them multiplies a slope of mean size by alpha^(1 - beta),
about 0.79, and steeper ones by less, so a large picture becomes paler than a small copy of it. A
central difference sees no slope in stripes that are one pixel wide, so a chart full of them is
shown badly.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from hdrlab.core import steps
from hdrlab.core.arrays import F32, ArrayLike, as_luminance
from hdrlab.core.filters import poisson, pyramid
from hdrlab.errors import InputError

LAWS = ("exposure",)
# luminance gradients are compressed and those of colour are not; the paper's 0.6 is pale
SATURATION = 0.8
# pixels of the shorter side of the coarsest level
MIN_LEVEL_SIDE = 32
# relative to white: black pixels get this luminance, or that of the darkest pixel if it is lower
BLACK_LUMINANCE = 1e-3
# percentiles are computed from about this many pixels
PERCENTILE_PIXELS = 2**18


class Level(NamedTuple):
    """The attenuation after each level, from the coarsest, k = d, to the picture itself, k = 0.

    Attributes
    ----------
    k : level
    lL : (h, w), ln luminance at this level
    slope : (h, w), length of its gradient
    phi : (h, w), attenuation by this level
    Phi : (h, w), attenuation by this level and all coarser ones
    """

    k: int
    lL: F32
    slope: F32
    phi: F32
    Phi: F32


def find_range(values: F32, black: float = 1e-4, white: float = 1e-4) -> tuple[float, float]:
    """Return the value below which a fraction `black` of the pixels lies, and the one for `white` above.

    At least one pixel lies beyond either value, if there are three.
    """
    every = 1 + values.size // PERCENTILE_PIXELS
    values = np.sort(values[::every])
    middle = (values.size - 1) // 2
    below = min(int(np.ceil(black * values.size)), middle)
    above = min(int(np.ceil(white * values.size)), middle)
    return float(values[below]), float(values[-1 - above])


def log_luminance(L: F32) -> F32:
    """Return lL = ln(L / Lwhite), where 0.01 % of the pixels are brighter than Lwhite.

    The unit of L cancels. Brighter pixels are clipped to white, as the display would clip them. The
    darkest 0.01 % and black pixels are raised to one small luminance.
    """
    black, white = find_range(L[L > 0])
    floor = max(min(black / white, BLACK_LUMINANCE), float(np.finfo(np.float32).tiny))
    return np.log(np.maximum(np.minimum(L, white) / white, floor))


def slope(lL: F32, k: int = 0) -> F32:
    """Return |grad lL_k|, by central differences / 2^(k+1) [Fattal02].

    A step at level k is 2^k pixels of the picture, and a central difference takes two.
    """
    l = np.pad(lL, 1, mode="symmetric")  # noqa: E741
    dy = l[2:, 1:-1] - l[:-2, 1:-1]
    dx = l[1:-1, 2:] - l[1:-1, :-2]
    return np.sqrt(dy * dy + dx * dx) * np.float32(0.5 ** (k + 1))


def attenuation(slope: F32, mean: float, *, alpha: float, beta: float, noise: float) -> F32:
    """Return phi = a / slope (slope / a)^beta, a = alpha mean [Fattal02; Battiato08 eq. 1.41].

    The mean is that of the level's slopes. Where the slope goes to zero, the formula goes to
    infinity, and would amplify the noise of an even sky. So a slope below `noise` times the mean
    counts as `noise` times the mean.
    """
    return (np.maximum(slope / (mean or 1), noise) / alpha) ** (beta - 1)


def attenuation_steps(
    lL: F32, *, alpha: float = 0.1, beta: float = 0.9, noise: float = 0.01
) -> Iterator[Level]:
    """Yield the Level of k = d ... 0: Phi_d = phi_d, Phi_k = enlarged(Phi_(k+1)) phi_k [Battiato08 eq. 1.42].

    Phi is enlarged by linear interpolation. The parameters are those of `attenuation`.
    """
    levels = pyramid.gaussian(lL, pyramid.depth(lL.shape, MIN_LEVEL_SIDE))
    Phi = np.ones_like(levels[-1][::2, ::2])
    for k, lL in reversed(list(enumerate(levels))):
        steepness = slope(lL, k)
        phi = attenuation(steepness, float(steepness.mean()), alpha=alpha, beta=beta, noise=noise)
        Phi = pyramid.interpolate(Phi, lL.shape) * phi
        yield Level(k, lL, steepness, phi, Phi)


def attenuate_gradient(lL: F32, Phi: F32) -> F32:
    """Return G = Phi grad lL, by forward differences [Fattal02; Battiato08 eq. 1.38, 1.39].

    A step lies between two pixels, so Phi there is the mean of both. With the Phi of the first
    pixel alone, the step up to a thin line would be attenuated and the step down would not, and the
    picture would drift with every line.
    """
    G = poisson.gradient(lL)
    G[0, :-1] *= (Phi[:-1] + Phi[1:]) / 2
    G[1, :, :-1] *= (Phi[:, :-1] + Phi[:, 1:]) / 2
    return G


def divergence(lL: F32, Phi: F32) -> F32:
    """Return div G, for `poisson.solve`: Laplacian lLd = div G [Fattal02; Battiato08 eq. 1.40]."""
    return poisson.divergence(attenuate_gradient(lL, Phi))


def display(lLd: F32, *, black: float = 0.001, white: float = 0.005) -> F32:
    """Return Ld = (exp lLd - b) / (w - b), clipped to [0, 1].

    A fraction `black` of the pixels has exp lLd below b, a fraction `white` above w. Where b is
    more than w / 2, b = w / 2, so that an even picture is not stretched over the whole display.
    """
    luminance = np.exp(lLd - lLd.max())
    low, high = find_range(luminance.ravel(), black, white)
    low = min(low, high / 2)
    return np.clip((luminance - np.float32(low)) * np.float32(1 / (high - low)), 0, 1)


def tonemap(
    L: ArrayLike,
    *,
    alpha: float = 0.1,
    beta: float = 0.9,
    noise: float = 0.01,
    black: float = 0.001,
    white: float = 0.005,
) -> F32:
    """Return display luminance with steep gradients of ln L attenuated more than gentle ones.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    alpha : the slope that stays unchanged, in mean slopes of each level. Another alpha multiplies
        Phi, and so lLd, by one number, which changes the contrast of the picture like a gamma
    beta : the power that slopes are raised to, 0 < beta <= 1; the paper has 0.8 to 0.9, 1 changes
        nothing
    noise : the slope below which the attenuation is constant, in mean slopes of each level
    black, white : fractions of the pixels that become black and white

    Returns
    -------
    (H, W) float32 in [0, 1], 1 = white. The paper adds colour to a power of 0.4 to 0.6: see
    SATURATION.

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and at least 0, and parameters out of range.

    References
    ----------
    Fattal, Lischinski, Werman, Gradient domain high dynamic range compression, SIGGRAPH 2002. The
    noise floor and the cut at both ends are additions of pfstools.

    Examples
    --------
    >>> L = np.repeat([[1.0, 100.0, 1e4, 1e6]], 16, axis=1) * np.ones((64, 1))
    >>> Ld = tonemap(L)
    >>> bool(Ld[0, 24] > 100 * L[0, 24] / L.max())  # the dark parts are visible
    True
    """
    L = as_luminance(L)
    if not (0 < alpha < np.inf and 0 < beta <= 1 and 0 < noise < np.inf):
        raise InputError(
            f"expected alpha > 0, 0 < beta <= 1, noise > 0, got {alpha=}, {beta=}, {noise=}"
        )
    if not (0 <= black < 0.5 and 0 <= white < 0.5):
        raise InputError(f"expected fractions black and white in 0 ... 0.5, got {black=}, {white=}")
    if L.max() == 0:
        return np.zeros_like(L)
    lL = log_luminance(L)
    finest = steps.last(attenuation_steps(lL, alpha=alpha, beta=beta, noise=noise))
    lLd = poisson.solve(divergence(lL, finest.Phi))
    return display(lLd, black=black, white=white)
