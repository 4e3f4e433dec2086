"""Find photos of which a band of rows is missing, by the other photos of the bracket.

Formats without checksums, such as uncompressed TIFF and RAW, are read without an error where a part
of the file is missing: some rows become black or gray.

The other photos tell what a photo should show. From the rows outside of the band, a table predicts
its pixel values from those of another photo. A band of one constant value over the full width is
damaged if every other photo that predicts it predicts other values. Clipped skies, black borders and
letterboxes are constant, too, but they are predicted to be so. For rows that are shifted, come from
elsewhere or are noise, see `io.wrong_rows`.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hdrlab.core.arrays import F64, Array, Mask, to_256
from hdrlab.io import wrong_rows

# Rows and columns of a photo that are compared.
MAX_ROWS = 512
MAX_COLUMNS = 256
# Rows of that sample in which other damage than a constant color is searched.
MAX_SMALL_ROWS = 192
# Brackets of more photos are searched only for constant bands.
MAX_SEARCHED_PHOTOS = 32
# Fewer photos could not do without one.
MIN_PHOTOS = 3
# Photos of similar brightness with which each photo is compared.
NEIGHBOR_COUNT = 4
# A band has at least this fraction of the rows, and so has the rest of the photo.
MIN_BAND_FRACTION = 0.03
MIN_REST_FRACTION = 0.1
# Levels of 256 by which a pixel differs from its prediction.
MIN_WRONG_LEVELS = 24
# Pixels with a level without which nothing is predicted from it.
MIN_PIXELS_PER_LEVEL = 8
# Levels of black and of clipped pixels predict nothing.
MIN_TELLING_LEVEL = 4
MAX_TELLING_LEVEL = 250
# A table is used if this fraction of the pixels outside of the band fits it.
MIN_FITTING_FRACTION = 0.9
# Fractions of the pixels of a damaged band whose prediction is known, and of those that are wrong.
MIN_KNOWN_FRACTION = 0.3
MIN_WRONG_FRACTION = 0.5


@dataclass(frozen=True)
class DamagedBand:
    """A photo, the first row of its damaged band, the row behind its last, and what it shows."""

    frame: int
    start: int
    stop: int
    is_constant: bool = True


def find_damaged_bands(
    images: Array, *, valid: Mask | None = None, only_constant: bool = False
) -> list[DamagedBand]:
    """Return the damaged bands of the photos of a bracket, at most one for each photo.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        The photos in any order; they need not be aligned.
    valid : (P, H, W) bool, optional
        False where a photo has no image. Such a bracket is not searched: its borders are bands.
    only_constant : bool
        Whether to search only for bands of one constant value, which is quicker. It is enough for
        formats whose decoders find shifted or overwritten rows themselves.

    Returns
    -------
    list of DamagedBand
        Empty for fewer than three photos.

    Examples
    --------
    >>> scene = np.random.default_rng(1).integers(1, 60, (64, 64)).repeat(4, axis=1)
    >>> images = np.stack([scene, 2 * scene, 4 * scene]).astype(np.uint8)
    >>> find_damaged_bands(images)
    []
    >>> images[1, 40:] = 0
    >>> find_damaged_bands(images)
    [DamagedBand(frame=1, start=40, stop=64, is_constant=True)]
    """
    if len(images) < MIN_PHOTOS or valid is not None:
        return []
    height, width = images.shape[1:3]
    step = max(1, height // MAX_ROWS)
    sample = to_256(images[:, ::step, :: max(1, width // MAX_COLUMNS)])
    sample = sample.reshape(*sample.shape[:3], -1)
    by_brightness = np.argsort(sample.mean(axis=(1, 2, 3)), kind="stable")
    further_step = -(-sample.shape[1] // MAX_SMALL_ROWS)
    small_step = step * further_step
    column_step = max(1, width // MAX_COLUMNS) * further_step
    comparison = wrong_rows.PhotoComparison(
        images.reshape(*images.shape[:3], -1), small_step, column_step
    )
    found = []
    for frame in range(len(images)):
        others = _choose_neighbors(by_brightness, frame)
        rows = _find_constant_band(sample, frame, others)
        if rows:
            start, stop = rows
            found.append(DamagedBand(frame, start * step, min(stop * step, height)))
            continue
        if only_constant or len(images) > MAX_SEARCHED_PHOTOS:
            continue
        rows = wrong_rows.find_wrong_rows(comparison, frame, others)
        if rows:
            start, stop = rows
            found.append(
                DamagedBand(frame, start * small_step, min(stop * small_step, height), False)
            )
    return found


def _choose_neighbors(by_brightness: Array, frame: int) -> list[int]:
    """Return the photos whose brightness is nearest to that of a photo in rank."""
    rank = np.empty(len(by_brightness), int)
    rank[by_brightness] = np.arange(len(by_brightness))
    distance = np.abs(rank - rank[frame])
    nearest = np.argsort(distance, kind="stable")
    return [int(k) for k in nearest if k != frame][:NEIGHBOR_COUNT]


def _find_constant_band(sample: Array, frame: int, others: Sequence[int]) -> tuple[int, int] | None:
    """Return the largest band of one constant value that the other photos do not have, if any."""
    photo = sample[frame]
    is_constant = np.all(photo == photo[:, :1], axis=(1, 2))
    if not is_constant.any():
        return None
    is_continued = np.all(photo[1:, 0] == photo[:-1, 0], axis=1) & is_constant[1:]
    starts = np.flatnonzero(is_constant & ~np.append(False, is_continued & is_constant[:-1]))
    bands = []
    for start in starts.tolist():
        stop = start + 1
        while stop < len(photo) and is_constant[stop] and is_continued[stop - 1]:
            stop += 1
        bands.append((start, stop))
    start, stop = max(bands, key=lambda band: band[1] - band[0])
    if not _has_band_size(start, stop, len(photo)):
        return None
    votes = []
    for other in others:
        wrong = _measure_wrong_fraction(sample, other, frame, start, stop)
        if wrong is not None:
            votes.append(wrong >= MIN_WRONG_FRACTION)
    return (start, stop) if votes and all(votes) else None


def _has_band_size(start: int, stop: int, height: int) -> bool:
    size = stop - start
    return size >= MIN_BAND_FRACTION * height and height - size >= MIN_REST_FRACTION * height


def _measure_wrong_fraction(
    sample: Array, source: int, target: int, start: int, stop: int
) -> float | None:
    """Return the fraction of a band of `target` that is not as `source` predicts it.

    None if nothing can be predicted: the rest of the photos does not fit, or most is unknown.
    """
    table = _make_table(sample, source, target, start, stop)
    if table is None:
        return None
    predicted = _predict(table, sample[source, start:stop])
    is_known = predicted >= 0
    if is_known.mean() < MIN_KNOWN_FRACTION:
        return None
    is_wrong = np.abs(predicted - sample[target, start:stop]) > MIN_WRONG_LEVELS
    return float(is_wrong[is_known].mean())


def _make_table(sample: Array, source: int, target: int, start: int, stop: int) -> F64 | None:
    """Return the mean levels of one photo for each level of another, (C, 256), -1 where unknown.

    They are those of all rows but a band. None if too few of these pixels fit.
    """
    is_rest = np.ones(len(sample[source]), bool)
    is_rest[start:stop] = False
    given = sample[source, is_rest]
    shown = sample[target, is_rest]
    table = np.full((given.shape[-1], 256), -1.0)
    for channel in range(given.shape[-1]):
        levels = given[..., channel].ravel()
        counts = np.bincount(levels, minlength=256)
        sums = np.bincount(levels, shown[..., channel].ravel(), minlength=256)
        is_known = counts >= MIN_PIXELS_PER_LEVEL
        is_known[:MIN_TELLING_LEVEL] = False
        is_known[MAX_TELLING_LEVEL + 1 :] = False
        table[channel, is_known] = sums[is_known] / counts[is_known]
    predicted = _predict(table, given)
    is_fitting = np.abs(predicted - shown) <= MIN_WRONG_LEVELS
    is_known = predicted >= 0
    if not is_known.any() or is_fitting[is_known].mean() < MIN_FITTING_FRACTION:
        return None
    return table


def _predict(table: F64, rows: Array) -> F64:
    """Return the levels that a table predicts for rows (h, w, C) of another photo."""
    return table[np.arange(rows.shape[-1]), rows]
