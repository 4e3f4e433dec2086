"""Which frame's exposure time is wrong, or does no time explain the images?

x        corrections   (P,), what the pixels add to ln times: see `response_steps`
stops    errors        (P,), log2(exposure by the pixels / exposure stated), most of them 0
regions  disagreement  (P - 1,), stops by which parts of the picture disagree, under the best of factors
significance           (P - 1,), the same over the standard error of a part's median; medians

The map follows its frames: one at the end of a bracket, .7 stops off, draws it along and shows in the
deviations of `consistency` as .1. Neighbours are compared here by themselves, through a response that fits
them as well as any response and one factor per frame can. The factors hold an unknown straight line in ln t
(unit and exponent of the response). As most times of a bracket are right, the line taken is that of least
square roots, which passes through most frames and leaves the wrong ones standing out: one large error is
likelier than several middling ones.

If factors explain all, times are wrong. If parts of one picture ask for different factors, none are: each
picture was processed by itself and by place, as phones do.

How weak a local tone map is noticed? One that multiplies by L^-u, with L the mean over a 20th of the width.
Parts that disagree by a tenth of a stop need no other proof. Down to a fiftieth they count where the patches
within a part agree so well that the parts are off by four times their error: true times and one response stay
below 3.2, at up to 0.06 stops, where people and clouds move and hands shake. So u = 0.3 is noticed in
`frobisher`, 0.2 in `tripod_phone` and in rooms of five frames and more. A weaker one cannot be distinguished
from what true brackets hold, nor one whose L follows the level, for that is a response like any other: among
simulated photographs of six measured rooms a third of those with u = 0.4 disagreed by a tenth of a stop, half
by less than 0.07. Where too few patches are flat in every frame (`memorial`) nothing is reported.
"""

from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hdrlab.core.arrays import as_stack
from hdrlab.core.types import F64, Indices, Mask
from hdrlab.diagnostics import flat_patches, response_steps

# side of a part of the picture, in patches
TILE = 12
# patches that make the median of a part
FEWEST = 10
# of w(a) w(b): a patch that is neither dark nor bright in both frames
TRUSTED = 0.1
# stops, the prior: here times are free, for the question is what is wrong and not what is likely
LOOSE = 4.0
# stops: true times of real brackets stay within 0.12
WRONG = 0.25
# stops: real brackets of one response stay within 0.06
LOCAL = 0.1
# stops, and standard errors: real brackets of one response stay within 3.2
SLIGHT, SIGNIFICANT = 0.02, 4.0
# stops: no standard error of a part is smaller, for patches have whole levels
SMALLEST_ERROR = 0.003


class Contradictions(NamedTuple):
    """stops (P,), NaN where no flat patch connects frames; regions, significance (P - 1,), NaN: unknown."""

    stops: F64
    regions: F64
    significance: F64 = np.zeros(0)

    @property
    def wrong(self) -> tuple[int, ...]:
        """The frames whose times are wrong."""
        return tuple(np.flatnonzero(np.abs(self.stops) > WRONG).tolist())

    @property
    def local(self) -> bool:
        """Whether one response, and one factor per frame, cannot explain the bracket."""
        by, errors = (one[np.isfinite(one)] for one in (self.regions, self.significance))
        if not len(by):
            return False
        return bool(np.median(by) > LOCAL or (np.median(by) > SLIGHT and np.median(errors) > SIGNIFICANT))


def find_contradictions(
    images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None
) -> Contradictions:
    """Return where the pixels of aligned photographs, from short to long, contradict their times.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
    times : (P,) seconds, as stated
    valid : (P, H, W) bool, optional, False where a photograph holds no picture

    Returns
    -------
    Contradictions
        Of the longest run of frames that flat patches connect, if these are three or more. Of three frames
        any one may be wrong: then the middle one is named, or an end by twice as much.

    Examples
    --------
    >>> from hdrlab.capture import camera
    >>> from hdrlab.capture.room import view
    >>> room = view.room((280, 420))
    >>> taken = camera.shoot(room, camera.times_around(room, 5, stops=1.5))
    >>> find_contradictions(taken.images, taken.times * [1, 1, 2, 1, 1]).wrong
    (2,)
    """
    stack = as_stack(images)
    B = np.log(response_steps.as_ascending_times(times, len(stack)))
    found = flat_patches.find_flat_patches(stack, valid=valid)
    H = flat_patches.count_pairs(found.Z, found.flat)
    stops, regions, significance = np.full(len(B), np.nan), *np.full((2, len(B) - 1), np.nan)
    start, stop = find_longest_run(response_steps.find_informative(H))
    frames, pairs = slice(start, stop + 1), slice(start, stop)
    if stop - start < 2 or np.ptp(B[frames]) == 0:
        return Contradictions(stops, regions, significance)
    best = response_steps.fit_steps(H[pairs], B[frames], response_steps.free_directions(B[frames]), sd=LOOSE)
    stops[frames] = remove_trend(best.x, B[frames]) / np.log(2)
    regions[pairs], significance[pairs] = measure_disagreement(
        found._replace(Z=found.Z[frames]), B[frames], best
    )
    return Contradictions(stops, regions, significance)


def find_longest_run(informative: Mask) -> tuple[int, int]:
    """Return start and stop of the longest run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], informative, [False]]).astype(int)))
    runs = edges.reshape(-1, 2).tolist()
    start, stop = max(runs, key=lambda run: run[1] - run[0], default=(0, 0))
    return start, stop


def remove_trend(x: F64, B: F64) -> F64:
    """Return x less a straight line in B: that of two frames, which leaves the least sum of sqrt |x|."""
    left = [
        x - x[i] - (x[k] - x[i]) / (B[k] - B[i]) * (B - B[i])
        for i, k in combinations(range(len(B)), 2)
        if B[k] != B[i]
    ]
    return min(left, key=lambda r: float(np.round(np.sqrt(np.abs(r)).sum(), 6)))


def measure_disagreement(
    found: flat_patches.FlatPatches, B: F64, best: response_steps.Fit
) -> tuple[F64, F64]:
    """Return each pair's disagreement by place, (P - 1,), twice.

    In stops, where a quarter of the tiles are off by more; and in standard errors, where half of them are.
    """
    h, w = found.flat.shape
    y, x = np.indices((h, w)) // TILE
    tile = y * (w // TILE + 1) + x
    channel = np.arange(found.Z.shape[1])[:, None, None]
    out = np.full((2, len(B) - 1), np.nan)
    for j, step in enumerate(np.diff(B + best.x)):
        a, b = found.Z[j], found.Z[j + 1]
        trusted = (response_steps.W[a] * response_steps.W[b] > TRUSTED).all(axis=0) & found.flat
        r = (best.g[channel, b] - best.g[channel, a]).mean(axis=0)[trusted] - step
        medians, errors = _tile_medians(r / np.log(2), tile[trusted])
        if len(medians):
            out[:, j] = np.quantile(np.abs(medians), 0.75), np.median(np.abs(medians) / errors)
    return out[0], out[1]


def _tile_medians(r: F64, tile: Indices) -> tuple[F64, F64]:
    """Return the median of r over each tile of at least FEWEST patches, and its standard error.

    That of a median is 1.25 sigma / sqrt(n), and sigma 1.48 times the median deviation, for normal errors.
    """
    order = np.argsort(tile, kind="stable")
    groups = np.split(r[order], np.flatnonzero(np.diff(tile[order])) + 1)
    large = [group for group in groups if len(group) >= FEWEST]
    medians = np.array([np.median(group) for group in large])
    sigma = np.array([1.48 * np.median(np.abs(group - np.median(group))) for group in large])
    return medians, np.maximum(1.25 * sigma / np.sqrt([len(group) for group in large]), SMALLEST_ERROR)


def warn_of_contradictions(found: Contradictions, names: Sequence[str]) -> str:
    """Return the sentence on what is wrong, at which frame, by how much, and what to do; "" for nothing."""
    if found.local:
        j = int(np.nanargmax(found.regions))
        return (
            f"one response cannot explain the photographs: under the best factor for each, parts of the "
            f"picture still disagree by {np.nanmedian(found.regions):.2f} stops, most between {names[j]} and "
            f"{names[j + 1]} ({found.regions[j]:.2f}), as when a phone tone-maps each by place: switch HDR "
            "and automatic enhancement off, or take RAW; other times will not help"
        )
    if not found.wrong:
        return ""
    off = ", ".join(f"{names[j]} by {found.stops[j]:+.2f}" for j in found.wrong)
    known = np.isfinite(found.stops).sum()
    other = " (of three it may also be the first or the last, by twice as much)" if known == 3 else ""
    return (
        f"the photographs contradict their exposure times, in stops of exposure by the pixels over exposure "
        f"stated: {off}{other}; a factor for each frame explains them: correct these times, or estimate them "
        "(--times estimate), and see that the camera did not change ISO or aperture"
    )
