"""Lens flare: light that a lens scattered, found in the map and taken off where it matters.

F       radiance, as photographed    (H, W[, 3]), (1 - share) E + share (K * E)
E       radiance without flare       (H, W[, 3])
K       point spread of the lens     falls with a power of the distance: see `core.scatter`
ratio   F / (K * E)                  (H, W[, 3]): share + (1 - share) E / (K * E), never below the share
region  (H, W) bool                  where scattered light is more than a part of what was photographed

A map is needed, not a photograph: the flare in the dark corner comes from a sun that only the shortest frame
holds. Scattered light is everywhere, so nothing in the map is darker than it [Reinhard05 on lens flare]: the
lowest ratios are the share, if there are dark places. Whether it is flare shows in how they agree. Under a
veil many places, far from each other, come down to one ratio; without one the lowest are a few odd pixels'.
The power is the one under which most can be taken off: under another the veil meets the floor at one distance
from the lights, and lies below it at all others.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import as_radiance
from hdrlab.core.scatter import Spread, checked, kernel, scattered
from hdrlab.core.steps import last

Float = NDArray[np.float32]
POWERS = (1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0, 3.25, 3.5)
LOW, HIGH = 2e-4, 1e-2  # of the pixels: the lowest ratios, and those that must agree with them
AGREE = 1.7  # times the lowest ratio: without flare they differ by more
LEAST = 0.004  # share: less is neither seen nor told from dark places
SMALL = 384  # pixels: the width at which powers are compared, and noise has averaged out
MOST = 0.97  # of a pixel's light: what is darker is not known any better
ROUNDS = 4  # K * E is needed, and K * F is there: what is off falls by the share each round


class State(NamedTuple):
    """After a round: the share, the veil share (K * E), and E."""

    share: float
    veil: Float
    E: Float


class Flare(NamedTuple):
    """A map without flare.

    Attributes
    ----------
    E : (H, W) or (H, W, 3) float32; outside the region it is the map as it was
    spread : Spread of the lens; its share is 0 where no flare was found
    region : (H, W) bool, where more than `part` of the light was scattered, in any channel
    veil : (H, W) or (H, W, 3) float32, the light that was scattered; 0 without flare
    agreement : the ratio of ratios that decided, near 1 under a veil
    """

    E: Float
    spread: Spread
    region: NDArray[np.bool_]
    veil: Float
    agreement: float


def reduced(E: Float, factor: int) -> Float:
    """Return means over squares of so many pixels; what is left over at the far edges is cut off."""
    height, width = (n // factor for n in E.shape[:2])
    cut = E[: height * factor, : width * factor].reshape(height, factor, width, factor, -1)
    return cut.mean(axis=(1, 3), dtype=np.float32).reshape(height, width, *E.shape[2:])


def floor(F: Float, G: Float) -> tuple[float, float]:
    """Return the lowest ratio F / G, and how far those above it lie: the share, and the agreement.

    Two low quantiles, ten apart, are continued to none at all, as far again below: so a floor that slopes, as
    of dark places that are not quite black, does not count as flare.
    """
    lit = G > 0
    if np.count_nonzero(lit) < 1 / LOW:
        return 0.0, np.inf
    low, next_, high = np.quantile(F[lit] / G[lit], [LOW, 5 * LOW, HIGH])
    share = max(2 * low - next_, 0.0)
    return float(share), float(high / low) if low > 0 else np.inf


def unveiled(F: Float, G: Float, share: float) -> Float:
    """Return E = (F - share G) / (1 - share), not below a thousandth of F: light is not negative."""
    return np.maximum(F - np.float32(share) * G, np.float32(1e-3) * F) / np.float32(1 - share)


def remove_steps(
    F: ArrayLike, power: float, *, core: float = 1.0, share: float | None = None
) -> Iterator[State]:
    """Yield the State of each round: the veil of what was known, the share, and what is left without it.

    The share is measured anew in each round, or is the one given.
    """
    F = E = as_radiance(F)
    transform = kernel(F.shape, power, core)
    factor = max(1, F.shape[1] // SMALL)
    for _ in range(ROUNDS):
        G = scattered(E, transform)
        now = floor(reduced(F, factor), reduced(G, factor))[0] if share is None else share
        E = unveiled(F, G, now)
        yield State(now, np.float32(now) * G, E)


class Fit(NamedTuple):
    """What a power of fall comes to: the share, the agreement of the darkest places, and the mean taken off.

    That is of ln F - ln E, and none counts for more than MOST.
    """

    power: float
    share: float
    agreement: float
    removed: float


def fit(F: ArrayLike, power: float, *, core: float = 1.0) -> Fit:
    """Return the Fit of a point spread of this power to a map."""
    F = as_radiance(F)
    state = last(remove_steps(F, power, core=core))
    if state.share == 0:
        return Fit(power, 0.0, np.inf, 0.0)
    _, agrees = floor(F, state.veil / np.float32(state.share))
    part = np.minimum(state.veil / np.maximum(F, np.finfo(np.float32).tiny), np.float32(MOST))
    return Fit(power, state.share, agrees, float(-np.log1p(-part).mean()))


def estimate(F: ArrayLike, *, powers: tuple[float, ...] = POWERS) -> tuple[Spread, float]:
    """Return the Spread of the lens that took a map, of share 0 where there is no flare, and the agreement.

    Parameters
    ----------
    F : (H, W) or (H, W, 3), radiance map of a whole bracket: its lights must not be clipped
    powers : the powers to choose from

    Raises
    ------
    ValueError
        For radiance that is not finite or negative, and for no powers.

    Examples
    --------
    >>> from hdrlab import scenes
    >>> from hdrlab.capture import lens_flare
    >>> spread, _ = estimate(lens_flare.add_glare(scenes.room((128, 192)), Spread(0.05, 2.5)))
    >>> spread.power, round(spread.share, 2)
    (2.5, 0.05)
    """
    F = as_radiance(F)
    if not powers:
        raise ValueError("expected at least one power")
    factor = max(1, F.shape[1] // SMALL)
    small = reduced(F, factor)
    best = max((fit(small, power, core=1 / factor) for power in powers), key=lambda one: one.removed)
    found = best.agreement < AGREE and best.share > LEAST
    return Spread(best.share if found else 0.0, best.power), best.agreement


def remove(F: ArrayLike, *, spread: Spread | None = None, part: float = 0.02) -> Flare:
    """Return the radiance map without the light that the lens scattered.

    Parameters
    ----------
    F : (H, W) or (H, W, 3), radiance map of a whole bracket
    spread : of the lens, where it was measured; by default it is estimated from the map
    part : of a pixel's light, from which on scattered light is taken off; elsewhere the map stays as it is

    Returns
    -------
    Flare

    Raises
    ------
    ValueError
        For radiance that is not finite or negative, and for a spread or a part that means nothing.

    References
    ----------
    Chuang, High dynamic range imaging (slides), "Lens flare removal"; Reinhard, Ward, Pattanaik and Debevec,
    High Dynamic Range Imaging, 2005, on lens flare; Talvala, Adams, Horowitz and Levoy, SIGGRAPH 2007.

    Examples
    --------
    >>> from hdrlab import scenes
    >>> from hdrlab.capture import lens_flare
    >>> room = scenes.room((128, 192))
    >>> found = remove(lens_flare.add_glare(room, Spread(0.05, 2.5)))
    >>> found.spread.power, round(found.spread.share, 2)
    (2.5, 0.05)
    >>> remove(room).region.any()
    np.False_
    """
    F = as_radiance(F)
    if not 0 < part < 1:
        raise ValueError(f"expected a part between 0 and 1, got {part}")
    found, agrees = estimate(F) if spread is None else (checked(spread), 1.0)
    if found.share == 0:
        return Flare(F.copy(), found, np.zeros(F.shape[:2], bool), np.zeros_like(F), agrees)
    given = None if spread is None else found.share
    state = last(remove_steps(F, found.power, core=found.core, share=given))
    much = state.veil > np.float32(part) * F
    region = np.asarray(much if F.ndim == 2 else much.any(axis=-1))
    where = region if F.ndim == 2 else region[..., None]
    return Flare(np.where(where, state.E, F), found._replace(share=state.share), region, state.veil, agrees)


def note(found: Flare) -> str:
    """Return the sentence on how much light the lens scattered, and where that was taken off."""
    if found.spread.share == 0:
        return "no veil found: the darkest places do not come down to one share of the light around them"
    share, power, region = 100 * found.spread.share, found.spread.power, 100 * found.region.mean()
    return (
        f"the lens scattered {share:.1f} % of the light, falling with the power {power:g} of the distance; "
        f"taken off in {region:.0f} % of the pixels"
    )
