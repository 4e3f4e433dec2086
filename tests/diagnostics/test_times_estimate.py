"""Times from the pixels: rough ones are corrected, true ones stay, and what is wrong is named."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from PIL import Image, TiffImagePlugin
from scipy.ndimage import gaussian_filter

from hdrlab import cli, pipeline, scenes
from hdrlab.capture import camera
from hdrlab.core.weights import gaussian
from hdrlab.diagnostics import (
    consistency,
    exposure_times,
    flat_patches,
    plausibility,
    response_steps,
)
from hdrlab.diagnostics.causes import collect_evidence, find_causes, warn_of_contradictions
from hdrlab.diagnostics.contradictions import Contradictions, find_contradictions
from hdrlab.diagnostics.exposure_times import estimate_times, note
from hdrlab.diagnostics.outlying_frames import find_outlying_frames
from hdrlab.fast import debevec
from hdrlab.fast.merge import merge
from hdrlab.response import linear

pytestmark = pytest.mark.papers


def is_local(found):
    """Whether the light changed in parts of the image, whatever else is wrong."""
    evidence = replace(collect_evidence(found), corners=0.0, time_error=0.0)
    return "local" in find_causes(evidence)


@pytest.fixture(scope="module")
def taken():
    """taken(count, response, seed) -> photographs of the room, with the noise of a large sensor."""
    room = scenes.room((280, 420))

    @cache
    def shoot(count, response="film", seed=1):
        times = camera.times_around(room, count, stops=1.5)
        return camera.shoot(
            room, times, camera.Camera(response=response, full_well=50_000, read_noise=5), rng=seed
        )

    return shoot


def spread(images, times):
    """Return the spread of the map of these times, stops."""
    g = debevec.recover(images, times)
    return consistency.measure_spread(
        consistency.measure_level_exposures(images, times, merge(images, times, g, gaussian()))
    )


def off_by(factors, found, stated):
    """Return how far estimated times are from the true ones, stops, without what the gauge leaves open."""
    Q = response_steps.free_directions(np.log(stated))
    return Q @ Q.T @ (found.stops + np.log2(factors))


def tone_mapped(images, strength=0.4, sigma=20):
    """Return photographs of which each was brightened where it is dark, as a phone does."""
    local = gaussian_filter(images.mean(axis=-1) + 1, (0, sigma, sigma))
    return np.clip(np.round(images * (local[..., None] / 128) ** -strength), 0, 255).astype(
        np.uint8
    )


# Patches


def test_a_patch_holds_the_mean_of_its_pixels_and_is_flat_if_they_are_similar():
    images = np.full((2, 14, 21), 100, np.uint8)
    images[1] = 150
    images[0, :7, :7] += np.arange(49, dtype=np.uint8).reshape(7, 7) % 12
    images[0, 7, 0] = 113
    images[1, 7:, 14:] = 90
    images[1, 0, 20] = 251
    found = flat_patches.find_flat_patches(images)
    assert found.Z.shape == (2, 1, 2, 3) and found.Z[0, 0, 0, 0] == np.round(
        images[0, :7, :7].mean()
    )
    assert found.flat.all(axis=0).tolist() == [[True, True, False], [False, True, True]]
    assert flat_patches.find_static(found.Z)[0].tolist() == [
        [True, True, True],
        [True, True, False],
    ]
    assert found.Z[1, 0, 0, 2] == 0  # clipped: no measurement


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_patches_of_8_and_16_bits_agree_and_masked_patches_are_left_out(dtype):
    levels = np.random.default_rng(0).integers(60, 66, (3, 30, 40, 3))
    images = (levels * (257 if dtype == np.uint16 else 1)).astype(dtype)
    valid = np.ones((3, 30, 40), bool)
    valid[1, 8, 8] = False
    found = flat_patches.find_flat_patches(images, valid=valid)
    expected = np.round(levels[:, :28, :35].reshape(3, 4, 7, 5, 7, 3).mean(axis=(2, 4)))
    expected[1, 1, 1] = 0
    assert np.abs(np.moveaxis(found.Z, 1, -1) - expected).max() <= (dtype == np.uint16)


def test_each_pair_of_neighbours_has_its_own_flat_patches():
    images = np.full((3, 7, 14), 100, np.uint8)
    images[1], images[2] = 150, 200
    # flat in the first two alone
    images[2, :7, :7] = np.arange(49, dtype=np.uint8).reshape(7, 7) + 160
    assert flat_patches.find_flat_patches(images).best[:, 0].tolist() == [
        [True, True],
        [False, True],
    ]


def test_patches_that_change_against_the_majority_are_not_static():
    Z = np.full((2, 1, 4, 5), 120, np.uint8)
    Z[1], Z[1, 0, 0, :2] = 60, 180
    assert np.array_equal(flat_patches.find_static(Z)[0], Z[1, 0] == 60)


def test_levels_of_equal_rank_can_replace_patches():
    levels = np.random.default_rng(0).integers(20, 100, (40, 60))
    images = np.stack([levels, 2 * levels]).astype(np.uint8)
    Z = flat_patches.rank_levels(images)
    assert Z.shape == (2, 1, plausibility.RANK_COUNT, 1) and np.array_equal(Z[1], 2 * Z[0])
    assert flat_patches.rank_levels(np.stack([images[0], images[0] // 50])).all(
        axis=(1, 2, 3)
    ).tolist() == [
        True,
        False,
    ]


def test_pair_tables_count_the_patches_of_each_pair_of_levels():
    Z = np.array([10, 10, 20, 0, 30, 40, 40, 40], np.uint8).reshape(2, 1, 1, 4)
    H = flat_patches.count_pairs(Z, np.array([[True, True, True, True]]))
    assert H.shape == (1, 1, 256, 256) and H.sum() == 3
    assert H[0, 0, 10, 30] == H[0, 0, 10, 40] == H[0, 0, 20, 40] == 1


def test_a_large_picture_is_read_on_an_even_grid_of_patches(monkeypatch):
    images = np.repeat(np.arange(10, 210, 5, dtype=np.uint8), 7)[None, :, None] * np.ones(
        (2, 1, 70), np.uint8
    )
    every = flat_patches.find_flat_patches(images).Z
    monkeypatch.setattr(flat_patches, "MAX_PATCHES", 40 * 10 // 4)
    assert np.array_equal(flat_patches.find_flat_patches(images).Z, every[:, :, ::2, ::2])


# Estimates


@pytest.mark.parametrize(("count", "seed"), [(4, 1), (5, 2), (7, 3)])
def test_times_off_by_up_to_a_tenth_are_recovered(taken, count, seed):
    bracket = taken(count, seed=seed)
    images = bracket.images
    true = bracket.times
    factors = np.random.default_rng(seed).uniform(0.9, 1.1, count)
    found = estimate_times(images, true * factors, lambda times: spread(images, times))
    assert found.accepted and np.abs(off_by(factors, found, true * factors)).max() < 0.02
    assert (
        found.bias_after < 0.2 * found.bias_before
        and found.spread_after < 0.2 * found.spread_before
    )
    assert np.allclose(found.times, true * factors * 2**found.stops, rtol=1e-12)


@pytest.mark.parametrize("frame", [0, 4])
def test_where_one_end_alone_is_wrong_the_other_times_and_their_span_stay(taken, frame):
    bracket = taken(5)
    images = bracket.images
    true = bracket.times
    factors = np.where(np.arange(5) == frame, 2.0 if frame else 0.5, 1.0)
    found = estimate_times(images, true * factors, lambda times: spread(images, times))
    assert found.accepted and np.abs(np.delete(found.stops, frame)).max() < 0.02
    assert abs(found.stops[frame] + np.log2(factors[frame])) < 0.15


def test_correcting_one_of_three_times_gives_a_warning(taken):
    three = taken(3)
    found = pipeline.assemble(replace(three, times=three.times * [1, 1, 1.3]))
    assert any("exposure times" in warning for warning in found.warnings)
    assert pipeline.assemble(three).warnings == ()
    rounded = exposure_times.Estimate(three.times, np.array([-0.03, 0.06, -0.03]), True, "")
    assert exposure_times.find_warnings(rounded) == ()  # as cameras round 1/32 s to 1/30


def test_a_wrong_time_is_reported_even_if_the_spread_is_small_but_not_if_it_is_tiny(taken):
    off = Contradictions(stops=np.array([0, 0.33, 0.0]), regions=np.full(2, np.nan), cost=0.06)
    assert "b by +0.33" in warn_of_contradictions(off, "abc", 0.02)
    assert warn_of_contradictions(off, "abc", 0.002) == ""


def test_for_a_linear_camera_the_span_of_times_is_recovered_too(taken):
    bracket = taken(5, "linear")
    images = bracket.images
    true = bracket.times
    factors = 0.97 ** np.arange(-2, 3)
    g = linear.recover(images, true)
    found = estimate_times(images, true * factors, g=g)
    assert found.accepted and np.abs(found.stops + np.log2(factors)).max() < 0.02
    # it is the exponent of an unknown one
    assert np.abs(estimate_times(images, true * factors).stops).max() < 0.005
    assert not estimate_times(images, true, g=g).accepted


def test_the_gauge_keeps_the_mean_and_the_span_of_the_stated_times(taken):
    bracket = taken(5)
    images = bracket.images
    true = bracket.times
    stated = true * [1, 1.1, 0.9, 1, 1.05]
    found = estimate_times(images, stated)
    B = np.log(stated)
    assert abs(found.stops.mean()) < 1e-9 and abs(found.stops @ (B - B.mean())) < 1e-9
    other = estimate_times(images, 60 * stated)
    assert np.allclose(other.stops, found.stops, atol=1e-9) and np.allclose(
        other.times, 60 * found.times
    )


@pytest.mark.parametrize("count", [3, 5, 7])
def test_exact_times_are_not_changed(taken, count):
    bracket = taken(count)
    images = bracket.images
    true = bracket.times
    found = estimate_times(images, true)
    assert not found.accepted and np.array_equal(found.times, true)
    assert np.abs(found.stops).max() < 0.005 and found.reason.startswith("the stated times agree")


def test_an_estimate_is_shrunk_to_the_stated_times(taken):
    bracket = taken(5)
    images = bracket.images
    true = bracket.times
    stated = true * [1, 1, 1.1, 1, 1]
    sizes = [np.linalg.norm(estimate_times(images, stated, sd=sd).stops) for sd in (1e-3, 1e-2, 1)]
    assert sizes[0] < 0.01 < 0.1 < sizes[-1] and np.all(np.diff(sizes) > 0)


@pytest.mark.parametrize("verdict", [0.02, np.nan])
def test_an_estimate_that_raises_the_spread_is_not_accepted(taken, verdict):
    bracket = taken(5)
    images = bracket.images
    true = bracket.times
    stated = true * [1, 1, 1.1, 1, 1]
    found = estimate_times(
        images, stated, lambda times: 0.01 if np.array_equal(times, stated) else verdict
    )
    assert (
        not found.accepted
        and np.array_equal(found.times, stated)
        and "spread would rise" in found.reason
    )
    assert "stated times stay" in note(found, "abcde")


def test_times_are_not_estimated_from_two_photographs_or_without_flat_patches(taken):
    bracket = taken(5)
    images = bracket.images
    true = bracket.times
    assert "two photos" in estimate_times(images[:2], true[:2]).reason
    noise = np.random.default_rng(0).integers(0, 256, (3, 60, 80, 3), dtype=np.uint8)
    assert "too few patches" in estimate_times(noise, [1, 2, 4]).reason


@pytest.mark.parametrize("verb", [estimate_times, find_contradictions])
@pytest.mark.parametrize(
    ("times", "said"), [([1, 2], "expected 3 exposure times"), ([1, 4, 2], "shortest")]
)
def test_times_of_wrong_number_or_order_raise_an_error(verb, times, said):
    with pytest.raises(ValueError, match=said):
        verb(np.full((3, 20, 20), 100, np.uint8), times)


# Contradictions


@pytest.mark.parametrize("frame", range(5))
@pytest.mark.parametrize("stops", [-0.7, 0.7])
def test_the_frame_whose_time_is_wrong_is_named_with_its_factor(taken, frame, stops):
    bracket = taken(5)
    images = bracket.images
    times = bracket.times
    names = bracket.names
    wrong = times.copy()
    wrong[frame] *= 2**stops
    found = find_contradictions(images, wrong)
    assert found.wrong == (frame,) and not is_local(found)
    # its own error bends the exponent of the response a little
    assert abs(found.stops[frame] + stops) < 0.15
    assert np.abs(np.delete(found.stops, frame)).max() < 0.03
    assert f"{names[frame]} by {found.stops[frame]:+.2f}" in warn_of_contradictions(found, names)


@pytest.mark.parametrize("count", [3, 4, 5, 7])
def test_true_times_give_no_contradiction(taken, count):
    taken = taken(count)
    found = find_contradictions(taken.images, taken.times)
    assert np.nanmax(np.abs(found.stops)) < 0.02 and np.nanmax(found.regions) < 0.01
    assert warn_of_contradictions(found, taken.names) == ""


def test_the_warning_for_three_frames_names_one_and_mentions_the_alternatives(taken):
    bracket = taken(3)
    images = bracket.images
    times = bracket.times
    names = bracket.names
    said = warn_of_contradictions(find_contradictions(images, times * [1, 2, 1]), names)
    assert "frame 2 by -" in said and "first or the last" in said


@pytest.mark.parametrize("count", [3, 5])
def test_local_tone_mapping_is_not_confused_with_wrong_times(taken, count):
    bracket = taken(count)
    images = bracket.images
    times = bracket.times
    names = bracket.names
    found = find_contradictions(tone_mapped(images), times)
    assert is_local(found) and "shoot RAW" in warn_of_contradictions(found, names)
    curve = np.round(255 * (np.arange(256) / 255) ** 0.7).astype(np.uint8)
    # one and the same tone curve for all is a response
    same = find_contradictions(curve[images], times)
    assert not is_local(same) and warn_of_contradictions(same, names) == ""


@pytest.mark.parametrize(("strength", "local"), [(0, False), (0.3, True), (0.4, True)])
def test_local_tone_mapping_of_a_real_bracket_is_noticed_where_it_is_weak(
    photographs, strength, local
):
    """frobisher has 426 x 640 pixels, and true times; at 0.3 its parts disagree by 0.08 stops."""
    bracket = photographs("frobisher")
    images = bracket.images
    times = bracket.times
    assert is_local(find_contradictions(tone_mapped(images, strength, 32), times)) == local


@pytest.mark.parametrize("count", [5, 7])
def test_weak_local_tone_mapping_of_a_simulated_bracket_is_noticed_from_five_frames_on(
    taken, count
):
    bracket = taken(count)
    images = bracket.images
    times = bracket.times
    assert is_local(find_contradictions(tone_mapped(images, 0.2), times))


def test_a_slight_local_difference_counts_only_if_it_is_significant():
    stops = np.zeros(3)
    for regions, signs, local in (
        (0.03, 5, True),
        (0.06, 3.2, False),
        (0.01, 9, False),
        (0.2, 1, True),
    ):
        found = Contradictions(
            stops=stops, regions=np.full(2, regions), significance=np.full(2, signs)
        )
        assert is_local(found) == local


def test_vignetting_that_changes_with_the_aperture_is_not_called_local_tone_mapping():
    room = scenes.room((280, 420))
    y, x = (np.linspace(-1, 1, n) for n in room.shape[:2])
    falloff = (y[:, None] ** 2 + x**2)[..., None].astype(np.float32)
    times = camera.times_around(room, 5, stops=1.5)
    images = [
        camera.shoot(room * (1 - 0.1 * j * falloff), t).images[0] for j, t in enumerate(times)
    ]
    assert "the aperture" in warn_of_contradictions(find_contradictions(images, times), "abcde")


@pytest.mark.parametrize(("count", "frame"), [(3, 1), (4, 0), (5, 2)])
def test_a_frame_of_another_white_balance_is_named(taken, count, frame):
    bracket = taken(count)
    images = bracket.images
    times = bracket.times
    names = bracket.names
    warm = camera.shoot(scenes.room((280, 420)) * np.float32([1.35, 1, 0.72]), times, rng=2)
    shifted = images.copy()
    shifted[frame] = warm.images[frame]
    found = find_contradictions(shifted, times)
    assert found.tints.argmax() == frame and found.tints[frame] == pytest.approx(0.43, abs=0.05)
    # also where the map explains its photographs
    said = warn_of_contradictions(found, names, 0.001)
    assert "white balance" in said and names[frame] in said
    assert find_contradictions(images, times).tints.max() < 0.05


def test_a_gray_bracket_has_no_white_balance(taken):
    bracket = taken(5)
    images = bracket.images
    times = bracket.times
    assert find_contradictions(images[..., 1], times * [1, 1, 2, 1, 1]).tints.max() == 0


def test_a_wrong_time_is_reported_only_if_it_changes_the_map(taken):
    bracket = taken(5)
    images = bracket.images
    times = bracket.times
    dark = np.where(np.arange(5)[:, None, None, None] == 0, np.minimum(images, 3), images)
    dark[0, :21, :21] = images[0, :21, :21]  # all that is left of the shortest
    assert find_contradictions(images, times * [1.6, 1, 1, 1, 1]).wrong == (0,)
    assert find_contradictions(dark, times * [1.6, 1, 1, 1, 1]).wrong == ()


def test_without_flat_patches_the_histograms_are_compared():
    E = np.exp(np.random.default_rng(0).normal(0, 1.2, (120, 160))).astype(np.float32)
    bracket = camera.shoot(E, camera.times_around(E, 5, stops=1.5))
    images = bracket.images
    times = bracket.times
    assert not flat_patches.find_flat_patches(images).best.any()
    assert find_contradictions(images, times).wrong == ()
    assert find_contradictions(images, times * [1, 1, 1, 2, 1]).wrong == (3,)


# Outlying frames


@pytest.mark.parametrize("frame", range(5))
def test_a_frame_of_another_scene_is_named_as_the_one_to_leave_out(taken, frame):
    bracket = taken(5)
    images = bracket.images
    times = bracket.times
    other = images.copy()
    other[frame] = np.flip(images[frame], axis=(0, 1))
    assert find_outlying_frames(other, times) == ((frame,), ())


@pytest.mark.parametrize("count", [3, 5, 7])
def test_no_frame_of_a_consistent_bracket_is_left_out(taken, count):
    bracket = taken(count)
    images = bracket.images
    times = bracket.times
    assert find_outlying_frames(images, times) == ((), ())


def test_no_frame_is_left_out_if_two_halves_of_a_bracket_contradict_each_other(taken):
    bracket = taken(5)
    images = bracket.images
    times = bracket.times
    assert find_outlying_frames(images, times * [1, 1, 5, 5, 5]) == ((), ())


def test_where_either_of_two_frames_may_be_the_wrong_one_both_are_named():
    chapel = scenes.chapel((280, 420))
    bracket = camera.shoot(chapel, camera.times_around(chapel, 4, stops=1.5), rng=1)
    images = bracket.images
    times = bracket.times
    frames, rivals = find_outlying_frames(images, times * [1, 1, 1, 2])
    assert {*frames, *rivals} == {1, 3}


def test_frames_without_common_patches_have_no_estimate():
    images = np.stack([np.full((70, 70), z, np.uint8) for z in (40, 120, 255)])
    found = find_contradictions(images, [1, 2, 4])
    assert np.isnan(found.stops).all() and np.isnan(found.regions).all()
    assert found.wrong == () and not is_local(found) and warn_of_contradictions(found, "abc") == ""
    assert warn_of_contradictions(
        Contradictions(stops=np.array([0, np.nan, 1.0]), regions=np.full(2, np.nan)), "abc"
    )


def test_remove_trend_keeps_the_error_of_a_single_frame():
    B = np.arange(5.0)
    assert np.allclose(
        response_steps.remove_trend(3 - 2 * B + [0, 0, 0, 0, 0.5], B), [0, 0, 0, 0, 0.5]
    )
    # a line from end to end would leave less in sum, and four wrong
    both = np.array([0, 0, 0, 0, 1.0, 1.0])
    assert np.allclose(response_steps.remove_trend(both - np.arange(6.0), np.arange(6.0)), both)


def test_an_estimate_is_accepted_only_if_held_out_pixels_improve_by_the_given_gain(taken):
    bracket = taken(4)
    images = bracket.images
    true = bracket.times
    rough = true * [1, 1.1, 0.95, 1]
    found = estimate_times(images, rough)
    left = found.bias_after / found.bias_before
    assert found.accepted and 0 < left < 1
    strict = estimate_times(images, rough, gain=1 - left / 2)
    assert not strict.accepted and np.array_equal(strict.times, rough)


# In the pipeline


def test_the_pipeline_estimates_times_between_alignment_and_response(taken):
    rough = replace(taken(5), times=taken(5).times * [1, 1, 1.1, 0.95, 1])
    states = list(pipeline.assemble_steps(rough, align="none", times="estimate"))
    assert tuple(state.stage for state in states) == pipeline.STAGES
    assert states[-1].spread < 0.3 * pipeline.assemble(rough, align="none", times="stated").spread
    assert any("times estimated" in one and "frame 3 -0.1" in one for one in states[-1].notes)
    assert states[-1].warnings == () and not np.array_equal(states[-1].bracket.times, rough.times)


def test_an_estimate_far_from_the_stated_times_is_accepted_with_a_warning(taken):
    wrong = replace(taken(5), times=taken(5).times * [1, 1, 2, 1, 1])
    stated = pipeline.assemble(wrong, times="stated")
    assert any("left out" in one and wrong.names[2] in one for one in stated.notes)
    found = pipeline.assemble(wrong)
    assert (
        found.spread < 0.03
        and len(found.warnings) == 1
        and "contrast of the map" in found.warnings[0]
    )


def test_an_unknown_value_of_times_raises_an_error(taken):
    with pytest.raises(ValueError, match="times .*correct, stated, estimate.*guess"):
        pipeline.assemble(taken(3), times="guess")


@pytest.fixture
def rough(taken, tmp_path, monkeypatch):
    """The names of five photographs in the working folder; their EXIF, and times.csv, are off by a tenth."""
    bracket = taken(5)
    images = bracket.images
    true = bracket.times
    times = true * [1, 1, 1.1, 0.95, 1]
    for j, (image, seconds) in enumerate(zip(images, times, strict=True)):
        exif = Image.Exif()
        exif[0x8769] = {0x829A: TiffImagePlugin.IFDRational(round(seconds * 1e9), 10**9)}
        Image.fromarray(image).save(tmp_path / f"{j}.jpg", exif=exif, quality=98, subsampling=0)
    rows = [f"{j}.jpg,{seconds}" for j, seconds in enumerate(times)]
    (tmp_path / "times.csv").write_text("\n".join(["file,exposure_time_s", *rows]))
    monkeypatch.chdir(tmp_path)
    return [f"{j}.jpg" for j in range(5)]


WAYS = [["estimate"], ["times.csv"], ["times.csv", "--correct-times"]]
KEPT = [["exif", "--keep-times"], ["times.csv", "--keep-times"]]


@pytest.mark.parametrize("arguments", [["exif"], ["estimate"], ["times.csv"], *KEPT])
def test_the_command_corrects_times_unless_they_are_to_stay(rough, tmp_path, capsys, arguments):
    with pytest.raises(SystemExit) as stop:
        cli.run(["assemble", *rough, "-o", "map.exr", "--align", "none", "--times", *arguments])
    assert not stop.value.code and (tmp_path / "map.exr").exists()
    assert ("times estimated" in capsys.readouterr().err) == (arguments not in KEPT)


@pytest.mark.parametrize("arguments", WAYS)
def test_calibrate_accepts_the_same_times_options(rough, capsys, arguments):
    with pytest.raises(SystemExit) as stop:
        cli.run(["calibrate", *rough, "--align", "none", "--times", *arguments])
    said = capsys.readouterr()
    estimated = arguments != ["times.csv"]
    assert (
        not stop.value.code and ("note: times estimated from the pixels" in said.err) == estimated
    )
    line = next(line for line in said.out.splitlines() if line.startswith("spread"))
    spread = next(float(word) for word in line.split()[::-1] if word[0].isdigit())
    assert (spread < 0.015) == estimated


# Real photographs


@pytest.mark.parametrize(
    ("name", "stops", "changed"),
    [("window", 0.02, True), ("frobisher", 0.004, False), ("stlouis_arch", 0.03, False)],
)
def test_real_photographs_agree_better_with_estimated_times_or_keep_those_stated(
    photographs, name, stops, changed
):
    taken = photographs(name)
    if name == "stlouis_arch":
        taken = replace(taken, images=taken.images[:, ::2, ::2])
    align = "mtb" if name == "stlouis_arch" else "none"
    found = pipeline.assemble(taken, times="estimate", align=align)
    assert found.spread <= stops and found.warnings == ()
    assert np.array_equal(found.bracket.times, taken.times) != changed


def test_wrong_times_of_a_phone_are_not_called_local_tone_mapping(photographs):
    taken = photographs("tripod_phone")
    taken = pipeline.align_bracket(taken, "mtb").bracket
    found = find_contradictions(taken.images, taken.times)
    assert not is_local(found) and np.nanmax(found.regions) < 0.1
    assert {taken.names[j] for j in found.wrong} >= {"img-3.jpeg", "img-1.jpeg"}
    assert "--times estimate" in warn_of_contradictions(found, taken.names)
    other = estimate_times(taken.images, taken.times)
    assert other.accepted and other.bias_after < 0.1 * other.bias_before


def test_cross_validation_predicts_held_out_patches():
    half = flat_patches.checkerboard((24, 24))
    light = np.random.default_rng(0).uniform(12, 30, (24, 24))
    ratio = np.where(half, 2.0, 2.0**1.3)  # the stated times are true of one half alone
    Z = np.stack([light, ratio * light, ratio**2 * light]).round().astype(np.uint8)[:, None]
    found = flat_patches.FlatPatches(Z, np.ones((3, 24, 24), bool))
    linear_g = np.log(np.maximum(np.arange(256), 0.5) / 128)[None]
    nothing = np.zeros((3, 0))
    B = np.log([1.0, 2.0, 4.0])
    apart = exposure_times.cross_validate(found, B, nothing, g=linear_g, sd=0.1)
    assert apart == pytest.approx(0.15, abs=0.03)
    alike = flat_patches.FlatPatches(np.where(half, Z, Z[..., ::-1, :]), found.flat)
    assert exposure_times.cross_validate(alike, B, nothing, g=linear_g, sd=0.1) != pytest.approx(
        apart
    )
