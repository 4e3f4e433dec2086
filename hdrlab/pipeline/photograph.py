"""A picture for photographers: light compressed where it must be, exposure and contrast set from the map.

L       luminance                 (H, W), any linear unit; lL its decades, log10 L
light   large-scale light of lL   (H, W), a lL + b of a guided filter: smooth but for its edges
x       lL - (1 - share) light    (H, W): the light's contrast is multiplied by `share`, all detail stays
Lm      scaled luminance          key 10^(CONTRAST (x - mean of x)), 1 about where the curve bends
Ld      (curve of Lm - black) / (1 - black), by the curve of `tonemap.reinhard` and its `white`

The defaults of Reinhard's paper are flat for a photograph: black is not set, and half of the
display's range is kept for the brightest pixels. A guided filter reverses no gradients beside soft
edges, unlike a bilateral one; its a and b are found on a coarse grid (He and Sun, Fast guided
filter, 2015).
"""

from collections.abc import Callable

import numpy as np

from hdrlab.core import colour, extremes
from hdrlab.core.arrays import F32, Array, ArrayLike, as_luminance, as_radiance
from hdrlab.core.filters.blur import blur_matrix
from hdrlab.errors import InputError
from hdrlab.fast._bands import banded
from hdrlab.tonemap.reinhard import display

# half of the guided filter's window, of the longer side; nodes of the coarse grid in that half
REACH, NODES = 0.03, 4
# of the median luminance: what is darker has no more detail
DARK = 1e-6
# decades: a step of light that stays an edge
EDGE = 0.35
# decades of light that a display shows with ease, and the least share that stays of more
RANGE, LEAST = 1.9, 0.45
# key of a map whose log luminance lies evenly about its mean
MIDDLE = 0.24
# contrast of the picture over that of x
CONTRAST = 1.25
# shares of the pixels that are white and black, and the most that is taken off as black
WHITE, BLACK, DEEPEST = 0.005, 0.002, 0.012
# pixels along a side that settings are chosen by, at least
ENOUGH = 360


def choose_settings(E: ArrayLike) -> dict[str, float]:
    """Return the knobs of `photograph` for a map E (H, W[, 3]), and its saturation, all from percentiles.

    share : of the light's contrast that stays, 1 where it spans at most RANGE decades
    key : MIDDLE; up to twice that where most of the map is bright for its range, half of it where
        dark
    white, black : the scaled and the display luminance that WHITE and BLACK of the pixels lie
        beyond
    saturation : 1.25 of grays, 0.95 where half of the pixels have the purest of colours

    Examples
    --------
    >>> E = np.geomspace(1, 1000, 4800, dtype=np.float32).reshape(60, 80)
    >>> {name: round(value, 2) for name, value in choose_settings(E).items()}
    {'share': 0.67, 'key': 0.24, 'white': 4.37, 'black': 0.01, 'saturation': 1.0}
    """
    E = as_radiance(E)
    every = max(1, min(E.shape[:2]) // ENOUGH)
    E = E[::every, ::every]
    L, share = colour.luminance(E), 1.0
    lL = find_logarithm(L)(L)
    a, b, down = light = filter_light(lL)
    low, high = np.quantile(down @ a * lL + down @ b, [0.005, 0.995])
    if high - low > RANGE:
        share = max(LEAST, RANGE / float(high - low))
    low, mean, high = find_levels(x := compress_light(lL, share, *light))
    key = MIDDLE * 2 ** ((2 * mean - low - high) / max(high - low, 1e-6))
    Lm = scale(x, mean, key)
    white = max(1.0, float(np.quantile(Lm, 1 - WHITE)))
    black, saturation = min(DEEPEST, float(np.quantile(display(Lm, Lm, white), BLACK))), 1.0
    if E.ndim == 3 and L.any():
        colours = E[L > 0]
        saturation = 1.25 - 0.3 * float(np.median(1 - colours.min(axis=-1) / colours.max(axis=-1)))
    return {"share": share, "key": key, "white": white, "black": black, "saturation": saturation}


def find_logarithm(L: F32) -> Callable[[F32], F32]:
    """Return the function to lL = log10 L, for which black is a millionth of the median of this L."""
    floor = np.float32(max(DARK * extremes.positive_median(L), 1e-37))
    return lambda L: np.log(np.maximum(L, floor)) * np.float32(1 / np.log(10))


def filter_light(L: F32, take: Callable[[F32], F32] = np.positive) -> tuple[Array, Array, F32]:
    """Return the light's a and b at nodes, (h, W), and the weights (H, h) of these in each row [He15].

    `take` returns lL from L (H, W), which is looked at in nodes; a is near 1 at edges of light, 0
    in detail.
    """
    reach = max(1, round(REACH * max(L.shape)))
    step = max(1, reach // NODES)
    few, width = take(L[::step, ::step]), 2 * (reach // step) + 1
    H, W = (blur_matrix(n, np.full(width, 1 / width)) for n in few.shape)
    mean: Array = H @ few @ W
    variance: Array = np.maximum(H @ (few * few) @ W - mean * mean, 0)
    a = variance / (variance + np.float32(EDGE**2))
    down, across = (draw_lines(n, m, step) for n, m in zip(L.shape, few.shape, strict=True))
    across = W @ across.T
    return H @ a @ across, H @ (mean - a * mean) @ across, down


def draw_lines(n: int, m: int, step: int) -> F32:
    """Return (n, m): from m values, at every `step`-th of n pixels, those at all, on lines between them."""
    at = np.minimum(np.arange(n, dtype=np.float32) / np.float32(step), m - 1)
    return np.maximum(1 - np.abs(at[:, None] - np.arange(m, dtype=np.float32)), 0)


def compress_light(lL: F32, share: float, a: Array, b: Array, down: F32) -> F32:
    """Return x = lL - (1 - share) (a lL + b) of some rows (n, W), by their weights (n, h) of the nodes."""
    if share == 1:
        return lL
    near = np.flatnonzero(down.any(axis=0))
    a, b = (down[:, near] @ (np.float32(1 - share) * one[near]) for one in (a, b))
    return np.asarray(lL - (a * lL + b), np.float32)


def find_levels(x: F32) -> tuple[float, float, float]:
    """Return the first percentile of x, the mean of x cut at its first and its last, and the last."""
    few = x[:: max(1, len(x) // ENOUGH), :: max(1, x.shape[1] // ENOUGH)]
    low, high = np.quantile(few, [0.01, 0.99])
    return float(low), float(np.clip(few, low, high).mean(dtype=np.float64)), float(high)


def scale(x: F32, mean: float, key: float) -> F32:
    """Return Lm = key 10^(CONTRAST (x - mean)), at most 1e15."""
    exponent = np.log(np.float32(key)) + np.float32(CONTRAST * np.log(10)) * (x - np.float32(mean))
    return np.exp(np.minimum(exponent, np.log(np.float32(1e15))))


def photograph(L: ArrayLike, *, share: float, key: float, white: float, black: float) -> F32:
    """Return display luminance (H, W) in [0, 1] of luminance L (H, W); the knobs: see `choose_settings`.

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and positive or zero, and knobs out of range.
    """
    numbers = all(isinstance(knob, int | float) for knob in (share, key, white, black))
    if not (numbers and 0 < share <= 1 and key > 0 and white > 0 and 0 <= black < 1):
        got = f"{share=}, {key=}, {white=}, {black=}"
        raise InputError(
            f"expected share in (0, 1], key and white above 0, black in [0, 1), got {got}"
        )
    L = as_luminance(L)
    take, some = find_logarithm(L), np.s_[:: max(1, len(L) // ENOUGH)]
    a, b, down = filter_light(L, take)
    _, mean, _ = find_levels(compress_light(take(L[some]), share, a, b, down[some]))

    def curve(L: F32, down: F32) -> F32:
        Lm = scale(compress_light(take(L), share, a, b, down), mean, key)
        Ld = np.clip((display(Lm, Lm, white) - np.float32(black)) / np.float32(1 - black), 0, 1)
        return np.where(L > 0, Ld, 0)

    return banded(curve, L, down)
