"""Which frame's exposure time is wrong, or does no time explain the images?

x        corrections   (P,), what the pixels add to ln times: see `response_steps`
stops    errors        (P,), log2(exposure by the pixels / exposure stated), most of them 0
regions  disagreement  (P - 1,), stops by which parts of the picture disagree, under the best of factors
significance           (P - 1,), the same over the standard error of a part's median
corners  change        (P - 1,), stops from the middle to the corners
tints    another white balance   (P,), stops by which one channel is too bright, and another too dark
cost     in the map    stops, RMS over the picture: what the errors change where each frame has its weight

The map follows its frames: one at the end of a bracket, .7 stops off, draws it along and shows in
the deviations of `consistency` as .1. Neighbours are compared here by themselves, through a
response that fits them as well as any response and one factor per frame can. The factors hold an
unknown straight line in ln t (unit and exponent of the response). As most times of a bracket are
right, the line taken is that of least square roots, which passes through most frames and leaves the
wrong ones standing out: one large error is likelier than several middling ones.

If factors explain all, times are wrong. If parts of one picture ask for different factors, none
are: the corners, where the aperture changed and with it the vignetting; or light, or a camera's
processing by place. If channels ask for factors of their own, one up and one down in the same
frame, white balance changed. A curve for each channel hides that from the map's spread.

An error counts by what it costs. An end frame that is nearly black measures little, and bends by a
camera's own processing: half a stop there leaves the map sound.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F64, Array, ArrayLike, Indices, Mask, as_stack, to_256
from hdrlab.diagnostics import flat_patches, response_steps
from hdrlab.diagnostics.doubts import say

# side of a part of the picture, in patches
TILE = 12
# patches that make the median of a part
FEWEST = 10
# flat patches of a pair, without which all take their place, and only what is large counts
ENOUGH = 50
# of a frame, on an even grid, that stand for the whole
PIXELS = 30_000
# stops, the prior: here times are free, for the question is what is wrong and not what is likely
LOOSE = 4.0
# stops: true times of real brackets stay within 0.24, and tints of one white balance within 0.16
WRONG = 0.25
# stops in the map, RMS: a smaller error leaves it sound
COST = 0.05
# stops: real brackets of one response stay within 0.08
LOCAL = 0.1
# stops, and standard errors: brackets of one response stay within 3.7
SLIGHT, SIGNIFICANT = 0.02, 4.0
# stops: no standard error of a part is smaller, for patches have whole levels
SMALLEST_ERROR = 0.003
# of the variance by place, that the distance from the middle explains
CORNERS = 0.5
# stops of the map's spread: below, the map explains its photographs, and what is slight needs no
# word
SOUND = 0.1
# stops of the map's spread: below, no time can be wrong that matters
EXPLAINED = 0.015


class Contradictions(NamedTuple):
    """stops (P,); regions, significance, corners (P - 1,), NaN where not known; cost; tints (P,)."""

    stops: F64
    regions: F64
    significance: F64 = np.zeros(0)
    corners: F64 = np.zeros(0)
    cost: float = np.inf
    tints: F64 = np.zeros(1)

    @property
    def wrong(self) -> tuple[int, ...]:
        """The frames whose times are wrong, at a cost."""
        return tuple(np.flatnonzero((np.abs(self.stops) > WRONG) & (self.cost > COST)).tolist())

    @property
    def local(self) -> bool:
        """Whether one response, and one factor per frame, cannot explain the bracket."""
        by, errors = (one[np.isfinite(one)] for one in (self.regions, self.significance))
        slight = len(by) > 0 and np.median(by) > SLIGHT and np.median(errors) > SIGNIFICANT
        return bool(slight or (len(by) and np.median(by) > LOCAL))


def find_contradictions(
    images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None
) -> Contradictions:
    """Return where the pixels of aligned photographs, from short to long, contradict their times.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
    times : (P,) seconds, as stated
    valid : (P, H, W) bool, optional, False where a photograph holds no picture

    Returns
    -------
    Contradictions
        Of the longest run of frames that patches or histograms connect, if these are three or more.
        Of three frames any one may be wrong: then the middle one is named, or an end by twice as
        much.

    Examples
    --------
    >>> from hdrlab.capture import camera
    >>> from hdrlab import scenes
    >>> room = scenes.room((280, 420))
    >>> taken = camera.shoot(room, camera.times_around(room, 5, stops=1.5))
    >>> find_contradictions(taken.images, taken.times * [1, 1, 2, 1, 1]).wrong
    (2,)
    """
    stack = as_stack(images)
    B = np.log(response_steps.as_ascending_times(times, len(stack)))
    found = flat_patches.find_flat_patches(stack, valid=valid)
    H = flat_patches.count_pairs(found.Z, found.best)
    few = ~response_steps.find_informative(H)
    if few.any():
        ranks = flat_patches.rank_levels(stack, valid=valid)
        H[few] = flat_patches.count_pairs(ranks, np.ones(ranks.shape[2:], bool))[few]
    stops, places = np.full(len(B), np.nan), np.full((3, len(B) - 1), np.nan)
    start, stop = find_longest_run(response_steps.find_informative(H))
    frames, pairs = slice(start, stop + 1), slice(start, stop)
    if stop - start < 2 or np.ptp(B[frames]) == 0:
        return Contradictions(stops, *places)
    here, Q, tints = B[frames], response_steps.free_directions(B[frames]), np.zeros(len(B))
    tables = H[pairs], *np.split(H[pairs], H.shape[1], axis=1)  # of all channels, and of each
    best, *each = (response_steps.fit_steps(one, here, Q, sd=LOOSE) for one in tables)
    x = np.stack([response_steps.remove_trend(one.x, here) for one in (best, *each)]) / np.log(2)
    stops[frames], tints[frames] = x[0], np.minimum(x[1:].max(axis=0), -x[1:].min(axis=0))
    places[:, pairs] = measure_disagreement(found.of(frames), here, best)
    return Contradictions(stops, *places)._replace(cost=measure_cost(stack, stops), tints=tints)


def measure_cost(stack: Array, stops: F64) -> float:
    """Return what errors of the frames, stops (P,), change in the map, up to a factor: RMS over pixels."""
    every = max(1, int(np.sqrt(stack.shape[1] * stack.shape[2] / PIXELS)))
    Z = to_256(stack[:, ::every, ::every])
    w = response_steps.W[Z.reshape(len(Z), Z.shape[1] * Z.shape[2], -1)].mean(axis=-1)
    total = w.sum(axis=0)
    off = (np.nan_to_num(stops) @ w)[total > 0] / total[total > 0]
    return float(off.std()) if off.size else 0.0


def find_longest_run(informative: Mask) -> tuple[int, int]:
    """Return start and stop of the longest run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], informative, [False]]).astype(int)))
    start, stop = max(
        edges.reshape(-1, 2).tolist(), key=lambda run: run[1] - run[0], default=(0, 0)
    )
    return start, stop


def measure_disagreement(found: flat_patches.FlatPatches, B: F64, best: response_steps.Fit) -> F64:
    """Return each pair's disagreement by place, (3, P - 1).

    Where a quarter of the tiles are off by more, in stops and in standard errors, 0 where few are
    flat; and in stops from the middle to the corners, 0 where that distance does not explain most.
    """
    h, w = found.Z.shape[2:]
    y, x = np.indices((h, w)) // TILE
    tile = y * (w // TILE + 1) + x
    r2 = (2 * np.arange(h) / h - 1)[:, None] ** 2 + (2 * np.arange(w) / w - 1) ** 2
    channel, out = np.arange(found.Z.shape[1])[:, None, None], np.full((3, len(B) - 1), np.nan)
    for j, step in enumerate(np.diff(B + best.x)):
        a, b = found.Z[j], found.Z[j + 1]
        trusted = (response_steps.PAIR[a, b] > 0).all(axis=0)
        flat = trusted & found.flat.all(axis=0)
        if np.count_nonzero(flat) < ENOUGH:
            flat = trusted & found.flat[j] & found.flat[j + 1]
        sure = np.count_nonzero(flat) >= ENOUGH
        chosen = flat if sure else trusted
        r = ((best.g[channel, b] - best.g[channel, a]).mean(axis=0) - step)[chosen] / np.log(2)
        medians, errors = _tile_medians(r, tile[chosen])
        if len(medians):
            off = np.quantile(np.abs([medians, sure * medians / errors]), 0.75, axis=1)
            out[:2, j] = off if sure else 0
            slope = np.polyfit(r2[chosen], r, 1)[0]
            explained = (slope * r2[chosen].std()) ** 2 > CORNERS * r.var()
            out[2, j] = 2 * abs(slope) * explained
    return out


def _tile_medians(r: F64, tile: Indices) -> tuple[F64, F64]:
    """Return the median of r over each tile of at least FEWEST patches, and its standard error.

    That of a median is 1.25 sigma / sqrt(n), and sigma 1.48 times the median deviation, for normal
    errors.
    """
    _, place, n = np.unique(tile, return_inverse=True, return_counts=True)
    first = np.cumsum(n) - n

    def find_medians(values: F64) -> F64:
        ordered = values[np.lexsort((values, place))]  # tile after tile, each from low to high
        return (ordered[first + (n - 1) // 2] + ordered[first + n // 2]) / 2

    medians, large = find_medians(r), n >= FEWEST
    sigma = 1.48 * find_medians(np.abs(r - medians[place]))
    return medians[large], np.maximum(1.25 * sigma / np.sqrt(n), SMALLEST_ERROR)[large]


def warn_of_contradictions(
    found: Contradictions, names: Sequence[str], spread: float = np.inf
) -> str:
    """Return the sentence on what is wrong, at which frame, by how much, and what to do; "" for nothing.

    Of a map whose spread is small, stops, only times that are wrong need a word, and places that
    differ much.
    """
    if found.tints.max() > WRONG:
        return say("white_balance", frame=names[int(found.tints.argmax())], stops=found.tints.max())
    corners = found.corners[np.isfinite(found.corners)]
    if len(corners) and np.median(corners) > SLIGHT:
        return say("corners", stops=np.median(corners))
    by = np.nanmedian(found.regions) if found.local else 0.0
    if by > LOCAL or (found.local and spread > SOUND):
        j = int(np.nanargmax(found.regions))
        return say("local", stops=by, dark=names[j], bright=names[j + 1])
    if not found.wrong or spread < EXPLAINED:
        return ""
    off = ", ".join(f"{names[j]} by {found.stops[j]:+.2f}" for j in found.wrong)
    return say("times", off=off + (say("of_three") if np.isfinite(found.stops).sum() == 3 else ""))
