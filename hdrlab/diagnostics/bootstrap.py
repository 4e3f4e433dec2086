"""How well a response repeats: the bootstrap (Efron, Annals of Statistics 1979), tile by tile.

images  photographs  (P, H, W[, 3]), aligned: a pixel is the same point of the scene in every frame
g       response     (256,) or (256, 3), ln exposure of each level, g[128] = 0
T       tiles        (rows, columns): each frame is cut into so many, all frames alike
G       responses    (rounds, 256[, 3]), one per round

A round draws rows x columns tiles from the photographs, with replacement, lays them side by side and recovers
the response of that picture. Tiles and not pixels, for neighbours measure the same light: single ones would
make the band too narrow. A tile is drawn with all its exposures, so that the frames stay connected.

The band measures the choice of the scene and the noise. It does not measure what all tiles share: wrong
times, frames that are not aligned, a model of the curve that is too stiff. So it says how well the curve
repeats and not how near the truth it is: that lies outside at far more levels than the rounds let expect.
"""

from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hdrlab.core.arrays import as_mask, as_stack, as_times
from hdrlab.core.metrics import RELIABLE_LEVELS
from hdrlab.core.types import F64, Array

# Share of the rounds that must find a response.
MIN_SUCCESS = 0.8


class Band(NamedTuple):
    """Percentiles of the rounds' responses at each level, (256,) or (256, 3): lower, median and upper."""

    low: F64
    middle: F64
    high: F64

    @property
    def width(self) -> float:
        """How far high lies above low, in stops: the median over the levels 10 to 250 and the channels."""
        return float(np.median((self.high - self.low)[RELIABLE_LEVELS]) / np.log(2))


def split_tiles(stack: Array, tiles: tuple[int, int]) -> Array:
    """Return the tiles of a stack (P, H, W, ...) as (rows columns, P, h, w, ...); the rest is left out."""
    rows, columns = tiles
    h, w = stack.shape[1] // rows, stack.shape[2] // columns
    cut = stack[:, : rows * h, : columns * w].reshape(len(stack), rows, h, columns, w, *stack.shape[3:])
    return np.moveaxis(cut, (1, 3), (0, 1)).reshape(rows * columns, len(stack), h, w, *stack.shape[3:])


def join_tiles(drawn: Array, tiles: tuple[int, int]) -> Array:
    """Return a stack of tiles (rows columns, P, h, w, ...) side by side: the inverse of `split_tiles`."""
    rows, columns = tiles
    _, P, h, w, *rest = drawn.shape
    grid = np.moveaxis(drawn.reshape(rows, columns, P, h, w, *rest), (0, 1), (1, 3))
    return grid.reshape(P, rows * h, columns * w, *rest)


def bootstrap_steps(
    recover: Callable[..., F64],
    images: ArrayLike,
    times: ArrayLike,
    *,
    rounds: int = 50,
    rng: np.random.Generator | int | None = None,
    tiles: tuple[int, int] = (12, 16),
    pixels: int = 200_000,
    valid: ArrayLike | None = None,
) -> Iterator[F64 | None]:
    """Yield the response of each round, None where its tiles hold too little; knobs as in `bootstrap`."""
    stack = as_stack(images)
    t, shown = as_times(times, len(stack)), as_mask(valid, stack)
    if rounds < 2 or min(tiles) < 1:
        raise ValueError(f"expected two rounds or more and tiles (rows, columns), got {rounds} and {tiles}")
    rows, columns = tiles = (min(tiles[0], stack.shape[1]), min(tiles[1], stack.shape[2]))
    step = max(1, int(np.sqrt(stack.shape[1] * stack.shape[2] / pixels)))
    step = min(step, stack.shape[1] // rows, stack.shape[2] // columns)
    parts = split_tiles(stack[:, ::step, ::step], tiles)
    masks = None if shown is None else split_tiles(shown[:, ::step, ::step], tiles)
    rng = np.random.default_rng(rng)
    for _ in range(rounds):
        drawn = rng.integers(0, len(parts), len(parts))
        mask = None if masks is None else join_tiles(masks[drawn], tiles)
        try:
            yield recover(join_tiles(parts[drawn], tiles), t, valid=mask)
        except ValueError:
            yield None


def percentile_band(curves: Iterable[F64 | None], *, share: float = 0.95) -> Band:
    """Return the Band that holds this share of the rounds' responses, at each level by itself.

    Raises
    ------
    ValueError
        For a share that is not between 0 and 1, and where more than a fifth of the rounds found no response.
    """
    curves = list(curves)
    found = [one for one in curves if one is not None]
    if not 0 < share < 1:
        raise ValueError(f"expected a share between 0 and 1, got {share}")
    if len(found) < max(2, MIN_SUCCESS * len(curves)):
        raise ValueError(
            f"expected a response in most rounds, got {len(found)} of {len(curves)}: "
            "too few parts of the scene are measured well in two exposures"
        )
    tail = 50 * (1 - share)
    return Band(*np.percentile(np.stack(found), [tail, 50, 100 - tail], axis=0))


def bootstrap(
    recover: Callable[..., F64], images: ArrayLike, times: ArrayLike, *, share: float = 0.95, **knobs: Any
) -> Band:
    """Return how well a method's response to a bracket repeats; the truth may lie outside, see above.

    Parameters
    ----------
    recover : function
        A method's `recover(images, times, *, valid) -> g`.
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs, aligned.
    times : (P,) float
        Exposure times in seconds.
    share : float
        Of the rounds' responses that the band holds.
    rounds : int
        How many pictures are drawn.
    rng : Generator or int
        Of the draw.
    tiles : (int, int)
        Into how many rows and columns each frame is cut.
    pixels : int
        About this many, on an even grid, represent a frame.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.

    Returns
    -------
    Band

    Raises
    ------
    ValueError
        For arrays that are no bracket, and where more than a fifth of the rounds found no response.

    References
    ----------
    Efron, Bootstrap methods: another look at the jackknife, Annals of Statistics 7(1), 1979.

    Examples
    --------
    >>> from hdrlab.fast import debevec
    >>> ramp = np.linspace(1, 100, 10_000).reshape(100, 100)  # a linear camera without noise
    >>> images = np.clip(np.round(ramp * np.array([1, 2, 4])[:, None, None]), 0, 255).astype(np.uint8)
    >>> found = bootstrap(debevec.recover, images, [0.01, 0.02, 0.04], rounds=5, rng=1)
    >>> bool(found.low[200] <= found.middle[200] <= found.high[200]), found.width < 0.05
    (True, True)
    """
    return percentile_band(bootstrap_steps(recover, images, times, **knobs), share=share)
