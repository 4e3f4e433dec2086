"""Metering: one number from a picture, and the exposure that follows (Battiato et al. 2008, sec. 1.2).

B      brightness     (H, W) in [0, 1], linear: the exposure of each pixel, 1 where it is full
w      weight         (H, W) >= 0, sum 1: how much each pixel counts
B_pre  the reading    sum of w B over the picture
B_opt  what the reading should be: 0.18, a surface that reflects a fifth of the light
EV     exposure value, stops: one more halves the light

A meter does not know what it looks at. It takes the world for gray, so snow comes out gray, and a
black locomotive too; the modes differ in which pixels they ask.
"""

from functools import lru_cache

import numpy as np

from hdrlab.core.arrays import F64, Array, ArrayLike, NDArray, as_luminance, describe
from hdrlab.errors import InputError

At = tuple[float, float]

# B_opt, share of full
MIDDLE_GRAY = 0.18
# how bright a full pixel is taken to be: it says "at least 1", and too dark a next shot is soon
# corrected
FULL_PIXEL_BRIGHTNESS = 16.0


def _places(shape: tuple[int, int], at: At) -> tuple[Array, Array]:
    """Return how far down and right of `at` each pixel lies, in heights and in widths of the picture."""
    if len(shape) != 2 or min(shape) < 1:
        raise InputError(f"expected the shape (H, W) of a picture, got {shape}")
    if not all(0 <= part <= 1 for part in at):
        raise InputError(
            f"expected a place (down, right) as parts of the picture, 0 to 1, got {at}"
        )
    down, right = ((np.arange(n) + 0.5) / n - part for n, part in zip(shape, at, strict=True))
    return down[:, None], right[None, :]


def _normal(w: Array) -> F64:
    return w / w.sum()


def average(shape: tuple[int, int]) -> F64:
    """Return w = 1 / (H W): every pixel counts alike."""
    return _normal(np.ones(shape))


def spot(shape: tuple[int, int], *, at: At = (0.5, 0.5), share: float = 0.03) -> F64:
    """Return equal weight in a disc, the `share` of the pixels nearest to `at`, and none elsewhere.

    A spot meter's disc is 1 to 5 % of the picture.
    """
    if not 0 < share <= 1:
        raise InputError(f"expected a share of the picture from 0 to 1, got {share}")
    down, right = _places(shape, at)
    distance = np.hypot(down * shape[0], right * shape[1])
    reach = np.sort(distance, axis=None)[max(round(share * distance.size), 1) - 1]
    return _normal(distance <= reach)


def partial(shape: tuple[int, int], *, at: At = (0.5, 0.5), share: float = 0.12) -> F64:
    """Return equal weight in a disc of 10 to 15 % of the picture, and none elsewhere."""
    return spot(shape, at=at, share=share)


def centre(
    shape: tuple[int, int], *, inside: float = 0.7, share: float = 0.25, at: At = (0.5, 0.5)
) -> F64:
    """Return weight of which `inside`, 60 to 80 %, lies in the central `share`, feathered toward the edges.

    It falls as a Gaussian of the distance, whose width is found by halving.
    """
    if not share < inside < 1:
        raise InputError(
            f"expected more than {share} of the weight inside, and less than 1, got {inside}"
        )
    down, right = _places(shape, at)
    squared = down**2 + right**2
    core = spot(shape, at=at, share=share) > 0
    low = 0.01
    high = 100.0
    for _ in range(60):
        sigma = np.sqrt(low * high)
        w = _normal(np.exp(-squared / (2 * sigma**2)))
        low, high = (sigma, high) if w[core].sum() > inside else (low, sigma)
    return w


def _honeycomb(down: Array, right: Array) -> Array:
    """Hexagons: each pixel belongs to the nearest of centres in five staggered rows of six and five."""
    rows = np.repeat(np.arange(5), [6, 5, 6, 5, 6])
    columns = np.concatenate([np.arange(6), np.arange(5) + 0.5] * 2 + [np.arange(6)])
    tall = down[..., None] - (rows / 5 - 0.4)
    wide = right[..., None] - ((columns + 0.5) / 6 - 0.5)
    return np.argmin((2 * tall) ** 2 + (3 * wide) ** 2, axis=-1)


@lru_cache(16)
def zones(shape: tuple[int, int]) -> NDArray[np.int64]:
    """Return which of a matrix meter's zones each pixel (H, W) lies in, from 0 to 27.

    A meter's zones stay as they are from shot to shot: they are kept, and must not be written to.
    """
    down, right = _places(shape, (0.5, 0.5))
    labels = _honeycomb(*np.broadcast_arrays(down, right))
    found = np.unique(labels, return_inverse=True)[1].reshape(shape)
    found.flags.writeable = False
    return found


def matrix(B: ArrayLike, *, at: At = (0.5, 0.5), near: float = 0.2, tolerance: float = 2.0) -> F64:
    """Return a matrix meter's weights: zones near the focus point count more, zones far from the others less.

    A zone's weight is exp(-d^2 / (2 near^2)) exp(-e^2 / (2 tolerance^2)): d is its distance from
    the focus point, in pictures, and e its distance in stops from the median zone, which leaves out
    a bare sun. Makers do not tell their rules; this one has what the text says they take into
    account.
    """
    B = as_luminance(B)
    labels = zones(B.shape)
    area = np.bincount(labels.ravel())

    def mean(values: Array) -> Array:
        return np.bincount(labels.ravel(), np.broadcast_to(values, B.shape).ravel()) / area

    down, right = _places(B.shape, at)
    stops = np.log2(np.maximum(mean(B), 2.0**-14))
    closeness = np.exp(-(mean(down) ** 2 + mean(right) ** 2) / (2 * near**2))
    likeness = np.exp(-((stops - np.median(stops)) ** 2) / (2 * tolerance**2))
    return _normal((closeness * likeness / area)[labels])


MODES = ("spot", "partial", "centre", "average", "matrix")


def weights(B: ArrayLike, mode: str, *, at: At = (0.5, 0.5)) -> F64:
    """Return the weights (H, W) of a mode, of MODES, for a picture of brightness B."""
    B = as_luminance(B)
    if mode not in MODES:
        raise InputError(f"expected a mode among {', '.join(MODES)}, got {mode!r}")
    return matrix(B, at=at) if mode == "matrix" else _blind(mode, B.shape, tuple(at)).copy()


@lru_cache(16)
def _blind(mode: str, shape: tuple[int, int], at: At) -> F64:
    """Return the weights of a mode that does not look at the picture: kept, as no shot changes them."""
    modes = {"spot": spot, "partial": partial, "centre": centre}
    return average(shape) if mode == "average" else modes[mode](shape, at=at)


def reading(B: ArrayLike, w: ArrayLike) -> float:
    """Return B_pre = sum w B / sum w."""
    B = as_luminance(B)
    w = np.asarray(w, np.float64)
    if w.shape != B.shape or not np.all(w >= 0) or not w.sum() > 0:
        raise InputError(
            f"expected weights of shape {B.shape}, positive somewhere, got {describe(w)}"
        )
    return float((w * B).sum() / w.sum())


def optimum(EV_pre: float, B_pre: float, B_opt: float = MIDDLE_GRAY) -> float:
    """Return EV_opt = EV_pre + log2 B_pre - log2 B_opt [Battiato08 eq. 1.2]; right where no pixel is full.

    Examples
    --------
    >>> float(optimum(10, 0.72))  # four times too bright: two stops more of exposure value
    12.0
    """
    return EV_pre + np.log2(B_pre) - np.log2(B_opt)


def predict_reading(B: ArrayLike, w: F64, stops: float) -> float:
    """Return the reading after `stops` more light, sum w min(2^stops B, 1), where a full B counts as 16."""
    B = np.asarray(B, np.float64)
    return float((w * np.minimum(np.where(B < 1, B, FULL_PIXEL_BRIGHTNESS) * 2.0**stops, 1)).sum())


def correction(B: ArrayLike, w: F64, B_opt: float = MIDDLE_GRAY, *, most: float = 8.0) -> float:
    """Return the stops after which the reading will be B_opt, at most `most` either way, found by halving.

    Where nothing is full, and nothing will be, this is log2 B_opt - log2 B_pre, eq. 1.2.
    """
    low = -most
    high = most
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if predict_reading(B, w, middle) < B_opt else (low, middle)
    return (low + high) / 2
