"""Checks of fit_channel_scales(I, M), the channel scales that keep chromaticity: k (3,)."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same
from hdrlab.radiance import scales


def draw_inputs(rng):
    """Return radiance I (N, 3), each channel in a unit of its own, and the pixel values M (N, 3)."""
    M = rng.uniform(0.1, 0.5, (80, 3))
    return M * rng.uniform(0.4, 2.5, 3), M


def distorted(radiance, M, *, rng):
    """Return I and M of a camera that keeps chromaticity only nearly.

    A fifth of the pixels is dark and lacks red, and another fifth is bright and has too much blue.
    """
    radiance = radiance * np.exp(rng.normal(0, 0.1, radiance.shape))
    dark = slice(0, len(radiance) // 5)
    M[dark] *= [0.06, 0.5, 0.5]
    radiance[dark] *= [0.3, 0.5, 0.5]
    bright = slice(len(radiance) // 5, 2 * len(radiance) // 5)
    M[bright] *= 1.9
    radiance[bright] *= [1.9, 1.9, 3.2]
    return radiance, M


def same_scales(subject, radiance, M, *, what="k"):
    """Compare k with the library's, to half a percent."""
    k = scales.fit_channel_scales(radiance, M)
    answer = finite(subject.fit_channel_scales(radiance, M), (3,), what=what).astype(float)
    same(answer / k, np.ones(3), 5e-3, what=f"{what} / the best k")


@points(5)
def test_the_scales_of_a_camera_that_keeps_chromaticity_are_exact(subject, rng):
    """k I must have the direction of M. What does that say about the ratio of two channels?

    k_R I_R / I_G must equal M_R / M_G, and in the same way for blue.

    k multiplies the radiance I. Divide all three scales by that of green, so that k[1] is 1.
    """
    radiance, M = draw_inputs(rng)
    same_scales(subject, radiance, M)


@points(8)
def test_the_scales_minimize_the_distance_of_the_directions(subject, rng):
    """No k fits all pixels. Which sum of squares is the smallest?

    The sum of the squared differences of directions, k I / |k I| - M / |M|, over pixels and
    channels. |.| is the length of a pixel's vector of three channels.

    Minimize over two numbers, the scales of red and blue, for example with
    scipy.optimize.least_squares or scipy.optimize.minimize. Search for ln k, so that k stays positive.
    """
    for _ in range(2):
        same_scales(
            subject, *distorted(*draw_inputs(rng), rng=rng), what="k of a camera with errors"
        )


@points(4)
def test_a_pixel_counts_whatever_its_brightness_is(subject, rng):
    """Some pixels get ten times as bright in the photo, and keep their color. What changes?

    Nothing: a direction has no length.

    Divide each row of M, and each row of k I, by its length.
    """
    radiance, M = distorted(*draw_inputs(rng), rng=rng)
    M = M * np.where(np.arange(len(M)) % 2, 1.0, 0.1)[:, None]
    same_scales(subject, radiance, M, what="k with some pixels ten times darker")


@points(3, needs="test_the_scales_of_a_camera_that_keeps_chromaticity_are_exact")
def test_another_unit_of_a_channel_changes_its_scale_alone(subject, rng):
    """The red radiance is given in a unit three times as large, so its numbers are a third. And k?

    The red scale becomes three times as large, and the others stay.

    The result may depend on the radiance only through k I.
    """
    radiance, M = distorted(*draw_inputs(rng), rng=rng)
    before = finite(subject.fit_channel_scales(radiance, M), (3,), what="k").astype(float)
    after = finite(subject.fit_channel_scales(radiance / [3, 1, 1], M), (3,), what="k").astype(
        float
    )
    same(after / before, [3, 1, 1], 1e-2, what="k, compared with k before the change")
