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

from typing import NamedTuple

import numpy as np

from hdrlab.beyond.ldr_values import boost, consistent_range, expose, radiance, resize_picture
from hdrlab.beyond.patchmatch import cut_patches
from hdrlab.core.arrays import F32, F64, Mask

Ramp = tuple[float, float]

# of noise: a noisy picture of a patch is as far from a clean one as its own noise is large
NOISE_PRICE = 2.0
# weight of a value near black or clipping: where no photograph measures, it still decides
LEAST_WEIGHT = 1e-4


class Scene(NamedTuple):
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
    """Return Lambda(I_k), the triangle; but 1 in the shortest's highlights and the longest's shadows.

    No other photograph measures more there.
    """
    w = triangle(I)
    w[0], w[-1] = np.where(I[0] > 0.5, 1, w[0]), np.where(I[-1] < 0.5, 1, w[-1])
    return np.maximum(w, LEAST_WEIGHT)


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
    within = np.clip(H, *consistent_range(v, scene.noise[k], scene.clipped[k], t, scene.full))
    return scene.alpha * radiance(v, t, scene.full) + (1 - scene.alpha) * within


def guess_radiance(scene: Scene) -> F32:
    """Return what to begin with: h(L_ref), or where it is clipped what a shorter exposure has, if more.

    The paper begins with the reference alone. But a flat, clipped region is like any other flat
    thing, and would be filled with the nearest wall; so nothing is searched where staying put
    explains the photographs.
    """
    k = scene.reference
    H = [radiance(v, t, scene.full) for v, t in zip(scene.L[: k + 1], scene.t, strict=False)]
    return np.where(scene.clipped[k], np.max(H, axis=0), H[k])


def extract_exposures(H: F32, scene: Scene) -> F32:
    """Return I_k = l_k(H) of every exposure."""
    return np.stack([expose(H, t, scene.full) for t in scene.t])


def boost_photographs(k: int, scene: Scene) -> tuple[F32, F32]:
    """Return g_k(L_q) of all photographs (P, h, w, C), and the price of each of their pixels (P, h, w).

    The price is the squared noise that a photograph has in exposure k: of two patches that look
    alike the cleaner one is taken. A pixel that a longer exposure clips has no price: how full it
    would be in exposure k is unknown.
    """
    ratios = scene.t[k] / scene.t
    g = np.stack([boost(v, ratio) for v, ratio in zip(scene.L, ratios, strict=True)])
    noise = np.stack([boost(one, ratio) for one, ratio in zip(scene.noise, ratios, strict=True)])
    noise = np.where(g < 1, noise, 0)
    unknown = scene.clipped.any(axis=-1) & (scene.t > scene.t[k])[:, None, None]
    return g, np.where(unknown, np.float32(np.inf), NOISE_PRICE * (noise**2).sum(axis=-1))


def weigh_patches(k: int, scene: Scene, price: F32, side: int) -> F32:
    """Return w (P, h', w'): how much the patches of each photograph have to be found again in I_k.

    As much as they are well exposed, where they are usable; and only those of the neighbouring
    exposures, for one that is much longer or shorter has little to say about exposure k.
    """
    near = np.abs(np.arange(len(scene.L)) - k) <= 1
    well = triangle(scene.L).min(axis=-1, keepdims=True) * near[:, None, None, None]
    barred = np.isinf(cut_patches(price[..., None], side)).any(axis=-1)
    return np.where(barred, 0, cut_patches(well, side).mean(axis=-1)).astype(np.float32)


def resize_scene(scene: Scene, shape: tuple[int, int]) -> Scene:
    """Return the scene at another size; a pixel is clipped where one of those that it stands for is."""
    L, noise = (
        np.stack([resize_picture(v, shape) for v in all_]) for all_ in (scene.L, scene.noise)
    )
    clipped = np.stack([resize_picture(one, shape) > 1e-3 for one in scene.clipped])
    return scene._replace(
        L=L, noise=noise, clipped=clipped, alpha=resize_picture(scene.alpha, shape)
    )
