"""Exposure ratios of neighbouring frames, and the response, by least squares over flat patches.

H   pair tables     (P - 1, C, 256, 256): patches of level a in frame j, b in the next; see `flat_patches`
V   the weights of what stands in them, by trust in the levels, and less where a patch does not fit: see Pairs
B   ln stated times (P,); b = its steps (P - 1,)
g   responses       (C, 256), ln exposure of each level
x   corrections     (P,), ln(time / stated time) = Q y
Q   free directions (P, K), orthonormal: what the gauge leaves
v   level balance   (C, P - 1, 256): patches that come to a level, less those that leave it
T   total weight    (P - 1,), the sum of V over a pair's table
sd  prior           how far a stated time may be off, 1/6 stop

A patch measures g(b) - g(a) = b_j + x_j+1 - x_j. Least squares over all patches, with smooth g and
x of size sd, is quadratic in both. The best g for given x is linear in x; put in, there remain K
equations.

The gauge: pixels do not determine the unit of light, nor, where the response is unknown too, the
exponent u ((g, B) and (u g, u B) explain the same pixels). So the corrections are kept orthogonal
to 1, and to B where g is not known: the geometric mean of the times stays, and so does their span.
"""

from itertools import combinations
from typing import NamedTuple

import numpy as np

from hdrlab.core import weights
from hdrlab.core.arrays import F64, ArrayLike, Indices, Mask, as_times
from hdrlab.core.weights import second_differences
from hdrlab.errors import InputError

W = weights.cut(weights.hat(), below=0.02)
# of w(a) w(b): below, a level is of the response's ends, where the floor of a scan stays when light
# grows
TRUSTED = 0.03
# trust in a patch of level a that becomes b, (256, 256)
PAIR = np.where(W[:, None] * W > TRUSTED, W[:, None] * W, 0)
# ln: error of a patch's step, by noise, but above all by flare and a camera's processing
SIGMA = 0.15 * np.log(2)
# ln: patches that miss by less are no outliers, however well the others fit
CORE = 0.01 * np.log(2)
# patches, weighted, without which a pair of frames measures nothing
FEWEST = 5
# patches that a pair of frames counts for: common errors do not average away
MOST = 100
# of weights by what is left, which then hardly change
ROUNDS = 4
CURVATURES = second_differences(W, 1)
# of g^T S g = |w(z) g''(z)|^2, as Debevec weights it
STIFFNESS = CURVATURES.T @ CURVATURES


class Pairs(NamedTuple):
    """What stands in pair tables, (M,) each: of step j and channel c, level a that becomes b, of weight V.

    Of a hundred pairs of levels one occurs or none. `shape` is (P - 1, C).
    """

    j: Indices
    c: Indices
    a: Indices
    b: Indices
    V: F64
    shape: tuple[int, int]

    def total(self, values: F64) -> F64:
        """Return the sum of values (M,) over each table, (P - 1, C)."""
        out = np.zeros(self.shape)
        np.add.at(out, (self.j, self.c), values)
        return out


class Fit(NamedTuple):
    """The responses (C, 256) and the corrections x (P,) that explain the pair tables best."""

    g: F64
    x: F64


def as_ascending_times(times: ArrayLike, count: int) -> F64:
    """Return `times` as float64 (count,), from short to long, or raise a ValueError."""
    checked = as_times(times, count)
    if np.any(np.diff(checked) < 0):
        raise InputError(f"expected photographs from short to long, got times {checked.tolist()}")
    return checked


def free_directions(B: F64, *, known: bool = False) -> F64:
    """Return Q (P, K): the corrections orthogonal to 1, and where g is not known to B.

    Examples
    --------
    >>> free_directions(np.log([1, 2, 4])).shape, free_directions(np.log([1, 2, 4]), known=True).shape
    ((3, 1), (3, 2))
    """
    gauge = np.ones((1, len(B))) if known else np.stack([np.ones(len(B)), B - B.mean()])
    _, s, V = np.linalg.svd(gauge)
    return np.asarray(V[np.count_nonzero(s > 1e-9 * s[0]) :].T, np.float64)


def remove_trend(x: F64, B: F64) -> F64:
    """Return x less a straight line in B: that of two frames, which leaves the least sum of sqrt |x|."""
    left = [
        x - x[i] - (x[k] - x[i]) / (B[k] - B[i]) * (B - B[i])
        for i, k in combinations(range(len(B)), 2)
        if B[k] != B[i]
    ]
    return min(left, key=lambda r: float(np.round(np.sqrt(np.abs(r)).sum(), 6)))


def trust_pairs(H: F64) -> Pairs:
    """Return what stands in H, of weight w(a) w(b) H, or 0 where a level is not trusted."""
    j, c, a, b = np.unravel_index(
        np.flatnonzero(H.ravel() != 0), H.shape
    )  # of one axis it is found fastest
    return Pairs(j, c, a, b, PAIR[a, b] * H[j, c, a, b], H.shape[:2])


def weight_pairs(H: F64) -> Pairs:
    """Return the trusted pairs, weighted by w(a) w(b) H / SIGMA^2, no step with more than MOST patches."""
    found = trust_pairs(H)
    most = np.minimum(1, MOST / np.maximum(found.total(found.V).sum(axis=1), 1))
    return found._replace(V=found.V * most[found.j] / SIGMA**2)


def find_informative(H: F64) -> Mask:
    """Return which pairs of frames have at least FEWEST patches, (P - 1,)."""
    found = trust_pairs(H)
    return np.asarray(found.total(found.V).mean(axis=1) >= FEWEST)


def solve_steps(
    V: Pairs, B: F64, Q: F64, *, g: F64 | None = None, sd: float, smoothness: float
) -> Fit:
    """Return the Fit of least squares: sum V (g(b) - g(a) - step)^2 + (smoothness w g'')^2 + (x / sd)^2."""
    b, F = np.diff(B), np.diff(Q, axis=0)
    v = np.zeros((V.shape[1], V.shape[0], 256))
    np.add.at(v, (V.c, V.j, V.b), V.V)
    np.subtract.at(v, (V.c, V.j, V.a), V.V)
    T = np.diag(V.total(V.V).sum(axis=1))
    if g is None:
        answers = np.stack(
            [np.linalg.solve(_penalty(V, c, smoothness), v[c].T) for c in range(len(v))]
        )
        left = T - (v @ answers).sum(
            axis=0
        )  # of the weight, when each response has explained its part
        target = left @ b
    else:
        left, target = T, T @ b - (v @ g[..., None]).sum(axis=(0, 2))
    y = -np.linalg.solve(F.T @ left @ F + np.eye(F.shape[1]) / sd**2, F.T @ target)
    return Fit(answers @ (b + F @ y) if g is None else g, Q @ y)


def _penalty(V: Pairs, c: int, smoothness: float) -> F64:
    """Return S of g^T S g: patches connect levels (a graph's Laplacian), smoothness connects the rest."""
    S = MOST / SIGMA**2 * smoothness**2 * STIFFNESS
    a, b, weights = (each[V.c == c] for each in (V.a, V.b, V.V))
    for row, column, sign in ((a, b, -1), (b, a, -1), (a, a, 1), (b, b, 1)):
        np.add.at(S, (row, column), sign * weights)
    S[128, 128] += MOST / SIGMA**2  # the gauge, g(128) = 0, costs nothing: v sums to 0
    np.fill_diagonal(S, S.diagonal() + 1e-9 * np.trace(S) / len(S))
    return S


def step_residuals(V: Pairs, found: Fit, B: F64) -> F64:
    """Return g(b) - g(a) - (B + x)_j+1 + (B + x)_j of each pair of levels, (M,)."""
    return found.g[V.c, V.b] - found.g[V.c, V.a] - np.diff(B + found.x)[V.j]


def fit_steps(
    H: F64, B: F64, Q: F64, *, g: F64 | None = None, sd: float = 1 / 6, smoothness: float = 1.0
) -> Fit:
    """Return the robust Fit: patches that miss by much more than their pair's others count less each round.

    sd is in stops here.
    """
    V0 = V = weight_pairs(H)
    for _ in range(ROUNDS):
        found = solve_steps(V, B, Q, g=g, sd=sd * np.log(2), smoothness=smoothness)
        r2 = step_residuals(V, found, B) ** 2
        spread2 = V.total(V.V * r2) / np.maximum(V.total(V.V), 1e-9)
        V = V0._replace(V=V0.V / (1 + r2 / (4 * np.maximum(spread2, CORE**2)[V.j, V.c])))
    return found


def measure_biases(H: F64, B: F64, found: Fit, *, sizes: bool = False) -> F64:
    """Return by how many stops each step misses, (P - 1, C): weighted medians over patches, or of sizes."""
    V = trust_pairs(H)
    r = step_residuals(V, found, B) / np.log(2)
    r, out = np.abs(r) if sizes else r, np.full(V.shape, np.nan)
    for j, c in np.ndindex(*out.shape):
        used = (V.j == j) & (V.c == c) & (V.V > 0)
        if used.any():
            out[j, c] = np.quantile(r[used], 0.5, weights=V.V[used], method="inverted_cdf")
    return out
