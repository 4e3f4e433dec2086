"""The default response: one curve where held-out pixels allow it, and none that photographs leave open."""

import io
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from hdrlab import pipeline, scenes
from hdrlab.capture import camera
from hdrlab.capture.responses import true_g
from hdrlab.core.bracket import bracket
from hdrlab.fast import debevec
from hdrlab.pipeline import recovery

LEVELS = slice(10, 251)


def bend(X):
    """Return the brightness of exposures X in a camera that adds an S-curve to a gamma."""
    M = X ** (1 / 2.2)
    return M + 0.9 * (M**2 * (3 - 2 * M) - M)


def shoot_chapel(shape):
    """Return a bracket of three JPEGs of a chapel, two stops apart."""
    E = scenes.chapel(shape)
    sensor = camera.Camera(response=bend, full_well=20_000, read_noise=5)
    taken = camera.shoot(E, camera.times_around(E, 3), sensor, rng=1)
    files = [io.BytesIO() for _ in taken.images]
    for file, image in zip(files, taken.images, strict=True):
        Image.fromarray(image).save(file, "jpeg", quality=90)
    return replace(taken, images=np.stack([np.asarray(Image.open(file)) for file in files]))


@pytest.fixture(scope="module")
def three():
    return shoot_chapel((180, 270))


def part(g):
    """Return by what factor the radiances of a gray wall's channels differ at most."""
    return np.exp(np.ptp(g[LEVELS], axis=1).max())


def error(g):
    """Return the root mean square error of a response in stops, the best unit for each channel."""
    off = (g - true_g(bend)[:, None])[LEVELS] / np.log(2)
    return np.sqrt(np.mean((off - off.mean(axis=0)) ** 2))


def test_a_gray_wall_in_three_photos_stays_gray(three):
    separate = debevec.recover(three.images, three.times)
    found = pipeline.assemble(three, align="none", times="stated")
    assert part(separate) > 2 and part(found.g) < 1.001
    assert error(found.g) < min(0.2, error(separate))
    assert any("response: one curve by" in detail for detail in found.details)


def test_channels_with_different_responses_get_a_curve_each():
    E = scenes.room((180, 270))
    times = camera.times_around(E, 5)
    taken = [
        camera.shoot(E[..., c], times, camera.Camera(response=f))
        for c, f in enumerate(["film", "srgb", "gamma"])
    ]
    mixed = bracket(np.stack([one.images for one in taken], axis=-1), times)
    found = recovery.choose_response("auto", mixed)
    assert "a curve for each channel" in found.notes[0].partition(",")[0]
    g = found.method(mixed.images, mixed.times, valid=None)
    assert np.array_equal(g, debevec.recover(mixed.images, mixed.times))


def test_one_channel_with_a_different_response_is_enough_for_three_curves():
    E = scenes.room((180, 270))
    times = camera.times_around(E, 5)
    film = ["srgb", "srgb", lambda X: X**0.3]
    taken = [camera.shoot(E[..., c], times, camera.Camera(response=f)) for c, f in enumerate(film)]
    mixed = bracket(np.stack([one.images for one in taken], axis=-1), times)
    assert (
        "a curve for each channel"
        in recovery.choose_response("auto", mixed).notes[0].partition(",")[0]
    )


def test_debevec_is_no_candidate_where_no_two_photos_share_the_middle_values():
    three = shoot_chapel((360, 540))
    far = bracket(three.images[[0, 2]], three.times[[0, 2]])
    images = np.where(
        (far.images > 60) & (far.images < 190), 0, far.images
    )  # nothing connects the middle
    assert "debevec" not in recovery.choose_response("auto", replace(far, images=images)).notes[0]


@pytest.mark.parametrize("gray", [False, True])
def test_a_linear_bracket_has_no_response_to_choose(three, gray):
    images = three.images[..., 1] if gray else three.images
    taken = bracket(images, three.times)
    assert recovery.choose_response("auto", replace(taken, linear=True)).notes == ()
    g = recovery.choose_response("auto", taken).method(images, three.times, valid=None)
    assert g.shape == (256, *images.shape[3:])


def test_held_out_stripes_share_no_pixel_with_those_that_make_a_response(three):
    rows = np.broadcast_to(np.arange(180, dtype=np.uint8)[:, None], (3, 180, 270))
    fit, held = recovery.split_stripes(bracket(rows, three.times))
    assert not set(fit.images.ravel()) & set(held.images.ravel())
    assert 0.4 < len(fit.images[0]) / (len(fit.images[0]) + len(held.images[0])) < 0.6


@pytest.mark.parametrize("level", [0, 255])
def test_photos_without_common_values_raise_an_error_that_says_what_to_do(level):
    taken = bracket(np.full((3, 40, 60, 3), level, np.uint8), [0.1, 0.2, 0.4])
    with pytest.raises(ValueError, match="1 to 2 stops apart"):
        pipeline.assemble(taken)
