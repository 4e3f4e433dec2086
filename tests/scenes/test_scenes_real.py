"""Photographs that travel with the package: free, small, and their times agree with their pixels."""

import numpy as np
import pytest

from hdrlab import pipeline, scenes
from hdrlab.io.photos import photographs
from hdrlab.scenes import places

FOLDER = places.FOLDER / "tripod"
SHAPE = (320, 240)


@pytest.fixture(scope="module")
def taken():
    return scenes.photographs(SHAPE)


def test_six_photographs_of_three_megapixels_travel_with_their_licence_in_three_megabytes():
    taken = scenes.photographs()
    assert taken.images.shape == (6, 2000, 1500, 3) and taken.images.dtype == np.uint8
    assert sum(file.stat().st_size for file in FOLDER.iterdir()) < 3e6
    assert "MIT License" in (FOLDER / "LICENSE").read_text()
    notice = (FOLDER / "README.md").read_text()
    assert "Fran Murcia" in notice and "times that were published with the photographs are wrong" in notice


def test_they_are_the_photographs_as_published(shared):
    assert [file.read_bytes() for file in photographs(FOLDER)] == [
        file.read_bytes() for file in photographs(shared("tripod_phone"))
    ]


def test_a_smaller_shape_is_the_mean_of_levels(taken):
    assert taken.images.shape == (6, *SHAPE, 3) and taken.images.dtype == np.uint8
    means = taken.images.mean(axis=(1, 2, 3))
    assert np.allclose(means, scenes.photographs().images.mean(axis=(1, 2, 3)), atol=0.5)
    assert np.all(np.diff(means) > -1)  # sorted from short to long


@pytest.mark.parametrize("shape", [(2001, 1500), (0, 240), (320,)])
def test_a_shape_that_they_do_not_have_is_refused(shape):
    with pytest.raises(ValueError, match="expected a shape"):
        scenes.photographs(shape)


def test_the_pipeline_finds_nothing_to_doubt_in_them(taken):
    found = pipeline.assemble(taken)
    assert found.doubts == () and found.fallback == "" and found.spread < 0.05
    assert np.array_equal(found.bracket.times, taken.times)


def test_their_times_are_those_that_the_pixels_give_to_a_fifth_of_a_stop(taken):
    found = pipeline.assemble(taken._replace(times=np.ones(6)))
    assert np.allclose(np.diff(np.log2(found.bracket.times)), np.diff(np.log2(taken.times)), atol=0.2)
