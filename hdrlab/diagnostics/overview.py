"""A small copy of a bracket, in which each pixel is a mean of light.

Z   pixel values    (P, H, W[, C]), n = 256 or 65536 of them
g   response        (n,) or (n, C), ln exposure of each pixel value
X   exposure        exp g(Z)

What is measured on the copy does not depend on the size of the photos, takes the same time for all
sizes, and has less noise. Exposures are averaged, and not pixel values: only their means grow with
the exposure time as the light of each pixel does. The mean becomes the pixel value of the nearest
exposure again, so that response and weights hold for the copy, too. A block that is clipped only in
part has no mean, and its mask is False.
"""

from dataclasses import dataclass

import numpy as np

from hdrlab.core.arrays import Array, Indices, Mask

Box = tuple[slice, slice]
# pixels of the copy
MAX_PIXELS = 180_000
# A clipped pixel counts as so much; that of others is at most 1.
CLIPPED_EXPOSURE = np.float32(2**12)
# A mean takes about this many pixels on each side of a block, evenly spaced.
SAMPLES_PER_SIDE = 2


@dataclass(frozen=True, kw_only=True, eq=False)
class Overview:
    """A bracket in a smaller size.

    Attributes
    ----------
    images : (P, h, w) or (P, h, w, C) uint8 or uint16
    valid : (P, h, w) bool or None
        False where a photo shows nothing of the scene, or is clipped in a part of the block.
    row_edges, column_edges : (h + 1,) and (w + 1,) int
        Where the blocks begin and end in the photos, in pixels.
    """

    images: Array
    valid: Mask | None
    row_edges: Indices
    column_edges: Indices

    @property
    def scale(self) -> float:
        """The mean side of a block, in pixels of the photos."""
        blocks = (len(self.row_edges) - 1) * (len(self.column_edges) - 1)
        return float(np.sqrt(self.row_edges[-1] * self.column_edges[-1] / blocks))

    def enlarge(self, values: Array, box: Box = (slice(None), slice(None))) -> Array:
        """Return block values (h, w), or those of a box, in the size of the photos.

        Each pixel has the value of its block.
        """
        rows, columns = box
        heights = np.diff(self.row_edges)[rows]
        widths = np.diff(self.column_edges)[columns]
        return np.repeat(np.repeat(values[box], heights, axis=0), widths, axis=1)

    def enlarge_box(self, box: Box) -> Box:
        """Return the rows and columns of the photos that a box of blocks covers."""
        rows, columns = box
        return (
            slice(int(self.row_edges[rows.start]), int(self.row_edges[rows.stop])),
            slice(int(self.column_edges[columns.start]), int(self.column_edges[columns.stop])),
        )


def make_overview(
    images: Array,
    g: Array,
    *,
    top: int,
    valid: Mask | None = None,
    max_pixels: int = MAX_PIXELS,
    frames: Indices | None = None,
) -> Overview:
    """Return the bracket with at most about `max_pixels` pixels for each photo.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, C) uint8 or uint16
    g : (n,) or (n, C)
        Response, ln exposure of each pixel value.
    top : int
        First clipped pixel value.
    valid : (P, H, W) bool, optional
        False where a photo shows nothing of the scene.
    max_pixels : int
        Photos with fewer pixels stay as they are.
    frames : (F,) int, optional
        The photos of the copy, all by default.

    Examples
    --------
    >>> g = np.log(np.arange(256) + 0.5)
    >>> images = np.array([[[10, 30, 200, 255]] * 2], np.uint8)
    >>> small = make_overview(images, g, top=250, max_pixels=2)
    >>> small.images.tolist(), small.valid.tolist(), small.column_edges.tolist()
    ([[[20, 249]]], [[[True, False]]], [0, 2, 4])
    """
    height, width = images.shape[1:3]
    scale = np.sqrt(height * width / max_pixels)
    all_frames = np.arange(len(images))
    if frames is None:
        frames = all_frames
    if scale <= 1:
        if not np.array_equal(frames, all_frames):
            images = images[frames]
            valid = None if valid is None else valid[frames]
        return Overview(
            images=images,
            valid=valid,
            row_edges=np.arange(height + 1),
            column_edges=np.arange(width + 1),
        )
    step = max(1, round(scale / SAMPLES_PER_SIDE))
    rows = _divide(height, step, scale)
    columns = _divide(width, step, scale)
    channel_count = images[0].size // (height * width)
    curves = np.broadcast_to(np.reshape(g, (len(g), -1)), (len(g), channel_count))
    small = np.empty((len(frames), len(rows) - 1, len(columns) - 1, channel_count), images.dtype)
    is_valid = np.ones(small.shape[:3], bool)
    for j, frame in enumerate(frames):
        photo = images[frame, ::step, ::step]
        photo = photo.reshape(*photo.shape[:2], channel_count)
        for c in range(channel_count):
            channel = np.ascontiguousarray(photo[..., c])
            levels, is_whole = _average_channel(channel, curves[:, c], rows, columns, top)
            small[j, ..., c] = levels
            is_valid[j] &= is_whole
        if valid is not None:
            is_valid[j] &= _reduce(np.logical_and, valid[frame, ::step, ::step], rows, columns)
    return Overview(
        images=small.reshape(*small.shape[:3], *images.shape[3:]),
        valid=is_valid,
        row_edges=np.minimum(rows * step, height),
        column_edges=np.minimum(columns * step, width),
    )


def _divide(length: int, step: int, scale: float) -> Indices:
    """Return where the blocks begin and end in every `step`-th pixel of a side."""
    sampled_count = -(-length // step)
    block_count = min(max(1, round(length / scale)), sampled_count)
    return np.rint(np.linspace(0, sampled_count, block_count + 1)).astype(np.intp)


def _reduce(ufunc: np.ufunc, values: Array, rows: Indices, columns: Indices) -> Array:
    """Return the reduction of each block of (H, W)."""
    bands = ufunc.reduceat(values, rows[:-1], axis=0)
    return np.asarray(ufunc.reduceat(bands, columns[:-1], axis=1))


def _average_channel(
    Z: Array, g: Array, rows: Indices, columns: Indices, top: int
) -> tuple[Array, Mask]:
    """Return the pixel values of the mean exposures, and where a block is clipped whole or not."""
    order = np.argsort(g, kind="stable")
    brightest = g[order[-1]]
    exposures = np.exp(g - brightest).astype(np.float32)
    exposures[top:] = CLIPPED_EXPOSURE  # so that one sum finds the clipped pixels, too
    sums = _reduce(np.add, exposures.take(Z), rows, columns)
    counts = np.diff(rows)[:, None] * np.diff(columns)
    ascending = g[order] - brightest
    limits = (ascending[1:] + ascending[:-1]) / 2
    levels = order[np.searchsorted(limits, np.log(np.maximum(sums / counts, 1e-30)))]
    has_clipped = sums >= CLIPPED_EXPOSURE
    is_clipped = sums >= CLIPPED_EXPOSURE * counts
    levels = np.where(is_clipped, top, np.minimum(levels, top - 1))
    return levels, is_clipped | ~has_clipped
