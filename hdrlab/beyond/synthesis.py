"""The HDR image synthesis equation: what a picture of light has to be like (Sen et al., SIGGRAPH Asia 2012).

L_k    photograph k          (H, W, C), values of `ldr_values`, 0 to 1, from short to long
h      value -> radiance;  l_k  radiance -> value that exposure k makes of it
g_k    l_k(h(L_q))           photograph q as exposure k would have had it
alpha  (H, W, 1), 0 to 1     how well the reference is exposed
H      radiance              (H, W, C)
I_k    (P, H, W, C)          the reference's moment in every exposure
Lambda (P, H, W, C)          how far to trust a value

    E(H) = sum of  alpha (h(L_ref) - H)^2 + (1 - alpha) MBDS(H | L_1, ..., L_P)        [Sen12 sec. 3]
"""

import dataclasses
from dataclasses import dataclass

import numpy as np

from hdrlab.beyond.ldr_values import boost, consistent_range, expose, radiance, resize_picture
from hdrlab.beyond.patchmatch import cut_patches
from hdrlab.core.arrays import F32, F64, Mask

Ramp = tuple[float, float]

# times the squared noise: the expected squared distance of a noisy patch from a clean one
NOISE_PRICE = 2.0
# of a value near black or clipping, for pixels that no photograph measures well
MIN_WEIGHT = 1e-4


@dataclass(frozen=True)
class Scene:
    """The photographs at one scale, from short to long.

    Attributes
    ----------
    L : (P, h, w, C), values
    noise : (P, h, w, C), what one level more would add to the value
    clipped : (P, h, w, C) bool
    t : (P,), seconds
    full : (C,), exposure of a full pixel
    reference : which of them
    alpha : (h, w, 1)
    """

    L: F32
    noise: F32
    clipped: Mask
    t: F64
    full: F32
    reference: int
    alpha: F32


def trapezoid(z: F32, low: Ramp, high: Ramp) -> F32:
    """Return alpha (H, W, 1) of levels z, 0 to 1: up over `low`, 1, down over `high`; the least channel's.

    Examples
    --------
    >>> trapezoid(np.array([[[0.1], [0.5], [0.875], [1.0]]]), (0.05, 0.2), (0.85, 0.95)).ravel().round(2)
    array([0.33, 1.  , 0.75, 0.  ], dtype=float32)
    """
    rising = (z - low[0]) / (low[1] - low[0])
    falling = (high[1] - z) / (high[1] - high[0])
    return np.clip(np.minimum(rising, falling), 0, 1).min(axis=-1, keepdims=True).astype(np.float32)


def triangle(v: F32) -> F32:
    """Return Lambda(v), 1 in the middle and 0 at both ends [Debevec97 eq. 4]."""
    return np.minimum(2 * v, 2 - 2 * v)


def trust_weights(I: F32) -> F32:  # noqa: E741
    """Return Lambda(I_k), but 1 in the highlights of the shortest and the shadows of the longest exposure.

    No other photograph measures these better.
    """
    w = triangle(I)
    shortest = np.where(I[0] > 0.5, 1, w[0])
    longest = np.where(I[-1] < 0.5, 1, w[-1])
    w[0] = shortest
    w[-1] = longest
    return np.maximum(w, MIN_WEIGHT)


def merge_exposures(I: F32, scene: Scene) -> F32:  # noqa: E741
    """Return H~ = sum_k Lambda(I_k) h(I_k) / sum_k Lambda(I_k)  [Sen12 sec. 3]."""
    w = trust_weights(I)
    h = np.stack([radiance(v, t, scene.full) for v, t in zip(I, scene.t, strict=True)])
    return (w * h).sum(axis=0) / w.sum(axis=0)


def blend_reference(H: F32, scene: Scene) -> F32:
    """Return alpha h(L_ref) + (1 - alpha) H~, the H of least energy for given I_k [Sen12 sec. 3].

    H~ is kept within what the reference allows: at least h(L_ref) where that is clipped, and
    elsewhere what lies within a few levels of it. Otherwise small things that stand in its shadows
    would be lost.
    """
    k = scene.reference
    v = scene.L[k]
    t = scene.t[k]
    low, high = consistent_range(v, scene.noise[k], scene.clipped[k], t, scene.full)
    return scene.alpha * radiance(v, t, scene.full) + (1 - scene.alpha) * np.clip(H, low, high)


def guess_radiance(scene: Scene) -> F32:
    """Return the initial guess: h(L_ref), or where it is clipped the maximum with shorter exposures.

    The paper begins with the reference alone. But a flat, clipped region is similar to any other
    flat region, and would be filled with the nearest wall.
    """
    k = scene.reference
    H = [radiance(v, t, scene.full) for v, t in zip(scene.L[: k + 1], scene.t, strict=False)]
    return np.where(scene.clipped[k], np.max(H, axis=0), H[k])


def extract_exposures(H: F32, scene: Scene) -> F32:
    """Return I_k = l_k(H) of every exposure."""
    return np.stack([expose(H, t, scene.full) for t in scene.t])


def boost_photographs(k: int, scene: Scene) -> tuple[F32, F32]:
    """Return g_k(L_q) of all photographs (P, h, w, C), and the price of each of their pixels (P, h, w).

    The price is the squared noise that a photograph has in exposure k: of two similar patches, the
    cleaner one is preferred. The price is infinite for a pixel that a longer exposure clips, as its
    value in exposure k is unknown.
    """
    ratios = scene.t[k] / scene.t
    g = np.stack([boost(v, ratio) for v, ratio in zip(scene.L, ratios, strict=True)])
    noise = np.stack([boost(n, ratio) for n, ratio in zip(scene.noise, ratios, strict=True)])
    noise = np.where(g < 1, noise, 0)
    unknown = scene.clipped.any(axis=-1) & (scene.t > scene.t[k])[:, None, None]
    return g, np.where(unknown, np.float32(np.inf), NOISE_PRICE * (noise**2).sum(axis=-1))


def weigh_patches(k: int, scene: Scene, price: F32, side: int) -> F32:
    """Return w (P, h', w'), the weight with which each photograph's patches must appear in I_k.

    It is their mean exposedness, and 0 for patches with an infinite price. Only neighbouring
    exposures count: a much longer or shorter one has little in common with exposure k.
    """
    is_near = np.abs(np.arange(len(scene.L)) - k) <= 1
    exposedness = triangle(scene.L).min(axis=-1, keepdims=True) * is_near[:, None, None, None]
    is_barred = np.isinf(cut_patches(price[..., None], side)).any(axis=-1)
    weight = cut_patches(exposedness, side).mean(axis=-1)
    return np.where(is_barred, 0, weight).astype(np.float32)


def resize_scene(scene: Scene, shape: tuple[int, int]) -> Scene:
    """Return the scene at another size; a pixel is clipped if one of its original pixels is."""
    return dataclasses.replace(
        scene,
        L=np.stack([resize_picture(v, shape) for v in scene.L]),
        noise=np.stack([resize_picture(noise, shape) for noise in scene.noise]),
        clipped=np.stack([resize_picture(mask, shape) > 1e-3 for mask in scene.clipped]),
        alpha=resize_picture(scene.alpha, shape),
    )
