"""Demosaicing by gradient-corrected interpolation (Malvar, He and Cutler, ICASSP 2004).

X        mosaic       (H, W), one color filter a pixel, green in every other pixel of each row
c        channels     (H, W) int, 0 to 2: the color of each pixel's filter
E^       estimate     (H, W, 3) of the image behind the mosaic
Laplace  of a channel at a pixel that measured it: its value less the mean of its next neighbors

Edges are in the same place in all channels. So the channel that a pixel measured tells what
bilinear interpolation of another channel misses: at a red pixel

    G^ = mean of the 4 green neighbors + 1/2 Laplace(R)

and likewise with 5/8 of the Laplace of green for red and blue at a green pixel, and 3/4 of that of
red for blue at a red pixel. The authors approximate the linear filters of least squared error on
photos. Together, mean and correction are one kernel of 5 x 5 pixels for each case.

The kernels are those of the package colour-demosaicing 0.2.7, and a test compares the results. They
are stated there, and in Getreuer, Malvar-He-Cutler linear image demosaicking, Image Processing On
Line 1, 2011, https://doi.org/10.5201/ipol.2011.g_mhcd, with reference to the paper.
"""

import numpy as np
from scipy.ndimage import correlate

from hdrlab.core.arrays import Array, ArrayLike, Indices, describe
from hdrlab.core.filters.mosaic import as_channels
from hdrlab.errors import InputError

# green at a red or a blue pixel
GREEN = (
    np.array(
        [
            [0, 0, -1, 0, 0],
            [0, 0, 2, 0, 0],
            [-1, 2, 4, 2, -1],
            [0, 0, 2, 0, 0],
            [0, 0, -1, 0, 0],
        ]
    )
    / 8
)
# red or blue at a green pixel that has neighbors of that color in its row; in its column: ROW.T
ROW = (
    np.array(
        [
            [0, 0, 0.5, 0, 0],
            [0, -1, 0, -1, 0],
            [-1, 4, 5, 4, -1],
            [0, -1, 0, -1, 0],
            [0, 0, 0.5, 0, 0],
        ]
    )
    / 8
)
# blue at a red pixel, red at a blue pixel
DIAGONAL = (
    np.array(
        [
            [0, 0, -1.5, 0, 0],
            [0, 2, 0, 2, 0],
            [-1.5, 0, 6, 0, -1.5],
            [0, 2, 0, 2, 0],
            [0, 0, -1.5, 0, 0],
        ]
    )
    / 8
)


def demosaic(X: ArrayLike, c: ArrayLike) -> Array:
    """Return the image E^ (H, W, 3) of a Bayer mosaic, its missing channels corrected by gradients.

    Beyond the edge of the mosaic, its pixels are repeated in reverse order.

    Parameters
    ----------
    X : (H, W), mosaic, any linear unit
    c : (H, W) int, channels of the filters, 0 to 2, in one of the four Bayer patterns

    Returns
    -------
    (H, W, 3) float. Values can be below 0 or above the largest of X next to strong edges.

    Raises
    ------
    InputError
        For channels that are no Bayer pattern, or of another shape than X.

    Examples
    --------
    >>> from hdrlab.core.filters.mosaic import BAYER, tile
    >>> demosaic(np.full((4, 4), 0.5), tile(BAYER, (4, 4)))[1, 1].tolist()
    [0.5, 0.5, 0.5]
    """
    c = as_bayer(c, np.shape(X))
    X = np.asarray(X)
    X = X.astype(np.result_type(X, np.float32), copy=False)
    # "mirror" does not repeat the pixel at the edge, so that the filters of the mosaic continue
    green = correlate(X, GREEN, mode="mirror")
    along_row = correlate(X, ROW, mode="mirror")
    along_column = correlate(X, ROW.T, mode="mirror")
    diagonal = correlate(X, DIAGONAL, mode="mirror")
    red = 0
    blue = 2
    E = np.empty((*X.shape, 3), X.dtype)
    E[..., 1] = np.where(c == 1, X, green)
    for k in (red, blue):
        is_in_row = (c == k).any(axis=1, keepdims=True)
        at_green = np.where(is_in_row, along_row, along_column)
        E[..., k] = np.select([c == k, c == 1], [X, at_green], diagonal)
    return E


def as_bayer(c: ArrayLike, shape: tuple[int, ...]) -> Indices:
    """Return the channels (H, W) of a sensor's pixels if they are a Bayer pattern, or raise an InputError."""
    channels = as_channels(c, shape)
    if channels.ndim != 2 or min(channels.shape) < 2:
        raise InputError(f"expected channels (H, W) of at least 2 x 2, got {describe(channels)}")
    cell = channels[:2, :2]
    is_repeated = np.array_equal(channels[2:], channels[:-2]) and np.array_equal(
        channels[:, 2:], channels[:, :-2]
    )
    diagonals = {tuple(sorted(np.diag(cell))), tuple(sorted(np.diag(cell[::-1])))}
    if not is_repeated or diagonals != {(1, 1), (0, 2)}:
        raise InputError(
            "expected a Bayer pattern, with green on one diagonal of each 2 x 2 pixels and red and "
            f"blue on the other, got {cell.tolist()}"
        )
    return channels
