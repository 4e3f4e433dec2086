"""Patch-based HDR: photographs of a moving scene, as one of them saw it (Sen et al., SIGGRAPH Asia 2012).

Z_k    photograph k        (P, H, W[, 3]) levels;  t  (P,) times, s;  g  (n[, 3]) ln exposure of each level
L_k    the same in values  (H, W, C), see `ldr_values`: patches differ in values about as they look
h      value -> radiance;  l_k  radiance -> value that exposure k makes of it
g_k    l_k(h(L_q))         photograph q as exposure k would have had it
alpha  (H, W, 1), 0 to 1   how well the reference is exposed
H      radiance            (H, W, C), what is wanted
I_k    (P, H, W, C)        photographs that never were: the reference's moment in every exposure

    E(H) = sum of  alpha (h(L_ref) - H)^2 + (1 - alpha) MBDS(H | L_1, ..., L_P)        [Sen12 sec. 3]

Where the reference is well exposed, H is the reference. Elsewhere H should look, in every exposure,
as if it were made of patches of the photographs, and leave none of theirs out: `bidirectional` has
that measure.

It takes long: time and memory go with pixels x side^2 x P, the time with P once more. Three
photographs of 96 x 144 pixels take two to three seconds and some 30 MB, so a megapixel would take
minutes and more than two gigabytes: this is for small pictures, to see how it works.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from hdrlab.beyond import ldr_values, patchmatch, synthesis
from hdrlab.beyond.bidirectional import Search, search, similarity, vote
from hdrlab.core import bracket, steps
from hdrlab.core.arrays import F32, F64, Array, ArrayLike, Indices
from hdrlab.errors import InputError

# the initial fields of the search in both directions
Fields = tuple[Indices, tuple[Indices, ...]]

# sides of a scale over those of the next coarser one
SCALE_RATIO = 2**0.5
# levels, 1 is the top: the weight of the reference rises over the first range, and falls over the
# second
TRUSTED_LEVELS: tuple[synthesis.Ramp, synthesis.Ramp] = ((0.05, 0.2), (0.85, 0.95))


class State(NamedTuple):
    """The synthesis after a round of a scale.

    Attributes
    ----------
    scale, round : from 0, the coarsest scale and the state before its first round
    H : (h, w, C), radiance
    I : (P, h, w, C), the values of H in each exposure
    mbds : (P,), dissimilarity of the exposures and the photographs in this round; NaN before the
        first
    """

    scale: int
    round: int
    H: F32
    I: F32  # noqa: E741  the paper's letter
    mbds: F64


def improve(
    state: State,
    scene: synthesis.Scene,
    fields: list[Fields],
    settings: Search,
    rng: np.random.Generator,
) -> tuple[State, list[Fields]]:
    """Return the next state: search and vote in every exposure, merge, blend, extract [Sen12 algorithm 1]."""
    pictures = []
    next_fields = []
    mbds = []
    for k, (T, at) in enumerate(zip(state.I, fields, strict=True)):
        S, price = synthesis.boost_photographs(k, scene)
        w = synthesis.weigh_patches(k, scene, price, settings.side)
        matches = search(T, S, price, at, settings, rng)
        pictures.append(vote(S, w, matches, settings.side))
        completeness = tuple(field.at for field in matches.completeness)
        next_fields.append((matches.coherence.at, completeness))
        mbds.append(similarity(w, matches))
    merged = synthesis.merge_exposures(np.stack(pictures), scene)
    H = synthesis.blend_reference(merged, scene)
    I_k = synthesis.extract_exposures(H, scene)
    return State(state.scale, state.round + 1, H, I_k, np.array(mbds)), next_fields


def plan_scales(shape: tuple[int, ...], coarsest: int) -> list[tuple[int, int]]:
    """Return the sides of every scale, coarse to fine; the shorter is about `coarsest` pixels at first."""
    count = max(0, round(np.log(min(shape) / coarsest) / np.log(SCALE_RATIO)))
    ratios = [SCALE_RATIO**j for j in range(count, -1, -1)]
    return [(round(shape[0] / ratio), round(shape[1] / ratio)) for ratio in ratios]


def as_scene(
    images: ArrayLike, times: ArrayLike, g: ArrayLike, reference: int | None
) -> synthesis.Scene:
    """Return the checked Scene of photographs in any order."""
    values = ldr_values.as_values(images, times, g)
    order = bracket.short_to_long(np.asarray(images), values.t)
    place = len(order) // 2
    if reference is not None:
        if not 0 <= reference < len(order):
            raise InputError(f"expected a reference from 0 to {len(order) - 1}, got {reference}")
        place = int(np.flatnonzero(order == reference)[0])
    rising, falling = TRUSTED_LEVELS
    return synthesis.Scene(
        L=values.v[order],
        noise=values.noise[order],
        clipped=values.clipped[order],
        t=values.t[order],
        full=values.full,
        reference=place,
        alpha=synthesis.trapezoid(values.z[order[place]], rising, falling),
    )


def synthesise_steps(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    *,
    reference: int | None = None,
    side: int = 5,
    coarsest: int = 24,
    rounds: tuple[int, int] = (8, 2),
    rng: int | np.random.Generator = 0,
) -> Iterator[State]:
    """Yield the State of every scale before its first round and after each; parameters as of `synthesise`."""
    finest = as_scene(images, times, g, reference)
    sizes = plan_scales(finest.L.shape[1:3], coarsest)
    if side % 2 == 0 or not 3 <= side <= min(sizes[0]):
        raise InputError(f"expected an odd side from 3 to {min(sizes[0])} pixels, got {side}")
    round_counts = plan_rounds(rounds, len(sizes))
    generator = np.random.default_rng(rng)
    H = synthesis.guess_radiance(finest)
    fields = start_fields(sizes[0], len(finest.t), side)
    unknown = np.full(len(finest.t), np.nan)
    for scale, (shape, count) in enumerate(zip(sizes, round_counts, strict=True)):
        scene = synthesis.resize_scene(finest, shape)
        H = ldr_values.resize_picture(H, shape)
        if scale > 0:
            H = synthesis.blend_reference(H, scene)
        state = State(scale, 0, H, synthesis.extract_exposures(H, scene), unknown)
        yield state
        settings = Search(side, rounds=2, radius=max(shape) if scale == 0 else 4)
        for _ in range(count):
            state, fields = improve(state, scene, fields, settings, generator)
            yield state
        H = state.H


def synthesise(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    *,
    reference: int | None = None,
    side: int = 5,
    coarsest: int = 24,
    rounds: tuple[int, int] = (8, 2),
    rng: int | np.random.Generator = 0,
) -> Array:
    """Return the radiance of the moment at which one of the photographs was taken.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs in any order, roughly aligned; anything may move. Use small ones: see above.
    times : (P,) float
        Exposure times in seconds.
    g : (n,) or (n, 3) float
        Response, ln exposure of each level.
    reference : int, optional
        Number of the photograph whose moment is shown; by default that of the middle exposure.
    side : int
        Side of a patch in pixels, odd.
    coarsest : int
        Shorter side of the coarsest scale, pixels.
    rounds : (int, int)
        Rounds of search and vote at the coarsest and at the finest scale; interpolated between.
    rng : int or Generator
        Seed or generator of PatchMatch's random search.

    Returns
    -------
    H : (H, W) or (H, W, 3) float32
        In the unit of `radiance.merge`.

    Raises
    ------
    ValueError
        For arrays that do not fit together, a reference that is not there, and patches larger than
        the coarsest scale.

    References
    ----------
    Sen, Kalantari, Yaesoubi, Darabi, Goldman and Shechtman, Robust patch-based HDR reconstruction
    of dynamic scenes, SIGGRAPH Asia 2012. Barnes, Shechtman, Finkelstein and Goldman, PatchMatch: a
    randomized correspondence algorithm for structural image editing, SIGGRAPH 2009.

    Examples
    --------
    >>> t, g = np.array([1.0, 2.0, 4.0]), np.log(np.maximum(np.arange(256), 0.5) / 128)
    >>> images = np.array([np.full((16, 16), level, np.uint8) for level in (32, 64, 128)])
    >>> H = synthesise(images, t, g, coarsest=16)
    >>> bool(np.allclose(H, 32 / 128, rtol=1e-3))
    True
    """
    states = synthesise_steps(
        images,
        times,
        g,
        reference=reference,
        side=side,
        coarsest=coarsest,
        rounds=rounds,
        rng=rng,
    )
    H = steps.last(states).H
    return H[..., 0] if np.ndim(images) == 3 else H


def plan_rounds(rounds: tuple[int, int], count: int) -> list[int]:
    """Return the number of rounds of each of `count` scales, interpolated between both ends."""
    if not min(rounds) >= 0:
        raise InputError(
            f"expected numbers of rounds at the coarsest and the finest scale, got {rounds}"
        )
    first, last = rounds
    return np.rint(np.linspace(first, last, count)).astype(int).tolist()


def start_fields(shape: tuple[int, int], count: int, side: int) -> list[Fields]:
    """Return the initial fields: each patch itself, in the photograph of the same exposure."""
    h = shape[0] - side + 1
    w = shape[1] - side + 1
    fields = []
    for k in range(count):
        completeness = (patchmatch.identity_field(h, w),) * count
        fields.append((patchmatch.identity_field(h, w, k), completeness))
    return fields
