"""Which frame contradicts all others?

B   ln times, as stated   (P,)

The typical patch of two neighbours, flat or not, misses their times by some stops. A frame without
which all others agree is the one that is wrong: by its time, or because it shows another scene, or
another light. Where the others agree without either of two, as three of four often do, nobody can
tell which.
"""

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, as_stack
from hdrlab.diagnostics import flat_patches, response_steps

# stops in a typical patch: what contradicts all others, and what agrees
CONTRARY, AGREEING = 0.3, 0.1


def find_outlying_frames(
    images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None
) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return the frames that contradict all others, while these agree; none where more than a third would.

    Frames are left out one by one, each time the one without which the others agree best. The
    second tuple holds those without which, in place of the last, the others agree as well.

    Examples
    --------
    >>> from hdrlab.capture import camera
    >>> from hdrlab import scenes
    >>> room = scenes.room((140, 210))
    >>> taken = camera.shoot(room, camera.times_around(room, 5, stops=1.5))
    >>> find_outlying_frames(*taken[:2])
    ((), ())
    >>> find_outlying_frames(taken.images, taken.times * [1, 1, 1, 6, 6])  # which two are right?
    ((), ())
    """
    stack = as_stack(images)
    B = np.log(response_steps.as_ascending_times(times, len(stack)))
    found = flat_patches.find_flat_patches(stack, valid=valid)
    kept, rivals = list(range(len(B))), tuple[int, ...]()
    error = first = measure_misfit(found, B)
    while error > AGREEING and first > CONTRARY and len(kept) > max(3, np.ceil(2 * len(B) / 3)):
        rests = [[k for k in kept if k != j] for j in kept]
        errors = [measure_misfit(found.of(rest), B[rest]) for rest in rests]
        best = int(np.argmin(errors))
        rivals = tuple(
            j for j, e in zip(kept, errors, strict=True) if e <= AGREEING and j != kept[best]
        )
        error, kept = errors[best], rests[best]
    return (
        (tuple(sorted(set(range(len(B))) - set(kept))), rivals) if error <= AGREEING else ((), ())
    )


def measure_misfit(found: flat_patches.FlatPatches, B: F64) -> float:
    """Return the most by which neighbours miss ln times B in a typical patch, flat or not, in stops."""
    H = flat_patches.count_pairs(found.Z, np.ones(found.Z.shape[2:], bool))
    fit = response_steps.fit_steps(H, B, np.zeros((len(B), 0)))
    errors = response_steps.measure_biases(H, B, fit, sizes=True)[
        response_steps.find_informative(H)
    ]
    return float(np.nanmax(errors, initial=0))
