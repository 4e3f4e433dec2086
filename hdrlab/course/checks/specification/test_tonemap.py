"""Checks of tonemap(L, key, white, local, phi, threshold), the photographic operator: Ld in [0,
1].
"""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks import laws
from hdrlab.course.checks.compare import finite, numbers, points, require, same
from hdrlab.tonemap import reinhard

SHOWN = "test_the_scene_fits_the_range_of_a_display"
OPERATOR = "test_it_is_the_photographic_operator"


def get_answer(subject):
    """Return the subject's operator with its result as float32, the type in which images are
    sent.
    """
    return lambda L: numbers(subject.tonemap(L), what="Ld").astype(np.float32)


def draw_inputs(rng, shape=(96, 128)):
    """Return luminance over a few decades, without black."""
    soft = gaussian_filter(rng.standard_normal(shape), 6)
    return np.exp(1.5 * soft / soft.std() + 0.2 * rng.standard_normal(shape)).astype(np.float32)


def scaled(L, key=0.18):
    """Return Lm, the luminance scaled by the key."""
    factor = key
    return reinhard.scale_to_key(L.astype(float), key=factor)


def displayed(Lm, adaptation, white):
    """Return the curve of the sheet, clipped at 1."""
    return np.minimum(Lm * (1 + Lm / white**2) / (1 + adaptation), 1)


# right operators may blur in different ways, so the pixels of the local ones are all alike
SMALL_INPUTS = [
    (np.array([[1.0]]), {"key": 0.5, "white": 2.0}),
    (np.array([[1.0, 4.0]]), {"key": 0.5, "white": 2.0}),
    (np.array([[1.0, 100.0]]), {"key": 0.5, "white": 2.0}),
    (np.array([[1e-6, 4e-6]]), {"key": 0.5, "white": 2.0}),
    (np.array([[1.0, 4.0]]),),
    (np.array([[1.0, 400.0]]),),
    (np.full((9, 9), 1.0), {"key": 0.5, "white": 2.0, "local": True}),
]


@points(14)
def test_it_is_the_photographic_operator(subject, rng):
    """What are Lm and Ld of a pixel with L = Lav, the log average?

    Scale L by key / Lav, with Lav = exp(mean(log L)).

    Ld = Lm (1 + Lm / white^2) / (1 + Lm), clipped at 1. Use the key and the white that you are
    given.
    """
    for key, white in ((0.18, np.inf), (float(rng.uniform(0.3, 0.7)), float(rng.uniform(1.5, 4)))):
        L = draw_inputs(rng)
        Lm = scaled(L, key)
        what = f"Ld with key={key:.3g} and white={white:.3g}"
        answer = subject.tonemap(L, key=key, white=white)
        expected = displayed(Lm, Lm, white)
        same(answer, expected, 0.01, what=what, picture=True)


@points(6, needs=OPERATOR)
def test_the_default_white_is_the_brightest_luminance_without_outliers(subject, rng):
    """If no white is given, which luminance becomes white?

    The largest scaled luminance after you leave out the brightest 0.01 % of the pixels, and at
    least 1.

    white = max(1, np.quantile(Lm, 0.9999)). Compute it after scaling to the key.
    """
    L = draw_inputs(rng)
    # so many that every rule of quantiles finds them
    L[:6, :9] = float(rng.uniform(1.5, 3)) * L.max()
    for luminance in (L, L**0.1):  # all of the second one is below 1
        Lm = scaled(luminance)
        expected = displayed(Lm, Lm, max(1.0, Lm.max()))
        same(subject.tonemap(luminance), expected, 0.01, what="Ld without a white", picture=True)


@points(6, needs=OPERATOR)
def test_local_divides_each_pixel_by_its_neighborhood(subject, rng):
    """With local=True, which brightness stands in the denominator?

    V1 at the largest width that is still even, where V1 is Lm blurred at s = 1, 1.6, ... with sigma
    = s / 4.

    phi and threshold decide the width: pass them on to your scale_steps.
    """
    for options in ({}, {"phi": 12.0, "threshold": 0.02}):
        L = draw_inputs(rng)
        Lm = scaled(L)
        expected = displayed(Lm, reinhard.local_adaptation(Lm, **options), np.inf)
        answer = finite(
            subject.tonemap(L, white=np.inf, local=True, **options), L.shape, what="Ld"
        ).astype(float)
        off = np.mean(np.abs(answer - expected)[12:-12, 12:-12] > 0.01)  # some lie at the threshold
        message = f"Ld with local=True{options or ''}: {off:.0%} of the pixels differ from what is expected"
        require(off <= 0.03, message, expected=expected, answer=answer, kind="image")


@points(2)
def test_the_scene_fits_the_range_of_a_display(subject):
    """Look at your image: can you see more than half of the scene?

    A display has two decades at most. Anything below or above them is black or white.

    At least half of the pixels must be between 0.01 and 0.99, and pixels of different luminance
    must differ in the image.
    """
    laws.shows_the_scene(get_answer(subject))


@points(3, needs=SHOWN)
def test_the_result_stays_in_range_for_any_scene(subject):
    """Try your operator on a black image, on one lamp in the dark, and on a single pixel.

    Images that are all black or all alike can give 0 / 0 or log 0.

    Clip the result to 0 ... 1. Before you divide by a maximum, a range or a mean, check that it is
    not 0.
    """
    laws.stays_in_range(get_answer(subject))


@points(1, needs=SHOWN)
def test_the_same_image_gives_the_same_result(subject):
    """Does your operator remember anything between two calls?

    Look for random numbers without a seed, and for a global variable that changes.

    The same image must give the same result.
    """
    laws.answers_the_same_twice(get_answer(subject))


@points(3, needs=OPERATOR)
def test_one_hot_pixel_does_not_darken_the_image(subject, rng):
    """One pixel is a million times as bright as the others. What happens to all other pixels?

    The maximum of an image depends on a single pixel.

    Leave out the brightest 0.01 % of the pixels. In this image, these are 5.
    """
    tonemap = get_answer(subject)
    L = laws.scene((200, 256))
    for luminance in (L, L**0.2):
        medians = [
            float(np.median(tonemap(picture))) for picture in (luminance, laws.hot_pixel(luminance))
        ]
        same(medians[1], medians[0], 0.02, what="the median of Ld with a hot pixel")


@points(2, needs=SHOWN)
def test_bright_regions_stay_bright(subject):
    """Are bright regions still bright?

    Compare the averages of large regions before and after. Their order should hardly change.

    Look for a wrong sign, or for a scale that should be its inverse.
    """
    laws.keeps_the_light_the_right_way_up(get_answer(subject))


@points(2, needs=OPERATOR)
def test_the_unit_of_luminance_cancels(subject):
    """The unit of luminance does not matter: watts and candelas describe the same scene.

    Twice the luminance everywhere must give the same image.

    Scale by a statistic of the image itself: the log average, the median, or a percentile.
    """
    laws.exposure(get_answer(subject))
