"""Which photo contradicts all others?

B   ln times, as stated   (P,)

The typical patch of two neighbors, flat or not, misses their times by some stops. If all other
photos agree without one photo, that one is wrong: its time is wrong, or it shows another scene, or
another light. If the others agree without either of two photos, as three of four often do, nobody
can tell which one is wrong.

A photo that is nearly black says little, and its darkest levels say the least. So a photo is wrong
only if its well exposed patches contradict two other photos over a large part of the image.
"""

from collections.abc import Sequence

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, Mask, as_mask, as_stack, levels
from hdrlab.diagnostics import flat_patches, response_steps

# stops in a typical patch, by which photos contradict each other
MIN_CONTRARY_STOPS = 0.3
# stops in a typical patch, up to which photos agree
MAX_AGREEING_STOPS = 0.1
# A photo is named, too, if the others agree up to this factor times the limit without it. Light that
# changes by a millionth changes their error by a factor of up to 1.23.
RIVAL_MARGIN = 1.3
# At least so many photos remain, and this fraction of them.
MIN_KEPT_PHOTOS = 3
MIN_KEPT_FRACTION = 2 / 3
# In a larger bracket, only so many photos are tried each time: those with the largest errors.
MAX_TRIED_PHOTOS = 8
# In an even larger one, a wrong photo hardly changes the map, and is not searched.
MAX_SEARCHED_PHOTOS = 64
# Darker levels do not show whether photos contradict each other.
MIN_SURE_LEVEL = 16
# patches that contradict another photo, as a fraction of the image
MIN_CONTRARY_AREA = 0.02
# and as a fraction of the patches that both photos measure
MIN_CONTRARY_FRACTION = 0.5
# other photos that a wrong photo contradicts
MIN_CONTRADICTED_PHOTOS = 2
# pixels at this fraction of the top level and above are clipped
CLIPPING_LEVEL = 0.98
# Highlights are brighter than this fraction of the other pixels of their photo.
HIGHLIGHT_QUANTILE = 0.95


def find_outlying_frames(
    images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None
) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Find the photos that contradict all others, while these agree with each other.

    Photos are left out one at a time, each time the one without which the others agree best.

    Returns
    -------
    outliers : tuple of int
        Empty if more than a third of the photos would be left out, and for more than
        MAX_SEARCHED_PHOTOS photos. Photos that contradict no two others over a large area are never
        among them.
    rivals : tuple of int
        Photos that could be left out in place of the last one: the others agree as well.

    Examples
    --------
    >>> from hdrlab.capture import camera
    >>> from hdrlab import scenes
    >>> room = scenes.room((140, 210))
    >>> taken = camera.shoot(room, camera.times_around(room, 5, stops=1.5))
    >>> find_outlying_frames(taken.images, taken.times)
    ((), ())
    >>> find_outlying_frames(taken.images, taken.times * [1, 1, 1, 6, 6])  # which two are right?
    ((), ())
    """
    stack = as_stack(images)
    B = np.log(response_steps.as_ascending_times(times, len(stack)))
    if len(stack) > MAX_SEARCHED_PHOTOS:
        return (), ()
    patches = flat_patches.find_flat_patches(stack, valid=valid)
    kept = list(range(len(B)))
    rivals: tuple[int, ...] = ()
    pair_errors = measure_pair_errors(patches, B)
    error = float(pair_errors.max(initial=0))
    if error <= MIN_CONTRARY_STOPS:
        return (), ()
    min_kept = max(MIN_KEPT_PHOTOS, np.ceil(MIN_KEPT_FRACTION * len(B)))
    while error > MAX_AGREEING_STOPS and len(kept) > min_kept:
        tried = [kept[place] for place in _choose_suspects(pair_errors)]
        remaining = [[k for k in kept if k != j] for j in tried]
        errors_without = [
            measure_pair_errors(patches.of(frames), B[frames]) for frames in remaining
        ]
        max_errors = [float(errors.max(initial=0)) for errors in errors_without]
        best = int(np.argmin(max_errors))
        # With a higher limit, two photos that could be left out are both named: it is never one of
        # them in one calculation, and the other in the next.
        rivals = tuple(
            j
            for j, other_error in zip(tried, max_errors, strict=True)
            if other_error <= RIVAL_MARGIN * MAX_AGREEING_STOPS and j != tried[best]
        )
        error = max_errors[best]
        pair_errors = errors_without[best]
        kept = remaining[best]
    if error > MAX_AGREEING_STOPS:
        return (), ()
    outliers = [j for j in range(len(B)) if j not in kept]
    wrong = tuple(j for j in outliers if contradicts_others(patches, B, j, kept))
    return wrong, rivals if wrong else ()


def _choose_suspects(pair_errors: F64) -> list[int]:
    """Return the photos with the largest errors to their neighbors, ascending: one of them is wrong.

    Without a photo of another pair, the pair with the largest error would stay.
    """
    photo_errors = np.maximum(np.append(pair_errors, 0), np.append(0, pair_errors))
    by_error = np.argsort(-photo_errors, kind="stable")
    return sorted(by_error[:MAX_TRIED_PHOTOS].tolist())


def contradicts_others(
    patches: flat_patches.FlatPatches, B: F64, frame: int, others: Sequence[int]
) -> bool:
    """Return whether a photo contradicts two of the others over a large part of the image."""
    contradicted_count = 0
    for errors in _measure_errors(patches, B, frame, others):
        is_contrary = np.abs(errors) > MIN_CONTRARY_STOPS
        is_large = is_contrary.mean() >= MIN_CONTRARY_AREA
        shared_count = np.isfinite(errors).sum()
        if is_large and is_contrary.sum() >= MIN_CONTRARY_FRACTION * shared_count:
            contradicted_count += 1
    return contradicted_count >= MIN_CONTRADICTED_PHOTOS


def measure_time_error(
    images: ArrayLike,
    times: ArrayLike,
    frame: int,
    others: Sequence[int],
    *,
    valid: ArrayLike | None = None,
) -> float:
    """Return by how many stops the time of a photo is too long, according to the other photos.

    It is NaN if no other time makes the photo agree with them.
    """
    stack = as_stack(images)
    B = np.log(response_steps.as_ascending_times(times, len(stack)))
    patches = flat_patches.find_flat_patches(stack, valid=valid)
    errors = _measure_errors(patches, B, frame, others)
    errors = errors[np.isfinite(errors)]
    if not len(errors):
        return float("nan")
    time_error = -np.median(errors)
    remaining = np.median(np.abs(errors + time_error))
    return float(time_error) if remaining <= MIN_CONTRARY_STOPS / 2 else float("nan")


def _measure_errors(
    patches: flat_patches.FlatPatches, B: F64, frame: int, others: Sequence[int]
) -> F64:
    """Return the errors in stops between a photo and each of the others, (len(others), h, w).

    The response is that of the others. An error is NaN where a patch is not well exposed in both.
    It is positive where the photo is too bright for its time.
    """
    kept = list(others)
    kept_patches = patches.of(kept)
    H = flat_patches.count_pairs(kept_patches.Z, np.ones(patches.Z.shape[2:], bool))
    fit = response_steps.fit_steps(H, B[kept], np.zeros((len(kept), 0)))
    channel = np.arange(patches.Z.shape[1])[:, None, None]
    g = fit.g[channel, patches.Z]
    is_sure = np.all(patches.Z >= MIN_SURE_LEVEL, axis=1)
    steps = (g[frame] - g[kept]).mean(axis=1)
    stated_steps = (B[frame] - B[kept])[:, None, None]
    errors = (steps - stated_steps) / np.log(2)
    return np.where(is_sure[frame] & is_sure[kept], errors, np.nan)


def find_highlights_of(images: ArrayLike, frame: int, *, valid: ArrayLike | None = None) -> Mask:
    """Return the pixels that are clipped in every photo but one, (H, W).

    The mask is empty if these pixels are not the brightest ones of that photo, as in a photo of
    another scene.

    Examples
    --------
    >>> images = np.array([[[2, 90, 4]], [[9, 255, 20]]], np.uint8)
    >>> find_highlights_of(images, 0).tolist()
    [[False, True, False]]
    """
    stack = as_stack(images)
    mask = as_mask(valid, stack)
    clipped_level = CLIPPING_LEVEL * (levels(stack) - 1)
    is_highlight = np.ones(stack.shape[1:3], bool)
    for j, image in enumerate(stack):
        brightest = image if image.ndim == 2 else image.max(axis=2)
        is_clipped = brightest > clipped_level
        if j == frame:
            own = brightest
            is_highlight &= ~is_clipped
            if mask is not None:
                is_highlight &= mask[j]
        elif mask is None:
            is_highlight &= is_clipped
        else:
            is_highlight &= is_clipped | ~mask[j]
    if not is_highlight.any() or is_highlight.all():
        return is_highlight
    threshold = np.quantile(own[~is_highlight], HIGHLIGHT_QUANTILE)
    if np.median(own[is_highlight]) <= threshold:
        return np.zeros_like(is_highlight)
    return is_highlight


def measure_pair_errors(patches: flat_patches.FlatPatches, B: F64) -> F64:
    """Return the errors of ln times B between neighbors in a typical patch, in stops, (P - 1,).

    An error is 0 where the patches of a pair measure nothing.
    """
    all_patches = np.ones(patches.Z.shape[2:], bool)
    H = flat_patches.count_pairs(patches.Z, all_patches)
    fit = response_steps.fit_steps(H, B, np.zeros((len(B), 0)))
    biases = response_steps.measure_biases(H, B, fit, sizes=True)
    is_informative = response_steps.find_informative(H)
    return np.where(is_informative, np.nan_to_num(biases).max(axis=1), 0)
