"""Checks of find_by_locus(Z), pixels with the color of skin: a mask (...)."""

import numpy as np

from hdrlab.course.checks.compare import points, same
from hdrlab.enhance import skin


def from_chromaticity(r, g, rng):
    """Return pixel values (..., 3) with the chromaticities r and g, and any brightness."""
    total = rng.uniform(150, 500, np.shape(r))
    return np.stack([r, g, 1 - r - g], axis=-1) * total[..., None]


def clear(r, g):
    """Return where no limit is nearer than a thousandth."""
    limits = [
        g - np.polyval(skin.UPPER, r),
        g - np.polyval(skin.LOWER, r),
        r - g,
        np.hypot(r - 1 / 3, g - 1 / 3) - 0.02,
    ]
    return np.abs(limits).min(axis=0) > 1e-3


def same_mask(subject, r, g, rng, what="skin"):
    Z = from_chromaticity(r, g, rng)
    same(subject.find_by_locus(Z), skin.find_by_locus(Z), 0, what=what, where=clear(r, g))


@points(5)
def test_skin_lies_between_two_parabolas(subject, rng):
    """r and g do not change with brightness. Which of them has skin?

    Those between two parabolas, the upper and the lower one.

    -0.776 r^2 + 0.5601 r + 0.1766 < g < -1.3767 r^2 + 1.0743 r + 0.1452.
    """
    r = rng.uniform(0.36, 0.6, 400)
    same_mask(subject, r, rng.uniform(0.2, 0.34, 400), rng)


@points(3)
def test_white_is_no_skin(subject, rng):
    """White lies between the parabolas. Is it skin?

    No. Leave out colors that are close to r = g = 1/3.

    Skin needs (r - 1/3)^2 + (g - 1/3)^2 > 0.0004.
    """
    angle = rng.uniform(-1.2, 0.1, 300)
    distance = rng.uniform(0.003, 0.06, 300)
    r = 1 / 3 + distance * np.cos(angle)
    g = 1 / 3 + distance * np.sin(angle)
    same_mask(subject, r, g, rng, what="skin, for colors around white")


@points(2)
def test_skin_has_more_red_than_green(subject, rng):
    """Some yellow and green colors lie between the parabolas, too. How do they differ from skin?

    They have at least as much green as red.

    Skin needs r > g.
    """
    r = rng.uniform(0.25, 0.42, 400)
    same_mask(subject, r, r + rng.uniform(-0.05, 0.07, 400), rng, what="skin, for yellow colors")


@points(1, needs="test_skin_lies_between_two_parabolas")
def test_a_picture_of_any_shape_can_be_asked(subject, rng):
    """Z is an image, (H, W, 3). Which shape has the mask?

    (H, W): one answer for each pixel.

    Use Z[..., 0] for red, so that the shape does not matter. Black pixels, with R + G + B = 0, are no skin.
    """
    r = rng.uniform(0.36, 0.55, (6, 9))
    g = rng.uniform(0.24, 0.34, (6, 9))
    Z = from_chromaticity(r, g, rng)
    Z[0, :4] = 0
    is_clear = clear(r, g)
    is_clear[0, :4] = True
    same(subject.find_by_locus(Z), skin.find_by_locus(Z), 0, what="skin", where=is_clear)
