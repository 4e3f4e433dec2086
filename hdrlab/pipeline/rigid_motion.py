"""Measure how far two photos are still shifted and rotated against each other, and correct it.

B      moving, darker photo    (h, w) pixel values at a level of its image pyramid
A      fixed, brighter photo   (h, w); each value is replaced by the one of the same rank in B, so
                               that neither exposure times nor a response are needed
H      rigid motion            (3, 3): where pixel (x, y, 1) of the moving photo lies on the fixed one
r      residual                B moved by H, minus A
G      gradient                (2, h, w): the mean gradient of both, values per pixel
w      weight                  of a Cauchy distribution: things that moved count little. Its width
                               grows with the gradient, because a small motion makes larger
                               residuals at an edge, which tell most about it
N      normal equations        (blocks, 5, 5): sums of w times the products of (G_x, G_y, G_arc, 1, r)

Near the right place r is linear in a small motion: r = G . (shift + rotation) [Lucas and Kanade,
IJCAI 1981]. One step of least squares over all pixels tells how far H is off, and a few steps on
each level of the pyramid find H. With the mean gradient of both photos, a step is exact to second
order [Benhimane and Malis, IROS 2004].

The same equations, solved for the shift of each block of the image alone, tell whether H is right:
in a wrong place the blocks want to move in different directions.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy

from hdrlab.align import cerman, homography
from hdrlab.align.light import DARK_FRACTION, SATURATED_FRACTION, SMOOTHING_SIGMA
from hdrlab.core.arrays import F32, F64, Array
from hdrlab.core.filters import warp
from hdrlab.diagnostics.warning_texts import MARGIN

# The motion is measured at the largest level of the pyramid that is not larger.
MAX_PIXELS = 2**18
# The coarsest level that is searched has at least this many pixels a side.
MIN_SIDE_PIXELS = 32
# A residual that a displacement by so many pixels of the level explains has its full weight.
EXPLAINED_PIXELS = 0.5
# A level ends after this many steps, or with a step that moves no more than so many pixels.
MAX_STEPS = 8
MIN_STEP_PIXELS = 0.02
# fraction of the pixels that must show some structure
MIN_STRUCTURE_FRACTION = 0.002
# fraction of the pixels that two photos must both expose well, or nobody expects them to fit
MIN_USABLE_FRACTION = 0.05
# Smoothing leaves 0.08 of the power of the gradient of noise, and 0.3 to 0.6 of that of a scene.
MIN_POWER_LEFT = 0.28
# Aligned photos are at least that similar, all others less.
MIN_SIMILARITY = 0.6
# Without enough blocks, similarity alone decides: a shift by 2 pixels of the level leaves 0.9.
MIN_SIMILARITY_WITHOUT_BLOCKS = 0.8
# variance of a pixel value by rounding
ROUNDING_VARIANCE = 1 / 12
# peaks of the correlation from which a search starts
PEAK_COUNT = 3
# blocks a side in which the remaining shift is measured
BLOCKS_PER_SIDE = 4
# A block counts if its shift is known to this fraction of the largest shift that is allowed.
MAX_RELATIVE_SIGMA = 0.3
# blocks that must count before they can tell anything
MIN_BLOCKS = 4
# The largest shift of a block that is allowed: in pixels of the photo, and of the level.
MAX_BLOCK_SHIFT = 0.75
MAX_LEVEL_SHIFT = 0.1
# fraction of an image that the other one must cover
MIN_OVERLAP_FRACTION = 0.25
# A residual of this fraction of the contrast counts half in the error of a motion.
SPREAD_FRACTION = 0.25
# points a side at which a displacement is measured
GRID_POINTS = 9


@dataclass(frozen=True, kw_only=True, eq=False)
class Level:
    """Two photos at one level: float32 (h, w) in values of the darker one, from `low` to `high`."""

    moving: F32
    fixed: F32
    low: float
    high: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Fit:
    """The motion of two photos at a level, and what the normal equations say about it.

    Attributes
    ----------
    H : (3, 3)
        The motion, in pixels of the level.
    next : (3, 3)
        The motion after one more step.
    step : float
        Displacement by that step which 95 % of the image does not exceed, pixels of the level.
    usable : float
        Fraction of the pixels that both photos expose well.
    similarity : float
        Correlation of the gradients of both photos: 1 if they are equal, 0 if they are unrelated.
    shifts : (n,)
        How far the blocks that are measured well would move, pixels of the level.
    scale : int
        Pixels of the photo in one pixel of the level.
    """

    H: F64
    next: F64
    step: float
    usable: float
    similarity: float
    shifts: F64
    scale: int

    @property
    def is_usable(self) -> bool:
        """Whether both photos expose enough pixels well to expect that they fit."""
        return self.usable >= MIN_USABLE_FRACTION

    @property
    def is_confirmed(self) -> bool:
        """Whether the photos are similar, and most blocks would stay where they are."""
        return self._is_confirmed(margin=1.0)

    @property
    def is_refuted(self) -> bool:
        """Whether it takes more than MARGIN to make `is_confirmed` or `is_usable` another one."""
        is_clearly_usable = self.usable >= MARGIN * MIN_USABLE_FRACTION
        return is_clearly_usable and not self._is_confirmed(margin=MARGIN)

    def _is_confirmed(self, margin: float) -> bool:
        """Return `is_confirmed` for measures that are better by the factor `margin`."""
        similarity = margin * self.similarity
        if not self.has_enough_blocks:
            return similarity >= MIN_SIMILARITY_WITHOUT_BLOCKS
        if similarity < MIN_SIMILARITY:
            return False
        return self.median_shift <= margin * allowed_shift(self.scale)

    @property
    def median_shift(self) -> float:
        """Median of `shifts`; infinite without enough blocks."""
        return float(np.median(self.shifts)) if self.has_enough_blocks else np.inf

    @property
    def has_enough_blocks(self) -> bool:
        """Whether enough blocks are measured well to tell where they would move."""
        return len(self.shifts) >= MIN_BLOCKS

    @property
    def motion(self) -> F64:
        """The motion H in pixels of the photos."""
        return homography.enlarge(self.H, self.scale)

    @property
    def displacement(self) -> float:
        """Displacement by the next step in pixels of the photo."""
        return self.step * self.scale


def allowed_shift(scale: int) -> float:
    """Return the largest shift of a block of aligned photos, in pixels of a level.

    `scale` is the number of pixels of the photo in one pixel of the level.
    """
    return max(MAX_BLOCK_SHIFT / scale, MAX_LEVEL_SHIFT)


def match_values(dark: Array, bright: Array, H: F64) -> Level:
    """Return the Level of two gray photos of 8 bits, whose overlap after a motion H has equal ranks.

    Examples
    --------
    >>> ramp = np.arange(10, 90, dtype=np.uint8).reshape(8, 10)
    >>> level = match_values(ramp, 2 * ramp, np.eye(3))
    >>> bool(np.nanmax(np.abs(level.moving - level.fixed)) < 1)
    True
    """
    height, width = dark.shape
    center = np.array([width - 1, height - 1]) / 2
    dx, dy = np.rint(warp.apply(H, [center])[0] - center).astype(int)
    seen = dark[max(-dy, 0) : height - max(dy, 0), max(-dx, 0) : width - max(dx, 0)]
    seen_bright = bright[max(dy, 0) : height + min(dy, 0), max(dx, 0) : width + min(dx, 0)]
    return match_ranks(dark, bright, seen, seen_bright)


def match_ranks(dark: Array, bright: Array, seen: Array, seen_bright: Array) -> Level:
    """Return the Level of two gray photos of 8 bits, of which two parts show the same things."""
    counts = np.bincount(seen.ravel(), minlength=256)
    values = np.flatnonzero(counts)
    bright_counts = np.bincount(seen_bright.ravel(), minlength=256)
    z = np.arange(256)
    if not len(values):
        matched = z.astype(float)
    else:
        matched = np.interp(_middle_ranks(bright_counts), _middle_ranks(counts)[values], values)
    low = DARK_FRACTION * 255
    high = SATURATED_FRACTION * 255
    # Noise and clipping end at the same light in both photos, so that the outline of a lamp is the
    # same in both, too.
    highest = max(min(matched[int(high)], high), low)
    moving_table = np.clip(z, low, highest).astype(np.float32)
    fixed_table = np.clip(matched, low, highest).astype(np.float32)
    return Level(moving=moving_table[dark], fixed=fixed_table[bright], low=low, high=float(highest))


def _middle_ranks(counts: Array) -> F64:
    """Return the rank from 0 to 1 of the middle of each pixel value (256,) of a histogram."""
    return np.asarray((np.cumsum(counts) - counts / 2) / max(counts.sum(), 1))


def smooth(level: Level) -> Level:
    """Return both photos smoothed, so that interpolation does not favor fractions of pixels."""
    sigma = (0, SMOOTHING_SIGMA, SMOOTHING_SIGMA)
    images = scipy.ndimage.gaussian_filter(np.stack([level.moving, level.fixed]), sigma)
    return replace(level, moving=images[0], fixed=images[1])


def fit(level: Level, H: F64, scale: int) -> Fit:
    """Return the Fit of two photos at a motion H.

    `scale` is the number of pixels of the photo in one pixel of the level.
    """
    shape = level.fixed.shape
    height, width = shape
    radius = np.hypot(height, width) / 2
    y = (np.arange(height, dtype=np.float32)[:, None] - (height - 1) / 2) / radius
    x = (np.arange(width, dtype=np.float32) - (width - 1) / 2) / radius
    moved = move(level.moving, H)
    return fit_moved(level, moved, H, scale, shape=shape, y=y, x=x, sum_blocks=_sum_blocks)


def fit_moved(
    level: Level,
    moved: F32,
    H: F64,
    scale: int,
    *,
    shape: tuple[int, ...],
    y: F32,
    x: F32,
    sum_blocks: Callable[[F32, F32], F64],
) -> Fit:
    """Return the Fit of an image, or of a stack of tiles of it, whose darker photo was moved by H.

    Parameters
    ----------
    level : Level
        Its `fixed` is (..., h, w); its `moving` is not used.
    moved : (..., h, w)
        The darker photo, moved by H; NaN where nothing is known.
    H : (3, 3)
    scale : int
        Pixels of the photo in one pixel of the level.
    shape : (int, int)
        Size of the whole image.
    y, x : (..., h, 1) and (..., 1, w)
        Distance from the middle of the image, 1 at its corners.
    sum_blocks : function
        From terms (5, ..., h - 2, w - 2) and weights (..., h - 2, w - 2) to N (blocks, 5, 5).
    """
    fixed = level.fixed
    rows = slice(1, -1)
    r = moved[..., rows, rows] - fixed[..., rows, rows]
    moved_x = (moved[..., rows, 2:] - moved[..., rows, :-2]) / 2
    moved_y = (moved[..., 2:, rows] - moved[..., :-2, rows]) / 2
    fixed_x = (fixed[..., rows, 2:] - fixed[..., rows, :-2]) / 2
    fixed_y = (fixed[..., 2:, rows] - fixed[..., :-2, rows]) / 2
    G_x = (moved_x + fixed_x) / 2
    G_y = (moved_y + fixed_y) / 2
    squared_gradient = G_x**2 + G_y**2
    is_known = np.isfinite(r + squared_gradient) & (squared_gradient > 0)
    usable = _measure_usable(level, moved)
    if is_known.mean() < MIN_STRUCTURE_FRACTION:
        return Fit(
            H=H, next=H, step=0.0, usable=usable, similarity=0.0, shifts=np.zeros(0), scale=scale
        )
    similarity = _correlate(
        np.stack([moved_x[is_known], moved_y[is_known]]),
        np.stack([fixed_x[is_known], fixed_y[is_known]]),
    )
    r[~is_known] = 0
    squared_gradient[~is_known] = 0
    known = r[is_known]
    scale_of_r = 1.5 * float(np.median(np.abs(known[:: len(known) // 10_000 + 1]))) + 0.5
    variance_of_r = scale_of_r**2 + EXPLAINED_PIXELS**2 * squared_gradient
    w = np.asarray(is_known / (1 + r**2 / (4 * variance_of_r)), np.float32)
    arc = x[..., rows] * G_y - y[..., rows, :] * G_x
    terms = np.stack([G_x, G_y, arc, np.ones_like(r), r])
    terms[:, ~is_known] = 0
    N = sum_blocks(terms, w)
    dx, dy, turn, _ = _solve(N.sum(axis=0), [0, 1, 2, 3])
    radius = np.hypot(shape[0], shape[1]) / 2
    delta = warp.turn(shape, np.rad2deg(turn / radius), (dy, dx))
    return Fit(
        H=H,
        next=delta @ H,
        step=displacement(delta, shape),
        usable=usable,
        similarity=similarity,
        shifts=_block_shifts(N, MAX_RELATIVE_SIGMA * allowed_shift(scale)),
        scale=scale,
    )


def _measure_usable(level: Level, moved: F32) -> float:
    """Return the fraction of the pixels that both photos expose well."""
    is_exposed = (moved > level.low) & (moved < level.high)
    is_exposed &= (level.fixed > level.low) & (level.fixed < level.high)
    return float(is_exposed.mean())


def _correlate(a: F32, b: F32) -> float:
    """Return the correlation of two arrays whose means are 0."""
    power = float(np.sum(a * a) * np.sum(b * b))
    return float(np.sum(a * b)) / np.sqrt(power) if power > 0 else 0.0


def _solve(N: F64, unknowns: list[int]) -> F64:
    """Return the solutions (..., n) of normal equations (..., 5, 5) for n of the terms."""
    terms = np.array(unknowns)
    normal = N[..., terms[:, None], terms]
    ridge = 1e-6 * np.trace(normal, axis1=-2, axis2=-1) + 1e-9
    normal = normal + ridge[..., None, None] * np.eye(len(terms))
    return np.asarray(np.linalg.solve(normal, N[..., terms, 4, None])[..., 0])


def _block_shifts(N: F64, max_sigma: float) -> F64:
    """Return how far each block would move alone, if that is known to `max_sigma` pixels."""
    N = N[np.linalg.det(N[:, :2, :2]) > 0]
    variance = N[:, 4, 4] / np.maximum(N[:, 3, 3], 1) + ROUNDING_VARIANCE
    least_known = np.linalg.eigvalsh(N[:, :2, :2])[:, 0]
    is_known = variance < max_sigma**2 * least_known
    shifts = _solve(N[is_known], [0, 1, 3])[:, :2]
    return np.asarray(np.hypot(shifts[:, 0], shifts[:, 1]))


def _sum_blocks(terms: F32, w: F32) -> F64:
    """Return N (blocks, 5, 5) of terms (5, h, w)."""
    sums = []
    # The blocks divide the part of the image that has weight, which may be small.
    used_rows = np.flatnonzero(w.any(axis=1))
    used_columns = np.flatnonzero(w.any(axis=0))
    all_rows = np.arange(used_rows[0], used_rows[-1] + 1)
    all_columns = np.arange(used_columns[0], used_columns[-1] + 1)
    for rows in np.array_split(all_rows, BLOCKS_PER_SIDE):
        for columns in np.array_split(all_columns, BLOCKS_PER_SIDE):
            if not rows.size or not columns.size:
                continue
            block = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
            flat = terms[:, *block].reshape(len(terms), -1)
            sums.append((flat * w[block].reshape(-1)) @ flat.T)
    return np.asarray(sums, np.float64)


def move(image: F32, H: F64) -> F32:
    """Return an image (h, w) moved by H, by linear interpolation; NaN where nothing is known."""
    offset = np.rint(H[1::-1, 2]).astype(int)
    if np.allclose(H, warp.as_homographies([offset])[0], rtol=0, atol=1e-6):
        dy, dx = offset
        height, width = image.shape
        moved = np.full_like(image, np.nan)
        target = np.s_[max(dy, 0) : height + min(dy, 0), max(dx, 0) : width + min(dx, 0)]
        source = np.s_[max(-dy, 0) : height - max(dy, 0), max(-dx, 0) : width - max(dx, 0)]
        if moved[target].size and moved[target].shape == image[source].shape:
            moved[target] = image[source]
        return moved
    back = np.linalg.inv(H)
    if not np.any(H[2, :2]):
        matrix = back[1::-1, 1::-1]
        return np.asarray(
            scipy.ndimage.affine_transform(image, matrix, back[1::-1, 2], order=1, cval=np.nan)
        )
    y, x = np.indices(image.shape)
    sources = warp.apply(back, np.stack([x.ravel(), y.ravel()], axis=-1))
    moved = scipy.ndimage.map_coordinates(image, sources.T[::-1], order=1, cval=np.nan)
    return np.asarray(moved.reshape(image.shape))


def displacement(H: F64, shape: tuple[int, ...]) -> float:
    """Return the displacement by H that 95 % of an image does not exceed, pixels."""
    y, x = np.mgrid[0 : shape[0] - 1 : GRID_POINTS * 1j, 0 : shape[1] - 1 : GRID_POINTS * 1j]
    points = np.stack([x.ravel(), y.ravel()], axis=-1)
    moved = warp.apply(H, points) - points
    return float(np.quantile(np.hypot(moved[:, 0], moved[:, 1]), 0.95))


def descend(level: Level, H: F64, scale: int) -> Fit:
    """Return the Fit at the end of steps from H at one level."""
    found = fit(level, H, scale)
    for _ in range(MAX_STEPS):
        if found.step <= MIN_STEP_PIXELS:
            break
        found = fit(level, found.next, scale)
    return found


def is_reduced(bright: Sequence[Array], number: int) -> bool:
    """Return whether noise made a level coarser than it would have to be."""
    return number > _first_level(bright, MAX_PIXELS)


def finest_level(dark: Sequence[Array], bright: Sequence[Array]) -> int | None:
    """Return the finest level at which structure outweighs noise in both photos, or None."""
    for number in range(_first_level(bright, MAX_PIXELS), len(bright)):
        if min(bright[number].shape) < MIN_SIDE_PIXELS:
            break
        level = match_values(dark[number], bright[number], np.eye(3))
        smoothed = smooth(level)
        left = min(
            _gradient_power(smoothed.moving) / max(_gradient_power(level.moving), 1e-9),
            _gradient_power(smoothed.fixed) / max(_gradient_power(level.fixed), 1e-9),
        )
        if left > MIN_POWER_LEFT:
            return number
    return None


def _gradient_power(image: F32) -> float:
    """Return the mean square of the gradient of an image (h, w)."""
    G_x = (image[:, 2:] - image[:, :-2]) / 2
    G_y = (image[2:] - image[:-2]) / 2
    return float(np.mean(G_x**2) + np.mean(G_y**2))


def _first_level(pyramid: Sequence[Array], max_pixels: float) -> int:
    small = (number for number, image in enumerate(pyramid) if image.size <= max_pixels)
    return next(small, len(pyramid) - 1)


def check(dark: Sequence[Array], bright: Sequence[Array], H: F64, number: int) -> Fit:
    """Return the Fit of two pyramids of gray photos at a level, for H in pixels of the photos."""
    scale = 2**number
    small_H = homography.enlarge(H, 1 / scale)
    return fit(smooth(match_values(dark[number], bright[number], small_H)), small_H, scale)


def common_light(dark: Sequence[Array], bright: Sequence[Array], H: F64, number: int) -> F32:
    """Return both photos (2, h, w), the fixed one first, in values of the darker one at a level."""
    small_H = homography.enlarge(H, 1 / 2**number)
    level = smooth(match_values(dark[number], bright[number], small_H))
    return np.stack([level.fixed, level.moving])


def error(level: Level, H: F64, spread: float) -> float:
    """Return the mean of r^2 / (r^2 + spread^2) at a motion H, from 0 to 1; 1 without overlap."""
    r = move(level.moving, H) - level.fixed
    r = r[np.isfinite(r)]
    if len(r) < MIN_OVERLAP_FRACTION * level.fixed.size:
        return 1.0
    return float(np.mean(r**2 / (r**2 + spread**2)))


def refine(dark: Sequence[Array], bright: Sequence[Array], H: F64, number: int) -> Fit:
    """Return the Fit at the end of steps from H, in pixels of the photos, at one level alone."""
    scale = 2**number
    small_H = homography.enlarge(H, 1 / scale)
    near = descend(match_values(dark[number], bright[number], small_H), small_H, scale).H
    return descend(smooth(match_values(dark[number], bright[number], near)), near, scale)


def search(
    dark: Sequence[Array], bright: Sequence[Array], starts: Sequence[F64], finest: int
) -> Fit:
    """Return the Fit at the rigid motion that a descent through the pyramids finds.

    At the coarsest level every start is tried, and the best one is followed to the finest level.

    Parameters
    ----------
    dark, bright : sequence of (h, w) uint8
        Gray photos at every size, full resolution first.
    starts : sequence of (3, 3)
        Motions in pixels of the photos. Peaks of the correlation are starts, too.
    finest : int
        Level at which the descent ends.
    """
    coarsest = finest
    while coarsest + 1 < len(bright) and min(bright[coarsest + 1].shape) >= MIN_SIDE_PIXELS:
        coarsest += 1
    level = match_values(dark[coarsest], bright[coarsest], np.eye(3))
    shifts = cerman.peaks(cerman.correlation(np.stack([level.fixed, level.moving])), PEAK_COUNT)
    motions = [homography.enlarge(H, 1 / 2**coarsest) for H in starts]
    motions += [warp.as_homographies([shift])[0] for shift in shifts]
    spread = SPREAD_FRACTION * float(np.nanstd(level.fixed)) + 1
    ends = [descend(level, H, 2**coarsest).H for H in motions]
    H = min(ends, key=lambda end: error(level, end, spread))
    for number in range(coarsest - 1, finest - 1, -1):
        H = homography.enlarge(H)
        level = match_values(dark[number], bright[number], H)
        H = descend(level, H, 2**number).H
    level = smooth(match_values(dark[finest], bright[finest], H))
    return descend(level, H, 2**finest)
