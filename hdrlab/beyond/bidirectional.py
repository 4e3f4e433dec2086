"""Bidirectional similarity of a picture to several others (Simakov et al., CVPR 2008; Sen et al. 2012).

T      target       (H, W, C) float32: the picture that is to become like the sources
S      sources      (N, H, W, C)
w      weights      (N, h, w), how much each patch of the sources has to be found again in T
P, Q   patches of the sources and of the target

    MBDS(T | S) = 1/N sum over P of  w(P) min_Q ||P - Q||^2 / |S|   +   sum over Q of  min_P ||Q - P||^2 / |T|

The first sum, completeness, is small where nothing of the sources is missing in T; the second,
coherence, where T has nothing that the sources have not.
"""

from typing import NamedTuple

import numpy as np

from hdrlab.beyond import patchmatch
from hdrlab.beyond.patchmatch import Field, Sources
from hdrlab.core.arrays import F32, Indices
from hdrlab.core.steps import last


class Matches(NamedTuple):
    """Both ways: of each patch of T in S, and of each patch of each S in T."""

    coherence: Field
    completeness: tuple[Field, ...]


class Search(NamedTuple):
    """How long to look: side of a patch, rounds, and how far chance reaches at first, pixels."""

    side: int
    rounds: int
    radius: int


def similarity(w: F32, matches: Matches) -> float:
    """Return MBDS(T | S) [Sen12 sec. 3]."""
    pairs = zip(w, matches.completeness, strict=True)
    completeness = sum(float((weight * field.d).mean()) for weight, field in pairs)
    return completeness / len(w) + float(matches.coherence.d.mean())


def search(
    T: F32,
    S: F32,
    price: F32,
    at: tuple[Indices, tuple[Indices, ...]],
    settings: Search,
    rng: np.random.Generator,
) -> Matches:
    """Return the matches of both ways, looked for from where they begin."""
    P = patchmatch.cut_patches(T, settings.side)
    Q = patchmatch.make_sources(S, settings.side, price)
    back = patchmatch.make_sources(T[None], settings.side)
    rows = Q.rows.reshape(*Q.shape, -1)
    coherence = search_one_way(P, Q, at[0], settings, rng)
    completeness = [
        search_one_way(rows[q], back, start, settings, rng) for q, start in enumerate(at[1])
    ]
    return Matches(coherence, tuple(completeness))


def search_one_way(
    P: F32, Q: Sources, at: Indices, settings: Search, rng: np.random.Generator
) -> Field:
    """Return the field after some rounds of PatchMatch from `at`, of this scale or of a coarser one."""
    height, width = P.shape[:2]
    if at.shape[:2] != (height, width):
        at = patchmatch.upscale_field(at, (height, width))
    first = patchmatch.start_field(P, Q, at)
    steps = patchmatch.search_steps(P, Q, first, radius=settings.radius, rng=rng)
    return last(field for _, field in zip(range(settings.rounds), steps, strict=False))


def vote(S: F32, w: F32, matches: Matches, side: int) -> F32:
    """Return the T that is best for these matches: the mean of all that they say [Simakov08 eq. 4].

    Every patch of T brings the pixels of its match; every patch of S its own pixels to its match,
    with the weight w / N.

    Examples
    --------
    Of a picture that is the source moved by a pixel, all is found in the source:

    >>> S = np.random.default_rng(0).random((1, 12, 14, 1), np.float32)
    >>> T, at, free = S[0, :, 1:-1], patchmatch.identity_field(10, 10), np.zeros((1, 12, 12), np.float32)
    >>> both = search(T, S[:, :, 2:], free, (at, (at,)), Search(3, 9, 4), np.random.default_rng(0))
    >>> bool(both.coherence.d[:, 1:].max() == 0)
    True
    """
    shape = S.shape[1:3]
    total, count = patchmatch.sum_votes(S, matches.coherence.at, shape, side)
    for picture, weight, field in zip(S, w / len(S), matches.completeness, strict=True):
        if weight.any():
            sums, votes = patchmatch.sum_given_votes(picture, field.at, weight, shape, side)
            total = total + sums
            count = count + votes
    return total / count[..., None]
