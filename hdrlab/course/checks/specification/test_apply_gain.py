"""What a screen makes of a gain map: apply_gain(sdr, g, low, high, W, gamma, k) -> light, 1 = white."""

import numpy as np

from hdrlab.core import gainmap
from hdrlab.course.checks.compare import points, same


def agree(subject, rng, channels=(), **knobs):
    """Compare the light of a picture, of which a third is black, and gains of one range or one a channel."""
    low, high = rng.uniform(-2, -1, channels), rng.uniform(2, 3, channels)
    sdr, g = np.maximum(rng.uniform(-0.5, 1, (2, 12, 16, 3)), 0)
    came, expected = (
        f(sdr, g, low, high, **knobs) for f in (subject.apply_gain, gainmap.apply_gain)
    )
    same(came, expected, 1e-3, what="light", picture=True)


@points(5)
def test_the_brightest_screen_shows_the_picture_times_its_gain(subject, rng):
    """A map of 0 is the gain low, a map of 1 the gain high. By what is the picture multiplied?

    Gains are stops: each doubles the light.

    sdr 2^G with G = low + (high - low) g, where W and gamma are 1 and both offsets 0.
    """
    agree(subject, rng, k=(0.0, 0.0))


@points(3)
def test_a_screen_between_takes_a_part_of_the_stops(subject, rng):
    """A screen with half of the stops, W = 1/2: where the picture is white and the gain 4, what does it show?

    Twice white: half of two stops is one. The part is taken of G, not of the light.

    sdr 2^(W G), where gamma is 1 and both offsets 0.
    """
    agree(subject, rng, W=rng.uniform(0.3, 0.7), k=(0.0, 0.0))


def test_a_screen_no_brighter_than_white_shows_the_picture(subject, rng):
    """W is 0 there. By what is the picture multiplied?

    By 2^0, wherever the gains begin.

    G is low at the least, and W is a part of all of G.
    """
    agree(subject, rng, W=0.0)


@points(3)
def test_the_offsets_of_the_map_are_taken_off_again(subject, rng):
    """The gain was that of the picture and the scene with an offset each. Which of them comes off at the end?

    Add the picture's, k[0], multiply, and take off the scene's, k[1].

    (sdr + k_sdr) 2^(W G) - k_hdr.
    """
    for k in ((1 / 64, 1 / 64), (1 / 512, 1 / 16)):
        agree(subject, rng, k=k)


@points(3)
def test_gamma_is_undone_before_the_range_of_each_channel_is_applied(subject, rng):
    """The map was raised to gamma when it was made. What gives the share of the range back?

    The power 1 / gamma, of the map alone.

    low and high may hold a number for each channel, (3,), and gamma as well.
    """
    agree(subject, rng, (3,), gamma=rng.choice([0.5, 2.0], 3), k=(0.0, 0.0))
