"""Checks of equalise(L, bins, limit), a window of the Detail Brush: display luminance Ld (H, W)."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same
from hdrlab.tonemap import brush

SHAPE = (60, 80)
# of display luminance: how a pixel at the edge of a bin counts makes less than half of that
TOLERANCE = 0.025


def draw_inputs(rng):
    """Return a window (H, W) of two surfaces with texture, a factor of about a hundred apart."""
    y, x = np.indices(SHAPE)
    ln_L = rng.normal(0, 0.5, SHAPE) + 3 * rng.uniform(0.8, 1.2) * (x > rng.integers(25, 50))
    ln_L += 0.01 * y + rng.uniform(-3, 3)
    # several pixels share the lowest and the highest value
    L = np.exp(np.clip(ln_L, *np.quantile(ln_L, [0.002, 0.998])))
    return L.astype(np.float32)


def displayed(Ld):
    """Return the luminance that the display of the sheet shows, from that of an sRGB display."""
    return Ld


def same_window(subject, L, what="Ld", **options):
    Ld = displayed(brush.equalise(L, **options))
    same(subject.equalise(L, **options), Ld, TOLERANCE, what=what, picture=True)


# in an image of a few pixels the result depends on where the edges of the bins are
check_one_input = None


@points(6)
def test_all_codes_are_equally_frequent(subject, rng):
    """Which curve uses all codes of the display equally often?

    The cumulative distribution of ln L: the code of a pixel is the fraction of the pixels that are
    darker.

    Add up the histogram of ln L to P, interpolate P at each pixel, and decode it as sRGB.
    """
    same_window(subject, draw_inputs(rng), bins=256, limit=100.0)


@points(5)
def test_no_bin_gets_more_codes_than_the_limit(subject, rng):
    """On a wall with hardly any texture, what does full equalization show?

    Noise: one narrow peak of the histogram gets most of the codes.

    Clip the histogram at limit / bins before you add it up, as in the task before.
    """
    L = draw_inputs(rng)
    L[:, :30] = np.exp(rng.normal(1, 0.15, (SHAPE[0], 30)))
    for limit in (2.5, float(rng.uniform(3, 4))):
        same_window(subject, L, bins=256, limit=limit, what=f"Ld for a limit of {limit:.3g}")


@points(3)
def test_a_hot_and_a_dead_pixel_change_nothing(subject, rng):
    """One pixel is a million times brighter than all others. What happens to the bins?

    If they reach up to it, all other pixels share a few of them.

    Let the bins reach from the second smallest to the second largest luminance.
    """
    L = draw_inputs(rng)
    L[7, 11] = 1e6 * L.max()
    L[20, 40] = 1e-6 * L.min()
    same_window(subject, L, bins=256, limit=1.2)


@points(2)
def test_a_flat_window_is_not_stretched_to_black_and_white(subject, rng):
    """All pixels differ by a few percent. Should they reach from black to white?

    No: the bins span a factor of 2 at least.

    If high < 2 low, divide low by sqrt(2 low / high), and multiply high by it.
    """
    L = rng.uniform(0.5, 20) * np.exp(rng.uniform(-0.05, 0.05, SHAPE))
    same_window(subject, L.astype(np.float32), bins=100, limit=3.0, what="Ld of a flat window")


@points(2, needs="test_all_codes_are_equally_frequent")
def test_the_unit_of_the_luminance_cancels(subject, rng):
    """The same window in cd/m^2 and in a unit a thousand times larger. How do the results differ?

    Not at all.

    A factor shifts ln L, and the bins with it.
    """
    L = draw_inputs(rng)
    before = finite(subject.equalise(L, bins=256, limit=4.0), SHAPE, what="Ld").astype(float)
    answer = subject.equalise(L * np.float32(1000), bins=256, limit=4.0)
    same(answer, before, TOLERANCE, what="Ld in another unit", picture=True)
