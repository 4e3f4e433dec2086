"""Alignment of a bracket pair by pair: every answer is validated, and the best of the methods is chosen.

e  error  mean over the pairs of neighbours in brightness of the mean square of d, see `align.light`, over the
          pixels that a pair shows after each of the methods alike, so that none gains by what it leaves out

Of all methods "auto" takes the simplest whose error is within a twentieth of the least. So by this measure
the choice is never worse than leaving the photographs where they are: that is the simplest of all.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hdrlab.align import cerman, homography, light, mtb
from hdrlab.core import warp
from hdrlab.core.arrays import as_stack, as_table, as_times, levels
from hdrlab.core.colour import decode_srgb
from hdrlab.core.steps import last
from hdrlab.core.transfer import brightness_transfer, histograms
from hdrlab.core.types import F32, F64, Array
from hdrlab.diagnostics import registration as judgement
from hdrlab.diagnostics.registration import Validation
from hdrlab.fast.mtb import Photograph
from hdrlab.pipeline import catalogue

METHODS = ("auto", *catalogue.names("align"))
SEARCHES: dict[str, Callable[[list[F32]], Iterator[Any]]] = {
    "cerman": cerman.search,
    "homography": homography.search,
}
# the simplest first
CHOICES = ("none", "mtb", "cerman", "homography")
# of the least error
SLACK = 0.05
# percentiles that are tried where the search by the median fails
OTHERS = (0.83, 0.17)
# confidence of what is taken from them
CERTAIN = 0.9


class Registration(NamedTuple):
    """The homographies (P, 3, 3) of a bracket, the Validation of each pair, and the errors of the choices."""

    homographies: F64
    pairs: tuple[Validation, ...]
    method: str
    errors: dict[str, float]


def register(
    images: ArrayLike, method: str = "auto", *, times: ArrayLike | None = None, g: ArrayLike | None = None
) -> Registration:
    """Return the Registration of photographs by a method of METHODS.

    A pair's homography counts only where the photographs then agree clearly better than without.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
        Photographs of one scene with different exposures, in any order.
    method : str
        "mtb", "cerman", "homography", or "auto", which takes whichever lays them on each other best.
    times : (P,) seconds, optional
        Their exposures. Without them the ratios come out of the histograms.
    g : (n,) or (n, 3), optional
        The camera's response, ln exposure of each level. Without it the histograms of each pair are matched.

    Raises
    ------
    ValueError
        For images that are not a stack of photographs, and for times or a response that do not fit them.

    Examples
    --------
    >>> from hdrlab import scenes
    >>> from hdrlab.capture import camera, responses
    >>> taken = camera.shoot(scenes.room((120, 180)), [0.02, 0.08], offsets=[[3, -4], [0, 0]])
    >>> found = register(taken.images, times=taken.times, g=responses.true_g())
    >>> found.method, found.homographies[0, :2, 2].tolist()  # dx, dy
    ('mtb', [-4.0, 3.0])
    """
    images, errors = as_stack(images), dict[str, float]()
    if method not in METHODS:
        raise ValueError(f"expected a method of align out of {', '.join(METHODS)}, got {method!r}")
    if method == "mtb":
        pairs = tuple(register_by_bits(images))
    elif method == "auto":
        method, pairs, errors = choose(images, times, g)
    else:
        each = light_pairs(images, times, g)
        pairs = tuple(_validated(*one, method) for one in each)
    steps = [one.H if one.informative else None for one in pairs]
    return Registration(warp.chain_homographies(mtb.by_brightness(images), steps), pairs, method, errors)


def register_by_bits(images: Array, *, bits: int = 6) -> Iterator[Validation]:
    """Yield the Validation of pair after pair from dark to bright, by median threshold bitmaps."""
    order = mtb.by_brightness(images)
    taken = ((image, Photograph(images[image], bits=bits)) for image in order)
    for (moving, B), (fixed, A) in pairwise(taken):  # two at a time in memory
        yield best_percentile(moving, B, fixed, A)


def best_percentile(moving: int, B: Photograph, fixed: int, A: Photograph) -> Validation:
    """Return the Validation at the median; where that fails, at Ward's other percentiles, if one is certain.

    Its answer must lie elsewhere: photographs that turned fit nearby, too.
    """

    def attempt(near: float) -> Validation:
        q = mtb.percentile(A.h[0], B.h[0], near=near)
        if q is None:
            return judgement.uninformative(moving, fixed)

        def count(offset: tuple[int, int], every: int) -> Array:
            return B.count_differences(A, offset, every, q)

        both = judgement.compare_bits(moving, fixed, A.Y[0], A.threshold(q), count)
        H = warp.as_homographies([B.offset_onto(A, q)])[0]
        return judgement.validate(both, H, limit=2 ** len(A.Y) - 1)

    first = attempt(0.5)
    for one in (attempt(q) for q in OTHERS if not first.reliable):
        apart = np.max(np.abs(np.subtract(one.offset, first.offset))) > judgement.NEAR
        if one.reliable and one.confidence > CERTAIN and apart:
            return one
    return first


def light_pairs(
    images: Array, times: ArrayLike | None, g: ArrayLike | None
) -> Iterator[tuple[int, int, list[F32]]]:
    """Yield (moving, fixed, pyramid of their light) from dark to bright, with one pyramid in memory.

    Without a response the darker photograph is brought to the brighter one by histograms alone, both are read
    by the curve of sRGB, and each pixel is divided by the mean around it: what is wrong with that is wrong in
    both alike, and cancels.
    """
    n, Z = levels(images), images if images.ndim == 3 else images[..., 1]
    seconds = None if times is None else as_times(times, len(images))
    f_inv = decode_srgb(np.arange(n) / (n - 1))
    if g is not None:
        f_inv = np.exp(as_table(g, n).reshape(n, -1)[:, :2][:, -1])  # the only one, or green
    for moving, fixed in pairwise(mtb.by_brightness(images)):
        if g is None:
            T = brightness_transfer(*histograms(Z[[moving, fixed]])[0])
            T[0], T[-1] = 0, n - 1
            z, known = np.arange(n), np.flatnonzero(np.isfinite(T))
            matched = np.interp(np.interp(z, known, T[known]), z, f_inv)
            pyramid = light.pair(Z[fixed], Z[moving], f_inv, matched)
            yield moving, fixed, [np.stack([x / light.local_mean(x) for x in X]) for X in pyramid]
            continue
        if seconds is None:
            k = light.exposure_ratio(Z[moving], Z[fixed], np.log(f_inv))
        else:
            k = seconds[fixed] / seconds[moving]
        yield moving, fixed, light.pair(Z[fixed], Z[moving], f_inv, k * f_inv)


def _validated(moving: int, fixed: int, pyramid: list[F32], method: str) -> Validation:
    """Return the Validation of what a method finds for a pair."""
    pair = judgement.compare_light(moving, fixed, pyramid[0])
    return judgement.validate(pair, last(SEARCHES[method](pyramid)).H)


def choose(
    images: Array, times: ArrayLike | None, g: ArrayLike | None
) -> tuple[str, tuple[Validation, ...], dict[str, float]]:
    """Return the simplest method whose error is within SLACK of the least, its pairs, and the errors of all.

    A homography is tried only where there is a reason not to trust a pair of what is chosen without.
    """
    images = as_stack(images)
    shifts = [one.H for one in register_by_bits(images)]
    name, pairs, errors = _choose_among(CHOICES[:3], images, times, g, shifts)
    if all(one.reliable for one in pairs):
        return name, pairs, errors
    return _choose_among(CHOICES, images, times, g, shifts)


def _choose_among(
    names: Sequence[str], images: Array, times: ArrayLike | None, g: ArrayLike | None, shifts: Sequence[F64]
) -> tuple[str, tuple[Validation, ...], dict[str, float]]:
    found: dict[str, list[Validation]] = {name: [] for name in names}
    errors = []
    for (moving, fixed, pyramid), by_bits in zip(light_pairs(images, times, g), shifts, strict=True):
        pair = judgement.compare_light(moving, fixed, pyramid[0])
        answers = {"none": np.eye(3), "mtb": by_bits}
        answers |= {name: last(SEARCHES[name](pyramid)).H for name in names if name in SEARCHES}
        for name, H in answers.items():
            found[name].append(judgement.validate(pair, H))
        d = np.array([pair.differences(found[name][-1].H) for name in names])
        alike = np.isfinite(d).all(axis=0)
        errors.append([light.error(np.where(alike, one, np.nan)) for one in d])
    e = dict(zip(names, np.mean(errors, axis=0).tolist() if errors else [0.0] * len(names), strict=True))
    name = simplest(e)
    return name, tuple(found[name]), e


def simplest(e: dict[str, float]) -> str:
    """Return the simplest method whose error is within SLACK of the least.

    Examples
    --------
    >>> simplest({"none": 0.2, "mtb": 0.101, "cerman": 0.1})
    'mtb'
    """
    least = min(e.values())
    return next(name for name in CHOICES if name in e and e[name] <= (1 + SLACK) * least)
