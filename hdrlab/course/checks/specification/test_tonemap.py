"""Your own operator: tonemap(L) -> Ld in [0, 1], under the laws that every operator of hdrlab obeys."""

import numpy as np
import pytest

from hdrlab.course.checks import laws
from hdrlab.course.checks.compare import numbers


def asked(subject):
    """Return the subject's operator, its answer as float32, which is how pictures travel."""

    def tonemap(L):
        return numbers(subject.tonemap(L), what="Ld").astype(np.float32)

    return tonemap


@pytest.mark.points(2)
def test_it_shows_the_scene_within_what_a_display_has(subject):
    """Look at the picture: can more than half of the scene be seen?

    A display has two decades at most; what is below or above them is black or white.

    Half the pixels, or more, belong between 0.01 and 0.99, and what differs in light differs in the picture.
    """
    laws.shows_the_scene(asked(subject))


@pytest.mark.points(4, needs="test_it_shows_the_scene_within_what_a_display_has")
def test_it_stays_in_range_whatever_the_scene(subject):
    """Try your operator on black, on one lamp in the dark, on a single pixel.

    0 / 0 and log 0 come from pictures that are all black, or all alike.

    Clip the answer to 0 ... 1, and look after a maximum, a range or a mean of 0 before you divide by it.
    """
    laws.stays_in_range(asked(subject))


@pytest.mark.points(2, needs="test_it_shows_the_scene_within_what_a_display_has")
def test_it_answers_the_same_twice(subject):
    """Does your operator remember anything?

    Randomness without a seed, or a global that changes?

    The same picture must give the same answer.
    """
    laws.answers_the_same_twice(asked(subject))


@pytest.mark.points(4, needs="test_it_shows_the_scene_within_what_a_display_has")
def test_it_shrugs_off_a_hot_pixel(subject):
    """One pixel of a million times the light: what happens to all the others?

    A maximum over the picture is a matter of one pixel.

    Use a percentile, such as the 99.9th, instead of the maximum.
    """
    laws.shrugs_off_a_hot_pixel(asked(subject))


@pytest.mark.points(4, needs="test_it_shows_the_scene_within_what_a_display_has")
def test_it_keeps_the_light_the_right_way_up(subject):
    """Is what was bright still bright?

    Compare the averages of large regions before and after: their ranks should hardly change.

    A sign, or an inverse scale?
    """
    laws.keeps_the_light_the_right_way_up(asked(subject))


@pytest.mark.points(4, needs="test_it_shows_the_scene_within_what_a_display_has")
def test_the_unit_of_luminance_cancels(subject):
    """Radiance has no unit that is sacred: watts or candelas show the same scene.

    Twice the luminance everywhere is the same picture.

    Scale by a statistic of the picture itself: the log average, the median, a percentile.
    """
    laws.exposure(asked(subject))


@pytest.mark.points(2, needs="test_it_shows_the_scene_within_what_a_display_has")
def test_it_takes_any_memory_layout(subject):
    """Which orders in memory does your code count on?

    ravel, reshape and views of other strides all name the same pixels.

    Begin with L = np.asarray(L, dtype=float).
    """
    laws.takes_any_memory_layout(asked(subject))
