"""Plots of blends of lights, and of least squares in the plane."""

import numpy as np
import pytest

from hdrlab.calibration.blends import Blend, InverseResponse
from hdrlab.show import pictures
from hdrlab.show.plots.lectures import geometry, mixtures

ALPHA = np.linspace(0, 1, 6)
TWO = [Blend(ALPHA, ALPHA**0.5), Blend(ALPHA, (0.2 * ALPHA) ** 0.5)]
M = np.linspace(0, 1, 1024)
ROOT = InverseResponse(M, M**2, np.array([1.0, 0.2]), np.zeros(2))


def points_of(line):
    return np.stack(line.get_data())


# Mixtures of lights


def test_samples_of_blends_are_at_their_exposure_and_pixel_value():
    ax = mixtures.samples(TWO, [1, 0.2], [0, 0.1], names=("bright", "dim"))
    bright, dim = ax.lines
    assert np.allclose(points_of(bright), [ALPHA, 255 * ALPHA**0.5])
    assert np.allclose(points_of(dim), [0.2 * ALPHA + 0.1, 255 * (0.2 * ALPHA) ** 0.5])
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["bright", "dim"]


def test_samples_with_joined_scales_lie_on_the_joined_curve():
    ax = mixtures.samples(TWO, ROOT.s, ROOT.r, joined=ROOT)
    curve = points_of(ax.lines[0])
    for dots in ax.lines[1:]:
        X, level = points_of(dots)
        assert np.allclose(np.interp(X, *curve), level, atol=3)  # a root is steep at 0


def test_few_blends_have_different_styles_and_many_have_the_same():
    few = mixtures.samples(TWO)
    many = mixtures.samples(TWO * 4)
    assert len({(line.get_color(), line.get_marker()) for line in few.lines}) == 2
    assert len({(line.get_color(), line.get_marker()) for line in many.lines}) == 1
    assert few.get_legend() is None and many.get_legend() is None


def test_samples_has_axis_labels_and_a_logarithmic_scale_on_request():
    ax = mixtures.samples(TWO, scale="log")
    assert ax.get_xscale() == "log"
    assert ax.get_xlabel() and "255 M" in ax.get_ylabel()


def test_deviations_of_the_true_curve_are_zero_and_of_a_wrong_one_in_percent():
    ax = mixtures.deviations({"true": ROOT, "a line": ROOT._replace(X=M)}, lambda M: M**2)
    true = points_of(ax.lines[1])
    line = points_of(ax.lines[2])
    assert np.abs(true[1]).max() < 1e-9
    assert line[1].max() == pytest.approx(25, abs=0.01)  # M - M^2 is 1/4 at its most
    assert "%" in ax.get_ylabel()


def test_deviations_rejects_more_than_five_curves():
    with pytest.raises(ValueError, match="at most 5 curves"):
        mixtures.deviations(dict.fromkeys("abcdef", ROOT), lambda M: M**2)


# Least squares in the plane


def test_circle_draws_the_ellipse_of_its_matrix():
    ax = geometry.circle(np.diag([2.0, 0.5]))
    x, y = points_of(ax.lines[2])  # after the two axes
    assert np.allclose((x / 2) ** 2 + (y / 0.5) ** 2, 1)
    ends = [points_of(line)[:, 1] for line in ax.lines[3:]]
    assert np.allclose(ends, [[2, 0], [0, 0.5]])


def test_axes_of_the_plane_have_equal_scales():
    ax = geometry.circle(np.eye(2))
    ax.figure.canvas.draw()
    box = ax.get_window_extent()
    assert box.width == pytest.approx(box.height, rel=0.01) and ax.get_xlim() == ax.get_ylim()


@pytest.mark.parametrize("A", [np.eye(3), np.zeros(2), np.full((2, 2), np.nan)])
def test_circle_rejects_anything_but_a_finite_2_by_2_matrix(A):
    with pytest.raises(ValueError, match=r"finite matrix \(2, 2\)"):
        geometry.circle(A)


def test_each_equation_is_drawn_as_the_line_of_its_solutions():
    A = np.array([[1.0, 2.0], [3.0, -1.0], [0.0, 0.0]])
    b = np.array([2.0, 1.0, 0.0])
    drawn = [points_of(line) for line in geometry.equations(A, b).lines[2:]]
    assert len(drawn) == 2  # 0 = 0 holds everywhere, and is no line
    for row, right, ends in zip(A, b, drawn, strict=False):
        assert np.allclose(row @ ends, right) and np.ptp(ends, axis=1).max() > 1


def test_residual_is_constant_on_a_ring():
    A = np.array([[2.0, 0.0], [0.0, 0.5]])
    b = np.zeros(2)
    (rings,) = geometry.equations(A, b).collections
    for level, path in zip(rings.levels, rings.get_paths(), strict=True):
        if len(path.vertices) > 2:
            assert np.allclose(np.linalg.norm(path.vertices @ A.T, axis=1), level, rtol=0.1)


def test_single_points_have_larger_markers_than_clouds_of_points():
    cloud = np.random.default_rng(0).standard_normal((2, 50))
    ax = geometry.equations(np.eye(2), np.ones(2), {"answers": cloud, "truth": [1, 1]})
    many, single = ax.lines[-2:]
    assert np.allclose(points_of(many), cloud) and np.allclose(points_of(single), 1)
    assert single.get_markersize() > many.get_markersize()


@pytest.mark.parametrize(("A", "b"), [(np.ones((3, 3)), np.ones(3)), (np.ones((3, 2)), np.ones(2))])
def test_equations_rejects_systems_with_other_than_two_unknowns(A, b):
    with pytest.raises(ValueError, match=r"A \(m, 2\) and b \(m,\)"):
        geometry.equations(A, b)


def test_spectrum_shows_decades_below_the_largest_singular_value_with_a_floor():
    ax = geometry.spectrum({"one": [200.0, 2.0, 0.0], "two": [1.0, 0.1]}, least=1e-17)
    first = points_of(ax.lines[0])
    second = points_of(ax.lines[1])
    assert np.allclose(first, [[1, 2, 3], [0, -2, -17]]) and np.allclose(second[1], [0, -1])
    assert ax.get_ylim()[0] < -17


def test_spectrum_rejects_an_empty_mapping():
    with pytest.raises(ValueError, match="1 to 5 systems"):
        geometry.spectrum({})


@pytest.mark.parametrize(
    "draw", [lambda: mixtures.samples(TWO, joined=ROOT), lambda: geometry.circle(np.eye(2))]
)
def test_plots_of_blends_and_planes_can_be_rendered(draw):
    assert pictures.render(draw()).std() > 0
