"""Photographs of one textured scene that known offsets lay on each other."""

import numpy as np
from scipy.ndimage import zoom
from skimage.data import astronaut

MARGIN, H, W = 70, 300, 420


def radiance(texture, decades=2.0):
    """Return a scene (H + 2 MARGIN, W + 2 MARGIN, 3) of median 1: a texture under slanting light."""
    rows, columns = H + 2 * MARGIN, W + 2 * MARGIN
    z = max(rows / texture.shape[0], columns / texture.shape[1]) + 0.01
    grown = zoom(texture.astype(np.float32) / 255, (z, z, 1), order=1)[:rows, :columns]
    light = (
        np.linspace(-0.25, 0.25, rows)[:, None, None]
        + np.linspace(-0.15, 0.15, columns)[None, :, None]
    )
    E = 10 ** (decades * (grown - 0.5 + light))
    return E / np.median(E)


def photograph(E, time, offset=(0, 0), *, rng, dtype=np.uint8, noise=0.004):
    """Return a photograph that must move by `offset` to lie on one taken without any."""
    dy, dx = offset
    X = 0.2 * time * E[MARGIN + dy : MARGIN + dy + H, MARGIN + dx : MARGIN + dx + W]
    X = X + noise * np.sqrt(X + 0.01) * rng.standard_normal(X.shape)
    top = np.iinfo(dtype).max
    return (np.clip(X, 0, 1) ** (1 / 2.2) * top + 0.5).astype(dtype)


def bracket(offsets, times, *, texture=None, decades=2.0, dtype=np.uint8, seed=0, **knobs):
    """Return photographs (P, H, W, 3) of one scene that `offsets` lay on each other."""
    rng = np.random.default_rng(seed)
    E = radiance(astronaut() if texture is None else texture, decades)
    return np.stack(
        [
            photograph(E, t, o, rng=rng, dtype=dtype, **knobs)
            for t, o in zip(times, offsets, strict=True)
        ]
    )
