"""The map against the photo that measures each place best, tone by tone and channel by channel.

j   best photo   (H, W), the longest one that does not clip the pixel
X   radiance     (H, W, C), of the best photo alone: exp(g(Z_j)) / t_j
E   radiance     (H, W, C), the map
d   error        (h, w, C) stops, log2 of the mean E over the mean X in a block: positive where the
                 map is too bright
e   contradiction  (h, w, C) stops, the same of the next shorter photo instead of the map

One number for the whole image hides what is wrong in a small part of it. Twelve of sixteen scans
that show only the black floor of the scanner make the darkest twentieth of a map three times too
bright, and the median over all pixel values stays small. So each part has its own median of d: the
darkest and the brightest twentieth, each channel, the blocks that each photo measures best, and the
tiles of the image.

The best photo collected the most light, so the map must agree with it, whatever the weights are. If
it agrees, the best photo may still be wrong: then the next shorter photo contradicts it. The means
over blocks keep noise from deciding which blocks are the darkest.

Beside clipped pixels, two photos of the same light differ. JPEG and sharpening carry light from a
bright pixel to its neighbors, but only as much as the pixel value shows: less in the photo that
clips it. In a chapel with bright panes this came to 0.7 stops, and to 0.04 elsewhere. So a block
counts only if the longest photo that shows it clips no pixel of it or of the blocks around it.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from hdrlab.core.arrays import F32, Array, ArrayLike, Indices, Mask, as_mask, as_radiance
from hdrlab.core.bracket import short_to_long
from hdrlab.diagnostics.motion import BLOCK_SIDE, minimum_around, sum_blocks
from hdrlab.diagnostics.warning_texts import warning_text
from hdrlab.errors import InputError
from hdrlab.radiance.merge import CLIPPING_LEVEL, as_tables

# mean pixel value of a block in an 8-bit photo; below, noise and the toe of the response decide
MIN_LEVEL = 16
# and of the next shorter photo
MIN_SHORTER_LEVEL = 30
# fraction of the blocks that are the darkest ones, and that are the brightest ones
TONE_FRACTION = 0.05
# blocks around one, in each direction, in which its best photo must clip nothing either
UNCLIPPED_REACH = 1
# tiles along each side of the image
TILES_PER_SIDE = 4
# blocks of a part, as a fraction of those that are compared, without which it has no median
MIN_PART_FRACTION = 0.01
# and their number
MIN_PART_BLOCKS = 10
# stops by which the darkest parts may differ; sound brackets with much noise come to 0.9
MAX_DARK_STOPS = 1.0
# stops by which the map or two photos may differ in another part; sound real brackets stay below 0.46
MAX_PART_STOPS = 0.5
# The map follows the longer of two photos if it differs from it by at most this, in stops.
MAX_FOLLOWING_STOPS = 0.25
# merges that weight a photo by its exposure time, so that a long one decides in the dark
MERGES_BY_TIME = ("shot", "likelihood")
CHANNEL_NAMES = ("red", "green", "blue")
ROW_NAMES = ("top", "upper middle", "lower middle", "bottom")
COLUMN_NAMES = ("left", "middle left", "middle right", "right")

PartKind = Literal["image", "dark", "bright", "photo", "tile"]


@dataclass(frozen=True, kw_only=True, eq=False)
class BlockErrors:
    """The errors of a map in blocks of pixels.

    Attributes
    ----------
    errors : (h, w, C) float32
        d in stops; NaN where no photo measures the block.
    contradictions : (h, w, C) float32
        e in stops; NaN where no second photo measures the block.
    best_photos : (h, w) int
        The index of the photo that measures the block best; -1 where none does.
    tones : (2, h, w) float32
        log2 radiance of the best photo alone, and of the map.
    """

    errors: F32
    contradictions: F32
    best_photos: Indices
    tones: F32


@dataclass(frozen=True, kw_only=True)
class PartError:
    """The median error of a map in a part of the image, in one channel.

    Attributes
    ----------
    kind : {"image", "dark", "bright", "photo", "tile"}
        The whole image, its darkest or brightest twentieth, the blocks that one photo measures
        best, or a tile.
    index : int
        Of the photo or the tile (row by row), from 0; 0 for the other kinds.
    channel : int
    stops : float
        Positive where the map is brighter than the photos that measure best.
    is_between_photos : bool
        Whether `stops` compares the next shorter photos instead of the map.
    """

    kind: PartKind
    index: int
    channel: int
    stops: float
    is_between_photos: bool = False


def measure_block_errors(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    E: ArrayLike,
    *,
    valid: ArrayLike | None = None,
) -> BlockErrors:
    """Compare a map with the photo that measures each block of pixels best.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Aligned photos.
    times : (P,) float
        Exposure times in seconds.
    g : (n,) or (n, 3) float
        Response, ln exposure of each pixel value.
    E : (H, W) or (H, W, 3)
        The map that was made of them.
    valid : (P, H, W) bool, optional
        False where a photo has no image.

    Raises
    ------
    InputError
        If the arrays do not fit together.
    """
    stack, times_s, _, curves, top = as_tables(images, times, g, None, "log", CLIPPING_LEVEL)
    radiance = as_radiance(E)
    if radiance.shape != stack.shape[1:]:
        raise InputError(f"expected a map of shape {stack.shape[1:]}, got {radiance.shape}")
    Z = stack.reshape(*stack.shape[:3], -1)
    E_channels = radiance.reshape(Z.shape[1:])
    best, second = _find_best_photos(Z, times_s, top, as_mask(valid, stack))
    is_far = _find_blocks_far_from_clipping(best, short_to_long(Z, times_s))[..., None]
    exposures = np.exp(curves).astype(np.float32)
    level_unit = 1 if stack.dtype == np.uint8 else 257

    is_measured = (best >= 0) & np.all(E_channels > 0, axis=-1)
    X, levels = _take_photos(Z, times_s, exposures, best)
    mean_X = _mean_of_blocks(X, is_measured)
    mean_E = _mean_of_blocks(E_channels, is_measured)
    has_signal = _mean_of_blocks(levels, is_measured) >= level_unit * MIN_LEVEL

    is_shared = is_measured & (second >= 0)
    shorter_X, shorter_levels = _take_photos(Z, times_s, exposures, second)
    is_shown = _mean_of_blocks(shorter_levels, is_shared) >= level_unit * MIN_SHORTER_LEVEL
    with np.errstate(divide="ignore", invalid="ignore"):
        log_X = np.log2(mean_X)
        log_E = np.log2(mean_E)
        contradictions = np.log2(_mean_of_blocks(shorter_X, is_shared))
        contradictions -= np.log2(_mean_of_blocks(X, is_shared))
    errors = np.where(has_signal & is_far, log_E - log_X, np.nan)
    contradictions[~(has_signal & is_far & is_shown)] = np.nan
    height, width = errors.shape[:2]
    corners = best[: height * BLOCK_SIDE : BLOCK_SIDE, : width * BLOCK_SIDE : BLOCK_SIDE]
    return BlockErrors(
        errors=errors,
        contradictions=contradictions,
        best_photos=np.where(has_signal.any(axis=-1), corners, -1),
        tones=np.stack([log_X.mean(axis=-1), log_E.mean(axis=-1)]),
    )


def _find_best_photos(
    Z: Array, times: Array, top: int, mask: Mask | None
) -> tuple[Indices, Indices]:
    """Return the indices of the two longest photos that do not clip a pixel, (H, W), or -1.

    The second one has another exposure time than the first.
    """
    best = np.full(Z.shape[1:3], -1)
    second = best.copy()
    for j in short_to_long(Z, times):
        is_unclipped = Z[j].max(axis=-1) < top
        if mask is not None:
            is_unclipped &= mask[j]
        second = np.where(is_unclipped, best, second)
        best = np.where(is_unclipped, j, best)
    return best, second


def _find_blocks_far_from_clipping(best: Indices, order: Sequence[int] | Indices) -> Mask:
    """Return whether no pixel around a block (h, w) is clipped in a photo that measures the block.

    Parameters
    ----------
    best : (H, W) int
        The longest photo that does not clip a pixel, or -1.
    order : (P,) int
        The photos from short to long.
    """
    ranks = np.full(len(order) + 1, -1)  # the last one is that of -1
    ranks[np.asarray(order)] = np.arange(len(order))
    height = best.shape[0] // BLOCK_SIDE
    width = best.shape[1] // BLOCK_SIDE
    best_ranks = ranks[best[: height * BLOCK_SIDE, : width * BLOCK_SIDE]]
    blocks = best_ranks.reshape(height, BLOCK_SIDE, width, BLOCK_SIDE)
    around = minimum_around(blocks.min(axis=(1, 3)), UNCLIPPED_REACH)
    return around >= blocks.max(axis=(1, 3))


def _take_photos(Z: Array, times: Array, exposures: F32, photos: Indices) -> tuple[F32, Array]:
    """Return the radiance (H, W, C) of the chosen photo at each pixel, and its pixel values."""
    photo = np.maximum(photos, 0)
    levels = np.take_along_axis(Z, photo[None, ..., None], axis=0)[0]
    rates = (1 / times).astype(np.float32)[photo]
    return exposures[levels, np.arange(Z.shape[-1])] * rates[..., None], levels


def _mean_of_blocks(values: Array, is_measured: Mask) -> F32:
    """Return the means over the measured pixels of blocks of (H, W, C); NaN where these are few."""
    weights = is_measured[..., None].astype(np.float32)
    count = _sum_channels(weights)
    total = _sum_channels(weights * values)
    return np.where(count >= BLOCK_SIDE**2 / 2, total / np.maximum(count, 1), np.nan)


def _sum_channels(values: Array) -> F32:
    """Return the sums over blocks of an image (H, W, C), (h, w, C)."""
    return np.moveaxis(sum_blocks(np.moveaxis(values, -1, 0)), 0, -1)


def measure_part_errors(
    blocks: BlockErrors, *, moving: ArrayLike | None = None
) -> tuple[PartError, ...]:
    """Return the median errors and contradictions of each part of the image in each channel.

    Parameters
    ----------
    blocks : BlockErrors
    moving : (H, W), optional
        Not 0 where something moved; these blocks are left out.

    Examples
    --------
    >>> images = np.full((2, 80, 80), 100, np.uint8)
    >>> images[1] = 200
    >>> E = np.ones((80, 80), np.float32)
    >>> E[:20, :20] = 2  # one of the 16 tiles
    >>> blocks = measure_block_errors(images, [1, 2], np.log((np.arange(256) + 0.5) / 100.25), E)
    >>> [(part.kind, part.index) for part in measure_part_errors(blocks) if part.stops > 0.9]
    [('bright', 0), ('tile', 0)]
    """
    is_compared: Mask = np.asarray(np.isfinite(blocks.errors).any(axis=-1))
    if moving is not None:
        height, width = is_compared.shape
        has_moved = sum_blocks((np.asarray(moving) > 0)[None].astype(np.float32))[0] > 0
        is_compared = is_compared & ~has_moved[:height, :width]
    if not is_compared.any():
        return ()
    parts = list(_find_parts(blocks, is_compared))
    of_map = _measure_medians(blocks.errors, parts, is_between_photos=False)
    of_photos = _measure_medians(blocks.contradictions, parts, is_between_photos=True)
    return (*of_map, *of_photos)


def _find_parts(blocks: BlockErrors, is_compared: Mask) -> Iterator[tuple[PartKind, int, Mask]]:
    """Yield the kind, the index and the blocks (h, w) of each part of the image."""
    yield "image", 0, is_compared
    # The darkest blocks of the map are others than those of the photo where the map is wrong.
    for tone in blocks.tones:
        low, high = np.quantile(tone[is_compared], [TONE_FRACTION, 1 - TONE_FRACTION])
        yield "dark", 0, is_compared & (tone <= low)
        yield "bright", 0, is_compared & (tone >= high)
    for photo in range(int(blocks.best_photos.max()) + 1):
        yield "photo", photo, is_compared & (blocks.best_photos == photo)
    height, width = is_compared.shape
    y, x = np.indices((height, width))
    tiles = y * TILES_PER_SIDE // height * TILES_PER_SIDE + x * TILES_PER_SIDE // width
    for tile in range(TILES_PER_SIDE**2):
        yield "tile", tile, is_compared & (tiles == tile)


def _measure_medians(
    errors: F32, parts: Sequence[tuple[PartKind, int, Mask]], *, is_between_photos: bool
) -> Iterator[PartError]:
    """Yield the median errors (h, w, C) of the parts that are large enough; the first part is all."""
    min_count = max(MIN_PART_BLOCKS, MIN_PART_FRACTION * np.count_nonzero(parts[0][2]))
    for kind, index, part in parts:
        for channel, values in enumerate(errors[part].T):
            known = values[np.isfinite(values)]
            if len(known) >= min_count:
                yield PartError(
                    kind=kind,
                    index=index,
                    channel=channel,
                    stops=float(np.median(known)),
                    is_between_photos=is_between_photos,
                )


def warn_of_dark_parts(parts: Sequence[PartError], *, merge: str = "log") -> str:
    """Return the warning that the darkest parts of the map contradict the longest photo, or "".

    `merge` is the method of the map. The warning recommends another one if that would help.
    """
    worst = _find_worst(
        part for part in parts if part.kind == "dark" and not part.is_between_photos
    )
    if worst is None or abs(worst.stops) < MAX_DARK_STOPS:
        return ""
    advice = "" if merge in MERGES_BY_TIME else warning_text("dark_parts_advice")
    return warning_text("dark_parts", stops=worst.stops, advice=advice)


def warn_of_parts(
    parts: Sequence[PartError], names: Sequence[str], *, alternatives: Sequence[str] = ()
) -> str:
    """Return the warning about a part where the map or a photo contradicts the best photo, or "".

    `alternatives` are options of the command line that would make another map to compare with.
    """
    worst = _find_worst(
        part for part in parts if part.kind != "dark" and not part.is_between_photos
    )
    if worst is not None and abs(worst.stops) >= MAX_PART_STOPS:
        text = warning_text("parts", stops=worst.stops, place=_describe_place(worst, names))
        if alternatives:
            text += warning_text("parts_advice", options=" and ".join(alternatives))
        return text
    follows = ""
    if worst is not None and abs(worst.stops) <= MAX_FOLLOWING_STOPS:
        follows = warning_text("photo_parts_follows")
    worst = _find_worst(part for part in parts if part.is_between_photos)
    if worst is not None and abs(worst.stops) >= MAX_PART_STOPS:
        place = _describe_place(worst, names)
        return warning_text("photo_parts", stops=abs(worst.stops), place=place, follows=follows)
    return ""


def _find_worst(parts: Iterable[PartError]) -> PartError | None:
    """Return the part with the largest error."""
    return max(parts, key=_size_of_error, default=None)


def _size_of_error(part: PartError) -> float:
    return abs(part.stops)


def _describe_place(part: PartError, names: Sequence[str]) -> str:
    """Return where a part is, as a warning shows it."""
    if part.kind == "bright":
        return "in the brightest parts of the image"
    if part.kind == "photo":
        return f"where {names[part.index]} measures best"
    if part.kind == "tile":
        row, column = divmod(part.index, TILES_PER_SIDE)
        return f"at the {ROW_NAMES[row]}, {COLUMN_NAMES[column]} of the image"
    if part.kind == "dark":
        return "in the darkest parts of the image"
    return f"in the {CHANNEL_NAMES[part.channel]} channel"
