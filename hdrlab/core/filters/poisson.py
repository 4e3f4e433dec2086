"""A picture from its gradients: the Poisson equation, solved by the cosine transform.

u     picture                    (H, W)
G     gradient field, (Gy, Gx)   (2, H, W), of the steps down and right of each pixel
divG  divergence of G            (H, W)

A gradient field G need not be the gradient of any picture. Of all pictures, the u with Laplacian
u = div G has the gradients nearest to G in the sense of least squares. Nothing flows through the
edges (Neumann boundary): there is no step beyond the last row and column. `divergence` is minus the
transpose of `gradient`, hence it sums to 0. The cosines of the DCT-II, which are even about the edges
of the picture, are the eigenvectors of `laplacian`. u plus a constant has the same gradients; `solve`
returns the one of mean 0.
"""

import numpy as np
from scipy.fft import dctn, idctn

from hdrlab.core.arrays import Array
from hdrlab.errors import InputError


def gradient(u: Array) -> Array:
    """Return G = (u(y + 1, x) - u(y, x), u(y, x + 1) - u(y, x)), and 0 beyond the last row and column."""
    G = np.zeros((2, *u.shape), u.dtype)
    G[0, :-1] = np.diff(u, axis=0)
    G[1, :, :-1] = np.diff(u, axis=1)
    return G


def divergence(G: Array) -> Array:
    """Return div G = Gy(y, x) - Gy(y - 1, x) + Gx(y, x) - Gx(y, x - 1), G = 0 on the steps across an edge."""
    if G.ndim != 3 or len(G) != 2:
        raise InputError(f"expected a gradient field (2, H, W), got shape {G.shape}")
    Gy = np.pad(G[0, :-1], ((1, 1), (0, 0)))
    Gx = np.pad(G[1, :, :-1], ((0, 0), (1, 1)))
    return np.diff(Gy, axis=0) + np.diff(Gx, axis=1)


def laplacian(u: Array) -> Array:
    """Return div grad u: the sum of the differences of a pixel's neighbors in the picture to it."""
    return divergence(gradient(u))


def eigenvalues(n: int) -> Array:
    """Return 2 cos(pi i / n) - 2, i = 0 ... n - 1: what `laplacian` makes of cos(pi i (x + 1/2) / n)."""
    # equal to it, and exact where it is small
    return -4 * np.sin(np.pi * np.arange(n) / (2 * n)) ** 2


def solve(divG: Array) -> Array:
    """Return the u of mean 0 whose Laplacian is div G.

    In the cosine transform the Laplacian is a multiplication, so the equation is solved by a
    division. A mean of div G other than 0, which no u can have, is removed.

    Parameters
    ----------
    divG : (H, W) float32 or float64

    Returns
    -------
    u : (H, W) of the same type

    Raises
    ------
    ValueError
        For an array of another shape.

    References
    ----------
    Press et al., Numerical Recipes in C, 2nd ed., section 19.4: boundary value problems by Fourier
    methods.

    Examples
    --------
    >>> u = np.array([[1.0, 2.0], [3.0, 6.0]])
    >>> solve(laplacian(u)).round(6)
    array([[-2., -1.],
           [ 0.,  3.]])
    """
    if divG.ndim != 2 or 0 in divG.shape:
        raise InputError(f"expected a picture (H, W), got shape {divG.shape}")
    coefficients = dctn(divG, type=2)
    H, W = divG.shape
    rows = eigenvalues(H).astype(coefficients.dtype)
    columns = eigenvalues(W).astype(coefficients.dtype)
    factors = np.add.outer(rows, columns)
    factors[0, 0] = np.inf
    return idctn(coefficients / factors, type=2, overwrite_x=True)
