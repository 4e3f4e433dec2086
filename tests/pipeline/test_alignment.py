"""Warnings of `assemble` about alignment: for photos that are misaligned, and only for these."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter
from skimage.data import astronaut, coffee
from support.hand_held_photos import MARGIN, H, W, bracket as shoot, photograph, scene_radiance

from hdrlab import pipeline, scenes
from hdrlab.capture import camera, hand_motion
from hdrlab.core.bracket import bracket
from hdrlab.core.filters import warp
from hdrlab.pipeline import alignment
from hdrlab.pipeline.alignment import register

pytestmark = pytest.mark.papers

STILL = [(0, 0)] * 7
HAND = [(4, -3), (1, 2), (0, 0), (-2, 5), (3, 3), (6, -1), (2, 2)]
# ends that are nearly black and nearly white
TIMES = 4.0 ** np.linspace(-6, 3, 7)


def aligned(images, align="auto"):
    """Return the first stage of `assemble` for photos a factor of 16 apart."""
    return pipeline.align_bracket(bracket(images, 16.0 ** np.arange(len(images))), align)


def night(offsets, seed=0):
    """Return photos of a street at night: nearly black except for lamps, and noisy."""
    rng = np.random.default_rng(seed)
    E = 1e-3 * scene_radiance(coffee(), 1.0)
    for y, x in rng.integers(MARGIN, (MARGIN + H, MARGIN + W), (12, 2)):
        E[y : y + 4, x : x + 4] += 3
    return np.stack([photograph(E, 4.0**k, o, rng=rng, noise=0.02) for k, o in enumerate(offsets)])


@pytest.mark.parametrize("align", ["auto", "mtb"])
@pytest.mark.parametrize("texture", [astronaut, coffee])
def test_nearly_black_or_white_frames_from_a_tripod_give_no_warning(texture, align):
    images = shoot(STILL, TIMES, texture=texture(), decades=3.0)
    assert np.mean(images[0] < 12) > 0.8 and np.mean(images[-1] > 243) > 0.8
    assembly = aligned(images, align)
    assert not assembly.offsets.any() and assembly.warnings == ()
    assert assembly.notes == ()


def test_photos_that_are_black_or_white_nearly_everywhere_give_no_warning():
    """High contrast and sharpening leave only edge pixels well exposed in both photos."""
    hard = camera.Camera(response=lambda X: X**3, full_well=40_000.0)
    taken = camera.shoot(scenes.room((344, 516)), [0.084, 0.277], hard, rng=0)
    soft = gaussian_filter(taken.images.astype(np.float32), (0, 1, 1, 0))
    sharp = np.clip(np.rint(2.0 * taken.images - soft), 0, 255).astype(np.uint8)
    assembly = aligned(sharp)
    assert not assembly.offsets.any() and assembly.warnings == ()


@pytest.mark.parametrize("seed", range(3))
def test_a_night_scene_from_a_tripod_gives_no_warning(seed):
    assembly = aligned(night([(0, 0)] * 4, seed))
    assert not assembly.offsets.any() and assembly.warnings == ()


def test_a_frame_that_cannot_be_aligned_moves_with_its_neighbour_and_is_noted():
    images = shoot(HAND[1:4], [1, 4, 16])
    black = np.random.default_rng(0).integers(0, 3, images[:1].shape, dtype=np.uint8)
    assembly = aligned(np.concatenate([black, images]))
    assert np.array_equal(assembly.offsets[0], assembly.offsets[1]) and assembly.offsets[1].any()
    (detail,) = assembly.details
    assert "frame 1 and frame 2" in detail and assembly.warnings == ()


def test_misaligned_pairs_give_one_warning_that_says_what_to_do():
    shots = [
        shoot([(0, 0)], [1, 4, 16][j : j + 1], texture=[astronaut, coffee][j % 2]())
        for j in range(3)
    ]
    (warning,) = aligned(np.concatenate(shots), "mtb").warnings
    assert "and 1 more pair" in warning and "leave one out" in warning


@pytest.mark.parametrize("removes_ghosts", [False, True])
def test_ghost_removal_is_recommended_for_photos_that_nothing_aligns(removes_ghosts):
    shots = [
        shoot([(0, 0)], [time], texture=texture())
        for time, texture in ((1, astronaut), (4, coffee))
    ]
    taken = bracket(np.concatenate(shots)[:, ::3, ::3], [1.0, 4.0])
    (warning,) = pipeline.align_bracket(taken, "auto", removes_ghosts=removes_ghosts).warnings
    assert ("--ghosts regions" in warning) != removes_ghosts


def test_the_search_range_grows_with_the_image_size():
    E = np.kron(scene_radiance(astronaut()), np.ones((2, 2, 1)))
    rng = np.random.default_rng(0)
    views = [0.2 * t * E[y : y + 700, x : x + 900] for t, y, x in ((1, 10, 5), (4, 110, 95))]
    images = np.stack(
        [
            (255 * np.clip(view + 0.002 * rng.standard_normal(view.shape), 0, 1) ** 0.45)
            for view in views
        ]
    )
    registration = register(images.astype(np.uint8), "mtb")
    assert np.abs(np.subtract(registration.pairs[0].offset, (-100, -90))).max() <= 1
    assert registration.pairs[0].reliable


def test_the_validation_gives_the_same_result_at_every_image_size():
    rng = np.random.default_rng(3)
    images = shoot([(0, 0), (0, 0)], [1, 4], noise=0.02)
    for times in (1, 2, 4):
        large = np.kron(images, np.ones((1, times, times, 1))) + rng.normal(
            0, 2 * times, (2, H * times, W * times, 1)
        )
        (pair,) = register(np.clip(large, 0, 255).astype(np.uint8), "mtb").pairs
        assert pair.known and not pair.apart and pair.confidence > 0.9


def test_a_single_photo_is_not_moved():
    registration = register(np.full((1, 40, 50), 90, np.uint8), "mtb")
    assert np.array_equal(registration.homographies, [np.eye(3)]) and len(registration.pairs) == 0


def test_rotated_photos_are_reported_once_and_not_as_motion_too():
    room = scenes.room((280, 420))
    turned = [warp.turn(room.shape, degrees, (3, 2)) for degrees in (-1.5, 0, 1.2, -0.9)]
    taken = camera.shoot(room, camera.times_around(room, 4, stops=1.5), offsets=turned, rng=1)
    (warning,) = pipeline.assemble(taken, align="mtb").warnings
    assert "rotates" in warning and "frame" in warning


@pytest.mark.parametrize(("degrees", "is_reported"), [(0, False), (0.3, True)])
def test_a_small_rotation_that_no_shift_undoes_is_reported_and_the_method_that_does_it(
    degrees, is_reported
):
    street = scenes.street((340, 510))
    turned = [warp.turn(street.shape, angle, (3, -2)) for angle in (0, degrees)]
    taken = camera.shoot(street, camera.times_around(street, 2, stops=1.5), offsets=turned, rng=1)
    warnings = next(pipeline.assemble_steps(taken, align="mtb")).warnings
    assert len(warnings) == is_reported
    assert all("--align auto" in warning for warning in warnings)


def by_percentile(monkeypatch, **validations):
    """Return which offset is chosen among those at the median and at two other percentiles."""
    answers = {
        q: replace(
            alignment.validation.uninformative(0, 1),
            moving=q,
            **({"failure": "", "confidence": 0.95, "offset": (4, 0)} | validations.get(name, {})),
        )
        for q, name in ((50, "median"), (83, "high"), (17, "low"))
    }
    monkeypatch.setattr(alignment.mtb, "percentile", lambda *_, near: near)
    monkeypatch.setattr(alignment.validation, "compare_bits", lambda *_: None)
    monkeypatch.setattr(
        alignment.validation, "validate", lambda _, H, limit: answers[round(H[1, 2])]
    )
    B = SimpleNamespace(h=[0], offset_onto=lambda A, q: (100 * q, 0))
    A = SimpleNamespace(h=[0], Y=[0], overview=0, threshold=lambda q, level: 0)
    return alignment.best_percentile(0, B, 1, A).moving


@pytest.mark.quick
def test_another_percentile_is_used_if_the_median_fails_and_it_is_confident_and_differs(
    monkeypatch,
):
    lost = {"failure": "turned", "offset": (0, 0)}
    assert by_percentile(monkeypatch) == 50
    assert by_percentile(monkeypatch, median=lost) == 83
    for wrong in (
        {"failure": "turned"},
        {"confidence": alignment.MIN_OTHER_CONFIDENCE},
        {"offset": (0, 2)},
    ):
        assert by_percentile(monkeypatch, median=lost, high=wrong) == 17
        assert by_percentile(monkeypatch, median=lost, high=wrong, low=wrong) == 50
    assert by_percentile(monkeypatch, median=lost, high={"offset": (0, 3)}) == 83


# 640 x 384 pixels, of which the hand's shifts cost some
LARGE = (400, 656)


def taken_by_hand(scene, degrees, seed=0):
    """Return a bracket of four photos rotated by up to so many degrees, and the true homographies."""
    rng = np.random.default_rng(seed)
    E = getattr(scenes, scene)(LARGE)
    moves = [
        warp.turn(E.shape, degrees * sign, rng.uniform(-8, 8, 2)) for sign in (1, -0.8, 0, 0.9)
    ]
    moves[2] = np.eye(3)
    taken = camera.shoot(E, camera.times_around(E, 4, stops=1.5), offsets=moves, rng=rng)
    return taken, hand_motion.frame_homographies(moves, E.shape)


def misregistration(homographies, truth, shape):
    """Return the 95th percentile of the displacement in pixels, for the worst photo."""
    y, x = np.mgrid[0 : shape[0] : 20, 0 : shape[1] : 20]
    points = np.stack([x.ravel(), y.ravel()], axis=-1)
    off = warp.apply(homographies, points) - warp.apply(np.linalg.inv(truth[2]) @ truth, points)
    return np.quantile(np.hypot(off[..., 0], off[..., 1]), 0.95, axis=1).max()


@pytest.mark.parametrize("degrees", [0.1, 0.3, 2])
@pytest.mark.parametrize("scene", ["chapel", "street"])
def test_auto_finds_small_and_large_rotations_to_a_fraction_of_a_pixel(scene, degrees):
    taken, truth = taken_by_hand(scene, degrees)
    registration = register(taken.images)
    assert misregistration(registration.homographies, truth, taken.images.shape[1:3]) < 0.4
    assert all(pair.confirmed for pair in registration.pairs)


@pytest.mark.parametrize(("scene", "degrees"), [("chapel", 0.05), ("room", 0.08)])
def test_auto_finds_a_displacement_of_half_a_pixel_in_dark_photos(scene, degrees):
    taken, truth = taken_by_hand(scene, degrees, seed=4)
    registration = register(taken.images)
    assert misregistration(registration.homographies, truth, taken.images.shape[1:3]) < 0.4


def test_auto_does_not_resample_photos_from_a_tripod():
    room = scenes.room(LARGE)
    taken = camera.shoot(room, camera.times_around(room, 4, stops=1.5), rng=1)
    registration = register(taken.images)
    assert registration.method == "none" and all(pair.confirmed for pair in registration.pairs)


def test_well_exposed_photos_that_do_not_fit_are_reported_and_change_no_times():
    shots = [
        shoot([(0, 0)], [1, 4, 16][j : j + 1], texture=[astronaut, coffee][j % 2]())
        for j in range(3)
    ]
    mixed = bracket(np.concatenate(shots), [1, 4, 16])
    assembly = pipeline.assemble(mixed, align="auto", response="linear")
    assert assembly.warnings and "align" in assembly.warnings[0]
    assert np.array_equal(assembly.bracket.times, mixed.times)
    assert assembly.moving is None


def test_a_bright_disc_that_drifts_on_a_black_ground_is_aligned_by_its_outline():
    y, x = np.mgrid[0:120, 0:160]
    photos = []
    for number, time in enumerate([1, 8, 64]):
        disc = np.hypot(y - 70 + 5 * number, x - 50 - 12 * number) < 16
        light = time * np.where(disc, 0.2, 1e-5)
        photos.append((255 * np.clip(light, 0, 1) ** 0.45).astype(np.uint8))
    homographies = register(np.stack(photos)).homographies
    assert np.abs(homographies[:, :2, 2] - [[12, -5], [0, 0], [-12, 5]]).max() < 0.3
