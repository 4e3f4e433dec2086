"""Adaptive logarithmic mapping (Drago, Myszkowski, Annen, Chiba, Computer Graphics Forum 22(3), 2003).

L        luminance                      (H, W) >= 0, any linear unit
Lwa      log average of L               same unit: what the eye of the viewer is adapted to
Lw       adapted luminance, L / Lwa     (H, W), 1 = as bright as the scene on the whole
Lwmax    the largest Lw                 it becomes white
b        bias, 0 to 1                   0.85; a smaller one brightens the middle tones
Ld       display luminance              (H, W), 1 = white

A logarithm compresses like the eye, but one base does not fit a whole scene: base 2 keeps the
contrast of dark places and makes lamps white, base 10 keeps the lamps and leaves the rest dark. So
the base goes from 2 for black to 10 for the brightest luminance, and the bias decides how soon.
"""

import numpy as np

from hdrlab.core.arrays import F32, F64, ArrayLike, as_luminance
from hdrlab.core.extremes import robust_maximum
from hdrlab.errors import InputError
from hdrlab.tonemap.reinhard import log_average

LAWS = ("monotone", "exposure")


def bias_power(t: ArrayLike, b: float) -> F64:
    """Return t^(ln b / ln 0.5) for t in 0 to 1, which is b at t = 0.5 and t itself for b = 0.5 [Perlin89]."""
    return np.asarray(t, np.float64) ** (np.log(b) / np.log(0.5))


def adaptive_log(L: ArrayLike, Lwa: float, Lmax: float, *, bias: float = 0.85) -> F64:
    """Return Ld = log_B(Lw + 1) / log10(Lwmax + 1), where the base B rises from 2 to 10 [Drago03].

    Lw = L / Lwa and Lwmax = Lmax / Lwa. The base is B = 2 + 8 (Lw / Lwmax)^(ln b / ln 0.5), and
    log_B(x) is ln x / ln B. The equation is that of a display whose white is 100 cd/m2.

    Parameters
    ----------
    L : luminance, 0 to Lmax, any shape and any linear unit
    Lwa : log average of the scene's luminance, above 0
    Lmax : the luminance that becomes white, above 0
    bias : b, above 0 and at most 1

    Returns
    -------
    Ld : float64, shape of L, 1 = white. It exceeds 1 just below Lmax if log10(1 + Lwmax) is above
        1.25 ln 0.5 / ln b, because there the base grows faster than the luminance: above
        Lwmax = 2e5 with a bias of 0.85, and above 270 with 0.7.

    Examples
    --------
    >>> adaptive_log([0, 1, 10, 100], 1.0, 100.0).round(2)
    array([0.  , 0.22, 0.63, 1.  ])
    """
    Lw = np.asarray(L, np.float64) / Lwa
    Lwmax = Lmax / Lwa
    base = 2 + 8 * bias_power(Lw / Lwmax, bias)
    logarithm = np.log(Lw + 1) / np.log(base)
    return logarithm / np.log10(Lwmax + 1)


def tonemap(L: ArrayLike, *, bias: float = 0.85) -> F32:
    """Return display luminance by a logarithm whose base rises from 2 in the dark to 10 in the light.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    bias : b, above 0 and at most 1; 0.7 to 0.9 is usual. With 1, the base is 10 everywhere

    Returns
    -------
    (H, W) float32 in [0, 1], 1 = white. It is light: the paper, too, encodes it for the display
    afterwards.

    Raises
    ------
    InputError
        For luminance that is not (H, W), finite and at least 0, and a bias out of range.

    Notes
    -----
    Lwmax is the luminance that 0.01 % of the pixels exceed, so that a hot pixel does not darken the
    image; the paper uses the maximum. Some programs divide Lwa by (1 + b - 0.85)^5, so that another
    bias leaves the image about as bright. This is left out here.

    References
    ----------
    Drago, Myszkowski, Annen, Chiba, Adaptive logarithmic mapping for displaying high contrast
    scenes, Computer Graphics Forum 22(3), 2003.

    Examples
    --------
    >>> tonemap(np.array([[0.0, 1.0, 10.0, 100.0, 1000.0, 1000.0]])).round(2)
    array([[0.  , 0.05, 0.27, 0.67, 1.  , 1.  ]], dtype=float32)
    """
    L = as_luminance(L)
    if not 0 < bias <= 1:
        raise InputError(f"expected a bias above 0 and at most 1, got {bias}")
    brightest = robust_maximum(L)
    if brightest == 0:
        return np.zeros_like(L)
    Lwa = log_average(L.astype(np.float64))
    Ld = adaptive_log(np.minimum(L, np.float32(brightest)), Lwa, brightest, bias=bias)
    return np.clip(Ld, 0, 1).astype(np.float32)
