"""Ghosts: what moved between the photographs stands in the map several times, half transparent.

Z           pixel levels      (P, H, W[, 3])
score       contradiction     (H, W), 1 is what noise and edges explain: see `deviation`
labels      regions           (H, W) int32, 1 ... R, 0 elsewhere
references  best exposures    (R,), the reference frame of each region
used        (P, H, W) bool    which frames make a pixel's radiance

The plain way: weighted variance, threshold, dilation, regions, and in each region the best
exposure. Two things are added. Edges of high contrast have variance as well; what they explain does
not count. And in a region the best exposure is the reference, but other frames join it where they
are consistent with it: see `reference`. So its clipped and its dark pixels are not lost, nor is its
noise all there is.

One frame per region means one moment per region: who walks through the picture in great steps may
appear twice, or never. With one reference for all regions, the map shows its moment.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from scipy import ndimage

from hdrlab.core import weights
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

# margins that a region grows at once
REACH = 4
# per cent of the pixels: where more than these contradict each other, it is hardly motion
WIDESPREAD = 50
# of growing: the figure in a reference frame is found in one or two
ROUNDS = 4
# contradiction, in ln E, that is tolerated everywhere, noise and edges aside
TAU = 0.1
# share of a frame's range of ln E over 3 x 3 pixels that is tolerated besides: at 0.5 no edge
# counts that is shifted by up to a pixel
EDGE = 0.35


class Regions(NamedTuple):
    """Regions (H, W), labelled 1 ... R, and the reference frame (R,) of each."""

    labels: Labels
    references: Indices


class Ghosts(NamedTuple):
    """A map without ghosts, and how it was made.

    Attributes
    ----------
    E : (H, W) or (H, W, 3) float32, the map; outside the regions it is the plain one
    quality : (H, W) uint8, pixel quality flags of `merge.Quality`
    labels : (H, W) int32, the regions 1 ... R; 0 where nothing moved
    references : (R,) int, the reference frame of each region
    used : (P, H, W) bool, the frames that make each pixel, in the order of the images given
    score : (H, W) float32, contradiction over what noise and edges explain
    """

    E: F32
    quality: Flags
    labels: Labels
    references: Indices
    used: Mask
    score: F32


def detect_motion(
    found: deviation.Deviation, *, tau: float, edge: float, margin: int
) -> tuple[F32, Mask]:
    """Return the score (H, W) and the mask (H, W) of what moved: see TAU and EDGE.

    Seeds have a score above 1. From them the mask grows over what contradicts half as much, edges
    counted for little, and then by the margin.
    """
    score = deviation.score_contradiction(found, tau=tau, edge=edge)
    seed = regions.find_seeds(score)
    if not seed.any():
        return score, seed
    weak = deviation.score_contradiction(found, tau=tau / 2, edge=edge / 5) > 1
    return score, regions.dilate(regions.grow(seed, weak, REACH * margin), margin)


def find_contradictions(taken: Calibrated, box: regions.Box, j: int, E: F32) -> Mask:
    """Return where a photograph is not consistent with the map E (h, w, C) of a box."""
    nothing = np.zeros_like(E)
    plain = reference.Estimate(E, nothing, np.ones(E.shape, bool), nothing, np.full_like(E, np.inf))
    return ~reference.find_consistent(
        reference.read_frame(taken, j, box), plain, tau=2 * reference.TAU
    )


def region_steps(
    taken: Calibrated, E: F32, moved: Mask, margin: int, *, choose: Callable[[Labels], Indices]
) -> Iterator[Regions]:
    """Yield the regions and their reference frames, until no region cuts off a figure of its reference.

    A region must hold the whole figure as it stands in its reference frame, which `choose` gives.
    Where that photograph contradicts the plain map E (H, W, C) beside the region, that grows, and
    may meet another.
    """
    for _ in range(ROUNDS):
        labels = regions.label(moved)
        chosen = choose(labels)
        yield Regions(labels, chosen)
        wider = moved.copy()
        for r, box in enumerate(ndimage.find_objects(labels)):
            wide = regions.pad_box(box, REACH * margin, labels.shape)
            beside = find_contradictions(taken, wide, int(chosen[r]), E[wide])
            wider[wide] |= regions.grow(labels[wide] == r + 1, beside, REACH * margin)
        if np.array_equal(wider, moved):
            return
        moved = regions.dilate(wider, margin // 2)


def select_frames(taken: Calibrated, box: regions.Box, j: int, *, alone: bool) -> Mask:
    """Return which frames make a box, (P, h, w): those consistent with the reference, or it alone."""
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
    most: float = np.inf,
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
    alone : nothing but the reference frame counts in a region, the plain way
    most : per cent of the pixels; where regions hold so many, the map stays the plain one
    merged : the plain map of `merge`, where it is known; else it is made here
    valid : (P, H, W) bool, optional, False where a photograph holds no picture
    merge : `merge_with_quality`, of `radiance.merge` or of `fast.merge`

    Returns
    -------
    Ghosts
        Where nothing moved there is no region, and E is the plain map, bit for bit.

    Raises
    ------
    ValueError
        For arrays that do not fit together, and a reference that is no frame.

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
    found = deviation.measure_deviation(taken, w)
    found.v[deviation.find_clipped_elsewhere(taken, plain)] = (
        np.inf
    )  # no edge and no noise explains that
    score, moved = detect_motion(found, tau=TAU, edge=EDGE, margin=margin)

    def choose(labels: Labels) -> Indices:
        return best_exposures(taken, labels) if fixed is None else np.full(labels.max(), fixed)

    used = np.ones(stack.shape[:3], bool) if mask is None else mask.copy()
    for labels, chosen in region_steps(taken, plain, moved, margin, choose=choose):
        if 100 * np.mean(labels > 0) >= most:  # and it would grow
            return Ghosts(E, quality, labels, chosen, used, score)
    alpha = regions.feather(labels, margin // 2)
    for r, box in enumerate(ndimage.find_objects(labels)):
        y, x = wide = regions.pad_box(box, 2 * reference.BOX, labels.shape)
        here = labels[wide] == r + 1
        frames = select_frames(taken, wide, int(chosen[r]), alone=alone)
        still = merge(stack[:, y, x], times, g, w, valid=frames)
        E[wide][here] = regions.blend(E[wide], still.E, alpha[wide])[here]
        quality[wide][here] = still.quality[here]
        used[:, y, x][:, here] = frames[:, here]
    return Ghosts(E, quality, labels, chosen, used, score)


def note(found: Ghosts, names: Sequence[str]) -> str:
    """Return the sentence on what moved, and which photographs are the references there."""
    if not len(found.references):
        return "nothing moved: no region contradicts itself by more than noise and edges explain"
    numbers, counts = np.unique(found.references, return_counts=True)
    per_frame = ", ".join(
        f"{names[j]} in {count}" for j, count in zip(numbers, counts, strict=True)
    )
    count = len(found.references)
    share = 100 * np.mean(found.labels > 0)
    number = "one region" if count == 1 else f"{count} regions"
    text = f"something moved in {number}, {share:.1f} % of the pixels; reference photographs: {per_frame}"
    return (
        text
        if share < WIDESPREAD
        else f"{text}; so much is rather a matter of times or of alignment"
    )
