"""Pixels that no frame measures: bound(Z, B, g, top, shown) -> E (M,) and flags (M,)."""

import numpy as np

from hdrlab.capture import responses
from hdrlab.course.checks.compare import finite, parts, points, same
from hdrlab.radiance.merge import bound

G, TOP = responses.true_g("gamma"), 250


def drawn(rng, P=3, M=40):
    """Return Z (P, M) of levels that measure nothing, and B (P,) from short to long."""
    B = np.cumsum(rng.uniform(0.5, 2, P))
    split = rng.integers(0, P + 1, M)  # from that frame on the pixel is clipped, before it is dark
    return np.where(np.arange(P)[:, None] >= split, rng.integers(TOP, 256, (P, M)), 0), B


def asked(subject, Z, B, shown=None):
    """Return ln E and the flags."""
    E, flags = parts(
        subject.bound(Z, B, G, TOP, np.ones(Z.shape, bool) if shown is None else shown), 2
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.log(np.asarray(E, float)), flags


def test_every_pixel_has_a_radiance_and_a_flag(subject, rng):
    """Two things come back: E, and how it is known.

    Z holds a column for each pixel: M of them.

    E (M,) and flags (M,).
    """
    Z, B = drawn(rng)
    E, flags = parts(subject.bound(Z, B, G, TOP, np.ones(Z.shape, bool)), 2)
    finite(E, (40,), what="E"), finite(flags, (40,), what="the flags")


@points(5)
def test_clipped_in_all_frames_is_the_bound_of_the_shortest(subject, rng):
    """Clipped in a frame of t seconds: the radiance is at least f^-1(top) / t.

    Of several lower bounds the tightest counts, the largest: that of the shortest clipped frame.

    ln E = max over the clipped frames of g[top] - B.
    """
    _, B = drawn(rng)
    Z = rng.integers(TOP, 256, (3, 20))
    lE, _ = asked(subject, Z, B)
    same(lE, np.full(20, G[TOP] - B[0]), 1e-3, what="ln E of clipped pixels")
    order = rng.permutation(3)
    lE, _ = asked(subject, Z[order], B[order])
    same(
        lE, np.full(20, G[TOP] - B[0]), 1e-3, what="ln E of clipped pixels, frames in another order"
    )


@points(4)
def test_dark_in_all_frames_is_the_bound_of_the_longest(subject, rng):
    """Dark in a frame of t seconds: the radiance is at most f^-1(1) / t.

    Of several upper bounds the tightest counts, the least: that of the longest dark frame.

    ln E = min over the dark frames of g[1] - B.
    """
    _, B = drawn(rng)
    lE, _ = asked(subject, np.zeros((3, 20), int), B)
    same(lE, np.full(20, G[1] - B[-1]), 1e-3, what="ln E of dark pixels")


@points(3)
def test_between_two_bounds_is_the_middle_of_their_logarithms(subject, rng):
    """Dark in one frame and clipped in the next: the truth lies between two bounds.

    Between means between the logarithms: radiance is a matter of factors.

    ln E = (lower + upper) / 2.
    """
    Z, B = drawn(rng)
    truth = bound(Z, B, G, TOP, np.ones(Z.shape, bool))[0]
    same(asked(subject, Z, B)[0], np.log(truth), 1e-3, what="ln E")


@points(2)
def test_a_frame_that_does_not_show_the_pixel_says_nothing(subject, rng):
    """A frame that does not show the pixel says nothing of it.

    `shown` is False there: neither clipped nor dark.

    clipped = shown & (Z >= top), dark = shown & (Z == 0).
    """
    Z, B = drawn(rng)
    shown = np.ones(Z.shape, bool)
    shown[0] = False
    truth = bound(Z, B, G, TOP, shown)[0]
    same(asked(subject, Z, B, shown)[0], np.log(truth), 1e-3, what="ln E")


def test_the_flags_say_what_stood_in_the_way(subject, rng):
    """The second answer says how each pixel is known.

    1 is clipped, 2 is dark, and 3 is both.

    1 * clipped + 2 * dark, and 8 where neither.
    """
    Z, B = drawn(rng)
    flags = bound(Z, B, G, TOP, np.ones(Z.shape, bool))[1]
    same(asked(subject, Z, B)[1], flags, 0, what="the flags")
