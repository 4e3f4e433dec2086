"""Checks of circle(A, B, tolerance, rings), the circle without vignetting: a radius in pixels."""

import numpy as np

from hdrlab.course.checks.compare import points, same
from hdrlab.response import selection

SHAPE = (120, 160)
# the largest radius, and the width of a ring of `circle`
OUTER = float(np.hypot(*SHAPE)) / 2
RING = 0.75 * OUTER / 40
# pixels: two rings, since the noise decides in which of them the circle ends
TOLERANCE = 2 * RING


def scene(rng):
    """Return the light of a scene, darker toward the corners, and each pixel's radius."""
    y, x = np.indices(SHAPE)
    waves = (
        np.sin(x / rng.uniform(5, 7)) + np.sin(y / rng.uniform(5, 7)) + rng.normal(0, 0.3, SHAPE)
    )
    r = selection.radius(SHAPE)
    light = 0.38 + 0.11 * waves - 0.1 * r / OUTER
    return np.clip(light, 0.05, 0.75), r


def respond(light):
    """Return the pixel values of a camera with a shoulder, so that no factor relates two photos."""
    steepness = 2.2
    values = 255 * (1 - np.exp(-steepness * light)) / (1 - np.exp(-steepness))
    return np.rint(values).clip(0, 255).astype(np.uint8)


def photos(light, falloff, ratio=1.3):
    """Return two photos, the second with more light and with vignetting."""
    return respond(light), respond(ratio * light * falloff)


def same_radius(subject, A, B, *, radius, what="the radius", **options):
    same(subject.circle(A, B, **options), radius, TOLERANCE, what=f"{what}, in pixels")


# few pixels fill few of the bins, and right functions treat nearly empty bins in different ways
check_one_input = None


@points(6)
def test_the_circle_ends_where_the_second_photo_gets_darker(subject, rng):
    """Which value does a pixel of A have in B? How do you know, without the camera's response?

    From the pixels near the middle, where there is no vignetting. Average B over all pixels there
    that have the same value in A.

    Ring by ring, take the median of B minus this prediction. The circle ends at the inner edge of
    the first two adjacent rings in which it is above `tolerance`, or below -`tolerance`.
    """
    for part in (rng.uniform(0.4, 0.55), rng.uniform(0.65, 0.8)):
        light, r = scene(rng)
        A, B = photos(light, np.where(r < part * OUTER, 1, 0.85))
        same_radius(subject, A, B, radius=part * OUTER)


@points(2, needs="test_the_circle_ends_where_the_second_photo_gets_darker")
def test_the_circle_also_ends_where_the_first_photo_gets_darker(subject, rng):
    """The photos are exchanged. Is B now below or above its prediction in the corners?

    Above. But they do not agree, so the circle ends here, too.

    Compare the absolute value of the median with `tolerance`.
    """
    light, r = scene(rng)
    part = rng.uniform(0.5, 0.7)
    A, B = photos(light, np.where(r < part * OUTER, 1, 0.85))
    same_radius(subject, B, A, radius=part * OUTER, what="the radius of exchanged photos")


@points(3)
def test_without_vignetting_the_circle_contains_the_image(subject, rng):
    """Both photos have the same aperture. How large is the circle?

    It contains the whole image, corners included.

    Return the distance from the middle to the farthest pixel.
    """
    light, _ = scene(rng)
    same_radius(subject, *photos(light, 1.0), radius=OUTER, what="the radius without vignetting")


@points(3)
def test_clipped_pixels_do_not_count(subject, rng):
    """A lamp is clipped in B. What does B minus its prediction say there?

    Nothing: B cannot be brighter than its largest value.

    Use only pixels from 5 to 249, in both photos.
    """
    light, r = scene(rng)
    part = rng.uniform(0.6, 0.75)
    A, B = photos(light, np.where(r < part * OUTER, 1, 0.85))
    is_lamp = (r > 0.3 * OUTER) & (rng.random(SHAPE) < 0.65)
    A[is_lamp] = rng.integers(120, 200, SHAPE)[is_lamp]
    B[is_lamp] = 255
    same_radius(subject, A, B, radius=part * OUTER, what="the radius with clipped pixels")
    bright = B.copy()
    dim = A.copy()
    is_lamp = rng.random(SHAPE) < 0.6
    bright[is_lamp] = 255
    dim[is_lamp] = np.where(r < 0.3 * OUTER, 170, 220)[is_lamp]
    what = "the radius with pixels that are clipped in the first photo"
    same_radius(subject, bright, dim, radius=part * OUTER, what=what)
    A, B = photos(light, np.where(r < part * OUTER, 1, 0.85))
    B[r > 0.9 * OUTER] = 0
    same_radius(subject, A, B, radius=part * OUTER, what="the radius with black corners")


@points(2)
def test_a_small_difference_is_tolerated(subject, rng):
    """B is darker by about 5 of 255 outside, and the tolerance is 12. Where does the circle end?

    Nowhere: the difference is within the tolerance.

    Compare the median with `tolerance`. Its default is 1.
    """
    light, r = scene(rng)
    A, B = photos(light, np.where(r < 0.6 * OUTER, 1, 0.95))
    same_radius(
        subject, A, B, radius=OUTER, what="the radius for a tolerance of 12", tolerance=12.0
    )
    answer = subject.circle(A, B)
    same(answer, 0.6 * OUTER, TOLERANCE, what="the radius for the default tolerance")


@points(2, needs="test_the_circle_ends_where_the_second_photo_gets_darker")
def test_a_single_ring_does_not_end_the_circle(subject, rng):
    """Somebody moved in one ring only. Is this vignetting?

    No: vignetting goes on to the corners.

    The circle ends only where two adjacent rings differ.
    """
    light, r = scene(rng)
    A, B = photos(light, 1.0)
    edges = np.linspace(OUTER / 4, OUTER, 41)
    k = int(rng.integers(10, 25))
    has_moved = (r >= edges[k] + 0.02) & (r < edges[k + 1] - 0.02)
    B[has_moved] -= 12
    same_radius(subject, A, B, radius=OUTER, what="the radius with a change in one ring")
