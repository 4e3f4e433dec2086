"""Drawings of registration by light."""

import numpy as np
import pytest

from hdrlab.align import cerman
from hdrlab.core.filters import warp
from hdrlab.show import pictures
from hdrlab.show.plots.lectures import homographies as drawn

RNG = np.random.default_rng(0)
WALL = np.kron(RNG.uniform(0.5, 2, (14, 18)), np.ones((8, 8))).astype(np.float32)
X = np.stack([WALL[8:104, 8:136], WALL[5:101, 12:140]])  # which lies on the first moved by (-3, 4)
TRUE_HOMOGRAPHY = warp.as_homographies([[-3, 4]])[0]


def title(drawn):
    return drawn.figure.axes[0].get_title()


def test_error_after_the_true_homography_is_zero():
    assert title(drawn.difference(X, TRUE_HOMOGRAPHY)) == "error e = 0.0000"
    d, e = drawn.differences(X, np.eye(3))
    assert e == pytest.approx(np.mean(d**2)) and f"{e:.4f}" in title(drawn.difference(X, np.eye(3)))


def test_pixels_outside_of_a_photo_are_gray():
    shown = drawn.difference(X, TRUE_HOMOGRAPHY).images[0].get_array()
    assert np.all(shown[-1] == 128) and np.all(shown[:, 0] == 128) and not np.all(shown[40] == 128)


def test_color_shows_which_photo_is_brighter():
    for k, warm in ((0.8, True), (1.25, False)):
        ax = drawn.difference(np.stack([X[0], X[0] * np.float32(k)]), np.eye(3))
        pixel = ax.images[0].get_array()[5, 5]
        assert (pixel[0] > pixel[2]) == warm


def test_maximum_of_the_drawn_correlation_is_at_the_true_shift():
    figure = drawn.correlation(cerman.correlation(X), marks={"true": (-3, 4)})
    image = figure.axes[0].images[0]
    (line,) = figure.axes[0].lines
    y, x = np.unravel_index(np.argmax(image.get_array()), image.get_array().shape)
    assert (
        (y - X.shape[1] + 1, x - X.shape[2] + 1)
        == (-3, 4)
        == (line.get_ydata()[0], line.get_xdata()[0])
    )


def test_level_shows_the_difference_and_the_error_of_every_step():
    state = cerman.State(
        level=2, X=X, path=np.zeros((5, 3)), errors=np.geomspace(0.1, 0.01, 5), H=TRUE_HOMOGRAPHY
    )
    figure = drawn.level(state)
    assert "level 2" in title(figure) and "e = 0.0100" in title(figure)
    assert figure.axes[1].lines[0].get_ydata().tolist() == (1000 * state.errors).tolist()
    assert pictures.render(figure).ndim == 3


def test_difference_and_correlation_reject_arrays_of_another_shape():
    with pytest.raises(ValueError, match="light of two photographs"):
        drawn.difference(X[0], TRUE_HOMOGRAPHY)
    with pytest.raises(ValueError, match="at shifts -n to n"):
        drawn.correlation(np.zeros((4, 5)))
