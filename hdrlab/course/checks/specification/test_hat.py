"""Checks of hat(n), the weights of pixel levels: w (n,). Their scale is free; only ratios of
weights count.
"""

import numpy as np

from hdrlab.course.checks.compare import finite, points, require, same


def get_answer(subject, n):
    """Return w (n,) divided by its largest value."""
    w = finite(subject.hat(n), (n,), what="w").astype(float)
    require(w.max() > 0, f"w: expected weights above 0, got none above {w.max():.3g}")
    return w / w.max()


def hat(n):
    z = np.arange(n)
    return np.minimum(z, n - 1 - z) / ((n - 1) // 2)


def check_one_input(subject, n):
    """Compare the weights of n levels, as the checks below do."""
    same(get_answer(subject, n), hat(n), 1e-3, what="w")


# of an 8-bit photo: only the last check asks for another number
LEVEL_COUNT = 256


def test_every_level_has_a_weight_of_at_least_0(subject, rng):
    """Return one weight for each pixel value.

    w is an array (n,), from pixel value 0 to pixel value n - 1.

    No weight is below 0.
    """
    n = LEVEL_COUNT
    w = finite(subject.hat(n), (n,), what="w")
    require(
        (w >= 0).all(), f"w: expected weights of at least 0, got {float(w.min()):.3g}", answer=w
    )


@points(4)
def test_the_weight_is_largest_in_the_middle_and_falls_to_both_ends(subject, rng):
    """Which pixel values are most reliable: those at the ends of the range, or those in the middle?

    The weight decreases toward pixel value 0 and toward the highest pixel value, n - 1.

    w(z) = z below the middle, and w(z) = n - 1 - z above it.
    """
    n = LEVEL_COUNT
    w = get_answer(subject, n)
    # the one in the middle may be 0
    steps = np.diff(w) * np.where(np.arange(n - 1) < n // 2, 1, -1)
    wrong = next((int(z) for z in np.flatnonzero(steps <= 0) if z != n // 2 - 1), n)
    message = f"w: expected weights that rise to the middle and fall after it; yours do not at level {wrong}"
    require(wrong == n, message, expected=hat(n), answer=w, kind="curve")
    same(w, hat(n), 0.02, what="w", kind="curve")  # another check tests the ends


@points(3)
def test_clipped_levels_have_weight_0(subject, rng):
    """What does a pixel of value 0 or n - 1 tell you about the light?

    Only "at most" or "at least". It measures nothing, so its weight is 0.

    w(0) = w(n - 1) = 0. Do not add 1.
    """
    n = LEVEL_COUNT
    w = get_answer(subject, n)
    same(w[[0, -1]], [0, 0], 1e-6, what=f"the weights of levels 0 and {n - 1}")


@points(3)
def test_any_number_of_levels_works(subject, rng):
    """How many pixel values does a 12-bit RAW photo have?

    The argument n is the number of pixel values. Is there a 255 or a 128 in your code?

    Use z = arange(n); the highest pixel value is n - 1.
    """
    for n in (2 * int(rng.integers(10, 60)), 4096):
        same(get_answer(subject, n), hat(n), 1e-3, what=f"w of {n} levels", kind="curve")
