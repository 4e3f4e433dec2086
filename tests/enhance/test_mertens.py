"""hdrlab.enhance.mertens: the measures, the weights, the pyramids; compared with OpenCV."""

import cv2
import numpy as np
import pytest
from hypothesis import given, strategies as st
from PIL import Image

from hdrlab.core.filters import pyramid
from hdrlab.enhance import mertens


def bracket(shape=(97, 131, 3), frames=3, dtype=np.uint8, seed=0):
    """Return photos of colorful noise over soft light, with increasing brightness."""
    rng = np.random.default_rng(seed)
    light = np.linspace(-2, 2, shape[1]).reshape(
        1, -1, *[1] * (len(shape) - 2)
    ) + rng.standard_normal(shape)
    top = np.iinfo(dtype).max
    steps = np.linspace(-1.5, 1.5, frames)
    return np.stack([np.round(top / (1 + np.exp(-light - step))) for step in steps]).astype(dtype)


def opencv(images, powers=(1, 1, 1)):
    """Return OpenCV's fusion of RGB photos."""
    return cv2.createMergeMertens(*powers).process(
        [np.ascontiguousarray(image) for image in images]
    )


def photographs(folder):
    """Return the JPEGs of a folder, sorted by name."""
    return np.stack([np.asarray(Image.open(file)) for file in sorted(folder.glob("*.jpg"))])


def test_contrast_is_the_absolute_laplacian_of_gray():
    F = np.zeros((3, 5, 5), np.float32)
    F[:, 2, 2] = 1
    assert mertens.contrast(F)[1:4, 1:4] == pytest.approx(
        np.array([[0, 1, 0], [1, 4, 1], [0, 1, 0]])
    )
    F = mertens.split_planes(bracket()[0])
    gray = 0.299 * F[0] + 0.587 * F[1] + 0.114 * F[2]
    assert np.allclose(mertens.contrast(F), np.abs(cv2.Laplacian(gray, cv2.CV_32F)), atol=1e-6)


def test_saturation_is_the_standard_deviation_and_exactly_zero_in_gray():
    F = mertens.split_planes(bracket()[0])
    assert np.allclose(mertens.saturation(F), F.std(axis=0), atol=1e-6)
    gray = np.repeat(bracket((40, 50))[0][..., None], 3, axis=-1)
    assert not mertens.saturation(mertens.split_planes(gray)).any()
    assert np.all(mertens.saturation(F[:1]) == 1)


def test_a_middle_gray_is_well_exposed_and_the_ends_are_not():
    F = np.float32([[[0.5, 0.3, 0.0, 1.0]]])
    assert mertens.exposedness(F)[0] == pytest.approx(np.exp([0, -0.5, -3.125, -3.125]))
    assert np.allclose(mertens.exposedness(np.repeat(F, 3, axis=0)), mertens.exposedness(F) ** 3)


def test_the_weight_is_the_product_of_powers():
    F = mertens.split_planes(bracket()[1])
    C = mertens.contrast(F)
    S = mertens.saturation(F)
    E = mertens.exposedness(F)
    assert np.allclose(mertens.weight(F, (0.5, 2, 1)), C**0.5 * S**2 * E, atol=1e-7)
    assert np.allclose(mertens.weight(F, (0, 0, 0)), 1)


@pytest.mark.parametrize("shape", [(64, 80, 3), (33, 47)])
def test_weights_sum_to_one_in_every_pixel(shape):
    images = bracket(shape, frames=5)
    images[:, :9, :9] = 0  # black in all of them
    total = sum(mertens.weights(images))
    assert np.allclose(total, 1, atol=1e-5)
    assert np.allclose(next(mertens.weights(images))[2:7, 2:7], 1 / 5)


@pytest.mark.parametrize("powers", [(1, 1, 1), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0.5, 2, 1)])
@pytest.mark.parametrize("shape", [(97, 131, 3), (64, 64, 3), (40, 201, 3)])
def test_the_fused_image_equals_that_of_opencv(shape, powers):
    images = bracket(shape)
    ours = mertens.fuse(images, contrast=powers[0], saturation=powers[1], exposedness=powers[2])
    assert np.abs(ours - opencv(images, powers)).max() < 1e-3


def test_the_fused_gray_image_equals_that_of_opencv():
    images = bracket((97, 131), frames=4)
    assert np.abs(mertens.fuse(images) - opencv(images)).max() < 0.01


def test_real_photographs_fuse_as_in_opencv(shared):
    images = photographs(shared("window"))[:, ::3, ::3]
    assert np.abs(mertens.fuse(images) - opencv(images)).max() < 1e-3


def contrast_with_opencvs_rounding(F):
    gray = cv2.cvtColor(np.ascontiguousarray(np.moveaxis(F, 0, -1)), cv2.COLOR_RGB2GRAY)
    return np.abs(cv2.Laplacian(gray, cv2.CV_32F))


def saturation_with_opencvs_rounding(F):
    """OpenCV multiplies by a third in float32, which is 1e-8 too much: a gray pixel is not its own mean."""
    mean = (F[0] + F[1] + F[2]) * np.float32(1 / 3)
    return np.sqrt((F[0] - mean) ** 2 + (F[1] - mean) ** 2 + (F[2] - mean) ** 2)


@pytest.mark.papers
def test_differences_from_opencv_are_rounding_where_no_photo_has_weight(shared, monkeypatch):
    """In 1 % of these pixels every photograph is gray or flat, and the formula has no weight for any of them.

    Ours then weighs all alike. In OpenCV what rounding leaves of R - mean, some 1e-8, is far above
    its trace of 1e-12 and decides. With its rounding in our place of the two measures, all pixels
    are alike; without it, those that differ are such pixels or next to one.
    """
    images = photographs(shared("mertens_house"))
    theirs = opencv(images)
    ours = mertens.fuse(images)
    exact = list(mertens.weights(images))
    heaviest = np.max([weigh(image) for image in images], axis=0)
    monkeypatch.setattr(mertens, "contrast", contrast_with_opencvs_rounding)
    monkeypatch.setattr(mertens, "saturation", saturation_with_opencvs_rounding)
    assert np.abs(mertens.fuse(images) - theirs).max() < 1e-5
    moved = np.max(
        [np.abs(W - E) for W, E in zip(mertens.weights(images), exact, strict=True)], axis=0
    )
    rounded = moved > 0.01
    assert 0.005 < rounded.mean() < 0.015 and heaviest[rounded].max() < 1e-5  # of 0.01, usually
    near = cv2.dilate(rounded.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    difference = np.abs(ours - theirs).max(axis=-1)
    assert np.all(near[difference > 0.01]) and difference[~near].max() < 0.01
    assert np.mean(difference > 0.01) < 0.001 and difference.max() < 0.15


def weigh(image):
    return mertens.weight(mertens.split_planes(image))


def test_rounding_leaves_no_contrast_in_flat_and_no_saturation_in_gray_images():
    """Otherwise rounding errors of 1e-8 would outweigh the constant 1e-12, for any gray or color."""
    levels = np.arange(256, dtype=np.uint8)
    gray = mertens.split_planes(np.broadcast_to(levels[:, None, None], (256, 7, 3)))
    assert not mertens.saturation(gray).any()
    for colour in np.random.default_rng(0).integers(0, 256, (300, 3), dtype=np.uint8):
        assert not mertens.contrast(mertens.split_planes(np.broadcast_to(colour, (5, 6, 3)))).any()


def test_every_step_adds_one_photograph_to_every_level():
    images = bracket(frames=4)
    steps = list(mertens.fuse_steps(images))
    assert [step.image for step in steps] == [0, 1, 2, 3]
    for level in range(len(steps[0].weights)):
        total = sum(step.weights[level] * step.details[level] for step in steps)
        assert np.allclose(steps[-1].blended[level], total, atol=1e-6)
        assert np.allclose(sum(step.weights[level] for step in steps), 1, atol=1e-5)
    assert np.allclose(
        pyramid.collapse(steps[1].details), mertens.split_planes(images[1]), atol=1e-5
    )
    assert steps[0].weights[-1].shape == (2, 3)


@given(
    frames=st.integers(1, 4),
    height=st.integers(1, 20),
    width=st.integers(1, 20),
    colour=st.booleans(),
)
def test_copies_of_one_photograph_fuse_to_it_at_any_size(frames, height, width, colour):
    photo = bracket((height, width, 3) if colour else (height, width), frames=1)[0]
    fused = mertens.fuse(np.stack([photo] * frames))
    assert fused.shape == photo.shape and fused.dtype == np.float32
    assert np.allclose(fused, photo / 255, atol=1e-4)


def test_sixteen_bits_fuse_as_eight():
    images = bracket((60, 70, 3))
    assert np.allclose(
        mertens.fuse(images.astype(np.uint16) * 257), mertens.fuse(images), atol=1e-3
    )


def test_the_order_of_the_photographs_does_not_matter():
    images = bracket(frames=4)
    assert np.allclose(mertens.fuse(images[::-1]), mertens.fuse(images), atol=1e-5)
    assert np.allclose(mertens.fuse(list(images)), mertens.fuse(images))


def test_the_result_is_not_clipped():
    """Details of one frame added to the light of another exceed [0, 1]."""
    R = mertens.fuse(np.random.default_rng(0).integers(0, 256, (3, 97, 131, 3), dtype=np.uint8))
    assert R.min() < -0.01 and R.max() > 1.01


def test_a_badly_exposed_photograph_hardly_counts():
    good = bracket((64, 64, 3), frames=1)[0]
    dark = (good // 16).astype(np.uint8)
    assert np.abs(mertens.fuse([good, dark]) - good / 255).mean() < 0.05


def test_invalid_input_raises_an_error():
    with pytest.raises(ValueError, match="stack"):
        mertens.fuse(np.zeros((4, 5), np.uint8))
    with pytest.raises(ValueError, match="uint8 or uint16"):
        mertens.fuse(np.zeros((2, 4, 5)))
    with pytest.raises(ValueError, match="one size"):
        mertens.fuse([np.zeros((4, 5), np.uint8), np.zeros((4, 6), np.uint8)])
    for wrong in (-1, np.nan, np.inf):
        with pytest.raises(ValueError, match="finite powers"):
            mertens.fuse(bracket(), saturation=wrong)
