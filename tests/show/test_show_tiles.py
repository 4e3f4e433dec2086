"""Figures of a burst's tiles: they show what the library's alignment and merge compute."""

import numpy as np
import pytest

from hdrlab.beyond.burst import temporal_merge, tile_alignment
from hdrlab.show import pictures
from hdrlab.show.plots.lectures import tiles

NOISE = {"shot": 0.0, "read": 0.02**2}
RNG = np.random.default_rng(0)
SCENE = RNG.random((80, 96), np.float32)
# The second frame sees the scene 3 pixels further down and 2 further left.
FRAMES = np.stack([SCENE[8:72, 8:88], SCENE[11:75, 6:86]])
OFFSETS = tile_alignment.align(FRAMES)
PHOTO = np.rint(255 * FRAMES[0]).astype(np.uint8)


def test_smallest_distance_of_the_map_is_at_the_offset_of_the_tile():
    found = tiles.search_tile(FRAMES, OFFSETS, PHOTO, frame=1, down=0.5, right=0.5)
    row, column = np.unravel_index(np.argmin(found.distances), found.distances.shape)
    radius = len(found.distances) // 2
    assert (row - radius, column - radius) == found.offset == (3, -2)
    assert found.distances.min() == 0


def test_weights_of_all_frames_add_up_to_1_at_each_frequency():
    found = tiles.weigh_tile(FRAMES, OFFSETS, PHOTO, down=0.5, right=0.5, tuning=1.0, **NOISE)
    assert np.allclose(found.weights.sum(axis=0), 1)
    assert (found.weights[0] >= 0.5 - 1e-6).all()


def test_weights_are_those_of_the_merged_tile():
    noisy = FRAMES + RNG.normal(0, 0.02, FRAMES.shape).astype(np.float32)
    found = tiles.weigh_tile(noisy, OFFSETS, PHOTO, down=0.5, right=0.5, tuning=12.0, **NOISE)
    pairs = zip(noisy, OFFSETS, strict=True)
    T = np.stack([tiles.cut_tile(X, found.place, u[found.place], 16) for X, u in pairs])
    weights = np.fft.ifftshift(found.weights, axes=(-2, -1))
    by_weights = np.fft.ifft2(np.sum(weights * np.fft.fft2(T), axis=0)).real
    merged = temporal_merge.merge_tile(T, NOISE["read"], tuning=12.0)
    assert np.allclose(by_weights, merged, atol=1e-6)


@pytest.mark.parametrize(("down", "right"), [(0, 0), (0.3, 0.8), (1, 1)])
def test_figures_of_any_tile_can_be_drawn(down, right):
    place = {"down": down, "right": right}
    search = tiles.search_tile(FRAMES, OFFSETS, PHOTO, frame=1, radius=2, **place)
    weights = tiles.weigh_tile(FRAMES, OFFSETS, PHOTO, tuning=1.0, **NOISE, **place)
    assert pictures.render(tiles.draw_search(search)).shape[2] == 3
    assert pictures.render(tiles.draw_weights(weights)).shape[2] == 3
