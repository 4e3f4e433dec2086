"""Out-of-gamut colours: negative channels, other primaries, and values that are not finite.

E          radiance            (H, W, 3), linear, primaries of sRGB; or (H, W), gray
L          luminance of E      (H, W), same unit; at least half of that of its channels above 0
t          how much of its colour a pixel keeps     1 all, 0 none: (1 - t) L + t E
n          how far its least channel is below 0     >= 0, unit of E
primaries  x and y of red, green, blue and white    8 numbers, CIE 1931

A channel below 0 is a color more saturated than the primaries can mix, or noise around black.
Clipping it would raise the luminance and leave the pixel fully saturated, so that shadows would be
full of magenta and green pixels. Instead, such a pixel moves toward the gray of its own luminance.

With t = L / (L + n) it moves until no channel is below 0, which is right for colors of other
primaries (`desaturate`). For noise that is not enough, because the channel that becomes 0 is a
random one. There t is squared (`sanitize`), so that little color remains where n is large and L is
small. The luminance does not change, unless the negative channels cancel more than half of the light
of the others. Then half of that light is kept, so that shadows keep their detail.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from hdrlab.core.arrays import F32, F64, ArrayLike, Mask, describe
from hdrlab.core.colour import LUMINANCE
from hdrlab.errors import InputError

SRGB = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)  # ITU-R BT.709, white D65
# of screens that show more colours: ITU-R BT.2020, and Display P3, whose primaries are of SMPTE RP
# 431-2
WIDE = {"bt2020": (0.708, 0.292, 0.170, 0.797, 0.131, 0.046, *SRGB[6:])}
WIDE |= {"p3": (0.680, 0.320, 0.265, 0.690, 0.150, 0.060, *SRGB[6:])}
BRADFORD = np.array(
    [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]
)


@dataclass(frozen=True, kw_only=True, eq=False)
class Sanitized:
    """Radiance that every operator takes, and counts of what was repaired.

    Attributes
    ----------
    E : (H, W) or (H, W, 3) float32, finite and not negative
    unknown : pixels with a NaN or a negative infinity, which took the mean of their known
        neighbours
    infinite : values that took the largest finite one
    negative : pixels with a channel below 0 and one above, which moved toward gray
    black : pixels with a channel below 0 and none above, which became black
    """

    E: F32
    unknown: int
    infinite: int
    negative: int
    black: int


def sanitize(E: ArrayLike, *, weights: ArrayLike = LUMINANCE) -> Sanitized:
    """Return valid radiance for any floats: unknown pixels filled, out-of-gamut colors moved to gray.

    Parameters
    ----------
    E : (H, W) or (H, W, 3), any values
    weights : of the channels in L; those of sRGB by default

    Returns
    -------
    Sanitized
        The radiance, and counts. An infinite value becomes the largest finite one of the map. A
        pixel with a NaN or -inf is not known in any channel; it becomes the mean of those of its
        eight neighbours that are known, and black where none is. Then channels below 0 make their
        pixel less colourful, or black.

    Raises
    ------
    ValueError
        For another shape, and for what are no numbers.

    Examples
    --------
    >>> result = sanitize([[[0.2, 0.4, -0.1], [np.nan, 1.0, 1.0], [0.2, 0.4, np.inf]]])
    >>> result.E[0, 0].round(3)  # its luminance is still 0.321
    array([0.251, 0.367, 0.076], dtype=float32)
    >>> result.unknown, result.infinite, result.negative, result.black
    (1, 1, 1, 0)
    """
    array = np.asanyarray(E)
    fits = array.ndim == 2 or (array.ndim == 3 and array.shape[2] == 3)
    if not fits or 0 in array.shape or array.dtype.kind not in "iuf" or np.ma.is_masked(array):
        raise InputError(f"expected radiance (H, W) or (H, W, 3), got {describe(array)}")
    with np.errstate(over="ignore"):
        values = np.asarray(array).astype(np.float32)
    planes = values.reshape(*values.shape[:2], -1)
    infinite = planes == np.inf
    planes[infinite] = max(0.0, planes[np.isfinite(planes)].max(initial=0))
    known: Mask = np.asarray(np.isfinite(planes).all(axis=-1))
    if not known.all():
        planes[~known] = mean_known(planes, known)[~known]
    below = planes.min(axis=-1) < 0
    dark = below & (planes.max(axis=-1) <= 0)
    E = desaturate(values, power=2, weights=weights) if below.any() else values
    return Sanitized(
        E=E,
        unknown=int(np.count_nonzero(~known)),
        infinite=int(np.count_nonzero(infinite)),
        negative=int(np.count_nonzero(below & ~dark)),
        black=int(np.count_nonzero(dark)),
    )


def mean_known(planes: F32, known: Mask) -> F32:
    """Return the mean of the known pixels of each 3 x 3, (H, W, C); 0 where there is none."""
    share = scipy.ndimage.uniform_filter(known.astype(np.float32), 3, mode="constant")
    # sums of which float32 may not hold
    light = np.where(known[..., None], planes, 0).astype(np.float64)
    total = scipy.ndimage.uniform_filter(light, (3, 3, 1), mode="constant")
    return np.where(share[..., None] > 0.05, total / np.maximum(share, 0.05)[..., None], 0)


def desaturate(E: F32, *, power: int = 1, weights: ArrayLike = LUMINANCE) -> F32:
    """Return (1 - t) L + t E, t = (L / (L + n))^power, where a channel is n below 0; E itself elsewhere.

    Hue, the direction away from gray, stays, and luminance as far as it is to be trusted. Without a
    channel above 0 a pixel is black.
    """
    planes = E.reshape(*E.shape[:2], -1)
    below = planes.min(axis=-1) < 0
    lost = planes[below].astype(np.float64)
    repaired = planes.copy()
    w = np.asarray(weights, np.float64) if planes.shape[2] == 3 else np.ones(1)
    L = np.maximum(lost @ w, np.maximum(lost, 0) @ np.maximum(w, 0) / 2)
    t = (L / (L - lost.min(axis=-1))) ** power
    repaired[below] = np.maximum(L[:, None] + t[:, None] * (lost - L[:, None]), 0)
    return repaired.reshape(E.shape)


def xyz_matrix(primaries: Sequence[float]) -> F64:
    """Return the matrix from linear RGB of these primaries to CIE XYZ, white to Y = 1 [SMPTE RP 177]."""
    x, y = np.array(primaries, np.float64).reshape(4, 2).T
    XYZ = np.stack([x / y, np.ones(4), (1 - x - y) / y])
    return XYZ[:, :3] * np.linalg.solve(XYZ[:, :3], XYZ[:, 3])


def conversion_matrix(primaries: Sequence[float], target: Sequence[float] = SRGB) -> F64:
    """Return the matrix from linear RGB of these primaries to that of others, white to white (Bradford)."""
    source = xyz_matrix(primaries)
    sink = xyz_matrix(target)
    scale = (BRADFORD @ sink.sum(axis=1)) / (BRADFORD @ source.sum(axis=1))
    return np.linalg.inv(sink) @ np.linalg.inv(BRADFORD) @ np.diag(scale) @ BRADFORD @ source


def to_srgb(E: F32, primaries: Sequence[float]) -> F32:
    """Return radiance (H, W, 3) of these primaries in those of sRGB, `desaturate` where that lacks it."""
    return desaturate(E @ conversion_matrix(primaries).T.astype(np.float32))
