"""Which photo contradicts all others?

B   ln times, as stated   (P,)

The typical patch of two neighbors, flat or not, misses their times by some stops. If all other
photos agree without one photo, that one is wrong: its time is wrong, or it shows another scene, or
another light. If the others agree without either of two photos, as three of four often do, nobody
can tell which one is wrong.
"""

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, as_stack
from hdrlab.diagnostics import flat_patches, response_steps

# stops in a typical patch, by which photos contradict each other
MIN_CONTRARY_STOPS = 0.3
# stops in a typical patch, up to which photos agree
MAX_AGREEING_STOPS = 0.1
# At least so many photos remain, and this fraction of them.
MIN_KEPT_PHOTOS = 3
MIN_KEPT_FRACTION = 2 / 3


def find_outlying_frames(
    images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None
) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Find the photos that contradict all others, while these agree with each other.

    Photos are left out one at a time, each time the one without which the others agree best.

    Returns
    -------
    outliers : tuple of int
        Empty if more than a third of the photos would be left out.
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
    patches = flat_patches.find_flat_patches(stack, valid=valid)
    kept = list(range(len(B)))
    rivals: tuple[int, ...] = ()
    error = measure_misfit(patches, B)
    if error <= MIN_CONTRARY_STOPS:
        return (), ()
    min_kept = max(MIN_KEPT_PHOTOS, np.ceil(MIN_KEPT_FRACTION * len(B)))
    while error > MAX_AGREEING_STOPS and len(kept) > min_kept:
        remaining = [[k for k in kept if k != j] for j in kept]
        errors = [measure_misfit(patches.of(frames), B[frames]) for frames in remaining]
        best = int(np.argmin(errors))
        rivals = tuple(
            j
            for j, other_error in zip(kept, errors, strict=True)
            if other_error <= MAX_AGREEING_STOPS and j != kept[best]
        )
        error = errors[best]
        kept = remaining[best]
    if error > MAX_AGREEING_STOPS:
        return (), ()
    return tuple(j for j in range(len(B)) if j not in kept), rivals


def measure_misfit(patches: flat_patches.FlatPatches, B: F64) -> float:
    """Return the largest error of ln times B between neighbors in a typical patch, in stops."""
    all_patches = np.ones(patches.Z.shape[2:], bool)
    H = flat_patches.count_pairs(patches.Z, all_patches)
    fit = response_steps.fit_steps(H, B, np.zeros((len(B), 0)))
    biases = response_steps.measure_biases(H, B, fit, sizes=True)
    is_informative = response_steps.find_informative(H)
    return float(np.nanmax(biases[is_informative], initial=0))
