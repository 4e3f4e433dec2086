"""hdrlab.tonemap.reinhard: the equations, the search for neighborhoods, the laws in every mode."""

import shutil
import subprocess
from functools import partial

import cv2
import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.ndimage import gaussian_filter
from support import laws

from hdrlab.core.colour import luminance
from hdrlab.core.steps import last
from hdrlab.errors import InputError
from hdrlab.fast import reinhard as fast
from hdrlab.tonemap import reinhard

KNOBS = {
    "local": {"local": True},
    "automatic key": {"key": "auto"},
    "nothing burns": {"white": np.inf},
    "local, white 2": {"local": True, "white": 2.0},
}
MODES = {name: partial(fast.tonemap, **knobs) for name, knobs in KNOBS.items()}
MODES |= {
    f"{name}, the lesson": partial(reinhard.tonemap, **knobs) for name, knobs in KNOBS.items()
}


@pytest.mark.parametrize("law", laws.ALWAYS, ids=lambda law: law.__name__)
@pytest.mark.parametrize("mode", MODES)
def test_every_mode_obeys_the_laws(mode, law):
    """The lesson also refuses invalid radiance, but it does not count the pixels."""
    if "lesson" in mode and law is laws.refuses_and_counts_invalid_radiance:
        for value in (np.nan, np.inf, -1.0):
            with pytest.raises(ValueError, match="luminance"):
                MODES[mode](np.float32([[1, value]]))
    else:
        law(MODES[mode])


@pytest.mark.parametrize("mode", MODES)
def test_the_unit_of_luminance_does_not_matter_in_any_mode(mode):
    laws.exposure(MODES[mode])


@pytest.mark.parametrize("mode", [mode for mode in MODES if "local" not in mode])
def test_every_global_mode_is_monotone(mode):
    laws.monotone(MODES[mode])


@given(level=st.floats(1e-9, 1e9), key=st.floats(0.01, 2))
def test_a_flat_scene_maps_to_key_over_one_plus_key(level, key):
    flat = np.full((9, 9), level)
    for local in (False, True):
        assert np.allclose(
            reinhard.tonemap(flat, key=key, white=np.inf, local=local), key / (1 + key), rtol=1e-4
        )


def test_log_average_is_the_geometric_mean_and_black_pixels_count_as_delta():
    assert reinhard.log_average(np.float32([[1, 100]])) == pytest.approx(10, rel=1e-4)
    assert reinhard.log_average(np.float32([[0, 1, 1, 1]])) == pytest.approx(
        10 ** (-6 / 4), rel=1e-3
    )
    assert reinhard.log_average(np.float32([[0, 1, 1, 1]]), delta=1e-2) == pytest.approx(
        10 ** (-2 / 4), rel=2e-2
    )


def test_scaling_brings_the_log_average_to_the_key():
    Lm = reinhard.scale_to_key(laws.scene(), key=0.36)
    assert reinhard.log_average(Lm) == pytest.approx(0.36, rel=1e-4)


@pytest.mark.parametrize("white", [1.0, 2.0, 4.0, 9.0])
def test_white_is_the_lowest_scaled_luminance_that_becomes_white(white):
    Lm = np.float32([[0.98 * white, white, 2 * white]])
    below, at, above = reinhard.display(Lm, Lm, white)[0]
    assert 0.95 < below < 1
    assert at == pytest.approx(1) and above == 1


def test_an_infinite_white_gives_the_simple_curve_and_white_at_1_changes_nothing():
    Lm = np.float32([[0.1, 0.5, 1]])
    assert np.allclose(reinhard.display(Lm, Lm), Lm / (1 + Lm))
    assert np.allclose(reinhard.display(Lm, Lm, 1.0), Lm)


@pytest.mark.parametrize("local", [False, True])
def test_white_is_respected_in_both_modes(local):
    L = laws.scene()
    burnt = [
        np.mean(reinhard.tonemap(L, white=white, local=local) == 1) for white in (0.5, 2, 8, np.inf)
    ]
    assert burnt[0] > burnt[1] > burnt[2] > burnt[3]
    assert local or burnt[3] == 0
    means = [reinhard.tonemap(L, white=white, local=local).mean() for white in (0.5, 2, 8, np.inf)]
    assert np.all(np.diff(means) < 0)


def test_a_higher_key_is_a_brighter_picture():
    L = laws.scene()
    for local in (False, True):
        darker = reinhard.tonemap(L, key=0.09, white=np.inf, local=local)
        brighter = reinhard.tonemap(L, key=0.36, white=np.inf, local=local)
        assert np.all(brighter > darker) or (local and np.mean(brighter > darker) > 0.98)


def test_the_automatic_key_follows_the_histogram():
    low_key = np.geomspace(1, 1e4, 5000, dtype=np.float32)[None]
    assert reinhard.automatic_key(low_key) == pytest.approx(0.18, rel=0.01), (
        "even in log: middle gray"
    )
    mostly_bright = np.concatenate([low_key, np.full((1, 15000), 9000, np.float32)], axis=1)
    mostly_dark = np.concatenate([low_key, np.full((1, 15000), 1.1, np.float32)], axis=1)
    assert 0.3 < reinhard.automatic_key(mostly_bright) <= 0.72
    assert 0.045 <= reinhard.automatic_key(mostly_dark) < 0.1
    assert reinhard.automatic_key(np.full((4, 4), 7, np.float32)) == 0.18


def test_a_hot_pixel_does_not_change_the_automatic_key():
    L = laws.scene()
    assert reinhard.automatic_key(laws.hot_pixel(L)) == pytest.approx(
        reinhard.automatic_key(L), rel=0.01
    )


def test_the_widths_are_the_papers():
    assert len(reinhard.WIDTHS) == 9
    assert reinhard.WIDTHS[0] == 1
    assert round(reinhard.WIDTHS[-1]) == 43
    assert np.allclose(np.divide(reinhard.WIDTHS[1:], reinhard.WIDTHS[:-1]), 1.6)


def test_a_blur_has_the_papers_profile():
    """exp(-r^2 / (alpha s)^2) with alpha = 1 / (2 sqrt 2), normalized to the sum 1."""
    point = np.zeros((121, 121), np.float32)
    point[60, 60] = 1
    r2 = np.sum((np.indices(point.shape) - 60) ** 2, axis=0)
    for s, blurred in zip(reinhard.WIDTHS, reinhard.blurs(point), strict=True):
        profile = np.exp(-r2 / (s / (2 * np.sqrt(2))) ** 2)
        assert np.abs(blurred - profile / profile.sum()).max() < 1e-3 * blurred.max()


def test_the_response_is_its_formula():
    V = reinhard.response(np.float32([3.0]), np.float32([1.0]), width=4.0, key=0.18, phi=8.0)
    assert V[0] == pytest.approx(2 / (256 * 0.18 / 16 + 3))


def test_a_neighbourhood_grows_until_it_meets_an_edge():
    L = np.full((120, 160), 1.0, np.float32)
    L[:, 80:] = 3000.0
    index = reinhard.select_widths(reinhard.scale_steps(reinhard.blurs(reinhard.scale_to_key(L))))
    row = index[60, 80:].astype(int)  # away from the edge, on its bright side
    assert row[0] < 2 and row[-1] == 7 and np.all(np.diff(row) >= 0)


def test_every_step_of_the_search_is_the_definition():
    Lm = reinhard.scale_to_key(laws.scene())
    V1 = list(reinhard.blurs(Lm))
    even = np.ones(Lm.shape, bool)
    adaptation = V1[0]
    for i, scale in enumerate(reinhard.scale_steps(V1)):
        V = (V1[i] - V1[i + 1]) / (2**8 * 0.18 / 1.6 ** (2 * i) + V1[i])
        even = even & (np.abs(V) < 0.05)
        adaptation = np.where(even, V1[i], adaptation)
        assert scale.width == pytest.approx(1.6**i) and scale.centre is V1[i]
        assert np.allclose(scale.response, V, atol=1e-6)
        assert np.mean(scale.even != even) < 1e-3 and np.mean(scale.adaptation != adaptation) < 1e-3
    assert i == 7


def test_the_selected_widths_give_the_local_adaptation():
    V1 = list(reinhard.blurs(reinhard.scale_to_key(laws.scene())))
    index = reinhard.select_widths(reinhard.scale_steps(V1))
    picked = np.take_along_axis(np.array(V1), index[None].astype(int), axis=0)[0]
    assert np.array_equal(picked, last(reinhard.scale_steps(V1)).adaptation)
    assert index.dtype == np.uint8 and len(np.unique(index)) > 4


@pytest.mark.parametrize("shape", [(1, 1), (2, 3), (63, 65), (64, 64), (200, 131)])
def test_computing_in_bands_gives_the_same_result_as_the_whole_image(shape):
    Lm = reinhard.scale_to_key(laws.scene(shape))
    whole = last(reinhard.scale_steps(reinhard.blurs(Lm))).adaptation
    close = np.isclose(fast.local_adaptation(Lm), whole, rtol=1e-4)
    assert np.mean(close) > 0.999  # rounding may tip a response at the threshold


def test_dodge_and_burn_is_within_one_percent_of_plain_gaussians_at_full_size():
    Lm = reinhard.scale_to_key(laws.scene((300, 400)))
    plain = [gaussian_filter(Lm.astype(np.float64), s / 4) for s in reinhard.WIDTHS]
    for V1, exact in zip(reinhard.blurs(Lm), plain, strict=True):
        assert np.abs(V1 / exact - 1).max() < 1e-4
    exact = last(reinhard.scale_steps(plain)).adaptation
    difference = np.abs(
        reinhard.display(Lm, fast.local_adaptation(Lm)) / np.minimum(Lm / (1 + exact), 1) - 1
    )
    assert np.mean(difference < 0.01) > 0.9999 and difference.mean() < 1e-4


def test_dodge_and_burn_keeps_local_contrast_that_the_global_curve_flattens():
    """Fine bars on a very bright wall: dodge and burn keeps their ratio, the global curve does not."""
    bars = np.where(np.arange(200) % 8 < 4, 1.0, 1.3) * np.ones((160, 1))
    L = np.where(np.arange(160)[:, None] < 80, 500 * bars, 0.5)
    ratios = []
    for local in (False, True):
        wall = reinhard.tonemap(L, white=np.inf, local=local)[20:40, 80:120]
        ratios.append(np.percentile(wall, 90) / np.percentile(wall, 10))
    assert ratios[0] < 1.06 and ratios[1] > 1.15


def pfstmo(L, *options):
    """Return the luminance that pfstmo_reinhard02 computes, through a pipe in the pfs format."""
    if not shutil.which("pfstmo_reinhard02"):
        pytest.skip("pfstools is not installed")
    head = f"PFS1\n{L.shape[1]} {L.shape[0]}\n3\n0\n" + "".join(f"{c}\n0\n" for c in "XYZ") + "ENDH"
    command = ["pfstmo_reinhard02", *options]
    frames = head.encode() + 3 * L.tobytes()
    answer = subprocess.run(command, input=frames, capture_output=True, check=True).stdout
    body = answer[answer.index(b"ENDH") + 4 :]
    return np.frombuffer(body, np.float32).reshape(3, *L.shape)[1]


def test_the_global_curve_equals_that_of_pfstools():
    """pfstools always uses the brightest pixel as white."""
    L = laws.scene((120, 160))
    brightest = float(reinhard.scale_to_key(L).max())
    assert np.abs(reinhard.tonemap(L, white=brightest) - pfstmo(L)).max() < 1e-3


def test_dodge_and_burn_is_close_to_pfstools():
    """They are not equal: the eight widths of pfstools run from 1 to 43 in other steps."""
    L = laws.scene((240, 320))
    ours = reinhard.tonemap(L, white=np.inf, local=True)
    theirs = np.minimum(pfstmo(L, "-s"), 1)
    assert np.corrcoef(ours.ravel(), theirs.ravel())[0, 1] > 0.98
    assert np.median(np.abs(ours - theirs)) < 0.02


@pytest.mark.parametrize(
    "knobs", [{"key": 0}, {"key": -1}, {"key": "bright"}, {"white": 0}, {"white": np.nan}]
)
@pytest.mark.parametrize("tonemap", [reinhard.tonemap, fast.tonemap])
def test_invalid_parameters_raise_an_error(tonemap, knobs):
    with pytest.raises(InputError):
        tonemap(np.ones((3, 3)), **knobs)
    with pytest.raises(ValueError, match="threshold"):
        tonemap(np.ones((3, 3)), local=True, threshold=0)


def test_real_maps_are_displayed_well_exposed(shared):
    E = cv2.imread(str(shared("hdri_cc0") / "lobby.hdr"), cv2.IMREAD_UNCHANGED)
    L = luminance(E[..., ::-1])
    for local in (False, True):
        Ld = reinhard.tonemap(L, local=local)
        assert 0.05 < np.median(Ld) < 0.4 and np.mean(Ld == 1) < 0.001
