"""Ghosts and flare where a reader meets them: in `assemble`, on the command line, in the report."""

from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

from hdrlab import pipeline, scenes
from hdrlab.capture import camera, lens_flare, movers, responses
from hdrlab.cli import main
from hdrlab.core.filters.scatter import GlareSpread
from hdrlab.io.radiance import read_radiance
from hdrlab.show.pages import report

pytestmark = pytest.mark.papers

SHAPE = (96, 144)


@pytest.fixture(scope="module")
def moving():
    room = scenes.room(SHAPE)
    ball = movers.ball(SHAPE, (60, 72), 10, np.array([6, 2, 1]) * np.median(room))
    at = movers.path(5, (0, 16))
    return movers.shoot(
        room, ball, at, camera.times_around(room, 5), camera.Camera(full_well=50_000), rng=1
    ).bracket


@pytest.fixture(scope="module")
def plain(moving):
    return pipeline.assemble(moving, align="none", ghosts="none")


def test_ghosts_none_keeps_ghosts_and_warns(plain):
    assert plain.moving is None and plain.glare is None and plain.stage == "compare"
    assert any("--ghosts regions" in doubt for doubt in plain.doubts)


@pytest.mark.parametrize("way", ["regions", "reference"])
def test_ghost_removal_is_a_stage_after_the_merge_with_a_note(moving, plain, way):
    states = list(pipeline.assemble_steps(moving, align="none", ghosts=way))
    assert [state.stage for state in states] == [
        "align",
        "times",
        "response",
        "merge",
        "ghosts",
        "compare",
    ]
    found = states[-1]
    inside = found.moving > 0
    assert inside.any() and np.array_equal(found.E[~inside], plain.E[~inside])
    assert not np.array_equal(found.E[inside], plain.E[inside])
    assert any("something moved" in note for note in found.notes)
    assert found.spread == plain.spread  # the photographs are what they were


def test_auto_removes_ghosts_with_a_note_if_something_moved(moving, plain):
    auto, regions = (
        pipeline.assemble(moving, align="none", **way) for way in ({}, {"ghosts": "regions"})
    )
    assert np.array_equal(auto.E, regions.E) and not np.array_equal(auto.E, plain.E)
    assert any("something moved in" in note for note in auto.notes) and not auto.doubts


def test_auto_does_not_change_the_map_of_a_still_scene():
    taken = camera.shoot(scenes.room(SHAPE), camera.times_around(scenes.room(SHAPE), 5), rng=1)
    auto, none = (pipeline.assemble(taken, align="none", ghosts=way) for way in ("auto", "none"))
    assert (
        np.array_equal(auto.E, none.E) and auto.moving is None and auto.doubts == none.doubts == ()
    )


def test_auto_removes_ghosts_that_fill_most_of_the_image_and_warns():
    wall = np.full((*SHAPE, 3), 0.4, np.float32)
    ball = movers.ball(SHAPE, (48, 72), 44, [1.5, 1.0, 0.6])
    taken = movers.shoot(wall, ball, movers.path(3, (0, 36)), [0.2, 0.6, 1.8], rng=1).bracket

    def film(images, times, valid=None):
        return responses.true_g("film")

    knobs = {"align": "none", "times": "stated", "response": film}
    auto = pipeline.assemble(taken, **knobs)
    regions = pipeline.assemble(taken, **knobs, ghosts="regions")
    assert np.mean(auto.moving > 0) > 0.5
    assert np.array_equal(auto.E, regions.E)
    assert any("moved" in doubt for doubt in auto.doubts)
    assert not any("--ghosts regions" in doubt for doubt in auto.doubts)


def test_flare_removal_is_the_last_stage_before_the_comparison():
    room = scenes.room(SHAPE)
    veiled = lens_flare.add_glare(room, GlareSpread(0.1, 2.5))
    times = 0.9 / veiled.max() * 4.0 ** np.arange(9)
    taken = camera.shoot(veiled, times, camera.Camera(full_well=50_000), rng=1)
    states = list(pipeline.assemble_steps(taken, align="none", flare="glare"))
    assert [state.stage for state in states][-2:] == ["flare", "compare"]
    found = states[-1]
    assert found.glare.any() and any("the lens scattered" in note for note in found.notes)
    assert np.median(found.E[found.glare]) < np.median(states[-3].E[found.glare])


def test_wrong_times_are_not_reported_as_motion(moving):
    wrong = replace(moving, times=moving.times * np.array([1, 1, 8, 9, 10]))
    found = pipeline.assemble(wrong, align="none", times="stated", ghosts="none")
    assert len(found.doubts) == 1 and "--times estimate" in found.doubts[0]


def test_unknown_values_of_ghosts_and_flare_raise_an_error(moving):
    with pytest.raises(ValueError, match="ghosts .*none, auto, regions, reference.*'some'"):
        pipeline.assemble(moving, ghosts="some")
    with pytest.raises(ValueError, match="flare .*none, glare.*'sun'"):
        pipeline.assemble(moving, flare="sun")


def test_the_command_line_and_the_report_show_what_moved(moving, plain, tmp_path):
    for name, image in zip(moving.names, moving.images, strict=True):
        Image.fromarray(image).save(tmp_path / f"{name.replace(' ', '')}.png")
    lines = ["file,exposure_time_s"]
    lines += [
        f"{n.replace(' ', '')}.png,{t}" for n, t in zip(moving.names, moving.times, strict=True)
    ]
    (tmp_path / "times.csv").write_text("\n".join(lines))
    photos = sorted(map(str, tmp_path.glob("*.png")))
    out, page = tmp_path / "map.pfm", tmp_path / "page"
    asked = ["--align", "none", "--ghosts", "regions", "--flare", "glare", "--report", str(page)]
    ran = CliRunner().invoke(
        main, ["assemble", *photos, "--times", str(tmp_path / "times.csv"), "-o", str(out), *asked]
    )
    assert ran.exit_code == 0, ran.output
    assert "something moved in" in ran.output and "veiling glare" in ran.output
    assert not np.allclose(read_radiance(out), plain.E)
    text = (page / "report.html").read_text(encoding="utf8")
    assert ">Motion</h2>" in text and "in orange with dark outlines" in text


def test_report_has_no_section_on_motion_if_nothing_moved(plain, tmp_path):
    page = report.write_report(tmp_path, plain, pipeline.develop(plain.E), recipe={})
    assert ">Motion</h2>" not in page.read_text(encoding="utf8")
