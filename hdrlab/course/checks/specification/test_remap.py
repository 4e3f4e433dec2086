"""Checks of remap(lL, g, sigma, alpha, beta), the remapping of a local Laplacian filter: r in
nats.
"""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def differences(rng, low, high):
    """Return differences from g (24, 30), from low to high above it or below it."""
    return rng.choice([-1.0, 1.0], (24, 30)) * rng.uniform(low, high, (24, 30))


def draw_inputs(rng):
    """Return log luminance that differs from g by more than noise, the value g, and sigma."""
    g = float(rng.uniform(-4, -2))
    lL = g + differences(rng, 0.03, 3)
    return lL.astype(np.float32), g, float(rng.uniform(0.4, 0.75))


@points(4)
def test_sigma_separates_details_from_edges(subject, rng):
    """A difference from g below sigma is detail, and a larger one is an edge. Do you treat them
    differently?

    Plot r over lL: a power curve up to sigma on both sides of g, and a line with slope beta beyond.

    With d = |lL - g|: r = g +- sigma (d / sigma)^alpha where d <= sigma, and r = g +- (sigma + beta
    (d - sigma)) beyond.
    """
    lL, g, sigma = draw_inputs(rng)
    d = np.abs(lL - g)
    alpha = float(rng.uniform(0.4, 0.8))
    beta = float(rng.uniform(0.2, 0.6))
    far = np.where(d <= sigma, sigma * (d / sigma) ** alpha, sigma + beta * (d - sigma))
    answer = subject.remap(lL, g, sigma=sigma, alpha=alpha, beta=beta)
    same(answer, g + np.sign(lL - g) * far, 1e-3, what="r", picture=True)


@points(2)
def test_details_are_raised_to_the_power_alpha(subject, rng):
    """A difference from g below sigma is detail. Each pixel must stay on its side of g.

    Divide the difference by sigma, raise it to alpha, and multiply it by sigma again.

    r = g +- sigma (d / sigma)^alpha, with d = |lL - g|.
    """
    _, g, sigma = draw_inputs(rng)
    small = (g + differences(rng, 0.03, 0.99 * sigma)).astype(np.float32)
    for alpha in (0.5, 2.0):
        expected = g + np.sign(small - g) * sigma * (np.abs(small - g) / sigma) ** alpha
        answer = subject.remap(small, g, sigma=sigma, alpha=alpha, beta=0.0)
        same(answer, expected, 1e-3, what=f"r of details, alpha = {alpha:g}", picture=True)


@points(3)
def test_edges_are_scaled_by_beta(subject, rng):
    """A difference from g above sigma is an edge. At d = sigma, r must not jump.

    Keep the first sigma of the difference, and multiply the rest by beta.

    r = g +- (sigma + beta (d - sigma)). alpha has no effect here.
    """
    lL, g, sigma = draw_inputs(rng)
    # shifted so that all differences are above sigma
    edges = (lL + np.sign(lL - g) * 1.01 * sigma).astype(np.float32)
    for beta in (0.0, 0.4):
        beyond = np.abs(edges - g) - sigma
        expected = g + np.sign(edges - g) * (sigma + beta * beyond)
        answer = subject.remap(edges, g, sigma=sigma, alpha=1.0, beta=beta)
        same(answer, expected, 1e-3, what=f"r of edges, beta = {beta:g}", picture=True)


@points(2)
def test_noise_is_not_amplified(subject, rng):
    """A power below 1 has an infinite slope at g, so it amplifies noise most of all. What do you do
    about it?

    For alpha < 1, blend the power with d / sigma itself. The weight tau depends on d in nats: 0 up
    to 0.01, 1 from 0.02 on. For alpha of 1 or more, do not blend.

    For alpha < 1: r = g +- sigma (tau (d / sigma)^alpha + (1 - tau) d / sigma), with tau = y^2
    (2 - y)^2 and y = d / 0.01 - 1, between 0 and 1.
    """
    _, g, sigma = draw_inputs(rng)
    lL = (g + differences(rng, 0.0, 0.025)).astype(np.float32)
    d = np.abs(lL - g)
    y = np.clip(d / 0.01 - 1, 0, 1)
    for alpha in (0.5, 2.0):
        power = (d / sigma) ** alpha
        tau = y**2 * (2 - y) ** 2 if alpha < 1 else 1.0
        expected = g + np.sign(lL - g) * sigma * (tau * power + (1 - tau) * d / sigma)
        answer = subject.remap(lL, g, sigma=sigma, alpha=alpha, beta=0.0)
        same(answer, expected, 1e-3, what=f"r of noise, alpha = {alpha:g}", picture=True)


def test_twice_the_light_only_shifts_r(subject, rng):
    """Twice the light adds ln 2 to lL and to g. What should it add to r?

    Also ln 2: only the difference between lL and g decides what is detail.

    Compute with lL - g, and add g once, at the end.
    """
    lL, g, sigma = draw_inputs(rng)
    options = {"sigma": sigma, "alpha": 0.6, "beta": 0.3}
    before = finite(subject.remap(lL, g, **options), lL.shape, what="r")
    answer = subject.remap(lL + np.float32(np.log(2)), g + np.log(2), **options)
    same(answer, before + np.log(2), 1e-3, what="r of twice the light", picture=True)
