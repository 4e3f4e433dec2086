"""How far apart were two exposures? Steps of the response between neighbouring frames, least squares.

H   pair tables     (P - 1, C, 256, 256): patches of level a in frame j, b in the next; see `flats`
V   the same, weighted by trust in the levels, and less where a patch does not fit
B   ln stated times (P,); b = its steps (P - 1,)
g   responses       (C, 256), ln exposure of each level
x   corrections     (P,), ln(time / stated time) = Q y
Q   free directions (P, K), orthonormal: what the gauge leaves
v   levels won      (C, P - 1, 256): patches that come to a level, less those that leave it
T   evidence        (P - 1,), the sum of V over a pair's table
sd  prior           how far a stated time may be off, 1/6 stop

A patch says g(b) - g(a) = b_j + x_j+1 - x_j. Least squares over all patches, with smooth g and x of size sd,
is quadratic in both. The best g for given x is linear in x; put in, there remain K equations.

The gauge: pixels cannot tell the unit of light, nor, where the response is sought too, the exponent u
((g, B) and (u g, u B) explain the same pixels). So the corrections are kept orthogonal to 1, and to B where g
is not known: the geometric mean of the times stays, and so does their span.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import null_space

from hdrlab.core import weights
from hdrlab.core.arrays import as_times
from hdrlab.core.weights import second_differences

Float = NDArray[np.float64]
W = weights.cut(weights.hat(), below=0.02)
SIGMA = 0.15 * np.log(
    2
)  # what a patch's step is true to, ln: noise, but above all flare and a camera's tricks
CORE = 0.01 * np.log(2)  # patches that miss by less are no outliers, however well the others fit
FEWEST = 5  # patches, weighted, without which a pair of frames says nothing
MOST = 100  # patches a pair of frames speaks with: what they err in common does not average away
CURVATURES = second_differences(W, 1)  # w(z) g''(z), as Debevec weights it


class Fit(NamedTuple):
    """The responses (C, 256) and the corrections x (P,) that explain the pair tables best."""

    g: Float
    x: Float


def ascending(times: ArrayLike, count: int) -> Float:
    """Return `times` as float64 (count,), from short to long, or raise a ValueError."""
    checked = as_times(times, count)
    if np.any(np.diff(checked) < 0):
        raise ValueError(f"expected photographs from short to long, got times {checked.tolist()}")
    return checked


def directions(B: Float, *, known: bool = False) -> Float:
    """Return Q (P, K): the corrections orthogonal to 1, and where g is not known to B.

    Examples
    --------
    >>> directions(np.log([1, 2, 4])).shape, directions(np.log([1, 2, 4]), known=True).shape
    ((3, 1), (3, 2))
    """
    gauge = np.ones((1, len(B))) if known else np.stack([np.ones(len(B)), B - B.mean()])
    return np.asarray(null_space(gauge, rcond=1e-9), np.float64)


def weighted(H: Float) -> Float:
    """Return V = w(a) w(b) H / SIGMA^2, no pair with more than MOST patches."""
    V = W[:, None] * W * H
    total = V.sum(axis=(1, 2, 3), keepdims=True)
    return V * np.minimum(1, MOST / np.maximum(total, 1)) / SIGMA**2


def speaking(H: Float) -> NDArray[np.bool_]:
    """Return which pairs of frames have at least FEWEST patches to speak with, (P - 1,)."""
    return np.asarray((W[:, None] * W * H).sum(axis=(2, 3)).mean(axis=1) >= FEWEST)


def solve(V: Float, B: Float, Q: Float, *, g: Float | None = None, sd: float, smoothness: float) -> Fit:
    """Return the Fit of least squares: sum V (g(b) - g(a) - step)^2 + (smoothness w g'')^2 + (x / sd)^2."""
    b, F = np.diff(B), np.diff(Q, axis=0)
    v = np.moveaxis(V.sum(axis=2) - V.sum(axis=3), 1, 0)
    T = np.diag(V.sum(axis=(1, 2, 3)))
    if g is None:
        answers = np.stack([np.linalg.solve(_stiff(V[:, c], smoothness), v[c].T) for c in range(len(v))])
        left = T - (v @ answers).sum(axis=0)  # of the evidence, when each response has explained its part
        told = left @ b
    else:
        left, told = T, T @ b - (v @ g[..., None]).sum(axis=(0, 2))
    y = -np.linalg.solve(F.T @ left @ F + np.eye(F.shape[1]) / sd**2, F.T @ told)
    return Fit(answers @ (b + F @ y) if g is None else g, Q @ y)


def _stiff(V: Float, smoothness: float) -> Float:
    """Return S of g^T S g: patches tie levels together (a graph's Laplacian), smoothness ties the rest."""
    ties = V.sum(axis=0)
    S = np.diag(ties.sum(axis=0) + ties.sum(axis=1)) - ties - ties.T
    S += MOST / SIGMA**2 * smoothness**2 * CURVATURES.T @ CURVATURES
    S[128, 128] += MOST / SIGMA**2  # the gauge, g(128) = 0, costs nothing: v sums to 0
    return S + 1e-9 * np.trace(S) / len(S) * np.eye(len(S))


def residuals(found: Fit, B: Float) -> Float:
    """Return g(b) - g(a) - (B + x)_j+1 + (B + x)_j for all pairs of levels, (P - 1, C, 256, 256)."""
    g = found.g
    return (g[:, None, :] - g[:, :, None]) - np.diff(B + found.x)[:, None, None, None]


def fit(
    H: Float,
    B: Float,
    Q: Float,
    *,
    g: Float | None = None,
    sd: float = 1 / 6,
    smoothness: float = 1.0,
    rounds: int = 4,
) -> Fit:
    """Return the robust Fit: patches that miss by much more than their pair's others count less each round.

    sd is in stops here.
    """
    V0 = V = weighted(H)
    for _ in range(rounds):
        found = solve(V, B, Q, g=g, sd=sd * np.log(2), smoothness=smoothness)
        r2 = residuals(found, B) ** 2
        spread2 = (V * r2).sum(axis=(2, 3), keepdims=True) / np.maximum(
            V.sum(axis=(2, 3), keepdims=True), 1e-9
        )
        V = V0 / (1 + r2 / (4 * np.maximum(spread2, CORE**2)))
    return found


def biases(H: Float, B: Float, found: Fit) -> Float:
    """Return by how many stops a frame is brighter than the one before says, (P - 1, C): weighted medians."""
    V, r = W[:, None] * W * H, residuals(found, B) / np.log(2)
    out = np.full(H.shape[:2], np.nan)
    for j, c in np.ndindex(*out.shape):
        told = V[j, c] > 0
        if told.any():
            out[j, c] = _median(r[j, c][told], V[j, c][told])
    return out


def _median(values: Float, weight: Float) -> float:
    """Return the weighted median."""
    order = np.argsort(values)
    heaped = np.cumsum(weight[order])
    return float(values[order][np.searchsorted(heaped, heaped[-1] / 2)])
