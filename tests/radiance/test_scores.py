"""hdrlab.radiance.scores: metrics by their definitions; the ranking depends on metric, unit and
fit.
"""

import numpy as np
import pytest

from hdrlab.radiance import pu21, scores

REFERENCE = np.geomspace(1, 1000, 64 * 64, dtype=np.float32).reshape(64, 64)


def test_psnr_is_relative_to_the_largest_value_of_the_reference():
    assert scores.psnr(REFERENCE + 10, REFERENCE) == pytest.approx(40, abs=1e-3)


def test_log_psnr_is_the_psnr_after_the_mu_law():
    E = 1.5 * REFERENCE
    T = np.log(1 + 5 * E) / np.log(5001)
    T_reference = np.log(1 + 5 * REFERENCE) / np.log(5001)
    expected = -10 * np.log10(np.mean((T - T_reference) ** 2))
    assert scores.log_psnr(E, REFERENCE) == pytest.approx(expected, rel=1e-6)


def test_pu_metrics_show_the_brightest_value_with_the_peak():
    E = 1.2 * REFERENCE
    expected = pu21.psnr(E, REFERENCE, luminance_of_unit=4)
    assert scores.pu_psnr(E, REFERENCE, peak=4000) == pytest.approx(expected)
    expected = pu21.ssim(E, REFERENCE, luminance_of_unit=4)
    assert scores.pu_ssim(E, REFERENCE, peak=4000) == pytest.approx(expected)


@pytest.mark.parametrize("metric", scores.METRICS)
@pytest.mark.parametrize("fit", scores.FITS)
def test_the_true_map_is_the_best_in_every_metric(metric, fit):
    maps = {"dark": 0.8 * REFERENCE**0.95, "true": REFERENCE}
    assert next(iter(scores.score_maps(maps, REFERENCE, metric=metric, fit=fit))) == "true"


@pytest.mark.parametrize("metric", scores.METRICS)
def test_the_unit_of_the_maps_does_not_matter_once_the_peak_is_stated(metric):
    def score(factor):
        maps = {"clipped": factor * np.minimum(REFERENCE, 500)}
        return scores.score_maps(maps, factor * REFERENCE, metric=metric)["clipped"]

    assert score(2.0**-10) == pytest.approx(score(1.0), rel=1e-5)


def test_the_order_turns_with_the_metric_the_peak_and_the_fit():
    maps = {"too bright": 1.2 * REFERENCE, "clipped": np.minimum(REFERENCE, 500)}

    def best(**settings):
        return next(iter(scores.score_maps(maps, REFERENCE, **settings)))

    assert best(metric="PSNR") == "too bright"
    assert best(metric="log PSNR") == "clipped"
    assert best(peak=100) == "too bright"
    assert best(peak=1000) == "clipped"
    assert best(peak=1000, fit="fitted") == "too bright"


def test_equal_scores_keep_the_order_of_the_maps():
    maps = {"b": REFERENCE, "a": REFERENCE * (1 + 1e-7)}
    assert list(scores.score_maps(maps, REFERENCE, metric="PU-SSIM")) == ["b", "a"]


@pytest.mark.parametrize(
    ("reference", "settings", "message"),
    [
        (REFERENCE, {"metric": "beauty"}, "metric must be one of"),
        (REFERENCE, {"fit": "perhaps"}, "fit must be one of"),
        (REFERENCE, {"peak": 0}, "peak above 0"),
        (0 * REFERENCE, {}, "light"),
        (REFERENCE[:32], {"metric": "PSNR"}, "one shape"),
        (REFERENCE[:32], {"metric": "PU-SSIM"}, "one shape"),
    ],
)
def test_what_cannot_be_scored_raises_an_error(reference, settings, message):
    with pytest.raises(ValueError, match=message):
        scores.score_maps({"map": REFERENCE}, reference, **settings)
