"""Ghosts: something that moved between the photographs appears several times, half transparent.

Z           pixel levels      (P, H, W[, 3])
score       contradiction     (H, W), 1 is what noise and edges explain: see `deviation`
labels      regions           (H, W) int32, 1 ... R, 0 elsewhere
references  best exposures    (R,), the reference frame of each region
used        (P, H, W) bool    which frames make a pixel's radiance

The plain method is weighted variance, threshold, dilation, regions, and the best exposure in each
region. This one differs in two points. Edges of high contrast have a variance as well, and the part
that they explain is subtracted. And in a region, the best exposure is the reference, but other
frames join it where they are consistent with it (see `reference`). They fill its clipped and its
dark pixels, and reduce its noise.

One frame per region means one moment per region: a person who walks through the picture may appear
twice, or not at all. With one reference for all regions, the map shows one moment.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy import ndimage

from hdrlab.core import steps, weights
from hdrlab.core.arrays import (
    F32,
    ArrayLike,
    Flags,
    Indices,
    Labels,
    Mask,
    as_mask,
    as_stack,
    levels,
)
from hdrlab.errors import InputError
from hdrlab.radiance.deghosting import deviation, reference, regions
from hdrlab.radiance.deghosting.frames import Calibrated, best_exposures, calibrate_frames
from hdrlab.radiance.merge import Merged, merge_with_quality

# a region grows by up to this many margins at once
GROWTH_MARGINS = 4
# per cent of the pixels; if more of them contradict each other, motion is hardly the reason
WIDESPREAD_PERCENT = 50
# growing finds the whole figure of a reference frame after one or two iterations
MAX_GROWTH_ITERATIONS = 4
# in ln E: contradiction that is tolerated everywhere, in addition to noise and edges
LOG_TOLERANCE = 0.1
# fraction of a frame's range of ln E over 3 x 3 pixels that is tolerated in addition; with 0.5, no
# edge counts that is displaced by up to a pixel
EDGE_FRACTION = 0.35


class Regions(NamedTuple):
    """Regions (H, W), labelled 1 ... R, and the reference frame (R,) of each."""

    labels: Labels
    references: Indices


@dataclass(frozen=True)
class Ghosts:
    """A radiance map without ghosts, the regions that moved, and the frames that were used.

    Attributes
    ----------
    E : (H, W) or (H, W, 3) float32, the map; outside the regions it is the plain map
    quality : (H, W) uint8, pixel quality flags of `merge.Quality`
    labels : (H, W) int32, the regions 1 ... R; 0 where nothing moved
    references : (R,) int, the reference frame of each region
    used : (P, H, W) bool, the frames that contribute to each pixel, in the order of the images
    score : (H, W) float32, contradiction over the part that noise and edges explain
    alpha : (H, W) float32, how much of E is made of `used`: 1 inside the regions, 0 outside, and
        between them in the seams, where the rest is the plain map
    """

    E: F32
    quality: Flags
    labels: Labels
    references: Indices
    used: Mask
    score: F32
    alpha: F32


def detect_motion(
    found: deviation.Deviation, *, tau: float, edge: float, margin: int
) -> tuple[F32, Mask]:
    """Return the score (H, W) and the mask (H, W) of moving pixels.

    For tau and edge, see LOG_TOLERANCE and EDGE_FRACTION.

    Seeds have a score above 1. The mask grows from them over weaker contradictions, with half of
    tau and a fifth of `edge`, and then by the margin.
    """
    score = deviation.score_contradiction(found, tau=tau, edge=edge)
    seed = regions.find_seeds(score)
    if not seed.any():
        return score, seed
    weak = deviation.score_contradiction(found, tau=tau / 2, edge=edge / 5) > 1
    grown = regions.grow(seed, weak, GROWTH_MARGINS * margin)
    return score, regions.dilate(grown, margin)


def find_contradictions(taken: Calibrated, box: regions.Box, j: int, E: F32) -> Mask:
    """Return where photograph j is not consistent with the map E (h, w, C) of a box."""
    plain = reference.Estimate(
        E=E,
        V=np.zeros_like(E),
        measured=np.ones(E.shape, bool),
        low=np.zeros_like(E),
        high=np.full_like(E, np.inf),
    )
    frame = reference.read_frame(taken, j, box)
    return ~reference.find_consistent(frame, plain, tau=2 * reference.RELATIVE_TOLERANCE)


def find_still(taken: Calibrated, box: regions.Box, E: F32) -> Mask:
    """Return where all photographs are consistent with the map E (h, w, C) of a box.

    There, removing ghosts would change what has none.
    """
    contradictions = [find_contradictions(taken, box, j, E) for j in range(len(taken.images))]
    return ~np.any(contradictions, axis=0)


def region_steps(
    taken: Calibrated, E: F32, moved: Mask, margin: int, *, choose: Callable[[Labels], Indices]
) -> Iterator[Regions]:
    """Yield the regions and their reference frames, until no region cuts through a figure.

    A region must contain the whole figure as it appears in its reference frame, which `choose`
    returns. So a region grows where that photograph contradicts the plain map E (H, W, C) next to
    it, and may merge with another region.
    """
    reach = GROWTH_MARGINS * margin
    for _ in range(MAX_GROWTH_ITERATIONS):
        labels = regions.label(moved)
        references = choose(labels)
        yield Regions(labels, references)
        wider = moved.copy()
        for r, box in enumerate(ndimage.find_objects(labels)):
            wide = regions.pad_box(box, reach, labels.shape)
            contradictions = find_contradictions(taken, wide, int(references[r]), E[wide])
            wider[wide] |= regions.grow(labels[wide] == r + 1, contradictions, reach)
        if np.array_equal(wider, moved):
            return
        moved = regions.dilate(wider, margin // 2)


def select_frames(taken: Calibrated, box: regions.Box, j: int, *, alone: bool) -> Mask:
    """Return the frames to use in a box, (P, h, w): those consistent with reference j, or only j."""
    if not alone:
        return reference.find_consistent_frames(taken, j, box)
    used = np.zeros((len(taken.images), *taken.images[0][box].shape[:2]), bool)
    used[j] = True if taken.valid is None else taken.valid[j][box]
    return used


def remove_ghosts(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    w: ArrayLike | None = None,
    *,
    fixed: int | None = None,
    alone: bool = False,
    merged: Merged | None = None,
    valid: ArrayLike | None = None,
    merge: Callable[..., Merged] = merge_with_quality,
) -> Ghosts:
    """Return the radiance map of a bracket in which something moved, without ghosts.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16, aligned photographs, in any order
    times : (P,) seconds
    g : (n,) or (n, 3), response, ln exposure of each level
    w : (n,), weights; the hat by default
    fixed : number of the reference frame of every region; by default each has its own best exposure
    alone : use only the reference frame in a region, as in the plain method
    merged : the plain map of `merge`, if it is known; by default it is computed
    valid : (P, H, W) bool, optional, False where a photograph shows nothing of the scene
    merge : `merge_with_quality`, of `radiance.merge` or of `fast.merge`

    Returns
    -------
    Ghosts
        If nothing moved, there is no region, and E is the plain map, bit for bit.

    Raises
    ------
    ValueError
        For arrays that do not fit together, and a number `fixed` that is not that of a frame.

    References
    ----------
    Chuang, High dynamic range imaging (slides), "Automatic ghost removal"; Reinhard, Ward,
    Pattanaik and Debevec, High Dynamic Range Imaging, 2005, on ghosts.

    Examples
    --------
    >>> from hdrlab.capture import movers, responses
    >>> wall = np.full((60, 90), 0.5, np.float32)
    >>> ball = movers.ball((60, 90), (30, 45), 9, 2.0)
    >>> taken = movers.shoot(wall, ball, movers.path(3, (0, 25)), [0.25, 0.5, 1.0])
    >>> found = remove_ghosts(taken.bracket.images, taken.bracket.times, responses.true_g("film"))
    >>> found.labels.max(), found.E.shape
    (np.int32(1), (60, 90))
    """
    stack = as_stack(images)
    mask = as_mask(valid, stack)
    margin = max(4, round(stack.shape[2] / 150))
    if fixed is not None and fixed not in range(len(stack)):
        raise InputError(
            f"expected the number of a frame, 0 to {len(stack) - 1}, as fixed, got {fixed}"
        )
    w = weights.hat(levels(stack)) if w is None else w
    merged = merged or merge(stack, times, g, w, valid=mask)
    E = merged.E.copy()
    quality = merged.quality.copy()
    taken = calibrate_frames(stack, times, g, E, valid=mask)
    plain = merged.E.reshape(taken.images.shape[1:])
    contradiction = deviation.measure_deviation(taken, w)
    # neither noise nor edges explain these
    contradiction.v[deviation.find_clipped_elsewhere(taken, plain)] = np.inf
    score, moved = detect_motion(
        contradiction, tau=LOG_TOLERANCE, edge=EDGE_FRACTION, margin=margin
    )

    def choose(labels: Labels) -> Indices:
        return best_exposures(taken, labels) if fixed is None else np.full(labels.max(), fixed)

    used = np.ones(stack.shape[:3], bool) if mask is None else mask.copy()
    labels, references = steps.last(region_steps(taken, plain, moved, margin, choose=choose))
    alpha = regions.feather(labels, margin // 2)
    for r, box in enumerate(ndimage.find_objects(labels)):
        wide = regions.pad_box(box, 2 * reference.BOX_SIDE, labels.shape)
        y, x = wide
        inside = labels[wide] == r + 1
        frames = select_frames(taken, wide, int(references[r]), alone=alone)
        if not alone:
            frames |= used[:, y, x] & find_still(taken, wide, plain[wide])
        still = merge(stack[:, y, x], times, g, w, valid=frames)
        E[wide][inside] = regions.blend(E[wide], still.E, alpha[wide])[inside]
        quality[wide][inside] = still.quality[inside]
        used[:, y, x][:, inside] = frames[:, inside]
    return Ghosts(E, quality, labels, references, used, score, alpha)


def note(result: Ghosts, names: Sequence[str]) -> str:
    """Return a sentence that says how much moved, and which photographs are the references there."""
    if not len(result.references):
        return "nothing moved: everywhere the photos differ by no more than noise and edges explain"
    numbers, counts = np.unique(result.references, return_counts=True)
    per_frame = ", ".join(
        f"{names[j]} in {count}" for j, count in zip(numbers, counts, strict=True)
    )
    count = len(result.references)
    percent = 100 * np.mean(result.labels > 0)
    number = "one region" if count == 1 else f"{count} regions"
    text = (
        f"something moved in {number}, {percent:.1f} % of the pixels; reference photos: {per_frame}"
    )
    if percent < WIDESPREAD_PERCENT:
        return text
    return f"{text}; with so many pixels, wrong times or a wrong alignment are more likely"
