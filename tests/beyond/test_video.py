"""HDR video from alternating exposures, and tone mapping without flicker, on films with a known truth."""

import numpy as np
import pytest

from hdrlab.beyond import flow, neighbours, steady, video
from hdrlab.capture import camera, movers
from hdrlab.capture.responses import true_g
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError
from hdrlab.fast.merge import merge
from hdrlab.scenes.places import layers
from hdrlab.tonemap import reinhard

G = true_g("film")


def psnr(E, truth):
    """Return the PSNR of log2 radiance, dB, over the truth's range; its darkest per cent counts as black."""
    floor = np.quantile(truth, 0.01)
    a = np.log2(np.maximum(E, floor))
    b = np.log2(np.maximum(truth, floor))
    return 20 * np.log10(np.ptp(b) / np.sqrt(np.mean((a - b - np.median(a - b)) ** 2)))


@pytest.fixture(scope="module")
def film():
    """Five frames, alternating four stops apart: the camera pans, and a visitor crosses the street."""
    place = layers("street", (56, 90))
    count = 5
    at = movers.path(count, (0, 4))
    pan = np.stack([np.zeros(count, int), np.arange(count)], axis=-1)
    middle = camera.times_around(place.radiance, 1)[0]
    t = middle * np.where(np.arange(count) % 2, 1 / 4, 4)
    rng = np.random.default_rng(0)
    frames = []
    truth = []
    for j in range(count):
        seen, _ = movers.compose_moment(
            place.radiance, movers.Figure(place.mover, place.mask), at[j]
        )
        truth.append(camera.views(seen, pan)[j])
        shot = camera.shoot(
            truth[-1], t[j : j + 1], camera.Camera(full_well=20000, read_noise=5), rng=rng
        )
        frames.append(shot.images[0])
    return np.stack(frames), t, np.stack(truth)


@pytest.fixture(scope="module")
def states(film):
    return list(video.merge_steps(*film[:2], G))


def smooth(shape=(48, 64)):
    y, x = np.indices(shape)
    return np.float32(0.5 + 0.2 * np.sin(x / 5) * np.cos(y / 4) + 0.2 * np.sin((x + y) / 9))


@pytest.mark.parametrize("move", [(0, 3), (2, -4)])
def test_the_flow_of_a_shifted_image_is_the_shift(move):
    a = smooth()
    b = np.roll(a, move, axis=(0, 1))
    u = flow.tvl1(a, b)
    inside = np.s_[8:-8, 8:-8]
    assert np.abs(u[:, *inside] - np.array(move).reshape(2, 1, 1)).max() < 0.3
    assert np.abs(flow.warp(b, u) - a)[inside].max() < 0.02
    assert not flow.lands_inside(np.full((2, 48, 64), 50.0)).any()
    assert flow.lands_inside(np.zeros((2, 48, 64))).all()


def test_half_of_a_flow_meets_in_the_middle():
    a = smooth()
    b = np.roll(smooth(), 4, axis=1)
    middle = np.roll(a, 2, axis=1)
    half_forward, half_backward = flow.halve_flow(flow.tvl1(a, b))
    there = flow.warp(a, half_forward)
    back = flow.warp(b, half_backward)
    inside = np.s_[8:-8, 10:-10]
    assert np.abs(there - middle)[inside].max() < 0.02
    assert np.abs(back - middle)[inside].max() < 0.02


def test_a_pixel_is_warped_as_a_line_between_pixels():
    f = np.float32([[0, 1, 4], [0, 1, 4]])
    u = np.zeros((2, 2, 3), np.float32)
    u[1] = 0.5
    assert flow.warp(f, u).tolist() == [[0.5, 2.5, 4], [0.5, 2.5, 4]]


def test_consistency_is_1_for_equal_values_and_0_from_16_levels_on():
    v = np.zeros((1, 3, 1), np.float32)
    v_ = np.float32([[[0], [8 / 255], [16 / 255]]])
    assert video.consistency(v, v_).ravel().tolist() == pytest.approx([1, 0.5, 0], abs=1e-6)


def test_slide_windows_yields_the_neighbors_of_each_item():
    for count in range(6):
        for span in range(4):
            windows = list(neighbours.slide_windows(range(count), span))
            assert [around[place] for place, around in windows] == list(range(count))
            for i, (_, around) in enumerate(windows):
                assert list(around) == list(range(max(0, i - span), min(count, i + span + 1)))


@pytest.mark.papers
def test_each_frame_is_nearer_to_its_moment_than_a_plain_merge_and_than_the_frame_alone(
    film, states
):
    frames, t, truth = film
    for i, state in enumerate(states):
        near = slice(max(i - 1, 0), i + 2)
        ours = psnr(state.E, truth[i])
        assert ours > psnr(merge(frames[near], t[near], G), truth[i]) + 2
        assert ours > psnr(state.alone, truth[i])


def test_a_still_film_is_as_good_as_a_bracket():
    E = layers("workshop", (48, 72)).radiance
    t = camera.times_around(E, 2, stops=4)
    rng = np.random.default_rng(0)
    frames = [
        camera.shoot(E, [t[j % 2]], camera.Camera(full_well=20000, read_noise=5), rng=rng).images[0]
        for j in range(3)
    ]
    times = [t[j % 2] for j in range(3)]
    E_ = video.merge(frames, times, G)[1]
    assert psnr(E_, E) > psnr(merge(np.stack(frames), times, G), E) - 0.5


def test_the_result_is_consistent_with_each_frame(film, states):
    frames, t, _ = film
    for Z, time, state in zip(frames, t, states, strict=True):
        top = np.exp(G[Z]) / time
        full = Z > 0.98 * 255
        assert np.all(state.E[full] >= 0.999 * top[full])
        well = (Z > 30) & (Z < 220)
        assert np.abs(state.E / top - 1)[well].max() < 0.25


def test_another_flow_can_be_put_in_its_place(film):
    def none(a, b):
        return np.zeros((2, *a.shape), np.float32)

    frames, t, truth = film
    still = video.merge(frames[:3], t[:3], G, flow=none)
    assert psnr(video.merge(frames[:3], t[:3], G)[1], truth[1]) > psnr(still[1], truth[1]) + 0.5


def test_frames_are_merged_as_they_come(film):
    """The first frame is finished after the second one, so a film need not fit into memory."""
    frames, t, _ = film
    taken = []
    steps = video.merge_steps((taken.append(j) or frame for j, frame in enumerate(frames)), t, G)
    assert next(steps).frame == 0 and taken == [0, 1]
    assert next(steps).frame == 1 and taken == [0, 1, 2]


def test_gray_frames_give_gray_radiance(film):
    frames, t, _ = film
    E = video.merge(frames[:3, ..., 1], t[:3], G)
    assert E.shape == frames[:3, ..., 1].shape and np.isfinite(E).all()


def test_black_and_full_frames_give_finite_radiance():
    frames = [np.full((20, 24, 3), level, np.uint8) for level in (0, 255, 0, 255)]
    E = video.merge(frames, [1, 4, 1, 4], G)
    assert np.isfinite(E).all() and E.min() >= 0


@pytest.mark.parametrize(
    "call",
    [
        lambda: video.merge([], [1], G),
        lambda: video.merge([np.zeros((20, 20), np.uint8)], [], G),
        lambda: video.merge([np.zeros((20, 20), np.uint8)] * 2, [1, -1], G),
        lambda: video.merge([np.zeros((20, 20))], [1], G),
        lambda: video.merge(
            [np.zeros((20, 20), np.uint8), np.zeros((20, 21), np.uint8)], [1, 2], G
        ),
        lambda: steady.flicker([np.zeros((2, 2))] * 2),
        lambda: list(steady.tonemap_steps([np.ones((2, 2))], reinhard.tonemap, key=0)),
        lambda: list(steady.tonemap_steps([np.ones((2, 2))], reinhard.tonemap, span=-1)),
        lambda: list(steady.tonemap_steps([-np.ones((2, 2))], reinhard.tonemap)),
    ],
)
def test_invalid_arguments_raise_an_error(call):
    with pytest.raises(InputError):
        call()


@pytest.mark.papers
def test_exposure_times_repeat_cyclically(film):
    frames, t, _ = film
    assert np.array_equal(video.merge(frames, t[:2], G), video.merge(frames, t, G))


def test_span_0_equals_tone_mapping_each_frame_alone():
    L = luminance(layers("chapel", (24, 36)).radiance)
    (state,) = steady.tonemap_steps([L], reinhard.tonemap, span=0)
    assert state.own == pytest.approx(reinhard.log_average(L), rel=1e-6)
    assert np.allclose(state.Ld, reinhard.tonemap(L), atol=1e-5)


def test_a_film_of_one_picture_looks_like_that_picture():
    L = luminance(layers("chapel", (24, 36)).radiance)
    for state in steady.tonemap_steps([L] * 4, reinhard.tonemap):
        assert np.allclose(state.Ld, reinhard.tonemap(L), atol=1e-5)


def test_the_adaptation_is_the_geometric_mean_of_the_frames_around():
    frames = [np.full((3, 3), level, np.float32) for level in (1.0, 10.0, 100.0)]
    averages = [state.average for state in steady.tonemap_steps(frames, reinhard.tonemap)]
    assert averages == pytest.approx([10**0.5, 10, 10**1.5], rel=1e-4)


def test_flicker_measures_alternation_and_not_steady_change():
    assert steady.flicker(np.full((2, 2), 0.5) for _ in range(5)) == 0
    levels = np.linspace(0.2, 0.8, 7) ** 2.2
    assert steady.flicker(np.full((2, 2), y) for y in levels) < 0.3
    assert steady.flicker(np.full((2, 2), y) for y in (0.4, 0.5) * 3) > 4


def test_steady_adaptation_reduces_flicker_from_a_blinking_lamp():
    room = luminance(layers("workshop", (32, 48)).radiance)
    lamp = room.copy()
    lamp[4:10, 4:10] = 50 * room.max()
    frames = [room, lamp, room, lamp, room, room, lamp, room]
    dark = np.s_[16:]
    alone = steady.flicker(
        state.Ld[dark] for state in steady.tonemap_steps(frames, reinhard.tonemap, span=0)
    )
    together = steady.flicker(
        state.Ld[dark] for state in steady.tonemap_steps(frames, reinhard.tonemap, span=1)
    )
    assert together < 0.7 * alone


def test_frames_that_are_dimmer_than_white_are_not_pulled_up_to_it():
    """The white of a film is 1 or more, so a dark uniform room stays as dark as its key makes it."""
    dim = steady.measure_frame(np.full((8, 8), 3.0))
    average, white = steady.adapt([dim, dim], key=0.18)
    assert white == 1 and average == pytest.approx(3.0, rel=1e-3)
    bright = steady.measure_frame(np.where(np.eye(64) > 0, 3000.0, 3.0))
    assert steady.adapt([bright], key=0.18)[1] > 1


def test_too_small_images_have_zero_flow():
    a, b = np.random.default_rng(0).random((2, 15, 40)).astype(np.float32)
    assert not flow.tvl1(a, b).any()
