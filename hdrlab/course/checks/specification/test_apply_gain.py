"""Checks of apply_gain(sdr, g, low, high, W, gamma, k): the linear light that a screen shows, 1
= white.
"""

import numpy as np

from hdrlab.core import gainmap
from hdrlab.course.checks.compare import points, same


def agree(subject, rng, channels=(), **options):
    """Compare the light of an image, a third of it black, for gains with one range or one per
    channel.
    """
    low = rng.uniform(-2, -1, channels)
    high = rng.uniform(2, 3, channels)
    sdr, g = np.maximum(rng.uniform(-0.5, 1, (2, 12, 16, 3)), 0)
    answer, expected = (
        f(sdr, g, low, high, **options) for f in (subject.apply_gain, gainmap.apply_gain)
    )
    same(answer, expected, 1e-3, what="light", picture=True)


@points(5)
def test_the_brightest_screen_applies_the_full_gain(subject, rng):
    """A map value of 0 is the gain low, and 1 is the gain high. By which factor do you multiply the
    image?

    Gains are in stops: each stop doubles the light.

    With W = 1, gamma = 1 and offsets of 0, return sdr 2^G with G = low + (high - low) g.
    """
    agree(subject, rng, k=(0.0, 0.0))


@points(3)
def test_a_screen_in_between_applies_a_fraction_of_the_stops(subject, rng):
    """A screen with W = 1/2 shows half of the stops. What does it show where the image is white and
    the gain is 4?

    It shows twice white: half of two stops is one stop. W multiplies G, not the light.

    With gamma = 1 and offsets of 0, return sdr 2^(W G).
    """
    agree(subject, rng, W=rng.uniform(0.3, 0.7), k=(0.0, 0.0))


def test_a_screen_without_headroom_shows_the_image_itself(subject, rng):
    """Here W is 0. By which factor do you multiply the image?

    By 2^0 = 1, whatever the value of low.

    W multiplies all of G, including low.
    """
    agree(subject, rng, W=0.0)


@points(3)
def test_the_offset_of_the_scene_is_subtracted_at_the_end(subject, rng):
    """The encoder added an offset to the image and another one to the scene. Which of them do you
    subtract at the end?

    Add the image's offset k[0], multiply, and subtract the scene's offset k[1].

    Return (sdr + k_sdr) 2^(W G) - k_hdr.
    """
    for k in ((1 / 64, 1 / 64), (1 / 512, 1 / 16)):
        agree(subject, rng, k=k)


@points(3)
def test_gamma_is_undone_before_the_range_of_each_channel_is_applied(subject, rng):
    """The encoder raised the map to the power gamma. How do you undo this?

    Raise the map g, and nothing else, to the power 1 / gamma. Then apply low and high.

    low, high and gamma can be numbers or arrays (3,), one value per channel.
    """
    agree(subject, rng, (3,), gamma=rng.choice([0.5, 2.0], 3), k=(0.0, 0.0))
