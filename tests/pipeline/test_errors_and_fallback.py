"""Worthless maps get no tone-mapped picture, and errors of a function surface as they are."""

import dataclasses
import importlib.util
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

from hdrlab import pipeline, scenes
from hdrlab.capture import camera
from hdrlab.capture.responses import true_g
from hdrlab.cli import common, main
from hdrlab.errors import InputError
from hdrlab.fast import debevec
from hdrlab.pipeline import options, pictures
from hdrlab.pipeline.stages import assemble_steps


@pytest.fixture(scope="module")
def taken():
    room = scenes.room((96, 144))
    return camera.shoot(room, camera.times_around(room, 4, stops=2), rng=1)


@pytest.fixture(scope="module")
def worthless():
    """Two photos with an exposure ratio of 4, which is stated as 1000."""
    room = scenes.room((96, 144))
    seconds = camera.times_around(room, 2, stops=2)
    pair = camera.shoot(room, seconds, rng=1)
    return replace(pair, times=seconds * [1, 250])


def test_a_response_that_no_camera_has_marks_the_map_as_fallback(worthless):
    assembly = pipeline.assemble(worthless, align="none", times="stated")
    assert assembly.fallback
    assert assembly.warnings


def test_a_map_whose_frames_disagree_by_stops_is_not_worth_a_picture(taken):
    def recover_true_response(images, times, *, valid=None):
        return np.repeat(true_g("film")[:, None], 3, axis=1)

    wrong = replace(taken, times=taken.times * [1, 3, 1, 3])
    for bracket, is_worthless in ((taken, False), (wrong, True)):
        assembly = pipeline.assemble(
            bracket, response=recover_true_response, align="none", times="stated"
        )
        assert bool(assembly.fallback) == is_worthless


def test_the_photos_of_a_worthless_map_are_kept_for_the_fusion(worthless):
    bracket = replace(worthless, images=worthless.images.copy())
    *_, final = assemble_steps(bracket, align="none", times="stated", in_place=True, release=True)
    assert final.fallback
    assert np.array_equal(final.bracket.images, worthless.images)


def test_the_command_line_writes_an_exposure_fusion_for_a_worthless_map(worthless, tmp_path):
    lines = []
    for j, (image, seconds) in enumerate(zip(worthless.images, worthless.times, strict=True)):
        Image.fromarray(image).save(tmp_path / f"{j}.png")
        lines.append(f"{j}.png {seconds}")
    times = tmp_path / "times.txt"
    times.write_text("\n".join(lines))
    picture = tmp_path / "picture.png"
    photos = [str(tmp_path / "0.png"), str(tmp_path / "1.png")]
    arguments = ["assemble", *photos, "--times", str(times), "--keep-times", "--align", "none"]
    arguments += ["-o", str(tmp_path / "map.pfm"), "--picture", str(picture)]
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == 0, result.output
    assert "fusion" in result.output
    assert picture.is_file()


@pytest.mark.parametrize("error", [TypeError, ValueError, np.linalg.LinAlgError])
@pytest.mark.parametrize("option", ["align", "response"])
def test_an_error_in_your_own_function_surfaces(taken, option, error):
    def broken(*args, **kwargs):
        raise error("a bug")

    with pytest.raises(error, match="a bug") as caught:
        pipeline.assemble(taken, **{"align": "none", option: broken})
    assert not isinstance(caught.value, InputError)


@pytest.mark.parametrize("error", [TypeError, ValueError])
@pytest.mark.parametrize("response", ["auto", "mann"])
def test_an_error_in_a_method_of_the_library_surfaces(taken, response, error, monkeypatch):
    def broken(*args, **kwargs):
        raise error("a bug")

    for name in ("hdrlab.response.mann.recover",):
        monkeypatch.setattr(name, broken)
    candidates = [
        dataclasses.replace(candidate, method=broken) for candidate in pipeline.recovery.CANDIDATES
    ]
    monkeypatch.setattr(pipeline.recovery, "CANDIDATES", candidates)
    with pytest.raises(error, match="a bug"):
        pipeline.assemble(taken, align="none", response=response)


class Recovery:
    """A callable object that is not hashable."""

    __hash__ = None

    def __call__(self, images, times, *, valid=None):
        return debevec.recover(images, times, valid=valid)


def test_a_response_may_be_a_callable_object_that_is_not_hashable(taken):
    assembly = pipeline.assemble(taken, align="none", response=Recovery())
    assert np.array_equal(assembly.g, debevec.recover(taken.images, taken.times))


def test_an_operator_may_come_from_a_file_that_is_not_importable_by_name(taken, tmp_path):
    path = tmp_path / "mine.py"
    path.write_text("SATURATION = 0.0\n\ndef tonemap(L):\n    return L / (1 + L)\n")
    spec = importlib.util.spec_from_file_location("a_module_of_mine", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    E = pipeline.assemble(taken, align="none").E
    made = pictures.develop_and_describe(E, module.tonemap)
    assert made.settings == "tonemap, saturation 0"
    assert np.ptp(made.picture, axis=-1).max() == 0


def test_an_operator_may_be_a_callable_object(taken):
    class Operator:
        def __call__(self, L):
            return L / (1 + L)

    E = pipeline.assemble(taken, align="none").E
    assert pipeline.develop(E, Operator()).shape == E.shape


@pytest.mark.parametrize(
    "function", [pipeline.assemble, lambda *a, **k: list(assemble_steps(*a, **k))[-1]]
)
def test_method_is_a_deprecated_name_of_merge(taken, function):
    with pytest.deprecated_call():
        old = function(taken, align="none", method="mean")
    new = function(taken, align="none", merge="mean")
    assert np.array_equal(old.E, new.E)


@pytest.mark.parametrize(
    ("old", "new"),
    [("aligned", "align_bracket"), ("moved", "apply_alignment"), ("settle", "resolve_settings")],
)
def test_old_names_of_the_pipeline_are_deprecated(old, new):
    with pytest.deprecated_call():
        assert getattr(pipeline, old) is getattr(pipeline, new)


def test_the_pipeline_lists_its_public_names():
    assert set(pipeline.__all__) <= set(dir(pipeline))
    assert all(getattr(pipeline, name) is not None for name in pipeline.__all__)


def test_options_are_checked_before_any_work_is_done():
    for name in ("weight", "merge", "times", "ghosts", "flare"):
        with pytest.raises(InputError, match=f"{name} .*'other'"):
            assemble_steps(None, **{name: "other"})
    assert "gaussian" in options.WEIGHTS


def test_values_of_a_light_meter_scale_the_map_and_its_deviation(taken):
    state = pipeline.assemble(taken, align="none")
    state = replace(state, s=0.1 * state.E)
    y, x = np.argwhere(state.quality == 0)[0]
    scaled = pipeline.calibrate(state, int(x), int(y), 100.0)
    factor = scaled.E[y, x] / state.E[y, x]
    assert factor != pytest.approx(1)
    assert np.allclose(scaled.E, state.E * factor, rtol=1e-5)
    assert np.allclose(scaled.s, state.s * factor, rtol=1e-5)
    unmeasured = np.argwhere(state.quality != 0)
    if len(unmeasured):
        y, x = unmeasured[0]
        with pytest.raises(InputError, match=f"{x},{y}"):
            pipeline.calibrate(state, int(x), int(y), 100.0)


@pytest.mark.parametrize("names", [["first"], ["first", "second"], ["a", "b", "c", "d", "e"]])
def test_progress_yields_every_item_for_any_number_of_names(names):
    assert list(common.one_by_one(iter([1, None, 3]), names)) == [1, None, 3]
