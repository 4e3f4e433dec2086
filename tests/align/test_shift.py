"""`align.shift`: shifting images by whole pixels."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from hypothesis.extra.numpy import arrays

from hdrlab.align.shift import crop, shift


def views(offsets, shape=(40, 50)):
    """Return photos of one scene that `offsets` aligns."""
    scene = np.random.default_rng(3).integers(0, 256, (100, 110, *shape[2:]), dtype=np.uint8)
    rows, columns = shape[:2]
    return np.stack(
        [scene[30 + dy : 30 + dy + rows, 30 + dx : 30 + dx + columns] for dy, dx in offsets]
    )


@given(arrays(np.int64, st.tuples(st.integers(1, 5), st.just(2)), elements=st.integers(-18, 18)))
@settings(deadline=None)
def test_shifted_views_of_one_scene_become_equal(offsets):
    offsets = np.clip(offsets - offsets[0], -18, 18)
    images = views(offsets)
    rows, columns = crop(offsets, images.shape[1:])
    moved = shift(images, offsets)
    assert np.all(moved == images[0][rows, columns])


@given(arrays(np.int64, st.tuples(st.integers(1, 5), st.just(2)), elements=st.integers(-30, 30)))
@settings(deadline=None)
def test_the_crop_holds_exactly_the_pixels_that_every_image_covers(offsets):
    covered = np.ones((40, 50), bool)
    for dy, dx in offsets:
        y, x = np.mgrid[:40, :50]
        covered &= (y >= dy) & (y < dy + 40) & (x >= dx) & (x < dx + 50)
    if not covered.any():
        with pytest.raises(ValueError, match="overlap"):
            crop(offsets, (40, 50))
        return
    rows, columns = crop(offsets, (40, 50))
    assert covered[rows, columns].all() and covered[rows, columns].size == covered.sum()


@pytest.mark.parametrize("shape", [(40, 50), (40, 50, 3)])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_shift_keeps_bit_depth_and_channels(shape, dtype):
    images = views([(0, 0), (2, -5)], shape).astype(dtype)
    moved = shift(images, [(0, 0), (2, -5)])
    assert moved.dtype == dtype and moved.shape == (2, 38, 45, *shape[2:])


def test_images_with_zero_offsets_are_not_copied():
    images = views([(0, 0), (0, 0)])
    assert shift(images, np.zeros((2, 2), int)) is images


def test_shift_does_not_change_its_arguments():
    images = views([(0, 0), (3, 4)])
    before = images.copy()
    shift(images, [(0, 0), (3, 4)])[:] = 0
    assert np.array_equal(images, before)


@pytest.mark.parametrize("offsets", [[(40, 0), (0, 0)], [(0, 25), (0, -25)], [(-20, 0), (20, 1)]])
def test_offsets_without_an_overlap_raise_an_error(offsets):
    with pytest.raises(ValueError, match=r"overlap.*\(40, 50\)"):
        shift(views([(0, 0), (0, 0)]), offsets)


@pytest.mark.parametrize(
    "offsets", [[(0, 0)], [(0, 0)] * 3, [0, 0], [(0.5, 0), (0, 0)], [(0, 0, 0), (0, 0, 0)]]
)
def test_offsets_must_be_one_pair_of_integers_per_image(offsets):
    with pytest.raises(ValueError, match="offsets"):
        shift(views([(0, 0), (0, 0)]), offsets)


def test_the_crop_stays_inside_the_images_if_all_offsets_have_one_sign():
    rows, columns = crop([[2, 5], [4, 3]], (20, 30))
    assert (rows, columns) == (slice(4, 20), slice(5, 30))
    rows, columns = crop([[-2, -5], [-4, -3]], (20, 30))
    assert (rows, columns) == (slice(0, 16), slice(0, 25))
