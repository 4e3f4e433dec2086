"""Exposure ratios of neighbouring frames, and the response, by least squares over flat patches.

H   pair tables     (P - 1, C, 256, 256): patches of level a in frame j, b in the next; see
                    `flat_patches`
V   pair weights    the entries of H, weighted by trust in the levels, and less where a patch does
                    not fit; see `Pairs`
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

from dataclasses import dataclass, replace
from itertools import combinations
from typing import NamedTuple

import numpy as np

from hdrlab.core import weights
from hdrlab.core.arrays import F64, ArrayLike, Indices, Mask, as_times
from hdrlab.core.weights import second_differences
from hdrlab.errors import InputError

# w(z), trust in a level
LEVEL_WEIGHTS = weights.cut(weights.hat(), below=0.02)
# below this w(a) w(b), a level is at an end of the response, where the floor of a scan does not
# move when light grows
MIN_PAIR_WEIGHT = 0.03
_LEVEL_WEIGHT_PRODUCTS = LEVEL_WEIGHTS[:, None] * LEVEL_WEIGHTS
# trust in a patch of level a that becomes b, (256, 256)
PAIR_WEIGHTS = np.where(_LEVEL_WEIGHT_PRODUCTS > MIN_PAIR_WEIGHT, _LEVEL_WEIGHT_PRODUCTS, 0)
# error of a patch's step, by noise, but above all by flare and a camera's processing
STEP_ERROR_LN = 0.15 * np.log(2)
# patches that miss by less are no outliers, however well the others fit
MIN_SPREAD_LN = 0.01 * np.log(2)
# weighted patches without which a pair of frames measures nothing
MIN_PATCHES_PER_PAIR = 5
# patches that a pair of frames counts for at most: common errors do not average away
MAX_PATCHES_PER_PAIR = 100
# rounds of reweighting by residuals; after these the weights hardly change
REWEIGHTING_ROUNDS = 4
WEIGHTED_CURVATURES = second_differences(LEVEL_WEIGHTS, 1)
# of g^T S g = |w(z) g''(z)|^2, as Debevec weights it
STIFFNESS = WEIGHTED_CURVATURES.T @ WEIGHTED_CURVATURES
# g(128) = 0
GAUGE_LEVEL = 128


@dataclass(frozen=True, kw_only=True, eq=False)
class Pairs:
    """The entries of pair tables, (M,) each: in step j and channel c, level a becomes b, weight V.

    Pair tables are sparse: at most one pair of levels in a hundred occurs. `shape` is (P - 1, C).
    """

    j: Indices
    c: Indices
    a: Indices
    b: Indices
    V: F64
    shape: tuple[int, int]

    def total(self, values: F64) -> F64:
        """Return the sum of values (M,) over each table, (P - 1, C)."""
        sums = np.zeros(self.shape)
        np.add.at(sums, (self.j, self.c), values)
        return sums


class Fit(NamedTuple):
    """The responses (C, 256) and the corrections x (P,) that explain the pair tables best."""

    g: F64
    x: F64


def as_ascending_times(times: ArrayLike, count: int) -> F64:
    """Return `times` as float64 (count,), from short to long, or raise a ValueError."""
    checked = as_times(times, count)
    if np.any(np.diff(checked) < 0):
        raise InputError(
            f"expected photos from the shortest to the longest time, got {checked.tolist()}"
        )
    return checked


def free_directions(B: F64, *, known: bool = False) -> F64:
    """Return Q (P, K): the corrections orthogonal to 1, and to B where g is not known.

    Examples
    --------
    >>> B = np.log([1, 2, 4])
    >>> free_directions(B).shape
    (3, 1)
    >>> free_directions(B, known=True).shape
    (3, 2)
    """
    ones = np.ones(len(B))
    gauge = ones[None] if known else np.stack([ones, B - B.mean()])
    _, s, V = np.linalg.svd(gauge)
    rank = np.count_nonzero(s > 1e-9 * s[0])
    return np.asarray(V[rank:].T, np.float64)


def remove_trend(x: F64, B: F64) -> F64:
    """Return x less a straight line in B.

    The line passes through two frames: those that leave the least sum of sqrt |x|.
    """
    return list_trends(x, B)[0]


def list_trends(x: F64, B: F64, *, margin: float = 1.0) -> list[F64]:
    """Return x less each straight line that leaves at most `margin` times the least sum of sqrt |x|.

    The best one comes first. Each line passes through two frames.
    """
    residuals = []
    for i, k in combinations(range(len(B)), 2):
        if B[k] != B[i]:
            slope = (x[k] - x[i]) / (B[k] - B[i])
            residuals.append(x - x[i] - slope * (B - B[i]))
    costs = np.array([np.round(np.sqrt(np.abs(r)).sum(), 6) for r in residuals])
    order = np.argsort(costs, kind="stable")
    return [residuals[n] for n in order if costs[n] <= margin * costs[order[0]]]


def trust_pairs(H: F64) -> Pairs:
    """Return the entries of H, of weight w(a) w(b) H, or 0 where a level is not trusted."""
    entries = np.flatnonzero(H.ravel() != 0)  # faster than a search over four axes
    j, c, a, b = np.unravel_index(entries, H.shape)
    V = PAIR_WEIGHTS[a, b] * H[j, c, a, b]
    return Pairs(j=j, c=c, a=a, b=b, V=V, shape=H.shape[:2])


def weight_pairs(H: F64) -> Pairs:
    """Return the trusted pairs, weighted by w(a) w(b) H / STEP_ERROR_LN^2.

    No step counts for more than MAX_PATCHES_PER_PAIR patches.
    """
    pairs = trust_pairs(H)
    patches = pairs.total(pairs.V).sum(axis=1)
    factor = np.minimum(1, MAX_PATCHES_PER_PAIR / np.maximum(patches, 1))
    return replace(pairs, V=pairs.V * factor[pairs.j] / STEP_ERROR_LN**2)


def find_informative(H: F64) -> Mask:
    """Return which pairs of frames have at least MIN_PATCHES_PER_PAIR patches, (P - 1,)."""
    pairs = trust_pairs(H)
    return np.asarray(pairs.total(pairs.V).mean(axis=1) >= MIN_PATCHES_PER_PAIR)


def solve_steps(
    V: Pairs, B: F64, Q: F64, *, g: F64 | None = None, sd: float, smoothness: float
) -> Fit:
    """Return the Fit of least squares.

    It minimizes sum V (g(b) - g(a) - step)^2 + (smoothness w g'')^2 + (x / sd)^2.
    """
    b = np.diff(B)
    F = np.diff(Q, axis=0)
    v = np.zeros((V.shape[1], V.shape[0], 256))
    np.add.at(v, (V.c, V.j, V.b), V.V)
    np.subtract.at(v, (V.c, V.j, V.a), V.V)
    T = np.diag(V.total(V.V).sum(axis=1))
    if g is not None:
        target = T @ b - (v @ g[..., None]).sum(axis=(0, 2))
        return Fit(g, Q @ _solve_corrections(T, target, F, sd))
    # the best response of each channel is linear in the steps: g = response_per_step @ steps
    response_per_step = np.stack(
        [np.linalg.solve(_penalty(V, c, smoothness), v[c].T) for c in range(len(v))]
    )
    # the weight that remains when each response has explained its part
    unexplained = T - (v @ response_per_step).sum(axis=0)
    y = _solve_corrections(unexplained, unexplained @ b, F, sd)
    return Fit(response_per_step @ (b + F @ y), Q @ y)


def _solve_corrections(A: F64, target: F64, F: F64, sd: float) -> F64:
    """Return y (K,) of the normal equations (F^T A F + 1 / sd^2) y = -F^T target."""
    prior = np.eye(F.shape[1]) / sd**2
    y = -np.linalg.solve(F.T @ A @ F + prior, F.T @ target)
    return np.asarray(y, np.float64)


def _penalty(V: Pairs, c: int, smoothness: float) -> F64:
    """Return S of g^T S g for channel c.

    Patches connect their two levels (a graph's Laplacian); smoothness connects the others.
    """
    total_weight = MAX_PATCHES_PER_PAIR / STEP_ERROR_LN**2
    S = total_weight * smoothness**2 * STIFFNESS
    in_channel = V.c == c
    a = V.a[in_channel]
    b = V.b[in_channel]
    weight = V.V[in_channel]
    np.add.at(S, (a, b), -weight)
    np.add.at(S, (b, a), -weight)
    np.add.at(S, (a, a), weight)
    np.add.at(S, (b, b), weight)
    # the gauge costs nothing: v sums to 0
    S[GAUGE_LEVEL, GAUGE_LEVEL] += total_weight
    np.fill_diagonal(S, S.diagonal() + 1e-9 * np.trace(S) / len(S))
    return S


def step_residuals(V: Pairs, fit: Fit, B: F64) -> F64:
    """Return g(b) - g(a) - (B + x)_j+1 + (B + x)_j of each pair of levels, (M,)."""
    return fit.g[V.c, V.b] - fit.g[V.c, V.a] - np.diff(B + fit.x)[V.j]


def fit_steps(
    H: F64, B: F64, Q: F64, *, g: F64 | None = None, sd: float = 1 / 6, smoothness: float = 1.0
) -> Fit:
    """Return the robust Fit of pair tables H to stated times B (ln).

    In each round, patches that miss by much more than the others of their pair count less. sd is
    in stops here.
    """
    all_pairs = weight_pairs(H)
    pairs = all_pairs
    for _ in range(REWEIGHTING_ROUNDS):
        fit = solve_steps(pairs, B, Q, g=g, sd=sd * np.log(2), smoothness=smoothness)
        r2 = step_residuals(pairs, fit, B) ** 2
        spread2 = pairs.total(pairs.V * r2) / np.maximum(pairs.total(pairs.V), 1e-9)
        scale2 = np.maximum(spread2, MIN_SPREAD_LN**2)[pairs.j, pairs.c]
        pairs = replace(all_pairs, V=all_pairs.V / (1 + r2 / (4 * scale2)))
    return fit


def measure_biases(H: F64, B: F64, fit: Fit, *, sizes: bool = False) -> F64:
    """Return by how many stops each step misses, (P - 1, C): the weighted median over its patches.

    With `sizes`, the median of the absolute values.
    """
    pairs = trust_pairs(H)
    residuals = step_residuals(pairs, fit, B) / np.log(2)
    if sizes:
        residuals = np.abs(residuals)
    biases = np.full(pairs.shape, np.nan)
    for j, c in np.ndindex(*biases.shape):
        used = (pairs.j == j) & (pairs.c == c) & (pairs.V > 0)
        if used.any():
            biases[j, c] = np.quantile(
                residuals[used], 0.5, weights=pairs.V[used], method="inverted_cdf"
            )
    return biases
