"""Remove ghosts from a radiance map of any size: find what moved in a small copy of the photos.

`radiance.deghosting.ghosts` has the method. Its windows and margins are counted in pixels, so that
the same scene would get other regions in another size. Here, it sees the photos in one size, see
`diagnostics.overview`. Its regions, and the photos that it uses in each, then hold for the full
size.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, F64, Array, Labels, Mask
from hdrlab.core.bracket import Bracket
from hdrlab.diagnostics.frame_choice import choose_spread_frames
from hdrlab.diagnostics.overview import make_overview
from hdrlab.radiance.deghosting import ghosts, regions
from hdrlab.radiance.deghosting.ghosts import Ghosts
from hdrlab.radiance.merge import CLIPPING_LEVEL, Merged, as_tables

# photos, spread over the exposure times, from which regions are taken; the others do not count there
MAX_COMPARED_PHOTOS = 64
# width of the seam between a region and the map around it, in pixels of the small copy
SEAM_WIDTH = 2
# rows of the small copy that are merged at once
BAND_ROWS = 32
# in ln E; a measurement may be this far below the lower bound of a clipped photo
BOUND_TOLERANCE = 0.25


def remove_ghosts(
    bracket: Bracket,
    g: F64,
    pixel_weights: F64,
    *,
    merged: Merged,
    merge: Callable[..., Merged],
    fixed: int | None = None,
) -> Ghosts:
    """Return the radiance map of a bracket without ghosts.

    Parameters
    ----------
    bracket : Bracket
        Aligned photos.
    g : (n,) or (n, 3)
        Response, ln exposure of each pixel value.
    pixel_weights : (n,)
        Weights of the pixel values.
    merged : Merged
        The radiance map (H, W) or (H, W, 3) with ghosts, and its quality.
    merge : function
        `fast.merge.merge_with_quality` as it made that map.
    fixed : int, optional
        Number of the reference photo of all regions. By default, each has the one that exposes it
        best. Of more than MAX_COMPARED_PHOTOS photos, so many are compared, and the nearest one of
        these is the reference.

    Returns
    -------
    Ghosts
        `score` has the size of the overview, everything else that of the photos. If nothing moved,
        there is no region.
    """
    images = bracket.images
    times = bracket.times
    top = as_tables(images, times, g, pixel_weights, "log", CLIPPING_LEVEL)[4]
    compared = choose_spread_frames(times, MAX_COMPARED_PHOTOS)
    small = make_overview(images, g, top=top, valid=bracket.valid, frames=compared)
    times = times[compared]
    found = ghosts.remove_ghosts(
        small.images,
        times,
        g,
        pixel_weights,
        fixed=None if fixed is None else int(np.argmin(np.abs(compared - fixed))),
        valid=small.valid,
        merge=merge,
    )
    labels = small.enlarge(found.labels)
    used = np.ones(images.shape[:3], bool) if bracket.valid is None else bracket.valid.copy()
    alpha_of_pixels = np.zeros(labels.shape, np.float32)
    if not len(found.references):
        return replace(
            found,
            E=merged.E,
            quality=merged.quality,
            labels=labels,
            used=used,
            alpha=alpha_of_pixels,
        )
    block_references = _map_references(found)
    # A block that is clipped in part has no mean, but its other pixels are those of the reference.
    chosen = found.used | (np.arange(len(compared))[:, None, None] == block_references)
    seams = regions.feather(found.labels, SEAM_WIDTH)
    E = merged.E.copy()
    quality = merged.quality.copy()
    for box in _divide_into_bands(found.labels):
        y, x = small.enlarge_box(box)
        photos = np.stack([images[frame, y, x] for frame in compared])
        shown = np.stack([used[frame, y, x] for frame in compared])
        frames = np.stack([small.enlarge(photo, box) for photo in chosen]) & shown
        reference = small.enlarge(block_references, box)
        filled = fill_pixels(photos, times, g, frames, shown, reference, top)
        frames |= filled.frames
        still = merge(photos, times, g, pixel_weights, valid=frames)
        is_white = filled.white > 0
        still.E[is_white] = filled.white[is_white]
        changed = (labels[y, x] > 0) & (frames != shown).any(axis=0)
        alpha = small.enlarge(seams, box)
        seam = changed & (alpha < 1)
        # one row of pixels
        blended = regions.blend(E[y, x][seam][None], still.E[seam][None], alpha[seam][None])
        E[y, x][changed] = still.E[changed]
        E[y, x][seam] = blended[0]
        quality[y, x][changed] = still.quality[changed]
        alpha_of_pixels[y, x][changed] = alpha[changed]
        used[:, y, x][:, changed] = False
        for frame, is_merged in zip(compared, frames, strict=True):
            used[frame, y, x][changed] = is_merged[changed]
    references = compared[found.references]
    return Ghosts(E, quality, labels, references, used, found.score, alpha_of_pixels)


def _map_references(found: Ghosts) -> Labels:
    """Return the number of the reference photo of each block (h, w), -1 outside of the regions."""
    return np.concatenate([[-1], found.references])[found.labels].astype(np.int32)


def _divide_into_bands(labels: Labels) -> Iterator[regions.Box]:
    """Yield the parts of bands of rows that regions cover, so that no pixel is merged twice."""
    for start in range(0, len(labels), BAND_ROWS):
        rows = slice(start, min(start + BAND_ROWS, len(labels)))
        columns = np.flatnonzero(labels[rows].any(axis=0))
        if len(columns):
            yield rows, slice(int(columns[0]), int(columns[-1]) + 1)


class Filled(NamedTuple):
    """Photos (P, H, W) for pixels that no chosen photo measures, and white (H, W[, C]), or 0."""

    frames: Mask
    white: F32


def fill_pixels(
    photos: Array, times: F64, g: F64, chosen: Mask, shown: Mask, reference: Labels, top: int
) -> Filled:
    """Return what to show in the pixels that no chosen photo measures.

    It is the longest photo in which no channel is clipped. But where the reference is clipped, a
    photo in which the pixel is darker shows another moment. If there is no other photo, the pixel
    is white, as clipped pixel values have no color.
    """
    values = photos.reshape(*photos.shape[:3], -1)
    measures = shown.copy()
    is_black = np.ones_like(shown)
    for channel in range(values.shape[-1]):
        measures &= values[..., channel] < top
        is_black &= values[..., channel] == 0
    measures &= ~is_black
    missing = ~(measures & chosen).any(axis=0) & (reference >= 0)
    frames = np.zeros_like(chosen)
    white = np.zeros(values.shape[1:], np.float32)
    if missing.any():
        numbers = reference[missing]
        candidates = values[:, missing]
        is_clipped = candidates[numbers, np.arange(len(numbers))] >= top
        curves = np.broadcast_to(np.reshape(g, (len(g), -1)), (len(g), values.shape[-1]))
        bounds = curves[top] - np.log(times[numbers])[:, None]
        channels = np.arange(values.shape[-1])
        is_left = np.ones(len(numbers), bool)
        for j in np.argsort(times)[::-1]:
            log_radiance = curves[candidates[j], channels] - np.log(times[j])
            is_darker = (is_clipped & (log_radiance < bounds - BOUND_TOLERANCE)).any(axis=-1)
            is_taken = is_left & measures[j][missing] & ~is_darker
            frames[j][missing] = is_taken
            is_left &= ~is_taken
        is_white = is_left & is_clipped.any(axis=-1)
        white[missing] = np.where(is_white[:, None], np.exp(bounds), 0)
    return Filled(frames, white.reshape(photos.shape[1:]))
