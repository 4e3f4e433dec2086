"""What `assemble` says of alignment: a doubt where photographs do not lie on each other, and nowhere else."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from brackets import MARGIN, H, W, bracket as shoot, photograph, radiance
from skimage.data import astronaut, coffee

from hdrlab import pipeline, scenes
from hdrlab.capture import camera
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
    """Return the first stage of `assemble` of photographs a factor of 16 apart."""
    return pipeline.align_bracket(bracket(images, 16.0 ** np.arange(len(images))), align)


def night(offsets, seed=0):
    """Return photographs of a street at night: nearly black but for lamps, and noisy."""
    rng = np.random.default_rng(seed)
    E = 1e-3 * radiance(coffee(), 1.0)
    for y, x in rng.integers(MARGIN, (MARGIN + H, MARGIN + W), (12, 2)):
        E[y : y + 4, x : x + 4] += 3
    return np.stack([photograph(E, 4.0**k, o, rng=rng, noise=0.02) for k, o in enumerate(offsets)])


@pytest.mark.parametrize("align", ["auto", "mtb"])
@pytest.mark.parametrize("texture", [astronaut, coffee])
def test_nearly_black_or_white_frames_from_a_tripod_give_no_warning(texture, align):
    images = shoot(STILL, TIMES, texture=texture(), decades=3.0)
    assert np.mean(images[0] < 12) > 0.8 and np.mean(images[-1] > 243) > 0.8
    found = aligned(images, align)
    assert not found.offsets.any() and found.doubts == ()
    assert found.notes == ()


@pytest.mark.parametrize("seed", range(3))
def test_a_night_scene_from_a_tripod_gives_no_warning(seed):
    found = aligned(night([(0, 0)] * 4, seed))
    assert not found.offsets.any() and found.doubts == ()


def test_a_frame_that_cannot_be_aligned_moves_with_its_neighbour_and_is_noted():
    images = shoot(HAND[1:4], [1, 4, 16])
    black = np.random.default_rng(0).integers(0, 3, images[:1].shape, dtype=np.uint8)
    found = aligned(np.concatenate([black, images]))
    assert np.array_equal(found.offsets[0], found.offsets[1]) and found.offsets[1].any()
    (detail,) = found.details
    assert "frame 1 and frame 2" in detail and found.doubts == ()


def test_misaligned_pairs_give_one_warning_that_says_what_to_do():
    shots = [
        shoot([(0, 0)], [1, 4, 16][j : j + 1], texture=[astronaut, coffee][j % 2]())
        for j in range(3)
    ]
    (doubt,) = aligned(np.concatenate(shots), "mtb").doubts
    assert "and 1 more pair" in doubt and "leave one out" in doubt


def test_the_search_range_grows_with_the_image_size():
    E = np.kron(radiance(astronaut()), np.ones((2, 2, 1)))
    rng = np.random.default_rng(0)
    views = [0.2 * t * E[y : y + 700, x : x + 900] for t, y, x in ((1, 10, 5), (4, 110, 95))]
    images = np.stack(
        [
            (255 * np.clip(one + 0.002 * rng.standard_normal(one.shape), 0, 1) ** 0.45)
            for one in views
        ]
    )
    found = register(images.astype(np.uint8), "mtb")
    assert (
        np.abs(np.subtract(found.pairs[0].offset, (-100, -90))).max() <= 1
        and found.pairs[0].reliable
    )


def test_the_validation_gives_the_same_result_at_every_image_size():
    rng = np.random.default_rng(3)
    images = shoot([(0, 0), (0, 0)], [1, 4], noise=0.02)
    for times in (1, 2, 4):
        large = np.kron(images, np.ones((1, times, times, 1))) + rng.normal(
            0, 2 * times, (2, H * times, W * times, 1)
        )
        (one,) = register(np.clip(large, 0, 255).astype(np.uint8), "mtb").pairs
        assert one.known and not one.apart and one.confidence > 0.9


def test_a_single_photo_is_not_moved():
    found = register(np.full((1, 40, 50), 90, np.uint8), "mtb")
    assert np.array_equal(found.homographies, [np.eye(3)]) and len(found.pairs) == 0


def test_rotated_photos_are_reported_once_and_not_as_motion_too():
    room = scenes.room((280, 420))
    turned = [warp.turn(room.shape, degrees, (3, 2)) for degrees in (-1.5, 0, 1.2, -0.9)]
    taken = camera.shoot(room, camera.times_around(room, 4, stops=1.5), offsets=turned, rng=1)
    (doubt,) = pipeline.assemble(taken, align="mtb").doubts
    assert "rotates" in doubt and "frame" in doubt


def by_percentile(monkeypatch, **validations):
    """Return which of the answers at the median and at the other two percentiles is taken."""
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


def improved(monkeypatch, side, **searches):
    """Return what is found of a pair that moved by (24, 40) pixels, its light measured on the left alone."""
    texture = np.random.default_rng(2).uniform(1, 2, (12, 14)).repeat(4, axis=0).repeat(4, axis=1)
    X = np.stack([texture[:40, :50], texture[3:43, 5:55]]).astype(np.float32)
    X[0, :, 25:] = np.nan
    for name, found in searches.items():
        states = [] if found is None else [SimpleNamespace(H=found)]
        monkeypatch.setitem(alignment.SEARCHES, name, lambda pyramid, states=states: iter(states))
    photograph = SimpleNamespace(
        overview=3, Y=[np.zeros((side, 400)), np.zeros((side // 2, 200)), 0, 0]
    )
    best = replace(alignment.validation.uninformative(0, 1), apart=True)
    return alignment.improve(best, "mtb", photograph, photograph, lambda *_: [X])


@pytest.mark.quick
def test_the_simplest_method_that_aligns_is_chosen_unless_it_leaves_little_overlap(
    monkeypatch,
):
    true, still = warp.as_homographies([(3, 5), (0, 0)])
    found, name = improved(monkeypatch, 100, cerman=true, homography=None)
    assert name == "cerman" and found.offset == pytest.approx((24, 40)) and not found.apart
    assert improved(monkeypatch, 100, cerman=still, homography=true)[1] == "homography"
    assert improved(monkeypatch, 100, cerman=still, homography=still)[1] == "mtb"
    assert improved(monkeypatch, 80, cerman=true, homography=true)[1] == "mtb"
