"""Flare: closed forms of the simulated lens, and removal of the scattered light from a map."""

import numpy as np
import pytest

from hdrlab import pipeline, scenes
from hdrlab.capture import lens_flare as lens
from hdrlab.core.filters.scatter import GlareSpread, scatter, spread_transform
from hdrlab.errors import InputError
from hdrlab.radiance import flare, reflection


@pytest.fixture(scope="module")
def room():
    return scenes.room((128, 192))


# The lens


def test_a_point_of_light_is_spread_by_the_kernel():
    E = np.zeros((31, 41), np.float32)
    E[10, 12] = 1
    seen = lens.add_glare(E, GlareSpread(0.1, 2.5, 2.0))
    y, x = np.indices(E.shape)
    r = np.hypot(y - 10, x - 12)
    K = (1 + (r / 2) ** 2) ** -1.25
    assert seen[10, 12] == pytest.approx(0.9, rel=1e-5)
    ratio = seen[r > 0] / K[r > 0]
    # one constant at all distances: nothing comes round
    assert np.allclose(ratio, ratio[0], rtol=2e-3)


def test_glare_adds_no_light_and_keeps_most_of_it_in_the_frame():
    E = np.zeros((81, 81), np.float32)
    E[40, 40] = 5
    seen = lens.add_glare(E, GlareSpread(0.2, 3.0))
    assert 0.95 * 5 < seen.sum(dtype=float) <= 5.0001 and np.all(seen >= 0)


def test_adding_glare_is_linear():
    rng = np.random.default_rng(1)
    first, second = rng.random((2, 20, 30, 3)).astype(np.float32)
    both = lens.add_glare(first + 3 * second)
    assert np.allclose(
        both, lens.add_glare(first) + 3 * lens.add_glare(second), rtol=1e-4, atol=1e-5
    )


def test_a_clear_lens_does_not_change_the_image(room):
    assert np.array_equal(lens.add_glare(room, GlareSpread(0.0)), room)


@pytest.mark.parametrize(
    "spread",
    [
        *(GlareSpread(1.0), GlareSpread(-0.1), GlareSpread(0.1, 0.0), GlareSpread(0.1, np.inf)),
        *(GlareSpread(0.1, 2.0, -1.0), GlareSpread(0.1, 2.0, 0.0), GlareSpread(0.1, 2.0, np.inf)),
    ],
)
def test_an_invalid_glare_spread_raises_an_error(spread):
    with pytest.raises(ValueError, match="fraction"):
        lens.add_glare(np.ones((4, 4)), spread)
    with pytest.raises(ValueError, match="fraction"):
        flare.remove_glare(np.ones((4, 4)), spread=spread)


# Its removal


@pytest.mark.parametrize("power", [2.0, 2.5, 3.0])
def test_glare_is_estimated_and_removed_within_5_percent(room, power):
    F = lens.add_glare(room, GlareSpread(0.1, power))
    result = flare.remove_glare(F)
    affected = (1 - 0.9 * room / F).max(axis=-1) > 0.05
    before = np.abs(F / room - 1).max(axis=-1)[affected]
    after = np.abs(result.E / room - 1).max(axis=-1)[affected]
    assert result.spread.power == power and result.spread.share == pytest.approx(0.1, rel=0.05)
    assert np.median(before) > 0.04 and np.median(after) < 0.01 and np.mean(after < 0.05) > 0.9


def test_glare_of_a_known_lens_is_removed_within_a_tenth_of_a_percent(room):
    spread = GlareSpread(0.08, 2.25)
    F = lens.add_glare(room, spread)
    result = flare.remove_glare(F, spread=spread, part=1e-6)
    assert np.quantile(np.abs(result.E / room - 1), 0.99) < 1e-3


@pytest.mark.parametrize("name", scenes.PLACES)
def test_a_scene_without_glare_is_not_changed(name):
    E = scenes.layers(name, (128, 192)).radiance
    result = flare.remove_glare(E)
    assert np.array_equal(result.E, E) and not result.region.any() and result.spread.share == 0
    assert "no veiling glare" in flare.note(result)


def test_the_iterations_converge_to_the_true_fraction_of_glare(room):
    F = lens.add_glare(room, GlareSpread(0.1, 2.0))
    shares = [state.share for state in flare.glare_steps(F, 2.0)]
    assert abs(shares[-1] - 0.1) < abs(shares[0] - 0.1)
    assert shares[-1] == pytest.approx(0.1, rel=0.03)


def test_pixels_outside_the_glare_region_are_not_changed(room):
    F = lens.add_glare(room, GlareSpread(0.1, 3.0))
    result = flare.remove_glare(F, part=0.2)
    assert 0 < result.region.mean() < 0.9
    assert np.array_equal(result.E[~result.region], F[~result.region])
    assert np.all(result.E[result.region].min(axis=-1) < F[result.region].max(axis=-1))
    assert f"{100 * result.spread.share:.1f} %" in flare.note(result)


def test_the_unit_of_light_does_not_matter(room):
    F = lens.add_glare(room, GlareSpread(0.1, 2.5))
    plain = flare.remove_glare(F)
    scaled = flare.remove_glare(F * np.float32(1024))
    assert plain.spread.power == scaled.spread.power
    assert np.allclose(scaled.E, 1024 * plain.E, rtol=1e-3)


def test_gray_and_black_maps_are_accepted(room):
    gray = flare.remove_glare(lens.add_glare(room[..., 1], GlareSpread(0.1, 2.5)))
    assert gray.E.shape == room.shape[:2] and gray.spread.power == 2.5
    dark = flare.remove_glare(np.zeros((12, 14)))
    assert not dark.E.any() and dark.spread.share == 0


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"F": np.full((4, 4), np.nan)}, "NaN"),
        ({"F": -np.ones((4, 4))}, "negative"),
        ({"part": 0}, "fraction"),
    ],
)
def test_invalid_maps_and_parameters_raise_an_error(wrong, message):
    with pytest.raises(ValueError, match=message):
        flare.remove_glare(**({"F": np.ones((4, 4))} | wrong))


def test_an_empty_list_of_powers_raises_an_error():
    with pytest.raises(ValueError, match="power"):
        flare.estimate_spread(np.ones((4, 4)), powers=())


def test_scattered_light_falls_with_distance():
    E = np.zeros((9, 60), np.float32)
    E[4, 5] = 1
    veil = scatter(E, spread_transform(E.shape, 2.0))
    assert np.all(np.diff(veil[4, 6:]) < 0) and veil[4, 5] == pytest.approx(0, abs=1e-6)


# reflections


@pytest.mark.parametrize("place", [scenes.chapel, scenes.workshop, scenes.street])
@pytest.mark.parametrize("r", [0.002, 0.01, 0.03])
def test_a_mirrored_reflection_is_estimated_and_removed(place, r):
    E = place((128, 192))
    F = E + np.float32(r) * E[::-1, ::-1]
    assert reflection.fit_reflection(F) == pytest.approx(r, rel=0.02)
    assert np.allclose(reflection.remove_reflection(F, r), E, rtol=1e-3, atol=1e-4 * E.max())


@pytest.mark.parametrize("place", [scenes.chapel, scenes.workshop, scenes.street])
def test_a_scene_without_a_reflection_is_not_changed(place):
    E = place((128, 192))
    assert reflection.fit_reflection(E) < 1e-4
    assert np.allclose(reflection.remove_reflection(E), E, rtol=0.02, atol=1e-5 * E.max())


def test_a_symmetric_scene_is_not_mistaken_for_a_reflection():
    E = scenes.chapel((128, 192))
    symmetric = E + E[::-1, ::-1]
    assert np.array_equal(reflection.remove_reflection(symmetric), symmetric)
    assert reflection.fit_reflection(np.ones((20, 30))) == 0


@pytest.mark.papers
def test_no_reflection_is_found_in_real_photos_without_one():
    E = pipeline.assemble(scenes.photographs((250, 188))).E
    assert reflection.fit_reflection(E) == 0


@pytest.mark.parametrize("r", [-0.1, 1.0, np.nan])
def test_a_reflection_outside_0_to_1_raises_an_error(r):
    with pytest.raises(InputError, match=str(r)):
        reflection.remove_reflection(np.ones((4, 4)), r)
