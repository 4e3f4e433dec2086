"""Calibration with a chart of 24 patches (Mitsunaga and Nayar, 1999, fig. 6; Wilburn et al., 2008, sec. 5).

R  reflectance      (6,) of the bottom row, white to black: the share of the light that a patch gives back
M  brightness       (4, 6[, 3]) of the patches, 0 to 1
t  exposure times   (P,) seconds
X  exposure         R times the light; of one patch in many photographs, t times what it gives back

One photograph gives six points of the inverse response, by the reflectances that are known. Several with
different times need none: along one patch exposure is proportional to time, which is a blend of its own with
a scale, the patch's brightness in that place under that light, and no offset. `joining` finds the scales and
one curve: Wilburn's ground truth.

The reflectances are the specification of the chart, McCamy, Marcus and Davidson, A color-rendition chart,
1976, as the package colour-science lists it ("ColorChecker 1976"). Printed charts differ: BabelColor's mean
of 30 is 1.4 % above it for white, 3.3 % below for neutral 5, and 2.2 % above for black. Whoever has measured
a chart passes its own R.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator

from hdrlab.calibration import joining
from hdrlab.calibration.blends import HIGH, LOW, POINTS, Joined, blend, unit
from hdrlab.calibration.patch_grid import read
from hdrlab.core.arrays import as_stack, as_times, describe

Float = NDArray[np.float64]
ROWS, COLUMNS = 4, 6
GAP = 0.15  # about what the classic chart has between its patches, over a patch's width
LUMINOUS = np.array(  # Y of the patches in %, row by row, under illuminant C
    [
        [10.05, 35.82, 19.33, 13.29, 24.27, 43.06],
        [30.05, 12.00, 19.77, 6.56, 44.29, 43.06],
        [6.11, 23.39, 12.00, 59.10, 19.77, 19.77],
        [90.01, 59.10, 36.20, 19.77, 9.00, 3.13],
    ]
)
LUMINOUS.setflags(write=False)
NEUTRAL = LUMINOUS[3] / 100  # gray reflects all wavelengths alike: R in every channel


def read_chart(image: ArrayLike, corners: ArrayLike, *, gap: float = GAP, core: float = 0.6) -> Float:
    """Return M (4, 6[, 3]), the mean brightness of the chart's patches, dark skin first and black last.

    Parameters
    ----------
    image : (H, W) or (H, W, 3) uint8 or uint16
        A photograph of the chart, evenly lit.
    corners : (4, 2)
        Pixels (x, y): the outer corners of dark skin, bluish green, black and white, in this order; so a
        chart that stands on its head or lies on its side is read as well.
    gap : float
        Space between two patches over a patch's width.
    core : float
        The fraction of a patch's width and height that is read.

    Raises
    ------
    ValueError
        For an image or corners that are none.

    Examples
    --------
    >>> chart = np.kron(LUMINOUS * 2.5, np.ones((20, 20))).astype(np.uint8)
    >>> M = read_chart(chart, [[-0.5, -0.5], [119.5, -0.5], [119.5, 79.5], [-0.5, 79.5]], gap=0)
    >>> bool(np.allclose(M[3], np.floor(NEUTRAL * 250) / 255))
    True
    """
    return read(image, corners, ROWS, COLUMNS, gap=gap, core=core)


def recover_gray(M: ArrayLike, R: ArrayLike = NEUTRAL, *, low: float = LOW, high: float = HIGH) -> Joined:
    """Return the inverse response through the gray patches, interpolated so that it rises (PCHIP).

    Parameters
    ----------
    M : (K,) float
        Brightness of the patches in one channel, 0 to 1.
    R : (K,) float
        Their reflectances: those of the specification, or better the chart's own.
    low, high : float
        The brightnesses that are measurements.

    Returns
    -------
    Joined
        From the darkest patch measured to the brightest; s is what reflectance 1 has, r what none has, so
        that `blends.ln_exposure(joined, black=joined.r[0])` is the chapter's g.

    Raises
    ------
    ValueError
        For fewer than three patches measured, or ones whose brightness does not rise with their reflectance.

    Examples
    --------
    >>> joined = recover_gray(0.9 * NEUTRAL ** 0.5)
    >>> true = (joined.M / 0.9) ** 2  # a camera with f = 0.9 root
    >>> bool(np.abs(joined.X - (true - true[0]) / (true[-1] - true[0])).max() < 0.01)
    True
    """
    M, R = np.asarray(M, np.float64), np.asarray(R, np.float64)
    samples = blend(R, M, low=low, high=high)
    order = np.argsort(samples.I)
    x, m = samples.I[order], samples.M[order]
    if len(x) < 3:
        raise ValueError(
            f"expected three gray patches within {low:.3g} to {high:.3g}, got {len(x)} of {describe(M)}"
        )
    if np.any(np.diff(x) <= 0) or np.any(np.diff(m) <= 0):
        raise ValueError(
            f"expected patches that are brighter the more they reflect, got {m.round(4).tolist()}"
        )
    at = np.linspace(m[0], m[-1], POINTS)
    return unit(at, np.asarray(PchipInterpolator(m, x)(at)), np.ones(1), np.zeros(1))


def ground_truth(
    M: ArrayLike, times: ArrayLike, *, low: float = LOW, high: float = HIGH, **knobs: Any
) -> Joined:
    """Return the inverse response that patches photographed with several times join in [Wilburn08 sec. 5].

    Parameters
    ----------
    M : (P, K) float
        Brightness of K patches in P photographs, one channel, 0 to 1. Any patches will do, coloured ones too.
    times : (P,) float
        Seconds.
    low, high : float
        The brightnesses that are measurements.
    **knobs
        Of `joining.join`.

    Returns
    -------
    Joined
        s is each patch's exposure per second; r is what no light has.

    Raises
    ------
    ValueError
        For arrays that do not fit together, or no patch measured at three times.

    Examples
    --------
    >>> times = 2.0 ** np.arange(-6, 1, 0.5)
    >>> M = np.minimum(np.outer(times, NEUTRAL), 1) ** (1 / 2.2)
    >>> joined = ground_truth(M, times)
    >>> bool(np.allclose(joined.s / joined.s[0], NEUTRAL / NEUTRAL[0], rtol=0.01))
    True
    """
    M = np.asarray(M, np.float64)
    if M.ndim != 2:
        raise ValueError(f"expected brightness (P, K) of K patches in P photographs, got {describe(M)}")
    times = as_times(times, len(M))
    patches = [blend(times, one, low=low, high=high) for one in M.T]
    return joining.join(patches, offset=False, **knobs)


def read_bracket(images: ArrayLike, corners: ArrayLike, **knobs: float) -> Float:
    """Return M (P, 24[, 3]) of photographs (P, H, W[, 3]) from one place; knobs of `read_chart`."""
    stack = as_stack(images)
    return np.stack(
        [read_chart(image, corners, **knobs).reshape(ROWS * COLUMNS, *stack.shape[3:]) for image in stack]
    )
