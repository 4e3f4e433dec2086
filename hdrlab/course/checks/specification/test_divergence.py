"""Checks of divergence(G): div G (H, W) of a field G = (Gy, Gx) of forward differences."""

import numpy as np

from hdrlab.core.filters.poisson import divergence
from hdrlab.course.checks.compare import finite, points, same


def field(rng, shape=(12, 17)):
    """Return a field (2, H, W) that is 0 on the differences beyond the last row and column."""
    G = rng.standard_normal((2, *shape))
    G[0, -1] = 0
    G[1, :, -1] = 0
    return G


def gradient(u):
    """Return the forward differences of u, 0 beyond the last row and column."""
    G = np.zeros((2, *u.shape))
    G[0, :-1] = np.diff(u, axis=0)
    G[1, :, :-1] = np.diff(u, axis=1)
    return G


def test_every_pixel_has_a_finite_divergence(subject, rng):
    """The field has two components; the divergence is one number per pixel.

    G has the shape (2, H, W), and the result has (H, W).

    The divergence of a field of zeros is 0.
    """
    finite(subject.divergence(field(rng)), (12, 17), what="div G")
    same(
        subject.divergence(np.zeros((2, 5, 6))),
        np.zeros((5, 6)),
        1e-9,
        what="the divergence of a zero field",
    )


@points(5)
def test_the_divergence_of_a_gradient_is_the_laplacian(subject, rng):
    """The gradient uses forward differences. Which differences must the divergence use?

    Backward differences: Gy(y, x) - Gy(y - 1, x) + Gx(y, x) - Gx(y, x - 1).

    The first row and column have no pixel before them: use only Gy(0, x) and only Gx(y, 0) there.
    """
    u = rng.standard_normal((12, 17))
    wide = np.pad(u, 1, mode="edge")
    laplacian = wide[2:, 1:-1] + wide[:-2, 1:-1] + wide[1:-1, 2:] + wide[1:-1, :-2] - 4 * u
    same(subject.divergence(gradient(u)), laplacian, 1e-4, what="div grad u", picture=True)


@points(4)
def test_it_sums_to_0_and_is_minus_the_transpose_of_the_gradient(subject, rng):
    """Nothing flows through the borders: what leaves one pixel enters its neighbor.

    The divergence of any field sums to 0.

    As a matrix, it is minus the transpose of the gradient.
    """
    G = field(rng)
    u = rng.standard_normal((12, 17))
    divG = same(subject.divergence(G), np.zeros((12, 17)), 100.0, what="div G")
    same(float(divG.sum()), 0.0, 1e-3, what="the sum of div G")
    same(float((divG * u).sum()), -float((G * gradient(u)).sum()), 1e-3, what="the sum of u div G")


@points(2, needs="test_the_divergence_of_a_gradient_is_the_laplacian")
def test_steps_across_the_edges_are_ignored(subject, rng):
    """The last row of Gy leads out of the image. What flows there?

    Nothing, whatever the field contains there.

    Use 0 in place of Gy[-1, :] and of Gx[:, -1].
    """
    inside = field(rng)
    G = inside.copy()
    G[0, -1] = rng.uniform(1, 2, G.shape[2])
    G[1, :, -1] = rng.uniform(1, 2, G.shape[1])
    expected = divergence(inside)
    same(
        subject.divergence(G), expected, 1e-4, what="div G of a field that leads out", picture=True
    )
