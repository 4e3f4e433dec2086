"""Gradient, divergence and the Poisson equation: they agree with one another, also at the borders."""

import numpy as np
import pytest
from scipy.sparse import diags_array, eye_array, kron
from scipy.sparse.linalg import spsolve

from hdrlab.core.filters import poisson

SHAPES = [(1, 1), (1, 7), (5, 1), (2, 3), (16, 16), (33, 50), (47, 31)]


def field(shape, seed=0, dtype=np.float64):
    """Return a gradient field that is not the gradient of any image, at the borders, too."""
    return np.random.default_rng(seed).standard_normal((2, *shape)).astype(dtype)


def second_difference(n):
    """Return the matrix of u(i + 1) - 2 u(i) + u(i - 1); both ends have only one neighbor."""
    middle = -2 * np.ones(n)
    middle[[0, -1]] += 1
    return diags_array([np.ones(n - 1), middle, np.ones(n - 1)], offsets=[-1, 0, 1])


def test_the_gradient_is_the_difference_to_the_next_pixel_and_zero_across_an_edge():
    G = poisson.gradient(np.array([[1.0, 2, 4], [10, 20, 40]]))
    assert G.tolist() == [[[9, 18, 36], [0, 0, 0]], [[1, 2, 0], [10, 20, 0]]]


def test_the_divergence_of_one_step_is_a_source_and_a_sink():
    G = np.zeros((2, 3, 4))
    G[0, 1, 2] = 1
    assert poisson.divergence(G).tolist() == [[0, 0, 0, 0], [0, 0, 1, 0], [0, 0, -1, 0]]


@pytest.mark.parametrize("shape", SHAPES)
def test_divergence_is_minus_the_transpose_of_gradient(shape):
    u = np.random.default_rng(1).standard_normal(shape)
    G = field(shape)
    assert np.vdot(poisson.gradient(u), G) == pytest.approx(
        -np.vdot(u, poisson.divergence(G)), abs=1e-9
    )


@pytest.mark.parametrize("shape", SHAPES)
def test_nothing_flows_through_the_edges_so_the_divergence_sums_to_zero(shape):
    assert abs(poisson.divergence(field(shape)).sum()) < 1e-10
    assert abs(poisson.divergence(field(shape, dtype=np.float32)).sum(dtype=np.float64)) < 1e-3


@pytest.mark.parametrize("n", [1, 2, 5, 12])
def test_cosines_about_the_edges_are_the_eigenvectors(n):
    cosines = np.cos(np.pi * np.arange(n)[:, None] * (np.arange(n) + 0.5) / n)
    for u, eigenvalue in zip(cosines, poisson.eigenvalues(n), strict=True):
        assert np.allclose(poisson.laplacian(u[None]), eigenvalue * u, atol=1e-12)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_solve_inverts_the_laplacian_except_for_the_mean(shape, dtype):
    u = np.random.default_rng(2).standard_normal(shape).astype(dtype)
    back = poisson.solve(poisson.laplacian(u))
    assert back.dtype == dtype and np.allclose(back, u - u.mean(), atol=1e-5)


@pytest.mark.parametrize("shape", SHAPES)
def test_the_residual_is_below_1e_5(shape):
    f = poisson.divergence(field(shape, dtype=np.float32))
    assert np.abs(poisson.laplacian(poisson.solve(f).astype(np.float64)) - f).max() < 1e-5


def test_the_residual_is_below_1e_5_in_a_picture_of_half_a_megapixel():
    f = poisson.divergence(field((600, 900), dtype=np.float32))
    u = poisson.solve(f)
    assert np.abs(poisson.laplacian(u.astype(np.float64)) - f).max() < 1e-5 * np.abs(f).max()
    assert abs(u.mean(dtype=np.float64)) < 1e-5


@pytest.mark.parametrize("shape", [(2, 3), (33, 50), (48, 31)])
def test_the_solution_is_that_of_a_sparse_direct_solver(shape):
    """The solution is unique up to a constant.

    The direct solver fixes one pixel, so we compare solutions of mean 0.
    """
    h, w = shape
    A = kron(second_difference(h), eye_array(w)) + kron(eye_array(h), second_difference(w))
    f = poisson.divergence(field(shape))
    held = np.append(spsolve(A.tocsr()[:-1, :-1].tocsc(), f.ravel()[:-1]), 0).reshape(shape)
    assert np.allclose(poisson.solve(f), held - held.mean(), atol=1e-9)
    assert np.abs(poisson.solve(f.astype(np.float32)) - (held - held.mean())).max() < 1e-4


def test_the_solution_has_the_closest_gradients_of_all_images():
    G = field((20, 30))
    rng = np.random.default_rng(3)
    u = poisson.solve(poisson.divergence(G))
    inside = np.ones_like(G)
    inside[0, -1] = 0
    inside[1, :, -1] = 0

    def distance(u):
        return np.sum(inside * (poisson.gradient(u) - G) ** 2)

    for _ in range(20):
        assert distance(u + 0.1 * rng.standard_normal(u.shape)) > distance(u)


def test_a_nonzero_mean_of_the_divergence_is_ignored():
    f = poisson.divergence(field((9, 14)))
    assert np.allclose(poisson.solve(f + 5), poisson.solve(f))


def test_the_mirror_image_has_the_mirrored_solution():
    f = poisson.divergence(field((9, 14)))
    assert np.allclose(poisson.solve(f[::-1, ::-1]), poisson.solve(f)[::-1, ::-1])


def test_invalid_images_raise_an_error():
    for wrong in (np.ones(4), np.ones((2, 3, 4)), np.ones((0, 3))):
        with pytest.raises(ValueError, match="picture"):
            poisson.solve(wrong)
    with pytest.raises(ValueError, match="gradient field"):
        poisson.divergence(np.ones((3, 4)))
