"""The picture that has given gradients: a Poisson equation, solved with cosines.

u     picture                    (H, W)
G     gradient field, (Gy, Gx)   (2, H, W), of the steps down and right of each pixel
f     divergence of G            (H, W)

No gradient need be the gradient of a picture. Of all pictures, the u with Laplacian u = div G has the
gradients nearest to G in the sense of least squares. Nothing flows through the edges (Neumann): there is no
step beyond the last row and column. `divergence` is minus the transpose of `gradient`, hence it sums to 0,
and the cosines of the DCT-II, which are even about the edges of the picture, are the eigenvectors of
`laplacian`. A u plus a constant has the same gradients; the one with the mean 0 is meant.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.fft import dctn, idctn

from hdrlab.core.arrays import describe

Float = NDArray[np.floating]


def gradient(u: ArrayLike) -> Float:
    """Return G = (u(y + 1, x) - u(y, x), u(y, x + 1) - u(y, x)), and 0 beyond the last row and column."""
    u = _as_picture(u)
    G = np.zeros((2, *u.shape), u.dtype)
    np.subtract(u[1:], u[:-1], out=G[0, :-1])
    np.subtract(u[:, 1:], u[:, :-1], out=G[1, :, :-1])
    return G


def divergence(G: ArrayLike) -> Float:
    """Return f = Gy(y, x) - Gy(y - 1, x) + Gx(y, x) - Gx(y, x - 1), G = 0 on the steps across an edge."""
    G = np.asarray(G)
    if G.ndim != 3 or len(G) != 2 or G.dtype.kind != "f":
        raise ValueError(f"expected a gradient field (2, H, W), got {describe(G)}")
    Gy, Gx = G
    f = Gy + Gx
    f[1:] -= Gy[:-1]
    f[:, 1:] -= Gx[:, :-1]
    f[-1] -= Gy[-1]
    f[:, -1] -= Gx[:, -1]
    return f


def laplacian(u: ArrayLike) -> Float:
    """Return div grad u: the sum over a pixel's neighbours inside the picture of their difference to it."""
    return divergence(gradient(u))


def eigenvalues(n: int) -> NDArray[np.float64]:
    """Return 2 cos(pi i / n) - 2, i = 0 ... n - 1: what `laplacian` makes of cos(pi i (x + 1/2) / n)."""
    return -4 * np.sin(np.pi * np.arange(n) / (2 * n)) ** 2  # the same, and exact where it is small


def solve(f: ArrayLike) -> Float:
    """Return the u of mean 0 whose Laplacian is f.

    In cosines the Laplacian is a factor, so the equation is solved by a division. A mean of f, which no u can
    have, is left out.

    Parameters
    ----------
    f : (H, W) float32 or float64

    Returns
    -------
    u : (H, W) of the same type

    Raises
    ------
    ValueError
        For an f of another shape.

    References
    ----------
    Press et al., Numerical Recipes in C, 2nd ed., section 19.4: boundary value problems by Fourier methods.

    Examples
    --------
    >>> u = np.array([[1.0, 2.0], [3.0, 6.0]])
    >>> solve(laplacian(u)).round(6)
    array([[-2., -1.],
           [ 0.,  3.]])
    """
    f = _as_picture(f)
    coefficients = dctn(f, type=2)
    coefficients[0, 0] = 0
    factors = np.add.outer(*(eigenvalues(n).astype(f.dtype) for n in f.shape))
    factors[0, 0] = 1
    coefficients /= factors
    return idctn(coefficients, type=2, overwrite_x=True)


def _as_picture(u: ArrayLike) -> Float:
    array = np.asarray(u)
    array = array if array.dtype in (np.float32, np.float64) else array.astype(np.float64)
    if array.ndim != 2 or 0 in array.shape:
        raise ValueError(f"expected a picture (H, W), got {describe(array)}")
    return array
