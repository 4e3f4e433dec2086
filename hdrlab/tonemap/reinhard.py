"""Photographic tone reproduction (Reinhard, Stark, Shirley, Ferwerda, SIGGRAPH 2002): global; dodge and burn.

L       luminance                          (H, W) >= 0, any linear unit
Lav     log average of L                   same unit: how bright the scene is on the whole
a       key                                what Lav becomes, 0.18: middle gray
Lm      scaled luminance, a L / Lav        (H, W), 1 = about white
white   the Lm that becomes white
s       width of a neighbourhood, pixels   1, 1.6, ..., 43: nine, each 1.6 times the one before
V1(s)   Lm blurred at width s              (H, W); the surround V2(s) is V1 at the next width
V       centre-surround response           (H, W), about 0 where the neighbourhood is even
Ld      display luminance                  (H, W) in [0, 1]

The paper's Gaussian exp(-(x^2 + y^2) / (alpha s)^2), alpha = 1 / (2 sqrt 2), has sigma = s / 4.
"""

from collections.abc import Iterable, Iterator
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import as_luminance
from hdrlab.core.blur import gaussian
from hdrlab.core.extremes import robust_maximum, robust_minimum
from hdrlab.core.steps import last

Float = NDArray[np.float32]

LAWS = ("monotone", "exposure")
WIDTHS = tuple(1.6**i for i in range(9))  # eight centres, and the surround of the last
LIMIT = np.float32(1e30)  # scaled luminance beyond this is white like any other, and its sums stay finite
TINY = float(np.finfo(np.float32).tiny)
BAND = 64  # rows at a time, which stay in the processor's cache


class Scale(NamedTuple):
    """The search for each pixel's neighbourhood after one more width.

    Attributes
    ----------
    width : s
    centre : (H, W), V1(s)
    response : (H, W), V(s)
    even : (H, W) bool, where the response has stayed small at this width and at all smaller ones
    adaptation : (H, W), V1 at the largest width that was still even; the smallest width where none was
    """

    width: float
    centre: Float
    response: Float
    even: NDArray[np.bool_]
    adaptation: Float


def log_average(L: Float, *, delta: float = 1e-6) -> float:
    """Return Lav = exp(mean(log(delta + L))) [Reinhard02, where 1 / N is misprinted outside exp].

    So that the unit of L cancels, delta is measured in medians of L; it stands for what is black.
    """
    floor = max(delta * robust_maximum(L, cut=0.5), TINY)
    return float(np.exp(np.log(L + np.float32(floor)).mean(dtype=np.float64)))


def automatic_key(L: Float) -> float:
    """Return a = 0.18 4^((2 log2 Lav - log2 Lmin - log2 Lmax) / (log2 Lmax - log2 Lmin)) [Reinhard02b].

    A scene that is mostly bright for its range gets a high key. Lmin and Lmax leave out 1 % of the pixels.
    """
    low, high = robust_minimum(L, cut=0.01), robust_maximum(L, cut=0.01)
    if not 0 < low < high:
        return 0.18
    low, middle, high = np.log2([low, np.clip(log_average(L), low, high), high])
    return float(0.18 * 4 ** ((2 * middle - low - high) / (high - low)))


def scaled(L: Float, *, key: float = 0.18) -> Float:
    """Return Lm = a L / Lav [Battiato08 eq. 1.32]."""
    with np.errstate(over="ignore"):
        return np.minimum(L / np.float32(max(log_average(L) / key, TINY)), LIMIT)


def white_point(Lm: Float) -> float:
    """Return the brightest Lm but for 0.01 % of the pixels, and at least 1: dim scenes are not stretched."""
    return max(1.0, robust_maximum(Lm))


def display(Lm: Float, adaptation: Float, white: float = np.inf) -> Float:
    """Return Ld = Lm (1 + Lm / white^2) / (1 + adaptation), clipped at 1.

    With Lm itself as the adaptation it is the global operator [Reinhard02 eq. 4; Battiato08 eq. 1.33]; with
    V1 at each pixel's own width it is dodge and burn [Battiato08 eq. 1.35], printed for an infinite white.
    """
    Ld = Lm / (1 + adaptation)
    with np.errstate(over="ignore"):
        return np.minimum(Ld * (1 + Lm / np.float32(white) / np.float32(white)), 1)


def blurs(Lm: Float) -> Iterator[Float]:
    """Yield V1(s) for s = 1, 1.6, ..., 43 [Battiato08 eq. 1.34]."""
    return (gaussian(Lm, s / 4) for s in WIDTHS)


def response(V1: Float, V2: Float, *, width: float, key: float = 0.18, phi: float = 8.0) -> Float:
    """Return V = (V1 - V2) / (2^phi a / s^2 + V1) [Battiato08 eq. 1.37]."""
    return (V1 - V2) / (np.float32(2**phi * key / width**2) + V1)


def scale_steps(
    blurred: Iterable[Float], *, key: float = 0.18, phi: float = 8.0, threshold: float = 0.05
) -> Iterator[Scale]:
    """Yield the Scale of each width, from small to large, given V1 at every width [Reinhard02]."""
    surrounds = iter(blurred)
    centre = adaptation = next(surrounds)
    even = np.ones_like(centre, dtype=bool)
    for width, surround in zip(WIDTHS, surrounds, strict=False):
        V = response(centre, surround, width=width, key=key, phi=phi)
        even = even & (np.abs(V) < threshold)
        adaptation = np.where(even, centre, adaptation)
        yield Scale(width, centre, V, even, adaptation)
        centre = surround


def chosen(scales: Iterable[Scale]) -> NDArray[np.uint8]:
    """Return the index into WIDTHS of each pixel's neighbourhood: how many widths stayed even, less one."""
    count = np.add.reduce([scale.even for scale in scales], dtype=np.uint8)
    return np.maximum(count, 1) - np.uint8(1)


def adaptation(Lm: Float, *, key: float = 0.18, phi: float = 8.0, threshold: float = 0.05) -> Float:
    """Return V1 of each pixel at its own width: the last of scale_steps(blurs(Lm))."""
    return last(scale_steps(blurs(Lm), key=key, phi=phi, threshold=threshold)).adaptation


def bands(Lm: Float) -> Iterator[slice]:
    """Yield the rows of the picture, BAND at a time."""
    return (slice(top, top + BAND) for top in range(0, len(Lm), BAND))


def tonemap(
    L: ArrayLike,
    *,
    key: float | Literal["auto"] = 0.18,
    white: float | None = None,
    local: bool = False,
    phi: float = 8.0,
    threshold: float = 0.05,
) -> Float:
    """Return display luminance as a photographer prints it: expose for middle gray, hold back the highlights.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    key : a, what the scene's log average is scaled to; "auto" takes it from the histogram (`automatic_key`)
    white : the scaled luminance Lm that becomes white; None takes the scene's own (`white_point`)
    local : dodge and burn, each pixel held back by its own neighbourhood
    phi : sharpening at edges, local only
    threshold : epsilon, the response at which a neighbourhood is no longer even, local only

    Returns
    -------
    (H, W) float32 in [0, 1], 1 = white

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and positive or zero, and knobs that are not positive.

    References
    ----------
    Reinhard, Stark, Shirley, Ferwerda, Photographic tone reproduction for digital images, SIGGRAPH 2002.
    Reinhard, Parameter estimation for photographic tone reproduction, Journal of Graphics Tools 7(1), 2002.

    Examples
    --------
    >>> tonemap(np.full((1, 2), 300.0), white=np.inf).round(3)
    array([[0.153, 0.153]], dtype=float32)
    """
    L = as_luminance(L)
    a = automatic_key(L) if key == "auto" else _positive("key", key)
    Lm = scaled(L, key=a)
    Lwhite = white_point(Lm) if white is None else _positive("white", white)
    V1 = adaptation(Lm, key=a, phi=phi, threshold=_positive("threshold", threshold)) if local else Lm
    Ld = np.empty_like(Lm)
    for rows in bands(Lm):
        Ld[rows] = display(Lm[rows], V1[rows], Lwhite)
    return Ld


def _positive(name: str, value: float | str) -> float:
    if isinstance(value, str) or not value > 0:
        raise ValueError(f"expected {name} > 0, got {value!r}")
    return float(value)
