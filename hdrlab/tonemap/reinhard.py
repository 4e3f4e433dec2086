"""Photographic tone reproduction (Reinhard, Stark, Shirley, Ferwerda, SIGGRAPH 2002): global; dodge and burn.

L       luminance                          (H, W) >= 0, any linear unit
Lav     log average of L                   same unit: how bright the scene is on the whole
a       key                                what Lav becomes, 0.18: middle gray
Lm      scaled luminance, a L / Lav        (H, W), 0.18 = middle gray if a is 0.18
white   the Lm that becomes white
s       width of a neighbourhood, pixels   1, 1.6, ..., 43: nine, each 1.6 times the one before
V1(s)   Lm blurred at width s              (H, W); the surround V2(s) is V1 at the next width
V       centre-surround response           (H, W), about 0 where the neighbourhood is even
Ld      display luminance                  (H, W) in [0, 1]

The paper's Gaussian exp(-(x^2 + y^2) / (alpha s)^2), alpha = 1 / (2 sqrt 2), has sigma = s / 4.
"""

from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np

from hdrlab.core import steps
from hdrlab.core.arrays import F32, Array, ArrayLike, Flags, Mask
from hdrlab.errors import InputError

LAWS = ("monotone", "exposure")
# eight centres, and the surround of the last
WIDTHS = tuple(1.6**i for i in range(9))


class Scale(NamedTuple):
    """The search for each pixel's neighbourhood after each width.

    Attributes
    ----------
    width : s
    centre : (H, W), V1(s)
    response : (H, W), V(s)
    even : (H, W) bool, where the response has stayed small at this width and at all smaller ones
    adaptation : (H, W), V1 at the largest width that was still even; the smallest width where none
        was
    """

    width: float
    centre: F32
    response: F32
    even: Mask
    adaptation: F32


def log_average(L: F32, *, delta: float = 1e-6) -> float:
    """Return Lav = exp(mean(log(delta + L))) [Reinhard02, where 1 / N is misprinted outside exp].

    So that the unit of L cancels, delta is measured in medians of the positive L; it stands for
    black.
    """
    median = np.median(L[L > 0]) if np.any(L) else 1.0
    return float(np.exp(np.log(L + delta * float(median)).mean(dtype=np.float64)))


def automatic_key(L: F32) -> float:
    """Return a = 0.18 4^((2 log2 Lav - log2 Lmin - log2 Lmax) / (log2 Lmax - log2 Lmin)) [Reinhard02b].

    A scene that is mostly bright for its range gets a high key. Lmin and Lmax are the percentiles 1
    and 99.
    """
    if not np.any(L):
        return 0.18
    low, high = np.log2(np.quantile(L[L > 0], [0.01, 0.99]))
    middle = np.clip(np.log2(log_average(L)), low, high)
    return float(0.18 * 4 ** ((2 * middle - low - high) / max(high - low, 1e-9)))


def scale_to_key(L: F32, *, key: float = 0.18) -> F32:
    """Return Lm = a L / Lav [Battiato08 eq. 1.32]."""
    return L * (key / log_average(L))


def white_point(Lm: F32) -> float:
    """Return the Lm that 0.01 % of the pixels exceed, but at least 1, so that dim scenes stay dim."""
    return max(1.0, float(np.quantile(Lm, 0.9999, method="lower")))


def display(Lm: F32, adaptation: F32, white: float = np.inf) -> F32:
    """Return Ld = Lm (1 + Lm / white^2) / (1 + adaptation), clipped at 1.

    With Lm itself as the adaptation it is the global operator [Reinhard02 eq. 4; Battiato08 eq.
    1.33]; with V1 at each pixel's own width it is dodge and burn [Battiato08 eq. 1.35], printed for
    an infinite white.
    """
    return np.minimum(Lm * (1 + Lm / white**2) / (1 + adaptation), 1)


def blurs(Lm: F32) -> Iterator[F32]:
    """Yield V1(s) for s = 1, 1.6, ..., 43 [Battiato08 eq. 1.34]."""
    from scipy.ndimage import gaussian_filter  # large, and `display` does without it

    return (gaussian_filter(Lm, s / 4) for s in WIDTHS)


def response(V1: F32, V2: F32, *, width: float, key: float = 0.18, phi: float = 8.0) -> F32:
    """Return V = (V1 - V2) / (2^phi a / s^2 + V1) [Battiato08 eq. 1.37]."""
    return (V1 - V2) / (2**phi * key / width**2 + V1)


def scale_steps(
    blurred: Iterable[F32], *, key: float = 0.18, phi: float = 8.0, threshold: float = 0.05
) -> Iterator[Scale]:
    """Yield the Scale of each width, from small to large, given V1 at every width [Reinhard02]."""
    even = np.array(True)
    adaptation = np.zeros(1, np.float32)
    for width, (V1, V2) in zip(WIDTHS, pairwise(blurred), strict=False):
        V = response(V1, V2, width=width, key=key, phi=phi)
        even = even & (np.abs(V) < threshold)
        adaptation = V1 if width == WIDTHS[0] else np.where(even, V1, adaptation)
        yield Scale(width, V1, V, even, adaptation)


def select_widths(scales: Iterable[Scale]) -> Flags:
    """Return the index into WIDTHS of each pixel's neighbourhood: the number of even widths, minus one."""
    count = np.add.reduce([scale.even for scale in scales], dtype=np.uint8)
    return np.maximum(count, 1) - np.uint8(1)


def local_adaptation(
    Lm: F32, *, key: float = 0.18, phi: float = 8.0, threshold: float = 0.05
) -> F32:
    """Return V1 of each pixel at its own width: the last of scale_steps(blurs(Lm))."""
    scales = scale_steps(blurs(Lm), key=key, phi=phi, threshold=threshold)
    return steps.last(scales).adaptation


def tonemap(
    L: ArrayLike,
    *,
    key: float | Literal["auto"] = 0.18,
    white: float | None = None,
    local: bool = False,
    phi: float = 8.0,
    threshold: float = 0.05,
) -> F32:
    """Return display luminance by photographic tone reproduction, global or with dodging and burning.

    The log average of the scene becomes middle gray, and highlights are compressed.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    key : a, the value that the scene's log average is scaled to; "auto" computes it from the
        histogram (`automatic_key`)
    white : the scaled luminance Lm that becomes white; None computes it from the scene
        (`white_point`)
    local : dodge and burn: compress each pixel by the luminance of its own neighbourhood
    phi : sharpening at edges, local only
    threshold : epsilon, the response at which a neighbourhood is no longer even, local only

    Returns
    -------
    (H, W) float32 in [0, 1], 1 = white

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and at least 0, and parameters that are not
        positive.

    References
    ----------
    Reinhard, Stark, Shirley, Ferwerda, Photographic tone reproduction for digital images, SIGGRAPH
    2002. Reinhard, Parameter estimation for photographic tone reproduction, Journal of Graphics
    Tools 7(1), 2002.

    Examples
    --------
    >>> tonemap(np.full((1, 2), 300.0), white=np.inf).round(3)
    array([[0.153, 0.153]], dtype=float32)
    """
    L = as_light(L)
    a = automatic_key(L) if key == "auto" else key
    if isinstance(a, str) or not (a > 0 and threshold > 0 and (white is None or white > 0)):
        raise InputError(
            f"expected key, white and threshold above 0, got {key=}, {white=}, {threshold=}"
        )
    Lm = scale_to_key(L, key=a)
    white = white_point(Lm) if white is None else white
    V1 = local_adaptation(Lm, key=a, phi=phi, threshold=threshold) if local else Lm
    return np.asarray(display(Lm, V1, white), np.float32)


def as_light(L: ArrayLike) -> Array:
    """Return L as float64 (H, W), finite and not negative, or raise a ValueError."""
    L = np.ma.filled(L, np.nan)
    if (
        L.ndim != 2
        or L.dtype.kind not in "iuf"
        or not (L.size and L.min() >= 0 and L.max() < np.inf)
    ):
        raise InputError(
            f"expected luminance (H, W), finite and not negative, got {L.dtype} {L.shape}"
        )
    return L.astype(np.float64)
