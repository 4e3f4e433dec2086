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
from typing import Any, NamedTuple

import numpy as np

from hdrlab.beyond import ldr_values, patchmatch, synthesis
from hdrlab.beyond.bidirectional import Search, search, similarity, vote
from hdrlab.core import bracket, steps
from hdrlab.core.arrays import F32, F64, Array, ArrayLike, Indices
from hdrlab.errors import InputError

# where the search of both ways begins
Fields = tuple[Indices, tuple[Indices, ...]]

# of the sides of a scale to those of the next coarser one
SCALE_RATIO = 2**0.5
# levels, 1 the top, between which the reference begins to be trusted, and ceases to be
TRUSTED_LEVELS: tuple[synthesis.Ramp, synthesis.Ramp] = ((0.05, 0.2), (0.85, 0.95))


class State(NamedTuple):
    """Where the synthesis stands after a round of a scale.

    Attributes
    ----------
    scale, round : from 0, the coarsest scale and what is before its first round
    H : (h, w, C), radiance
    I : (P, h, w, C), what each exposure makes of it, in values
    mbds : (P,), by how much the exposures were unlike the photographs in this round; NaN before the
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
    found = []
    unlike = []
    for k, (T, at) in enumerate(zip(state.I, fields, strict=True)):
        S, price = synthesis.boost_photographs(k, scene)
        w = synthesis.weigh_patches(k, scene, price, settings.side)
        both = search(T, S, price, at, settings, rng)
        pictures.append(vote(S, w, both, settings.side))
        found.append((both.coherence.at, tuple(field.at for field in both.completeness)))
        unlike.append(similarity(w, both))
    H = synthesis.blend_reference(synthesis.merge_exposures(np.stack(pictures), scene), scene)
    I_k = synthesis.extract_exposures(H, scene)
    return State(state.scale, state.round + 1, H, I_k, np.array(unlike)), found


def plan_scales(shape: tuple[int, ...], coarsest: int) -> list[tuple[int, int]]:
    """Return the sides of every scale, coarse to fine; the shorter is about `coarsest` pixels at first."""
    count = max(0, round(np.log(min(shape) / coarsest) / np.log(SCALE_RATIO)))
    ratios = [SCALE_RATIO**j for j in range(count, -1, -1)]
    return [(round(shape[0] / ratio), round(shape[1] / ratio)) for ratio in ratios]


def as_scene(
    images: ArrayLike, times: ArrayLike, g: ArrayLike, reference: int | None
) -> synthesis.Scene:
    """Return the Scene of photographs in any order, checked."""
    each = ldr_values.as_values(images, times, g)
    order = bracket.short_to_long(np.asarray(images), each.t)
    place = len(order) // 2
    if reference is not None:
        if not 0 <= reference < len(order):
            raise InputError(f"expected a reference from 0 to {len(order) - 1}, got {reference}")
        place = int(np.flatnonzero(order == reference)[0])
    alpha = synthesis.trapezoid(each.z[order[place]], *TRUSTED_LEVELS)
    v = each.v[order]
    noise = each.noise[order]
    clipped = each.clipped[order]
    t = each.t[order]
    return synthesis.Scene(v, noise, clipped, t, each.full, place, alpha)


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
    generator = np.random.default_rng(rng)
    state = None
    fields = None
    for scale, (shape, count) in enumerate(
        zip(sizes, plan_rounds(rounds, len(sizes)), strict=True)
    ):
        scene = synthesis.resize_scene(finest, shape)
        H = ldr_values.resize_picture(
            synthesis.guess_radiance(finest) if state is None else state.H, shape
        )
        H = H if state is None else synthesis.blend_reference(H, scene)
        state = State(
            scale, 0, H, synthesis.extract_exposures(H, scene), np.full(len(scene.t), np.nan)
        )
        yield state
        fields = start_fields(shape, len(scene.t), side) if fields is None else fields
        settings = Search(side, 2, max(shape) if scale == 0 else 4)
        for _ in range(count):
            state, fields = improve(state, scene, fields, settings, generator)
            yield state


def synthesise(images: ArrayLike, times: ArrayLike, g: ArrayLike, **knobs: Any) -> Array:
    """Return the radiance of the moment at which one of the photographs was taken.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs in any order, roughly aligned; what moves may be anywhere. Small ones: see
        above.
    times : (P,) float
        Exposure times in seconds.
    g : (n,) or (n, 3) float
        Response, ln exposure of each level.
    reference : int, optional
        Which photograph's moment it is; the middle exposure's by default.
    side : int
        Of a patch, pixels, odd.
    coarsest : int
        Shorter side of the coarsest scale, pixels.
    rounds : (int, int)
        Of search and vote at the coarsest scale and at the finest; those between lie between.
    rng : int or Generator
        Where PatchMatch looks by chance.

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
    H = steps.last(synthesise_steps(images, times, g, **knobs)).H
    return H[..., 0] if np.ndim(images) == 3 else H


def plan_rounds(rounds: tuple[int, int], count: int) -> list[int]:
    """Return how many rounds each of `count` scales has: as many less from scale to scale."""
    if not min(rounds) >= 0:
        raise InputError(
            f"expected numbers of rounds at the coarsest and the finest scale, got {rounds}"
        )
    return np.rint(np.linspace(*rounds, count)).astype(int).tolist()


def start_fields(shape: tuple[int, int], count: int, side: int) -> list[Fields]:
    """Return where each search begins: where the patch stands, in the photograph of the same exposure."""
    h, w = (n - side + 1 for n in shape)
    return [
        (patchmatch.identity_field(h, w, k), (patchmatch.identity_field(h, w),) * count)
        for k in range(count)
    ]
