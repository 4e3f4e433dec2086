"""The weights of pixel levels: hat(n) -> w (n,). Their scale is free; what counts is one against another."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, require, same


def asked(subject, n):
    """Return w (n,) in shares of its largest value."""
    w = finite(subject.hat(n), (n,), what="w").astype(float)
    require(w.max() > 0, f"w: expected weights above 0, got none above {w.max():.3g}")
    return w / w.max()


def hat(n):
    z = np.arange(n)
    return np.minimum(z, n - 1 - z) / ((n - 1) // 2)


def some(rng):
    """Return how many levels to ask for, about as many as a photograph has: no table learnt by heart."""
    return 2 * int(rng.integers(100, 140))


def test_every_level_has_a_weight_that_is_not_negative(subject, rng):
    """As many weights as levels.

    An array (n,), from level 0 to n - 1.

    No weight is below 0.
    """
    n = some(rng)
    w = finite(subject.hat(n), (n,), what="w")
    require((w >= 0).all(), f"w: expected weights of at least 0, got {float(w.min()):.3g}", came=w)


@points(4)
def test_the_middle_counts_most_and_the_weight_falls_to_either_side(subject, rng):
    """Which levels does a photograph tell best: the ends of its range, or the middle?

    A level is trusted the less the closer it is to 0 or to the top, 255 where there are 256.

    w(z) = z below the middle, and n - 1 - z above it.
    """
    n = some(rng)
    w = asked(subject, n)
    steps = np.diff(w) * np.where(
        np.arange(n - 1) < n // 2, 1, -1
    )  # the one in the middle may be 0
    wrong = next((int(z) for z in np.flatnonzero(steps <= 0) if z != n // 2 - 1), n)
    said = (
        f"w: expected to rise up to the middle and to fall from there, not so from level {wrong} on"
    )
    require(wrong == n, said, expected=hat(n), came=w, kind="curve")
    same(w, hat(n), 0.02, what="w", kind="curve")  # ends that count are another promise


@points(3)
def test_clipped_levels_do_not_count(subject, rng):
    """What does a pixel of the lowest level say of the light? And one of the highest?

    Only "at most" and "at least": they measure nothing, and count nothing.

    w(0) = w(n - 1) = 0: do not add 1.
    """
    n = some(rng)
    w = asked(subject, n)
    same(w[[0, -1]], [0, 0], 1e-6, what=f"the weights of levels 0 and {n - 1}")


@points(3)
def test_any_number_of_levels_will_do(subject, rng):
    """How many levels has a RAW photograph of 12 bits?

    n says how many: is there a 255 or a 128 in your code?

    z = arange(n), and the top level is n - 1.
    """
    for n in (2 * int(rng.integers(10, 60)), 4096):
        same(asked(subject, n), hat(n), 1e-3, what=f"w of {n} levels", kind="curve")
