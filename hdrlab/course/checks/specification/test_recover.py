"""Checks of recover(images, times), Mitsunaga and Nayar's response: g, the ln exposure of each
level, with g[128] = 0.
"""

import numpy as np

from hdrlab.capture import camera, responses
from hdrlab.course.checks import laws
from hdrlab.course.checks.compare import as_shape, finite, numbers, points, require, same
from hdrlab.response import mitsunaga

SHOWN = slice(25, 246)


def get_answer(subject, images, times, channels=(), **options):
    """Return g in nats, shifted to g[128] = 0, for times in seconds, passed as on the sheet.

    Minus infinity at level 0 is replaced by the log of half of level 1.
    """
    exposures = times
    answer = numbers(subject.recover(images, exposures, **options), what="g")
    nats = 1
    g = nats * as_shape(answer, (256, *channels), "g").astype(float)
    g[0] = np.where(np.isneginf(g[0]), g[1] - np.log(2), g[0])
    g = finite(g, (256, *channels), what="g")
    return g - g[128]


def photographs(rng, response, frames=5, shape=(60, 80)):
    """Return a Bracket of frames one stop apart, with almost no noise."""
    E = (10.0 ** rng.uniform(-1.5, 1.5, shape)).astype(np.float32)
    return camera.shoot(
        E, camera.times_around(E, frames, stops=1), camera.Camera(response=response), rng=rng
    )


def settled(rng):
    """Return a response and its photos, for which a polynomial of order 5 increases without a
    constraint.

    Where it decreases, the paper can be read in several ways: a clamp, a constraint, or neither.
    """
    for _ in range(20):
        response = laws.drawn_response(rng)
        photos = photographs(rng, response)
        g = mitsunaga.recover(photos.images, photos.times, order=5)
        slope = 255 * np.diff(np.exp(g - g[255]))[1:].min()
        if slope > 0.01 and laws.curve_error(g, responses.true_g(response)) < 0.005:
            break
    return response, photos


def same_curve(g, response, tolerance):
    """Compare f^-1 = exp g, with its unit fitted, over levels 10 to 250."""
    truth = responses.true_g(response)
    error = laws.curve_error(g, truth)
    message = f"g: expected the curve of the camera within {tolerance:.1%}, got {error:.1%}"
    require(error <= tolerance, message, expected=truth, answer=g, kind="curve")


# few pixels do not determine a curve, and right fits of them differ
check_one_input = None


def test_every_level_above_0_has_a_finite_g(subject, rng):
    """Return one number for each of the 256 pixel values.

    f^-1(0) = 0, so g[0] may be minus infinity. All other values of g must be
    finite.

    Instead, you can give pixel value 0 a fraction of the f^-1 of pixel value 1.
    """
    photos = photographs(rng, "linear", frames=3)
    get_answer(subject, photos.images, photos.times, order=3)


@points(7)
def test_the_curve_of_a_camera_is_recovered(subject, rng):
    """Plot f^-1 over M from 0 to 1: it must go through (0, 0) and (1, 1).

    With known ratios R, minimizing the sum of (f^-1(M_q) - R f^-1(M_q+1))^2 is linear least squares
    in the coefficients.

    Use only samples that are between 0.05 and 0.98 in both frames. The condition f^-1(1) = 1 fixes
    the scale.
    """
    for _ in range(2):
        response, photos = settled(rng)
        same_curve(get_answer(subject, photos.images, photos.times, order=5), response, 0.025)


@points(5, needs="test_the_curve_of_a_camera_is_recovered")
def test_frames_in_another_order_give_the_same_curve(subject, rng):
    """In eq. 5, R is the ratio of a frame to the next longer one, so it is below 1.

    R = t_q / t_q+1, not the inverse.

    Sort the frames by their times first.
    """
    response, photos = settled(rng)
    order = rng.permutation(len(photos.times))
    shuffled = get_answer(subject, photos.images[order], photos.times[order], order=5)
    same_curve(shuffled, response, 0.025)


@points(5, needs="test_the_curve_of_a_camera_is_recovered")
def test_rough_times_are_corrected(subject, rng):
    """The method assumes that the times are only approximate. Which quantity does it correct?

    It corrects R. With a known curve, R is the sum of f^-1 over one frame divided by the sum over
    the next one.

    Alternate between coefficients and ratios until f^-1 changes by less than eps.
    """
    for frame, factor in ((1, 1.3), (2, 1 / 1.3)):
        photos = photographs(rng, "linear", frames=4)
        rough = photos.times.copy()
        rough[frame] *= (
            factor  # one frame in the middle; a constant factor per stop could not be detected
        )
        same_curve(get_answer(subject, photos.images, rough, order=3), "linear", 0.015)


@points(4, needs="test_the_curve_of_a_camera_is_recovered")
def test_the_curve_rises_at_all_levels(subject, rng):
    """Does your curve fall anywhere? A brighter pixel value can never mean less light.

    f^-1 must be above 0 and must increase; otherwise g has no value or falls.

    Clamp the differences of f^-1 between neighboring pixel values before you take the logarithm.
    """
    for response in (laws.drawn_response(rng), laws.drawn_response(rng)):
        photos = photographs(rng, response)
        g = get_answer(subject, photos.images, photos.times, order=6)
        falls = np.sum(np.diff(g) < -1e-6)
        require(falls == 0, f"g: expected a curve that rises, got {falls} falls", answer=g)
        same_curve(g, response, 0.05)


@points(4, needs="test_the_curve_of_a_camera_is_recovered")
def test_three_equal_channels_have_the_gray_curve(subject, rng):
    """Each channel has its own curve.

    For color photos, g has the shape (256, 3).

    Three equal channels must all have the curve of the gray photo.
    """
    photos = photographs(rng, "gamma", frames=4)
    rgb = get_answer(subject, np.stack([photos.images] * 3, axis=-1), photos.times, (3,), order=5)
    gray = get_answer(subject, photos.images, photos.times, order=5)
    same(rgb[SHOWN], np.stack([gray] * 3, axis=-1)[SHOWN], 0.02, what="g at levels 25 to 245")
    same_curve(gray, "gamma", 0.025)
