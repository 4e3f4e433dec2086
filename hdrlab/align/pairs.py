"""From pairs of photographs to a bracket: who is compared with whom, what was found, where each ends up."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hdrlab.align.bitmaps import Offset
from hdrlab.core.arrays import Array


class Verdict(NamedTuple):
    """What the comparison of two photographs found.

    Attributes
    ----------
    moving, fixed : which two images; they are neighbours in brightness, and the darker one moves
    offset : (dy, dx), pixels, by which `moving` comes to lie on `fixed`
    before, after : disagreement without the offset and with it, from 0, all agrees, to 1
    confidence : 1 is a perfect match, 0 is no better than 8 pixels away
    informative : False where no threshold divides both pictures, so that nothing can be compared
    trouble : why the offset is not to be trusted; empty where it is
    """

    moving: int
    fixed: int
    offset: Offset
    before: float
    after: float
    confidence: float
    informative: bool
    trouble: str

    @property
    def reliable(self) -> bool:
        """Whether nothing speaks against the offset."""
        return not self.trouble


def blind(moving: int, fixed: int) -> Verdict:
    """Return the Verdict on a pair that cannot be compared: stay where you are."""
    reason = "uninformative: no threshold divides both pictures where neither is clipped"
    return Verdict(moving, fixed, (0, 0), 0.0, 0.0, 0.0, False, reason)


def by_brightness(images: Array) -> list[int]:
    """Return the order of the images from dark to bright, judged on every eighth pixel.

    Examples
    --------
    >>> by_brightness(np.array([200, 10, 90], np.uint8)[:, None, None] * np.ones((1, 16, 16), np.uint8))
    [1, 2, 0]
    """
    return [int(j) for j in np.argsort([image[::8, ::8].mean() for image in images], kind="stable")]


def along(verdicts: Sequence[Verdict]) -> NDArray[np.int64]:
    """Return the offsets (P, 2) that lay every image on the middle one, summed along the P - 1 pairs.

    The verdicts run from dark to bright, each pair beginning with the image that ended the one before. A pair
    that is not informative breaks the chain: the image beyond stays where it is, and those behind follow it.
    """
    offsets = np.zeros((len(verdicts) + 1, 2), np.int64)
    middle = (len(verdicts) + 1) // 2
    for verdict in verdicts[middle:]:
        if verdict.informative:
            offsets[verdict.fixed] = offsets[verdict.moving] - verdict.offset
    for verdict in reversed(verdicts[:middle]):
        if verdict.informative:
            offsets[verdict.moving] = offsets[verdict.fixed] + verdict.offset
    return offsets
