"""Burst photography: tiles find their offsets, noise falls, and what moves leaves no ghost.

X        frames     (N, H, W), the reference first; 1 is a full well
truth    radiance of the moment of the reference, in the unit of the frames
bound    noise of the mean of N frames, that of one frame divided by sqrt(N)
"""

from dataclasses import dataclass

import numpy as np
import pytest
from skimage import data

from hdrlab import scenes
from hdrlab.beyond.burst import temporal_merge, tile_alignment
from hdrlab.capture import camera, movers, sensor
from hdrlab.capture.hand_motion import views
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError

FRAME_COUNT = 8
FULL_WELL = 5000
READ_NOISE = 5
SHOT = 1 / FULL_WELL
READ = (READ_NOISE / FULL_WELL) ** 2
# pixels at the border of a photo, which not all frames saw
BORDER = 24


def texture(shape=(160, 192)):
    """Return a photo of gravel, 0 to 1: each tile of it differs from its neighbors."""
    return (data.gravel()[: shape[0], : shape[1]] / 255).astype(np.float32)


def still(frames):
    """Return offsets of 0 for all tiles of some frames."""
    grid = tile_alignment.tile_grid(np.shape(frames)[1:3])
    return np.zeros((len(frames), *grid, 2), int)


def merge(frames, offsets=None, **options):
    offsets = still(frames) if offsets is None else offsets
    return temporal_merge.merge(frames, offsets, **{"shot": SHOT, "read": READ, **options})


def rms(x):
    return float(np.sqrt(np.mean(np.square(x))))


def inside(image):
    return image[BORDER:-BORDER, BORDER:-BORDER]


def expose(X, rng):
    N = sensor.photons(X, full_well=FULL_WELL, rng=rng)
    return sensor.readout(N, read_noise=READ_NOISE, rng=rng) / FULL_WELL


@dataclass(frozen=True, kw_only=True)
class Burst:
    """A simulated burst, what the reference saw without noise, and where a ball stood in any frame."""

    frames: np.ndarray
    truth: np.ndarray
    moving: np.ndarray

    @property
    def noise(self):
        return np.sqrt(SHOT * self.truth + READ)


def means_of_4(X):
    """Return the means of blocks of 2 x 2 pixels."""
    rows, columns = X.shape
    return X.reshape(rows // 2, 2, columns // 2, 2).mean(axis=(1, 3))


def hand_held_chapel(*, radiance=0.2, step=12, seed=0):
    """Return 8 short photos of the chapel by a shaking hand, in front of which a ball flies."""
    L = luminance(scenes.chapel())
    X = np.minimum(0.9 * L / np.quantile(L, 0.99), 0.95).astype(np.float32)
    ball = movers.ball(X.shape, (300, 250), 40, radiance)
    shake = camera.shake(FRAME_COUNT, rng=1)
    offsets = shake - shake[0]
    rng = np.random.default_rng(seed)
    frames = []
    masks = []
    for z in range(FRAME_COUNT):
        moment, mask = movers.compose_moment(X, ball, (0, step * z))
        frames.append(expose(views(moment, offsets)[z], rng))
        masks.append(views(mask, offsets)[0])
    truth = views(movers.compose_moment(X, ball, (0, 0))[0], offsets)[0]
    return Burst(frames=np.stack(frames), truth=truth, moving=np.max(masks, axis=0) > 0)


# Alignment


@pytest.mark.parametrize("offset", [(0, 0), (3, -5), (-12, 9), (17, 14)])
def test_each_tile_finds_a_shift_of_whole_pixels(offset):
    frames = np.stack(views(texture((240, 256)), [(0, 0), offset]))
    found = tile_alignment.align(frames)
    assert not found[0].any()
    assert (inside_tiles(found[1]) == offset).all()


def inside_tiles(offsets, border=6):
    """Return the offsets of tiles that all frames saw, also at the coarse levels."""
    return offsets[border:-border, border:-border]


def test_tiles_of_an_object_move_with_it_and_the_others_stay():
    """A square of another texture moves by (4, 6) pixels over a background at rest."""
    X = texture((192, 192))
    piece = np.ascontiguousarray(X[:80, :80].T)
    before, after = X.copy(), X.copy()
    before[48:128, 48:128] = piece
    after[52:132, 54:134] = piece
    found = tile_alignment.align([before, after])[1]
    on_object = found[9:14, 9:14]  # middles from pixel 72 to 104, 16 pixels inside
    assert (on_object == (-4, -6)).all()
    assert not found[20:].any() and not found[:, 20:].any()


def test_search_returns_the_offset_with_the_smallest_distance_of_all():
    """A slow search, tile by tile with np.roll, agrees."""
    rng = np.random.default_rng(3)
    X0, Xz = rng.random((2, 64, 64), np.float32)
    start = np.zeros((*tile_alignment.tile_grid(X0.shape), 2), int)
    T0 = tile_alignment.cut_tiles(X0, start)
    found = tile_alignment.search(T0, Xz, start, 2, tile_alignment.l1_distance)
    y, x = 3, 4  # the tile of pixels 16 to 31 and 24 to 39
    part = (slice(16, 32), slice(24, 40))
    errors = {}
    for down in range(-2, 3):
        for right in range(-2, 3):
            moved = np.roll(Xz, (down, right), axis=(0, 1))
            errors[down, right] = np.abs(X0 - moved)[part].sum()
    assert tuple(found[y, x]) == min(errors, key=errors.get)


def test_a_fine_tile_may_start_from_a_neighbor_of_its_coarse_tile():
    """Only one coarse tile has seen the shift. Its four neighbors' fine tiles find it as well."""
    frames = views(texture((240, 256)), [(0, 0), (8, 8)])
    grid = tile_alignment.tile_grid(frames[0].shape)
    coarse = np.zeros((15, 15, 2), int)
    coarse[6, 6] = 4
    T0 = tile_alignment.cut_tiles(frames[0], np.zeros((*grid, 2), int))
    starts = tile_alignment.candidates(coarse, grid)
    chosen = tile_alignment.choose(T0, frames[1], starts, tile_alignment.l1_distance)
    for i, j in [(12, 12), (10, 12), (14, 12), (12, 10), (12, 14)]:
        assert tuple(chosen[i, j]) == (8, 8)
    assert tuple(chosen[20, 20]) == (0, 0)


def test_steps_go_from_the_coarsest_level_to_the_frame_itself():
    frames = views(texture(), [(0, 0), (5, 4)])
    states = list(tile_alignment.align_steps(*frames))
    assert [state.level for state in states] == [3, 2, 1, 0]
    assert np.array_equal(states[-1].offsets, tile_alignment.align(frames)[1])


# Merge


@pytest.mark.parametrize("tuning", [0.0, 1.0, 1e9])
def test_a_still_burst_without_noise_returns_its_frame(tuning):
    X = texture((100, 77))
    merged = merge([X] * 4, tuning=tuning, shot=0, read=0)
    assert merged.shape == X.shape
    assert np.allclose(merged, X, atol=1e-6)


def test_windows_that_overlap_by_half_add_up_to_1():
    w = temporal_merge.raised_cosine(16)
    assert np.allclose(w[:8] + w[8:], 1)
    assert np.allclose(w, w[::-1])


def test_without_tuning_the_merge_is_the_reference_and_with_much_the_mean():
    rng = np.random.default_rng(0)
    X = rng.random((5, 64, 80), np.float32)
    assert np.allclose(merge(X, tuning=0), X[0], atol=1e-5)
    assert np.allclose(merge(X, tuning=1e12), X.mean(axis=0), atol=1e-5)


def test_twice_the_light_gives_twice_the_result():
    rng = np.random.default_rng(1)
    X = texture() + rng.normal(0, 0.02, (6, 160, 192)).astype(np.float32)
    merged = merge(X, shot=0.001, read=4e-4)
    doubled = merge(2 * X, shot=0.002, read=16e-4)
    assert np.allclose(doubled, 2 * merged, atol=1e-5)


def test_a_difference_as_large_as_the_noise_has_a_shrinkage_of_1_over_1_plus_c():
    variance = 0.03
    D = np.full((16, 16), np.sqrt(2 * 16**2 * variance), complex)
    assert np.allclose(temporal_merge.shrinkage(D, variance, 3.0), 1 / (1 + 3))


def test_noise_of_two_frames_has_a_mean_power_of_2_n_squared_variance():
    """This is the unit of the tuning constant, here measured."""
    rng = np.random.default_rng(2)
    T = rng.normal(0, 0.1, (2, 4000, 16, 16))
    D = np.fft.fft2(T[0]) - np.fft.fft2(T[1])
    assert np.mean(np.abs(D) ** 2) == pytest.approx(2 * 16**2 * 0.1**2, rel=0.01)


def expected_noise(frame_count, tuning):
    """Return the noise of the merge, relative to one frame, from random Fourier coefficients alone."""
    rng = np.random.default_rng(5)
    F = rng.normal(size=(frame_count, 200_000)) + 1j * rng.normal(size=(frame_count, 200_000))
    D = F[0] - F
    u = np.abs(D) ** 2 / 4  # |F|^2 has a mean of 2, so |D|^2 has one of 4
    return rms(np.abs(np.mean(F + u / (u + tuning) * D, axis=0))) / rms(np.abs(F))


@pytest.mark.parametrize("frame_count", [2, 4, 8])
@pytest.mark.parametrize("tuning", [1.0, 12.0, 1e9])
def test_noise_of_a_still_burst_falls_as_the_formula_says(frame_count, tuning):
    rng = np.random.default_rng(4)
    X = 0.5 + rng.normal(0, 0.01, (frame_count, 200, 200))
    merged = merge(X, shot=0, read=0.01**2, tuning=tuning)
    assert rms(merged - 0.5) / 0.01 == pytest.approx(expected_noise(frame_count, tuning), rel=0.03)


@pytest.mark.parametrize(("tuning", "limit"), [(12.0, 1.1), (temporal_merge.TUNING, 1.35)])
def test_noise_of_8_still_frames_is_near_the_bound(tuning, limit):
    assert expected_noise(FRAME_COUNT, tuning) * np.sqrt(FRAME_COUNT) < limit


def test_a_moving_square_leaves_no_ghost():
    """A bright square stands elsewhere in each frame. In the merge it stands only in the reference."""
    rng = np.random.default_rng(6)
    truth = np.full((FRAME_COUNT, 128, 160), 0.1)
    for z in range(FRAME_COUNT):
        truth[z, 48:72, 16 + 16 * z : 36 + 16 * z] = 0.6
    X = truth + rng.normal(0, 0.01, truth.shape)
    merged = merge(X, shot=0, read=0.01**2)
    trail = (slice(48, 72), slice(36, 148))
    average = np.mean(X, axis=0)
    assert rms((average - truth[0])[trail]) > 0.05
    assert rms((merged - truth[0])[trail]) < rms((X[0] - truth[0])[trail])


def test_channels_are_merged_separately():
    rng = np.random.default_rng(7)
    X = rng.random((3, 40, 48, 3), np.float32)
    merged = merge(X, tuning=1.0)
    for k in range(3):
        assert np.array_equal(merged[..., k], merge(X[..., k], tuning=1.0))


@pytest.mark.papers
@pytest.mark.parametrize(("radiance", "step"), [(0.05, 12), (0.2, 12), (0.8, 12), (0.2, 3)])
@pytest.mark.parametrize(("tuning", "limit"), [(12.0, 1.1), (temporal_merge.TUNING, 1.35)])
def test_hand_held_burst_is_near_the_bound_and_has_no_ghosts(radiance, step, tuning, limit):
    """Compared with the known radiance: where nothing moved, and where the ball did."""
    burst = hand_held_chapel(radiance=radiance, step=step)
    merged = temporal_merge.align_and_merge(burst.frames, shot=SHOT, read=READ, tuning=tuning)
    error = (merged - burst.truth) / burst.noise
    assert rms(inside(error)[~inside(burst.moving)]) * np.sqrt(FRAME_COUNT) < limit
    single = (burst.frames[0] - burst.truth)[burst.moving]
    assert rms((merged - burst.truth)[burst.moving]) < rms(single)


@pytest.mark.papers
def test_a_hand_that_moves_by_half_pixels_leaves_less_error_than_one_frame_also_at_edges():
    """Each pixel is the mean of 2 x 2 pixels of a larger scene, which moves by whole ones of those."""
    L = luminance(scenes.street((512, 768)))
    X = np.minimum(0.8 * L / np.quantile(L, 0.985), 1)
    rng = np.random.default_rng(1)
    offsets = rng.integers(-6, 7, (FRAME_COUNT, 2))
    offsets[0] = 0
    moments = [means_of_4(np.roll(X, offset, axis=(0, 1))) for offset in offsets]
    truth = moments[0]
    frames = np.stack([expose(moment, rng) for moment in moments])
    merged = temporal_merge.align_and_merge(frames, shot=SHOT, read=READ)
    slope = np.hypot(*np.gradient(truth))
    is_edge = inside(slope > np.quantile(slope, 0.9))
    merged_error = inside(merged - truth)
    single_error = inside(frames[0] - truth)
    assert rms(merged_error) < 0.8 * rms(single_error)
    assert rms(merged_error[is_edge]) < rms(single_error[is_edge])


def test_errors_name_what_was_expected():
    X = np.zeros((2, 32, 32), np.float32)
    with pytest.raises(InputError, match="offsets"):
        merge(X, np.zeros((2, 3, 3, 2), int))
    with pytest.raises(InputError, match="whole offsets"):
        merge(X, still(X) + 0.5)
    with pytest.raises(InputError, match="frames"):
        tile_alignment.align(X[0])
    with pytest.raises(InputError, match="even side"):
        tile_alignment.align(X, tile_side=15)
    with pytest.raises(InputError, match="at least 0"):
        merge(X, tuning=-1)
