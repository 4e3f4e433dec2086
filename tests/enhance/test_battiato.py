"""Exposure correction by the important region of an image."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from skimage import data
from support.synthetic_skin import sample_skin

from hdrlab.capture import exposure
from hdrlab.core.colour import decode_srgb, encode_srgb, to_8bit
from hdrlab.core.steps import last
from hdrlab.enhance import battiato, relight, skin
from hdrlab.enhance.skin import DARK, LIGHT
from hdrlab.errors import InputError
from hdrlab.scenes import subjects

LEVELS = np.arange(256)


def photographed(EV, make=subjects.backlight):
    """Return a photograph of a subject at f/8, and the mask of the subject."""
    scene = make()
    return to_8bit(np.minimum(scene.E / exposure.saturating_luminance(64 / 2**EV), 1)), scene.mask


def test_no_light_is_the_identity():
    assert np.array_equal(relight.table(0.0), LEVELS)


@given(delta=st.floats(-8, 8))
def test_a_table_rises_and_leaves_black_and_white_alone(delta):
    table = relight.table(delta)
    assert np.all(np.diff(table.astype(int)) >= 0) and (table[0], table[255]) == (0, 255)


@given(delta=st.floats(-4, 4), more=st.floats(-4, 4))
def test_two_corrections_equal_one_by_the_sum(delta, more):
    once = relight.f(relight.f_inv(LEVELS) + delta)
    twice = relight.f(relight.f_inv(once[1:255]) + more)
    assert twice == pytest.approx(relight.curve(delta + more)[1:255], abs=1e-4)


@given(q=st.floats(-8, 4), a=st.floats(0.4, 3), c=st.floats(0.1, 2))
def test_the_inverse_inverts_whatever_the_shape(q, a, c):
    assert relight.f_inv(relight.f(q, a=a, c=c), a=a, c=c) == pytest.approx(q, abs=1e-3)


def test_the_default_shape_lies_within_four_levels_of_srgb_from_20_to_200():
    Z = np.arange(20, 200)
    stops = np.log2(decode_srgb(Z / 255) / decode_srgb(128 / 255))
    best = min(np.abs(relight.f(stops + shift) - Z).max() for shift in np.linspace(-2.2, -1.8, 81))
    assert best < 4


def test_one_round_moves_the_average_level_to_the_target():
    table = relight.curve(relight.offset(40.0))
    assert np.interp(40, LEVELS, table) == pytest.approx(128, abs=1e-9)


def test_rounds_bring_the_mean_to_the_target_where_one_leaves_it_off():
    p = np.zeros(256)
    p[[10, 200]] = 0.7, 0.3
    states = list(relight.settle_steps(p))
    assert abs(states[1].mean - 128) > 10 > 0.5 > abs(states[-1].mean - 128)


@pytest.mark.parametrize("level", [0, 255])
def test_a_black_or_white_image_is_not_changed(level):
    Z = np.full((32, 32, 3), level, np.uint8)
    corrected = battiato.correct(Z)
    assert np.array_equal(corrected.picture, Z) and corrected.delta == 0


def test_a_histogram_is_smoothed_over_five_levels():
    smoothed = battiato.histogram(np.full((4, 5), 100.0))
    assert smoothed[98:103] == pytest.approx(np.full(5, 4.0))
    assert smoothed.sum() == pytest.approx(20)


def test_contrast_is_the_mean_distance_from_the_mean():
    half = np.repeat([50.0, 150.0], 32).reshape(8, 8)
    assert battiato.contrast(half) == pytest.approx(50)
    # the smoothing's own: (2+1+0+1+2)/5
    assert battiato.contrast(np.full((8, 8), 90.0)) == pytest.approx(1.2)


def test_focus_measures_an_edge_and_ignores_noise():
    edge = np.repeat([[60.0, 160.0]], 16, axis=0).repeat(8, axis=1)
    grain = 100 + np.random.default_rng(1).normal(0, 2, (16, 16))
    assert battiato.focus(edge) == pytest.approx(2 * 100 / 16) and battiato.focus(grain) < 0.7
    assert battiato.focus(grain, noise=0) > 5


def test_the_blocks_with_detail_are_the_relevant_ones():
    Y = np.full((64, 64), 128.0)
    Y[:16, :16] = np.random.default_rng(2).integers(40, 220, (16, 16))
    relevant = battiato.find_relevant_blocks(Y)
    assert relevant[:16, :16].all() and relevant.sum() == 256


def test_sixty_four_blocks_cover_any_picture():
    for shape in ((480, 640), (63, 65), (3, 5), (1, 1)):
        assert (
            battiato.find_relevant_blocks(np.random.default_rng(0).uniform(0, 255, shape)).shape
            == shape
        )


def test_quarter_size_has_the_red_mean_green_and_blue_of_each_cell():
    mosaic = np.array([[10, 20], [40, 30]], np.uint8)
    assert battiato.quarter_size(mosaic).tolist() == [[[10, 30, 30]]]
    with pytest.raises(ValueError, match="Bayer"):
        battiato.quarter_size(np.zeros((4, 4, 3), np.uint8))


@pytest.mark.parametrize("EV", [12, 12.77, 13.3, 14])
@pytest.mark.parametrize("by", ["auto", "blocks"])
def test_against_the_light_the_relevant_regions_come_to_the_target_within_three_levels(EV, by):
    Z, _ = photographed(EV)
    corrected = battiato.correct(Z, by=by, least=0)
    Y = battiato.brightness(corrected.picture)
    held = corrected.relevant & (battiato.brightness(Z) > 0) & (battiato.brightness(Z) < 255)
    assert Y[held].mean() == pytest.approx(128, abs=3)
    assert corrected.after == pytest.approx(Y[held].mean())


@pytest.mark.parametrize("EV", [12, 12.77, 13.3])
def test_a_backlit_face_is_found_and_correctly_exposed(EV):
    Z, face = photographed(EV)
    corrected = battiato.correct(Z)
    assert corrected.by == "skin" and corrected.relevant[face].mean() > 0.8
    assert (
        battiato.brightness(Z)[face].mean()
        < 60
        < 110
        < battiato.brightness(corrected.picture)[face].mean()
        < 150
    )


def test_a_well_exposed_photo_changes_by_less_than_five_levels():
    for Z in (data.astronaut(), battiato.correct(photographed(13)[0]).picture):
        change = battiato.brightness(battiato.correct(Z).picture) - battiato.brightness(Z)
        assert abs(change.mean()) < 5


def test_a_bayer_mosaic_is_corrected_as_its_picture_is():
    Z, _ = photographed(13)
    mosaic = Z[..., 1].copy()
    mosaic[::2, ::2] = Z[::2, ::2, 0]
    mosaic[1::2, 1::2] = Z[1::2, 1::2, 2]
    of_mosaic = battiato.correct_mosaic(mosaic)
    of_picture = battiato.correct(Z)
    assert of_mosaic.picture.shape == mosaic.shape
    assert of_mosaic.by == of_picture.by == "skin"
    assert of_mosaic.delta == pytest.approx(of_picture.delta, abs=0.3)
    assert of_mosaic.after == pytest.approx(128, abs=3)


def test_a_gray_picture_is_corrected_by_contrast_and_focus():
    Z = (data.brick() // 4).astype(np.uint8)
    corrected = battiato.correct(Z)
    assert corrected.by == "contrast and focus" and corrected.after == pytest.approx(128, abs=3)


@pytest.mark.parametrize("shape", [(0.7, 1.0), (3.0, 0.1)])
def test_another_shape_of_the_response_reaches_the_target_too(shape):
    Z, _ = photographed(13)
    assert battiato.correct(Z, shape=shape).after == pytest.approx(128, abs=3)


@pytest.mark.parametrize("knobs", [dict(target=0), dict(target=255), dict(by="faces")])
def test_invalid_parameters_raise_an_error(knobs):
    with pytest.raises(InputError):
        battiato.correct(data.astronaut()[:64, :64], **knobs)


def test_invalid_images_raise_an_error():
    for bad in (np.zeros((4, 4)), np.zeros((4, 4, 2), np.uint8), np.zeros((0, 4), np.uint8)):
        with pytest.raises(ValueError, match="picture"):
            battiato.correct(bad)
    with pytest.raises(ValueError, match="skin"):
        battiato.correct(data.brick(), by="skin")


def test_every_state_leads_to_the_last():
    assert last(relight.settle_steps(relight.shares(np.full((4, 4), 40)))).mean == pytest.approx(
        128, abs=0.5
    )


# --- skin ---


def portrait(dark):
    """Return the astronaut, her face light or as a dark-skinned woman's, and the masks of face and no face.

    Left out of both are hair, neck and ears, which are neither for sure, and her suit and helmet.
    """
    Z = data.astronaut()
    y, x = np.mgrid[:512, :512]
    wide = ((y - 112) / 75) ** 2 + ((x - 222) / 52) ** 2 < 1
    face = ((y - 122) / 42) ** 2 + ((x - 223) / 30) ** 2 < 1
    light = decode_srgb(Z / 255)
    if dark:
        light[wide] *= decode_srgb(np.array(DARK) / 255) / decode_srgb(np.array(LIGHT) / 255)
    Z = np.round(255 * encode_srgb(light)).astype(np.uint8)
    elsewhere = ~wide & (y < 140)
    return Z, face, elsewhere


FOUND = {  # (way, dark): recall in the face, and share of flag, rocket and wall taken for skin
    ("chrominance", False): (0.76, 0.02),
    ("chrominance", True): (0.91, 0.01),
    ("locus", False): (0.94, 0.11),
    ("locus", True): (0.98, 0.10),
}


@pytest.mark.parametrize(("way", "dark"), FOUND)
def test_skin_is_found_in_light_and_dark_faces(way, dark):
    Z, face, elsewhere = portrait(dark)
    is_skin = skin.FINDERS[way](battiato.brighten(Z))
    recall, mistaken = FOUND[way, dark]
    assert is_skin[face].mean() >= recall and is_skin[elsewhere].mean() <= mistaken


def test_light_and_dark_skin_lie_at_the_same_distance():
    """Both skin patches of the ColorChecker are closer than 1.5, and so are darker shades of them."""
    for tone in (LIGHT, DARK):
        for shade in (1.0, 0.5, 0.25):
            Z = 255 * encode_srgb(shade * decode_srgb(np.array(tone) / 255))
            assert skin.distance(Z) < 1.5


@pytest.mark.parametrize("name", ["brick", "grass", "gravel"])
def test_walls_grass_and_gravel_are_no_skin(name):
    Z = np.repeat(getattr(data, name)()[..., None], 3, axis=-1)
    assert not skin.find_by_chrominance(Z).any() and not skin.find_by_locus(Z).any()


def test_blue_green_and_gray_are_no_skin():
    Z = np.array([[40, 80, 200], [60, 160, 60], [128, 128, 128], [255, 255, 255], [0, 0, 0]])
    assert not skin.find_by_chrominance(Z).any() and not skin.find_by_locus(Z).any()


def test_your_own_training_set_changes_what_counts_as_skin():
    rng = np.random.default_rng(5)
    green = np.array([60, 160, 60]) + rng.normal(0, 4, (500, 3))
    martian = skin.fit(green)
    assert skin.find_by_chrominance(green, martian).mean() > 0.9
    assert not skin.find_by_chrominance(np.array(LIGHT), martian)


def test_the_default_skin_is_that_of_the_computed_training_set():
    fitted = skin.fit(sample_skin())
    assert np.allclose(skin.DEFAULT.mu, fitted.mu, atol=1e-4)
    assert np.allclose(skin.DEFAULT.S, fitted.S, atol=1e-4)


def test_the_density_is_the_gaussian_of_the_distance_and_integrates_to_one():
    mu, S = skin.DEFAULT
    assert skin.likelihood(sample_skin(100)) == pytest.approx(
        np.exp(-(skin.distance(sample_skin(100)) ** 2) / 2)
        / (2 * np.pi * np.sqrt(np.linalg.det(S)))
    )
    inside = skin.find_by_chrominance(sample_skin(4000, rng=9))
    assert 0.9 < inside.mean() < 0.99


def test_training_sets_without_a_covariance_raise_an_error():
    for bad in (np.full((10, 3), 7.0), np.zeros((2, 3)), np.zeros((5, 2))):
        with pytest.raises(ValueError, match="training pixels"):
            skin.fit(bad)


def test_a_mosaic_of_odd_size_loses_its_last_row_and_column():
    mosaic = np.arange(35, dtype=np.uint8).reshape(5, 7)
    quarter = battiato.quarter_size(mosaic)
    assert quarter.shape == (2, 3, 3)
    assert np.array_equal(quarter, battiato.quarter_size(mosaic[:4, :6]))
    assert quarter[1, 2].tolist() == [18, (19 + 25 + 1) // 2, 26]
