"""From pairs of photographs to a bracket, where a pair's answer is a move: who is compared with whom, whether
to trust what was found, and where each photograph ends up.

X     light                   (2, H, W): the fixed photograph and the moving one, see `light`
H     move                    (3, 3): where pixel (x, y, 1) of the moving photograph lies on the fixed one
e     error                   see `criterion`
near  (8,) moves              2 pixels further than H, in eight directions
far   (8,) moves              8 pixels further

A search answers all the same when there is no answer, so each is looked at once more, as `judge` does with
bitmaps: is it better than not moving, better than what lies around it, better than the next best shift of a
texture that repeats, and do the four quarters of the picture agree?
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.fft import irfft2, next_fast_len, rfft2
from scipy.ndimage import maximum_filter

from hdrlab.align import criterion, light
from hdrlab.align.judge import ALIKE, DOUBT, FAR, NEAR, RIVALS
from hdrlab.align.pairs import by_brightness
from hdrlab.core import warp
from hdrlab.core.arrays import as_stack, as_times

Float = NDArray[np.float64]
TILE = 512  # pixels: of so large a part of the picture repeating textures are looked for
EIGHT = np.array([(dy, dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dy or dx])


class Pair(NamedTuple):
    """Two neighbours in brightness: image `moving` is the darker; X is their light, full resolution first."""

    moving: int
    fixed: int
    X: list[light.Float]


class Match(NamedTuple):
    """What the comparison of two photographs found.

    Attributes
    ----------
    moving, fixed : which two images; they are neighbours in brightness, and the darker one moves
    H : (3, 3), where pixel (x, y, 1) of `moving` comes to lie on `fixed`
    offset : (dy, dx), pixels, by which the middle of `moving` is moved
    degrees : by how much it is turned, clockwise as seen
    before, after : error e without the move and with it
    confidence : 1 is a perfect match, 0 is no better than 8 pixels away
    informative : False where both photographs measure too little of the scene to be compared
    trouble : why the move is not to be trusted; empty where it is
    """

    moving: int
    fixed: int
    H: Float
    offset: tuple[float, float]
    degrees: float
    before: float
    after: float
    confidence: float
    informative: bool
    trouble: str

    @property
    def reliable(self) -> bool:
        """Whether nothing speaks against the move."""
        return not self.trouble


def neighbours(
    images: ArrayLike | Sequence[ArrayLike], times: ArrayLike | None, g: ArrayLike | None
) -> Iterator[Pair]:
    """Yield pair after pair, from dark to bright, with no more than one pyramid in memory."""
    images = as_stack(images)
    seconds = None if times is None else as_times(times, len(images))
    order = by_brightness(images)
    for moving, fixed in zip(order, order[1:], strict=False):
        k = None if seconds is None else float(seconds[fixed] / seconds[moving])
        yield Pair(moving, fixed, light.pair(light.gray(images[fixed]), light.gray(images[moving]), g, k))


def correlation(X: light.Float) -> Float:
    """Return how well `moving` fits at every shift (dy, dx): the sum of a(p + s) b(p), by FFT.

    Discarded pixels are 0, and so is the mean, or the brightest overlap would win: the mean around each
    pixel, for light that falls off slowly across the scene would win, too.
    """
    a, b = (np.where(np.isfinite(x), x - light.around(x), 0) for x in X)
    h, w = X.shape[1:]
    size = [next_fast_len(2 * n - 1) for n in (h, w)]
    c = irfft2(rfft2(a, size) * np.conj(rfft2(b, size)), size)
    return np.asarray(np.roll(c, (h - 1, w - 1), axis=(0, 1))[: 2 * h - 1, : 2 * w - 1])


def peaks(c: Float, count: int) -> NDArray[np.int64]:
    """Return the shifts (count, 2) of the highest peaks, the highest first: argmax [Cerman06 eq. 5]."""
    y, x = np.nonzero((c == maximum_filter(c, 5)) & (c > 0))
    best = np.argsort(-c[y, x], kind="stable")[:count]
    return np.stack([y[best], x[best]], axis=-1) - np.array(c.shape) // 2


def shifted(H: Float, offset: ArrayLike) -> Float:
    """Return H, and then so many pixels (dy, dx) further."""
    return np.asarray(warp.as_moves(np.reshape(offset, (1, 2)))[0] @ H)


def rivals(X: light.Float, H: Float) -> list[Float]:
    """Return H moved on by the next best shifts of the correlation, of the middle of the picture."""
    h, w = X.shape[1:]
    rows, columns = (slice(max(n - TILE, 0) // 2, max(n - TILE, 0) // 2 + TILE) for n in (h, w))
    moved = warp.read(X[1], np.linalg.inv(H), (h, w), order=1)
    c = correlation(np.stack([X[0], moved])[:, rows, columns])
    return [shifted(H, s) for s in peaks(c, RIVALS) if np.abs(s).max() > NEAR]


def lower(d: Float, other: Float) -> bool:
    """Whether an error is below another by a twentieth of it and three standard deviations of its mean."""
    both = np.isfinite(d) & np.isfinite(other)
    if both.sum() < 20:
        return False
    gain = other[both] ** 2 - d[both] ** 2
    margin = np.mean(other[both] ** 2) / 20 + 3 * gain.std() / np.sqrt(len(gain))
    return bool(gain.mean() > margin)


def confidence(e: float, elsewhere: Sequence[float]) -> float:
    """Return 1 - e / the mean error elsewhere.

    Examples
    --------
    >>> confidence(0.25, [1.0, 1.5])
    0.8
    """
    mean = float(np.mean(elsewhere)) if len(elsewhere) else 0.0
    return 1 - e / mean if mean > 0 else 0.0


def judge(pair: Pair, H: Float) -> Match:
    """Return the Match of a pair whose search found H; without a move where that is not clearly better."""
    X, shape = pair.X[0], pair.X[0].shape[1:]
    p = criterion.lattice(shape)
    still, moved = (criterion.differences(X, one, p) for one in (np.eye(3), H))
    before = after = criterion.error(still)
    if lower(moved, still) or not np.isfinite(still).any():
        after = criterion.error(moved)
    else:
        H, moved = np.eye(3), still
    middle = (np.array(shape[::-1]) - 1) / 2
    dx, dy = warp.apply(H, [middle])[0] - middle
    far = [criterion.error(criterion.differences(X, shifted(H, FAR * s), p)) for s in EIGHT]
    informative = bool(np.isfinite(moved).mean() > criterion.LEAST)
    sure = confidence(after, far) if informative else 0.0
    said = (
        trouble(X, H, p, moved, sure)
        if informative
        else "uninformative: both measure too little of the scene"
    )
    turned = float(np.rad2deg(np.arctan2(H[1, 0], H[0, 0])))
    return Match(*pair[:2], H, (float(dy), float(dx)), turned, before, after, sure, informative, said)


def trouble(X: light.Float, H: Float, p: Float, d: Float, sure: float) -> str:
    """Return why H, whose differences are d, is not to be trusted, or nothing."""
    if sure < DOUBT:
        return f"8 pixels away the photographs fit nearly as well (confidence {sure:.2f})"
    near = [criterion.differences(X, shifted(H, NEAR * s), p) for s in EIGHT]
    if not all(lower(d, other) for other in near):
        return "2 pixels away the photographs fit as well"
    e = criterion.error(d)
    elsewhere = e / (1 - sure) if sure < 1 else e
    for rival in rivals(X, H):
        also = criterion.error(criterion.differences(X, rival, p))
        if confidence(e, [also]) < DOUBT or also - e < ALIKE * (elsewhere - e):
            dx, dy = (rival - H)[:2, 2]
            return f"the picture repeats itself: moved on by ({dy:.0f}, {dx:.0f}) it fits nearly as well"
    halves = p > np.median(p, axis=0)
    quarters = [np.all(halves == (right, low), axis=1) for right in (False, True) for low in (False, True)]
    away = sum(any(lower(other[one], d[one]) for other in near) for one in quarters)
    if away:
        return f"{away} of 4 quarters of the picture fit better elsewhere (depth, or a scene that moves)"
    return ""


def along(matches: Sequence[Match]) -> Float:
    """Return the moves (P, 3, 3) that lay every image on the middle one, chained along the P - 1 pairs.

    The matches run from dark to bright. A pair that is not informative breaks the chain: the image beyond
    stays where it is, and those behind follow it.
    """
    moves = np.tile(np.eye(3), (len(matches) + 1, 1, 1))
    middle = (len(matches) + 1) // 2
    for one in matches[middle:]:
        if one.informative:
            moves[one.fixed] = moves[one.moving] @ np.linalg.inv(one.H)
    for one in reversed(matches[:middle]):
        if one.informative:
            moves[one.moving] = moves[one.fixed] @ one.H
    return moves / moves[:, 2:, 2:]
