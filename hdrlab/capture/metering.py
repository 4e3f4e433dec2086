"""Metering: one number from a picture, and the exposure that follows (Battiato et al. 2008, sec. 1.2).

B      brightness     (H, W) in [0, 1], linear: the exposure of each pixel, 1 where it is full
w      weight         (H, W) >= 0, sum 1: how much each pixel counts
B_pre  the reading    sum of w B over the picture
B_opt  what the reading should be: 0.18, a surface that reflects a fifth of the light
EV     exposure value, stops: one more halves the light

A meter does not know what it looks at. It assumes that the world is gray, so snow comes out gray,
and so does a black locomotive. The modes differ in which pixels they count.
"""

from functools import lru_cache

import numpy as np

from hdrlab.core.arrays import F64, Array, ArrayLike, NDArray, as_luminance, describe
from hdrlab.errors import InputError

At = tuple[float, float]

# B_opt, as a fraction of full
MIDDLE_GRAY = 0.18
# A full pixel is at least 1 bright; how bright is unknown. A high guess makes the next shot too dark,
# which is soon corrected.
FULL_PIXEL_BRIGHTNESS = 16.0
# `matrix` counts darker zones as this bright, 14 stops below full
_MIN_ZONE_BRIGHTNESS = 2.0**-14
# Halving steps of the two searches; each one makes the result more exact by a factor of two.
_WIDTH_HALVINGS = 60
_STOPS_HALVINGS = 40


def _places(shape: tuple[int, int], at: At) -> tuple[Array, Array]:
    """Return each pixel's distance from `at`, down in heights and right in widths of the picture."""
    if len(shape) != 2 or min(shape) < 1:
        raise InputError(f"expected the shape (H, W) of a picture, got {shape}")
    if not all(0 <= part <= 1 for part in at):
        raise InputError(
            f"expected a position (down, right) as fractions of the image, 0 to 1, got {at}"
        )
    H, W = shape
    down = (np.arange(H) + 0.5) / H - at[0]
    right = (np.arange(W) + 0.5) / W - at[1]
    return down[:, None], right[None, :]


def _normal(w: Array) -> F64:
    """Return w divided by its sum."""
    return w / w.sum()


def average(shape: tuple[int, int]) -> F64:
    """Return w = 1 / (H W): every pixel counts the same."""
    return _normal(np.ones(shape))


def spot(shape: tuple[int, int], *, at: At = (0.5, 0.5), share: float = 0.03) -> F64:
    """Return equal weight in a disc, the `share` of the pixels nearest to `at`, and none elsewhere.

    A spot meter's disc is 1 to 5 % of the picture.
    """
    if not 0 < share <= 1:
        raise InputError(f"expected a fraction of the image from 0 to 1, got {share}")
    down, right = _places(shape, at)
    distance = np.hypot(down * shape[0], right * shape[1])
    count = max(round(share * distance.size), 1)
    radius = np.sort(distance, axis=None)[count - 1]
    return _normal(distance <= radius)


def partial(shape: tuple[int, int], *, at: At = (0.5, 0.5), share: float = 0.12) -> F64:
    """Return equal weight in a disc of 10 to 15 % of the picture, and none elsewhere."""
    return spot(shape, at=at, share=share)


def centre(
    shape: tuple[int, int], *, inside: float = 0.7, share: float = 0.25, at: At = (0.5, 0.5)
) -> F64:
    """Return center-weighted w: `inside`, 60 to 80 %, of it lies in the central `share` of the picture.

    It falls as a Gaussian of the distance. Its width is found by bisection.
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
    for _ in range(_WIDTH_HALVINGS):
        sigma = np.sqrt(low * high)
        w = _normal(np.exp(-squared / (2 * sigma**2)))
        if w[core].sum() > inside:
            low = sigma
        else:
            high = sigma
    return w


def _honeycomb(down: Array, right: Array) -> Array:
    """Return the hexagon of each pixel: the nearest center in five staggered rows of six and five."""
    rows = np.repeat(np.arange(5), [6, 5, 6, 5, 6])
    columns = np.concatenate([np.arange(6), np.arange(5) + 0.5] * 2 + [np.arange(6)])
    tall = down[..., None] - (rows / 5 - 0.4)
    wide = right[..., None] - ((columns + 0.5) / 6 - 0.5)
    return np.argmin((2 * tall) ** 2 + (3 * wide) ** 2, axis=-1)


@lru_cache(16)
def zones(shape: tuple[int, int]) -> NDArray[np.int64]:
    """Return the zone of a matrix meter, 0 to 27, that each pixel (H, W) lies in.

    The zones are the same for all shots: the array is cached, and read-only.
    """
    down, right = _places(shape, (0.5, 0.5))
    labels = _honeycomb(*np.broadcast_arrays(down, right))
    zone = np.unique(labels, return_inverse=True)[1].reshape(shape)
    zone.flags.writeable = False
    return zone


def matrix(B: ArrayLike, *, at: At = (0.5, 0.5), near: float = 0.2, tolerance: float = 2.0) -> F64:
    """Return a matrix meter's weights: zones near the focus point count more, outliers less.

    A zone's weight is exp(-d^2 / (2 near^2)) exp(-e^2 / (2 tolerance^2)). d is its distance from
    the focus point, in picture sizes; e is its distance in stops from the median zone, so that a
    bare sun counts little. Makers keep their rules secret; this one uses what the paper says that
    they take into account.
    """
    B = as_luminance(B)
    labels = zones(B.shape)
    area = np.bincount(labels.ravel())

    def mean(values: Array) -> Array:
        return np.bincount(labels.ravel(), np.broadcast_to(values, B.shape).ravel()) / area

    down, right = _places(B.shape, at)
    stops = np.log2(np.maximum(mean(B), _MIN_ZONE_BRIGHTNESS))
    closeness = np.exp(-(mean(down) ** 2 + mean(right) ** 2) / (2 * near**2))
    likeness = np.exp(-((stops - np.median(stops)) ** 2) / (2 * tolerance**2))
    return _normal((closeness * likeness / area)[labels])


MODES = ("spot", "partial", "centre", "average", "matrix")


def weights(B: ArrayLike, mode: str, *, at: At = (0.5, 0.5)) -> F64:
    """Return the weights (H, W) of a mode, of MODES, for a picture of brightness B."""
    B = as_luminance(B)
    if mode not in MODES:
        raise InputError(f"expected one of the modes {', '.join(MODES)}, got {mode!r}")
    if mode == "matrix":
        return matrix(B, at=at)
    return _fixed_weights(mode, B.shape, tuple(at)).copy()


@lru_cache(16)
def _fixed_weights(mode: str, shape: tuple[int, int], at: At) -> F64:
    """Return the weights of a mode that does not depend on the picture; they are cached."""
    if mode == "average":
        return average(shape)
    modes = {"spot": spot, "partial": partial, "centre": centre}
    return modes[mode](shape, at=at)


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
    """Return EV_opt = EV_pre + log2 B_pre - log2 B_opt [Battiato08 eq. 1.2], exact if no pixel is full.

    Examples
    --------
    >>> float(optimum(10, 0.72))  # four times too bright: two stops more of exposure value
    12.0
    """
    return EV_pre + np.log2(B_pre) - np.log2(B_opt)


def predict_reading(B: ArrayLike, w: F64, stops: float) -> float:
    """Return the reading after `stops` more light, sum w min(2^stops B, 1).

    A full pixel counts as `FULL_PIXEL_BRIGHTNESS`.
    """
    B = np.asarray(B, np.float64)
    light = np.where(B < 1, B, FULL_PIXEL_BRIGHTNESS)
    return float((w * np.minimum(light * 2.0**stops, 1)).sum())


def correction(B: ArrayLike, w: F64, B_opt: float = MIDDLE_GRAY, *, most: float = 8.0) -> float:
    """Return the correction in stops that makes the reading B_opt, by bisection between +-`most`.

    Where no pixel is full, and none will be, this is log2 B_opt - log2 B_pre, eq. 1.2.
    """
    low = -most
    high = most
    for _ in range(_STOPS_HALVINGS):
        middle = (low + high) / 2
        if predict_reading(B, w, middle) < B_opt:
            low = middle
        else:
            high = middle
    return (low + high) / 2
