"""hdrlab.pipeline.certainty: how certain each pixel of a radiance map is."""

from dataclasses import replace

import numpy as np
import pytest

from hdrlab import pipeline, scenes
from hdrlab.capture import camera
from hdrlab.cli.brackets import read_bracket
from hdrlab.pipeline import certainty
from hdrlab.radiance.merge import Quality
from hdrlab.show.pages import wording

pytestmark = pytest.mark.papers


@pytest.fixture(scope="module")
def assembly():
    """Five 8-bit photos of the room, with a full well of 4000 electrons; the lamps are clipped in all."""
    E = scenes.room((192, 288))
    maker = camera.Camera(response="srgb", full_well=4_000, read_noise=8)
    taken = camera.shoot(E, camera.times_around(E, 5, stops=1.5), maker, rng=1)
    return E, pipeline.assemble(taken, align="none")


def test_95_percent_of_pixels_lie_within_the_deviation_estimated_from_the_photos(assembly):
    E, state = assembly
    measured = pipeline.measure_deviation(state)
    known = np.isfinite(measured.s)
    ratio = np.median((measured.E / E)[known])  # the map's unit is the camera's own
    inside = np.abs(measured.E / ratio - E) < 1.96 * measured.s / ratio
    assert 0.93 < inside[known].mean() < 0.97 and known.mean() > 0.9
    assert measured.notes == state.notes and measured.warnings == state.warnings


def test_unmeasured_pixels_keep_their_bound_and_have_an_infinite_deviation(assembly):
    _, state = assembly
    measured = pipeline.measure_deviation(state)
    unknown = state.quality != Quality.MEASURED
    assert unknown.any() and np.isinf(measured.s[unknown]).all()
    assert np.array_equal(measured.E[unknown], state.E[unknown])
    assert measured.E.dtype == measured.s.dtype == np.float32 and state.s is None


def test_regions_with_motion_or_removed_glare_have_an_infinite_deviation(assembly):
    _, state = assembly
    labels = np.zeros(state.quality.shape, np.int32)
    glare = np.zeros(state.quality.shape, bool)
    labels[:40, :40] = 2
    glare[-40:, -40:] = True
    measured = pipeline.measure_deviation(replace(state, moving=labels, glare=glare))
    for corner in (np.s_[:40, :40], np.s_[-40:, -40:]):
        assert np.isinf(measured.s[corner]).all()
        assert np.array_equal(measured.E[corner], state.E[corner])


def test_computing_in_strips_does_not_change_the_deviation(assembly, monkeypatch):
    _, state = assembly
    whole = pipeline.measure_deviation(state)
    monkeypatch.setattr(certainty, "ROWS_PER_STRIP", 7)
    parts = pipeline.measure_deviation(state)
    assert np.array_equal(parts.E, whole.E) and np.array_equal(parts.s, whole.s)


def test_masked_pixels_do_not_contribute_to_the_deviation(assembly):
    _, state = assembly
    images = state.bracket.images
    valid = np.ones(images.shape[:3], bool)
    valid[-1, :, :60] = False
    hidden = np.where(valid[..., None], images, np.uint8(77))
    kept = [hidden.copy(), valid.copy()]
    measured = pipeline.measure_deviation(
        replace(state, bracket=replace(state.bracket, images=hidden, valid=valid))
    )
    plain = pipeline.measure_deviation(state)
    assert np.array_equal(kept[0], hidden) and np.array_equal(kept[1], valid)
    both = np.isfinite(measured.s) & np.isfinite(plain.s)
    ratio = np.divide(measured.s, plain.s, where=both, out=np.ones_like(measured.s))
    assert np.median(ratio[:, :60]) > 1.1 > np.median(ratio[:, 60:])


def test_too_small_a_bracket_gives_a_note_and_infinite_deviations():
    E = scenes.room((24, 36))
    taken = camera.shoot(E, camera.times_around(E, 3), camera.Camera(full_well=4_000), rng=1)
    state = pipeline.assemble(taken, align="none")
    measured = pipeline.measure_deviation(state)
    assert np.isinf(measured.s).all() and np.array_equal(measured.E, state.E)
    assert "noise" in measured.notes[-1]
    assert "not known" in wording.certainty(measured.E, measured.s)


def test_calibrate_scales_the_map_and_its_deviation(assembly):
    measured = pipeline.measure_deviation(assembly[1])
    y, x = np.argwhere(measured.quality == 0)[0].tolist()
    scaled = pipeline.calibrate(measured, x, y, 100.0)
    assert np.allclose((scaled.s / scaled.E)[y, x], (measured.s / measured.E)[y, x], rtol=1e-5)


REAL = [
    ("frobisher", None, 0.01, 0.1),
    ("window", None, 0.01, 0.1),
    ("memorial", "0000FF", 0.01, 0.2),
]


@pytest.mark.parametrize(("folder", "mask", "least", "most"), REAL)
def test_the_median_deviation_of_real_maps_is_within_known_bounds(
    folder, mask, least, most, shared
):
    taken = read_bracket((shared(folder),), "exif", mask, None, note=print, detail=print)
    measured = pipeline.measure_deviation(pipeline.assemble(taken))
    known = wording.deviation(measured.E, measured.s)
    assert least < np.median(known[np.isfinite(known)]) < most
