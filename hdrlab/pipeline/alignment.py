"""Alignment of a bracket pair by pair, where every answer is validated.

"mtb" shifts by whole pixels. "auto" does so, too, and looks once more at the pairs that no shift
lays on each other: with rotation, then with a homography, in an overview of half a megapixel. It
takes their answer where the light of the two photographs then agrees clearly better than after the
shift.
"""

from collections.abc import Callable, Iterator
from itertools import pairwise, starmap
from typing import Any, NamedTuple

import numpy as np

from hdrlab.align import cerman, homography, light, mtb
from hdrlab.core import colour, steps, transfer
from hdrlab.core.arrays import F32, F64, Array, ArrayLike, as_stack, as_table, as_times, levels
from hdrlab.core.filters import warp
from hdrlab.core.threads import map_in_threads
from hdrlab.diagnostics import registration as judgement
from hdrlab.errors import InputError
from hdrlab.fast.mtb import Photograph
from hdrlab.pipeline import catalogue

METHODS = ("auto", *catalogue.names("align"))
SEARCHES: dict[str, Callable[[list[F32]], Iterator[Any]]] = {
    "cerman": cerman.search,
    "homography": homography.search,
}
# levels of a pyramid: more than any picture has, so the range grows with the picture
BITS = 16
# percentiles that are tried where the search by the median fails
OTHERS = (0.83, 0.17)
# confidence of what is taken from them
CERTAIN = 0.9
Curve = ArrayLike | Callable[[], F64 | None] | None  # of one's own, or found where it is asked for
# from the numbers and the gray photographs of a darker and a brighter one to the pyramid of their
# light
AsLight = Callable[[int, int, Array, Array], list[F32]]


class Registration(NamedTuple):
    """The homographies (P, 3, 3) of a bracket, the Validation of each pair, and the method.

    Of "auto" it is the least simple that a pair took, and "none" where all photographs stay.
    """

    homographies: F64
    pairs: tuple[judgement.Validation, ...]
    method: str


def register(
    images: ArrayLike, method: str = "auto", *, times: ArrayLike | None = None, g: Curve = None
) -> Registration:
    """Return the Registration of photographs by a method of METHODS.

    A pair's homography counts only where the photographs then agree clearly better than without.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
        Photographs of one scene with different exposures, in any order.
    method : str
        "mtb", "cerman", "homography", or "auto": "mtb", and the others for pairs that no shift
        serves.
    times : (P,) seconds, optional
        Their exposures. Without them the ratios come out of the histograms.
    g : (n,) or (n, 3), optional
        The camera's response, ln exposure of each level, or a function that finds it where light is
        compared. Without it the histograms of each pair are matched.

    Raises
    ------
    ValueError
        For images that are not a stack of photographs, and for times or a response that do not fit
        them.

    Examples
    --------
    >>> from hdrlab import scenes
    >>> from hdrlab.capture import camera, responses
    >>> taken = camera.shoot(scenes.room((120, 180)), [0.02, 0.08], offsets=[[3, -4], [0, 0]])
    >>> found = register(taken.images, times=taken.times, g=responses.true_g())
    >>> found.method, found.homographies[0, :2, 2].tolist()  # dx, dy
    ('mtb', [-4.0, 3.0])
    """
    images = as_stack(images)
    if method not in METHODS:
        raise InputError(f"expected a method of align out of {', '.join(METHODS)}, got {method!r}")
    as_light, by_bits = (
        light_scale(images, times, g),
        starmap(best_percentile, photograph_pairs(images)),
    )
    pairs = tuple(register_by_light(images, as_light, method) if method in SEARCHES else by_bits)
    if method == "auto":
        names = ["mtb" if np.any(one.step != np.eye(3)) else "none" for one in pairs]
        if any(one.apart for one in pairs):  # a hand that rotates once does so in every pair
            each = zip(pairs, names, photograph_pairs(images), strict=True)
            found = [improve(one, name, B, A, as_light) for one, name, (_, B, _, A) in each]
            pairs, names = tuple(one for one, _ in found), [name for _, name in found]
        method = next((name for name in ("homography", "cerman", "mtb") if name in names), "none")
    order = [pairs[0].moving, *(one.fixed for one in pairs)] if pairs else [0]
    return Registration(warp.chain_homographies(order, [one.step for one in pairs]), pairs, method)


def photograph_pairs(
    images: Array, bits: int = BITS
) -> Iterator[tuple[int, Photograph, int, Photograph]]:
    """Yield the numbers and Photographs of neighbours from dark to bright, a few at a time in memory."""
    taken = map_in_threads(
        lambda image: (image, Photograph(images[image], bits=bits)), mtb.by_brightness(images)
    )
    yield from ((moving, B, fixed, A) for (moving, B), (fixed, A) in pairwise(taken))


def register_by_light(
    images: Array, as_light: AsLight, method: str
) -> Iterator[judgement.Validation]:
    """Yield the Validation of pair after pair from dark to bright, by one of SEARCHES at full resolution."""
    Z = images if images.ndim == 3 else images[..., 1]
    for moving, fixed in pairwise(mtb.by_brightness(images)):
        pyramid = as_light(moving, fixed, Z[moving], Z[fixed])
        pair = judgement.compare_light(moving, fixed, pyramid[0])
        yield judgement.validate(pair, steps.last(SEARCHES[method](pyramid)).H)


def improve(
    best: judgement.Validation, name: str, B: Photograph, A: Photograph, as_light: AsLight
) -> tuple[judgement.Validation, str]:
    """Return the Validation of a pair by the simplest method that serves, and its name."""
    scale, pyramid = (
        2**A.overview,
        as_light(best.moving, best.fixed, B.Y[A.overview], A.Y[A.overview]),
    )
    pair = judgement.compare_light(best.moving, best.fixed, pyramid[0], scale)
    d = pair.differences(best.step)
    for method, search in SEARCHES.items():
        found = judgement.validate(pair, homography.enlarge(steps.last(search(pyramid)).H, scale))
        left, overlaps = (
            pair.differences(found.H),
            max(map(abs, found.offset)) < min(B.Y[0].shape) / 2,
        )
        if (
            found.known
            and overlaps
            and found.confidence >= judgement.LOST
            and pair.lower(left, d)[-1]
        ):
            best, name, d = found, method, left
        if not best.apart:
            break
    return best, name


def best_percentile(moving: int, B: Photograph, fixed: int, A: Photograph) -> judgement.Validation:
    """Return the Validation at the median; where that fails, at Ward's other percentiles, if one is certain.

    Its answer must lie elsewhere: photographs that turned fit nearby, too.
    """

    def attempt(near: float) -> judgement.Validation:
        q = mtb.percentile(A.h[0], B.h[0], near=near)
        if q is None:
            return judgement.uninformative(moving, fixed)

        def count(offset: Array, level: int) -> Array:
            return B.count_differences(A, (int(offset[0]), int(offset[1])), level, q)

        t = A.threshold(q, A.overview)
        both = judgement.compare_bits(moving, fixed, A.Y, A.overview, t, count)
        H = warp.as_homographies([B.offset_onto(A, q)])[0]
        return judgement.validate(both, H, limit=2 ** len(A.Y) - 1)

    first = attempt(0.5)
    for one in (attempt(q) for q in OTHERS if not first.reliable):
        apart = np.max(np.abs(np.subtract(one.offset, first.offset))) > judgement.NEAR
        if one.reliable and one.confidence > CERTAIN and apart:
            return one
    return first


def light_scale(images: Array, times: ArrayLike | None, g: Curve) -> AsLight:
    """Return the function that brings the light of two photographs to one scale, at every size.

    Without a response the darker photograph is brought to the brighter one by histograms alone,
    both are read by the curve of sRGB, and each pixel is divided by the mean around it: what is
    wrong with that is wrong in both alike, and cancels.
    """
    n, seconds = levels(images), None if times is None else as_times(times, len(images))
    given = g if g is None or callable(g) else as_table(g, n)

    def as_light(moving: int, fixed: int, dark: Array, bright: Array) -> list[F32]:
        table, curve = (
            colour.decode_srgb(np.arange(n) / (n - 1)),
            given() if callable(given) else given,
        )
        if curve is not None:
            table = np.exp(
                as_table(curve, n).reshape(n, -1)[:, :2][:, -1]
            )  # the only one, or green
        f_inv = table[:: (n - 1) // np.iinfo(dark.dtype).max]  # an overview has 8 bits
        if curve is None:
            T = transfer.brightness_transfer(*transfer.histograms([dark, bright])[0])
            T[0], T[-1] = 0, len(f_inv) - 1
            z, known = np.arange(len(f_inv)), np.flatnonzero(np.isfinite(T))
            matched = np.interp(np.interp(z, known, T[known]), z, f_inv)
            pair = light.pair(bright, dark, f_inv, matched)
            return [np.stack([x / light.local_mean(x) for x in X]) for X in pair]
        k = light.exposure_ratio(dark, bright, np.log(f_inv))
        if seconds is not None:
            k = seconds[fixed] / seconds[moving]
        return light.pair(bright, dark, f_inv, k * f_inv)

    return as_light
