"""Remove ghosts from a radiance map of any size: find what moved in a small copy of the photos.

`radiance.deghosting.ghosts` has the method. Its windows and margins are counted in pixels, so that
the same scene would get other regions in another size. Here, it sees the photos in one size, see
`diagnostics.overview`. Its regions, and the photos that it uses in each, then hold for the full
size.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy import ndimage

from hdrlab.core.arrays import F64, Array, Mask
from hdrlab.core.bracket import Bracket
from hdrlab.diagnostics.overview import Overview, make_overview
from hdrlab.radiance.deghosting import ghosts, regions
from hdrlab.radiance.deghosting.ghosts import Ghosts
from hdrlab.radiance.merge import CLIPPING_LEVEL, Merged, as_tables

# width of the seam between a region and the map around it, in pixels of the small copy
SEAM_WIDTH = 2
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
        best.

    Returns
    -------
    Ghosts
        `score` has the size of the overview, everything else that of the photos. If nothing moved,
        there is no region.
    """
    images = bracket.images
    times = bracket.times
    top = as_tables(images, times, g, pixel_weights, "log", CLIPPING_LEVEL)[4]
    small = make_overview(images, g, top=top, valid=bracket.valid)
    found = ghosts.remove_ghosts(
        small.images, times, g, pixel_weights, fixed=fixed, valid=small.valid, merge=merge
    )
    labels = small.enlarge(found.labels)
    used = np.ones(images.shape[:3], bool) if bracket.valid is None else bracket.valid.copy()
    if not len(found.references):
        return replace(found, E=merged.E, quality=merged.quality, labels=labels, used=used)
    chosen = _choose_photos(small, found)
    E = merged.E.copy()
    quality = merged.quality.copy()
    alpha = regions.feather(labels, max(1, round(SEAM_WIDTH * small.scale)))
    for number, box in enumerate(ndimage.find_objects(found.labels), start=1):
        full_box = small.enlarge_box(box)
        y, x = full_box
        frames = np.stack([small.enlarge(photo, box) for photo in chosen])
        frames &= used[:, y, x]
        photos = images[:, y, x]
        reference = int(found.references[number - 1])
        frames |= _find_substitutes(photos, times, g, frames, used[:, y, x], reference, top)
        still = merge(photos, times, g, pixel_weights, valid=frames)
        inside = labels[full_box] == number
        changed = inside & (frames != used[:, y, x]).any(axis=0)
        E[full_box][changed] = regions.blend(E[full_box], still.E, alpha[full_box])[changed]
        quality[full_box][changed] = still.quality[changed]
        used[:, y, x][:, inside] = frames[:, inside]
    return Ghosts(E, quality, labels, found.references, used, found.score)


def _choose_photos(small: Overview, found: Ghosts) -> Mask:
    """Return the photos (P, h, w) to use in the overview, where a block may be clipped in part.

    Such a block has no mean in that photo, but the pixels that are not clipped are still those of
    the reference.
    """
    chosen = found.used.copy()
    for number, reference in enumerate(found.references, start=1):
        chosen[reference] |= found.labels == number
    return chosen


def _find_substitutes(
    photos: Array, times: F64, g: F64, chosen: Mask, shown: Mask, reference: int, top: int
) -> Mask:
    """Return a photo for each pixel that no chosen photo measures, (P, H, W).

    It is the longest one in which no channel of the pixel is clipped. Otherwise the pixel would
    have the color of clipped pixel values. Where all channels of the reference are clipped, the
    pixel is bright, and photos in which it is darker show another moment.
    """
    values = photos.reshape(*photos.shape[:3], -1)
    curves = np.broadcast_to(np.reshape(g, (len(g), -1)), (len(g), values.shape[-1]))
    measures = (values < top).all(axis=-1) & (values > 0).any(axis=-1) & shown
    missing = ~(measures & chosen).any(axis=0)
    is_white = (values[reference] >= top).all(axis=-1)
    bound = curves[top] - np.log(times[reference]) - BOUND_TOLERANCE
    substitutes = np.zeros_like(chosen)
    if not missing.any():
        return substitutes
    channels = np.arange(values.shape[-1])
    for j in np.argsort(times)[::-1]:
        candidates = missing & measures[j]
        log_radiance = curves[values[j][candidates], channels] - np.log(times[j])
        is_too_dark = (log_radiance < bound).any(axis=-1)
        candidates[candidates] = ~(is_too_dark & is_white[candidates])
        substitutes[j] = candidates
        missing &= ~candidates
    return substitutes
