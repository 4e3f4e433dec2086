"""All stages together: from photos to a radiance map that explains them, and to an image."""

import math
import sys
from dataclasses import dataclass, replace
from functools import cache

import cv2
import numpy as np
import pytest
from PIL import Image

from hdrlab import pipeline, scenes
from hdrlab.capture import camera, responses
from hdrlab.core.bracket import Bracket, bracket
from hdrlab.core.colour import luminance
from hdrlab.diagnostics import causes, consistency
from hdrlab.fast import merge as quick
from hdrlab.pipeline import assemble, assemble_steps, catalogue, develop
from hdrlab.pipeline.alignment import register
from hdrlab.radiance.merge import METHODS, Quality
from scenes.computed import view


@pytest.fixture(scope="module")
def room():
    return scenes.room((128, 192))


@pytest.fixture(scope="module")
def hand_held(room):
    """Seven noisy, shaken photos of the room, and their true offsets."""
    times = camera.times_around(room, 7, stops=2)
    offsets = camera.shake(7, radius=5, rng=3)
    return camera.shoot(
        room, times, camera.Camera(full_well=50_000, read_noise=5), offsets=offsets, rng=3
    ), offsets


# Stages


@pytest.mark.papers
def test_each_stage_fills_in_more_fields_of_the_assembly(hand_held):
    states = list(assemble_steps(hand_held[0]))
    assert tuple(state.stage for state in states) == pipeline.STAGES
    for name, first in (("g", 2), ("E", 3), ("quality", 3), ("medians", 4)):
        assert [getattr(state, name) is not None for state in states] == [
            j >= first for j in range(5)
        ]
    assert [math.isnan(state.spread) for state in states] == [True, True, True, True, False]
    assert np.array_equal(states[-1].E, assemble(hand_held[0]).E)


@dataclass(frozen=True, kw_only=True, eq=False)
class BracketWithIso(Bracket):
    iso: float | None = None


def test_assemble_takes_brackets_with_one_more_field(hand_held):
    taken = hand_held[0]
    values = {name: getattr(taken, name) for name in ("images", "times", "names")}
    assembly = assemble(BracketWithIso(**values, iso=100.0))
    assert np.array_equal(assembly.E, assemble(taken).E)
    assert assembly.bracket.iso == 100


@pytest.mark.papers
def test_in_place_gives_the_same_map_without_a_copy_of_the_photos(hand_held):
    expected = assemble(hand_held[0])
    taken = replace(hand_held[0], images=hand_held[0].images.copy())
    *_, assembly = assemble_steps(taken, in_place=True)
    assert np.array_equal(assembly.E, expected.E) and assembly.warnings == expected.warnings
    assert np.array_equal(assembly.bracket.images, expected.bracket.images)
    assert np.shares_memory(assembly.bracket.images, taken.images)


def test_release_gives_the_same_map_and_frees_the_memory_of_the_photos(hand_held, monkeypatch):
    monkeypatch.setattr(quick, "PAGE_BYTES", 1 << 12)
    monkeypatch.setattr(quick, "RELEASED_ROWS", quick.BLOCK_ROWS)
    expected = assemble(hand_held[0])
    taken = replace(hand_held[0], images=hand_held[0].images.copy())
    *_, assembly = assemble_steps(taken, in_place=True, release=True)
    assert np.array_equal(assembly.E, expected.E)
    assert np.array_equal(assembly.quality, expected.quality)
    assert (assembly.notes, assembly.warnings, assembly.spread) == (
        expected.notes,
        expected.warnings,
        expected.spread,
    )
    assert assembly.bracket.images.size == 0 and hand_held[0].images[3].mean() > 1
    assert sys.platform != "linux" or np.mean(taken.images[3] == 0) > 0.7


def test_release_keeps_the_photos_if_ghosts_are_removed(hand_held):
    taken = replace(hand_held[0], images=hand_held[0].images.copy())
    *_, assembly = assemble_steps(taken, ghosts="regions", in_place=True, release=True)
    assert assembly.bracket.images.any()


def test_a_hand_held_bracket_becomes_the_radiance_of_the_room(room, hand_held):
    taken, offsets = hand_held
    assembly = assemble(taken)
    assert (
        np.array_equal(assembly.offsets - assembly.offsets[3], offsets) and assembly.warnings == ()
    )
    top, left = assembly.offsets.max(axis=0) - offsets.min(axis=0)  # of the map, in the scene
    h, w = assembly.E.shape[:2]
    truth = room[top : top + h, left : left + w]
    images = assembly.bracket.images
    well = ((images > 30) & (images < 225)).all(axis=-1).any(axis=0) & (
        assembly.quality == Quality.MEASURED
    )
    ratio = assembly.E[well] / truth[well]
    ratio /= np.median(ratio, axis=0)
    assert well.mean() > 0.7
    assert np.median(np.abs(ratio - 1)) < 0.015  # edges of half a pixel included
    assert assembly.spread < 0.05


def test_photos_from_a_tripod_are_not_moved(room):
    taken = camera.shoot(room, camera.times_around(room, 5))
    assembly = assemble(taken)
    assert not assembly.offsets.any() and assembly.E.shape == room.shape and assembly.warnings == ()
    assert assembly.notes == ()


@pytest.mark.parametrize("order", [(6, 5, 4, 3, 2, 1, 0), (2, 0, 6, 4, 1, 3, 5)])
def test_any_order_of_photographs_gives_the_same_map_bit_for_bit(hand_held, order):
    taken = hand_held[0]
    order = list(order)
    shuffled = bracket(taken.images[order], taken.times[order])
    assert np.array_equal(assemble(shuffled).E, assemble(taken).E)


@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("colours", [1, 3])
@pytest.mark.parametrize("response", ["linear", "film"])
def test_gray_and_rgb_8_and_16_bits_linear_or_not(room, bits, colours, response):
    E = room if colours == 3 else luminance(room)
    taken = camera.shoot(E, camera.times_around(E, 5), camera.Camera(response=response, bits=bits))
    assembly = assemble(taken)
    assert assembly.E.shape == E.shape
    assert assembly.E.dtype == np.float32
    assert assembly.quality.shape == E.shape[:2]
    well = assembly.quality == Quality.MEASURED
    ratio = assembly.E[well] / E[well]
    assert np.median(np.abs(ratio / np.median(ratio, axis=0) - 1)) < 0.02
    picture = develop(assembly.E)
    assert picture.shape == E.shape
    assert picture.dtype == np.uint8
    assert picture.max() > 200 > 60 > picture.min()


def test_a_linear_bracket_has_no_response_to_recover(room):
    taken = camera.shoot(
        room, camera.times_around(room, 3), camera.Camera(response="linear", bits=16)
    )
    assert taken.linear and assemble(taken).g.shape == (65536,)
    assert assemble(taken, response="debevec").g.shape == (256, 3)


@pytest.mark.parametrize(
    "knob", [{"weight": name} for name in pipeline.WEIGHTS] + [{"merge": name} for name in METHODS]
)
def test_every_weight_and_method_can_be_named(room, knob):
    taken = camera.shoot(room, camera.times_around(room, 5))
    assert assemble(taken, **knob).spread < 0.05


def test_your_own_functions_can_replace_methods(room):
    taken = camera.shoot(room, camera.times_around(room, 3))
    offsets = np.array([[0, 0], [0, 0], [1, -2]])
    g = responses.true_g("film")
    assembly = assemble(
        taken, align=lambda images: offsets, response=lambda images, times, *, valid: g
    )
    assert np.array_equal(assembly.offsets, offsets) and assembly.g is g
    assert assembly.E.shape == (room.shape[0] - 1, room.shape[1] - 2, 3)
    picture = develop(assembly.E, lambda L: np.full(L.shape, 0.5, np.float32), saturation=0)
    assert np.all(picture == 188)  # half of white in sRGB


@pytest.mark.papers
def test_alignment_can_be_left_out_and_named(hand_held):
    taken = hand_held[0]
    assert not assemble(taken, align="none").offsets.any()
    assert assemble(taken, align="none").spread > assemble(taken).spread
    offsets = register(taken.images, "mtb").homographies[:, 1::-1, 2]
    assert np.array_equal(assemble(taken, align="mtb").offsets, offsets)


def test_masks_are_aligned_with_their_photos(hand_held):
    taken, _ = hand_held
    images = taken.images.copy()
    valid = np.ones(taken.images.shape[:3], bool)
    images[:, :9] = (0, 0, 255)
    valid[:, :9] = False
    assembly = assemble(bracket(images, taken.times, valid=valid))
    assert assembly.bracket.valid.shape == assembly.bracket.images.shape[:3]
    unseen = ~assembly.bracket.valid.any(axis=0)
    assert unseen.any()
    assert np.all(assembly.E[unseen] == 0)
    assert np.all(assembly.quality[unseen] == Quality.UNSEEN)
    blue = (assembly.bracket.images == (0, 0, 255)).all(axis=-1)
    assert not np.any(assembly.bracket.valid & blue)


@pytest.mark.papers
def test_a_border_that_the_mask_hides_does_not_count_as_a_contradiction():
    room = view.room((128, 192))
    taken = camera.shoot(room, camera.times_around(room, 5))
    images = taken.images.copy()
    valid = np.ones(taken.images.shape[:3], bool)
    images[1:4, :100] = np.linspace(40, 220, 192).astype(np.uint8)[:, None]
    valid[1:4, :100] = False
    masked = assemble(bracket(images, taken.times, valid=valid), align="none")
    assert masked.spread < 0.05 and masked.warnings == ()
    blind = consistency.measure_level_exposures(images, taken.times, masked.E)
    assert consistency.measure_spread(blind) > causes.MAX_EXPLAINED_SPREAD


def test_assemble_does_not_change_its_bracket(hand_held):
    taken = hand_held[0]
    images = taken.images.copy()
    assemble(taken)
    assert np.array_equal(images, taken.images)


# Warnings


@pytest.mark.papers
def test_wrong_times_give_a_warning_that_names_the_frames(room):
    taken = camera.shoot(room, camera.times_around(room, 5, stops=1))
    wrong = replace(
        taken, times=taken.times * np.array([1, 1, 8, 9, 10]), names=("a", "b", "c", "d", "e")
    )
    assembly = assemble(wrong, align="none", times="stated")
    assert len(assembly.warnings) == 1 and assembly.spread > causes.MAX_EXPLAINED_SPREAD
    for deviation in ("b by +1", "c by -0.9"):
        assert deviation in assembly.warnings[0]
    assert assemble(taken, align="none").warnings == ()


def test_photos_without_common_levels_give_a_warning():
    images = np.stack([np.full((20, 20), z, np.uint8) for z in (60, 200)])
    images[:, :5] = np.array([100, 140])[:, None, None]
    images[0, :, :1] = np.arange(20, 120, 5)[:, None]  # a few pixels that tie the levels
    images[1, :, :1] = np.arange(40, 140, 5)[:, None]
    assembly = assemble(bracket(images, [1, 2]), align="none")
    assert np.isnan(assembly.spread) and assembly.warnings and assembly.fallback


@pytest.mark.papers
def test_photos_of_two_scenes_give_a_warning_about_the_alignment(room):
    rng = np.random.default_rng(4)
    other = (10 ** rng.uniform(-1, 3, (32, 48, 1))).astype(np.float32).repeat(4, 0).repeat(
        4, 1
    ) * np.ones(3, np.float32)
    times = camera.times_around(room, 3)
    images = [
        camera.shoot(E, [t]).images[0] for E, t in zip((room, other, room), times, strict=True)
    ]
    warnings = assemble(bracket(np.stack(images), times, ["a.jpg", "b.jpg", "c.jpg"])).warnings
    assert any("b.jpg" in warning and "leave one out" in warning for warning in warnings)


# Refusals

STACK = np.random.default_rng(5).integers(0, 256, (2, 20, 30), np.uint8)


@pytest.mark.parametrize(
    ("images", "times", "knobs", "message"),
    [
        (STACK[:1], [1], {}, "at least two different exposures, got frame 1 1 s"),
        (STACK, [2, 2], {}, "at least two different exposures, got frame . 2 s, frame . 2 s"),
        (STACK * 0, [1, 2], {}, "well exposed in two photos"),
        (STACK * 0 + 255, [1, 2], {}, "well exposed in two photos"),
        (STACK, [1, 2], {"weight": "heavy"}, "weight .*hat, gaussian, flat, snr.*'heavy'"),
        (STACK, [1, 2], {"merge": "guess"}, "merge .*log, likelihood, mean, shot"),
        (STACK, [1, 2], {"align": "luck"}, "align .*mtb.*luck"),
        (STACK, [1, 2], {"response": "luck"}, "response .*debevec.*linear.*luck"),
        (
            STACK,
            [1, 2],
            {"align": lambda images: np.zeros((3, 2), int)},
            "expected offsets .2, 2. .*one per image",
        ),
        (
            STACK,
            [1, 2],
            {"align": lambda images: np.zeros((2, 2))},
            "offsets .2, 2. of whole pixels",
        ),
    ],
)
def test_invalid_brackets_and_options_raise_an_error(images, times, knobs, message):
    with pytest.raises(ValueError, match=message):
        assemble(bracket(images, times), **knobs)


def test_develop_raises_an_error_for_unknown_operators_and_invalid_radiance(room):
    with pytest.raises(ValueError, match="tonemap .*curves.*reinhard.*magic"):
        develop(room, "magic")
    with pytest.raises(ValueError, match="1 NaN"):
        develop(np.array([[1.0, np.nan]]))


@pytest.mark.parametrize("name", catalogue.names("tonemap"))
def test_every_operator_develops_a_map_in_colour_and_in_gray(room, name):
    for E in (room, luminance(room)):
        picture = develop(E, name)
        assert picture.shape == E.shape and picture.dtype == np.uint8 and np.ptp(picture) > 100


# Real photographs


@pytest.fixture(scope="module")
def assembled(photographs):
    """assembled(name) -> the Assembly of a real data set."""
    return cache(lambda name: assemble(photographs(name)))


@pytest.mark.papers
@pytest.mark.parametrize(
    ("name", "stops"), [("window", 0.03), ("stlouis_arch", 0.03), ("frobisher", 0.01)]
)
def test_the_map_explains_real_photographs(assembled, name, stops):
    assembly = assembled(name)
    assert assembly.spread <= stops and assembly.warnings == ()
    assert np.all(np.isfinite(assembly.E)) and np.mean(assembly.quality == Quality.MEASURED) > 0.95


@pytest.mark.papers
def test_the_arch_is_aligned_to_within_a_pixel_of_the_measured_shifts(assembled):
    offsets = assembled("stlouis_arch").offsets
    assert np.all(np.abs(np.abs(np.diff(offsets[:, 1])) - [1, 7.5, 2]) <= 1)
    assert np.all(np.abs(np.diff(offsets[:, 0])) <= 1)


def radiance_of(path, tmp_path):
    """Return a radiance file read by OpenCV, without the lines before its first header line."""
    data = path.read_bytes()
    clean = tmp_path / "clean.hdr"
    clean.write_bytes(data[data.index(b"#?RADIANCE") :])
    return cv2.imread(str(clean), cv2.IMREAD_UNCHANGED)[..., ::-1]


@pytest.mark.papers
def test_the_memorial_church_agrees_with_its_published_map(photographs, shared, tmp_path):
    taken = photographs("memorial")
    valid = ~(taken.images == (0, 0, 255)).all(axis=-1)  # the border of the registered scans
    assembly = assemble(replace(taken, valid=valid))
    published = luminance(radiance_of(shared("memorial") / "memorial.hdr", tmp_path))
    assert not assembly.offsets.any() and assembly.warnings == ()
    seen = valid.all(axis=0) & (assembly.quality == Quality.MEASURED) & (published > 0)
    ours = np.log2(luminance(assembly.E)[seen])
    theirs = np.log2(published[seen])
    error = ours - theirs - np.median(ours - theirs)  # up to one factor
    assert seen.mean() > 0.8
    assert np.corrcoef(ours, theirs)[0, 1] >= 0.98 and np.median(np.abs(error)) <= 0.20


@pytest.mark.papers
def test_the_wrong_times_of_the_phone_are_found_and_replaced(photographs, assembled):
    stated = assemble(photographs("tripod_phone"), times="stated")
    assert stated.spread > 0.5
    assert any("exposure times" in warning and "img-" in warning for warning in stated.warnings)
    assembly = assembled("tripod_phone")
    assert assembly.spread < 0.1 and "times" in assembly.warnings[0]


@pytest.mark.papers
def test_photos_from_different_viewpoints_give_a_warning_that_says_what_to_do(shared):
    paths = sorted((shared("crusader") / "frames").glob("*.jpeg"))
    images = np.stack([np.asarray(Image.open(path).convert("RGB").reduce(4)) for path in paths])
    order = np.argsort(images.mean(axis=(1, 2, 3)))
    taken = bracket(images[order], 2.0 ** np.arange(7), [paths[j].name for j in order])
    warnings = [warning for warning in assemble(taken).warnings if "leave one out" in warning]
    assert len(warnings) == 1 and ".jpeg and " in warnings[0]


@pytest.mark.papers
def test_a_photo_that_contradicts_all_others_is_left_out_with_a_note(room):
    taken = camera.shoot(room, camera.times_around(room, 6, stops=1.5), rng=1)
    images = taken.images.copy()
    images[2] = images[2, ::-1, ::-1]  # another scene, of the same brightness
    assembly = assemble(
        replace(taken, images=images, names=tuple("abcdef")), align="none", times="stated"
    )
    assert assembly.bracket.names == tuple("abdef") and assembly.offsets.shape == (5, 2)
    assert any(" c;" in note for note in assembly.notes)
    assert assembly.spread < 0.02 and assemble(taken).bracket.images.shape[0] == 6


@pytest.mark.papers
def test_if_either_of_two_photos_may_be_wrong_a_warning_names_both():
    chapel = scenes.chapel((280, 420))
    taken = camera.shoot(chapel, camera.times_around(chapel, 4, stops=1.5), rng=1)
    wrong = replace(taken, times=taken.times * [1, 1, 1, 2])
    (warning,) = assemble(wrong, align="none", times="stated").warnings
    assert "frame 2" in warning and "frame 4" in warning
