"""The packaged photos: free licenses, small files, and times that agree with the pixels."""

from dataclasses import replace

import numpy as np
import pytest

from hdrlab import pipeline, scenes
from hdrlab.align import mtb
from hdrlab.align.shift import shift
from hdrlab.core import sampling, weights
from hdrlab.core.colour import luminance
from hdrlab.fast.debevec import gsolve
from hdrlab.io.album import photographs
from hdrlab.scenes import places

pytestmark = pytest.mark.scenes

FOLDER = places.FOLDER / "tripod"
SHAPE = (320, 240)
# at 500 x 375: the rubber of a foot, the device's front, the floor, a post before the windows, a
# window
PLACES = (
    np.s_[340:350, 283:293],
    np.s_[118:150, 110:200],
    np.s_[440:490, 200:340],
    np.s_[40:90, 115:125],
    np.s_[20:60, 225:250],
)


@pytest.fixture(scope="module")
def taken():
    return scenes.photographs(SHAPE)


def test_the_package_contains_six_photos_of_three_megapixels_and_their_licence():
    taken = scenes.photographs()
    assert taken.images.shape == (6, 2000, 1500, 3) and taken.images.dtype == np.uint8
    assert sum(file.stat().st_size for file in FOLDER.iterdir()) < 3e6
    assert "MIT License" in (FOLDER / "LICENSE").read_text()
    notice = (FOLDER / "README.md").read_text()
    assert "Fran Murcia" in notice
    assert "times" in notice and "wrong" in notice


def test_the_photos_are_those_that_were_published(shared):
    assert [file.read_bytes() for file in photographs(FOLDER)] == [
        file.read_bytes() for file in photographs(shared("tripod_phone"))
    ]


def test_a_smaller_shape_is_the_mean_of_levels(taken):
    assert taken.images.shape == (6, *SHAPE, 3) and taken.images.dtype == np.uint8
    means = taken.images.mean(axis=(1, 2, 3))
    assert np.allclose(means, scenes.photographs().images.mean(axis=(1, 2, 3)), atol=0.5)
    assert np.all(np.diff(means) > -1)  # sorted from short to long


@pytest.mark.parametrize("shape", [(2001, 1500), (0, 240), (320,)])
def test_an_invalid_shape_raises_an_error(shape):
    with pytest.raises(ValueError, match="shape"):
        scenes.photographs(shape)


def test_the_pipeline_gives_no_warning_for_the_photos(taken):
    assembly = pipeline.assemble(taken)
    assert assembly.warnings == () and assembly.fallback == "" and assembly.spread < 0.05
    assert np.array_equal(assembly.bracket.times, taken.times)


def test_the_times_of_the_packaged_photos_agree_with_their_pixels_within_a_fifth_of_a_stop(taken):
    assembly = pipeline.assemble(replace(taken, times=np.ones(6)))
    assert np.allclose(
        np.diff(np.log2(assembly.bracket.times)), np.diff(np.log2(taken.times)), atol=0.2
    )


# What the notebooks say of them


@pytest.fixture(scope="module")
def shown():
    return scenes.photographs((500, 375))


@pytest.fixture(scope="module")
def assembled(shown):
    return pipeline.assemble(shown)


def test_the_hand_moved_by_up_to_eight_pixels_to_the_side_and_one_up_or_down(shown):
    assert np.abs(mtb.align(shown.images)).max(axis=0).tolist() == [1, 8]


def test_the_map_spans_six_stops_and_the_feet_are_darker_than_the_front_and_the_floor(assembled):
    assert 5.5 < scenes.decades(assembled.E) / np.log10(2) < 6.5
    assert 0.015 < assembled.spread < 0.025
    L = np.log2(luminance(assembled.E))
    medians = [np.median(L[place]) for place in PLACES]
    foot, front, floor, post, window = medians
    assert 0.8 < min(front, floor) - foot < 1.5
    assert post - front > 1.5 and window - post > 2  # a black post, in the haze of the window


def test_one_small_region_at_the_left_edge_moved(shown):
    assembly = pipeline.assemble(shown, ghosts="regions")
    assert assembly.moving.max() == 1 and np.mean(assembly.moving > 0) < 0.005
    assert np.nonzero(assembly.moving)[1].max() < 20


def test_they_turned_by_a_fifth_of_a_degree_and_auto_keeps_shifts_that_agree_as_well(
    shown, assembled
):
    turned = pipeline.assemble(shown, align="cerman")
    degrees = np.rad2deg(np.arctan2(turned.homographies[:, 1, 0], turned.homographies[:, 0, 0]))
    assert 0.15 < np.abs(degrees).max() < 0.25
    assert np.array_equal(assembled.homographies[:, :2, :2], np.tile(np.eye(2), (6, 1, 1)))
    assert assembled.spread <= turned.spread + 0.0005


def test_the_stated_times_put_the_points_ten_times_further_from_the_curve(shown):
    images = shift(shown.images, mtb.align(shown.images))[..., 1]
    Z = sampling.by_grid(images, 60)
    w = weights.hat()
    off = []
    for times in (1 / np.array([1000, 120, 60, 15, 8, 4]), shown.times):
        g, lE = gsolve(Z, np.log(times), 30, w)
        residuals = w[Z] * (g[Z] - lE[:, None] - np.log(times))
        off.append(np.sqrt(np.sum(residuals**2) / np.sum(w[Z] ** 2)))
    assert off[0] > 10 * off[1]


# The room with a window


@pytest.fixture(scope="module")
def room():
    return scenes.window((432, 576))


@pytest.fixture(scope="module")
def room_map(room):
    return pipeline.assemble(room)


def test_the_package_contains_twelve_photos_of_a_room_with_their_license_and_credit():
    folder = FOLDER.parent / "window"
    taken = scenes.window()
    assert taken.images.shape == (12, 864, 1152, 3) and taken.images.dtype == np.uint8
    assert sum(file.stat().st_size for file in folder.iterdir()) < 1.5e6
    for name in ("LICENSE", "README.md"):
        notice = (folder / name).read_text("utf8")
        assert "Axel Jacobs" in notice and "CC BY-SA 2.0" in notice and "reduced" in notice


def test_the_times_of_the_room_are_in_exif_and_one_stop_apart(room):
    assert np.allclose(np.diff(np.log2(room.times)), 1, atol=0.1)
    assert room.times[0] == pytest.approx(1 / 1000) and room.times[-1] == 2


def test_the_map_of_the_room_spans_nearly_ten_stops_without_a_warning(room_map):
    assert room_map.warnings == () and room_map.fallback == ""
    assert 9.3 < scenes.decades(room_map.E) / np.log10(2) < 9.9 and room_map.spread < 0.03


def test_the_sky_is_nine_stops_above_the_cushion_and_the_stand_one(room_map):
    L = np.log2(luminance(room_map.E))
    cushion = np.median(L[310:318, 340:346])
    assert np.median(L[35:60, 230:320]) - cushion == pytest.approx(9.3, abs=0.3)
    assert np.median(L[330:345, 119:124]) - cushion == pytest.approx(1, abs=0.3)
