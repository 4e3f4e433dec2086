"""Known mistakes in `equalise`, the task of hdrlab.tonemap.brush.equalise."""

import numpy as np

from hdrlab.core.colour import decode_srgb
from hdrlab.course.checks.mistakes import mistake
from hdrlab.tonemap.brush import bin_position, clip_histogram, cumulative, find_range, histogram


@mistake(
    "equalise_not_in_logarithms",
    says="Your bins are equally wide in L, so the dark pixels share a few of them. Divide ln L "
    "into bins.",
)
def not_in_logarithms(L, *, bins=1024, limit=4.0):
    low, high = find_range(L)
    t = (L - low) * (bins / (high - low))
    P = cumulative(clip_histogram(histogram(t, bins), limit=limit))
    return np.interp(t, np.arange(bins + 1), decode_srgb(P))


@mistake(
    "equalise_not_clipped",
    says="You equalize completely, so a flat surface gets most of the codes. Clip the histogram at "
    "the limit first.",
)
def not_clipped(L, *, bins=1024, limit=4.0):
    low, high = find_range(L)
    t = bin_position(L, low, high, bins)
    P = cumulative(histogram(t, bins))
    return np.interp(t, np.arange(bins + 1), decode_srgb(P))


@mistake(
    "equalise_not_decoded",
    says="You return the code P. The display luminance is what a display shows for this code: "
    "decode it as sRGB.",
)
def not_decoded(L, *, bins=1024, limit=4.0):
    low, high = find_range(L)
    t = bin_position(L, low, high, bins)
    P = cumulative(clip_histogram(histogram(t, bins), limit=limit))
    return np.interp(t, np.arange(bins + 1), P)


@mistake(
    "equalise_from_minimum_to_maximum",
    says="Your bins reach to the darkest and the brightest pixel, which may be defective. Use the "
    "second smallest and the second largest luminance.",
)
def from_minimum_to_maximum(L, *, bins=1024, limit=4.0):
    low = float(L.min())
    high = float(L.max())
    widening = max(1.0, 2 * low / high) ** 0.5
    t = bin_position(L, low / widening, high * widening, bins)
    P = cumulative(clip_histogram(histogram(t, bins), limit=limit))
    return np.interp(t, np.arange(bins + 1), decode_srgb(P))


@mistake(
    "equalise_flat_window_stretched",
    says="You stretch a flat window from black to white, and so show its noise. Let the bins span a "
    "factor of 2 at least.",
)
def flat_window_stretched(L, *, bins=1024, limit=4.0):
    ordered = np.sort(L, axis=None)
    t = bin_position(L, float(ordered[1]), float(ordered[-2]), bins)
    P = cumulative(clip_histogram(histogram(t, bins), limit=limit))
    return np.interp(t, np.arange(bins + 1), decode_srgb(P))
