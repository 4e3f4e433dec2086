"""The picture that has a divergence: solve(divG) -> u, Laplacian u = div G. A constant in u is free."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def laplacian(u):
    """Return the sum over the neighbours inside the picture of their difference to it."""
    wide = np.pad(u, 1, mode="edge")
    return wide[2:, 1:-1] + wide[:-2, 1:-1] + wide[1:-1, 2:] + wide[1:-1, :-2] - 4 * u


def asked(subject, divG):
    """Return u, moved to the mean 0."""
    u = finite(subject.solve(divG), divG.shape, what="u").astype(float)
    return u - u.mean()


def test_an_even_picture_is_what_no_divergence_belongs_to(subject):
    """Which picture has no slopes at all?

    div G = 0 everywhere: u is a constant.

    0 / 0 at the first coefficient: set it to 0.
    """
    same(asked(subject, np.zeros((9, 12))), np.zeros((9, 12)), 1e-9, what="u less its mean")


@points(5)
def test_its_laplacian_is_the_divergence(subject, rng):
    """Take the Laplacian of what you found: is it div G?

    Cosines (DCT-II) are the eigenvectors, with eigenvalues 2 cos(pi i / n) - 2; the two axes add
    up.

    Divide the coefficients by the eigenvalues, all but the first, which is 0 / 0: set it to 0.
    """
    u = rng.standard_normal((20, 31))
    u -= u.mean()
    same(asked(subject, laplacian(u)), u, 5e-3, what="u", picture=True)


@points(3)
def test_a_ramp_of_light_does_not_wrap_around(subject, rng):
    """Look at the borders: does the left one continue at the right one?

    A Fourier transform makes the picture periodic; nothing flows through our edges.

    Use dctn(type=2) and idctn(type=2).
    """
    u = np.broadcast_to(np.linspace(0, float(rng.uniform(2, 5)), 33), (18, 33)).copy()
    same(asked(subject, laplacian(u)), u - u.mean(), 5e-3, what="u of a ramp", picture=True)


@points(2)
def test_tall_and_wide_pictures_are_solved_alike(subject, rng):
    """A picture is as high as it is wide only now and then.

    Rows and columns have eigenvalues of their own.

    np.add.outer of the two, with the height first.
    """
    for shape in ((9, 40), (40, 9)):
        u = rng.standard_normal(shape)
        u -= u.mean()
        same(
            asked(subject, laplacian(u)),
            u,
            5e-3,
            what=f"u of {shape[0]} x {shape[1]} pixels",
            picture=True,
        )
