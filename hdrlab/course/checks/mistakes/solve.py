"""Known mistakes in `solve`, the task of hdrlab.core.filters.poisson.solve."""

import numpy as np
from scipy.fft import dctn, idctn

from hdrlab.core.filters.poisson import eigenvalues
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "solve_periodic",
    says="You solved with a Fourier transform, which assumes a periodic image and distorts its "
    "borders. Use a cosine transform.",
    misses_method=True,
)
def periodic(divG):
    coefficients = np.fft.fft2(divG)
    factors = np.add.outer(*(2 * np.cos(2 * np.pi * np.arange(n) / n) - 2 for n in divG.shape))
    factors[0, 0] = np.inf
    return np.fft.ifft2(coefficients / factors).real


@mistake(
    "solve_axes_swapped",
    says="You used the eigenvalues of the columns for the rows. The result is right for square "
    "images only.",
)
def axes_swapped(divG):
    def eigenvalues(n, side):
        # the same, and exact where it is small
        return -4 * np.sin(np.pi * np.arange(n) / (2 * side)) ** 2

    coefficients = dctn(divG, type=2)
    factors = np.add.outer(
        *(eigenvalues(n, max(divG.shape)).astype(coefficients.dtype) for n in divG.shape)
    )
    factors[0, 0] = np.inf
    return idctn(coefficients / factors, type=2, overwrite_x=True)


@mistake(
    "solve_wrong_sign",
    says="Your image is a negative. The eigenvalues of the Laplacian are negative: 2 cos(...) - 2.",
)
def wrong_sign(divG):
    coefficients = dctn(divG, type=2)
    factors = np.add.outer(*(eigenvalues(n).astype(coefficients.dtype) for n in divG.shape))
    factors[0, 0] = np.inf
    return -idctn(coefficients / factors, type=2, overwrite_x=True)
