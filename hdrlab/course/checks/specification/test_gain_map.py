"""Checks of gain_map(sdr, hdr, low, high, gamma, k), the gain map of ISO 21496-1: g from 0 to 1."""

from hdrlab.core import gainmap
from hdrlab.course.checks.compare import points, same


def agree(subject, rng, stops, low, high, *, black=0.0, **options):
    """Compare the gain maps of an image and a scene that is brighter by a random number of
    stops; a fraction of both is black.
    """
    sdr = rng.uniform(0.1, 0.9, (12, 16, 3))
    hdr = sdr * 2 ** rng.uniform(*stops, sdr.shape)
    sdr, hdr = (image * (rng.random(image.shape) >= black) for image in (sdr, hdr))
    answer, expected = (
        f(sdr, hdr, low, high, **options) for f in (subject.gain_map, gainmap.gain_map)
    )
    same(answer, expected, 1e-3, what="g", picture=True)


@points(6)
def test_the_map_is_the_gain_in_stops_scaled_to_its_range(subject, rng):
    """Where the scene is twice as bright as the image, the gain is one stop. Where is one stop
    between low and high?

    The map is 0 at low, 1 at high and 1/2 in the middle.

    With offsets of 0, g = (log2(hdr / sdr) - low) / (high - low).
    """
    agree(subject, rng, (-1, 3), rng.uniform(-3, -1.5), rng.uniform(3.5, 5), k=(0.0, 0.0))


@points(3)
def test_black_pixels_have_a_finite_gain(subject, rng):
    """Where the image is black, hdr / sdr is infinite or 0 / 0. The offsets prevent this.

    Add the offsets before you divide: k[0] to the image and k[1] to the scene.

    G = log2((hdr + k_hdr) / (sdr + k_sdr)), with k = (k_sdr, k_hdr).
    """
    for k in ((1 / 64, 1 / 64), (1 / 512, 1 / 32)):
        agree(subject, rng, (-1, 1), -10.0, 10.0, black=0.5, k=k)


@points(3)
def test_gains_outside_the_range_are_clipped(subject, rng):
    """The map is stored as whole numbers from 0 to 255. What happens to a gain below low or above
    high?

    Store it as low or as high: no value is below 0 or above 1.

    Clip g to 0 ... 1 before you apply gamma.
    """
    for stops, gamma in (((-5, -3), 2.0), ((5, 7), 1.0)):
        agree(subject, rng, stops, -1.0, 3.0, gamma=gamma, k=(0.0, 0.0))


@points(3)
def test_each_channel_has_its_own_range_and_gamma(subject, rng):
    """Each channel can have its own low and high. Gamma changes the values between 0 and 1.

    low and high can be arrays (3,), one value per channel. Channels are the last axis.

    g = ((G - low) / (high - low))^gamma.
    """
    low = rng.uniform(-2, -1, 3)
    high = rng.uniform(2.5, 4, 3)
    gamma = float(rng.choice([0.5, 2]))
    agree(subject, rng, (-0.5, 2), low, high, gamma=gamma, k=(0.0, 0.0))
