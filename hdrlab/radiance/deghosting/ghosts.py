"""Ghosts: what moved between the photographs stands in the map several times, half transparent.

Z        pixel levels      (P, H, W[, 3])
score    contradiction     (H, W), 1 is what noise and edges explain: see `deviation`
labels   regions           (H, W) int32, 1 ... R, 0 elsewhere
frames   best exposures    (R,), the frame that leads each region
shown    (P, H, W) bool    which frames make a pixel's radiance

The slide's way: weighted variance, threshold, dilation, regions, and in each region the best exposure. Two
things are added. Edges of high contrast have variance as well; what they explain does not count. And in a
region the best exposure leads, but other frames join it where they agree with it (`agreement`): so its
clipped and its dark pixels are not lost, nor is its noise all there is. `alone` leaves them out, as on the
slide.

One frame per region means one moment per region: who walks through the picture in great steps may be quality
twice, or never. With a `reference`, that frame leads in every region, and the map shows its moment.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage

from hdrlab.core import weights
from hdrlab.core.arrays import Array, as_mask, as_stack, as_times, levels
from hdrlab.core.steps import last
from hdrlab.radiance.deghosting import agreement, deviation
from hdrlab.radiance.deghosting.deviation import Deviation
from hdrlab.radiance.deghosting.frames import Photographs, photographs
from hdrlab.radiance.deghosting.regions import (
    Box,
    Labels,
    Mask,
    blended,
    dilated,
    grown,
    labelled,
    padded,
    seam,
    seeds,
)
from hdrlab.radiance.merge import Merged, merge_with_quality

Float = NDArray[np.float32]
TAU = 0.1  # ln E: what photographs of a still scene contradict each other by, noise and edges aside
EDGE = 0.35  # of the range of ln E over 3 x 3 pixels; 0.5 is all that a shift of a pixel can do
REACH = 4  # margins that a region grows at once
MOST = 50  # per cent of the pixels: where more than these contradict each other, it is hardly motion
ROUNDS = 4  # of growing: a leader's figure is found in one or two


class Led(NamedTuple):
    """Regions (H, W), labelled 1 ... R, and the frame (R,) that leads in each."""

    labels: Labels
    frames: NDArray[np.int64]


class Ghosts(NamedTuple):
    """A map without ghosts, and how it was made.

    Attributes
    ----------
    E : (H, W) or (H, W, 3) float32, the map; outside the regions it is the plain one
    quality : (H, W) uint8, how each pixel is known, flags of `merge.Quality`
    labels : (H, W) int32, the regions 1 ... R; 0 where nothing moved
    frames : (R,) int, the frame that leads in each region
    shown : (P, H, W) bool, the frames that make each pixel, in the order of the images given
    score : (H, W) float32, contradiction over what noise and edges explain
    """

    E: Float
    quality: NDArray[np.uint8]
    labels: Labels
    frames: NDArray[np.int64]
    shown: NDArray[np.bool_]
    score: Float


def detect(found: Deviation, *, tau: float, edge: float, margin: int) -> tuple[Float, Mask]:
    """Return the score (H, W) and the mask (H, W) of what moved; the knobs are those of `remove`.

    Seeds have a score above 1. From them the mask grows over what contradicts half as much, edges counted for
    little, and then by the margin.
    """
    score = deviation.score(found, tau=tau, edge=edge)
    seed = seeds(score)
    if not seed.any():
        return score, seed
    weak = deviation.score(found, tau=tau / 2, edge=edge / 5) > 1
    return score, dilated(grown(seed, weak, REACH * margin), margin)


def losses(taken: Photographs) -> NDArray[np.float32]:
    """Return what a level costs, (P, C, n): the variance of its ln E; 1, the most, if it measures nothing."""
    cost = np.minimum(taken.s2, 1.0)
    cost[..., 0] = cost[..., taken.top :] = 1
    return cost.astype(np.float32)


def exposures(taken: Photographs, labels: Labels) -> NDArray[np.float64]:
    """Return the mean loss of each frame in each region, (P, R)."""
    cost, boxes = losses(taken), ndimage.find_objects(labels)
    out = np.ones((len(taken.images), len(boxes)))
    for j, r in np.ndindex(*out.shape):
        inside = labels[boxes[r]] == r + 1
        Z = taken.images[j][boxes[r]][inside]
        loss = np.mean([cost[j, c][Z[:, c]] for c in range(Z.shape[1])], axis=0)
        quality = True if taken.valid is None else taken.valid[j][boxes[r]][inside]
        out[j, r] = np.where(quality, loss, 1).mean()
    return out


def leaders(taken: Photographs, labels: Labels, reference: int | None = None) -> NDArray[np.int64]:
    """Return the frame that leads in each region (R,): its best exposure, of least loss, or the reference."""
    loss = exposures(taken, labels)
    return loss.argmin(axis=0) if reference is None else np.full(loss.shape[1], reference)


def contradicted(taken: Photographs, box: Box, lead: int, E: Float) -> Mask:
    """Return where a photograph does not agree with the map E (h, w, C) of a box."""
    nothing = np.zeros_like(E)
    plain = agreement.Known(E, nothing, np.ones(E.shape, bool), nothing, np.full_like(E, np.inf))
    return ~agreement.agrees(agreement.reading(taken, lead, box), plain, tau=2 * agreement.TAU)


def led_steps(
    taken: Photographs, E: Float, moved: Mask, margin: int, *, reference: int | None = None
) -> Iterator[Led]:
    """Yield the regions and the frame that leads in each, until no region cuts off what its leader saw.

    A region must hold the whole figure as it stands in the frame that leads there. Where that frame's
    photograph contradicts the plain map E (H, W, C) beside the region, that grows, and may meet another.
    """
    for _ in range(ROUNDS):
        labels = labelled(moved)
        frames = leaders(taken, labels, reference)
        yield Led(labels, frames)
        wider = moved.copy()
        for r, box in enumerate(ndimage.find_objects(labels)):
            wide = padded(box, REACH * margin, labels.shape)
            beside = contradicted(taken, wide, int(frames[r]), E[wide])
            wider[wide] |= grown(labels[wide] == r + 1, beside, REACH * margin)
        if np.array_equal(wider, moved):
            return
        moved = dilated(wider, margin // 2)


def followers(taken: Photographs, box: Box, lead: int, *, alone: bool) -> Mask:
    """Return which frames make a box's pixels, (P, h, w): those that agree with the leader, or it alone."""
    if not alone:
        return agreement.following(taken, lead, box)
    follow = np.zeros((len(taken.images), *taken.images[0][box].shape[:2]), bool)
    follow[lead] = True if taken.valid is None else taken.valid[lead][box]
    return follow


def around(images: Array) -> int:
    """Return the margin that suits photographs of this size: a 150th of their width, at least 4 pixels."""
    return max(4, round(images.shape[2] / 150))


def remove(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    w: ArrayLike | None = None,
    *,
    merged: Merged | None = None,
    merge: Callable[..., Merged] = merge_with_quality,
    reference: int | None = None,
    alone: bool = False,
    tau: float = TAU,
    edge: float = EDGE,
    margin: int | None = None,
    top: float = 0.98,
    valid: ArrayLike | None = None,
    **knobs: Any,
) -> Ghosts:
    """Return the radiance map of a bracket in which something moved, without ghosts.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16, aligned photographs, in any order
    times : (P,) seconds
    g : (n,) or (n, 3), response, ln exposure of each level
    w : (n,), weights; the hat by default
    merged : the plain map of `merge_with_quality`, where it is known; else it is made here
    merge : `merge_with_quality`, or its fast form
    reference : number of the frame that leads in every region; by default each has its own best exposure
    alone : nothing but the leading frame counts in a region, as on the slide
    tau : contradiction, in ln E, that is tolerated everywhere
    edge : share of a frame's range of ln E over 3 x 3 pixels that is tolerated besides; at 0.5 no edge that
        is shifted by up to a pixel counts
    margin : pixels by which regions are dilated, and over which seams are blended; by default 1 in 150 of
        the width, at least 4
    top, valid, **knobs : of `merge_with_quality`

    Returns
    -------
    Ghosts
        Where nothing moved there is no region, and E is the plain map, bit for bit.

    Raises
    ------
    ValueError
        For arrays that do not fit together, and knobs out of their range.

    References
    ----------
    Chuang, High dynamic range imaging (slides), "Automatic ghost removal"; Reinhard, Ward, Pattanaik and
    Debevec, High Dynamic Range Imaging, 2005, on ghosts.

    Examples
    --------
    >>> from hdrlab.capture import movers, responses
    >>> wall = np.full((60, 90), 0.5, np.float32)
    >>> ball = movers.ball((60, 90), (30, 45), 9, 2.0)
    >>> taken = movers.shoot(wall, ball, movers.path(3, (0, 25)), [0.25, 0.5, 1.0])
    >>> found = remove(taken.bracket.images, taken.bracket.times, responses.true_g("film"))
    >>> found.labels.max(), found.E.shape
    (np.int32(1), (60, 90))
    """
    stack = as_stack(images)
    seconds, mask, n = as_times(times, len(stack)), as_mask(valid, stack), levels(stack)
    _check(len(stack), reference, tau, edge, margin)
    margin = around(stack) if margin is None else margin
    w = weights.hat(n) if w is None else w
    knobs |= {"top": top}
    E, quality = merge(stack, seconds, g, w, valid=mask, **knobs) if merged is None else merged
    taken = photographs(stack, seconds, g, E, top=top, valid=mask)
    score, moved = detect(deviation.deviation(taken, w), tau=tau, edge=edge, margin=margin)
    plain = E.reshape(taken.images.shape[1:])
    labels, frames = last(led_steps(taken, plain, moved, margin, reference=reference))
    alpha = seam(labels, margin // 2)
    E, quality = E.copy(), quality.copy()
    shown = np.ones(stack.shape[:3], bool) if mask is None else mask.copy()
    for r, box in enumerate(ndimage.find_objects(labels)):
        y, x = wide = padded(box, 2 * agreement.BOX, labels.shape)
        here = labels[wide] == r + 1
        follow = followers(taken, wide, int(frames[r]), alone=alone)
        led = merge(stack[:, y, x], seconds, g, w, valid=follow, **knobs)
        E[wide][here] = blended(E[wide], led.E, alpha[wide])[here]
        quality[wide][here] = led.quality[here]
        shown[:, y, x][:, here] = follow[:, here]
    return Ghosts(E, quality, labels, frames, shown, score)


def note(found: Ghosts, names: Sequence[str]) -> str:
    """Return the sentence on what moved, and which photographs lead where it did."""
    if not len(found.frames):
        return "nothing moved: no region contradicts itself by more than noise and edges explain"
    numbers, counts = np.unique(found.frames, return_counts=True)
    led = ", ".join(f"{names[j]} in {count}" for j, count in zip(numbers, counts, strict=True))
    count, share = len(found.frames), 100 * np.mean(found.labels > 0)
    regions = "one region" if count == 1 else f"{count} regions"
    said = f"something moved in {regions}, {share:.1f} % of the pixels; photographs that lead there: {led}"
    return said if share < MOST else f"{said}; so much is rather a matter of times or of alignment"


def _check(count: int, reference: int | None, tau: float, edge: float, margin: int | None) -> None:
    if reference is not None and reference not in range(count):
        raise ValueError(
            f"expected a reference from 0 to {count - 1}, the number of a frame, got {reference}"
        )
    if not (0 < tau < np.inf and 0 <= edge < np.inf):
        raise ValueError(f"expected a positive tau, and an edge of at least 0, got {tau} and {edge}")
    if margin is not None and margin < 0:
        raise ValueError(f"expected a margin of at least 0 pixels, got {margin}")
