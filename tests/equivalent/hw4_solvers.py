"""Homework 4 with other methods: sparse systems with another constant, states with fewer parts."""

# %%
import numpy as np
from scipy.ndimage import convolve1d, fourier_gaussian, gaussian_filter1d
from scipy.sparse import diags_array, eye_array, kron
from scipy.sparse.linalg import spsolve

# %% task="solve"


def second(n):
    """Return the matrix of the second difference, with nothing flowing through the ends."""
    main = np.full(n, -2.0)
    main[[0, -1]] = -1
    return diags_array([np.ones(n - 1), main, np.ones(n - 1)], offsets=[-1, 0, 1])


def solve(f):
    H, W = f.shape
    A = kron(second(H), eye_array(W)) + kron(eye_array(H), second(W))
    A = A.tolil()
    A[0, :] = 0
    A[0, 0] = 1
    b = f.astype(float).ravel()
    b[0] = 41.0  # any constant will do
    return spsolve(A.tocsc(), b).reshape(H, W)


# %% task="divergence"


def first(n):
    """Return the matrix of the forward difference, 0 at the last."""
    main = np.full(n, -1.0)
    main[-1] = 0
    return diags_array([main, np.ones(n - 1)], offsets=[0, 1])


def divergence(G):
    """Return minus the transpose of the gradient, as matrices."""
    Gy, Gx = G
    return -(first(len(Gy)).T @ Gy) - (first(Gx.shape[1]).T @ Gx.T).T


# %% task="attenuation_steps"


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    levels = int(np.log2((min(lL.shape) + 1) / 32))
    pyramid = [np.array(lL, float)]
    for _ in range(levels):
        blurred = pyramid[-1]
        for axis in (0, 1):
            blurred = convolve1d(blurred, np.array([1, 4, 6, 4, 1]) / 16, axis=axis, mode="mirror")
        pyramid.append(blurred[::2, ::2])
    lPhi = np.zeros(((pyramid[-1].shape[0] + 1) // 2, (pyramid[-1].shape[1] + 1) // 2))
    for k in range(levels, -1, -1):
        H = np.pad(pyramid[k], 1, mode="edge")
        dy, dx = (H[2:] - H[:-2])[:, 1:-1], (H[:, 2:] - H[:, :-2])[1:-1]
        slope = np.sqrt(dy**2 + dx**2) / 2 ** (k + 1)
        lphi = (beta - 1) * np.log(np.maximum(slope / (alpha * slope.mean()), noise / alpha))
        rows = np.interp(np.arange(slope.shape[0]) / 2, np.arange(len(lPhi)), np.arange(len(lPhi)))
        columns = np.minimum(np.arange(slope.shape[1]) / 2, lPhi.shape[1] - 1)
        lPhi = np.log(between(np.exp(lPhi), rows, columns)) + lphi
        yield k, pyramid[k], slope, np.exp(lphi), np.exp(lPhi)


def between(A, rows, columns):
    """Return A read between its pixels, along one axis after the other."""
    down = np.stack([np.interp(rows, np.arange(len(A)), column) for column in A.T], axis=1)
    return np.stack([np.interp(columns, np.arange(A.shape[1]), row) for row in down])


# %% task="scale"


def scale(L, *, headroom=8.0, sigma=None):
    blurred = np.asarray(L, float)
    for axis in (0, 1):
        blurred = gaussian_filter1d(blurred, sigma, axis=axis, mode="reflect", truncate=3.0)
    return (1 / headroom) / blurred


# %% task="adjust_steps"


def adjust_steps(f, db, D, *, tolerance=0.025):
    """Yield lists instead of tuples."""
    histogram = np.asarray(f, dtype=float)
    first = histogram.sum()
    yield [histogram, np.inf, first, np.inf]
    for _ in range(200):
        total = histogram.sum()
        if total <= tolerance * first:
            break
        ceiling = total * db / D
        trimmed = np.where(histogram > ceiling, ceiling, histogram)
        cut = total - trimmed.sum()
        yield [trimmed, ceiling, total, cut]
        if cut < tolerance * total:
            break
        histogram = trimmed


# %% task="compress"


def compress(base, low, high, *, contrast=50.0):
    share = (np.asarray(base, float) - high) / (high - low)
    return share * min(np.log10(contrast), high - low)


# %% task="layers"


def layers(lL, *, sigma_s, sigma_r=0.4):
    """Sum over offsets, as in the definition, half of them at a time."""
    v = np.asarray(lL, float)
    r = int(np.ceil(3 * sigma_s))
    total, weight = v.copy(), np.ones_like(v)
    for dy in range(r + 1):
        for dx in range(-r if dy else 1, r + 1):
            a = v[dy:, max(dx, 0) : v.shape[1] + min(dx, 0)]
            b = v[: v.shape[0] - dy, max(-dx, 0) : v.shape[1] + min(-dx, 0)]
            w = np.exp(-0.5 * ((dy**2 + dx**2) / sigma_s**2 + (a - b) ** 2 / sigma_r**2))
            here = (slice(dy, None), slice(max(dx, 0), v.shape[1] + min(dx, 0)))
            there = (slice(None, v.shape[0] - dy), slice(max(-dx, 0), v.shape[1] + min(-dx, 0)))
            total[here] += w * b
            weight[here] += w
            total[there] += w * a
            weight[there] += w
    return total / weight, v - total / weight


# %% task="scale_steps"


def scale_steps(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    adaptation, undecided = np.array(blurred[0], float), None
    for k, (centre, surround) in enumerate(zip(blurred[:-1], blurred[1:], strict=True)):
        s = 1.6**k
        V = (centre - surround) * s**2 / (2**phi * key + centre * s**2)
        small = np.abs(V) < threshold
        undecided = small if undecided is None else undecided & small
        adaptation[undecided] = centre[undecided]
        yield [s, centre, V, undecided.astype(int), adaptation.copy()]


# %% task="display"


def display(Lm, adaptation, white=None):
    Ld = np.divide(Lm, adaptation + 1)
    if white is not None and np.isfinite(white):
        Ld = Ld + Lm * Lm / (white * white) / (1 + adaptation)
    return np.where(Ld > 1, 1, Ld)


# %% task="log_average"


def log_average(L, *, delta=1e-6):
    L = L.astype(float)
    unit = np.median(L[L > 0]) if np.any(L > 0) else 1.0
    return 2 ** np.log2(L + delta * unit).mean()


# %% task="fix_uncertain"


def fix_uncertain(mean, k, *, sigma_s):
    smooth = np.fft.ifft2(fourier_gaussian(np.fft.fft2(mean), 2)).real
    root = np.sqrt(2 * np.pi) * sigma_s
    u = np.where(k >= root, 1, np.where(k <= 1, 0, np.log2(np.maximum(k, 1e-9)) / np.log2(root)))
    return u * mean + (1 - u) * smooth
