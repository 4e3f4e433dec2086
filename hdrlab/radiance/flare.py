"""Lens flare: veiling glare, the light that a lens scattered, found in the map and removed where it matters.

F       radiance, as photographed    (H, W[, 3]), (1 - share) E + share (K * E)
E       radiance without glare       (H, W[, 3])
K       glare spread function        falls with a power of the distance: see `core.filters.scatter`
ratio   F / (K * E)                  (H, W[, 3]): share + (1 - share) E / (K * E), never below the share
region  (H, W) bool                  where glare is more than a part of what was photographed

A map is needed, not a photograph: the glare in the dark corner comes from a sun that only the
shortest frame holds. Glare is everywhere, so nothing in the map is darker than it [Reinhard05 on
lens flare]: the lowest ratios are the share, if there are dark places. Whether it is glare shows in
how they agree. Under glare many places, far from each other, come down to one ratio; without it the
lowest are a few odd pixels'. The power is the one under which most can be removed: under another
the glare meets the floor at one distance from the lights, and lies below it at all others.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, ArrayLike, Mask, as_radiance
from hdrlab.core.filters.scatter import GlareSpread, scatter, spread_transform, validate_spread
from hdrlab.core.steps import last
from hdrlab.errors import InputError

POWERS = (1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0, 3.25, 3.5)
# of the pixels: the lowest ratios, and those that must agree with them
LOW = 2e-4
HIGH = 1e-2
# times the lowest ratio: without glare they differ by more
AGREE = 1.7
# share: less is neither visible nor measured by dark places
LEAST = 0.004
# pixels: the width at which powers are compared, and noise has averaged out
WIDTH = 384
# of a pixel's light: what is darker is not known any better
MOST = 0.97
# K * E is needed, and K * F is there: what is off falls by the share each round
ROUNDS = 4


class State(NamedTuple):
    """After a round: the share, the veiling glare share (K * E), and E."""

    share: float
    glare: F32
    E: F32


class Deglared(NamedTuple):
    """A map without veiling glare.

    Attributes
    ----------
    E : (H, W) or (H, W, 3) float32; outside the region it is the map as it was
    spread : GlareSpread of the lens; its share is 0 where no glare was found
    region : (H, W) bool, where more than `part` of the light was scattered, in any channel
    glare : (H, W) or (H, W, 3) float32, the light that was scattered; 0 without glare
    agreement : the ratio of ratios that decided, near 1 under glare
    """

    E: F32
    spread: GlareSpread
    region: Mask
    glare: F32
    agreement: float


def block_means(E: F32, factor: int) -> F32:
    """Return means over squares of so many pixels; what is left over at the far edges is cut off."""
    height, width = (n // factor for n in E.shape[:2])
    cut = E[: height * factor, : width * factor].reshape(height, factor, width, factor, -1)
    return cut.mean(axis=(1, 3), dtype=np.float32).reshape(height, width, *E.shape[2:])


def lowest_ratio(F: F32, G: F32) -> tuple[float, float]:
    """Return the lowest ratio F / G, and how far those above it lie: the share, and the agreement.

    Two low quantiles, ten apart, are continued to none at all, as far again below: so a floor that
    slopes, as of dark places that are not quite black, does not count as glare.
    """
    positive = G > 0
    if np.count_nonzero(positive) < 1 / LOW:
        return 0.0, np.inf
    low, next_, high = np.quantile(F[positive] / G[positive], [LOW, 5 * LOW, HIGH])
    return float(max(2 * low - next_, 0.0)), float(high / low) if low > 0 else np.inf


def subtract_glare(F: F32, G: F32, share: float) -> F32:
    """Return E = (F - share G) / (1 - share), not below a thousandth of F: light is not negative."""
    return np.maximum(F - np.float32(share) * G, np.float32(1e-3) * F) / np.float32(1 - share)


def glare_steps(
    F: ArrayLike, power: float, *, core: float = 1.0, share: float | None = None
) -> Iterator[State]:
    """Yield the State of each round: the glare of the E before, its share, and E without it.

    The share is measured again in each round, or is the one given.
    """
    F = E = as_radiance(F)
    transform = spread_transform(F.shape, power, core)
    factor = max(1, F.shape[1] // WIDTH)
    for _ in range(ROUNDS):
        G = scatter(E, transform)
        now = (
            lowest_ratio(block_means(F, factor), block_means(G, factor))[0]
            if share is None
            else share
        )
        E = subtract_glare(F, G, now)
        yield State(now, np.float32(now) * G, E)


class Fit(NamedTuple):
    """A glare spread function of one power: the share, the agreement of the darkest places, the mean removed.

    That is of ln F - ln E, and none counts for more than MOST.
    """

    power: float
    share: float
    agreement: float
    removed: float


def fit_power(F: ArrayLike, power: float, *, core: float = 1.0) -> Fit:
    """Return the Fit of a glare spread function of this power to a map."""
    F = as_radiance(F)
    state = last(glare_steps(F, power, core=core))
    if state.share == 0:
        return Fit(power, 0.0, np.inf, 0.0)
    _, agreement = lowest_ratio(F, state.glare / np.float32(state.share))
    part = np.minimum(state.glare / np.maximum(F, np.finfo(np.float32).tiny), np.float32(MOST))
    return Fit(power, state.share, agreement, float(-np.log1p(-part).mean()))


def estimate_spread(
    F: ArrayLike, *, powers: tuple[float, ...] = POWERS
) -> tuple[GlareSpread, float]:
    """Return the GlareSpread of the lens that took a map, of share 0 where there is none, and the agreement.

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
    >>> from hdrlab.capture.lens_flare import add_glare
    >>> spread, _ = estimate_spread(add_glare(scenes.room((128, 192)), GlareSpread(0.05, 2.5)))
    >>> spread.power, round(spread.share, 2)
    (2.5, 0.05)
    """
    F = as_radiance(F)
    if not powers:
        raise InputError("expected at least one power")
    factor = max(1, F.shape[1] // WIDTH)
    small = block_means(F, factor)
    best = max(
        (fit_power(small, power, core=1 / factor) for power in powers), key=lambda one: one.removed
    )
    found = best.agreement < AGREE and best.share > LEAST
    return GlareSpread(best.share if found else 0.0, best.power), best.agreement


def remove_glare(
    F: ArrayLike, *, spread: GlareSpread | None = None, part: float = 0.02
) -> Deglared:
    """Return the radiance map without veiling glare, the light that the lens scattered.

    Parameters
    ----------
    F : (H, W) or (H, W, 3), radiance map of a whole bracket
    spread : of the lens, where it was measured; by default it is estimated from the map
    part : of a pixel's light, from which on glare is removed; elsewhere the map stays as it is

    Returns
    -------
    Deglared

    Raises
    ------
    ValueError
        For radiance that is not finite or negative, and for a spread or a part out of range.

    References
    ----------
    Chuang, High dynamic range imaging (slides), "Lens flare removal"; Reinhard, Ward, Pattanaik and
    Debevec, High Dynamic Range Imaging, 2005, on lens flare; Talvala, Adams, Horowitz and Levoy,
    SIGGRAPH 2007.

    Examples
    --------
    >>> from hdrlab import scenes
    >>> from hdrlab.capture.lens_flare import add_glare
    >>> room = scenes.room((128, 192))
    >>> found = remove_glare(add_glare(room, GlareSpread(0.05, 2.5)))
    >>> found.spread.power, round(found.spread.share, 2)
    (2.5, 0.05)
    >>> remove_glare(room).region.any()
    np.False_
    """
    F = as_radiance(F)
    if not 0 < part < 1:
        raise InputError(f"expected a part between 0 and 1, got {part}")
    found, agreement = estimate_spread(F) if spread is None else (validate_spread(spread), 1.0)
    if found.share == 0:
        return Deglared(F.copy(), found, np.zeros(F.shape[:2], bool), np.zeros_like(F), agreement)
    share = None if spread is None else found.share
    state = last(glare_steps(F, found.power, core=found.core, share=share))
    much = state.glare > np.float32(part) * F
    region = np.asarray(much if F.ndim == 2 else much.any(axis=-1))
    E = np.where(region if F.ndim == 2 else region[..., None], state.E, F)
    return Deglared(E, found._replace(share=state.share), region, state.glare, agreement)


def note(found: Deglared) -> str:
    """Return the sentence on how much light the lens scattered, and where that was removed."""
    if found.spread.share == 0:
        return "no veiling glare found: the darkest places have no common share of the light around them"
    share = 100 * found.spread.share
    power = found.spread.power
    region = 100 * found.region.mean()
    return (
        f"veiling glare: the lens scattered {share:.1f} % of the light, falling with the power {power:g} of "
        f"the distance; removed in {region:.0f} % of the pixels"
    )
