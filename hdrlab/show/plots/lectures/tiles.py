"""Draw what a burst's alignment and merge do with one tile, beside the photo in which the tile is framed.

X        frames     (N, H, W), the reference first, 1 is a full well
T        tiles      (N, n, n), cut from the frames and aligned
A        shrinkage  (N, n, n), of each spatial frequency; 0 for the reference
weights  (N, n, n), of each frame at each spatial frequency, zero frequency in the middle: (1 - A_z) / N, and
         for the reference what is missing to 1
"""

from dataclasses import dataclass
from typing import cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from hdrlab.beyond.burst import temporal_merge, tile_alignment
from hdrlab.core.arrays import F32, F64, ArrayLike, NDArray
from hdrlab.show.plots import bare, reuse

SIZE_INCHES = (8.6, 3.7)
# pixels around the place of the tile
SEARCH_RADIUS = 16
# left, bottom, width, height, as fractions of the figure
PHOTO_PLACE = (0.005, 0.02, 0.55, 0.88)
MAP_PLACE = (0.65, 0.15, 0.335, 0.7)
SMALL_MAP_WIDTH = 0.1
SMALL_MAP_GAP = 0.01
TITLE_SIZE = 10
FRAME_COLOR = "#E69F00"
SMALL_MAP_COLUMNS = 4
MAX_FRAMES = 8


@dataclass(frozen=True, kw_only=True)
class TileSearch:
    """A tile of the reference, and its distances from all tiles around the same place in another frame.

    Attributes
    ----------
    photo : (H, W[, 3]) uint8, the reference
    place : (row, column) of the tile in the grid
    side : n, pixels
    distances : (2 r + 1, 2 r + 1), mean absolute difference of the pixels in percent of a full well
    offset : (dy, dx) that the alignment found, pixels
    """

    photo: NDArray[np.uint8]
    place: tuple[int, int]
    side: int
    distances: F64
    offset: tuple[int, int]


@dataclass(frozen=True, kw_only=True)
class TileWeights:
    """A tile of the reference, and the weight of each frame at each spatial frequency of the tile."""

    photo: NDArray[np.uint8]
    place: tuple[int, int]
    side: int
    weights: F64


def find_tile(grid: tuple[int, ...], *, down: float, right: float) -> tuple[int, int]:
    """Return the row and the column of the tile nearest to a place, in fractions of the photo."""
    row = round(down * (grid[0] - 1))
    column = round(right * (grid[1] - 1))
    return min(max(row, 0), grid[0] - 1), min(max(column, 0), grid[1] - 1)


def cut_tile(image: F32, place: tuple[int, int], offset: ArrayLike, side: int) -> F32:
    """Return the tile (n, n) of an image at a place of the grid, moved by an offset."""
    u = np.zeros((place[0] + 1, place[1] + 1, 2), np.int64)
    u[place] = offset
    return tile_alignment.cut_tiles(image, u, side)[place]


def search_tile(
    frames: F32,
    offsets: NDArray[np.int64],
    photo: NDArray[np.uint8],
    *,
    frame: int,
    down: float,
    right: float,
    radius: int = SEARCH_RADIUS,
    side: int = tile_alignment.TILE_SIDE,
) -> TileSearch:
    """Return the distances of one tile from all tiles of a frame up to `radius` pixels away."""
    place = find_tile(offsets.shape[1:3], down=down, right=right)
    T0 = cut_tile(frames[0], place, (0, 0), side)
    steps = range(-radius, radius + 1)
    distances = np.zeros((len(steps), len(steps)))
    for row, dy in enumerate(steps):
        for column, dx in enumerate(steps):
            Tz = cut_tile(frames[frame], place, (dy, dx), side)
            distances[row, column] = 100 * tile_alignment.l1_distance(T0, Tz) / side**2
    dy, dx = offsets[frame][place].tolist()
    return TileSearch(photo=photo, place=place, side=side, distances=distances, offset=(dy, dx))


def weigh_tile(
    frames: F32,
    offsets: NDArray[np.int64],
    photo: NDArray[np.uint8],
    *,
    down: float,
    right: float,
    shot: float,
    read: float,
    tuning: float,
    side: int = tile_alignment.TILE_SIDE,
) -> TileWeights:
    """Return the weight of each frame in the merge of one tile, for each spatial frequency."""
    place = find_tile(offsets.shape[1:3], down=down, right=right)
    pairs = zip(frames, offsets, strict=True)
    T = np.stack([cut_tile(frame, place, u[place], side) for frame, u in pairs])
    F = np.fft.fft2(T)
    variance = temporal_merge.noise_variance(T[0], shot, read)
    A = temporal_merge.shrinkage(F[0] - F, variance, tuning)
    weights = (1 - A) / len(T)
    weights[0] = 1 - weights[1:].sum(axis=0)
    shifted = np.fft.fftshift(weights, axes=(-2, -1))
    return TileWeights(photo=photo, place=place, side=side, weights=shifted)


def draw_search(found: TileSearch) -> Figure:
    """Draw the photo with the tile, and a map of the distances with the offset that was found."""

    def make() -> list[Axes]:
        figure = Figure(figsize=SIZE_INCHES, dpi=100)
        return [bare(figure.add_axes(PHOTO_PLACE)), figure.add_axes(MAP_PLACE)]

    photo_axes, map_axes = reuse.take((*SIZE_INCHES, *MAP_PLACE), make)
    draw_framed(photo_axes, found.photo, found.place, found.side)
    radius = len(found.distances) // 2
    ends = (-radius - 0.5, radius + 0.5)
    extent = (*ends, ends[1], ends[0])
    map_axes.imshow(found.distances, extent=extent, interpolation="nearest", aspect="auto")
    dy, dx = found.offset
    is_inside = max(abs(dy), abs(dx)) <= radius
    if is_inside:
        map_axes.plot(dx, dy, "o", markersize=12, mfc="none", mec="white", mew=2)
    map_axes.set(xlabel="offset, pixels to the right", ylabel="offset, pixels down")
    map_axes.set_title(describe_search(found), fontsize=TITLE_SIZE)
    return cast(Figure, photo_axes.figure)


def describe_search(found: TileSearch) -> str:
    """Return the offset that was found and the distance there, in words.

    Examples
    --------
    >>> photo = np.zeros((32, 32), np.uint8)
    >>> map_ = np.full((3, 3), 2.5)
    >>> found = TileSearch(photo=photo, place=(1, 1), side=16, distances=map_, offset=(-1, 1))
    >>> print(describe_search(found))
    moved 1 up and 1 to the right
    differs by 2.5 % of a full pixel
    """
    dy, dx = found.offset
    down = f"{abs(dy)} {'down' if dy >= 0 else 'up'}"
    right = f"{abs(dx)} to the {'right' if dx >= 0 else 'left'}"
    words = f"moved {down} and {right}"
    radius = len(found.distances) // 2
    if max(abs(dy), abs(dx)) > radius:
        return f"{words}\noutside of this map"
    distance = found.distances[dy + radius, dx + radius]
    return f"{words}\ndiffers by {distance:.2g} % of a full pixel"


def draw_weights(found: TileWeights) -> Figure:
    """Draw the photo with the tile, and a map of the weights of each of up to eight frames.

    Yellow is a full share, 1/N; dark blue is 0. For the reference, dark blue is 1/N and yellow is 1.
    """

    def make() -> list[Axes]:
        figure = Figure(figsize=SIZE_INCHES, dpi=100)
        axes = [figure.add_axes(PHOTO_PLACE)]
        height = SMALL_MAP_WIDTH * SIZE_INCHES[0] / SIZE_INCHES[1]
        for k in range(MAX_FRAMES):
            row, column = divmod(k, SMALL_MAP_COLUMNS)
            left = 0.57 + column * (SMALL_MAP_WIDTH + SMALL_MAP_GAP)
            bottom = 0.57 - 0.44 * row
            axes.append(figure.add_axes((left, bottom, SMALL_MAP_WIDTH, height)))
        return [bare(ax) for ax in axes]

    photo_axes, *maps = reuse.take((*SIZE_INCHES, MAX_FRAMES), make)
    draw_framed(photo_axes, found.photo, found.place, found.side)
    share = 1 / len(found.weights)
    for k, ax in enumerate(maps[: len(found.weights)]):
        low, high = (share, 1) if k == 0 else (0, share)
        ax.imshow(found.weights[k], vmin=low, vmax=high, interpolation="nearest", aspect="auto")
        name = "reference" if k == 0 else f"frame {k + 1}"
        ax.set_title(f"{name}\n{found.weights[k].mean():.0%}", fontsize=TITLE_SIZE - 1)
    return cast(Figure, photo_axes.figure)


def draw_framed(ax: Axes, photo: NDArray[np.uint8], place: tuple[int, int], side: int) -> None:
    """Draw a photo with a frame around one tile."""
    height, width = photo.shape[:2]
    ax.imshow(photo, interpolation="nearest", aspect="auto")
    ax.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5))
    top = (place[0] - 1) * side / 2 - 0.5
    left = (place[1] - 1) * side / 2 - 0.5
    ax.add_patch(
        Rectangle((left, top), side, side, fill=False, edgecolor=FRAME_COLOR, linewidth=2.5)
    )
