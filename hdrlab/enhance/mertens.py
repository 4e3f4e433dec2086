"""Exposure fusion (Mertens, Kautz, Van Reeth, Pacific Graphics 2007; Computer Graphics Forum 28(1), 2009).

Z_j       photograph j                  (H, W[, 3]) uint8 or uint16, as it came from the camera
F_j       the same in planes            (1 or 3, H, W) float32 in [0, 1]
C, S, E   contrast, saturation, well-exposedness    (H, W), >= 0: what makes a pixel worth keeping
W_j       weight of photograph j        (H, W), C^wC S^wS E^wE; after `weights` the sum over j is 1
W_j,k     its Gaussian pyramid          level k
L_j,k     Laplacian pyramid of F_j      level k
R         fused picture                 (H, W[, 3]) float32, about [0, 1]

Neither exposure times nor a response are needed: pixels are never turned into light. Blending the
photographs themselves, R = sum_j W_j F_j, shows seams wherever a weight jumps; blending their
Laplacian pyramids shows none, as each detail is blended by weights as smooth as it is wide.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, Array, ArrayLike, as_stack, levels
from hdrlab.core.filters import pyramid
from hdrlab.core.steps import last
from hdrlab.errors import InputError

# ITU-R BT.601: the gray of encoded values
LUMA = np.array([0.299, 0.587, 0.114], np.float32)
# width of the curve of well-exposedness
SIGMA = 0.2
# weight of a pixel that is flat, gray or clipped in every photograph
SMALLEST_WEIGHT = 1e-12


class State(NamedTuple):
    """The fusion after one more photograph.

    Attributes
    ----------
    image : j
    weights : W_j,k, the pyramid of its normalised weight, a list of (h, w), the finest level first
    details : L_j,k, its own pyramid, a list of (1 or 3, h, w)
    blended : the sum of W_i,k L_i,k over i <= j, a list of the same shapes
    """

    image: int
    weights: list[F32]
    details: list[F32]
    blended: list[F32]


def split_planes(Z: Array) -> Array:
    """Return F = Z / top level, the channels as planes."""
    return np.moveaxis(np.atleast_3d(Z), -1, 0) * np.float32(1 / (levels(Z) - 1))


def contrast(F: F32) -> F32:
    """Return C = |Y(up) + Y(down) + Y(left) + Y(right) - 4 Y|, Y the gray picture [Mertens07].

    Which is a Laplacian filter. At the edges Y is reflected.
    """
    Y = F[0] if len(F) == 1 else LUMA[0] * F[0] + LUMA[1] * F[1] + LUMA[2] * F[2]
    Y = np.pad(Y, 1, mode="reflect")
    rows = Y[:-2, 1:-1] + Y[2:, 1:-1]
    columns = Y[1:-1, :-2] + Y[1:-1, 2:]
    # summed by pairs: 2 Y + 2 Y is 4 Y without rounding, where Y is flat
    return np.abs(rows + columns - 4 * Y[1:-1, 1:-1])


def saturation(F: F32) -> F32:
    """Return S, the standard deviation of R, G and B [Mertens07]; 1 where there are no colours.

    Computed as ((R - G)^2 + (G - B)^2 + (B - R)^2)^(1/2) / 3, it is exactly 0 in a gray pixel.
    Computed from the mean of the three, rounding would leave a rest, which would decide alone in
    places that are gray in every photograph.
    """
    if len(F) == 1:
        return np.ones_like(F[0])
    a = F[0] - F[1]
    b = F[1] - F[2]
    # the third difference is -(a + b), so the squares sum to 2 (a (a + b) + b b)
    return np.sqrt((a * (a + b) + b * b) * np.float32(2 / 9))


def exposedness(F: F32) -> F32:
    """Return E = product over the channels of exp(-(F - 0.5)^2 / (2 sigma^2)) [Mertens07]."""
    return np.exp(sum((plane - np.float32(0.5)) ** 2 for plane in F) * np.float32(-0.5 / SIGMA**2))


def weight(F: F32, powers: Sequence[float] = (1, 1, 1)) -> F32:
    """Return W = C^wC S^wS E^wE [Mertens07], and a trace, so that no pixel is without any weight."""
    W = np.ones(F.shape[1:], np.float32)
    for measure, power in zip((contrast, saturation, exposedness), powers, strict=True):
        if power:
            W *= measure(F) if power == 1 else measure(F) ** np.float32(power)
    return W + np.float32(SMALLEST_WEIGHT)


def weights(images: Array, powers: Sequence[float] = (1, 1, 1)) -> Iterator[F32]:
    """Yield W_j / sum_i W_i, photograph after photograph: they sum to 1 in every pixel [Mertens07]."""
    stack = [weight(split_planes(Z), powers) for Z in images]
    total = sum(stack)
    for W in stack:
        yield W / total


def add_term(blended: F32, W: F32, detail: F32) -> F32:
    """Return the sum of W_i,k L_i,k so far and the next W_j,k L_j,k [Mertens07]."""
    return blended + W * detail


def fuse_steps(
    images: ArrayLike, *, contrast: float = 1.0, saturation: float = 1.0, exposedness: float = 1.0
) -> Iterator[State]:
    """Yield the State after each photograph; the parameters are those of `fuse`.

    R_k = sum_j W_j,k L_j,k at every level [Mertens07]: a photograph adds its term to all of them.
    """
    stack = as_stack(images)
    powers = (contrast, saturation, exposedness)
    if not all(0 <= power < np.inf for power in powers):
        raise InputError(
            f"expected finite powers >= 0 of contrast, saturation and exposedness, got {powers}"
        )
    depth = min(stack.shape[1:3]).bit_length()  # down to one or two rows or columns
    blended: list[F32] = []
    for j, W in enumerate(weights(stack, powers)):
        Wk = pyramid.gaussian(W, depth)
        Lk = pyramid.laplacian(split_planes(stack[j]), depth)
        if not blended:
            blended = [np.zeros_like(detail) for detail in Lk]
        blended = list(map(add_term, blended, Wk, Lk))
        yield State(j, Wk, Lk, blended)


def fuse(
    images: ArrayLike, *, contrast: float = 1.0, saturation: float = 1.0, exposedness: float = 1.0
) -> F32:
    """Fuse photographs of one scene: each region comes from the photographs that show it best.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs of one scene from one place, with different exposures, in any order.
    contrast, saturation, exposedness : float
        Powers of the three measures in the weight; 0 leaves one out. Gray photographs have no
        saturation.

    Returns
    -------
    R : (H, W) or (H, W, 3) float32
        Encoded like the photographs, 1 = their top level. It is not clipped, and does leave [0, 1]
        where the details of one photograph are added to the light of others: real brackets reach
        -0.5 and 1.8, often in a quarter of the pixels. Clip it for a display.

    Raises
    ------
    ValueError
        For images that are no stack of photographs, and for powers that are negative or not finite.

    References
    ----------
    Mertens, Kautz, Van Reeth, Exposure fusion, Pacific Graphics 2007. Two things it leaves open are
    as in OpenCV: the pyramids go down to one or two rows or columns, and all filters reflect at the
    edges. The two differ where every photograph is gray or flat: there rounding decides in OpenCV,
    and here all weigh alike.

    Examples
    --------
    >>> dark, bright = np.full((8, 8), 20, np.uint8), np.full((8, 8), 120, np.uint8)
    >>> fuse([dark, bright], contrast=0)[0, 0].round(2)  # 20 is badly exposed, 120 well
    np.float32(0.43)
    """
    steps = fuse_steps(images, contrast=contrast, saturation=saturation, exposedness=exposedness)
    R = pyramid.collapse(last(steps).blended)
    return R[0] if len(R) == 1 else np.moveaxis(R, 0, -1).copy()
