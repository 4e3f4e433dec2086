"""A picture for photographers: illumination compressed as needed, exposure and contrast set from the map.

L       luminance                  (H, W), any linear unit; lL is log10 L, in decades
light   large-scale light of lL    (H, W), a lL + b of a guided filter: smooth except at its edges
x       lL - (1 - share) light     (H, W): the contrast of the light is multiplied by `share`, detail stays
Lm      scaled luminance           key 10^(CONTRAST (x - mean of x)), about 1 where the curve bends
Ld      (curve of Lm - black) / (1 - black), with the curve of `tonemap.reinhard` and its `white`

The defaults of Reinhard's paper look flat for a photograph: the black point is not set, and half of
the display's range is kept for the brightest pixels. The a and b of the guided filter are computed
on a coarse grid (He and Sun, Fast guided filter, 2015), from the means and variances of the grid's
cells. The grid is centered in the image, so a mirrored image gets a mirrored picture. Where `share`
is below 1, the picture can reverse gradients next to an edge of light, as with a bilateral filter:
before an edge of three decades, it gets darker by about 5 of 255 pixel values.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hdrlab.core import colour, extremes
from hdrlab.core.arrays import F32, Array, ArrayLike, Indices, as_luminance, as_radiance
from hdrlab.core.filters.blur import blur_matrix
from hdrlab.core.threads import map_in_threads
from hdrlab.errors import InputError
from hdrlab.fast._bands import banded
from hdrlab.tonemap.reinhard import display

# cd/m^2: the calibration constant K of exposure meters for reflected light, ISO 2720
METER_CONSTANT = 12.5
# half of the guided filter's window, as a fraction of the longer side
WINDOW_FRACTION = 0.03
# cells of the coarse grid in half a window
CELLS_PER_RADIUS = 4
# rows of an image whose cells are averaged at a time
ROWS_PER_BAND = 256
# Darker pixels than this fraction of the median luminance have no more detail.
MIN_LUMINANCE_FRACTION = 1e-6
# decades; a step of light that remains an edge
EDGE_DECADES = 0.35
# decades of light that a display shows easily
DISPLAY_DECADES = 1.9
# least fraction of the light's contrast that remains
MIN_SHARE = 0.45
# quantiles of the light that count as its range
LIGHT_QUANTILES = (0.005, 0.995)
# quantiles of x that count as its range
LEVEL_QUANTILES = (0.01, 0.99)
# key of a map whose log luminance is symmetric about its mean
MIDDLE_KEY = 0.24
# A map is dark for its range if its skew is below this; it gets a lower key, as nights do.
DARK_SKEW = -0.35
# EV at ISO 100 of a scene that gets the full key, and of one that gets the key of a night.
BRIGHT_SCENE_EV = 8.0
NIGHT_SCENE_EV = 0.0
# key of a night relative to the key of a bright scene
NIGHT_KEY_FRACTION = 0.08 / 0.18
# largest display luminance that becomes black at night, and the fraction of the pixels
NIGHT_MAX_BLACK = 0.02
NIGHT_BLACK_FRACTION = 0.05
# largest mean pixel value of a picture at night, and of one of the last bright scene, of 255
NIGHT_MAX_MEAN = 78.0
BRIGHT_MAX_MEAN = 135.0
# factor of the key from one trial to the next while the mean is too large, and number of trials
KEY_STEP = 0.92
MAX_KEY_STEPS = 20
# display value of the largest channel from which a color is bleached: 252 of 255
BLEACHED_VALUE = 0.97
# largest fraction of the pixels that are bleached
MAX_BLEACHED_FRACTION = 0.1
# least share of the light's contrast to avoid that; less would reverse gradients visibly
MIN_UNBLEACHED_SHARE = 0.6
# factor of key and share from one trial to the next while too much is bleached
BLEACHED_STEP = 0.95
# contrast of the picture relative to that of x
CONTRAST = 1.25
# fraction of the pixels that become white
WHITE_FRACTION = 0.005
# fraction of the pixels that become black
BLACK_FRACTION = 0.002
# largest display luminance that becomes black
MAX_BLACK = 0.012
# largest scaled luminance, to avoid an overflow
MAX_SCALED_LUMINANCE = 1e15
# Settings are chosen from at least this many pixels along the shorter side, where there are so
# many.
MIN_SAMPLED_SIDE = 360


@dataclass(frozen=True, kw_only=True)
class Light:
    """The large-scale light of an image, a lL + b, with a and b in the cells of a coarse grid.

    slope, offset : (h, W), a and b in h rows of cells, at each column of the image
    row_weights : (H, h), weights of the rows of cells in each row of the image
    """

    slope: Array
    offset: Array
    row_weights: F32

    def evaluate(self, lL: F32) -> Array:
        """Return the light of an image lL (H, W)."""
        return self.row_weights @ self.slope * lL + self.row_weights @ self.offset


@dataclass(frozen=True, kw_only=True)
class Levels:
    """The first and the last percentile of x, and the mean of x clipped at these."""

    low: float
    mean: float
    high: float


def measure_scene_ev(E: ArrayLike, luminance_of_unit: float) -> float:
    """Return the exposure value of a scene at ISO 100, from the geometric mean of its luminance.

    EV = log2(L S / K) with S = 100 and the constant K = 12.5 cd/m^2 of exposure meters. A sunny
    landscape has about EV 15, a living room in the evening EV 5, a lit street at night EV 2.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance map.
    luminance_of_unit : float
        cd/m^2 of a surface with E = 1.

    Examples
    --------
    >>> measure_scene_ev(np.full((2, 3), 4.0), luminance_of_unit=0.5)
    4.0
    """
    E = as_radiance(E)
    step = max(1, min(E.shape[:2]) // MIN_SAMPLED_SIDE)
    L = colour.luminance(E[::step, ::step])
    if not L.any():
        return -np.inf
    mean_log2 = np.log2(L[L > 0]).mean(dtype=np.float64)
    return round(float(mean_log2 + np.log2(luminance_of_unit * 100 / METER_CONSTANT)), 2)


def choose_settings(E: ArrayLike, *, scene_ev: float | None = None) -> dict[str, float]:
    """Choose the settings of `photograph`, and the saturation, for a radiance map E (H, W[, 3]).

    `scene_ev` is the result of `measure_scene_ev`; None if it is unknown. It keeps a night dark:
    between EV 8 and EV 0, the key falls to four ninths, more pixels become black, and the mean
    pixel value is limited, which lowers the key further where a bright sky covers half of the image.

    share
        The fraction of the light's contrast that remains, 1 where it spans at most DISPLAY_DECADES
        and colors are not bleached.
    key
        MIDDLE_KEY; up to twice that if most of the map is bright for its range, less than half of
        it if most is dark. Key and share are lower if otherwise more than MAX_BLEACHED_FRACTION of
        the pixels would have a channel at white: a bright sky keeps its clouds, and saturated light
        keeps its color. The share falls no lower than MIN_UNBLEACHED_SHARE for that.
    white, black
        The scaled and the display luminance beyond which WHITE_FRACTION and BLACK_FRACTION of the
        pixels lie.
    saturation
        1.25 for grays, 0.95 if half of the pixels have fully saturated colors.

    Examples
    --------
    >>> E = np.geomspace(1, 1000, 4800, dtype=np.float32).reshape(60, 80)
    >>> {name: round(value, 2) for name, value in choose_settings(E).items()}
    {'share': 0.67, 'key': 0.24, 'white': 4.37, 'black': 0.01, 'saturation': 1.0}
    """
    E = as_radiance(E)
    step = max(1, min(E.shape[:2]) // MIN_SAMPLED_SIDE)
    E = E[::step, ::step]
    L = colour.luminance(E)
    lL = find_logarithm(L)(L)
    light = filter_light(lL)
    darkest, brightest = np.quantile(light.evaluate(lL), LIGHT_QUANTILES)
    share = 1.0
    if brightest - darkest > DISPLAY_DECADES:
        share = max(MIN_SHARE, DISPLAY_DECADES / float(brightest - darkest))
    x = compress_light(lL, share, light)
    levels = find_levels(x)
    skew = (2 * levels.mean - levels.low - levels.high) / max(levels.high - levels.low, 1e-6)
    darkness = 0.0 if scene_ev is None else _measure_darkness(scene_ev)
    # Without an absolute luminance, the histogram decides.
    excess = min(0.0, skew - DARK_SKEW) if scene_ev is None else 0.0
    key = MIDDLE_KEY * 2 ** (skew + 2 * excess) * NIGHT_KEY_FRACTION**darkness
    saturation = 1.0
    if E.ndim == 3 and L.any():
        colors = E[L > 0]
        purity = 1 - colors.min(axis=-1) / colors.max(axis=-1)
        saturation = 1.25 - 0.3 * float(np.median(purity))
    peaks = _measure_peaks(E, L, saturation)
    tones = _choose_tones(x, levels.mean, key, darkness, peaks)
    if darkness > 0:
        max_mean = BRIGHT_MAX_MEAN * (NIGHT_MAX_MEAN / BRIGHT_MAX_MEAN) ** darkness
        for _ in range(MAX_KEY_STEPS):
            if tones.mean_pixel_value <= max_mean:
                break
            tones = _choose_tones(x, levels.mean, KEY_STEP * tones.key, darkness, peaks)
    while tones.bleached_fraction > MAX_BLEACHED_FRACTION and share > MIN_UNBLEACHED_SHARE:
        share = max(MIN_UNBLEACHED_SHARE, BLEACHED_STEP * share)
        x = compress_light(lL, share, light)
        levels = find_levels(x)
        tones = _choose_tones(x, levels.mean, BLEACHED_STEP * tones.key, darkness, peaks)
    return {
        "share": share,
        "key": tones.key,
        "white": tones.white,
        "black": tones.black,
        "saturation": saturation,
    }


@dataclass(frozen=True, kw_only=True)
class _Tones:
    """Key, white and black of a picture, and what they give.

    mean_pixel_value : of the gray picture, of 255
    bleached_fraction : of the pixels whose largest channel is above BLEACHED_VALUE
    """

    key: float
    white: float
    black: float
    mean_pixel_value: float
    bleached_fraction: float


def _measure_peaks(E: F32, L: F32, saturation: float) -> F32:
    """Return the largest channel of each pixel of a picture, relative to its luminance, (H, W)."""
    if E.ndim == 2:
        return np.ones_like(L)
    ratio = np.divide(E.max(axis=-1), L, out=np.ones_like(L), where=L > 0)
    return np.float32(1 - saturation) + np.float32(saturation) * ratio


def _choose_tones(x: F32, mean: float, key: float, darkness: float, peaks: F32) -> _Tones:
    """Return white and black for a key, and what they give; `peaks` is from `_measure_peaks`."""
    Lm = scale(x, mean, key)
    white = max(1.0, float(np.quantile(Lm, 1 - WHITE_FRACTION)))
    Ld = display(Lm, Lm, white)
    max_black = MAX_BLACK + darkness * (NIGHT_MAX_BLACK - MAX_BLACK)
    black_fraction = BLACK_FRACTION + darkness * (NIGHT_BLACK_FRACTION - BLACK_FRACTION)
    black = min(max_black, float(np.quantile(Ld, black_fraction)))
    shown = np.clip((Ld - black) / (1 - black), 0, 1)
    encoded = colour.encode_srgb(shown)
    return _Tones(
        key=key,
        white=white,
        black=black,
        mean_pixel_value=255 * float(np.mean(encoded, dtype=np.float64)),
        bleached_fraction=float(np.mean(shown * peaks > BLEACHED_VALUE)),
    )


def _measure_darkness(scene_ev: float) -> float:
    """Return 0 for scenes from BRIGHT_SCENE_EV, 1 for scenes up to NIGHT_SCENE_EV."""
    darkness = (BRIGHT_SCENE_EV - scene_ev) / (BRIGHT_SCENE_EV - NIGHT_SCENE_EV)
    return float(np.clip(darkness, 0, 1))


def find_logarithm(L: F32) -> Callable[[F32], F32]:
    """Return the function from L to lL = log10 L, with a lower bound from the median of this L."""
    floor = np.float32(max(MIN_LUMINANCE_FRACTION * extremes.positive_median(L), 1e-37))

    def logarithm(L: F32) -> F32:
        return np.log(np.maximum(L, floor)) * np.float32(1 / np.log(10))

    return logarithm


def filter_light(L: F32, take: Callable[[F32], F32] = np.positive) -> Light:
    """Return the Light of an image by a guided filter on a coarse grid [He15].

    `take` computes lL from rows of L (H, W). The slope a is near 1 at edges of light, and near 0 in
    detail.
    """
    radius = max(1, round(WINDOW_FRACTION * max(L.shape)))
    step = max(1, radius // CELLS_PER_RADIUS)
    row_averages = cell_weights(L.shape[0], step)
    column_averages = cell_weights(L.shape[1], step)
    cells, squares = average_cells(L, take, row_averages, column_averages)
    width = 2 * (radius // step) + 1
    kernel = np.full(width, 1 / width)
    blur_rows = blur_matrix(cells.shape[0], kernel)
    blur_columns = blur_matrix(cells.shape[1], kernel)
    mean: Array = blur_rows @ cells @ blur_columns
    variance: Array = np.maximum(blur_rows @ squares @ blur_columns - mean * mean, 0)
    a = variance / (variance + np.float32(EDGE_DECADES**2))
    b = mean - a * mean
    blur_and_enlarge = blur_columns @ interpolation_weights(L.shape[1], step).T
    return Light(
        slope=blur_rows @ a @ blur_and_enlarge,
        offset=blur_rows @ b @ blur_and_enlarge,
        row_weights=interpolation_weights(L.shape[0], step),
    )


def average_cells(
    L: F32, take: Callable[[F32], F32], row_averages: F32, column_averages: F32
) -> tuple[F32, F32]:
    """Return the means (h, w) of lL and of lL^2 in the cells, a band of rows at a time.

    `row_averages` (h, H) and `column_averages` (w, W) are `cell_weights`.
    """
    mean = np.zeros((len(row_averages), len(column_averages)), np.float32)
    squared_mean = np.zeros_like(mean)

    def average_band(top: int) -> tuple[Indices, Array, F32]:
        rows = slice(top, top + ROWS_PER_BAND)
        lL = take(L[rows])
        cell_rows = np.flatnonzero(row_averages[:, rows].any(axis=1))
        averages = row_averages[cell_rows, rows]
        means: Array = averages @ lL @ column_averages.T
        squared_means: F32 = averages @ (lL * lL) @ column_averages.T
        return cell_rows, means, squared_means

    bands = map_in_threads(average_band, range(0, len(L), ROWS_PER_BAND), pixels=L.size)
    for cell_rows, means, squared_means in bands:
        mean[cell_rows] += means
        squared_mean[cell_rows] += squared_means
    return mean, squared_mean


def cell_weights(n: int, step: int) -> F32:
    """Return the weights (m, n) of n pixels in the means of m cells, `step` pixels wide.

    The cells are centered. The first and the last one can reach beyond the pixels, where they count
    only the part with pixels.

    Examples
    --------
    >>> cell_weights(5, 2)  # the outer cells have one and a half pixels in the image
    array([[0.6666667 , 0.33333334, 0.        , 0.        , 0.        ],
           [0.        , 0.25      , 0.5       , 0.25      , 0.        ],
           [0.        , 0.        , 0.        , 0.33333334, 0.6666667 ]],
          dtype=float32)
    """
    cell_count = -(-n // step)
    starts = (n - cell_count * step) / 2 + step * np.arange(cell_count)
    pixels = np.arange(n)
    ends = np.minimum(pixels + 1, starts[:, None] + step)
    overlap = np.maximum(ends - np.maximum(pixels, starts[:, None]), 0)
    return (overlap / overlap.sum(axis=1, keepdims=True)).astype(np.float32)


def interpolation_weights(n: int, step: int) -> F32:
    """Return the weights (n, m) of linear interpolation at n pixels from the centers of m cells.

    The cells are those of `cell_weights`. Pixels beyond the center of the last cell take its value.
    """
    cell_count = -(-n // step)
    first_center = (n - cell_count * step + step - 1) / 2
    position = np.clip((np.arange(n) - first_center) / step, 0, cell_count - 1)
    distance = np.abs(position[:, None] - np.arange(cell_count))
    return np.maximum(1 - distance, 0).astype(np.float32)


def compress_light(lL: F32, share: float, light: Light, row_weights: F32 | None = None) -> F32:
    """Return x = lL - (1 - share) (a lL + b).

    For some rows (n, W) of an image, give the weights (n, h) of the cells in these rows.
    """
    if share == 1:
        return lL
    if row_weights is None:
        row_weights = light.row_weights
    # A few rows depend on a few cells only.
    cells = np.flatnonzero(row_weights.any(axis=0))
    weights = row_weights[:, cells]
    a = weights @ (np.float32(1 - share) * light.slope[cells])
    b = weights @ (np.float32(1 - share) * light.offset[cells])
    return np.asarray(lL - (a * lL + b), np.float32)


def find_levels(x: F32) -> Levels:
    """Return the Levels of x, from an even grid of its pixels."""
    row_step = max(1, x.shape[0] // MIN_SAMPLED_SIDE)
    column_step = max(1, x.shape[1] // MIN_SAMPLED_SIDE)
    sample = x[::row_step, ::column_step]
    low, high = np.quantile(sample, LEVEL_QUANTILES)
    mean = np.clip(sample, low, high).mean(dtype=np.float64)
    return Levels(low=float(low), mean=float(mean), high=float(high))


def scale(x: F32, mean: float, key: float) -> F32:
    """Return Lm = key 10^(CONTRAST (x - mean)), at most MAX_SCALED_LUMINANCE."""
    gain = np.float32(CONTRAST * np.log(10))
    exponent = np.log(np.float32(key)) + gain * (x - np.float32(mean))
    return np.exp(np.minimum(exponent, np.log(np.float32(MAX_SCALED_LUMINANCE))))


def photograph(L: ArrayLike, *, share: float, key: float, white: float, black: float) -> F32:
    """Return display luminance (H, W) in [0, 1] of luminance L (H, W).

    `choose_settings` describes the settings, and chooses them for a map.

    Raises
    ------
    InputError
        If luminance is not (H, W), finite and not negative, or a setting is out of its range.
    """
    settings = (share, key, white, black)
    are_numbers = all(isinstance(setting, int | float) for setting in settings)
    if not (are_numbers and 0 < share <= 1 and key > 0 and white > 0 and 0 <= black < 1):
        raise InputError(
            "expected share in (0, 1], key and white above 0, black in [0, 1), "
            f"got {share=}, {key=}, {white=}, {black=}"
        )
    L = as_luminance(L)
    logarithm = find_logarithm(L)
    light = filter_light(L, logarithm)
    sample = np.s_[:: max(1, len(L) // MIN_SAMPLED_SIDE)]
    x = compress_light(logarithm(L[sample]), share, light, light.row_weights[sample])
    mean = find_levels(x).mean

    def tone_map_rows(L: F32, row_weights: F32) -> F32:
        Lm = scale(compress_light(logarithm(L), share, light, row_weights), mean, key)
        scaled = (display(Lm, Lm, white) - np.float32(black)) / np.float32(1 - black)
        return np.where(L > 0, np.clip(scaled, 0, 1), 0)

    return banded(tone_map_rows, L, light.row_weights)
