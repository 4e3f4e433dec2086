"""Errors of a radiance map as the eye sees them: PU21 (Mantiuk and Azimi, Picture Coding Symposium 2021).

Y            luminance, or one linear color channel      cd/m2, 0.005 to 10,000; any shape
V            PU21 value, equal steps are equally visible 0 to 595; 100 cd/m2 gives 256
p1 ... p7    parameters of the fit
E, reference radiance maps                               (H, W) or (H, W, 3), one unit for both
luminance_of_unit                                        cd/m2 of the value 1 in both maps

PSNR and SSIM were made for pixel values, whose steps are about equally visible. Linear light is
not like that: one more cd/m2 is visible on a dark wall, and invisible on a lamp. PU21 converts
cd/m2 to values whose steps are equally visible, so that PSNR and SSIM work on them.

How visible a step is depends on the absolute luminance. So PU21 needs cd/m2, and a map in relative
units has no PU21 score until somebody decides how bright it is. A score without that number, and
without a statement whether an exposure was fitted, cannot be compared with any other.

The authors published the parameters of four fits, and recommend the one that models banding and
glare, which is the one here. Their program (github.com/gfxdisp/pu21) uses a peak of 256 in PSNR
and SSIM, for any display, so that scores of ordinary displays stay similar to those of pixel values.
"""

import numpy as np

from hdrlab.core.arrays import F32, F64, ArrayLike, as_radiance
from hdrlab.core.colour import luminance
from hdrlab.core.optional import skimage_metrics
from hdrlab.errors import InputError

# p1 to p7 of the fit "banding_glare" [Mantiuk21]
P1 = 0.353487901
P2 = 0.3734658629
P3 = 8.277049286e-05
P4 = 0.9062562627
P5 = 0.09150303166
P6 = 0.9099517204
P7 = 596.3148142
# cd/m2, the range of the fit
MIN_LUMINANCE = 0.005
MAX_LUMINANCE = 10_000.0
# the largest value of PSNR and SSIM, about that of 100 cd/m2
PEAK = 256.0
# of SSIM's Gaussian window of 11 x 11 pixels
WINDOW_SIGMA_PIXELS = 1.5
WINDOW_RADIUS_PIXELS = 5


def encode(Y: ArrayLike) -> F64:
    """Return V = p7 (((p1 + p2 Y^p4) / (1 + p3 Y^p4))^p5 - p6) of luminance Y in cd/m2 [Mantiuk21].

    Luminance outside of 0.005 ... 10,000 cd/m2 is clipped to that range.

    Examples
    --------
    >>> encode([0.005, 100, 10_000]).round(1)
    array([  0. , 256.4, 595.4])
    """
    Y = np.clip(np.asarray(Y, np.float64), MIN_LUMINANCE, MAX_LUMINANCE)
    y = Y**P4
    return P7 * (((P1 + P2 * y) / (1 + P3 * y)) ** P5 - P6)


def decode(V: ArrayLike) -> F64:
    """Return the luminance in cd/m2 of PU21 values, the inverse of `encode`.

    Examples
    --------
    >>> decode(encode([0.1, 100, 4000])).round(6)
    array([1.e-01, 1.e+02, 4.e+03])
    """
    v = np.maximum(np.asarray(V, np.float64) / P7 + P6, 0) ** (1 / P5)
    return (np.maximum(v - P1, 0) / (P2 - P3 * v)) ** (1 / P4)


def psnr(E: ArrayLike, reference: ArrayLike, *, luminance_of_unit: float | None) -> float:
    """Return the PU-PSNR of a radiance map in dB, 10 log10(256^2 / mean (V - V_reference)^2).

    A color map is compared channel by channel, as by the authors' program. Pass luminances for the
    value that it calls PSNRY.

    Parameters
    ----------
    E : (H, W) or (H, W, 3), radiance
    reference : the same shape, radiance in the same unit
    luminance_of_unit : cd/m2 of the value 1, such as `io.radiance.read_luminance_of_unit` gives

    Returns
    -------
    float
        dB; infinity for equal maps. A difference in exposure lowers it: see `fit_exposure`.

    Raises
    ------
    ValueError
        For maps that do not fit together, for a map without a unit, whose `luminance_of_unit` is
        None, and for one whose unit puts all of the reference outside of 0.005 ... 10,000 cd/m2.

    References
    ----------
    Mantiuk and Azimi, PU21: A novel perceptually uniform encoding for adapting existing quality
    metrics for HDR, PCS 2021.

    Examples
    --------
    >>> reference = np.geomspace(1, 1000, 64 * 64).reshape(64, 64)
    >>> bright = psnr(reference * 1.1, reference, luminance_of_unit=1)
    >>> dark = psnr(reference * 1.1, reference, luminance_of_unit=0.01)
    >>> f"{bright:.1f} dB on a bright display, {dark:.1f} dB on a dark one"
    '33.4 dB on a bright display, 40.9 dB on a dark one'
    """
    V, V_reference = _encode_both(E, reference, luminance_of_unit)
    mean_squared_error = np.mean((V - V_reference) ** 2)
    return float(10 * np.log10(PEAK**2 / mean_squared_error)) if mean_squared_error else np.inf


def ssim(E: ArrayLike, reference: ArrayLike, *, luminance_of_unit: float | None) -> float:
    """Return the PU-SSIM of the luminance of a radiance map, at most 1.

    SSIM is that of scikit-image with the settings of Wang et al. (2004): a Gaussian window of
    1.5 pixels, 11 x 11, and population covariances. The authors use MATLAB's ssim, which repeats
    the pixels of the edge five times and takes the mean over all pixels, so this function does
    the same. (scikit-image by itself leaves the outer five pixels out of the mean.)

    Parameters, errors and references are those of `psnr`.

    Examples
    --------
    >>> reference = np.geomspace(1, 1000, 64 * 64).reshape(64, 64)
    >>> ssim(reference, reference, luminance_of_unit=1)
    1.0
    """
    E = luminance(E)
    reference = luminance(reference)
    both = _encode_both(E, reference, luminance_of_unit)
    V, V_reference = (np.pad(image, WINDOW_RADIUS_PIXELS, mode="edge") for image in both)
    similarity = skimage_metrics.structural_similarity(
        V,
        V_reference,
        data_range=PEAK,
        gaussian_weights=True,
        sigma=WINDOW_SIGMA_PIXELS,
        use_sample_covariance=False,
    )
    return float(similarity)


def fit_exposure(E: ArrayLike, reference: ArrayLike) -> float:
    """Return the factor s for which s E has the exposure of the reference: the median ratio of luminances.

    Pixels without light in one of the maps are left out. A score of s E measures errors of contrast,
    color and noise, but not of exposure. So say with each score whether it was fitted.

    Raises
    ------
    ValueError
        For maps that do not fit together, and if no pixel has light in both.

    Examples
    --------
    >>> fit_exposure([[1.0, 2.0, 9.0]], [[4.0, 8.0, 16.0]])
    4.0
    """
    E, reference = _as_pair(E, reference)
    L = luminance(E).astype(np.float64)
    L_reference = luminance(reference).astype(np.float64)
    has_light = (L > 0) & (L_reference > 0)
    if not has_light.any():
        raise InputError("expected maps with a pixel that has light in both, got none")
    return float(np.median(L_reference[has_light] / L[has_light]))


def _as_pair(E: ArrayLike, reference: ArrayLike) -> tuple[F32, F32]:
    """Return two radiance maps of one shape, or raise an InputError."""
    E = as_radiance(E)
    reference = as_radiance(reference)
    if E.shape != reference.shape:
        raise InputError(
            f"expected two radiance maps of one shape, got {E.shape} and {reference.shape}"
        )
    return E, reference


def _encode_both(
    E: ArrayLike, reference: ArrayLike, luminance_of_unit: float | None
) -> tuple[F64, F64]:
    """Return the PU21 values of two maps, or raise an InputError if their unit is not known."""
    E, reference = _as_pair(E, reference)
    if luminance_of_unit is None:
        raise InputError(
            "PU21 needs luminance in cd/m2, and this map is in relative units; state its "
            "luminance_of_unit, the cd/m2 of the value 1"
        )
    if not 0 < luminance_of_unit < np.inf:
        raise InputError(
            f"expected a luminance_of_unit above 0 and finite, in cd/m2, got {luminance_of_unit}"
        )
    Y = luminance_of_unit * E.astype(np.float64)
    Y_reference = luminance_of_unit * reference.astype(np.float64)
    darkest = Y_reference.min()
    brightest = Y_reference.max()
    if brightest < MIN_LUMINANCE or darkest > MAX_LUMINANCE:
        raise InputError(
            f"expected a reference with luminance in {MIN_LUMINANCE} ... {MAX_LUMINANCE:,.0f} cd/m2, "
            f"got {darkest:.3g} ... {brightest:.3g}; is its luminance_of_unit right?"
        )
    return encode(Y), encode(Y_reference)
