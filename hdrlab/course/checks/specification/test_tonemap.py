"""The photographic operator: tonemap(L, key, white, local, phi, threshold) -> Ld in [0, 1]."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks import laws
from hdrlab.course.checks.compare import finite, numbers, points, require, same
from hdrlab.tonemap import reinhard

SHOWN = "test_it_shows_the_scene_within_what_a_display_has"
OPERATOR = "test_it_is_the_photographic_operator"


def asked(subject):
    """Return the subject's operator, its answer as float32, which is how pictures travel."""
    return lambda L: numbers(subject.tonemap(L), what="Ld").astype(np.float32)


def drawn(rng, shape=(96, 128)):
    """Return luminance of some decades, and no black in it."""
    soft = gaussian_filter(rng.standard_normal(shape), 6)
    return np.exp(1.5 * soft / soft.std() + 0.2 * rng.standard_normal(shape)).astype(np.float32)


@points(14)
def test_it_is_the_photographic_operator(subject, rng):
    """Which Lm has a pixel that is as bright as the log average? And which Ld?

    Scale L by key / Lav, Lav = exp(mean(log L)).

    Ld = Lm (1 + Lm / white^2) / (1 + Lm), at most 1, with the key and the white that are given.
    """
    for key, white in ((0.18, np.inf), (float(rng.uniform(0.3, 0.7)), float(rng.uniform(1.5, 4)))):
        L = drawn(rng)
        Lm = reinhard.scale_to_key(L.astype(float), key=key)
        what = f"Ld with key={key:.3g} and white={white:.3g}"
        came, expected = subject.tonemap(L, key=key, white=white), reinhard.display(Lm, Lm, white)
        same(came, expected, 0.01, what=what, picture=True)


@points(6, needs=OPERATOR)
def test_the_white_is_the_brightest_but_for_a_few_pixels(subject, rng):
    """Without a white, which luminance becomes white?

    The brightest scaled luminance but for 0.01 % of the pixels, and at least 1.

    white = max(1, np.quantile(Lm, 0.9999)), with Lm after the scaling to the key.
    """
    L = drawn(rng)
    L[:6, :9] = (
        float(rng.uniform(1.5, 3)) * L.max()
    )  # so many that every rule of quantiles finds them
    for one in (L, np.sqrt(np.sqrt(L))):
        Lm = reinhard.scale_to_key(one.astype(float))
        expected = reinhard.display(Lm, Lm, max(1.0, Lm.max()))
        same(subject.tonemap(one), expected, 0.01, what="Ld without a white", picture=True)


@points(6, needs=OPERATOR)
def test_local_holds_back_each_pixel_by_its_neighbourhood(subject, rng):
    """With local=True, whose brightness stands below the fraction?

    V1 at the largest width that is still even, of Lm blurred at s = 1, 1.6, ... with sigma = s / 4.

    phi and threshold decide how large that is: hand them on to your scale_steps.
    """
    for knobs in ({}, {"phi": 12.0, "threshold": 0.02}):
        L = drawn(rng)
        expected = reinhard.tonemap(L, white=np.inf, local=True, **knobs)
        came = finite(
            subject.tonemap(L, white=np.inf, local=True, **knobs), L.shape, what="Ld"
        ).astype(float)
        off = np.mean(np.abs(came - expected)[12:-12, 12:-12] > 0.01)  # some lie at the threshold
        said = f"Ld with local=True{knobs or ''}: expected another value at {off:.0%} of the pixels"
        require(off <= 0.03, said, expected=expected, came=came, kind="image")


@points(2)
def test_it_shows_the_scene_within_what_a_display_has(subject):
    """Look at the picture: can more than half of the scene be seen?

    A display has two decades at most; what is below or above them is black or white.

    Half the pixels, or more, belong between 0.01 and 0.99, and what differs in light differs in the
    picture.
    """
    laws.shows_the_scene(asked(subject))


@points(3, needs=SHOWN)
def test_it_stays_in_range_whatever_the_scene(subject):
    """Try your operator on black, on one lamp in the dark, on a single pixel.

    0 / 0 and log 0 come from pictures that are all black, or all alike.

    Clip the answer to 0 ... 1, and look after a maximum, a range or a mean of 0 before you divide
    by it.
    """
    laws.stays_in_range(asked(subject))


@points(1, needs=SHOWN)
def test_it_answers_the_same_twice(subject):
    """Does your operator remember anything?

    Randomness without a seed, or a global that changes?

    The same picture must give the same answer.
    """
    laws.answers_the_same_twice(asked(subject))


@points(3, needs=OPERATOR)
def test_it_shrugs_off_a_hot_pixel(subject, rng):
    """One pixel of a million times the light: what happens to all the others?

    A maximum over the picture is a matter of one pixel.

    Leave out 0.01 % of the pixels: of this picture these are 5.
    """
    tonemap, L = asked(subject), laws.scene((200, 256))
    for one in (L, L**0.2):
        medians = [float(np.median(tonemap(picture))) for picture in (one, laws.hot_pixel(one))]
        same(medians[1], medians[0], 0.02, what="the median of Ld with a hot pixel")


@points(2, needs=SHOWN)
def test_it_keeps_the_light_the_right_way_up(subject):
    """Is what was bright still bright?

    Compare the averages of large regions before and after: their ranks should hardly change.

    A sign, or an inverse scale?
    """
    laws.keeps_the_light_the_right_way_up(asked(subject))


@points(2, needs=OPERATOR)
def test_the_unit_of_luminance_cancels(subject):
    """Radiance has no unit that is sacred: watts or candelas show the same scene.

    Twice the luminance everywhere is the same picture.

    Scale by a statistic of the picture itself: the log average, the median, a percentile.
    """
    laws.exposure(asked(subject))


@points(1, needs=SHOWN)
def test_it_takes_any_memory_layout(subject):
    """Which orders in memory does your code count on?

    ravel, reshape and views of other strides all name the same pixels.

    Begin with L = np.asarray(L, dtype=float).
    """
    laws.takes_any_memory_layout(asked(subject))
