"""How likely the levels of a bracket are, for a response, ratios and a noise: the model behind `marginal`.

Z      pixel levels   (N, P), 0 ... 255: pixel i in frame q, frames from short to long
f_inv  f^-1           M -> exposure, a polynomial with coefficients c: see `mitsunaga`
tau    ln exposures   (P,), of each frame over the longest, tau[-1] = 0
sigma  noise          standard deviation of M at every brightness, before it is cut into levels
x      nodes          (K,) brightnesses that a pixel may have in frame `at` (K,); p (K,) how often it does
m      prediction     (P, K), brightness of node k in frame q

Each pixel has an exposure that we do not know, and sum over:

    P(Z_i) = sum_k p_k prod_q P(Z_iq | m_qk),     P(z | m) = mass of Normal(m, sigma) in the cell of level z.

The end cells are open, so clamping and rounding are part of the model, and dark and clipped pixels
say what they know instead of being cut.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array
from scipy.special import ndtr

from hdrlab.core.arrays import F64, ArrayLike, Indices
from hdrlab.response import mitsunaga, polynomial

# of the levels' cells, in M
EDGES = np.concatenate([[-np.inf], (np.arange(255) + 0.5) / 255, [np.inf]])
# probability of a level that the noise does not explain, so that a pixel that moved has no influence
OUTLIER_PROBABILITY = 1e-12


class Nodes(NamedTuple):
    """Brightness x (K,) in frame `at` (K,): an exposure each, which moves with c and tau."""

    x: F64
    at: Indices


@dataclass(frozen=True, kw_only=True, eq=False)
class Support:
    """The nodes that matter for each pixel: those of pixel i are k[start[i] : start[i + 1]].

    P(z | m_qk) is needed at `cells`, each (q, k, z) once. Pair j of a pixel and a node uses cell
    at[q, j] in frame q.
    """

    start: Indices
    k: Indices
    cells: tuple[Indices, ...]
    at: Indices


def nodes(c: F64, tau: F64, count: int) -> Nodes:
    """Return `count` nodes evenly over the brightness of the longest frame; where it clips, of the next, ...

    So p and the response hardly disturb each other: a frame's own levels say much of p, and nothing
    of f^-1.
    """
    x = (np.arange(count) + 0.5) / count
    # exposure from which only this frame is left
    clipped_next = np.append(np.exp(tau[:-1] - tau[1:]), 0)
    frames = [x[mitsunaga.value(x, c) > exposure] for exposure in clipped_next]
    counts = [len(frame) for frame in frames]
    return Nodes(np.concatenate(frames), np.repeat(np.arange(len(frames)), counts))


def predict(c: F64, tau: F64, at: Nodes) -> tuple[F64, F64]:
    """Return m = f(e_q / e_at f^-1(x)), (P, K), and its derivatives by (c, tau[:-1]), (P, K, A - 1).

    f^-1(m) = rho f^-1(x), differentiated: the slope at m times dm is (rho b_n(x) - b_n(m)) dc_n +
    rho f^-1(x) d ln rho. Clipped, m stays.
    """
    order = len(c) + 1
    P = len(tau)
    rho = np.exp(tau[:, None] - tau[at.at])
    X = rho * mitsunaga.value(at.x, c)
    m = polynomial.brightness(X, c)
    dc = (rho[..., None] * mitsunaga.terms(at.x, order) - mitsunaga.terms(m, order))[..., 1:]
    own = np.arange(P)[:, None] == np.arange(P - 1)
    dtau = X[..., None] * (own[:, None, :].astype(float) - own[at.at])
    return m, np.where(X < 1, 1 / polynomial.slope(m, c), 0)[..., None] * np.concatenate(
        [dc, dtau], axis=-1
    )


def masses(m: ArrayLike, sigma: float, z: ArrayLike) -> tuple[F64, F64, F64]:
    """Return P(z | m), and the derivatives of its logarithm by m and by ln sigma; m and z broadcast."""
    z = np.asarray(z, dtype=np.intp)
    m = np.asarray(m)
    low = (EDGES[z] - m) / sigma
    high = (EDGES[z + 1] - m) / sigma
    bell_low = np.exp(-(low**2) / 2) / np.sqrt(2 * np.pi)
    bell_high = np.exp(-(high**2) / 2) / np.sqrt(2 * np.pi)
    P = ndtr(high) - ndtr(low) + OUTLIER_PROBABILITY
    tilt = bell_high * np.where(high < np.inf, high, 0) - bell_low * np.where(low > -np.inf, low, 0)
    return P, (bell_low - bell_high) / (sigma * P), -tilt / P


def table(m: F64, sigma: float) -> F64:
    """Return P(z | m) of all levels, (P, K, 256).

    Examples
    --------
    >>> int(table(np.array([[100 / 255]]), 0.01).argmax())
    100
    """
    return np.diff(ndtr((EDGES - m[..., None]) / sigma)) + OUTLIER_PROBABILITY


def support(Z: Indices, P: F64, *, least: float = 1e-7, block: int = 1000) -> Support:
    """Return for each pixel the nodes with at least that fraction of its best node's likelihood."""
    # (P, 256, K): a pixel's likelihood is a product of rows
    tables = P.swapaxes(1, 2).astype(np.float32)
    kept = []
    for z in np.split(Z, range(block, len(Z), block)):
        likelihood = np.prod(
            [table[levels] for table, levels in zip(tables, z.T, strict=True)], axis=0
        )
        kept.append(likelihood > least * likelihood.max(axis=1, keepdims=True))
    counts = np.concatenate([mask.sum(axis=1) for mask in kept])
    k = np.concatenate([mask.nonzero()[1] for mask in kept])
    cell = np.ravel_multi_index(
        (np.arange(len(P))[:, None], k, np.repeat(Z, counts, axis=0).T), P.shape
    )
    is_used = np.zeros(P.size, bool)
    is_used[cell] = True
    at = (np.cumsum(is_used) - 1)[cell]
    start = np.append(0, np.cumsum(counts))
    cells = np.unravel_index(np.flatnonzero(is_used), P.shape)
    return Support(start=start, k=k, cells=cells, at=at)


def posterior(P: F64, p: F64, near: Support) -> tuple[F64, F64]:
    """Return ln P(Z_i) (N,) and each supporting node's share of it, p_k prod_q P(Z_iq | m_qk) / P(Z_i).

    P are the probabilities of the support's cells.
    """
    joint = p[near.k]
    for cell in near.at:
        joint = joint * P[cell]
    total = np.add.reduceat(joint, near.start[:-1])
    return np.log(total), joint / np.repeat(total, np.diff(near.start))


def scores(weights: F64, near: Support, J: F64, dm: F64, ds: F64) -> F64:
    """Return the derivatives of ln P(Z_i) by (c, tau[:-1], ln sigma), (N, A), from those of the cells.

    Fisher's identity: the derivative for a known node, averaged over the nodes by their shares.
    """
    shape = len(near.start) - 1, J.shape[1]
    S = np.zeros((shape[0], J.shape[2] + 1))
    for own, cell in zip(J, near.at, strict=True):
        S[:, :-1] += csr_array((weights * dm[cell], near.k, near.start), shape=shape) @ own
        S[:, -1] += np.add.reduceat(weights * ds[cell], near.start[:-1])
    return S


def density(weights: F64, near: Support, count: int) -> F64:
    """Return p_k, the mean over the pixels of node k's shares: the step of EM."""
    return np.bincount(near.k, weights, count) / (len(near.start) - 1)


def stiffness(A: int, frames: int, trust: float) -> F64:
    """Return the (A, A) matrix of a prior on theta = (c, tau[:-1], ln sigma): each ln R to within `trust`."""
    D = np.zeros((frames - 1, A))
    # tau_q - tau_q+1
    D[:, A - frames :] = np.eye(frames - 1, frames) - np.eye(frames - 1, frames, 1)
    D[:, -1] = 0  # where ln sigma stands, for tau of the longest frame is 0
    return D.T @ D / trust**2
