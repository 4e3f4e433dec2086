"""Color for operators that map luminance alone, and conversion of linear light to 8-bit sRGB.

E        radiance            (H, W, 3), linear, primaries of sRGB; or (H, W), gray
L        luminance           (H, W), same unit
Ld       display luminance   (H, W), linear, 1 = white
display  linear display RGB  (H, W, 3) in [0, 1], or (H, W)
s        saturation          1 keeps the colour's ratios, 0 is gray

A saturated color may need more of a channel than the display has. There are two policies, in `WAYS`:

ratio  `recolour` clips the channel: the luminance drops and the hue shifts, a blue sky toward cyan
       and a flame from orange to yellow, but bright colors stay saturated
hue    C = (1 + s (E / L - 1)) Ld [Mantiuk09], a distance along the direction away from gray. Where
       the largest channel is M > 1 the color is darkened by M^0.85, and then desaturated, smoothly
       before that channel reaches 1: hue and gradation stay, and lamps and glass keep a color

Out-of-gamut colors, with a channel below 0, move toward gray as far as necessary: `core.gamut`.

Mantiuk et al., Color correction for tone mapping, Eurographics 2009.
"""

from collections.abc import Callable

import numpy as np

from hdrlab.core.arrays import F32, Array, ArrayLike, as_luminance, as_radiance, describe
from hdrlab.core.threads import map_in_threads
from hdrlab.errors import InputError

# weights of R, G and B [ITU-R BT.709], the primaries of sRGB
LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)
# below this luminance a pixel has no color: it is gray
_MIN_COLOR_LUMINANCE = np.float32(1e-30)
# a band of this many rows stays in the processor's cache
_BAND_ROWS = 16
# `hue` divides a color by M to this power, where its largest channel is M > 1
_HUE_DARKENING_POWER = 0.85
# `hue` starts to desaturate where the largest channel takes this fraction of the room above Ld
_HUE_KNEE_FRACTION = np.float32(0.5)


def luminance(E: ArrayLike) -> F32:
    """Return L = 0.2126 R + 0.7152 G + 0.0722 B [BT.709], or E itself where it has one channel."""
    E = as_radiance(E)
    return E if E.ndim == 2 else E @ LUMINANCE


def recolour(E: ArrayLike, L: ArrayLike, Ld: ArrayLike, *, saturation: float = 1.0) -> F32:
    """Return C = (E / L)^s Ld for each channel C, clipped to [0, 1] [Tumblin99].

    Parameters
    ----------
    E : (H, W, 3) radiance, or (H, W), which passes as gray
    L : (H, W) luminance of E
    Ld : (H, W) display luminance, linear, 1 = white
    saturation : s >= 0; below 1 it takes from colours the contrast that tone mapping took from
        luminance

    Returns
    -------
    (H, W, 3) float32 linear display RGB in [0, 1], or (H, W) where E is gray.
    A pixel without light, E = L = 0, has no colour and becomes Ld in gray.

    Raises
    ------
    ValueError
        For shapes that do not fit together, values that are not finite or negative, a negative
        saturation.

    References
    ----------
    Tumblin and Turk, LCIS: a boundary hierarchy for detail-preserving contrast reduction, SIGGRAPH
    1999.

    Examples
    --------
    >>> E = np.array([[[8.0, 4.0, 2.0]]])
    >>> L = luminance(E)
    >>> recolour(E, L, L / 10).round(3)
    array([[[0.8, 0.4, 0.2]]], dtype=float32)
    """
    E, L, Ld = _as_fitting(E, L, Ld, saturation)
    C = Ld if E.ndim == 2 else _ratio(E, L, Ld, saturation)
    return np.clip(C, 0, 1)


def encode_srgb(linear: ArrayLike) -> Array:
    """Return 12.92 c up to c = 0.0031308 and 1.055 c^(1/2.4) - 0.055 above it [IEC 61966-2-1]."""
    c = np.asarray(linear)
    curve = 1.055 * np.maximum(c, 0.0031308) ** (1 / 2.4) - 0.055
    return np.where(c <= 0.0031308, 12.92 * c, curve)


def decode_srgb(encoded: ArrayLike) -> Array:
    """Return v / 12.92 up to v = 0.04045 and ((v + 0.055) / 1.055)^2.4 above it [IEC 61966-2-1]."""
    v = np.asarray(encoded)
    curve = ((np.maximum(v, 0.04045) + 0.055) / 1.055) ** 2.4
    return np.where(v <= 0.04045, v / 12.92, curve)


# sRGB codes of 65536 steps of linear light. Where the curve is steepest a step is 1/20 of a code.
CODES = np.floor(255 * encode_srgb(np.arange(65536) / 65535) + 0.5).astype(np.uint8)


def to_8bit(display: ArrayLike) -> Array:
    """Return the sRGB codes floor(255 encode_srgb(display) + 0.5), and 255 above 1.

    They are read from a table, and within 0.53 of the exact value.
    """
    return _codes(as_radiance(display))


def render(
    E: ArrayLike, L: ArrayLike, Ld: ArrayLike, *, saturation: float = 1.0, way: str = "ratio"
) -> Array:
    """Return to_8bit(recolour(E, L, Ld)), computed band by band, which saves memory.

    Parameters and errors are those of `recolour`. With way="hue", colors keep their hue.

    Returns
    -------
    (H, W, 3) uint8, sRGB; or (H, W) where E is gray

    Examples
    --------
    >>> E = np.full((1, 1, 3), 4.0)
    >>> render(E, luminance(E), [[0.5]]).tolist()
    [[[188, 188, 188]]]
    """
    if way not in WAYS:
        raise InputError(f"expected one of {', '.join(WAYS)}, got {way!r}")
    E, L, Ld = _as_fitting(E, L, Ld, saturation)
    picture = np.empty(E.shape, np.uint8)

    def fill(top: int) -> None:
        band = slice(top, top + _BAND_ROWS)
        C = Ld[band] if E.ndim == 2 else WAYS[way](E[band], L[band], Ld[band], saturation)
        picture[band] = _codes(C)

    for _ in map_in_threads(fill, range(0, len(E), _BAND_ROWS), pixels=L.size):
        pass
    return picture


def _ratio(E: F32, L: F32, Ld: F32, saturation: float) -> F32:
    dark = L < _MIN_COLOR_LUMINANCE
    L = np.maximum(L, _MIN_COLOR_LUMINANCE)
    if saturation == 1:
        C = E * np.stack([Ld / L] * 3, axis=-1)  # faster than an inner loop over three channels
    else:
        C = (E / L[..., None]) ** saturation * Ld[..., None]
    if dark.any():
        C[dark] = Ld[dark, None]
    return C


def _hue(E: F32, L: F32, Ld: F32, saturation: float) -> F32:
    dark = L < _MIN_COLOR_LUMINANCE
    s = np.float32(saturation)
    scale = s * Ld / np.maximum(L, _MIN_COLOR_LUMINANCE)
    gray = (1 - s) * Ld
    if dark.any():
        scale[dark] = 0
        gray[dark] = Ld[dark]
    C = E * np.stack([scale] * 3, axis=-1)
    if saturation != 1 or dark.any():
        C += np.stack([gray] * 3, axis=-1)
    M = np.maximum(np.maximum(C[..., 0], C[..., 1]), C[..., 2])
    bright = M - Ld > _HUE_KNEE_FRACTION * (1 - Ld)
    if bright.any():
        C[bright] = _pale(C[bright], M[bright, None], Ld[bright, None])
    return np.clip(C, 0, 1)


def _pale(C: F32, M: F32, Ld: F32) -> F32:
    """Return colors (N, 3), of largest channel M (N, 1), desaturated until no channel exceeds 1.

    Ld is (N, 1), too.
    """
    fit = _power(np.maximum(M, 1), -_HUE_DARKENING_POWER)
    C = C * fit
    M = M * fit
    Ld = Ld * fit
    room = np.maximum(1 - Ld, _MIN_COLOR_LUMINANCE)
    fraction = np.minimum((M - Ld) / room, 1000)
    eighth_power = np.square(np.square(np.square(fraction)))
    return np.asarray(Ld + (C - Ld) * _power(1 + eighth_power, -1 / 8), np.float32)


def _power(x: F32, exponent: float) -> F32:
    """Return x^exponent, x above 0: NumPy's own power takes five times as long."""
    return np.exp(np.float32(exponent) * np.log(x))


WAYS: dict[str, Callable[[F32, F32, F32, float], F32]] = {"ratio": _ratio, "hue": _hue}


def _codes(display: F32) -> Array:
    index = (np.minimum(display, 1) * 65535 + 0.5).astype(np.uint16)
    return CODES.take(index, mode="clip")  # faster than checking for indices out of range


def _as_fitting(
    E: ArrayLike, L: ArrayLike, Ld: ArrayLike, saturation: float
) -> tuple[F32, F32, F32]:
    E = as_radiance(E)
    L = as_luminance(L)
    Ld = as_luminance(Ld)
    if not E.shape[:2] == L.shape == Ld.shape:
        raise InputError(
            f"expected L and Ld of shape {E.shape[:2]}, got {describe(L)} and {describe(Ld)}"
        )
    if not 0 <= saturation < np.inf:
        raise InputError(f"expected a saturation that is finite and not negative, got {saturation}")
    return E, L, Ld
