"""The guided filter, compared with the sums of its definition; when it preserves edges."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.core.filters import guided
from hdrlab.errors import InputError


@pytest.fixture
def rng():
    return np.random.default_rng(3)


def by_definition(I, p, radius, epsilon):  # noqa: E741
    """Fit a line in each window by least squares, and average the lines of each pixel."""
    H, W = I.shape
    lines = np.zeros((H, W, 2))
    q = np.zeros((H, W))

    def window(y, x):
        return np.s_[max(y - radius, 0) : y + radius + 1, max(x - radius, 0) : x + radius + 1]

    for y in range(H):
        for x in range(W):
            guide = I[window(y, x)].ravel()
            filtered_values = p[window(y, x)].ravel()
            A = np.stack([guide, np.ones_like(guide)], axis=1)
            pull = np.diag([epsilon * guide.size, 0])  # eps a^2, once for each pixel
            lines[y, x] = np.linalg.solve(A.T @ A + pull, A.T @ filtered_values)
    for y in range(H):
        for x in range(W):
            a, b = lines[window(y, x)].reshape(-1, 2).mean(axis=0)
            q[y, x] = a * I[y, x] + b
    return q


@pytest.mark.parametrize(("radius", "epsilon"), [(1, 0.3), (2, 0.01), (4, 1e-4), (30, 0.1)])
def test_the_filter_is_the_least_squares_of_each_window_averaged(rng, radius, epsilon):
    I, p = rng.normal(size=(2, 11, 14))  # noqa: E741
    assert np.allclose(
        guided.guided(I, p, radius=radius, epsilon=epsilon), by_definition(I, p, radius, epsilon)
    )


def test_the_image_is_its_own_guide_by_default(rng):
    I = rng.normal(size=(20, 30))  # noqa: E741
    knobs = {"radius": 3, "epsilon": 0.2}
    assert np.array_equal(guided.guided(I, **knobs), guided.guided(I, I, **knobs))


@given(radius=st.integers(1, 40), epsilon=st.floats(1e-6, 1e3), level=st.floats(-5, 5))
def test_a_flat_image_is_not_changed(radius, epsilon, level):
    assert np.allclose(guided.guided(np.full((9, 7), level), radius=radius, epsilon=epsilon), level)


def test_a_level_added_to_the_picture_is_added_to_the_base(rng):
    I = rng.normal(size=(20, 30))  # noqa: E741
    knobs = {"radius": 3, "epsilon": 0.2}
    assert np.allclose(guided.guided(I + 7, **knobs), guided.guided(I, **knobs) + 7)


def test_epsilon_is_in_squares_of_the_unit(rng):
    I = rng.normal(size=(20, 30))  # noqa: E741
    in_units = guided.guided(I, radius=3, epsilon=0.2)
    in_tenths = guided.guided(10 * I, radius=3, epsilon=0.2 * 10**2)
    assert np.allclose(in_tenths, 10 * in_units)


def test_a_large_epsilon_leaves_two_means_and_a_small_one_the_picture(rng):
    I = rng.normal(size=(20, 30))  # noqa: E741
    twice = guided.window_mean(guided.window_mean(I, 2), 2)
    assert np.allclose(guided.guided(I, radius=2, epsilon=1e9), twice, atol=1e-6)
    assert np.allclose(guided.guided(I, radius=2, epsilon=1e-12), I, atol=1e-6)


def test_a_step_is_kept_and_a_ripple_is_removed_except_beside_the_step():
    x = np.arange(200)
    plains = np.where(x < 100, 0.0, 2.0)
    ripple = 0.1 * np.sin(x / 2)
    left = guided.guided((plains + ripple) * np.ones((40, 1)), radius=8, epsilon=0.04)[20] - plains
    assert np.abs(left[20:80]).max() < 0.02 and np.abs(left).max() < 0.1
    assert np.abs(left[85:115]).max() > 0.05


def test_the_edge_of_another_guide_is_taken_over(rng):
    """A flash photo as guide: the noise disappears, and the guide's edge appears."""
    I = np.where(np.arange(60) < 30, 0.0, 1.0) * np.ones((40, 1))  # noqa: E741
    p = 3 * I + rng.normal(0, 0.3, I.shape)
    q = guided.guided(I, p, radius=5, epsilon=1e-3)
    assert np.abs(q - 3 * I).max() < 0.2 and np.std(q - 3 * I) < 0.06


@pytest.mark.parametrize(
    ("I", "p", "knobs"),
    [
        (np.ones(5), None, {}),
        (np.ones((5, 5, 3)), None, {}),
        (np.full((5, 5), np.nan), None, {}),
        (np.ones((5, 5)), np.ones((5, 6)), {}),
        (np.ones((5, 5)), np.full((5, 5), np.inf), {}),
        (np.ones((5, 5)), None, {"radius": 0}),
        (np.ones((5, 5)), None, {"epsilon": 0}),
        (np.ones((5, 5)), None, {"epsilon": np.inf}),
    ],
)
def test_invalid_images_and_parameters_raise_an_error(I, p, knobs):  # noqa: E741
    with pytest.raises(InputError):
        guided.guided(I, p, **{"radius": 2, "epsilon": 0.1} | knobs)


def test_the_filter_agrees_with_opencv_away_from_the_border():
    cv2 = pytest.importorskip("cv2")
    if not hasattr(cv2, "ximgproc"):
        pytest.skip("this OpenCV has no ximgproc (opencv-contrib-python-headless)")
    rng = np.random.default_rng(3)
    I, p = rng.random((2, 60, 70)).astype(np.float32)  # noqa: E741
    theirs = cv2.ximgproc.guidedFilter(I, p, 5, 0.01)
    assert np.abs(guided.guided(I, p, radius=5, epsilon=0.01) - theirs)[10:-10, 10:-10].max() < 1e-4


def test_small_differences_of_large_numbers_are_filtered_like_those_of_small_ones(rng):
    small = rng.normal(0, 1e-3, (30, 40))
    knobs = {"radius": 3, "epsilon": 1e-8}
    expected = guided.guided(small, **knobs)
    result = guided.guided(1e6 + small, **knobs) - 1e6
    assert np.abs(result - expected).max() < 1e-5  # 0.8e-3 if the squares cancel
