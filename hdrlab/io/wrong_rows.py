"""Find photos in which a band of rows shows something else, by the other photos of the bracket.

Formats without checksums are read without an error where bytes are missing in the middle, repeated or
overwritten: from there on, rows are shifted, come from elsewhere, or are noise.

A table of pixel values predicts each photo from another one. In a damaged band the prediction fails
over the full width, in one photo alone, and from one row to the next. A thing that moves rarely is
as wide as the image, and has no straight edges; water moves in all photos; light that flickers
fades from row to row.

A camera in the hand moves, so photos are shifted onto each other first. Shifted rows stay unnoticed
where the next photo is largely clipped: then the rows seem to be what moved.
"""

from collections.abc import Sequence

import numpy as np

from hdrlab.core.arrays import F64, Array, Mask, to_256
from hdrlab.io.band_shifts import measure_shift

# columns of the image in which the prediction is judged one by one
SECTION_COUNT = 8
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


class PhotoComparison:
    """The photos of a bracket, each predicted from others, in a small sample.

    A camera in the hand moves from photo to photo, so each photo is shifted onto the one that it
    predicts. What is known of a pair is computed once.

    Parameters
    ----------
    images : (P, H, W, C) uint8 or uint16
    step, column_step : int
        Every `step`-th row and every `column_step`-th column is compared.
    """

    def __init__(self, images: Array, step: int, column_step: int) -> None:
        self.images = images
        self.step = step
        self.column_step = column_step
        self._shifts: dict[tuple[int, int], tuple[int, int]] = {}
        self._wrong_fractions: dict[tuple[int, int], F64] = {}

    def get_shift(self, source: int, target: int) -> tuple[int, int]:
        """Return (dy, dx) in pixels by which `source` must move to lie on `target`."""
        key = (source, target)
        if key not in self._shifts:
            green = min(1, self.images.shape[-1] - 1)
            moving = to_256(self.images[source, ..., green])
            dy, dx = measure_shift(moving, to_256(self.images[target, ..., green]))
            self._shifts[key] = (dy, dx)
            self._shifts[target, source] = (-dy, -dx)
        return self._shifts[key]

    def get_wrong_fractions(self, source: int, target: int) -> F64:
        """Return the fraction of wrong pixels (h, SECTION_COUNT); NaN where too little is predicted."""
        key = (source, target)
        if key not in self._wrong_fractions:
            shift = self.get_shift(source, target)
            given = self._take_sample(source, shift)
            shown = self._take_sample(target, (0, 0))
            self._wrong_fractions[key] = _measure_wrong_fractions(given, shown)
        return self._wrong_fractions[key]

    def _take_sample(self, frame: int, shift: tuple[int, int]) -> Array:
        """Return a photo that is shifted, (h, w, C) in levels of 256; 0 where it shows nothing."""
        image = self.images[frame]
        height, width = image.shape[:2]
        y = np.arange(0, height, self.step) - shift[0]
        x = np.arange(0, width, self.column_step) - shift[1]
        rows = np.flatnonzero((y >= 0) & (y < height))
        columns = np.flatnonzero((x >= 0) & (x < width))
        sample = np.zeros((len(y), len(x), image.shape[2]), np.uint8)
        sample[np.ix_(rows, columns)] = to_256(image[np.ix_(y[rows], x[columns])])
        return sample

    def move_rows(self, rows: slice, source: int, target: int) -> slice:
        """Return the rows of the sample of `target` that show what `rows` of `source` show."""
        down = round(self.get_shift(source, target)[0] / self.step)
        return slice(max(rows.start + down, 0), max(rows.stop + down, 0))


def find_wrong_rows(
    photos: PhotoComparison, frame: int, others: Sequence[int]
) -> tuple[int, int] | None:
    """Return the first row of a band that shows something else, and the row behind it, or None.

    Parameters
    ----------
    photos : PhotoComparison
    frame : int
        The photo that is searched.
    others : sequence of int
        The photos that predict it.
    """
    bands = {}
    for other in others:
        band = _find_band(photos.get_wrong_fractions(other, frame))
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
        wrong = photos.get_wrong_fractions(other, frame)[start:stop]
        is_known = np.isfinite(wrong)
        if is_known.any() and wrong[is_known].mean() < MIN_WRONG_FRACTION:
            return None  # this photo finds the rows right
    # Clouds and water change in all photos: then the others contradict each other, too.
    has_agreement = False
    for first in others:
        for second in others:
            if first == second:
                continue
            rows = photos.move_rows(slice(start, stop), frame, second)
            wrong = photos.get_wrong_fractions(first, second)
            inside = wrong[rows]
            outside = np.delete(wrong, rows, axis=0)
            if not np.isfinite(inside).any():
                continue
            wrong_fraction = np.nanmean(inside)
            predicts_others = np.isfinite(outside).any() and np.nanmean(outside) < MAX_WRONG_OUTSIDE
            if wrong_fraction >= MIN_WRONG_FRACTION and predicts_others:
                return None
            is_witness = first in bands and second in bands
            has_agreement |= bool(is_witness and wrong_fraction <= MAX_WRONG_OUTSIDE)
    return (start, stop) if has_agreement else None


def _measure_wrong_fractions(given: Array, shown: Array) -> F64:
    errors = np.full(shown.shape, np.nan, np.float32)
    for channel in range(shown.shape[-1]):
        table = _make_median_table(given[..., channel], shown[..., channel])
        errors[..., channel] = np.abs(table[given[..., channel]] - shown[..., channel])
    is_known = np.isfinite(errors)
    if not is_known.any():
        return np.full((len(shown), SECTION_COUNT), np.nan)
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
    """Return how many values of a mask (h, w, C) are true in each section, (h, SECTION_COUNT)."""
    counts = mask.sum(axis=2).astype(np.float64)
    starts = np.linspace(0, mask.shape[1], SECTION_COUNT + 1)[:-1].astype(int)
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
    needed = np.ceil(known_sections * MIN_WRONG_SECTIONS / SECTION_COUNT)
    is_bad = (known_sections >= SECTION_COUNT // 2) & (wrong_sections >= needed)
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
