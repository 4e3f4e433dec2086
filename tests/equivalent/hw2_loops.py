"""Homework 2 in loops, with the linear systems as the papers print them."""

# %%
import numpy as np

# %% task="hat"


def hat(n=256):
    return np.array([z if z <= (n - 1) / 2 else n - 1 - z for z in range(n)])


# %% task="gsolve"


def gsolve(Z, B, smoothness, w):
    N, P = Z.shape
    n = len(w)
    A, b, k = np.zeros((N * P + n - 1, n + N)), np.zeros(N * P + n - 1), 0
    for i in range(N):
        for j in range(P):
            A[k, Z[i, j]] = w[Z[i, j]]
            A[k, n + i] = -w[Z[i, j]]
            b[k] = w[Z[i, j]] * B[j]
            k += 1
    A[k, n // 2] = 1
    k += 1
    for z in range(1, n - 1):
        A[k, z - 1], A[k, z], A[k, z + 1] = (smoothness * w[z] * c for c in (1, -2, 1))
        k += 1
    x = np.linalg.lstsq(A, b, rcond=None)[0]
    return x[:n], x[n:]


# %% task="irradiance"


def irradiance(Z, t, f_inv, w):
    E = []
    for row in Z:
        above = sum(w[z] * f_inv[z] * tj for z, tj in zip(row, t, strict=True))
        below = sum(w[z] * tj * tj for z, tj in zip(row, t, strict=True))
        E.append(above / below if below > 0 else float("nan"))
    return np.array(E)


# %% task="update"


def update(Z, t, E, n=256):
    total, pixels = [0.0] * n, [0] * n
    for row, Ei in zip(Z.tolist(), E.tolist(), strict=True):
        if Ei == Ei:  # NaN is not
            for z, tj in zip(row, t.tolist(), strict=True):
                total[z] += Ei * tj
                pixels[z] += 1
    return np.array([s / p if p else float("nan") for s, p in zip(total, pixels, strict=True)])


# %% task="recover_steps"


def recover_steps(Z, times, w, *, tolerance=1e-4, max_iterations=200):
    f_inv = np.arange(256) / 128
    empty = np.array([not (Z == m).any() for m in range(256)])
    empty[0], top = True, max(z for z in range(256) if w[z] > 0)
    empty[top + 1 :] = True
    yield f_inv, np.inf, empty
    for _ in range(max_iterations):
        new = update(Z, times, irradiance(Z, times, f_inv, w))
        known = [m for m in range(256) if not empty[m] and new[m] == new[m]]
        new = np.interp(np.arange(256), known, new[known])
        new = new / new[128]
        f_inv, change = new, np.abs(new - f_inv).max()
        yield f_inv, change, empty
        if change < tolerance:
            return


# %% task="recover"


def recover(images, times, *, order=5, eps=1e-3):
    if images.ndim == 3:
        images = images[..., None]
    by_time = sorted(range(len(times)), key=lambda q: times[q])
    images, times = images[by_time], [times[q] for q in by_time]
    R = [times[q] / times[q + 1] for q in range(len(times) - 1)]
    C, before = images.shape[-1], None
    for _ in range(25):
        curves, above, below = [], np.zeros(len(R)), np.zeros(len(R))
        for c in range(C):
            pairs = [both_hold(images[q, ..., c], images[q + 1, ..., c]) for q in range(len(R))]
            A, b = [], []
            for (M, N), r in zip(pairs, R, strict=True):
                A.append(
                    np.stack(
                        [M**n - M**order - r * (N**n - N**order) for n in range(1, order)], axis=1
                    )
                )
                b.append(r * N**order - M**order)
            a = np.linalg.lstsq(np.concatenate(A), np.concatenate(b), rcond=None)[0]
            a = np.append(a, 1 - sum(a))
            for q, (M, N) in enumerate(pairs):
                above[q] += value(a, M).sum()
                below[q] += value(a, N).sum()
            curves.append(value(a, np.arange(256) / 255))
        R, f = list(above / below), np.stack(curves, axis=-1)
        if before is not None and np.abs(f - before).max() < eps:
            break
        before = f
    rises = np.maximum(np.diff(f, axis=0), 1e-6)
    f = np.concatenate([f[:1] * 0, np.cumsum(rises, axis=0)])
    f[0] = f[1] / 2
    return np.log(f / f[128]).squeeze()


def both_hold(Z, Y):
    M, N = Z.ravel() / 255, Y.ravel() / 255
    held = (M > 0.05) & (M < 0.98) & (N > 0.05) & (N < 0.98)
    return M[held], N[held]


def value(a, M):
    f = 0 * M
    for n in range(len(a)):
        f = f + a[n] * M ** (n + 1)
    return f
