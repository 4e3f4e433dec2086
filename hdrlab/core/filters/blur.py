"""The Gaussian blur, by its definition.

image  (H, W), continued beyond its edges by reflection: d c b a | a b c d | d c b a
sigma  standard deviation, pixels
g      kernel, exp(-(x^2 + y^2) / (2 sigma^2)), sum 1, cut off at 4 sigma
"""

import numpy as np
import scipy
from numpy.lib.stride_tricks import sliding_window_view

from hdrlab.core.arrays import F32, ArrayLike
from hdrlab.errors import InputError


def gaussian(image: ArrayLike, sigma: float) -> F32:
    """Return sum_q g(p - q) image(q) at every pixel p.

    Parameters
    ----------
    image : (H, W)
    sigma : standard deviation in pixels, > 0

    Returns
    -------
    (H, W) float32

    Raises
    ------
    ValueError
        For an image of another shape and a sigma that is not positive.

    Examples
    --------
    >>> np.allclose(gaussian([[0, 0, 1, 0, 0]], 0.5), [[0.0003, 0.1065, 0.7865, 0.1065, 0.0003]], atol=1e-4)
    True
    """
    image = np.asarray(image, np.float32)
    if image.ndim != 2 or 0 in image.shape or not 0 < sigma < np.inf:
        raise InputError(
            f"expected an image (H, W) and a positive sigma, got shape {image.shape}, {sigma=}"
        )
    return scipy.ndimage.gaussian_filter(image, sigma)


def blur_matrix(n: int, k: ArrayLike) -> F32:
    """Return K (n, n) symmetric, whose product with n values is their blur by the symmetric taps k (2r + 1,).

    Examples
    --------
    >>> blur_matrix(3, [0.25, 0.5, 0.25]).tolist()
    [[0.75, 0.25, 0.0], [0.25, 0.5, 0.25], [0.0, 0.25, 0.75]]
    """
    k = np.asarray(k, np.float32)
    values = np.pad(np.eye(n, dtype=np.float32), ((0, 0), (len(k) // 2, len(k) // 2)), "symmetric")
    return np.asarray(sliding_window_view(values, len(k), axis=1) @ k)
