"""Patch-based HDR: closed forms, PatchMatch against an exhaustive search, scenes with a known truth."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from hdrlab.beyond import bidirectional, ldr_values, patches, patchmatch, synthesis
from hdrlab.capture import camera, movers
from hdrlab.capture.responses import true_g
from hdrlab.errors import InputError
from hdrlab.fast.merge import merge_with_quality
from hdrlab.scenes.places import layers

pytestmark = pytest.mark.papers

G = true_g("film")


def noise(shape, seed=0):
    return np.random.default_rng(seed).random(shape, np.float32)


def in_stops(E, truth):
    """Return log2 radiance; the darkest per cent of the truth counts as black."""
    return np.log2(np.maximum(E, np.quantile(truth, 0.01)))


def off(E, truth):
    """Return the error of radiance in stops, with the scale that fits best."""
    departure = in_stops(E, truth) - in_stops(truth, truth)
    return departure - np.median(departure)


def psnr(E, truth):
    """Return the PSNR of log2 radiance, dB, over the truth's range."""
    return 20 * np.log10(np.ptp(in_stops(truth, truth)) / np.sqrt(np.mean(off(E, truth) ** 2)))


@pytest.fixture(scope="module")
def walk():
    """A street in three photos three stops apart; a visitor walks eight pixels between two photos."""
    place = layers("street", (48, 72))
    times = camera.times_around(place.radiance, 3, stops=3)
    figure = movers.Figure(place.mover, place.mask)
    return movers.shoot(
        place.radiance,
        figure,
        movers.path(3, (0, 8)),
        times,
        camera.Camera(full_well=20000, read_noise=5),
    )


def test_patches_are_the_windows_of_a_picture():
    T = noise((7, 9, 3))
    P = patchmatch.cut_patches(T, 3)
    assert P.shape == (5, 7, 27)
    assert np.array_equal(np.sort(P[2, 4]), np.sort(T[2:5, 4:7].ravel()))


def test_the_patch_distance_is_the_sum_of_squares_plus_the_price():
    S = noise((2, 8, 9, 3))
    price = noise((2, 8, 9), 1)
    Q = patchmatch.make_sources(S, 3, price)
    P = patchmatch.cut_patches(noise((8, 9, 3), 2), 3)
    at = np.zeros((6, 7, 3), int)
    at[..., 0] = 1
    at[..., 1] = 3
    at[..., 2] = 2
    expected = ((P[4, 5] - patchmatch.cut_patches(S[1], 3)[3, 2]) ** 2).sum() + price[
        1, 3:6, 2:5
    ].sum()
    assert patchmatch.distance(P, Q, at)[4, 5] == pytest.approx(expected, rel=1e-5)


def test_patchmatch_finds_nearly_the_same_as_an_exhaustive_search():
    T = noise((14, 15, 1))
    S = noise((2, 16, 17, 1), 3)
    S[1, 3:13, 4:14] = T[2:12, 1:11]  # a part of T is to be found again
    P = patchmatch.cut_patches(T, 5)
    Q = patchmatch.make_sources(S, 5)
    best = ((P[:, :, None] - Q.rows) ** 2).sum(axis=-1).min(axis=-1)
    steps = patchmatch.search_steps(
        P,
        Q,
        patchmatch.start_field(P, Q, patchmatch.identity_field(10, 11)),
        radius=16,
        rng=np.random.default_rng(0),
    )
    states = [next(steps) for _ in range(12)]
    ratios = [float((field.d.mean()) / best.mean()) for field in states]
    assert np.all(np.diff(ratios) <= 1e-6) and ratios[-1] < 1.06
    assert np.array_equal(states[-1].at[3, 4], [1, 4, 7]) and states[-1].d[3, 4] < 1e-9


def test_upscale_field_scales_the_offsets():
    at = patchmatch.identity_field(6, 8, 1) + np.array([0, 1, -2])
    fine = patchmatch.upscale_field(at, (12, 16))
    assert np.all(fine[..., 0] == 1)
    assert np.array_equal(
        fine[..., 1:], patchmatch.identity_field(12, 16)[..., 1:] + np.array([2, -4])
    )


def test_voting_with_identity_matches_reproduces_the_image():
    S = noise((1, 10, 11, 3))
    P = patchmatch.cut_patches(S[0], 3)
    Q = patchmatch.make_sources(S, 3)
    field = patchmatch.start_field(P, Q, patchmatch.identity_field(8, 9))
    both = bidirectional.Matches(field, (field,))
    w = noise((1, 8, 9), 4)
    assert bidirectional.similarity(w, both) == 0
    assert np.allclose(bidirectional.vote(S, w, both, 3), S[0], atol=1e-6)


def test_missing_patches_lower_completeness_and_foreign_ones_lower_coherence():
    S = np.zeros((1, 16, 16, 1), np.float32)
    S[0, 5:9, 5:9] = 1
    T = np.zeros((16, 16, 1), np.float32)
    knobs = bidirectional.Search(5, 4, 16)
    at = patchmatch.identity_field(12, 12)
    rng = np.random.default_rng(0)
    free = np.zeros((1, 16, 16), np.float32)
    w = np.ones((1, 12, 12), np.float32)
    lacking = bidirectional.search(T, S, free, (at, (at,)), knobs, rng)
    assert lacking.coherence.d.max() == 0 and lacking.completeness[0].d.max() > 1
    alien = bidirectional.search(S[0], T[None], free, (at, (at,)), knobs, rng)
    assert alien.coherence.d.max() > 1 and alien.completeness[0].d.max() == 0
    assert bidirectional.similarity(w, lacking) > 0
    assert bidirectional.similarity(0 * w, lacking) == 0


@settings(max_examples=25, deadline=None)
@given(st.floats(1e-3, 1e3), st.floats(1e-3, 10))
def test_values_survive_a_round_trip_through_radiance(t, full):
    v = np.linspace(0, 1, 11, dtype=np.float32)
    wells = np.float32([full])
    assert np.allclose(ldr_values.expose(ldr_values.radiance(v, t, wells), t, wells), v, atol=1e-5)
    boosted = ldr_values.expose(ldr_values.radiance(v, t, wells), 4 * t, wells)
    assert np.allclose(ldr_values.boost(v, 4), boosted, atol=1e-5)


def test_radiance_of_values_agrees_with_merging_a_single_photo(walk):
    Z = walk.bracket.images
    t = walk.bracket.times
    seen = ldr_values.as_values(Z, t, G)
    for k in range(3):
        E = merge_with_quality(Z[k : k + 1], t[k : k + 1], G, repair=False).E
        inside = (Z[k] > 10) & (Z[k] < 240)
        assert np.allclose(
            ldr_values.radiance(seen.v[k], t[k], seen.full)[inside], E[inside], rtol=1e-3
        )


def test_the_true_radiance_lies_in_the_consistent_range_of_each_photo(walk):
    """The true radiance lies within what each photograph allows, but for noise beyond a few levels."""
    seen = ldr_values.as_values(walk.bracket.images, walk.bracket.times, G)
    unit = np.exp(G[-1])  # of g over the truth's, in which exposure 1 fills a pixel
    for k in range(3):
        least, most = ldr_values.consistent_range(
            seen.v[k], seen.noise[k], seen.clipped[k], seen.t[k], seen.full
        )
        truth = unit * walk.moments[k]
        assert np.mean((truth >= 0.98 * least) & (truth <= 1.02 * most)) > 0.98


def test_a_pixel_clipped_in_a_longer_exposure_cannot_be_a_source_for_a_shorter_one(walk):
    scene = patches.as_scene(walk.bracket.images, walk.bracket.times, G, None)
    for k in range(3):
        _, price = synthesis.boost_photographs(k, scene)
        barred = np.isinf(price)
        assert not barred[: k + 1].any()
        assert np.array_equal(barred[k + 1 :], scene.clipped[k + 1 :].any(axis=-1))


def test_a_still_scene_is_reconstructed():
    place = layers("workshop", (48, 72)).radiance
    shots = camera.shoot(
        place, camera.times_around(place, 3, stops=3), camera.Camera(full_well=20000, read_noise=5)
    )
    H = patches.synthesise(shots.images, shots.times, G)
    E = merge_with_quality(shots.images, shots.times, G).E
    assert psnr(H, place) > psnr(E, place) - 0.5


def test_where_the_reference_is_well_exposed_the_result_is_the_reference(walk):
    Z = walk.bracket.images
    t = walk.bracket.times
    H = patches.synthesise(Z, t, G, rounds=(2, 1))
    well = ((Z[1] > 0.25 * 255) & (Z[1] < 0.84 * 255)).all(axis=-1)
    assert np.allclose(H[well], (np.exp(G[Z[1]]) / t[1])[well], rtol=1e-4) and well.mean() > 0.1


def test_a_moving_visitor_appears_as_in_the_reference_without_a_ghost(walk):
    Z = walk.bracket.images
    t = walk.bracket.times
    H = patches.synthesise(Z, t, G)
    E = merge_with_quality(Z, t, G).E
    truth = walk.moments[1]
    seen = np.abs(in_stops(walk.moments, truth) - in_stops(truth, truth)).max(axis=(0, -1)) > 0.1
    assert 0.05 < seen.mean() < 0.2  # somewhere in any photograph
    assert np.mean(off(E, truth)[seen] ** 2) > 25 * np.mean(off(H, truth)[seen] ** 2)
    assert psnr(H, truth) > psnr(E, truth) + 1.5
    for reference in (0, 2):
        H = patches.synthesise(Z, t, G, reference=reference)
        assert psnr(H, walk.moments[reference]) > psnr(E, walk.moments[reference])


def test_the_steps_go_from_coarse_to_fine_with_decreasing_dissimilarity(walk):
    steps = list(patches.synthesise_steps(walk.bracket.images, walk.bracket.times, G))
    sides = [state.H.shape[0] for state in steps]
    assert sides == sorted(sides) and sides[0] < 30 and steps[-1].H.shape == (48, 72, 3)
    first = [state for state in steps if state.scale == 0]
    assert np.isnan(first[0].mbds).all() and first[-1].mbds.sum() < first[1].mbds.sum()
    assert np.array_equal(
        steps[-1].H, patches.synthesise(walk.bracket.images, walk.bracket.times, G)
    )


def test_the_order_of_the_photos_does_not_matter(walk):
    Z = walk.bracket.images[:, :32, :48]
    t = walk.bracket.times
    knobs = {"rounds": (2, 1), "coarsest": 16}
    order = [2, 0, 1]
    assert np.array_equal(
        patches.synthesise(Z, t, G, **knobs), patches.synthesise(Z[order], t[order], G, **knobs)
    )
    assert np.array_equal(
        patches.synthesise(Z, t, G, reference=0, **knobs),
        patches.synthesise(Z[order], t[order], G, reference=1, **knobs),
    )


@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("channels", [(), (3,)])
def test_few_gray_black_or_full_photos_give_finite_radiance(count, channels):
    for level in (0, 255):
        images = np.full((count, 20, 24, *channels), level, np.uint8)
        H = patches.synthesise(images, 2.0 ** np.arange(count), G, rounds=(2, 1))
        assert H.shape == images.shape[1:] and H.dtype == np.float32
        assert np.isfinite(H).all() and H.min() >= 0


@pytest.mark.parametrize(
    "change",
    [
        {"times": [1.0, 2.0]},
        {"times": [1.0, -2.0, 3.0]},
        {"images": np.zeros((3, 20, 24))},
        {"g": np.zeros((256, 2))},
        {"reference": 3},
        {"reference": -1},
        {"side": 4},
        {"side": 99},
        {"rounds": (-1, 2)},
    ],
)
def test_invalid_arguments_raise_an_error(change):
    arguments = {
        "images": np.zeros((3, 20, 24, 3), np.uint8),
        "times": [1.0, 2.0, 4.0],
        "g": G,
    } | change
    with pytest.raises(InputError):
        patches.synthesise(**arguments)


@pytest.mark.parametrize("step", [(1, 0), (0, 1), (-1, 0), (0, -1), (2, -3)])
def test_propagate_takes_the_match_of_the_neighbour_or_the_nearest_edge_pixel(step):
    at = np.random.default_rng(3).integers(0, 9, (5, 7, 3))
    matches = patchmatch.propagate(at, step)
    for y, x in np.ndindex(5, 7):
        beside = min(max(y - step[0], 0), 4), min(max(x - step[1], 0), 6)
        assert matches[y, x].tolist() == (at[beside] + [0, *step]).tolist()


@pytest.mark.quick
@pytest.mark.parametrize(("k", "unknown"), [(0, [[1, 1, 1], [2, 2, 2]]), (1, [[2, 2, 2]]), (2, [])])
def test_only_pixels_that_a_longer_exposure_clips_have_no_price(k, unknown):
    L = np.full((3, 4, 5, 3), 0.5, np.float32)
    clipped = np.zeros((3, 4, 5, 3), bool)
    clipped[0, 0, 0, 1] = True
    clipped[1, 1, 1, 0] = True
    clipped[2, 2, 2, 2] = True
    full = np.ones(3, np.float32)
    alpha = np.ones((4, 5, 1), np.float32)
    scene = synthesis.Scene(L, L / 50, clipped, np.array([1.0, 4, 16]), full, 1, alpha)
    _, price = synthesis.boost_photographs(k, scene)
    assert np.argwhere(np.isinf(price)).tolist() == unknown
