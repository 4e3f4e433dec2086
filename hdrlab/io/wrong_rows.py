"""Find photos in which a band of rows shows something else, by the other photos of the bracket.

Formats without checksums are read without an error where bytes are missing in the middle, repeated or
overwritten: from there on, rows are shifted, come from elsewhere, or are noise.

A table of pixel values predicts each photo from another one. In a damaged band the prediction fails
over the full width, in one photo alone, and from one row to the next. A thing that moves rarely is
as wide as the image, and has no straight edges; water moves in all photos; light that flickers
fades from row to row.
"""

from collections.abc import Sequence

import numpy as np

from hdrlab.core.arrays import F64, Array, Mask

# columns of the image in which the prediction is judged one by one
SECTIONS = 8
# sections in which a row must be wrong
MIN_WRONG_SECTIONS = 6
# fraction of the pixels of a section that must be wrong, and that must be predicted
MIN_WRONG_FRACTION = 0.25
MIN_KNOWN_FRACTION = 0.3
# A pixel is wrong if its error is that many times this quantile of the errors, which a band of half
# of the image does not reach, and so many levels.
ERROR_QUANTILE = 0.35
WRONG_FACTOR = 5
MIN_WRONG_LEVELS = 8
# fraction of the pixels that are wrong outside of a band, at most, and across its edges
MAX_WRONG_OUTSIDE = 0.15
# rows over which a row is judged, and on each side of an edge
EDGE_ROWS = 3
# rows between two bands that make one
MAX_GAP_ROWS = 4
# fraction of the rows that a band has, at least and at most
MIN_BAND_FRACTION = 0.03
MAX_BAND_FRACTION = 0.6
# Levels of black and of clipped pixels predict nothing.
MIN_TELLING_LEVEL = 4
MAX_TELLING_LEVEL = 250
MIN_PIXELS_PER_LEVEL = 8
# fraction of a band that two photos must have in common to be the same
MIN_COMMON_FRACTION = 0.7
# photos that must contradict a band, and agree with each other about its rows
MIN_WITNESSES = 2


def find_wrong_rows(
    sample: Array, frame: int, others: Sequence[int], cache: dict[tuple[int, int], F64]
) -> tuple[int, int] | None:
    """Return the first row of a band that shows something else, and the row behind it, or None.

    Parameters
    ----------
    sample : (P, h, w, C) int
        Photos in levels of 256.
    frame : int
        The photo that is searched.
    others : sequence of int
        The photos that predict it.
    cache : dict
        The fractions of wrong pixels of pairs of photos; this function adds to it.
    """
    bands = {}
    for other in others:
        band = _find_band(_get_wrong_fractions(sample, other, frame, cache))
        if band is not None:
            bands[other] = band
    if len(bands) < MIN_WITNESSES:
        return None
    start = max(first_row for first_row, _ in bands.values())
    stop = min(last_row for _, last_row in bands.values())
    longest = max(last_row - first_row for first_row, last_row in bands.values())
    if stop - start < MIN_COMMON_FRACTION * longest:
        return None
    for other in others:
        wrong = _get_wrong_fractions(sample, other, frame, cache)[start:stop]
        is_known = np.isfinite(wrong)
        if is_known.any() and wrong[is_known].mean() < MIN_WRONG_FRACTION:
            return None  # this photo finds the rows right
    witnesses = list(bands)
    for first in witnesses:
        for second in witnesses:
            if first != second:
                wrong = _get_wrong_fractions(sample, first, second, cache)[start:stop]
                is_known = np.isfinite(wrong)
                if is_known.any() and wrong[is_known].mean() <= MAX_WRONG_OUTSIDE:
                    return start, stop
    return None


def _get_wrong_fractions(
    sample: Array, source: int, target: int, cache: dict[tuple[int, int], F64]
) -> F64:
    """Return the fraction of wrong pixels (h, SECTIONS); NaN where too little is predicted."""
    key = (source, target)
    if key not in cache:
        cache[key] = _measure_wrong_fractions(sample[source], sample[target])
    return cache[key]


def _measure_wrong_fractions(given: Array, shown: Array) -> F64:
    errors = np.full(shown.shape, np.nan, np.float32)
    for channel in range(shown.shape[-1]):
        table = _make_median_table(given[..., channel], shown[..., channel])
        errors[..., channel] = np.abs(table[given[..., channel]] - shown[..., channel])
    is_known = np.isfinite(errors)
    if not is_known.any():
        return np.full((len(shown), SECTIONS), np.nan)
    typical = float(np.quantile(errors[is_known], ERROR_QUANTILE))
    is_wrong = errors > max(MIN_WRONG_LEVELS, WRONG_FACTOR * typical)
    known = _sum_sections(is_known)
    total = _sum_sections(np.ones_like(is_known))
    with np.errstate(divide="ignore", invalid="ignore"):
        wrong = _sum_sections(is_wrong) / known
    wrong[known < MIN_KNOWN_FRACTION * total] = np.nan
    return wrong


def _make_median_table(given: Array, shown: Array) -> F64:
    """Return the median of `shown` for each level of `given`, (256,), NaN where unknown."""
    joint = np.bincount((256 * given.astype(np.int32) + shown).ravel(), minlength=256 * 256)
    cumulative = np.cumsum(joint.reshape(256, 256), axis=1)
    counts = cumulative[:, -1]
    table = np.argmax(2 * cumulative >= counts[:, None], axis=1).astype(np.float64)
    table[counts < MIN_PIXELS_PER_LEVEL] = np.nan
    table[:MIN_TELLING_LEVEL] = np.nan
    table[MAX_TELLING_LEVEL + 1 :] = np.nan
    return table


def _sum_sections(mask: Mask) -> F64:
    """Return how many values of a mask (h, w, C) are true in each section, (h, SECTIONS)."""
    counts = mask.sum(axis=2).astype(np.float64)
    starts = np.linspace(0, mask.shape[1], SECTIONS + 1)[:-1].astype(int)
    summed = np.add.reduceat(counts, starts, axis=1)
    # A few rows together: one row has few pixels.
    padded = np.pad(summed, ((EDGE_ROWS // 2, EDGE_ROWS // 2), (0, 0)), "edge")
    windows = [padded[k : k + len(summed)] for k in range(EDGE_ROWS)]
    return np.asarray(np.sum(windows, axis=0))


def _find_band(wrong: F64) -> tuple[int, int] | None:
    """Return the band of rows that are wrong over the full width, if the others are right."""
    height = len(wrong)
    known_sections = np.isfinite(wrong).sum(axis=1)
    wrong_sections = np.nansum(wrong >= MIN_WRONG_FRACTION, axis=1)
    needed = np.ceil(known_sections * MIN_WRONG_SECTIONS / SECTIONS)
    is_bad = (known_sections >= SECTIONS // 2) & (wrong_sections >= needed)
    rows = np.flatnonzero(is_bad)
    if not len(rows):
        return None
    runs = np.split(rows, np.flatnonzero(np.diff(rows) > MAX_GAP_ROWS) + 1)
    run = max(runs, key=len)
    start = int(run[0])
    stop = int(run[-1]) + 1
    if not MIN_BAND_FRACTION * height <= stop - start <= MAX_BAND_FRACTION * height:
        return None
    if len(run) < MIN_COMMON_FRACTION * (stop - start):
        return None
    # The rows next to the band are right, and so are the others.
    above = wrong[max(start - 2 * EDGE_ROWS, 0) : max(start - EDGE_ROWS // 2, 0)]
    below = wrong[stop + EDGE_ROWS // 2 : stop + 2 * EDGE_ROWS]
    outside = np.concatenate([wrong[: max(start - EDGE_ROWS, 0)], wrong[stop + EDGE_ROWS :]])
    for rest in (above, below, outside):
        if np.isfinite(rest).any() and np.nanmean(rest) > MAX_WRONG_OUTSIDE:
            return None
    return (start, stop) if np.isfinite(outside).any() else None
