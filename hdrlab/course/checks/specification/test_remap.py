"""The remapping of a local Laplacian filter: remap(lL, g, sigma, alpha, beta) -> r, nats."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def drawn(rng):
    """Return log luminance, a brightness g in its midst, and sigma."""
    g = float(rng.uniform(-4, -2))
    return (g + rng.uniform(-3, 3, (24, 30))).astype(np.float32), g, float(rng.uniform(0.4, 0.75))


@points(4)
def test_sigma_tells_details_from_edges(subject, rng):
    """In a picture there are both. What differs from g by less than sigma is detail, the rest is an edge.

    Draw r over lL: the power up to sigma on either side of g, and from there on a line of slope
    beta.

    r = g +- sigma (d / sigma)^alpha where d <= sigma, and g +- (sigma + beta (d - sigma)) beyond.
    """
    lL, g, sigma = drawn(rng)
    d, alpha, beta = np.abs(lL - g), float(rng.uniform(0.4, 0.8)), float(rng.uniform(0.2, 0.6))
    far = np.where(d <= sigma, sigma * (d / sigma) ** alpha, sigma + beta * (d - sigma))
    came = subject.remap(lL, g, sigma=sigma, alpha=alpha, beta=beta)
    same(came, g + np.sign(lL - g) * far, 1e-3, what="r", picture=True)


@points(2)
def test_details_take_the_power(subject, rng):
    """What differs from g by less than sigma is detail, and stays on its side of g.

    Measure the difference in sigmas, raise it to alpha, and give it its unit back.

    r = g +- sigma (d / sigma)^alpha, d = |lL - g|.
    """
    lL, g, sigma = drawn(rng)
    small = (g + (lL - g) * sigma / 3.01).astype(np.float32)  # the same, all of it within sigma
    for alpha in (0.5, 2.0):
        expected = g + np.sign(small - g) * sigma * (np.abs(small - g) / sigma) ** alpha
        came = subject.remap(small, g, sigma=sigma, alpha=alpha, beta=0.0)
        same(came, expected, 1e-3, what=f"r of details, alpha = {alpha:g}", picture=True)


@points(3)
def test_of_an_edge_beta_is_left(subject, rng):
    """What differs by more than sigma is an edge. Where the two meet, r makes no jump.

    Its first sigma is kept whole; of what is beyond, beta is left.

    r = g +- (sigma + beta (d - sigma)); alpha does not matter here.
    """
    lL, g, sigma = drawn(rng)
    edges = (lL + np.sign(lL - g) * 1.01 * sigma).astype(
        np.float32
    )  # the same, all of it beyond sigma
    for beta in (0.0, 0.4):
        beyond = np.abs(edges - g) - sigma
        expected = g + np.sign(edges - g) * (sigma + beta * beyond)
        came = subject.remap(edges, g, sigma=sigma, alpha=1.0, beta=beta)
        same(came, expected, 1e-3, what=f"r of edges, beta = {beta:g}", picture=True)


def test_twice_the_light_moves_r_and_changes_nothing_else(subject, rng):
    """Twice the light adds ln 2 to lL and to g. What does it add to r?

    Only the difference of lL and g decides what is detail.

    Add g back at the end, and nowhere else.
    """
    lL, g, sigma = drawn(rng)
    knobs = {"sigma": sigma, "alpha": 0.6, "beta": 0.3}
    before = finite(subject.remap(lL, g, **knobs), lL.shape, what="r")
    came = subject.remap(lL + np.float32(np.log(2)), g + np.log(2), **knobs)
    same(came, before + np.log(2), 1e-3, what="r of twice the light", picture=True)
