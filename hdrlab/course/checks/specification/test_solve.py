"""Checks of solve(divG): the image u whose Laplacian is div G. A constant in u is free."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def laplacian(u):
    """Return the sum of the differences between each pixel's neighbors inside the image and the
    pixel.
    """
    wide = np.pad(u, 1, mode="edge")
    return wide[2:, 1:-1] + wide[:-2, 1:-1] + wide[1:-1, 2:] + wide[1:-1, :-2] - 4 * u


def get_answer(subject, divG):
    """Return u, shifted to the mean 0."""
    u = finite(subject.solve(divG), divG.shape, what="u").astype(float)
    return u - u.mean()


# divergences whose sum is 0, as that of every gradient field is
SMALL_INPUTS = [
    (np.array([[1.0, -1.0], [0.0, 0.0]]),),
    (np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]),),
]


def test_zero_divergence_gives_a_constant_image(subject):
    """Which image has no gradient at all?

    If div G is 0 everywhere, u is a constant.

    The first coefficient is 0 / 0: set it to 0.
    """
    same(get_answer(subject, np.zeros((9, 12))), np.zeros((9, 12)), 1e-9, what="u minus its mean")


@points(5)
def test_the_laplacian_of_u_is_the_divergence(subject, rng):
    """Compute the Laplacian of your u: is it div G?

    The eigenvectors are cosines (DCT-II), with eigenvalues 2 cos(pi i / n) - 2. Add the eigenvalues
    of the two axes.

    Divide the coefficients by the eigenvalues, except for the first one, which is 0 / 0: set it to
    0.
    """
    u = rng.standard_normal((20, 31))
    u -= u.mean()
    same(get_answer(subject, laplacian(u)), u, 5e-3, what="u", picture=True)


@points(3)
def test_a_ramp_does_not_wrap_around(subject, rng):
    """Look at the borders: does the left border continue at the right one?

    A Fourier transform makes the image periodic. Here nothing may flow through the borders.

    Use dctn(type=2) and idctn(type=2).
    """
    u = np.broadcast_to(np.linspace(0, float(rng.uniform(2, 5)), 33), (18, 33)).copy()
    same(get_answer(subject, laplacian(u)), u - u.mean(), 5e-3, what="u of a ramp", picture=True)


@points(2)
def test_images_of_any_shape_are_solved(subject, rng):
    """Do you mix up height and width?

    Rows and columns have different eigenvalues.

    Use np.add.outer of the two, with the rows (the height) first.
    """
    for shape in ((9, 40), (40, 9)):
        u = rng.standard_normal(shape)
        u -= u.mean()
        same(
            get_answer(subject, laplacian(u)),
            u,
            5e-3,
            what=f"u of {shape[0]} x {shape[1]} pixels",
            picture=True,
        )
