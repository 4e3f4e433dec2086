"""PatchMatch: find a similar patch in other pictures for each patch (Barnes et al., SIGGRAPH 2009).

T      target            (H, W, C) float32
S      sources           (N, H, W, C) float32, of one size
side   of a patch, pixels, odd;  h = H - side + 1 patches stand below each other, w likewise
P, Q   patches           rows of side^2 C numbers, of each place (y, x) of its upper left corner
at     the field         (h, w, 3) int: which source, y and x: where the patch like that at (y, x) is
d      distance          (h, w), ||P - Q||^2 + the price of Q, which is inf where a patch is barred

A random field has a few good matches by chance. Good matches propagate: the neighbour of a patch is
probably similar to the neighbour of its match. The paper processes the picture pixel by pixel; here
all pixels try the match of the same neighbour at once, in numpy.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from hdrlab.core.arrays import F32, Indices

NEIGHBOURS = ((0, 1), (1, 0), (0, -1), (-1, 0))
# places, beyond any picture's
UNBOUNDED = (1 << 30, 1 << 30)
# patches at a time, which stay in the processor's cache
PATCHES_PER_CHUNK = 2048


class Field(NamedTuple):
    """Where the match of each patch is, `at` (h, w, 3), and how far from it, `d` (h, w)."""

    at: Indices
    d: F32


class Sources(NamedTuple):
    """Patches to choose among: `rows` (N h w, side^2 C), their `price` (N h w), and (N, h, w)."""

    rows: F32
    price: F32
    shape: tuple[int, int, int]


def cut_patches(picture: F32, side: int) -> F32:
    """Return the patches of a picture (H, W, C) or of several, (..., h, w, side^2 C).

    Examples
    --------
    >>> cut_patches(np.arange(12, dtype=np.float32).reshape(3, 4, 1), 3)[0, 1].tolist()
    [1.0, 2.0, 3.0, 5.0, 6.0, 7.0, 9.0, 10.0, 11.0]
    """
    windows = sliding_window_view(picture, (side, side), axis=(-3, -2))
    return np.ascontiguousarray(windows.reshape(*windows.shape[:-3], -1))


def make_sources(S: F32, side: int, price: F32 | None = None) -> Sources:
    """Return the patches of S; the price of each is the sum of its pixels' prices (N, H, W), 0 by default."""
    rows = cut_patches(S, side)
    price = np.zeros(S.shape[:-1], np.float32) if price is None else price
    patch_prices = cut_patches(price[..., None], side).sum(axis=-1)
    return Sources(rows.reshape(-1, rows.shape[-1]), patch_prices.ravel(), rows.shape[:3])


def distance(P: F32, Q: Sources, at: Indices) -> F32:
    """Return d = ||P - Q(at)||^2 + price of Q(at), (h, w)."""
    _, h, w = Q.shape
    index = ((at[..., 0] * h + at[..., 1]) * w + at[..., 2]).ravel()
    rows = P.reshape(-1, P.shape[-1])
    d = np.empty(index.size, np.float32)
    for start in range(0, index.size, PATCHES_PER_CHUNK):
        part = slice(start, start + PATCHES_PER_CHUNK)
        difference = rows[part] - Q.rows[index[part]]
        d[part] = np.einsum("ij,ij->i", difference, difference)
    return (d + Q.price[index]).reshape(at.shape[:2])


def start_field(P: F32, Q: Sources, at: Indices) -> Field:
    """Return the Field that begins with these places."""
    at = clip_places(at, Q.shape)
    return Field(at, distance(P, Q, at))


def clip_places(at: Indices, shape: tuple[int, int, int]) -> Indices:
    """Return places clipped to the sources."""
    return np.clip(at, 0, np.array(shape) - 1)


def keep_nearer(field: Field, P: F32, Q: Sources, at: Indices) -> Field:
    """Return the field with these places instead, where they are nearer."""
    at = clip_places(at, Q.shape)
    d = distance(P, Q, at)
    nearer = d < field.d
    return Field(np.where(nearer[..., None], at, field.at), np.where(nearer, d, field.d))


def propagate(at: Indices, step: tuple[int, int]) -> Indices:
    """Return at(p - step) + step: the places beside the neighbours' matches [Barnes09 sec. 3.2, propagation].

    At the edge, where there is no neighbour, it is the nearest one's.
    """
    h, w = at.shape[:2]
    y = np.clip(np.arange(h) - step[0], 0, h - 1)
    x = np.clip(np.arange(w) - step[1], 0, w - 1)
    return at[np.ix_(y, x)] + np.array([0, *step])


def random_places(at: Indices, radius: int, count: int, rng: np.random.Generator) -> Indices:
    """Return places at random within `radius` of the field's, in any source [Barnes09 sec. 3.2, search]."""
    moves = rng.integers(-radius, radius, (*at.shape[:2], 2), endpoint=True)
    source = at[..., :1] if count == 1 else rng.integers(0, count, (*at.shape[:2], 1))
    return np.concatenate([source, at[..., 1:] + moves], axis=-1).astype(np.intp)


def search_steps(
    P: F32, Q: Sources, field: Field, *, radius: int, rng: np.random.Generator
) -> Iterator[Field]:
    """Yield the field after each round: propagation, then random search from `radius` down to 1."""
    while True:
        for step in NEIGHBOURS:
            field = keep_nearer(field, P, Q, propagate(field.at, step))
        for source in range(1, Q.shape[0]):  # the same place in another picture
            field = keep_nearer(field, P, Q, (field.at + (source, 0, 0)) % (Q.shape[0], *UNBOUNDED))
        current_radius = radius
        while current_radius:
            places = random_places(field.at, current_radius, Q.shape[0], rng)
            field = keep_nearer(field, P, Q, places)
            current_radius //= 2
        yield field


def identity_field(h: int, w: int, source: int = 0) -> Indices:
    """Return the field that looks for each patch where it stands, in one source."""
    y, x = np.indices((h, w))
    return np.stack([np.full((h, w), source), y, x], axis=-1)


def upscale_field(at: Indices, shape: tuple[int, int]) -> Indices:
    """Return a field for (h, w) patches of a finer scale, from that of a coarser one."""
    ratios = np.divide(shape, at.shape[:2])
    own = [(np.arange(n) / r).astype(int) for n, r in zip(shape, ratios, strict=True)]
    coarse = np.stack([np.zeros(shape, int), *np.meshgrid(*own, indexing="ij")], axis=-1)
    # number of the source, and displacement in pixels of the coarser scale
    shift = at[np.ix_(*own)] - coarse
    return identity_field(*shape) + np.rint(shift * np.array([1, *ratios])).astype(int)


def sum_votes(S: F32, at: Indices, shape: tuple[int, int], side: int) -> tuple[F32, F32]:
    """Return the sums (H, W, C) of the votes of the matches in S for each pixel, and their number (H, W).

    Each patch of the target has a match, whose pixels vote for the pixels of the patch. So a pixel
    has side^2 votes, and fewer near the edge.
    """
    h, w = at.shape[:2]
    total = np.zeros((*shape, S.shape[-1]), np.float32)
    count = np.zeros(shape, np.float32)
    for dy in range(side):
        for dx in range(side):
            total[dy : dy + h, dx : dx + w] += S[at[..., 0], at[..., 1] + dy, at[..., 2] + dx]
            count[dy : dy + h, dx : dx + w] += 1
    return total, count


def sum_given_votes(
    S: F32, at: Indices, weight: F32, shape: tuple[int, int], side: int
) -> tuple[F32, F32]:
    """Return the same sums of the votes that patches of one source S (H, W, C) give to their matches.

    `at` is the field from the source to the target, and `weight` (h, w) the weight of each patch.
    """
    h, w = weight.shape
    sums = np.zeros((S.shape[-1] + 1, shape[0] * shape[1]))
    for dy in range(side):
        for dx in range(side):
            pixel = ((at[..., 1] + dy) * shape[1] + at[..., 2] + dx).ravel()
            planes = [*np.moveaxis(S[dy : dy + h, dx : dx + w], -1, 0), np.ones((h, w))]
            for c, plane in enumerate(planes):
                sums[c] += np.bincount(pixel, (weight * plane).ravel(), sums.shape[1])
    total = sums.reshape(-1, *shape).astype(np.float32)
    return np.moveaxis(total[:-1], 0, -1), total[-1]
