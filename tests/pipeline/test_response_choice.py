"""The default response uses one curve for all channels as far as held-out pixels allow it."""

import io
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from hdrlab import pipeline, scenes
from hdrlab.capture import camera
from hdrlab.capture.responses import true_g
from hdrlab.core.bracket import bracket
from hdrlab.core.weights import gaussian
from hdrlab.errors import InputError
from hdrlab.fast import debevec
from hdrlab.fast.merge import merge_with_quality
from hdrlab.pipeline import recovery, tied_curves
from hdrlab.response import space

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
    """Return the largest factor between the radiances of a gray wall's channels."""
    return np.exp(np.ptp(g[LEVELS], axis=1).max())


def error(g):
    """Return the root mean square error of a response in stops, after fitting the unit of each channel."""
    off = (g - true_g(bend)[:, None])[LEVELS] / np.log(2)
    return np.sqrt(np.mean((off - off.mean(axis=0)) ** 2))


def test_a_gray_wall_in_three_photos_stays_gray(three):
    separate = debevec.recover(three.images, three.times)
    assembly = pipeline.assemble(three, align="none", times="stated")
    assert part(separate) > 2 and part(assembly.g) < 1.001
    assert error(assembly.g) < min(0.2, error(separate))
    assert any("response: one curve by" in detail for detail in assembly.details)


def s_curve(strength):
    """Return a gamma with an S-curve of this strength."""

    def brightness(X):
        M = X ** (1 / 2.2)
        return M + strength * (M**2 * (3 - 2 * M) - M)

    return brightness


def shoot_channels(E, channel_responses, *, full_well=20_000):
    """Return five photos of E in which each channel has its own response."""
    times = camera.times_around(E, 5)
    channels = []
    for c, response in enumerate(channel_responses):
        sensor = camera.Camera(response=response, full_well=full_well, read_noise=8)
        channels.append(camera.shoot(E[..., c], times, sensor, rng=c).images)
    return bracket(np.stack(channels, axis=-1), times)


def measure_map_error(E, taken, g):
    """Return the median error of the map in stops, after fitting the unit of each channel."""
    merged = merge_with_quality(taken.images, taken.times, g, gaussian(), method="shot")
    is_measured = merged.quality == 0
    off = np.log2(merged.E[is_measured] / E[is_measured])
    return np.median(np.abs(off - np.median(off, axis=0)))


@pytest.mark.parametrize("scene", [scenes.room, scenes.street])
@pytest.mark.parametrize(
    "channel_responses",
    [
        (s_curve(0.5), s_curve(0.5), s_curve(0.5)),
        (s_curve(0.45), s_curve(0.5), s_curve(0.58)),
        ("film", s_curve(0.5), lambda X: X**0.3),
        ("srgb", "srgb", lambda X: X**0.3),
    ],
    ids=["equal", "slightly different", "very different", "one different"],
)
def test_the_map_is_as_exact_as_with_the_better_of_one_curve_and_three(scene, channel_responses):
    E = scene((128, 192))
    taken = shoot_channels(E, channel_responses)
    alternatives = []
    for recover in (space.recover, debevec.recover):
        for method in (recover, recovery.share_curve(recover)):
            g = method(taken.images, taken.times)
            alternatives.append(measure_map_error(E, taken, g))
    choice = recovery.choose_response("auto", taken)
    curve = choice.method(taken.images, taken.times, valid=None)
    assert measure_map_error(E, taken, curve) <= min(alternatives) + 0.003


def test_channels_stay_together_if_ties_are_close_and_part_if_they_are_loose():
    E = scenes.room((128, 192))
    taken = shoot_channels(E, (s_curve(0.3), s_curve(0.5), s_curve(0.7)))
    departures = [
        part(tied_curves.recover(taken.images, taken.times, departure=departure))
        for departure in (1e-4, 0.03, 0.3)
    ]
    assert departures[0] < 1.02
    assert departures[0] < departures[1] < departures[2]


def test_without_ties_each_channel_gets_its_own_curve():
    E = scenes.room((128, 192))
    taken = shoot_channels(E, ("film", "srgb", "gamma"))
    tied = tied_curves.recover(taken.images, taken.times, departure=100)
    separate = space.recover(taken.images, taken.times)
    assert np.abs(tied - separate)[20:240].max() < 0.05


def test_channels_do_not_drift_apart_where_noise_hides_the_dark_values():
    E = scenes.room((128, 192))
    gray = E.mean(axis=-1, keepdims=True)
    is_dark = gray < np.median(gray)
    night = np.where(is_dark, gray, E * [1.5, 1, 0.5]).astype(np.float32)
    sensor = camera.Camera(response="film", full_well=3_000, read_noise=12)
    taken = camera.shoot(night, camera.times_around(night, 5, middle=0.1 / 16), sensor, rng=1)
    tied = tied_curves.recover(taken.images, taken.times, departure=0.5)
    drift_stops = np.ptp(tied[2:8], axis=1).max() / np.log(2)
    assert drift_stops < 0.25


@pytest.mark.parametrize("departure", [0, -1, np.inf])
def test_a_departure_that_is_not_positive_raises_an_error(three, departure):
    with pytest.raises(InputError, match="departure"):
        tied_curves.recover(three.images, three.times, departure=departure)


def test_debevec_is_no_candidate_where_no_two_photos_share_the_middle_values():
    three = shoot_chapel((360, 540))
    far = bracket(three.images[[0, 2]], three.times[[0, 2]])
    # nothing connects the middle
    images = np.where((far.images > 60) & (far.images < 190), 0, far.images)
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
