"""Veiling glare, the light that a lens scatters: estimated from the radiance map, and removed.

F       radiance, as photographed    (H, W[, 3]), (1 - share) E + share (K * E)
E       radiance without glare       (H, W[, 3])
K       glare spread function        falls with a power of the distance: see `core.filters.scatter`
ratio   F / (K * E)                  (H, W[, 3]): share + (1 - share) E / (K * E), never below the share
region  (H, W) bool                  where glare is more than a part of what was photographed

This needs a radiance map, not a photograph: the glare in a dark corner comes from a sun that only
the shortest frame measures. Glare is everywhere, so nothing in the map is darker than it
[Reinhard05 on lens flare]: if there are dark places, the lowest ratios equal the share. Their
agreement shows whether they are glare. With glare, many distant places come down to one ratio;
without it, the lowest ratios are those of a few odd pixels. The power is the one with which most
light can be removed. With any other power, the estimated glare reaches the lowest ratios at one
distance from the lights only, and is too low at all others.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, ArrayLike, Mask, as_radiance
from hdrlab.core.filters.scatter import GlareSpread, scatter, spread_transform, validate_spread
from hdrlab.core.steps import last
from hdrlab.errors import InputError

POWERS = (1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0, 3.25, 3.5)
# quantile of the ratios that counts as the lowest ratio
LOW_QUANTILE = 2e-4
# quantile of the ratios that is compared with the lowest ratio
HIGH_QUANTILE = 1e-2
# quotient of the two; without glare it is larger
MAX_AGREEMENT = 1.7
# a smaller share is invisible, and dark places do not measure it
MIN_SHARE = 0.004
# pixels of the reduced map on which powers are compared; noise is averaged out there
COMPARISON_WIDTH = 384
# fraction of a pixel's light that the estimate of the removed light counts at most
MAX_REMOVED_FRACTION = 0.97
# K * F stands in for K * E at first; each iteration reduces the error by a factor of the share
ITERATION_COUNT = 4


class State(NamedTuple):
    """The share, the veiling glare share (K * E), and E after an iteration."""

    share: float
    glare: F32
    E: F32


@dataclass(frozen=True)
class Deglared:
    """A radiance map without veiling glare.

    Attributes
    ----------
    E : (H, W) or (H, W, 3) float32; outside the region it is the original map
    spread : GlareSpread of the lens; its share is 0 if no glare was found
    region : (H, W) bool, where more than `part` of the light was scattered, in any channel
    glare : (H, W) or (H, W, 3) float32, the scattered light; 0 without glare
    agreement : quotient of a high and the lowest ratio, near 1 with glare
    """

    E: F32
    spread: GlareSpread
    region: Mask
    glare: F32
    agreement: float


def block_means(E: F32, factor: int) -> F32:
    """Return means over squares of `factor` pixels; incomplete squares at the far edges are cut off."""
    height = E.shape[0] // factor
    width = E.shape[1] // factor
    blocks = E[: height * factor, : width * factor].reshape(height, factor, width, factor, -1)
    return blocks.mean(axis=(1, 3), dtype=np.float32).reshape(height, width, *E.shape[2:])


def lowest_ratio(F: F32, G: F32) -> tuple[float, float]:
    """Return the lowest ratio F / G, which is the share, and the quotient of a higher ratio and it.

    The lowest ratio is extrapolated from two low quantiles. So a gradual increase, as of dark
    places that are not quite black, does not count as glare.
    """
    positive = G > 0
    if np.count_nonzero(positive) < 1 / LOW_QUANTILE:
        return 0.0, np.inf
    quantiles = [LOW_QUANTILE, 5 * LOW_QUANTILE, HIGH_QUANTILE]
    low, higher, high = np.quantile(F[positive] / G[positive], quantiles)
    share = float(max(2 * low - higher, 0.0))
    agreement = float(high / low) if low > 0 else np.inf
    return share, agreement


def subtract_glare(F: F32, G: F32, share: float) -> F32:
    """Return E = (F - share G) / (1 - share), at least a thousandth of F, as light is not negative."""
    return np.maximum(F - np.float32(share) * G, np.float32(1e-3) * F) / np.float32(1 - share)


def glare_steps(
    F: ArrayLike, power: float, *, core: float = 1.0, share: float | None = None
) -> Iterator[State]:
    """Yield the State of each iteration: the share, the glare computed from the last E, and the new E.

    With `share` None, each iteration estimates the share again.
    """
    F = as_radiance(F)
    E = F
    transform = spread_transform(F.shape, power, core)
    factor = max(1, F.shape[1] // COMPARISON_WIDTH)
    for _ in range(ITERATION_COUNT):
        G = scatter(E, transform)
        if share is None:
            estimate, _ = lowest_ratio(block_means(F, factor), block_means(G, factor))
        else:
            estimate = share
        E = subtract_glare(F, G, estimate)
        yield State(estimate, np.float32(estimate) * G, E)


@dataclass(frozen=True)
class Fit:
    """A glare spread function of one power, fitted to a map.

    Attributes
    ----------
    power : of the distance, with which scattered light falls
    share : of the light that is scattered
    agreement : quotient of a high and the lowest ratio, near 1 with glare
    removed : mean of ln F - ln E; a pixel counts as if at most 97 % of its light were removed
    """

    power: float
    share: float
    agreement: float
    removed: float


def fit_power(F: ArrayLike, power: float, *, core: float = 1.0) -> Fit:
    """Return the Fit of a glare spread function of this power to the map F."""
    F = as_radiance(F)
    state = last(glare_steps(F, power, core=core))
    if state.share == 0:
        return Fit(power, 0.0, np.inf, 0.0)
    _, agreement = lowest_ratio(F, state.glare / np.float32(state.share))
    fraction = state.glare / np.maximum(F, np.finfo(np.float32).tiny)
    fraction = np.minimum(fraction, np.float32(MAX_REMOVED_FRACTION))
    return Fit(power, state.share, agreement, float(-np.log1p(-fraction).mean()))


def estimate_spread(
    F: ArrayLike, *, powers: tuple[float, ...] = POWERS
) -> tuple[GlareSpread, float]:
    """Return the glare spread function of the lens, estimated from a radiance map, and the agreement.

    Its share is 0 if there is no glare.

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
    factor = max(1, F.shape[1] // COMPARISON_WIDTH)
    small = block_means(F, factor)
    fits = [fit_power(small, power, core=1 / factor) for power in powers]
    best = max(fits, key=lambda fit: fit.removed)
    has_glare = best.agreement < MAX_AGREEMENT and best.share > MIN_SHARE
    return GlareSpread(best.share if has_glare else 0.0, best.power), best.agreement


def remove_glare(
    F: ArrayLike, *, spread: GlareSpread | None = None, part: float = 0.02
) -> Deglared:
    """Return the radiance map without veiling glare, the light that the lens scattered.

    Parameters
    ----------
    F : (H, W) or (H, W, 3), radiance map of a whole bracket
    spread : measured glare spread of the lens; by default it is estimated from the map
    part : glare is removed where it is more than this part of a pixel's light; elsewhere the map
        stays as it is

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
        raise InputError(f"expected a fraction between 0 and 1, got {part}")
    if spread is None:
        spread, agreement = estimate_spread(F)
        given_share = None
    else:
        spread = validate_spread(spread)
        agreement = 1.0
        given_share = spread.share
    if spread.share == 0:
        return Deglared(
            E=F.copy(),
            spread=spread,
            region=np.zeros(F.shape[:2], bool),
            glare=np.zeros_like(F),
            agreement=agreement,
        )
    state = last(glare_steps(F, spread.power, core=spread.core, share=given_share))
    exceeds = state.glare > np.float32(part) * F
    region = np.asarray(exceeds if F.ndim == 2 else exceeds.any(axis=-1))
    E = np.where(region if F.ndim == 2 else region[..., None], state.E, F)
    return Deglared(
        E=E,
        spread=spread._replace(share=state.share),
        region=region,
        glare=state.glare,
        agreement=agreement,
    )


def note(result: Deglared) -> str:
    """Return a sentence that says how much light the lens scattered, and where that was removed."""
    if result.spread.share == 0:
        return "no veiling glare found: the darkest places have no common share of the light around them"
    share = 100 * result.spread.share
    power = result.spread.power
    percent = 100 * result.region.mean()
    return (
        f"veiling glare: the lens scattered {share:.1f} % of the light, which falls off with the "
        f"power {power:g} of the distance; the glare was removed in {percent:.0f} % of the pixels"
    )
