"""Registration beyond a shift: homographies, resampling of photos, and the choice of a method."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from PIL import Image

from hdrlab import pipeline, scenes
from hdrlab.align import homography, mtb, resample
from hdrlab.align.shift import shift
from hdrlab.capture import camera, hand_motion
from hdrlab.capture.responses import true_g
from hdrlab.core.bracket import bracket
from hdrlab.core.filters import warp
from hdrlab.diagnostics.registration import MIN_CONFIDENCE
from hdrlab.pipeline import alignment, registration
from hdrlab.radiance.merge import Quality
from scenes.computed import view

pytestmark = pytest.mark.papers

SHAPE = (150, 220)
CAMERA = camera.Camera(full_well=20_000, read_noise=5)
HAND = dict(radius=4, degrees=2, rng=6)


@pytest.fixture(scope="module")
def room():
    return view.room(SHAPE)  # traced at this size: sharper than the mean of a larger picture


def shoot(E, moves):
    """Return photographs two stops apart of a moved camera, and the moves in their own pixels."""
    taken = camera.shoot(
        E, camera.times_around(E, len(moves), stops=2), CAMERA, offsets=moves, rng=2
    )
    return taken, hand_motion.frame_homographies(moves, E.shape)


# homographies


def test_warp_through_finds_the_homography_of_four_corners():
    H = hand_motion.shake(2, SHAPE, degrees=9, zoom=0.1, tilt=0.1, rng=5)[0]
    assert np.allclose(
        warp.through(warp.corners(SHAPE), warp.apply(H, warp.corners(SHAPE))), H / H[2, 2]
    )


def test_a_homography_of_a_level_is_that_of_the_next_in_its_pixels():
    H = warp.as_homographies([[1.25, -3]])[0]
    assert np.allclose(homography.enlarge(H), warp.as_homographies([[2.5, -6]])[0])


def test_inconsistent_matches_give_no_homography():
    points = np.random.default_rng(0).uniform(0, 200, (2, 40, 2))
    H, agree = homography.consensus(points)
    assert np.array_equal(H, np.eye(3)) and not agree.any()
    assert not homography.consensus(points[:, :5])[1].any()


def test_a_step_ahead_with_a_tilted_camera_is_found():
    E = scenes.room((220, 320))
    taken, truth = shoot(
        E, hand_motion.shake(2, E.shape, radius=12, degrees=4, zoom=0.05, tilt=0.05, rng=7)
    )
    homographies = homography.align(taken.images, taken.times, true_g())
    truth = np.linalg.inv(truth[-1]) @ truth
    assert (
        warp.corner_distance(np.linalg.inv(homographies[-1]) @ homographies, truth, E.shape).max()
        < 1
    )
    (pair,) = alignment.register(taken.images, "homography").pairs
    assert pair.reliable and pair.confidence > 0.6


def test_photos_without_feature_points_are_not_moved_and_reported():
    images = np.stack([np.full((90, 120), level, np.uint8) for level in (60, 120)])
    (pair,) = alignment.register(images, "homography").pairs
    assert np.array_equal(pair.H, np.eye(3)) and not pair.reliable


# the choice


@pytest.mark.parametrize(
    ("moves", "ways"),
    [
        ([[0, 0], [0, 0]], {"none"}),
        ([[5, -7], [0, 0]], {"mtb"}),
        ([warp.turn(SHAPE, 2.5, (3.5, 1.2)), np.eye(3)], {"rotation"}),
    ],
)
def test_auto_chooses_the_simplest_method_that_aligns(room, moves, ways):
    taken, _ = shoot(room, moves)
    choice = alignment.register(taken.images, times=taken.times, g=true_g())
    assert choice.method in ways


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=2)
def test_unrelated_photos_are_not_moved(seed):
    images = np.random.default_rng(seed).integers(0, 256, (2, 80, 90), dtype=np.uint8)
    choice = alignment.register(images, times=[1, 2], g=true_g())
    assert choice.method == "none" and np.array_equal(choice.homographies, [np.eye(3)] * 2)


@pytest.mark.parametrize("moves", [[[0, 0], [0, 0], [0, 0]], [[5, -7], [0, 0], [-3, 6]]])
def test_auto_only_runs_mtb_if_shifts_align_the_photos(room, moves, monkeypatch):
    taken, _ = shoot(room, moves)
    monkeypatch.setattr(alignment, "improve", None)  # nothing is searched by light
    homographies = alignment.register(taken.images, "auto").homographies
    assert np.array_equal(homographies, alignment.register(taken.images, "mtb").homographies)


def test_auto_is_never_worse_than_no_alignment(room):
    for seed in range(4):
        taken, _ = shoot(room, hand_motion.shake(2, SHAPE, radius=3, degrees=6, zoom=0.1, rng=seed))
        (pair,) = alignment.register(taken.images, "auto").pairs
        assert pair.after <= pair.before


def test_match_points_returns_at_most_max_points():
    noise = np.random.default_rng(0).uniform(0.1, 1, (1, 120, 160)).astype(np.float32)
    points = homography.match_points(np.repeat(noise, 2, axis=0), max_points=50)
    assert 10 < points.shape[1] <= 50


# photographs that move


def test_shifts_by_whole_pixels_are_cropped_without_resampling():
    images = np.random.default_rng(0).integers(0, 256, (3, 30, 40, 3), dtype=np.uint8)
    offsets = [(2, -5), (0, 0), (-3, 4)]
    moved, valid = resample.photographs(images, offsets)
    assert valid is None and np.array_equal(moved, shift(images, offsets))


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("g", [None, true_g("film")])
def test_a_uniform_wall_keeps_its_pixel_value_for_any_response(dtype, g):
    for level in (0, 7, 100, 249, 255):
        wall = np.full((2, 20, 30, 3), level, dtype) * dtype(257 if dtype == np.uint16 else 1)
        moved, _ = resample.photographs(wall, [[0.4, -0.3], [0, 0]], g)
        assert np.abs(moved.astype(int) - wall[0, 0, 0, 0]).max() <= (
            1 if dtype == np.uint16 else 0
        )


def test_pixels_between_pixels_are_means_of_light(room):
    times = camera.times_around(room, 2, stops=0.001, middle=0.03)
    moves = [warp.turn(SHAPE, 1.5, (2.4, 3.3)), np.eye(3)]
    taken = camera.shoot(room, times, offsets=moves)
    moved, _ = resample.photographs(
        taken.images, hand_motion.frame_homographies(moves, SHAPE), true_g()
    )
    well = (moved > 20).all(axis=(0, 3)) & (moved < 240).all(axis=(0, 3))
    assert np.median(np.abs(moved[0].astype(int) - moved[1])[well]) <= 2


@pytest.mark.parametrize("colours", [(), (3,)])
def test_resampling_in_bands_gives_the_same_result_as_the_whole_image(monkeypatch, colours):
    image = np.random.default_rng(0).integers(0, 256, (2, 45, 60, *colours), dtype=np.uint8)
    moves = [
        warp.turn((45, 60), 20, (3.3, -2.6)) + [[0, 0, 0], [0, 0, 0], [1e-4, 2e-4, 0]],
        np.eye(3),
    ]
    whole, _ = resample.photographs(image, moves, true_g())
    monkeypatch.setattr(resample, "BAND_ROWS", 7)
    banded, _ = resample.photographs(image, moves, true_g())
    assert np.abs(banded.astype(int) - whole).max() <= 1


def test_resampling_does_not_average_clipped_with_unclipped_pixels():
    image = np.full((1, 20, 20), 40, np.uint8)
    image[0, :, 10:] = 255
    moved, _ = resample.photographs(np.repeat(image, 2, axis=0), [[0, 0.5], [0, 0]], true_g())
    assert set(np.unique(moved[0])) == {40, 255}


def test_resampling_does_not_average_masked_pixels():
    images = np.full((2, 20, 24), 90, np.uint8)
    valid = np.ones(images.shape, bool)
    images[0, :, 12] = 200
    valid[0, :, 12] = False
    moved, kept = resample.photographs(images, [[0, 0.5], [0, 0]], valid=valid)
    assert kept[1].all() and not kept[0].all() and np.all(moved[0][kept[0]] == 90)


def test_homographies_that_do_not_fit_the_images_raise_an_error():
    images = np.zeros((2, 20, 24), np.uint8)
    for moves, message in (
        ([[0, 0.5]], "expected 2 homographies"),
        ([[0, 0], [0, 99.5]], "overlap"),
    ):
        with pytest.raises(ValueError, match=message):
            resample.photographs(images, moves)


# the pipeline


@pytest.fixture(scope="module")
def turned(room):
    """Three photos, between which the camera rotated, and its rotations."""
    return shoot(room, hand_motion.shake(3, SHAPE, **HAND))


def map_error(assembly, room, taken):
    """Return the median relative error of a map on edges, where misalignment shows."""
    rows, columns = warp.common_rectangle(assembly.homographies, taken.images.shape[1:3])
    scene = hand_motion.views(room, hand_motion.shake(3, SHAPE, **HAND))[1][rows, columns]
    slope = np.hypot(*np.gradient(np.log(scene[..., 1] + 1e-4)))
    well = (assembly.quality == Quality.MEASURED) & (slope > np.quantile(slope, 0.8))
    ratio = assembly.E[well] / scene[well]
    return np.median(np.abs(ratio / np.median(ratio, axis=0) - 1))


def test_correcting_rotation_halves_the_error_of_the_map(room, turned):
    taken = turned[0]
    errors = {
        way: map_error(pipeline.assemble(taken, align=way, ghosts="none"), room, taken)
        for way in ("none", "cerman")
    }
    assert errors["cerman"] < errors["none"] / 2


def test_the_assembly_holds_the_homographies_and_a_note_on_the_method(turned):
    taken, truth = turned
    assembly = next(pipeline.assemble_steps(taken, align="auto"))
    relative = np.linalg.inv(truth[1]) @ truth
    assert (
        warp.corner_distance(assembly.homographies, relative, taken.images.shape[1:3]).max() < 0.5
    )
    assert assembly.offsets.dtype == np.int64 and 'aligned by "rotation"' in assembly.details[0]
    still = next(pipeline.assemble_steps(taken, align="mtb"))
    assert np.array_equal(still.homographies, warp.as_homographies(mtb.align(taken.images)))


def test_your_own_align_function_may_return_homographies(turned):
    taken, truth = turned
    moves = np.linalg.inv(truth[1]) @ truth
    assembly = next(pipeline.assemble_steps(taken, align=lambda images: moves))
    assert np.allclose(assembly.homographies, moves)
    assert assembly.bracket.images.shape[1] < taken.images.shape[1]


def test_masks_are_warped_with_their_photos(turned):
    taken, _ = turned
    valid = np.ones(taken.images.shape[:3], bool)
    valid[0, :, :40] = False
    assembly = next(
        pipeline.assemble_steps(bracket(taken.images, taken.times, valid=valid), align="cerman")
    )
    assert assembly.bracket.valid.shape == assembly.bracket.images.shape[:3]
    assert not assembly.bracket.valid[0].all() and assembly.bracket.valid[1:].all()


def test_photos_of_two_scenes_give_a_warning(room):
    rng = np.random.default_rng(4)
    other = (10 ** rng.uniform(-1, 3, (50, 73, 1))).repeat(3, 0).repeat(3, 1)[:150, :219] * np.ones(
        3
    )
    times = camera.times_around(room, 2)
    images = [
        camera.shoot(E, [t]).images[0] for E, t in zip((room[:, :219], other), times, strict=True)
    ]
    assembly = next(
        pipeline.assemble_steps(
            bracket(np.stack(images), times, ["a.jpg", "b.jpg"]), align="cerman"
        )
    )
    assert any("b.jpg" in warning and "leave one out" in warning for warning in assembly.warnings)
    assert assembly.homographies.shape == (2, 3, 3) and MIN_CONFIDENCE == 0.3


# real photographs


def test_the_arch_is_registered_to_the_measured_shifts_without_rotation(photographs):
    taken = photographs("stlouis_arch")
    small = taken.images[:, ::4, ::4]  # shifts of 1, 7.5 and 2 pixels at full size
    g = registration.find_provisional_response(replace(taken, images=small), "auto")
    pairs = alignment.register(small, "cerman", times=taken.times, g=g).pairs
    across = np.abs([pair.offset[1] for pair in pairs])
    assert np.all(np.abs(across - np.array([1, 7.5, 2]) / 4) < 0.35)
    assert all(
        abs(pair.offset[0]) < 0.4 and abs(pair.degrees) < 0.1 and pair.confidence > 0.6
        for pair in pairs
    )


def test_different_viewpoints_fit_better_by_homographies_than_by_rotations(shared):
    paths = sorted((shared("crusader") / "frames").glob("*.jpeg"))
    images = np.stack([np.asarray(Image.open(path).convert("RGB").reduce(6)) for path in paths])
    turned = alignment.register(images, "cerman").pairs
    tilted = alignment.register(images, "homography").pairs
    better = [
        pair.after < rotated_pair.after for pair, rotated_pair in zip(tilted, turned, strict=True)
    ]
    assert sum(better) >= 4 and all(pair.after <= pair.before for pair in tilted)
    assert np.mean([pair.after for pair in tilted]) < 0.5 * np.mean(
        [pair.before for pair in tilted]
    )
    # depth, and a pair with little overlap, which is reported
    assert not all(pair.reliable for pair in tilted)
