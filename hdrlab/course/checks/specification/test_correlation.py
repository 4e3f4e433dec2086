"""Checks of correlation(X), how well two photos fit at every shift: c (2 h - 1, 2 w - 1)."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.align import cerman
from hdrlab.course.checks.compare import finite, points, require, same

SHAPE = (26, 34)
FULL = (2 * SHAPE[0] - 1, 2 * SHAPE[1] - 1)


def draw_inputs(rng, discarded=0.0):
    """Return X (2, h, w), two photos of one scene that is brighter on one side, and their shift."""
    h, w = SHAPE
    scene = gaussian_filter(rng.standard_normal((h + 12, w + 12)), 1.2) * 4
    scene += 6 + 0.15 * np.arange(w + 12)
    dy, dx = rng.integers(2, 6, 2) * rng.choice([-1, 1], 2)
    fixed = scene[6 : 6 + h, 6 : 6 + w]
    moving = scene[6 + dy : 6 + dy + h, 6 + dx : 6 + dx + w]
    X = np.stack([fixed, moving]).astype(np.float32)
    X[1] *= 1 + 0.02 * rng.standard_normal(SHAPE)
    X[rng.random(X.shape) < discarded] = np.nan
    if discarded:
        X[:, 15:, :8] = np.nan
    return X, np.array([dy, dx])


def same_correlation(subject, X, what="c"):
    c = cerman.correlation(X)
    same(subject.correlation(X), c, 1e-3 * np.abs(c).max(), what=what, picture=True)


def is_valid_input(X):
    """Return whether both images have rows and columns, and no pixel is discarded."""
    return min(X.shape[1:]) >= 2 and bool(np.isfinite(X).all())


@points(3)
def test_the_largest_value_is_at_the_shift_of_the_photos(subject, rng):
    """By how much must the second photo move, so that it lies on the first one?

    By the shift s at which the sum of a(p + s) b(p) is largest. A shift of 0 is in the middle of c.

    c[i, j] belongs to the shift (i - (h - 1), j - (w - 1)).
    """
    X, shift = draw_inputs(rng)
    c = finite(subject.correlation(X), FULL, what="c")
    largest = np.array(np.unravel_index(int(np.argmax(c)), c.shape)) - np.array(SHAPE) + 1
    require(
        np.array_equal(largest, shift) and c.max() > c.min(),
        f"the largest c is at the shift {tuple(largest.tolist())}, expected {tuple(shift.tolist())}",
        expected=cerman.correlation(X),
        answer=c,
        kind="image",
    )


@points(8)
def test_each_value_is_the_sum_of_products_at_its_shift(subject, rng):
    """A Fourier transform makes an image periodic. How do you keep it from wrapping around?

    Pad both photos with zeros to at least (2 h - 1, 2 w - 1) before the transform.

    Subtract the local mean of each photo first. Of one of the two spectra, take the conjugate.
    """
    same_correlation(subject, draw_inputs(rng)[0])


@points(5)
def test_discarded_pixels_take_no_part(subject, rng):
    """A pixel is NaN in one photo. What does it contribute to the sum, and to a local mean?

    Nothing: it is 0 after the local mean is subtracted, and the mean is over the other pixels alone.

    Local mean: filter the photo with 0 for discarded pixels, and divide by the filtered mask of kept
    pixels.
    """
    same_correlation(
        subject, draw_inputs(rng, discarded=0.08)[0], what="c of photos with discarded pixels"
    )


@points(2, needs="test_each_value_is_the_sum_of_products_at_its_shift")
def test_exchanging_the_photos_reverses_all_shifts(subject, rng):
    """Which shift moves the first photo onto the second?

    The opposite one, in both directions.

    c must be turned by 180 degrees.
    """
    X, _ = draw_inputs(rng)
    c = finite(subject.correlation(X), FULL, what="c").astype(float)
    turned = subject.correlation(X[::-1].copy())
    same(turned, c[::-1, ::-1], 1e-3 * np.abs(c).max(), what="c, exchanged", picture=True)
