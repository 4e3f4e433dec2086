"""hdrlab.tonemap.quality: TMQI, its definition, closed forms, and changes that must lower it."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.ndimage import gaussian_filter
from scipy.stats import beta, norm
from support import laws

from hdrlab import pipeline, scenes
from hdrlab.core.colour import to_8bit
from hdrlab.tonemap import quality, reinhard


def scene(shape=(192, 256), seed=0):
    """Return luminance (H, W) of several decades with detail at all scales."""
    rng = np.random.default_rng(seed)
    lL = sum(2**k * gaussian_filter(rng.standard_normal(shape), 2**k) for k in range(5))
    return np.exp(1.5 * lL).astype(np.float32)


def shown(L):
    return to_8bit(reinhard.tonemap(L))


def defined_S(x, y):
    """Return S computed window by window, with the mean subtracted before squaring."""
    g = np.exp(-0.5 * (np.arange(-5, 6) / 1.5) ** 2)
    w = np.outer(g, g) / g.sum() ** 2
    S = 1.0
    for f, weight in zip((16, 8, 4, 2, 1), (0.0448, 0.2856, 0.3001, 0.2363, 0.1333), strict=True):
        tau = 128 / (1.4 * 100 * 2.6 * (0.0192 + 0.114 * f) * np.exp(-((0.114 * f) ** 1.1)))
        total = []
        for i, j in np.ndindex(x.shape[0] - 10, x.shape[1] - 10):
            window_x = x[i : i + 11, j : j + 11]
            window_y = y[i : i + 11, j : j + 11]
            a = window_x - (w * window_x).sum()
            b = window_y - (w * window_y).sum()
            sa = np.sqrt((w * a * a).sum())
            sb = np.sqrt((w * b * b).sum())
            sab = (w * a * b).sum()
            pa, pb = norm.cdf([sa, sb], loc=tau, scale=tau / 3)
            seen = (2 * pa * pb + 0.01) / (pa**2 + pb**2 + 0.01)
            total.append(seen * (sab + 10) / (sa * sb + 10))
        S *= np.mean(total) ** weight
        h = x.shape[0] // 2 * 2
        v = x.shape[1] // 2 * 2
        x = (x[:h:2, :v:2] + x[1:h:2, :v:2] + x[:h:2, 1:v:2] + x[1:h:2, 1:v:2]) / 4
        y = (y[:h:2, :v:2] + y[1:h:2, :v:2] + y[:h:2, 1:v:2] + y[1:h:2, 1:v:2]) / 4
    return S


@pytest.mark.papers
def test_structural_fidelity_is_its_definition():
    L = scene((177, 179))
    x = quality.scale_luminance(L)
    y = quality.gray(shown(L))
    assert quality.structural_fidelity(x, y) == pytest.approx(defined_S(x, y), rel=1e-6)


def test_the_brightest_pixel_is_the_largest_number_of_32_bits():
    assert quality.scale_luminance(np.float32([[1, 3]])).tolist() == [[0, 2**32 - 1]]


def test_naturalness_is_the_product_of_its_two_densities_over_their_peaks():
    y = quality.gray(shown(scene((110, 121))))
    d = np.mean([b.std() for row in np.split(y, 10) for b in np.split(row, 11, axis=1)]) / 64.29
    P_d = beta.pdf(d, 4.4, 10.1) / beta.pdf(3.4 / 12.5, 4.4, 10.1)
    P_m = norm.pdf(y.mean(), 115.94, 27.99) / norm.pdf(0, 0, 27.99)
    assert quality.naturalness(y) == pytest.approx(P_m * P_d, rel=1e-9)
    assert quality.naturalness(y) > 0.05


@given(S=st.floats(0, 1), N=st.floats(0, 1))
def test_quality_is_a_mean_of_powers(S, N):
    assert quality.overall(S, N) == pytest.approx(0.8012 * S**0.3046 + 0.1988 * N**0.7088)
    assert 0 <= quality.overall(S, N) <= 1 + 1e-12


def test_the_eye_is_most_sensitive_at_eight_cycles_per_degree():
    f = np.arange(0.5, 40, 0.5)
    assert 7 <= f[np.argmax([quality.sensitivity(frequency) for frequency in f])] <= 9
    assert quality.sensitivity(8) == pytest.approx(100, abs=3), "100 is what the paper scales it to"


@pytest.mark.parametrize("f", quality.FREQUENCIES)
def test_contrast_at_the_threshold_is_visible_with_probability_one_half(f):
    tau = quality.threshold(f)
    sigma = np.array([0, tau, 4 / 3 * tau, 100 * tau])
    assert np.allclose(quality.visible(sigma, f), [0.00135, 0.5, 0.84134, 1], atol=1e-5)


def test_a_picture_has_the_structure_of_itself():
    for shape in ((192, 256), (177, 33), (11, 11), (5, 7), (1, 1)):
        y = quality.gray(shown(scene(shape)))
        assert quality.structural_fidelity(y, y) == pytest.approx(1, abs=1e-12)


def test_an_image_has_full_structural_fidelity_to_its_own_luminance():
    picture = np.random.default_rng(0).integers(0, 256, (300, 300), dtype=np.uint8)
    assert quality.tmqi(quality.gray(picture), picture).S > 0.998
    assert quality.tmqi(quality.gray(picture)[::-1], picture).S < 0.3


def test_structural_fidelity_is_symmetric():
    x = quality.gray(shown(scene()))
    y = quality.gray(shown(scene(seed=1)))
    assert quality.structural_fidelity(x, y) == pytest.approx(quality.structural_fidelity(y, x))


def test_the_unit_and_the_black_level_of_the_scene_do_not_matter():
    L = scene()
    known = quality.tmqi(L, shown(L))
    for other in (L * 2.0**-20, L * 2.0**20, L.astype(np.float64) + 1):
        assert quality.tmqi(other, shown(L)) == pytest.approx(known, abs=1e-4)


@pytest.mark.parametrize(
    "worse",
    [
        lambda y, k: gaussian_filter(y, k),
        lambda y, k: np.clip(y, 0, 250 / 2**k),
        lambda y, k: np.clip(y, 255 - 250 / 2**k, 255),
        lambda y, k: y // 4 ** (k + 1) * 4 ** (k + 1),
        lambda y, k: y + 25 * k * np.random.default_rng(0).standard_normal(y.shape),
        lambda y, k: np.roll(y, 2**k, axis=0),
    ],
    ids=["blur", "burnt", "drowned", "few levels", "noise", "displaced"],
)
def test_more_damage_gives_a_lower_fidelity(worse):
    L = scene()
    x = quality.scale_luminance(L)
    y = quality.gray(shown(L))
    S = [quality.structural_fidelity(x, y)]
    S += [quality.structural_fidelity(x, worse(y, k)) for k in (1, 2, 3)]
    assert np.all(np.diff(S) < 0) and S[3] < 0.9 * S[0], S


def test_a_negative_has_a_fidelity_of_0():
    L = scene()
    scores = quality.tmqi(L, 255 - shown(L))
    assert scores.S == 0 and scores.Q == pytest.approx(0.1988 * scores.N**0.7088)


def test_tone_mapping_beats_a_display_that_clips():
    L = scene()
    clipped = to_8bit(np.minimum(L / L.max() * 20, 1))
    assert quality.tmqi(L, shown(L)).Q > quality.tmqi(L, clipped).Q + 0.05


def test_naturalness_is_1_at_the_typical_mean_and_contrast_and_falls_with_the_density():
    checker = np.where(np.indices((110, 110)).sum(axis=0) % 2, 1.0, -1.0)
    y = 115.94 + 64.29 * 3.4 / 12.5 * checker
    assert quality.naturalness(y) == pytest.approx(1, abs=1e-3)
    assert quality.brightness(y + 27.99) == pytest.approx(np.exp(-0.5), abs=1e-3)
    assert quality.contrast(y * 0 + 80) == 0 and quality.contrast(127.5 + 127.5 * checker) == 0


@pytest.mark.parametrize("shape", [(110, 121), (112, 130), (7, 40), (11, 11)])
def test_padded_blocks_are_those_of_the_authors_program(shape):
    """The authors call MATLAB's blkproc, which pads the image with zeros and crops the result."""
    y = quality.gray(shown(scene(shape)))
    filled = np.zeros([-(-side // 11) * 11 for side in shape])
    filled[: shape[0], : shape[1]] = y
    result = np.empty(filled.shape)
    for i, j in np.ndindex(filled.shape[0] // 11, filled.shape[1] // 11):
        block = slice(11 * i, 11 * i + 11), slice(11 * j, 11 * j + 11)
        result[block] = np.std(filled[block], ddof=1)
    d = result[: shape[0], : shape[1]].mean() / 64.29
    P_d = beta.pdf(d, 4.4, 10.1) / beta.pdf(3.4 / 12.5, 4.4, 10.1)
    assert quality.contrast(y, edge_blocks="pad") == pytest.approx(P_d, rel=1e-9, abs=1e-12)


def test_padding_changes_nothing_but_the_divisor_where_all_blocks_are_complete():
    y = quality.gray(shown(scene((110, 121))))
    padded = quality.block_deviation(y, edge_blocks="pad")
    assert padded == pytest.approx(quality.block_deviation(y) * np.sqrt(121 / 120))


def test_padding_counts_as_contrast_and_changes_naturalness_only():
    L = scene((78, 100))
    picture = np.full(L.shape, 116, np.uint8)
    known = quality.tmqi(L, picture)
    padded = quality.tmqi(L, picture, edge_blocks="pad")
    assert known.N == 0 and padded.N > 0
    assert padded.S == known.S
    assert padded.Q == pytest.approx(quality.overall(padded.S, padded.N))


def test_padding_alone_raises_the_naturalness_of_a_small_picture():
    E = scenes.street((128, 192))
    y = quality.gray(pipeline.develop(E, "curves"))
    assert quality.naturalness(y, edge_blocks="pad") > quality.naturalness(y) + 0.2


def test_an_unknown_treatment_of_edge_blocks_raises_an_error():
    with pytest.raises(ValueError, match="edge_blocks must be one of omit, pad"):
        quality.tmqi(scene(), shown(scene()), edge_blocks="mirror")


@pytest.mark.parametrize(
    ("shape", "scales"),
    [((176, 176), 5), ((175, 400), 4), ((21, 300), 1), ((22, 22), 2), ((3, 3), 1)],
)
def test_a_small_picture_has_fewer_scales_and_they_share_the_weight(shape, scales):
    L = scene(shape)
    x = quality.scale_luminance(L)
    y = quality.gray(shown(L))
    fidelities = quality.scale_fidelities(x, y)
    weights = quality.WEIGHTS[:scales]
    assert len(fidelities) == scales
    log_S = np.dot(np.log(fidelities), weights) / sum(weights)
    assert quality.structural_fidelity(x, y) == pytest.approx(np.exp(log_S), rel=1e-3)


@pytest.mark.parametrize("name", laws.RADIANCES)
def test_quality_is_finite_and_from_0_to_1_for_any_radiance(name):
    L = laws.RADIANCES[name]
    noise = np.random.default_rng(0).integers(0, 256, L.shape, dtype=np.uint8)
    for picture in (shown(L), noise, noise * 0, noise // 128 * 255, np.stack([noise] * 3, axis=-1)):
        assert all(0 <= score <= 1 + 1e-12 for score in quality.tmqi(L, picture))


def test_rounding_in_a_bright_uniform_area_does_not_count_as_structure():
    """At 2^32, the rounding of a squared float64 would look like noise with a sigma of 60."""
    L = np.full((40, 60), 0.7, np.float32)
    L[:, :5] = 0
    L[:, 5:10] = 1
    sigma = quality.deviations(quality.scale_luminance(L), quality.scale_luminance(L))[0]
    assert np.all(sigma[:, 15:] == 0) and np.all(sigma[:, :10] > 1e6)


@pytest.mark.parametrize(
    ("L", "picture", "message"),
    [
        (np.ones((4, 5)), np.zeros((5, 4), np.uint8), "scene's"),
        (np.ones((4, 5)), np.zeros((4, 5)), "uint8"),
        (np.ones((4, 5)), np.zeros((4, 5, 4), np.uint8), "picture"),
        (np.full((4, 5), np.nan), np.zeros((4, 5), np.uint8), "20 NaN"),
        (np.ones((4, 5, 3)), np.zeros((4, 5), np.uint8), "luminance"),
    ],
)
def test_images_that_cannot_be_compared_raise_an_error(L, picture, message):
    with pytest.raises(ValueError, match=message):
        quality.tmqi(L, picture)
