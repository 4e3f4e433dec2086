"""The gain map of ISO 21496-1: gain_map(sdr, hdr, low, high, gamma, k) -> g, 0 to 1."""

from hdrlab.core import gainmap
from hdrlab.course.checks.compare import points, same


def agree(subject, rng, stops, low, high, *, black=0.0, **knobs):
    """Compare the maps of a picture and a scene that is so many stops brighter; of each a part is black."""
    sdr = rng.uniform(0.1, 0.9, (12, 16, 3))
    hdr = sdr * 2 ** rng.uniform(*stops, sdr.shape)
    sdr, hdr = (one * (rng.random(one.shape) >= black) for one in (sdr, hdr))
    came, expected = (f(sdr, hdr, low, high, **knobs) for f in (subject.gain_map, gainmap.gain_map))
    same(came, expected, 1e-3, what="g", picture=True)


@points(6)
def test_the_map_says_in_shares_of_its_range_how_many_stops_are_gained(subject, rng):
    """Where the scene is twice as bright as the picture, the gain is one stop. Where is it in the range?

    At low the map is 0, at high it is 1, and in the middle between them 1/2.

    g = (log2(hdr / sdr) - low) / (high - low), where both offsets are 0.
    """
    agree(subject, rng, (-1, 3), rng.uniform(-3, -1.5), rng.uniform(3.5, 5), k=(0.0, 0.0))


@points(3)
def test_black_has_a_gain_that_is_finite(subject, rng):
    """Where the picture is black the quotient would be infinite, or nothing by nothing. What are offsets for?

    Each is added before the division: k[0] to the picture, k[1] to the scene.

    G = log2((hdr + k_hdr) / (sdr + k_sdr)), with k = (k_sdr, k_hdr).
    """
    for k in ((1 / 64, 1 / 64), (1 / 512, 1 / 32)):
        agree(subject, rng, (-1, 1), -10.0, 10.0, black=0.5, k=k)


@points(3)
def test_what_is_gained_beyond_the_range_takes_its_ends(subject, rng):
    """The map is kept in whole numbers from 0 to 255. What of a gain below low, and above high?

    It is told as low, or as high: nothing is below 0 or above 1.

    Clip the share of the range to 0 ... 1.
    """
    for stops in ((-5, -3), (5, 7)):
        agree(subject, rng, stops, -1.0, 3.0, k=(0.0, 0.0))


@points(3)
def test_gamma_bends_what_lies_between_the_ends_of_each_channel(subject, rng):
    """Each channel may have a range of its own, and gamma bends what is between its ends.

    low and high may hold a number for each channel, (3,). Channels are the last axis.

    g = (share of the range)^gamma.
    """
    low, high, gamma = rng.uniform(-2, -1, 3), rng.uniform(2.5, 4, 3), float(rng.choice([0.5, 2]))
    agree(subject, rng, (-0.5, 2), low, high, gamma=gamma, k=(0.0, 0.0))
