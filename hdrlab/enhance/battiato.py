"""Exposure correction of one photograph by what matters in it (Battiato et al. 2008, sec. 1.3).

Z      picture         (H, W) or (H, W, 3) uint8
Y      levels          (H, W), 0 to 255: its luminance, or the green of a quarter-size Bayer picture
I, I~  histogram       (256,) of a block, and smoothed
M, D   its mean, and its mean distance from it, levels: contrast
F      mean of what a Laplacian leaves above the noise, levels: focus
R      relevance       (blocks, blocks), from D and F

Three steps. Brighten the picture until its mean is 128: in this visibility image dark regions get a fair
look. Find in it the regions that matter: skin where there is some, else the blocks of most contrast and
focus. Give all pixels the light that brings the mean of those regions to 128 (`enhance.relight`).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import correlate, correlate1d

from hdrlab.core.arrays import Array, describe
from hdrlab.core.picture import as_picture
from hdrlab.core.steps import last
from hdrlab.enhance import relight, skin

Float = NDArray[np.float64]

LUMA = np.array([0.299, 0.587, 0.114])  # ITU-R BT.601: the Y channel of encoded values
LAPLACIAN = np.array([[0.0, 1, 0], [1, -4, 1], [0, 1, 0]])
NOISE = 20.0  # levels: 2 sigma of what a Laplacian, whose weights have norm sqrt 20, makes of noise of 2.2
BLOCKS = 8  # along a side: N = 64
LEAST = 1 / 3  # stops, the step of a camera's dial: less is not worth a change
LEAST_SKIN = 0.01  # share of the picture: less is no face


class Correction(NamedTuple):
    """What was found, and done.

    Attributes
    ----------
    visible : (h, w), the visibility image
    relevant : (h, w) bool, the regions that matter, whose mean is brought to the target
    by : "skin" or "contrast and focus"
    delta : stops, the light added
    before, after : mean level of the relevant regions, without what is quite black or white
    picture : uint8, the corrected picture or mosaic, of the shape that came
    """

    visible: Float
    relevant: NDArray[np.bool_]
    by: str
    delta: float
    before: float
    after: float
    picture: NDArray[np.uint8]


def quarter(mosaic: ArrayLike) -> NDArray[np.uint8]:
    """Return the quarter-size picture (H/2, W/2, 3) of a Bayer mosaic R G / G B: a cell becomes a pixel."""
    Z = np.asarray(mosaic)
    if Z.ndim != 2 or min(Z.shape) < 2 or Z.dtype != np.uint8:
        raise ValueError(f"expected a Bayer mosaic (H, W) of uint8, at least 2 x 2, got {describe(Z)}")
    Z = Z[: Z.shape[0] // 2 * 2, : Z.shape[1] // 2 * 2]
    green = (Z[::2, 1::2].astype(np.uint16) + Z[1::2, ::2] + 1) // 2
    return np.stack([Z[::2, ::2], green.astype(np.uint8), Z[1::2, 1::2]], axis=-1)


def brightness(Z: Array) -> Float:
    """Return Y = 0.299 R + 0.587 G + 0.114 B of the levels; a gray picture as it is."""
    return Z @ LUMA if Z.ndim == 3 else Z.astype(np.float64)


def visible(Z: Array, Y: Float, *, a: float = relight.A, c: float = relight.C) -> Array:
    """Return Z, as floats, with the light that brings the mean of Y to 128."""
    delta = last(relight.settle_steps(relight.shares(Y), a=a, c=c)).delta
    return relight.curve(delta, a=a, c=c)[Z]


def histogram(block: Float) -> Float:
    """Return I~[i], the mean of I[i-2] ... I[i+2] [eq. 1.3]; beyond its ends I is 0."""
    I = np.bincount(np.rint(block).astype(np.intp).ravel(), minlength=256)  # noqa: E741
    return correlate1d(I.astype(np.float64), np.full(5, 0.2), mode="constant")


def contrast(block: Float) -> float:
    """Return D, the mean of |i - M| over the smoothed histogram, M its mean [eq. 1.4, 1.5]."""
    smoothed = histogram(block)
    i = np.arange(256)
    M = (i @ smoothed) / smoothed.sum()
    return float((np.abs(i - M) @ smoothed) / smoothed.sum())


def focus(block: Float, *, noise: float = NOISE) -> float:
    """Return F, the mean over the block of |Laplacian| where it exceeds the noise, 0 elsewhere [eq. 1.6]."""
    edges = np.abs(correlate(block, LAPLACIAN, mode="nearest"))
    return float(np.where(edges > noise, edges, 0).mean())


def blocks(Y: Float, count: int = BLOCKS) -> list[list[Float]]:
    """Return the picture cut into count rows of count blocks, as equal as it can be."""
    rows = np.array_split(Y, min(count, len(Y)))
    return [np.array_split(row, min(count, Y.shape[1]), axis=1) for row in rows]


def relevance(D: Float, F: Float, *, share: float = 0.5) -> Float:
    """Return R = share D / max D + (1 - share) F / max F: a linear combination, 0 to 1."""
    return share * D / max(D.max(), 1e-9) + (1 - share) * F / max(F.max(), 1e-9)


def by_blocks(Y: Float, *, count: int = BLOCKS, noise: float = NOISE) -> NDArray[np.bool_]:
    """Return the mask (H, W) of the blocks whose relevance is at least the mean of all."""
    cut = blocks(Y, count)
    D = np.array([[contrast(block) for block in row] for row in cut])
    F = np.array([[focus(block, noise=noise) for block in row] for row in cut])
    R = relevance(D, F)
    chosen = R >= R.mean()
    masks = [
        [np.full(block.shape, keep) for block, keep in zip(row, keeps, strict=True)]
        for row, keeps in zip(cut, chosen, strict=True)
    ]
    return np.block(masks)


def by_skin(Z: Array, *, way: str = "chrominance") -> NDArray[np.bool_]:
    """Return the mask (H, W) of skin in a colour picture, by `skin.by_chrominance` or `skin.by_locus`."""
    ways = {"chrominance": skin.by_chrominance, "locus": skin.by_locus}
    if way not in ways:
        raise ValueError(f"expected skin by {' or '.join(ways)}, got {way!r}")
    return ways[way](Z)


def correct(
    picture: ArrayLike,
    *,
    target: float = relight.TARGET,
    by: str = "auto",
    bayer: bool = False,
    way: str = "chrominance",
    noise: float = NOISE,
    a: float = relight.A,
    c: float = relight.C,
    least: float = LEAST,
) -> Correction:
    """Correct the exposure of a photograph by the regions that matter in it.

    Parameters
    ----------
    picture : (H, W, 3) or (H, W) uint8, as the camera made it; or a Bayer mosaic (H, W), R G / G B
    target : mean level that the relevant regions get
    by : "skin", "blocks" (contrast and focus), or "auto": skin where it covers 1 % of the picture
    bayer : the picture is a mosaic: look at its quarter-size picture, and correct the mosaic
    way : how skin is found, "chrominance" or "locus"
    noise : what a Laplacian makes of the sensor's noise, levels; less is no focus
    a, c : A and C, the shape of the simulated response
    least : stops; a photograph that lacks less is left as it is

    Returns
    -------
    correction : Correction

    Raises
    ------
    ValueError
        For a picture that is not uint8, a target outside 1 to 254, or an unknown way.

    References
    ----------
    Battiato, Messina and Castorina, Exposure correction for imaging devices: an overview, 2008, sec. 1.3.

    Examples
    --------
    >>> dark = np.full((64, 64), 20, np.uint8)
    >>> dark[::2] = 40
    >>> found = correct(dark)
    >>> found.by, abs(found.after - 128) < 3
    ('contrast and focus', True)
    """
    if not 1 <= target <= 254:
        raise ValueError(f"expected a target level from 1 to 254, got {target}")
    if by not in ("auto", "skin", "blocks"):
        raise ValueError(f"expected by auto, skin or blocks, got {by!r}")
    Z = as_picture(picture)
    seen = quarter(Z) if bayer else Z
    Y = brightness(seen)
    lit = visible(seen, Y, a=a, c=c)
    found = by_skin(lit, way=way) if seen.ndim == 3 and by != "blocks" else np.zeros(Y.shape, bool)
    if by == "skin" and not found.any():
        raise ValueError("expected a colour picture with skin in it, found none")
    faces = by == "skin" or found.mean() >= LEAST_SKIN
    relevant = found if faces else by_blocks(brightness(lit), noise=noise)
    held = relevant & (Y > 0) & (Y < 255)  # black and white stay what they are, and would drag the mean
    held = held if held.any() else relevant
    delta = last(relight.settle_steps(relight.shares(Y[held]), target, a=a, c=c)).delta
    delta = delta if abs(delta) >= least else 0.0
    changed = relight.table(delta, a=a, c=c)[Z]
    after = brightness(quarter(changed) if bayer else changed)[held].mean()
    why = "skin" if faces else "contrast and focus"
    return Correction(brightness(lit), relevant, why, delta, float(Y[held].mean()), float(after), changed)
