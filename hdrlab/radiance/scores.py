"""Score radiance maps against a reference in four metrics, to see how their order depends on the metric.

E, reference  radiance maps                       (H, W) or (H, W, 3), one linear unit
peak          luminance of the brightest pixel of the reference    cd/m2
H             radiance over the largest radiance of the reference  0 to 1
T             H after the mu-law                                   0 to 1

The metrics:

- PSNR of linear radiance: the brightest pixels decide.
- Log PSNR, the PSNR of T = ln(1 + mu H) / ln(1 + mu) with mu = 5000, as papers about deghosting
  report it since Kalantari and Ramamoorthi, Deep high dynamic range imaging of dynamic scenes,
  SIGGRAPH 2017.
- PU-PSNR, of perceptually uniform values, see `radiance.pu21`. It depends on `peak`.
- PU-SSIM, structural similarity of perceptually uniform luminance. It depends on `peak`.

Maps are relative, so PU21 needs a decision how bright they are shown. As in the example of its
authors, the brightest pixel of the reference becomes the peak of a display.
"""

from collections.abc import Callable, Mapping

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, as_radiance
from hdrlab.core.choices import require_choice
from hdrlab.errors import InputError
from hdrlab.radiance import pu21

# of the mu-law: H = 1 / 5000 is where it changes from linear to logarithmic
MU = 5000.0
# whether a factor between map and reference is removed before the comparison
FITS = ("not fitted", "fitted")
# scores that differ less are equal
REPORTED_DECIMALS = 3


def psnr(E: ArrayLike, reference: ArrayLike) -> float:
    """Return 10 log10(max(reference)^2 / mean (E - reference)^2), in dB; infinity for equal maps."""
    E, reference = _as_normalized_pair(E, reference)
    return _decibels(E, reference)


def log_psnr(E: ArrayLike, reference: ArrayLike) -> float:
    """Return the PSNR of T = ln(1 + mu H) / ln(1 + mu), in dB [Kalantari17]; infinity for equal maps."""
    E, reference = _as_normalized_pair(E, reference)
    return _decibels(compress(E), compress(reference))


def compress(H: ArrayLike) -> F64:
    """Return T = ln(1 + mu H) / ln(1 + mu) of values with a peak of 1, the mu-law [Kalantari17].

    Examples
    --------
    >>> compress([0, 1 / 5000, 1]).round(3)
    array([0.   , 0.081, 1.   ])
    """
    return np.log1p(MU * np.asarray(H, np.float64)) / np.log1p(MU)


def pu_psnr(E: ArrayLike, reference: ArrayLike, *, peak: float) -> float:
    """Return the PU-PSNR in dB if the brightest value of the reference is shown with `peak` cd/m2."""
    return pu21.psnr(E, reference, luminance_of_unit=_unit_of_peak(reference, peak))


def pu_ssim(E: ArrayLike, reference: ArrayLike, *, peak: float) -> float:
    """Return the PU-SSIM if the brightest value of the reference is shown with `peak` cd/m2."""
    return pu21.ssim(E, reference, luminance_of_unit=_unit_of_peak(reference, peak))


# name -> function of a map, the reference and the peak; larger is better in each
METRICS: dict[str, Callable[[ArrayLike, ArrayLike, float], float]] = {
    "PSNR": lambda E, reference, peak: psnr(E, reference),
    "log PSNR": lambda E, reference, peak: log_psnr(E, reference),
    "PU-PSNR": lambda E, reference, peak: pu_psnr(E, reference, peak=peak),
    "PU-SSIM": lambda E, reference, peak: pu_ssim(E, reference, peak=peak),
}


def score_maps(
    maps: Mapping[str, ArrayLike],
    reference: ArrayLike,
    *,
    metric: str = "PU-PSNR",
    peak: float = 1000.0,
    fit: str = "not fitted",
) -> dict[str, float]:
    """Return the score of each map, best first.

    Parameters
    ----------
    maps : name -> (H, W) or (H, W, 3), radiance in the unit of the reference
    reference : (H, W) or (H, W, 3), the true radiance
    metric : one of `METRICS`
    peak : cd/m2 of the brightest value of the reference; PSNR and log PSNR do not depend on it
    fit : "not fitted", or "fitted" to multiply each map by `pu21.fit_exposure` first

    Raises
    ------
    ValueError
        For an unknown metric or fit, a peak that is not positive, a reference without light, and
        for maps of another shape.

    References
    ----------
    Mantiuk and Azimi, PU21, PCS 2021; Kalantari and Ramamoorthi, SIGGRAPH 2017.

    Examples
    --------
    >>> reference = np.geomspace(1, 1000, 64 * 64).reshape(64, 64)
    >>> maps = {"too bright": 1.2 * reference, "clipped": np.minimum(reference, 500)}
    >>> list(score_maps(maps, reference, peak=100))
    ['too bright', 'clipped']
    >>> list(score_maps(maps, reference, peak=1000))
    ['clipped', 'too bright']
    """
    require_choice("metric", metric, METRICS)
    require_choice("fit", fit, FITS)
    scores = {}
    for name, E in maps.items():
        if fit == "fitted":
            E = pu21.fit_exposure(E, reference) * as_radiance(E)
        scores[name] = METRICS[metric](E, reference, peak)
    return sort_scores(scores)


def sort_scores(scores: Mapping[str, float]) -> dict[str, float]:
    """Return scores, best first; those that agree to three decimals keep their order.

    Examples
    --------
    >>> sort_scores({"a": 0.5, "b": 0.9, "c": 0.5001})
    {'b': 0.9, 'a': 0.5, 'c': 0.5001}
    """
    return dict(sorted(scores.items(), key=lambda item: -round(item[1], REPORTED_DECIMALS)))


def _as_normalized_pair(E: ArrayLike, reference: ArrayLike) -> tuple[F64, F64]:
    """Return both maps over the largest value of the reference, or raise an InputError."""
    E = as_radiance(E)
    reference = as_radiance(reference)
    if E.shape != reference.shape:
        raise InputError(
            f"expected two radiance maps of one shape, got {E.shape} and {reference.shape}"
        )
    largest = _largest(reference)
    return E.astype(np.float64) / largest, reference.astype(np.float64) / largest


def _largest(reference: ArrayLike) -> float:
    """Return the largest value of a reference, or raise an InputError if it has no light."""
    largest = float(as_radiance(reference).max())
    if largest == 0:
        raise InputError("expected a reference with light, got one that is black")
    return largest


def _unit_of_peak(reference: ArrayLike, peak: float) -> float:
    """Return the cd/m2 of the value 1 for which the reference reaches `peak`."""
    if not 0 < peak < np.inf:
        raise InputError(f"expected a peak above 0 and finite, in cd/m2, got {peak}")
    return peak / _largest(reference)


def _decibels(values: F64, reference: F64) -> float:
    """Return the PSNR of values with a peak of 1."""
    mean_squared_error = np.mean((values - reference) ** 2)
    return float(-10 * np.log10(mean_squared_error)) if mean_squared_error else np.inf
