"""Real brackets become radiance maps by the steps of the command, with the right warnings only."""

from dataclasses import replace

import numpy as np
import pytest

from hdrlab import pipeline
from hdrlab.cli.brackets import read_bracket
from hdrlab.io import radiance
from hdrlab.pipeline.alignment import register

pytestmark = pytest.mark.papers

SIDE = 500  # pixels: of larger photographs every second, third ... is taken


@pytest.fixture
def assembled(shared):
    """assembled(folder, ...) -> the Assembly of a folder of photos, made like `hdrlab assemble` does."""

    def assemble(folder, times="exif", mask=None, stops=None):
        top, _, rest = folder.partition("/")
        taken = read_bracket((shared(top) / rest,), times, mask, stops, note=print, detail=print)
        every = max(1, round(max(taken.images.shape[1:3]) / SIDE))
        valid = taken.valid if taken.valid is None else taken.valid[:, ::every, ::every]
        images = np.ascontiguousarray(taken.images[:, ::every, ::every])
        way = "estimate" if times == "estimate" else "correct"
        return pipeline.assemble(replace(taken, images=images, valid=valid), times=way)

    return assemble


LIST = "memorial.hdr_image_list.txt"

SOUND = [
    ("window", {}, 0.026),
    ("stlouis_arch", {}, 0.02),
    ("frobisher", {}, 0.002),
    ("memorial", {"mask": "0000FF"}, 0.09),
    ("memorial", {}, 0.09),  # with its border
    ("mertens_house", {"stops": 3}, 0.02),
    ("mertens_house", {"times": "estimate"}, 0.02),
]


@pytest.mark.parametrize(("folder", "options", "spread"), SOUND)
def test_a_consistent_real_bracket_gives_no_warning(assembled, folder, options, spread):
    assembly = assembled(folder, **options)
    assert assembly.warnings == () and assembly.fallback == ""
    assert assembly.spread <= spread + 5e-4 and np.all(np.isfinite(assembly.E))
    assert assembly.moving is None or not assembly.moving.any()  # nothing is taken for motion


def test_the_dark_wood_of_the_church_is_as_dark_and_as_red_as_in_the_map_of_its_author(
    assembled, shared
):
    """The scans have a black floor; twelve frames that show it must not outvote the other four."""
    assembly = assembled("memorial", times=str(shared("memorial") / LIST), mask="0000FF")
    author = radiance.read_radiance(shared("memorial") / "memorial.hdr")[::2, ::2]
    is_exposed = (assembly.bracket.images > 30) & (assembly.bracket.images < 225)
    is_compared = is_exposed.all(axis=-1).any(axis=0) & (assembly.quality == 0)
    is_compared &= author.min(axis=-1) > 0
    E = assembly.E[is_compared]
    truth = author[is_compared]
    off = np.log2(E / truth)
    off -= np.median(off, axis=0)
    is_dark = truth.mean(axis=-1) <= np.quantile(truth.mean(axis=-1), 0.1)
    assert np.quantile(np.abs(off), 0.95) < 0.25
    assert abs(np.median(off[is_dark, 0] - off[is_dark, 1])) < 0.25


def test_scans_that_fit_already_stay_in_place_at_full_size(shared):
    taken = read_bracket((shared("memorial"),), "exif", "0000FF", None, note=print, detail=print)
    registration = register(taken.images)
    assert np.array_equal(registration.homographies, np.broadcast_to(np.eye(3), (16, 3, 3)))


def test_true_times_are_not_changed(assembled, shared):
    stated = read_bracket(
        (shared("frobisher"),), "exif", None, None, note=print, detail=print
    ).times
    assert assembled("frobisher").bracket.times.tobytes() == stated.tobytes()


def test_wrong_times_of_a_phone_are_replaced_by_relative_times_with_a_warning(assembled):
    assembly = assembled("tripod_phone")
    assert assembly.spread < 0.25 and assembly.E.any() and assembly.fallback == ""
    assert any("relative exposure times" in warning for warning in assembly.warnings)


@pytest.mark.parametrize("options", [{"stops": 1}, {"times": "estimate"}])
def test_photos_from_different_viewpoints_give_warnings(assembled, options):
    assembly = assembled("crusader/frames", **options)
    assert assembly.warnings and np.all(np.isfinite(assembly.E)) and assembly.E.any()


def test_photos_without_times_become_a_map_with_relative_times_and_a_warning(assembled):
    assembly = assembled("mertens_house")
    assert assembly.fallback == "" and assembly.E.any()
    assert np.all(np.diff(assembly.bracket.times) > 0)
    assert any("relative exposure times" in warning for warning in assembly.warnings)
