"""Exposure correction of one photograph by its relevant regions (Battiato et al. 2008, sec. 1.3).

Z      picture         (H, W) or (H, W, 3) uint8
Y      levels          (H, W), 0 to 255: its luminance, or the green of a quarter-size Bayer picture
I, I~  histogram       (256,) of a block, and smoothed
M, D   its mean, and its mean distance from it, levels: contrast
F      mean of the absolute Laplacian where it is above the noise, levels: focus
R      relevance       (blocks, blocks), from D and F

There are three steps. Brighten the picture until its mean is 128: in this visibility image, dark
regions can be judged as well. Find the relevant regions in it: skin if there is any, or else the
blocks with the highest contrast and focus. Add to all pixels the light that brings the mean of
these regions to 128 (`enhance.relight`).

The paper leaves open how D and F are weighted, which R is relevant, where noise ends, and how much
skin is enough: `relevance`, `find_relevant_blocks`, `NOISE` and `MIN_FACE_FRACTION` are choices of
this library. So is that black and white pixels do not count in the mean.
"""

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import correlate1d, laplace

from hdrlab.core.arrays import F64, Array, ArrayLike, Mask, as_picture, describe
from hdrlab.core.steps import last
from hdrlab.enhance import relight, skin
from hdrlab.errors import InputError

# levels: 2 sigma of the Laplacian of noise with a sigma of 2.2 (the norm of its weights is sqrt 20)
NOISE = 20.0
# a smaller fraction of the picture is not a face
MIN_FACE_FRACTION = 0.01


@dataclass(frozen=True)
class Correction:
    """A corrected picture, and the regions that decided.

    Attributes
    ----------
    visible : (h, w), the visibility image
    relevant : (h, w) bool, the relevant regions, whose mean is brought to the target
    by : "skin" or "contrast and focus"
    delta : stops, the light added
    before, after : mean level of the relevant regions, without black and white pixels
    picture : uint8, the corrected picture or mosaic, of the original shape
    """

    visible: F64
    relevant: Mask
    by: str
    delta: float
    before: float
    after: float
    picture: Array


def brightness(Z: Array) -> F64:
    """Return Y = 0.299 R + 0.587 G + 0.114 B of the levels; a gray picture is returned as it is."""
    return Z @ skin.LUMA if Z.ndim == 3 else Z.astype(np.float64)


def brighten(Z: Array, *, a: float = relight.A, c: float = relight.C) -> F64:
    """Return the visibility image: Z, as floats, with the light that brings its mean to 128."""
    state = last(relight.settle_steps(relight.shares(brightness(Z)), a=a, c=c))
    return relight.curve(state.delta, a=a, c=c)[Z]


def histogram(block: F64) -> F64:
    """Return I~[i], the mean of I[i-2] ... I[i+2] [eq. 1.3]; beyond its ends, I is 0."""
    return correlate1d(relight.shares(block) * block.size, np.full(5, 0.2), mode="constant")


def contrast(block: F64) -> float:
    """Return D, the mean of |i - M| over the smoothed histogram, M its mean [eq. 1.4, 1.5]."""
    i = np.arange(256)
    smoothed = histogram(block)
    M = np.average(i, weights=smoothed)
    return float(np.average(np.abs(i - M), weights=smoothed))


def focus(block: F64, *, noise: float = NOISE) -> float:
    """Return F, the mean of |Laplacian| over the block, where values below the noise count as 0 [eq. 1.6]."""
    edges = np.abs(laplace(block, mode="nearest"))
    return float(np.where(edges > noise, edges, 0).mean())


def split_blocks(Y: F64, count: int = 8) -> list[list[F64]]:
    """Return the picture divided into `count` rows of `count` blocks, as equal as possible."""
    rows = np.array_split(Y, min(count, len(Y)))
    return [np.array_split(row, min(count, Y.shape[1]), axis=1) for row in rows]


def relevance(D: F64, F: F64, *, share: float = 0.5) -> F64:
    """Return the relevance R = share D / max D + (1 - share) F / max F, 0 to 1."""
    return share * D / max(D.max(), 1e-9) + (1 - share) * F / max(F.max(), 1e-9)


def find_relevant_blocks(Y: F64, *, count: int = 8, noise: float = NOISE) -> Mask:
    """Return the mask (H, W) of the blocks whose relevance is at least the mean of all."""
    blocks = split_blocks(Y, count)
    D = np.array([[contrast(block) for block in row] for row in blocks])
    F = np.array([[focus(block, noise=noise) for block in row] for row in blocks])
    R = relevance(D, F)
    is_relevant = R >= R.mean()
    masks = [
        [np.full(block.shape, is_relevant[i, j]) for j, block in enumerate(row)]
        for i, row in enumerate(blocks)
    ]
    return np.block(masks)


def correct(
    picture: ArrayLike,
    *,
    target: float = relight.TARGET,
    by: str = "auto",
    find_skin: Callable[..., Mask] = skin.find_by_chrominance,
    noise: float = NOISE,
    shape: tuple[float, float] = (relight.A, relight.C),
    least: float = 1 / 3,
) -> Correction:
    """Correct the exposure of a photograph so that its relevant regions get the right brightness.

    Parameters
    ----------
    picture : (H, W, 3) or (H, W) uint8, as the camera made it; for a Bayer mosaic see
        `correct_mosaic`
    target : mean level of the relevant regions after the correction
    by : "skin", "blocks" (contrast and focus), or "auto": skin if it covers 1 % of the picture
    find_skin : function of a picture that returns the mask of skin, one of `skin.FINDERS`
    noise : levels; a smaller absolute Laplacian is noise, and not focus
    shape : A and C of the simulated response
    least : stops; a smaller correction is not made

    Returns
    -------
    correction : Correction

    Raises
    ------
    ValueError
        For a picture that is not uint8, a target outside 1 to 254, or `by="skin"` if no skin is
        found.

    References
    ----------
    Battiato, Messina and Castorina, Exposure correction for imaging devices: an overview, 2008,
    sec. 1.3.

    Examples
    --------
    >>> dark = np.full((64, 64), 20, np.uint8)
    >>> dark[::2] = 40
    >>> found = correct(dark)
    >>> found.by, abs(found.after - 128) < 3
    ('contrast and focus', True)
    """
    if not (1 <= target <= 254 and by in ("auto", "skin", "blocks")):
        raise InputError(
            f"expected a target from 1 to 254, and by = auto, skin or blocks, got {target}, {by!r}"
        )
    Z = as_picture(picture)
    a, c = shape
    Y = brightness(Z)
    visible = brighten(Z, a=a, c=c)
    faces = find_skin(visible) if Z.ndim == 3 and by != "blocks" else np.zeros(Y.shape, bool)
    if by == "skin" and not faces.any():
        raise InputError("no skin found in the photo; use --by blocks (by='blocks' in Python)")
    if by == "skin" or faces.mean() >= MIN_FACE_FRACTION:
        by = "skin"
        relevant = faces
    else:
        by = "contrast and focus"
        relevant = find_relevant_blocks(brightness(visible), noise=noise)
    # black and white pixels cannot change, and would shift the mean
    inner = relevant & (Y > 0) & (Y < 255)
    if not inner.any():
        inner = relevant
    state = last(relight.settle_steps(relight.shares(Y[inner]), target, a=a, c=c))
    delta = state.delta if abs(state.delta) >= least else 0.0
    corrected = relight.table(delta, a=a, c=c)[Z]
    return Correction(
        visible=brightness(visible),
        relevant=relevant,
        by=by,
        delta=delta,
        before=float(Y[inner].mean()),
        after=float(brightness(corrected)[inner].mean()),
        picture=corrected,
    )


def quarter_size(mosaic: ArrayLike) -> Array:
    """Return the quarter-size picture (H/2, W/2, 3) of a Bayer mosaic R G / G B, a pixel for each cell."""
    Z = np.asarray(mosaic)
    if Z.ndim != 2 or min(Z.shape) < 2 or Z.dtype != np.uint8:
        raise InputError(
            f"expected a Bayer mosaic (H, W) of uint8, at least 2 x 2, got {describe(Z)}"
        )
    Z = Z[: Z.shape[0] // 2 * 2, : Z.shape[1] // 2 * 2]
    green = (Z[::2, 1::2].astype(np.uint16) + Z[1::2, ::2] + 1) // 2
    return np.stack([Z[::2, ::2], green.astype(np.uint8), Z[1::2, 1::2]], axis=-1)


def correct_mosaic(
    mosaic: ArrayLike,
    *,
    target: float = relight.TARGET,
    by: str = "auto",
    find_skin: Callable[..., Mask] = skin.find_by_chrominance,
    noise: float = NOISE,
    shape: tuple[float, float] = (relight.A, relight.C),
    least: float = 1 / 3,
) -> Correction:
    """Correct the exposure of a Bayer mosaic by its quarter-size picture.

    The parameters are those of `correct`.
    """
    correction = correct(
        quarter_size(mosaic),
        target=target,
        by=by,
        find_skin=find_skin,
        noise=noise,
        shape=shape,
        least=least,
    )
    a, c = shape
    table = relight.table(correction.delta, a=a, c=c)
    return dataclasses.replace(correction, picture=table[np.asarray(mosaic)])
