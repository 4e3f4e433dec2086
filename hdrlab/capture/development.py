"""Develop a RAW photo: from the levels of a mosaic to an image in sRGB, one function for each step.

Z      RAW levels    (H, W), the converter's numbers; each pixel has one color filter
c      channels      (H, W) int, 0 to 2: the color of each pixel's filter
X      exposure      (H, W), 0 is no light, 1 is the white level
g      gains         (3,) of white balance, the smallest of them 1
E      image         (H, W, 3), the channels of the camera, linear
M      color matrix  (3, 3), from XYZ to the channels of the camera: ColorMatrix of a DNG
C      conversion    (3, 3), from balanced channels of the camera to linear sRGB

    Z -> normalize -> X -> balance_white -> demosaic -> E -> convert -> encode_srgb

This is also the order of dcraw and LibRaw. White balance is the first step after the levels,
because there a clipped pixel can be recognized: it is 1 in all channels, before and after it.

What a mosaic tells of its own pattern: the two diagonals of each 2 x 2 pixels differ. On one of
them both pixels are green, so that they agree except for noise and detail. That decides between two
pairs of patterns. Within a pair, red and blue change places, and no pixel shows which is which: a
red scene looks as its blue twin would. `find_pattern` needs the gains of white balance, and assumes
that the mean of the scene is gray.
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from scipy.ndimage import maximum_filter

from hdrlab.capture.sensor import balance
from hdrlab.core.arrays import F32, F64, Array, ArrayLike, Indices, describe
from hdrlab.core.colour import encode_srgb
from hdrlab.core.filters import malvar
from hdrlab.core.filters.mosaic import as_channels, tile
from hdrlab.core.steps import last
from hdrlab.errors import InputError

Demosaic = Callable[[Array, Array], Array]

# XYZ of linear red, green and blue of sRGB, one a column, under D65 [IEC 61966-2-1]
XYZ_OF_SRGB = np.array(
    [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
)
# the patterns with green in the first pixel, and those with green in the second one
_GREEN_FIRST = np.array([[[1, 0], [2, 1]], [[1, 2], [0, 1]]])
_GREEN_SECOND = np.array([[[0, 1], [1, 2]], [[2, 1], [1, 0]]])


class Step(NamedTuple):
    """One step of the development: its name, and the mosaic (H, W) or image (H, W, 3) after it."""

    name: str
    image: Array


def normalize(Z: ArrayLike, *, black: ArrayLike, white: float) -> F32:
    """Return X = (Z - black) / (white - black), at most 1: levels become exposure.

    Noise in the dark stays below 0, so that its mean is right.

    Parameters
    ----------
    Z : (H, W), RAW levels
    black : level of no light; a number, or (H, W) if the filters have different ones
    white : level at which a pixel is full

    Raises
    ------
    InputError
        If the white level is not above the black level.

    Examples
    --------
    >>> normalize(np.uint16([[64, 2064, 4095]]), black=64, white=4064).tolist()
    [[0.0, 0.5, 1.0]]
    """
    Z = _as_mosaic(Z)
    black = np.asarray(black, np.float32)
    if not np.all(black < white):
        raise InputError(f"expected a white level above the black level, got {white} and {black}")
    return np.minimum((Z - black) / (np.float32(white) - black), 1)


def cell_planes(X: ArrayLike) -> Array:
    """Return the four planes (2, 2, H/2, W/2) of a mosaic: those pixels that share a place in their cell."""
    X = _as_mosaic(X)
    height = X.shape[0] // 2
    width = X.shape[1] // 2
    cells = X[: 2 * height, : 2 * width].reshape(height, 2, width, 2)
    return cells.transpose(1, 3, 0, 2)


def diagonal_differences(X: ArrayLike) -> F64:
    """Return sum |a - d| / sum (a + d) of both diagonals (2,) of the cells; the smaller one is green.

    The first diagonal joins the pixels at the top left and the bottom right. Cells with a clipped
    pixel do not count.
    """
    planes = cell_planes(X).astype(np.float64)
    is_measured = (planes < 1).all(axis=(0, 1))
    if not is_measured.any():
        raise InputError("expected a mosaic with pixels below 1, got only clipped ones")
    (top_left, top_right), (bottom_left, bottom_right) = planes[..., is_measured]
    first = np.abs(top_left - bottom_right).sum() / (top_left + bottom_right).sum()
    second = np.abs(top_right - bottom_left).sum() / (top_right + bottom_left).sum()
    return np.array([first, second])


def find_candidates(X: ArrayLike) -> Indices:
    """Return the two Bayer patterns (2, 2, 2) that the mosaic itself allows: green is known, red is not."""
    first, second = diagonal_differences(X)
    return (_GREEN_FIRST if first < second else _GREEN_SECOND).copy()


def find_pattern(X: ArrayLike, gains: ArrayLike) -> Indices:
    """Find the Bayer pattern of a mosaic from its pixels and the gains of white balance.

    Of the two candidates, it takes the one under which the mean of the scene is closer to gray after
    white balance. So it is wrong for a scene whose color outweighs that of the filters, and no
    better than a coin where red and blue have equal gains.

    Parameters
    ----------
    X : (H, W), mosaic, 0 is no light and 1 is full
    gains : (3,) that make gray gray in the light of the scene, for red, green and blue

    Returns
    -------
    (2, 2) int, channels of the filters at the top left corner

    Raises
    ------
    InputError
        For a mosaic of another shape, one with clipped pixels only, or gains that are not positive.

    Examples
    --------
    >>> gray_card = np.tile([[0.3, 0.6], [0.6, 0.2]], (4, 4))  # red filters let half of it pass
    >>> find_pattern(gray_card, gains=[2, 1, 3]).tolist()
    [[0, 1], [1, 2]]
    """
    g = np.asarray(gains, np.float64)
    if g.shape != (3,) or not np.all((g > 0) & np.isfinite(g)):
        raise InputError(f"expected three positive gains, got {describe(g)}")
    candidates = find_candidates(X)
    planes = cell_planes(X)
    is_measured = (planes < 1).all(axis=(0, 1))
    mean = planes[..., is_measured].mean(axis=-1)
    casts = []
    for pattern in candidates:
        red = g[0] * mean[pattern == 0].item()
        blue = g[2] * mean[pattern == 2].item()
        casts.append(abs(np.log(max(red, 1e-9) / max(blue, 1e-9))))
    return candidates[np.argmin(casts)]


def gray_world(X: ArrayLike, c: ArrayLike) -> F64:
    """Return gains (3,) that make the mean of the scene gray, without what is clipped."""
    return balance([pixels.mean() for pixels in _measured_pixels(X, c)])


def white_patch(X: ArrayLike, c: ArrayLike, *, quantile: float = 0.99) -> F64:
    """Return gains (3,) that make the brightest pixels white, those at a quantile of each channel.

    Clipped pixels and their neighbors do not count: they are white already, whatever the light was.
    """
    if not 0 < quantile <= 1:
        raise InputError(f"expected a quantile above 0, at most 1, got {quantile}")
    return balance([np.quantile(pixels, quantile) for pixels in _measured_pixels(X, c)])


def gray_patch(X: ArrayLike, c: ArrayLike, *, rows: slice, columns: slice) -> F64:
    """Return gains (3,) that make one patch gray, where a gray card was in the scene."""
    X = _as_mosaic(X)
    c = as_channels(c, X.shape)
    return gray_world(X[rows, columns], c[rows, columns])


def balance_white(X: ArrayLike, c: ArrayLike, gains: ArrayLike) -> Array:
    """Return min(g_c X, 1), each pixel times the gain of its filter, for gains of at least 1.

    Gains are divided by the smallest of them. With gains below 1, a pixel that is full in all
    channels would end below 1 in some of them: white would turn magenta.

    Parameters
    ----------
    X : (H, W), mosaic, 1 is full
    c : (H, W) int, channels of the filters, 0 to 2
    gains : (3,), only their ratios count

    Raises
    ------
    InputError
        For channels of another shape, or gains that are not positive.

    Examples
    --------
    >>> balance_white([[0.3, 0.4], [0.4, 1.0]], [[0, 1], [1, 2]], [1.0, 0.5, 0.75])
    array([[0.6, 0.4],
           [0.4, 1. ]])
    """
    if np.shape(c) != np.shape(X) or np.shape(gains) != (3,) or not np.min(gains) > 0:
        raise InputError("expected a mosaic (H, W), its channels (H, W) and three positive gains")
    if not np.isin(c, (0, 1, 2)).all():
        raise InputError(f"expected channels 0, 1 and 2, got {describe(np.asarray(c))}")
    g = np.asarray(gains) / np.min(gains)
    return np.minimum(X * g[np.asarray(c)], 1)


def screen_from_camera(M: ArrayLike, P: ArrayLike) -> F64:
    """Return C (3, 3), from balanced channels of a camera to linear RGB of a screen.

    A = M P takes RGB of the screen to the channels of the camera. White, (1, 1, 1), becomes the
    sums of A's rows, and white balance divides by just these sums. So each row of A is divided by
    its sum before A is inverted: C = (A / row sums)^-1. Then C keeps (1, 1, 1), and gray stays gray.

    Parameters
    ----------
    M : (3, 3), color matrix, from XYZ under D65 to the channels of the camera
    P : (3, 3), XYZ of the screen's linear red, green and blue, one a column: `XYZ_OF_SRGB`

    Raises
    ------
    InputError
        For matrices that are not (3, 3), have no inverse, or make no positive channels of white.

    Examples
    --------
    >>> camera = [[0.67, -0.06, -0.10], [-0.43, 1.25, 0.20], [-0.09, 0.22, 0.57]]
    >>> screen_from_camera(camera, XYZ_OF_SRGB).sum(axis=1).round(6).tolist()
    [1.0, 1.0, 1.0]
    """
    if np.shape(M) != (3, 3) or np.shape(P) != (3, 3):
        raise InputError(f"expected matrices (3, 3), got {np.shape(M)} and {np.shape(P)}")
    if np.linalg.matrix_rank(np.dot(M, P)) < 3 or np.dot(M, P).sum(axis=1).min() <= 0:
        raise InputError("expected matrices with inverses, under which white is positive")
    A = np.asarray(M) @ np.asarray(P)
    A = A / A.sum(axis=1, keepdims=True)
    return np.linalg.inv(A)


def convert(E: ArrayLike, C: ArrayLike) -> F32:
    """Return C E, clipped to [0, 1], at each pixel: channels of the camera become linear sRGB.

    A color outside of sRGB needs a negative channel, which becomes 0.
    """
    E = np.asarray(E)
    if E.ndim != 3 or E.shape[2] != 3 or np.shape(C) != (3, 3):
        raise InputError(f"expected an image (H, W, 3) and a matrix (3, 3), got {describe(E)}")
    return np.clip(E @ np.asarray(C).T, 0, 1).astype(np.float32)


def develop_steps(
    Z: ArrayLike,
    *,
    pattern: ArrayLike,
    black: ArrayLike,
    white: float,
    gains: ArrayLike,
    conversion: ArrayLike,
    demosaic: Demosaic = malvar.demosaic,
) -> Iterator[Step]:
    """Yield the steps from RAW levels to an image in sRGB. The parameters are those of `develop`."""
    Z = _as_mosaic(Z)
    c = tile(pattern, Z.shape)
    X = normalize(Z, black=black, white=white)
    yield Step("levels", X)
    X = balance_white(X, c, gains).astype(np.float32)
    yield Step("white balance", X)
    E = demosaic(X, c)
    yield Step("demosaiced", E)
    E = convert(E, conversion)
    yield Step("linear sRGB", E)
    yield Step("sRGB", encode_srgb(E).astype(np.float32))


def develop(
    Z: ArrayLike,
    *,
    pattern: ArrayLike,
    black: ArrayLike,
    white: float,
    gains: ArrayLike,
    conversion: ArrayLike,
    demosaic: Demosaic = malvar.demosaic,
) -> F32:
    """Develop a RAW photo.

    Parameters
    ----------
    Z : (H, W), RAW levels of a Bayer mosaic
    pattern : (2, 2) int, channels of the filters at the top left corner, 0 to 2
    black : level of no light; a number, or (H, W) if the filters have different ones
    white : level at which a pixel is full
    gains : (3,) of white balance, only their ratios count
    conversion : (3, 3), C of the camera, see `screen_from_camera`
    demosaic : function of a mosaic and its channels, `malvar.demosaic` or `mosaic.demosaic`

    Returns
    -------
    (H, W, 3) float32, sRGB, encoded, 0 to 1

    Raises
    ------
    InputError
        For levels, a pattern, gains or a matrix that the steps reject.

    Examples
    --------
    >>> card = np.tile([[300, 500], [500, 200]], (4, 4))
    >>> camera = [[0.67, -0.06, -0.10], [-0.43, 1.25, 0.20], [-0.09, 0.22, 0.57]]
    >>> C = screen_from_camera(camera, XYZ_OF_SRGB)
    >>> levels = dict(pattern=[[0, 1], [1, 2]], black=100, white=1100)
    >>> develop(card, **levels, gains=[2, 1, 4], conversion=C)[3, 3].round(3)
    array([0.665, 0.665, 0.665], dtype=float32)
    """
    steps = develop_steps(
        Z,
        pattern=pattern,
        black=black,
        white=white,
        gains=gains,
        conversion=conversion,
        demosaic=demosaic,
    )
    return last(steps).image


def _measured_pixels(X: ArrayLike, c: ArrayLike) -> list[Array]:
    """Return the pixels of each channel that have no clipped pixel next to them.

    Leaving out the clipped pixels alone would not do: green clips first, so that the brightest
    places would count in red and blue only.
    """
    X = _as_mosaic(X)
    c = as_channels(c, X.shape)
    is_measured = maximum_filter(X, size=3) < 1
    channels = [X[(c == k) & is_measured] for k in range(3)]
    if min(pixels.size for pixels in channels) == 0:
        raise InputError("expected pixels of each color below 1, got a channel without them")
    return channels


def _as_mosaic(X: ArrayLike) -> Array:
    """Return a mosaic (H, W) as floats, or raise an InputError."""
    X = np.asarray(X)
    if X.ndim != 2 or min(X.shape) < 1 or X.dtype.kind not in "iuf":
        raise InputError(f"expected a mosaic (H, W) of numbers, got {describe(X)}")
    return X.astype(np.result_type(X, np.float32), copy=False)
