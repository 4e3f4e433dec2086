"""Gain maps: an SDR image that brighter screens can show in HDR (ISO 21496-1, 2025).

sdr        the image for any screen           (H, W) or (H, W, 3), linear, 1 = white
hdr        the image for a bright screen      same shape and unit, from 0 to its headroom
headroom   peak luminance over white          of hdr, or of a screen; 1 = no brighter than white
G          gain                               same shape, stops
low, high  the smallest and the largest gain  stops, a number or one for each channel
g          the gain map, as it is stored      same shape, 0 to 1
gamma      of g: above 1 it gives codes to    1 = to all gains alike
           large gains, below 1 to small ones
k          offsets of sdr and of hdr          unit of sdr; they make the gain of black finite
W          fraction of the gain               0 = none, the screen shows sdr; 1 = all, it shows hdr

Such a file holds two images: a program without support for gain maps shows sdr. Both offsets are
equal, or black would become gray where W is between 0 and 1. They are small, or hdr would lose its
shadows.
"""

import numpy as np

from hdrlab.core.arrays import F32, Array, ArrayLike
from hdrlab.core.colour import luminance

OFFSETS = (1 / 1024, 1 / 1024)
# At either end this fraction of the pixels may have a gain outside low to high.
_CLIPPED_FRACTION = 0.001
# high exceeds low by at least this many stops
_MIN_GAIN_RANGE_STOPS = 1 / 256


def log_gain(sdr: Array, hdr: Array, *, k: ArrayLike = OFFSETS) -> Array:
    """Return G = log2((hdr + k_hdr) / (sdr + k_sdr)) [ISO 21496-1].

    Examples
    --------
    >>> log_gain(np.array([0.5, 1.0]), np.array([0.5, 8.0])).round(2)
    array([0., 3.])
    """
    k_sdr, k_hdr = np.asarray(k)
    return np.log2((hdr + k_hdr) / (sdr + k_sdr))


def find_range(G: Array) -> tuple[Array, Array]:
    """Return low and high of each channel; a thousandth of the gains lies below and above them."""
    low, high = np.quantile(G, [_CLIPPED_FRACTION, 1 - _CLIPPED_FRACTION], axis=(0, 1))
    return low, np.maximum(high, low + _MIN_GAIN_RANGE_STOPS)


def gain_map(
    sdr: Array,
    hdr: Array,
    low: ArrayLike,
    high: ArrayLike,
    *,
    gamma: float = 1.0,
    k: ArrayLike = OFFSETS,
) -> Array:
    """Return g = ((G - low) / (high - low))^gamma, the quotient clipped to 0 ... 1 [ISO 21496-1].

    Examples
    --------
    >>> gain_map(np.array([0.5, 0.5, 1.0]), np.array([0.5, 1.0, 16.0]), low=0.0, high=2.0).round(2)
    array([0. , 0.5, 1. ])
    """
    return np.clip((log_gain(sdr, hdr, k=k) - low) / np.subtract(high, low), 0, 1) ** gamma


def weight(screen: float, headroom: float) -> float:
    """Return W = log2(screen) / log2(headroom), clipped to 0 ... 1: how much of the gain a screen shows.

    Both are at least 1. W is 0 for a headroom of 1, where hdr is no brighter than sdr.

    Examples
    --------
    >>> weight(1, 8), round(weight(2, 8), 2), weight(16, 8)
    (0.0, 0.33, 1.0)
    """
    if headroom <= 1:
        return 0.0
    return float(np.clip(np.log2(screen) / np.log2(headroom), 0, 1))


def apply_gain(
    sdr: Array,
    g: Array,
    low: ArrayLike,
    high: ArrayLike,
    *,
    W: float = 1.0,
    gamma: ArrayLike = 1.0,
    k: ArrayLike = OFFSETS,
) -> Array:
    """Return (sdr + k_sdr) 2^(W G) - k_hdr, where G = low + (high - low) g^(1 / gamma) [ISO 21496-1].

    Examples
    --------
    >>> apply_gain(np.array([0.5, 0.5, 1.0]), np.array([0, 0.5, 1]), low=0.0, high=2.0).round(2)
    array([0.5, 1. , 4. ])
    """
    k_sdr, k_hdr = np.asarray(k)
    G = low + np.subtract(high, low) * g ** np.divide(1, gamma)
    return (sdr + k_sdr) * 2 ** (W * G) - k_hdr


def expose(E: F32, sdr: Array, headroom: float) -> F32:
    """Return hdr = s E, at most the headroom, with s from the log averages of sdr and E.

    s gives hdr the log average luminance of sdr. Where the largest channel of s E is above the
    headroom, all channels are scaled down together, so lamps keep their color and do not turn white.

    Examples
    --------
    >>> flame = np.float32([[[9.0, 4.5, 1.5]]])
    >>> expose(flame, flame, 6.0).round(2).tolist()
    [[[6.0, 3.0, 1.0]]]
    """
    L = luminance(E)
    Ld = luminance(sdr)
    lit = (L > 0) & (Ld > 0)
    s = np.exp(np.mean(np.log(Ld[lit] / L[lit]))) if lit.any() else 1.0
    hdr = np.float32(s) * E
    largest = hdr.max(axis=-1, keepdims=True) if E.ndim == 3 else hdr
    is_beyond = largest > headroom
    scale = np.divide(headroom, largest, out=np.ones_like(largest), where=is_beyond)
    return np.minimum(hdr * scale, np.float32(headroom))
