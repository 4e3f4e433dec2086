"""Which registration to take: none, whole pixels, rotation too, or a homography. The light decides.

e  error  mean over the pairs of neighbours in brightness of the mean square of d, see `criterion`, over the
          pixels that a pair shows after each of the moves alike, so that none gains by what it leaves out

Of these the simplest is taken whose error is within a twentieth of the least. So by this measure the choice
is never worse than leaving the photographs where they are: that is the simplest of all.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.align import cerman, criterion, homography, mtb
from hdrlab.align.matches import Match, Pair, along, judge, neighbours
from hdrlab.core import warp
from hdrlab.core.arrays import as_stack
from hdrlab.core.steps import last

Float = NDArray[np.float64]
WAYS = ("none", "mtb", "cerman", "homography")  # the simplest first
SLACK = 0.05  # of the least error


class Choice(NamedTuple):
    """Which of WAYS was taken, the error of each, and the matches of the one that was.

    A homography is tried only where `cerman` is in doubt about a pair.
    """

    way: str
    errors: dict[str, float]
    matches: tuple[Match, ...]


def found(pair: Pair, offset: tuple[int, int], ways: Sequence[str]) -> dict[str, Float]:
    """Return the H of a pair that each way finds; `offset` is that of `mtb`."""
    moves = {"none": np.eye(3), "mtb": warp.as_moves([offset])[0]}
    moves["cerman"] = judge(pair, last(cerman.search(pair)).H).H
    if "homography" in ways:
        moves["homography"] = judge(pair, last(homography.search(pair)).H).H
    return moves


def errors(pair: Pair, moves: dict[str, Float]) -> dict[str, float]:
    """Return the e of a pair after each move, over the pixels that it shows after all of them."""
    X = pair.X[0]
    p = criterion.lattice(X.shape[1:])
    d = {way: criterion.differences(X, H, p) for way, H in moves.items()}
    alike = np.all([np.isfinite(one) for one in d.values()], axis=0)
    return {way: criterion.error(np.where(alike, one, np.nan)) for way, one in d.items()}


def chosen(e: dict[str, float]) -> str:
    """Return the simplest way whose error is within SLACK of the least.

    Examples
    --------
    >>> chosen({"none": 0.2, "mtb": 0.101, "cerman": 0.1})
    'mtb'
    """
    least = min(e.values())
    return next(way for way in WAYS if way in e and e[way] <= (1 + SLACK) * least)


def choose(
    images: ArrayLike | Sequence[ArrayLike], *, times: ArrayLike | None = None, g: ArrayLike | None = None
) -> Choice:
    """Return the Choice for a bracket; knobs of `align`."""
    images = as_stack(images)
    offsets = {(one.moving, one.fixed): one.offset for one in mtb.verdicts(images)}
    ways = list(WAYS[:-1])
    choice = _tried(images, times, g, offsets, ways)
    if all(one.reliable for one in choice.matches):
        return choice
    return _tried(images, times, g, offsets, [*ways, "homography"])


def _tried(
    images: ArrayLike,
    times: ArrayLike | None,
    g: ArrayLike | None,
    offsets: dict[tuple[int, int], tuple[int, int]],
    ways: Sequence[str],
) -> Choice:
    """Return the Choice among `ways`."""
    told: list[dict[str, float]] = []
    matches: dict[str, list[Match]] = {way: [] for way in ways}
    for pair in neighbours(images, times, g):
        moves = found(pair, offsets[pair[:2]], ways)
        told.append(errors(pair, moves))
        for way, H in moves.items():
            matches[way].append(judge(pair, H))
    if not told:
        return Choice("none", dict.fromkeys(ways, 0.0), ())
    e = {way: float(np.mean([one[way] for one in told])) for way in ways}
    way = chosen(e)
    return Choice(way, e, tuple(matches[way]))


def verdicts(
    images: ArrayLike | Sequence[ArrayLike], *, times: ArrayLike | None = None, g: ArrayLike | None = None
) -> tuple[Match, ...]:
    """Return the Match of every pair of neighbours in brightness, of the way that is taken."""
    return choose(images, times=times, g=g).matches


def align(
    images: ArrayLike | Sequence[ArrayLike], *, times: ArrayLike | None = None, g: ArrayLike | None = None
) -> Float:
    """Return the moves of whichever registration lays the photographs on each other best.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
        Photographs of one scene with different exposures, in any order.
    times : (P,) seconds, optional
        Their exposures. Without them the ratios come out of the histograms.
    g : (n,) or (n, 3), optional
        The camera's response, ln exposure of each level. Without it the histograms of each pair are matched.

    Returns
    -------
    moves : (P, 3, 3)
        Where pixel (x, y, 1) of each image lies on the one in the middle of their brightness. The identity
        for all where nothing lies better than that.

    Raises
    ------
    ValueError
        For images that are not a stack of photographs, and for times or a response that do not fit them.

    Examples
    --------
    >>> from hdrlab.capture import camera, responses, scenes
    >>> room = scenes.room((120, 180))
    >>> taken = camera.shoot(room, [0.02, 0.08], offsets=[[3, -4], [0, 0]])
    >>> known = {"times": taken.times, "g": responses.true_g()}
    >>> choose(taken.images, **known).way, align(taken.images, **known)[0, :2, 2].tolist()  # dx, dy
    ('mtb', [-4.0, 3.0])
    """
    return along(verdicts(images, times=times, g=g))
