"""Checks of subtract_glare(F, G, share), a radiance map without its veiling glare: E, of F's shape."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same
from hdrlab.radiance import flare


def draw_inputs(rng, channels=()):
    """Return F, G and the share of a map E that glare was added to."""
    shape = (24, 32, *channels)
    E = np.exp(rng.normal(0, 1, shape))
    G = np.exp(rng.normal(1, 0.5, shape))
    share = float(rng.uniform(0.15, 0.3))
    return ((1 - share) * E + share * G).astype(np.float32), G.astype(np.float32), share


def same_map(subject, F, G, share, *, what="E"):
    E = flare.subtract_glare(F, G, share)
    same(subject.subtract_glare(F, G, share), E, 1e-4 * E.max(), what=what, picture=True)


@points(5)
def test_the_map_is_that_to_which_the_glare_was_added(subject, rng):
    """The lens scattered the share s of the light. Which equation contains E?

    F = (1 - s) E + s G. Solve it for E.

    E = (F - s G) / (1 - s): the share that was scattered is missing in the rest.
    """
    same_map(subject, *draw_inputs(rng))
    same_map(subject, *draw_inputs(rng, (3,)), what="E in color")


@points(3)
def test_no_radiance_is_negative(subject, rng):
    """F is smaller than s G, because of noise. What is E?

    Not negative, since light is not, and not 0 either: its logarithm would be infinite.

    Use at least F / 1000 in place of F - s G, and then divide by 1 - s.
    """
    F, G, share = draw_inputs(rng)
    below = (rng.uniform(0.2, 0.9, F.shape) * share * G).astype(np.float32)
    E = flare.subtract_glare(below, G, share)
    answer = finite(subject.subtract_glare(below, G, share), E.shape, what="E").astype(float)
    same(answer / E, np.ones(E.shape), 1e-2, what="E / the right E, where F is below s G")
    just_above = (share * G * 1.0004).astype(np.float32)
    E = flare.subtract_glare(just_above, G, share)
    answer = finite(subject.subtract_glare(just_above, G, share), E.shape, what="E").astype(float)
    same(answer / E, np.ones(E.shape), 1e-2, what="E / the right E, where F is just above s G")
    half_dark = np.where(rng.random(F.shape) < 0.5, below, F)
    same_map(subject, half_dark, G, share, what="E of a map with dark places")


@points(1, needs="test_the_map_is_that_to_which_the_glare_was_added")
def test_without_glare_the_map_stays(subject, rng):
    """The lens scatters nothing: s is 0. What is E?

    F itself: nothing was added to it.

    If your result differs, there is a term without s.
    """
    F, G, _ = draw_inputs(rng)
    same_map(subject, F, G, 0.0, what="E for a share of 0")
