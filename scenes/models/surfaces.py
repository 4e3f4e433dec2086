"""Materials: wood, plaster, glass and the like, out of noise and of the pictures in scikit-image's wheel.

rho  reflectance (h, w, 3), 0 to 1, linear light, primaries of sRGB
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import gaussian_filter

from scenes.computed.textures import texture
from scenes.models.place import Colour, Material

Texture = NDArray[np.floating[Any]]


def noise(shape: tuple[int, int], scales: tuple[tuple[float, float], ...], *, seed: int) -> Texture:
    """Return the mean of smooth random pictures (h, w) that tile, each of variance 1; scales in pixels."""
    rng = np.random.default_rng(seed)
    layers = [gaussian_filter(rng.standard_normal(shape), scale, mode="wrap") for scale in scales]
    return np.mean([layer / layer.std() for layer in layers], axis=0)


def wood(
    dark: Colour, light: Colour, *, seed: int = 0, planks: int = 0, size: int = 512
) -> Texture:
    """Return rho of sawn wood whose grain runs along u; `planks` boards side by side, or one piece."""
    rings = noise((size, size), ((3, 90), (9, 160)), seed=seed)
    fibre = noise((size, size), ((0.7, 14),), seed=seed + 1)
    share = 0.5 + 0.28 * np.sin(5 * rings) * 0.6 + 0.12 * fibre
    if planks:
        rng = np.random.default_rng(seed + 2)
        row = np.arange(size) * planks // size
        share = np.stack(
            [
                np.roll(line, k)
                for line, k in zip(share, rng.integers(0, size, planks)[row], strict=True)
            ]
        )
        share = share + rng.normal(0, 0.14, planks)[row][:, None]
        gap = np.arange(size) * planks % size < 0.045 * size
        share[gap] = -0.6
    rho = np.array(dark) + np.clip(share, -0.6, 1.2)[..., None] * (np.array(light) - np.array(dark))
    return np.clip(rho, 0.004, 0.9)


def tinted(name: str, colour: Colour, *, contrast: float = 1.0) -> Texture:
    """Return a picture of `textures` in gray, of that mean colour, its contrast raised to a power."""
    gray = texture(name)[0].mean(axis=2) ** contrast
    return np.clip(gray[..., None] / gray.mean() * np.array(colour), 0.003, 0.92)


def bricks(colour: Colour, *, contrast: float = 1.0) -> Texture:
    """Return the brick wall, whose picture shows its courses upright, with its courses level."""
    return np.rot90(tinted("brick", colour, contrast=contrast)).copy()


def picture(name: str, gain: float = 1.0) -> Texture:
    """Return a picture of `scenes.computed.textures` in its colours."""
    rho = texture(name)[0]
    return np.clip(gain * np.broadcast_to(rho, (*rho.shape[:2], 3)), 0.003, 0.92)


def plaster(colour: Colour, *, seed: int = 0, depth: float = 0.1, size: int = 512) -> Texture:
    """Return rho of an old plastered wall: clouds, stains and grain."""
    clouds = noise((size, size), ((60, 40), (18, 14), (4, 4), (1, 1)), seed=seed)
    return np.clip(np.array(colour) * (1 + depth * clouds[..., None]), 0.01, 0.92)


def tiles(
    first: Colour, second: Colour, *, seed: int = 0, count: int = 8, size: int = 1024
) -> Texture:
    """Return rho of a floor of `count` by `count` worn tiles in two colours, with mortar between them."""
    rng = np.random.default_rng(seed)
    k = np.arange(size) * count // size
    at = (np.arange(size) * count / size) % 1
    checks = (k[:, None] + k) % 2
    rho = (
        np.where(checks[..., None] == 0, first, second)
        * (1 + 0.13 * rng.standard_normal((count, count)))[k][:, k][..., None]
    )
    rho = (
        rho * (1 + 0.12 * noise((size, size), ((30, 30), (6, 6), (1, 1)), seed=seed + 1))[..., None]
    )
    edge = np.minimum(at, 1 - at)
    joint = np.minimum(edge[:, None], edge) < 0.025
    rho[joint] = 0.05
    return np.clip(rho, 0.01, 0.9)


def matt(rho: ArrayLike, *, metres: ArrayLike = 1.0) -> Material:
    """Return a surface without gloss: a colour, or a texture that spans `metres`, along both of u and v."""
    return {"type": "diffuse", "reflectance": paint(rho, metres)}


def glossy(rho: ArrayLike, *, rough: float = 0.2, metres: ArrayLike = 1.0) -> Material:
    """Return a varnished, glazed or wet surface: a colour under a clear coat."""
    return {
        "type": "roughplastic",
        "diffuse_reflectance": paint(rho, metres),
        "alpha": rough,
        "nonlinear": False,
        "distribution": "ggx",
    }


def metal(rho: ArrayLike, *, rough: float = 0.25, metres: ArrayLike = 1.0) -> Material:
    """Return metal that reflects a share rho of the light."""
    return {
        "type": "roughconductor",
        "material": "none",
        "specular_reflectance": paint(rho, metres),
        "alpha": rough,
        "distribution": "ggx",
    }


def paint(rho: ArrayLike, metres: ArrayLike = 1.0) -> Material:
    """Return Mitsuba's texture of a colour, or of an array that repeats after so many metres."""
    rho = np.asarray(rho, np.float64)
    if rho.ndim == 1:
        return {"type": "rgb", "value": rho.tolist()}
    u, v = (1 / float(m) for m in np.broadcast_to(np.asarray(metres, np.float64), 2))
    return {"type": "bitmap", "data": rho, "repeat": (u, v)}
