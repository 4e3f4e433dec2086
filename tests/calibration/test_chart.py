"""A color chart with 24 patches: found from its corners, measured, and turned into a response curve."""

import numpy as np
import pytest
from skimage.transform import ProjectiveTransform, warp

from hdrlab.calibration import chart
from hdrlab.calibration.blends import InverseResponse, ln_exposure, rmse
from hdrlab.capture import camera, responses
from hdrlab.errors import InputError

SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
TIMES = 2.0 ** np.arange(-6, 1.5, 0.5)


def drawn(values, *, patch=40, gap=chart.GAP, margin=20):
    """Return an image of patches with these values (rows, columns) on black, and the corners."""
    pitch = round(patch * (1 + gap))
    rows, columns = values.shape
    wide = columns * pitch - (pitch - patch)
    high = rows * pitch - (pitch - patch)
    picture = np.zeros((high + 2 * margin, wide + 2 * margin))
    for (i, j), value in np.ndenumerate(values):
        y = margin + i * pitch
        x = margin + j * pitch
        picture[y : y + patch, x : x + patch] = value
    return picture, margin - 0.5 + SQUARE * [wide, high]


def test_the_homography_maps_the_corners_and_agrees_with_scikit_image():
    rng = np.random.default_rng(0)
    for _ in range(20):
        source = 10 * SQUARE + rng.uniform(-2, 2, (4, 2))
        target = 10 * SQUARE + rng.uniform(-2, 2, (4, 2))
        H = chart.homography(source, target)
        oracle = ProjectiveTransform(H)
        assert np.allclose(oracle(source), target, atol=1e-9)
        assert np.allclose(np.linalg.inv(H) @ H, np.eye(3), atol=1e-9)


def test_a_flat_chart_is_read_exactly():
    picture, corners = drawn(np.arange(24).reshape(4, 6) * 10)
    assert np.allclose(
        chart.read_chart(picture.astype(np.uint8), corners) * 255, np.arange(24).reshape(4, 6) * 10
    )


@pytest.mark.parametrize("turns", [0, 1, 2, 3])
def test_a_rotated_chart_is_read_alike_with_rotated_corners(turns):
    picture, corners = drawn(np.arange(24).reshape(4, 6) * 10)
    turned = np.rot90(picture, turns)
    for _ in range(turns):  # (x, y) -> (y, W - 1 - x)
        corners = np.column_stack([corners[:, 1], picture.shape[1] - 1 - corners[:, 0]])
        picture = np.rot90(picture)
    assert np.allclose(
        chart.read_chart(turned.astype(np.uint8), corners) * 255, np.arange(24).reshape(4, 6) * 10
    )


def test_a_chart_in_perspective_is_read_to_a_tenth_of_a_level():
    values = np.random.default_rng(1).integers(20, 240, (4, 6))
    picture, corners = drawn(values)
    seen = np.array([[40, 60], [260, 30], [250, 210], [60, 190.0]])
    H = chart.homography(seen, corners)
    image = warp(picture / 255, ProjectiveTransform(H), output_shape=(240, 300), order=1)
    M = chart.read_chart(np.round(image * 255).astype(np.uint8), seen)
    assert np.abs(M * 255 - values).max() < 0.1


def test_channels_and_16_bits_are_read_like_gray():
    picture, corners = drawn(np.arange(24).reshape(4, 6) * 10)
    gray = chart.read_chart(picture.astype(np.uint8), corners)
    colour = chart.read_chart(
        np.repeat((picture * 257).astype(np.uint16)[..., None], 3, axis=-1), corners
    )
    assert colour.shape == (4, 6, 3) and np.allclose(colour, gray[..., None])


def test_the_gray_reflectances_agree_with_munsell_values_and_densities():
    """Closed forms: the polynomial of Newhall, Nickerson and Judd, 1943, and R = 10^-D by the label."""
    V = np.array([9.5, 8, 6.5, 5, 3.5, 2])
    D = np.array([0.05, 0.23, 0.44, 0.70, 1.05, 1.5])
    Y = 1.2219 * V - 0.23111 * V**2 + 0.23951 * V**3 - 0.021009 * V**4 + 0.0008404 * V**5
    assert np.allclose(100 * chart.NEUTRAL, Y, atol=0.01)
    assert np.allclose(chart.NEUTRAL, 10**-D, rtol=0.02)


@pytest.mark.papers
def test_the_reflectances_are_those_of_the_specification_and_near_to_those_of_measured_charts():
    listed = pytest.importorskip("colour.characterisation").CCS_COLOURCHECKERS
    Y = {name: [100 * color[2] for color in listed[name].data.values()] for name in listed}
    assert np.allclose(chart.LUMINANCE.ravel(), Y["ColorChecker 1976"], atol=1e-9)
    assert np.allclose(chart.LUMINANCE[3], Y["BabelColor Average"][18:], rtol=0.035)


@pytest.mark.parametrize("name", sorted(responses.RESPONSES))
def test_one_photograph_of_the_grays_gives_the_response(name):
    response = responses.as_response(name)
    M = response.f(chart.NEUTRAL)
    recovered = chart.recover_gray(M)
    g = ln_exposure(recovered, black=recovered.r[0])
    at = np.round(recovered.M[[0, -1]] * 255).astype(int)
    low = max(at[0], 15)
    high = at[1]
    error = np.exp(g[low:high]) / np.exp(g[high]) - np.exp(
        responses.true_g(name)[low:high] - responses.true_g(name)[high]
    )
    assert np.sqrt(np.mean(error**2)) < 0.02


@pytest.mark.parametrize("name", sorted(responses.RESPONSES))
def test_many_exposures_give_the_response_without_any_reflectance(name):
    values = chart.LUMINANCE / 100
    picture, corners = drawn(values)
    taken = camera.shoot(
        picture, TIMES, camera.Camera(response=name, full_well=50_000, read_noise=5), rng=3
    )
    M = chart.read_bracket(taken.images, corners)
    recovered = chart.recover_bracket(M, taken.times)
    inverse = responses.as_response(name).inverse
    assert (
        rmse(recovered, InverseResponse(recovered.M, inverse(recovered.M), np.ones(0), np.ones(0)))
        < 0.003
    )
    g = ln_exposure(recovered, black=recovered.r[0])
    true = responses.true_g(name)
    assert np.abs(g[30:230] - true[30:230]).max() < 0.05


def test_the_scales_of_the_patches_are_their_reflectances():
    response = responses.as_response("srgb")
    M = response.f(np.minimum(np.outer(TIMES, chart.NEUTRAL), 1))
    s = chart.recover_bracket(M, TIMES).s
    assert np.allclose(s / s[0], chart.NEUTRAL / chart.NEUTRAL[0], rtol=0.005)


def test_invalid_charts_raise_an_error():
    image = np.zeros((50, 50), np.uint8)
    for call in (
        lambda: chart.read_chart(image, [[0, 0], [1, 1], [2, 2], [3, 3]]),
        lambda: chart.read_chart(image, [[0, 0], [9, 0], [9, 9]]),
        lambda: chart.read_chart(image, [[0, 0], [90, 0], [90, 40], [0, 40]]),
        lambda: chart.read_chart(image, 2 * SQUARE),
        lambda: chart.read_chart(image.astype(float), 40 * SQUARE),
        lambda: chart.read_chart(image, 40 * SQUARE, gap=-1),
        lambda: chart.recover_gray(chart.NEUTRAL[::-1]),
        lambda: chart.recover_gray(np.full(6, 0.5)),
        lambda: chart.recover_gray(np.ones(6)),
        lambda: chart.recover_bracket(np.ones((3, 24)), [1, 2, 3]),
        lambda: chart.recover_bracket(np.ones((3, 24)), [1, 2]),
        lambda: chart.recover_bracket(np.ones(3), [1, 2, 3]),
    ):
        with pytest.raises(InputError):
            call()


def test_patches_touch_each_other_unless_a_gap_is_named():
    image = np.kron([[0, 51, 102], [153, 204, 255]], np.ones((12, 12))).astype(np.uint8)
    corners = np.array([[-0.5, -0.5], [35.5, -0.5], [35.5, 23.5], [-0.5, 23.5]])
    expected = [[0, 0.2, 0.4], [0.6, 0.8, 1]]
    np.testing.assert_allclose(chart.read_patches(image, corners, 2, 3), expected, atol=1e-9)
    np.testing.assert_allclose(chart.read_patches(image, corners, 2, 3, gap=0), expected, atol=1e-9)


def test_the_response_is_extrapolated_with_its_last_slope():
    M = np.linspace(0.1, 0.6, 256)
    g = ln_exposure(InverseResponse(M, 2 * (M - 0.1), np.ones(1), np.zeros(1)), black=-0.2)
    z = np.arange(1, 256)
    np.testing.assert_allclose(np.exp(g[1:]), z / 128, rtol=1e-6)
