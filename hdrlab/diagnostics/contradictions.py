"""Which photo has a wrong exposure time, or can no time explain the images?

x        corrections   (P,), what the pixels add to ln times: see `response_steps`
stops    errors        (P,), log2(exposure by the pixels / stated exposure), most of them 0
regions  disagreement  (P - 1,), stops by which parts of the image disagree, with the best factors
significance           (P - 1,), the same divided by the standard error of a part's median
corners  change        (P - 1,), stops from the center to the corners
tints    white balance (P,), stops by which one channel is too bright, and another too dark
cost     in the map    stops, RMS over the image: what the errors change where each photo has its weight

The map follows its photos: a photo at the end of a bracket that is 0.7 stops off pulls the map with
it, and shows up as 0.1 in the deviations of `consistency`. So this module compares neighbors
directly, with a response that fits them as well as any response and one factor per photo can. The
factors contain an unknown straight line in ln t (the unit and the exponent of the response). As
most times of a bracket are right, it is the line with the least sum of square roots: it passes
through most photos, and the wrong ones stand out. One large error is more likely than several
medium ones.

If factors explain everything, times are wrong. If parts of one image need different factors, the
times are right: the aperture changed, and with it the vignetting in the corners; or the light, or
the camera's processing by place. If channels need factors of their own, one up and one down in the
same photo, the white balance changed. A curve for each channel hides that from the map's spread.

An error counts by what it costs. A photo at the end that is nearly black measures little, and the
camera's own processing bends it: half a stop there does not harm the map.

`causes` decides what the warning says.
"""

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from hdrlab.core.arrays import F64, Array, ArrayLike, Indices, Mask, as_mask, as_stack, to_256
from hdrlab.diagnostics import flat_patches, response_steps
from hdrlab.diagnostics.frame_choice import choose_spread_frames
from hdrlab.diagnostics.warning_texts import MARGIN

# side of a part of the image, in patches
PATCHES_PER_TILE_SIDE = 12
# patches in a part, without which it has no median
MIN_PATCHES_PER_TILE = 10
# Where a pair has fewer flat patches, all patches are used, and only large differences count.
MIN_FLAT_PATCHES = 50
# photos, spread over the exposure times, that are compared
MAX_COMPARED_PHOTOS = 64
# wrong photos that a warning names
MAX_NAMED_PHOTOS = 10
# pixels of a photo, on an even grid, that are used to measure the cost
MAX_PIXELS = 30_000
# stops; prior of a time's error. It is wide, for the question is what is wrong and not what is
# likely.
PRIOR_STOPS = 4.0
# stops; true times of real brackets stay within 0.24, and tints of one white balance within 0.16
MIN_WRONG_STOPS = 0.25
# stops of a tint that only the ranks of histograms show; one white balance stays within 0.3
MIN_RANK_TINT_STOPS = 0.32
# stops in the map, RMS; a smaller error does not harm it
MIN_COST_STOPS = 0.05
# stops; real brackets with one response stay within 0.08
MIN_LOCAL_STOPS = 0.1
# A smaller disagreement counts if it is significant.
MIN_SLIGHT_STOPS = 0.02
# standard errors; brackets with one response stay within 3.7
MIN_SIGNIFICANCE = 4.0
# stops; the standard error of a part is at least this, because patches have whole pixel values
MIN_STANDARD_ERROR = 0.003
# Changes from the center to the corners do not count if the distance from the center explains less
# than the first fraction of the variance over the image, and fully from the second one on. In between
# they count in part, so that a small change of the photos never changes the measure by much.
MIN_EXPLAINED_BY_RADIUS = 0.5
FULL_EXPLAINED_BY_RADIUS = 0.6

# squared stops; keeps a quotient finite where the photos agree everywhere
TINY_VARIANCE = 1e-12

TimesSource = Literal["kept", "corrected", "relative"]


def _no_values() -> F64:
    return np.zeros(0)


def _no_tint() -> F64:
    return np.zeros(1)


@dataclass(frozen=True, kw_only=True, eq=False)
class Contradictions:
    """What contradicts the exposure times of a bracket; the module explains the fields.

    stops, tints : (P,)
    regions, significance, corners : (P - 1,)
    cost : float

    Values that are not known are NaN. `other_stops` (P,) are the errors by another straight line that
    is about as likely, and makes other photos wrong. It is empty if there is no such line.
    """

    stops: F64
    regions: F64
    significance: F64 = field(default_factory=_no_values)
    corners: F64 = field(default_factory=_no_values)
    cost: float = np.inf
    tints: F64 = field(default_factory=_no_tint)
    other_stops: F64 = field(default_factory=_no_values)

    @property
    def wrong(self) -> tuple[int, ...]:
        """The photos whose times are wrong, and change the map."""
        if self.cost <= MIN_COST_STOPS:
            return ()
        return _find_wrong(self.stops)


def _find_wrong(stops: F64) -> tuple[int, ...]:
    """Return the photos whose errors in stops are large."""
    return tuple(np.flatnonzero(np.abs(stops) > MIN_WRONG_STOPS).tolist())


def find_contradictions(
    images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None
) -> Contradictions:
    """Find out where the pixels of aligned photos contradict their exposure times.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Aligned photos, from short to long.
    times : (P,) float
        Stated times in seconds.
    valid : (P, H, W) bool, optional
        False where a photo has no image.

    Returns
    -------
    Contradictions
        Of the longest run of photos that patches or histograms connect, if these are three or more.
        With three photos any one may be wrong: then the middle one is named, or an end by twice as
        much. Of more than MAX_COMPARED_PHOTOS photos, so many are compared; the others are unknown.

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
    seconds = response_steps.as_ascending_times(times, len(stack))
    chosen = choose_spread_frames(seconds, MAX_COMPARED_PHOTOS)
    if len(chosen) < len(stack):
        mask = as_mask(valid, stack)
        found = find_contradictions(
            stack[chosen], seconds[chosen], valid=None if mask is None else mask[chosen]
        )
        return _expand(found, chosen, len(stack))
    B = np.log(seconds)
    patches = flat_patches.find_flat_patches(stack, valid=valid)
    H = flat_patches.count_pairs(patches.Z, patches.best)
    has_few = ~response_steps.find_informative(H)
    if has_few.any():
        # Values of equal rank take the place of flat patches [Grossberg03].
        ranks = flat_patches.rank_levels(stack, valid=valid)
        all_ranks = np.ones(ranks.shape[2:], bool)
        for pair in np.flatnonzero(has_few):
            H[pair] = flat_patches.count_pairs(ranks[pair : pair + 2], all_ranks)[0]
    unknown = Contradictions(
        stops=np.full(len(B), np.nan),
        regions=np.full(len(B) - 1, np.nan),
        significance=np.full(len(B) - 1, np.nan),
        corners=np.full(len(B) - 1, np.nan),
    )
    start, stop = find_longest_run(response_steps.find_informative(H))
    frames = slice(start, stop + 1)
    pairs = slice(start, stop)
    if stop - start < 2 or np.ptp(B[frames]) == 0:
        return unknown
    B_run = B[frames]
    Q = response_steps.free_directions(B_run)
    fit = response_steps.fit_steps(H[pairs], B_run, Q, sd=PRIOR_STOPS)
    channel_fits = [
        response_steps.fit_steps(table, B_run, Q, sd=PRIOR_STOPS)
        for table in np.split(H[pairs], H.shape[1], axis=1)
    ]
    stops = unknown.stops.copy()
    stops[frames] = _corrections_in_stops(fit, B_run)
    channel_stops = np.stack(
        [_corrections_in_stops(channel_fit, B_run) for channel_fit in channel_fits]
    )
    tints = np.zeros(len(B))
    tints[frames] = np.minimum(channel_stops.max(axis=0), -channel_stops.min(axis=0))
    is_from_ranks = ~_find_photos_with_flat_patches(~has_few)
    tints[is_from_ranks & (tints < MIN_RANK_TINT_STOPS)] = 0
    places = np.full((3, len(B) - 1), np.nan)
    places[:, pairs] = measure_disagreement(patches.of(frames), B_run, fit)
    regions, significance, corners = places
    return Contradictions(
        stops=stops,
        regions=regions,
        significance=significance,
        corners=corners,
        cost=measure_cost(stack, stops),
        tints=tints,
        other_stops=_find_other_stops(fit.x, B_run, frames, stops),
    )


def _find_other_stops(x: F64, B: F64, frames: slice, stops: F64) -> F64:
    """Return the errors (P,) by another line that is about as likely, and makes other photos wrong.

    x and B are those of the frames that are connected. With three of them, each one may be wrong,
    and the warning says so anyway.
    """
    if len(B) <= 3:
        return _no_values()
    wrong = set(_find_wrong(stops))
    for residuals in response_steps.list_trends(x, B, margin=MARGIN):
        other_stops = np.full(len(stops), np.nan)
        other_stops[frames] = residuals / np.log(2)
        other = set(_find_wrong(other_stops))
        if wrong and other and not wrong & other:
            return other_stops
    return _no_values()


def _find_photos_with_flat_patches(has_flat: Mask) -> Mask:
    """Return the photos (P,) that flat patches connect with a neighbor; has_flat is (P - 1,).

    Ranks of whole histograms show the white balance less exactly: JPEG and sharpening change the
    histograms of the channels differently where bright colored areas border on dark ones.
    """
    is_connected = np.zeros(len(has_flat) + 1, bool)
    is_connected[:-1] |= has_flat
    is_connected[1:] |= has_flat
    return is_connected


def _expand(found: Contradictions, chosen: Indices, count: int) -> Contradictions:
    """Return what is known of some photos of a bracket as fields for all `count` photos."""
    stops = np.full(count, np.nan)
    stops[chosen] = found.stops
    other_stops = found.other_stops
    if len(other_stops):
        other_stops = np.full(count, np.nan)
        other_stops[chosen] = found.other_stops
    tints = np.zeros(count)
    tints[chosen] = found.tints

    def expand_pairs(values: F64) -> F64:
        expanded = np.full(count - 1, np.nan)
        expanded[chosen[:-1]] = values
        return expanded

    return replace(
        found,
        stops=stops,
        other_stops=other_stops,
        tints=tints,
        regions=expand_pairs(found.regions),
        significance=expand_pairs(found.significance),
        corners=expand_pairs(found.corners),
    )


def _corrections_in_stops(fit: response_steps.Fit, B: F64) -> F64:
    """Return the corrections of a fit without their straight line in B, in stops."""
    return response_steps.remove_trend(fit.x, B) / np.log(2)


def measure_cost(stack: Array, stops: F64) -> float:
    """Return how errors (P,) of the photos in stops change the map, up to a factor: RMS over pixels."""
    step = max(1, int(np.sqrt(stack.shape[1] * stack.shape[2] / MAX_PIXELS)))
    Z = to_256(stack[:, ::step, ::step])
    w = response_steps.LEVEL_WEIGHTS[Z.reshape(len(Z), Z.shape[1] * Z.shape[2], -1)].mean(axis=-1)
    total = w.sum(axis=0)
    is_measured = total > 0
    change = (np.nan_to_num(stops) @ w)[is_measured] / total[is_measured]
    return float(change.std()) if change.size else 0.0


def find_longest_run(informative: Mask) -> tuple[int, int]:
    """Return start and stop of the longest run of True; the first one of several."""
    padded = np.concatenate([[False], informative, [False]]).astype(int)
    runs = np.flatnonzero(np.diff(padded)).reshape(-1, 2)
    if not len(runs):
        return 0, 0
    start, stop = runs[np.argmax(runs[:, 1] - runs[:, 0])].tolist()
    return start, stop


def measure_disagreement(patches: flat_patches.FlatPatches, B: F64, fit: response_steps.Fit) -> F64:
    """Return by how much the places of each pair of photos disagree, (3, P - 1).

    The first two rows say by how much a quarter of the tiles are off or more, in stops and in
    standard errors; 0 where few patches are flat. The third is the change from the center to the
    corners in stops; 0 where the distance from the center does not explain most of it, and NaN where
    few patches are known.
    """
    height, width = patches.Z.shape[2:]
    y, x = np.indices((height, width)) // PATCHES_PER_TILE_SIDE
    tile = y * (width // PATCHES_PER_TILE_SIDE + 1) + x
    y_relative = 2 * np.arange(height) / height - 1
    x_relative = 2 * np.arange(width) / width - 1
    squared_radius = y_relative[:, None] ** 2 + x_relative**2
    channel = np.arange(patches.Z.shape[1])[:, None, None]
    flat_in_all = patches.flat.all(axis=0)
    disagreement = np.full((3, len(B) - 1), np.nan)
    for j, step in enumerate(np.diff(B + fit.x)):
        a = patches.Z[j]
        b = patches.Z[j + 1]
        is_trusted = (response_steps.PAIR_WEIGHTS[a, b] > 0).all(axis=0)
        is_flat = is_trusted & flat_in_all
        if np.count_nonzero(is_flat) < MIN_FLAT_PATCHES:
            is_flat = is_trusted & patches.flat[j] & patches.flat[j + 1]
        has_flat = np.count_nonzero(is_flat) >= MIN_FLAT_PATCHES
        chosen = is_flat if has_flat else is_trusted
        measured_step = (fit.g[channel, b] - fit.g[channel, a]).mean(axis=0)
        residuals = (measured_step - step)[chosen] / np.log(2)
        medians, errors = _tile_medians(residuals, tile[chosen])
        if not len(medians):
            continue
        disagreement[:2, j] = 0
        if has_flat:
            sizes = np.abs([medians, medians / errors])
            disagreement[:2, j] = np.quantile(sizes, 0.75, axis=1)
        if len(residuals) < MIN_FLAT_PATCHES:
            continue
        r2 = squared_radius[chosen]
        slope = np.polyfit(r2, residuals, 1)[0]
        explained = (slope * r2.std()) ** 2 / max(residuals.var(), TINY_VARIANCE)
        disagreement[2, j] = 2 * abs(slope) * weigh_corners(explained)
    return disagreement


def weigh_corners(explained: float) -> float:
    """Return the weight, 0 to 1, of a change that the distance from the center explains in part.

    `explained` is the fraction of the variance over the image that the distance explains.
    """
    span = FULL_EXPLAINED_BY_RADIUS - MIN_EXPLAINED_BY_RADIUS
    return float(np.clip((explained - MIN_EXPLAINED_BY_RADIUS) / span, 0, 1))


def _tile_medians(residuals: F64, tile: Indices) -> tuple[F64, F64]:
    """Return the median of each tile with at least MIN_PATCHES_PER_TILE patches, and its standard error.

    For normal errors the standard error of a median is 1.25 sigma / sqrt(n), and sigma is 1.48
    times the median deviation.
    """
    _, place, counts = np.unique(tile, return_inverse=True, return_counts=True)
    first = np.cumsum(counts) - counts

    def find_medians(values: F64) -> F64:
        ordered = values[np.lexsort((values, place))]  # tile after tile, each from low to high
        lower = ordered[first + (counts - 1) // 2]
        upper = ordered[first + counts // 2]
        return (lower + upper) / 2

    medians = find_medians(residuals)
    sigma = 1.48 * find_medians(np.abs(residuals - medians[place]))
    errors = np.maximum(1.25 * sigma / np.sqrt(counts), MIN_STANDARD_ERROR)
    is_large = counts >= MIN_PATCHES_PER_TILE
    return medians[is_large], errors[is_large]
