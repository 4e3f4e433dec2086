"""What registration by light promises the command line: homographies, and a reason where one is not right."""

import numpy as np
import pytest
import scipy
from hypothesis import given, settings, strategies as st
from skimage.data import astronaut

from hdrlab import scenes
from hdrlab.align import cerman, light
from hdrlab.capture import camera, hand_motion
from hdrlab.capture.responses import true_g
from hdrlab.core.filters import warp
from hdrlab.diagnostics import registration
from hdrlab.diagnostics.registration import MIN_CONFIDENCE
from hdrlab.pipeline.alignment import register

pytestmark = pytest.mark.papers

SHAPE = (110, 160)


@pytest.fixture(scope="module")
def room():
    return scenes.room(SHAPE)


def shoot(E, moves, *, stops=2.0, response="film", bits=8, rng=1, count=None):
    """Return photographs of a moved camera, and the moves in their own pixels."""
    times = camera.times_around(E, count or len(moves), stops=stops)
    model = camera.Camera(response=response, bits=bits, full_well=20_000, read_noise=5)
    taken = camera.shoot(E, times, model, offsets=moves, rng=rng)
    return taken, hand_motion.frame_homographies(moves, E.shape)


def off(found, truth, shape=SHAPE):
    """Return the worst error of moves at the corners, pixels, relative to the last frame."""
    ours, theirs = (np.linalg.inv(one[-1]) @ one for one in (found, truth))
    return float(warp.corner_distance(ours, theirs, shape).max())


def validation(images, **knobs):
    (one,) = register(images, "cerman", **knobs).pairs
    return one


def test_a_correct_homography_gives_no_warning_and_reports_rotation_and_offset(room):
    taken, truth = shoot(room, [warp.turn(SHAPE, 2, (5.5, -3.25)), np.eye(3)])
    one = validation(taken.images, times=taken.times, g=true_g())
    assert one.reliable and one.confidence > 0.6 and one.after < one.before / 4
    assert (
        one.degrees == pytest.approx(2, abs=0.1)
        and np.abs(np.array(one.offset) - (5.5, -3.25)).max() < 0.3
    )


@pytest.mark.parametrize("level", [0, 255])
def test_a_black_or_white_frame_is_reported_and_stays(room, level):
    taken, _ = shoot(room, [np.eye(3), np.eye(3)])
    images = np.stack([taken.images[1], np.full_like(taken.images[0], level)])
    one = validation(images, g=true_g())
    assert not one.informative and "uninformative" in one.failure
    assert np.array_equal(register(images, "cerman", g=true_g()).homographies, [np.eye(3)] * 2)


def test_unrelated_photos_are_reported_and_not_moved(room):
    other = np.random.default_rng(0).integers(20, 230, (2, *SHAPE), np.uint8)
    one = validation(other, times=[1, 1], g=true_g())
    assert one.confidence < MIN_CONFIDENCE and "fit nearly as well" in one.failure


@pytest.mark.parametrize("period", [7, 12])
def test_a_periodic_image_is_reported(period):
    y, x = np.indices((170, 240)) * 2 * np.pi / period
    E = np.repeat((10 ** (0.3 * np.sin(x) * np.sin(y)))[..., None], 3, axis=2).astype(np.float32)
    taken, _ = shoot(E, [[9, -14], [0, 0]])
    one = validation(taken.images, times=taken.times, g=true_g())
    assert not one.reliable


def test_motion_in_a_quarter_of_the_scene_is_reported(room):
    taken, _ = shoot(room, [np.eye(3), np.eye(3)])
    images = taken.images.copy()
    images[0, :55, :80] = np.roll(images[0], (5, 3), axis=(0, 1))[:55, :80]
    assert "quarters" in validation(images, times=taken.times, g=true_g()).failure


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=4)
def test_the_found_homography_never_has_a_larger_error_than_none(seed):
    images = np.random.default_rng(seed).integers(0, 256, (2, 70, 90), dtype=np.uint8)
    one = validation(images, g=true_g())
    assert one.after <= one.before and (np.array_equal(one.H, np.eye(3)) or one.after < one.before)


@pytest.mark.parametrize("response", ["film", "srgb", "linear"])
def test_alignment_within_a_pixel_needs_neither_times_nor_response(response):
    E = (10 ** (2.0 * astronaut()[60:240, 120:360] / 255)).astype(np.float32)
    taken, truth = shoot(E, [warp.turn(E.shape, 1.5, (5.5, -3)), np.eye(3)], response=response)
    assert off(register(taken.images, "cerman").homographies, truth, E.shape) < 1


@pytest.mark.parametrize("shape", [(1, 1), (1, 300), (10, 10), (33, 63)])
def test_small_frames_are_aligned_without_an_error(shape):
    images = np.random.default_rng(0).integers(0, 256, (3, *shape), dtype=np.uint8)
    for method in ("mtb", "cerman"):
        assert register(images, method).homographies.shape == (3, 3, 3)


def test_a_single_frame_is_not_moved():
    images = np.zeros((1, 40, 50), np.uint8)
    for method in ("mtb", "cerman", "auto"):
        found = register(images, method)
        assert np.array_equal(found.homographies, [np.eye(3)]) and found.pairs == ()


@pytest.mark.parametrize(
    ("images", "knobs", "said"),
    [
        (np.zeros((2, 8, 8)), {}, "uint8 or uint16"),
        (np.zeros((8, 8), np.uint8), {}, "stack of images"),
        (np.zeros((2, 8, 8), np.uint8), {"times": [1]}, "expected 2 exposure times"),
        (np.zeros((2, 8, 8), np.uint8), {"times": [1, -1]}, "positive exposure times"),
        (np.zeros((2, 8, 8), np.uint8), {"g": [np.nan] * 256}, "finite table"),
    ],
)
def test_invalid_images_times_or_responses_raise_an_error(images, knobs, said):
    for method in ("cerman", "homography", "auto"):
        with pytest.raises(ValueError, match=said):
            register(images, method, **knobs)


@pytest.mark.parametrize("seed", range(3))
def test_a_rival_is_a_peak_of_the_autocorrelation_of_light_less_its_local_mean(seed):
    rng = np.random.default_rng(seed)
    texture = np.tile(rng.random((12, 17)), (6, 5))[:64, :80] + 0.1 * rng.random((64, 80))
    texture[5:9, 7:12] = np.nan  # measures nothing
    texture = texture.astype(np.float32)
    x = np.where(np.isfinite(texture), texture - light.local_mean(texture), 0)
    c = scipy.fft.fftshift(
        scipy.fft.irfft2(np.abs(scipy.fft.rfft2(x, (128, 160))) ** 2, (128, 160))
    )
    found = cerman.peaks(c[:, 80:], registration.RIVAL_COUNT + 1) + [0, 40]  # c is symmetric
    expected = [one for one in found.tolist() if max(np.abs(one)) > registration.NEAR_PIXELS]
    assert np.array_equal(registration.rivals(texture), expected)
