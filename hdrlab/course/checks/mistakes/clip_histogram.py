"""Known mistakes in `clip_histogram`, the task of hdrlab.tonemap.brush.clip_histogram."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "clip_histogram_excess_lost",
    says="You cut the high bins and drop the rest, so the sum is less than 1. Distribute the "
    "excess over the other bins.",
)
def excess_lost(h, *, limit=4.0):
    return np.minimum(h, min(limit / len(h), 1.0))


@mistake(
    "clip_histogram_distributed_evenly",
    says="You give all bins the same part of the excess, so some end up above the limit. "
    "Distribute it in proportion to the room below the limit.",
)
def distributed_evenly(h, *, limit=4.0):
    h = np.minimum(h, min(limit / len(h), 1.0))
    return h + (1 - h.sum()) / len(h)


@mistake(
    "clip_histogram_stretched",
    says="You divide the cut histogram by its sum, so the high bins are above the limit again. "
    "Distribute the excess in proportion to the room.",
)
def stretched(h, *, limit=4.0):
    h = np.minimum(h, min(limit / len(h), 1.0))
    return h / h.sum()


@mistake(
    "clip_histogram_low_bins_share_evenly",
    says="You give all bins below the limit the same part of the excess, so some end up above it. "
    "Distribute it in proportion to the room.",
)
def low_bins_share_evenly(h, *, limit=4.0):
    top = min(limit / len(h), 1.0)
    is_low = h < top
    clipped = np.minimum(h, top)
    return clipped + is_low * (1 - clipped.sum()) / max(np.count_nonzero(is_low), 1)
