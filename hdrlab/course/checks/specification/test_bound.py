"""Checks of bound(Z, B, g, top, shown), pixels that no frame measures: E (M,) and flags (M,)."""

import numpy as np

from hdrlab.capture import responses
from hdrlab.course.checks.compare import finite, parts, points, same
from hdrlab.radiance.merge import bound

G = responses.true_g("gamma")
TOP = 250


def draw_inputs(rng, P=3, M=40):
    """Return Z (P, M) of levels that measure nothing, and B (P,) from short to long."""
    B = np.cumsum(rng.uniform(0.5, 2, P))
    split = rng.integers(0, P + 1, M)  # from that frame on the pixel is clipped, before it is dark
    return np.where(np.arange(P)[:, None] >= split, rng.integers(TOP, 256, (P, M)), 0), B


def get_answer(subject, Z, B, shown=None):
    """Return ln E and the flags."""
    E, flags = parts(
        subject.bound(Z, B, G, TOP, np.ones(Z.shape, bool) if shown is None else shown), 2
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.log(np.asarray(E, float)), flags


def test_every_pixel_has_a_radiance_and_a_flag(subject, rng):
    """Return two arrays: E, and the flags that say how it is known.

    Z has a column for each of the M pixels.

    E and flags both have the shape (M,).
    """
    Z, B = draw_inputs(rng)
    E, flags = parts(subject.bound(Z, B, G, TOP, np.ones(Z.shape, bool)), 2)
    finite(E, (40,), what="E"), finite(flags, (40,), what="the flags")


@points(5)
def test_a_pixel_clipped_in_all_frames_gets_the_bound_of_the_shortest(subject, rng):
    """If a pixel is clipped in a frame of t seconds, its radiance is at least f^-1(top) / t.

    Of several lower bounds, the largest one is the tightest. It comes from the shortest clipped
    frame.

    ln E = max of g[top] - B over the clipped frames.
    """
    _, B = draw_inputs(rng)
    Z = rng.integers(TOP, 256, (3, 20))
    lE, _ = get_answer(subject, Z, B)
    same(lE, np.full(20, G[TOP] - B[0]), 1e-3, what="ln E of clipped pixels")
    order = rng.permutation(3)
    lE, _ = get_answer(subject, Z[order], B[order])
    same(
        lE, np.full(20, G[TOP] - B[0]), 1e-3, what="ln E of clipped pixels, frames in another order"
    )


@points(4)
def test_a_pixel_dark_in_all_frames_gets_the_bound_of_the_longest(subject, rng):
    """If a pixel is dark in a frame of t seconds, its radiance is at most f^-1(1) / t.

    Of several upper bounds, the smallest one is the tightest. It comes from the longest dark frame.

    ln E = min of g[1] - B over the dark frames.
    """
    _, B = draw_inputs(rng)
    lE, _ = get_answer(subject, np.zeros((3, 20), int), B)
    same(lE, np.full(20, G[1] - B[-1]), 1e-3, what="ln E of dark pixels")


@points(3)
def test_between_two_bounds_ln_E_is_their_mean(subject, rng):
    """If a pixel is dark in one frame and clipped in the next, its radiance lies between two
    bounds.

    Take the middle of the logarithms, because radiance is compared by ratios.

    ln E = (lower + upper) / 2.
    """
    Z, B = draw_inputs(rng)
    for frames in ([0, 1, 2], [2, 0, 1]):
        truth = bound(Z[frames], B[frames], G, TOP, np.ones(Z.shape, bool))[0]
        same(get_answer(subject, Z[frames], B[frames])[0], np.log(truth), 1e-3, what="ln E")


@points(2)
def test_a_frame_that_does_not_show_the_pixel_is_ignored(subject, rng):
    """Do you use frames that do not show the pixel?

    Where `shown` is False, the pixel counts neither as clipped nor as dark.

    clipped = shown & (Z >= top), and dark = shown & (Z == 0).
    """
    Z, B = draw_inputs(rng)
    shown = np.ones(Z.shape, bool)
    shown[0] = False
    truth = bound(Z, B, G, TOP, shown)[0]
    same(get_answer(subject, Z, B, shown)[0], np.log(truth), 1e-3, what="ln E")


def test_the_flags_say_why_a_pixel_has_no_measurement(subject, rng):
    """The second result says how each pixel is known.

    1 means clipped, 2 means dark, 3 means both.

    flags = 1 * clipped + 2 * dark, and 8 where a pixel is neither.
    """
    Z, B = draw_inputs(rng)
    shown = np.ones(Z.shape, bool)
    same(get_answer(subject, Z, B)[1], bound(Z, B, G, TOP, shown)[1], 0, what="the flags")
    shown[0] = False
    what = "the flags of pixels that the first photo does not show"
    same(get_answer(subject, Z, B, shown)[1], bound(Z, B, G, TOP, shown)[1], 0, what=what)


@points(2)
def test_a_pixel_without_any_bound_is_0_and_has_the_flag_8(subject, rng):
    """All values of such a pixel are between 0 and `top`. Which bounds does it have?

    None: only 0 is dark, and only `top` and above are clipped.

    E = 0, and the flag is 8.
    """
    Z, B = draw_inputs(rng)
    Z[:, ::2] = rng.integers(2, TOP - 1, Z[:, ::2].shape)
    Z[0, ::4] = 1
    Z[1, ::4] = TOP - 1
    E, flags = parts(subject.bound(Z, B, G, TOP, np.ones(Z.shape, bool)), 2)
    same(np.asarray(E)[::2], np.zeros(20), 0, what="E of pixels without bounds")
    same(np.asarray(flags)[::2], np.full(20, 8), 0, what="the flags of pixels without bounds")
