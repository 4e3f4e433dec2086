"""Ghosts and flare in `assemble`, on the command line and in the report."""

from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

from hdrlab import pipeline, scenes
from hdrlab.capture import camera, lens_flare, movers, responses
from hdrlab.cli import main
from hdrlab.core.bracket import bracket
from hdrlab.core.filters.scatter import GlareSpread
from hdrlab.io.radiance import read_radiance
from hdrlab.pipeline import registration
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
    assert any("--ghosts regions" in warning for warning in plain.warnings)


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
    final = states[-1]
    inside = final.moving > 0
    assert inside.any() and np.array_equal(final.E[~inside], plain.E[~inside])
    assert not np.array_equal(final.E[inside], plain.E[inside])
    assert any("something moved" in note for note in final.notes)
    assert final.spread == plain.spread  # the photographs are what they were


def test_auto_removes_ghosts_with_a_note_if_something_moved(moving, plain):
    auto = pipeline.assemble(moving, align="none")
    regions = pipeline.assemble(moving, align="none", ghosts="regions")
    assert np.array_equal(auto.E, regions.E) and not np.array_equal(auto.E, plain.E)
    assert any("something moved in" in note for note in auto.notes) and not auto.warnings


def test_auto_does_not_change_the_map_of_a_still_scene():
    taken = camera.shoot(scenes.room(SHAPE), camera.times_around(scenes.room(SHAPE), 5), rng=1)
    auto = pipeline.assemble(taken, align="none", ghosts="auto")
    none = pipeline.assemble(taken, align="none", ghosts="none")
    assert np.array_equal(auto.E, none.E)
    assert auto.moving is None
    assert auto.warnings == none.warnings == ()


@pytest.mark.parametrize(("align", "is_cleaned"), [("auto", True), ("mtb", False)])
def test_auto_removes_ghosts_from_photos_that_no_alignment_brings_together(
    moving, monkeypatch, align, is_cleaned
):
    align_bracket = registration.align_bracket

    def report_misalignment(bracket, *arguments, **named):
        aligned = align_bracket(bracket, "none")
        warnings = ("two photos could not be aligned",)
        return replace(aligned, warnings=warnings, is_misaligned=True)

    monkeypatch.setattr(registration, "align_bracket", report_misalignment)
    assembly = pipeline.assemble(moving, align=align)
    assert (assembly.moving is not None) == is_cleaned
    assert assembly.warnings == ("two photos could not be aligned",)


def test_auto_removes_ghosts_that_fill_most_of_the_image_and_warns():
    wall = np.full((*SHAPE, 3), 0.4, np.float32)
    ball = movers.ball(SHAPE, (48, 72), 44, [1.5, 1.0, 0.6])
    taken = movers.shoot(wall, ball, movers.path(3, (0, 36)), [0.2, 0.6, 1.8], rng=1).bracket
    auto = pipeline.assemble(taken, **KNOBS)
    regions = pipeline.assemble(taken, **KNOBS, ghosts="regions")
    assert np.mean(auto.moving > 0) > 0.5
    assert np.array_equal(auto.E, regions.E)
    assert any("moved" in warning for warning in auto.warnings)
    assert not any("--ghosts regions" in warning for warning in auto.warnings)


def film(images, times, valid=None):
    return responses.true_g("film")


def draw_hall(shape):
    """Return a dark hall with four equal lamps, whose light falls on the wall."""
    y, x = np.indices(shape) / shape[0]
    light = 0.05 + 0.03 * np.sin(9 * x) * np.cos(7 * y)
    for k in range(4):
        distance = np.hypot(y - 0.25, x - (k + 0.5) * shape[1] / shape[0] / 4)
        light += 25 * (distance < 0.06) + 0.3 * np.exp(-distance / 0.08)
    return (light[..., None] * [1, 0.75, 0.4]).astype(np.float32)


def take_hall(shape, at, figure):
    """Photograph the hall with the faults of cameras: noise, vignetting, and rounded times."""
    hall = draw_hall(shape)
    times = 0.014 * 4.0 ** np.arange(5)
    fall_off = [0.95, 1.0, 1.04, 0.98, 1.02]
    y, x = np.indices(shape) / np.array(shape)[:, None, None] - 0.5
    images = []
    for j, time in enumerate(times):
        moment = hall if figure is None else movers.compose_moment(hall, figure, at[j])[0]
        seen = moment * (1 + (fall_off[j] - 1) * 2 * (x**2 + y**2))[..., None]
        model = camera.Camera(response="film", full_well=30_000, read_noise=6)
        images.append(camera.shoot(np.float32(seen), [time * fall_off[j]], model, rng=j).images[0])
    return bracket(np.stack(images), times)


KNOBS = {"align": "none", "times": "stated", "response": film}


def test_nothing_moves_in_an_empty_hall_with_lamps():
    shape = (180, 270)
    taken = take_hall(shape, None, None)
    cleaned = pipeline.assemble(taken, **KNOBS, ghosts="regions")
    plain = pipeline.assemble(taken, **KNOBS, ghosts="none")
    assert not cleaned.moving.any()
    assert np.array_equal(cleaned.E, plain.E)


def test_removing_ghosts_does_not_change_lamps_that_all_photos_show():
    shape = (180, 270)
    figure = movers.ball(shape, (120, 135), 55, np.array([0.5, 0.3, 0.2]), stripes=0)
    taken = take_hall(shape, movers.path(5, (0, 30)), figure)
    cleaned = pipeline.assemble(taken, **KNOBS)
    plain = pipeline.assemble(taken, **KNOBS, ghosts="none")
    y, x = np.indices(shape) / shape[0]
    near = [np.hypot(y - 0.25, x - (k + 0.5) * shape[1] / shape[0] / 4) < 0.045 for k in range(4)]
    lamps = near[0] | near[3]
    assert cleaned.moving.any()
    assert np.allclose(cleaned.E[lamps], plain.E[lamps], rtol=0.02)


def test_auto_removes_somebody_far_away():
    shape = (180, 270)
    figure = movers.ball(shape, (120, 135), 11, np.array([0.5, 0.3, 0.2]), stripes=0)
    taken = take_hall(shape, movers.path(5, (0, 25)), figure)
    cleaned = pipeline.assemble(taken, **KNOBS)
    assert 0 < np.mean(cleaned.moving > 0) < 0.1
    assert cleaned.warnings == ()


def test_ghosts_in_a_large_and_a_small_bracket_are_found_in_the_same_places():
    shape = (540, 810)
    figure = movers.ball(shape, (330, 405), 130, [0.9, 0.25, 0.2])
    taken = take_hall(shape, movers.path(5, (0, 90)), figure)
    blocks = taken.images.reshape(5, 180, 3, 270, 3, 3)
    smaller = replace(taken, images=blocks.mean(axis=(2, 4)).round().astype(np.uint8))
    large = pipeline.assemble(taken, **KNOBS)
    small = pipeline.assemble(smaller, **KNOBS)
    enlarged = np.repeat(np.repeat(small.moving > 0, 3, axis=0), 3, axis=1)
    assert np.mean(enlarged ^ (large.moving > 0)) < 0.3 * np.mean(enlarged)
    assert len(small.warnings) == len(large.warnings)


def test_a_figure_before_a_bright_wall_gets_no_color_of_clipped_pixel_values():
    shape = (120, 180)
    y, x = np.indices(shape)
    wall = np.exp(1.5 * np.sin(x / 30) + np.cos(y / 17))[..., None] * np.float32([1.6, 0.8, 0.2])
    figure = movers.ball(shape, (60, 90), 26, [0.8, 0.8, 0.8], stripes=0)
    times = [0.03, 0.12, 0.5, 2.0]
    taken = movers.shoot(wall, figure, movers.path(4, (0, 30)), times, rng=3)
    cleaned = pipeline.assemble(taken.bracket, **KNOBS)
    assert cleaned.moving.any()
    # Nothing is known of the wall where it is clipped in each photo that the figure does not hide.
    is_clipped = taken.bracket.images.max(axis=-1) >= 250
    is_shown = np.any(~taken.hidden & ~is_clipped, axis=0)
    known = cleaned.quality == 0
    assert known[(cleaned.moving > 0) & is_shown].mean() > 0.99
    clipped = cleaned.E[(cleaned.moving > 0) & ~known]
    assert np.allclose(clipped.min(axis=-1), clipped.max(axis=-1), rtol=0.01)
    ratio = np.log2(cleaned.E[None] / np.concatenate([taken.moments, wall[None]]))
    ratio -= np.median(ratio[-1], axis=(0, 1))
    hue = np.abs(ratio - ratio.mean(axis=-1, keepdims=True)).max(axis=-1).min(axis=0)
    assert np.mean(hue[known] > 0.3) < 0.01


def test_flare_removal_is_the_last_stage_before_the_comparison():
    room = scenes.room(SHAPE)
    veiled = lens_flare.add_glare(room, GlareSpread(0.1, 2.5))
    times = 0.9 / veiled.max() * 4.0 ** np.arange(9)
    taken = camera.shoot(veiled, times, camera.Camera(full_well=50_000), rng=1)
    states = list(pipeline.assemble_steps(taken, align="none", flare="glare"))
    assert [state.stage for state in states][-2:] == ["flare", "compare"]
    final = states[-1]
    assert final.glare.any() and any("the lens scattered" in note for note in final.notes)
    assert np.median(final.E[final.glare]) < np.median(states[-3].E[final.glare])


def test_wrong_times_are_not_reported_as_motion(moving):
    wrong = replace(moving, times=moving.times * np.array([1, 1, 8, 9, 10]))
    assembly = pipeline.assemble(wrong, align="none", times="stated", ghosts="none")
    assert len(assembly.warnings) == 1 and "--times estimate" in assembly.warnings[0]


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
    out = tmp_path / "map.pfm"
    page = tmp_path / "page"
    options = ["--align", "none", "--ghosts", "regions", "--flare", "glare", "--report", str(page)]
    ran = CliRunner().invoke(
        main,
        ["assemble", *photos, "--times", str(tmp_path / "times.csv"), "-o", str(out), *options],
    )
    assert ran.exit_code == 0, ran.output
    assert "something moved in" in ran.output and "veiling glare" in ran.output
    assert not np.allclose(read_radiance(out), plain.E)
    text = (page / "report.html").read_text(encoding="utf8")
    assert ">Motion</h2>" in text and "in orange with dark outlines" in text


def test_report_has_no_section_on_motion_if_nothing_moved(plain, tmp_path):
    page = report.write_report(tmp_path, plain, pipeline.develop(plain.E), recipe={})
    assert ">Motion</h2>" not in page.read_text(encoding="utf8")
