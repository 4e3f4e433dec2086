"""The noise of a sensor from its darks and flats, and whether these photos show it.

Z       RAW levels            dark pair (2, K, h, w), flat pairs (M, 2, K, h, w): the K planes of a
                              mosaic whose filters have one color
S, V    signal and variance   (M + 1,) levels and levels^2 of each pair, the dark pair first
K       gain                  electrons per level
n       pixels of a pair

`capture.photon_transfer` draws the line V = V_0 + S / K. This module computes intervals from the
number of pixels: a variance V of n pixels has the standard deviation V sqrt(2 / n). It also finds
photos that are not what they seem:

- a tone curve bends the line. A term c S^2 is fitted as well, and must be small;
- noise reduction makes neighboring pixels alike. The difference of a pair has no other reason to be
  correlated from pixel to pixel, once the means of rows and columns are removed;
- a full pixel has no photon noise left. Its level should be the white level that the file states;
- light that changes between the two photos of a pair changes their means, or the means of rows;
- light in the darks makes them uneven, or brighter than the black level that the file states.

Vignetting and dust are the same in both photos of a pair, and do no harm.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from hdrlab.capture import photon_transfer
from hdrlab.capture.photon_transfer import DEVIATIONS_OF_95_PERCENT
from hdrlab.core.arrays import F64, Array, Indices, Mask
from hdrlab.errors import CalibrationError

# Kinds of warnings. With the first two, the gain is wrong.
TONE_CURVE = "tone curve"
DENOISED_FLATS = "denoised flats"
DENOISED_DARKS = "denoised darks"
EARLY_CLIPPING = "clipping below the white level"
UNSTEADY_LIGHT = "unsteady light"
LIGHT_LEAK = "light in the darks"
BLACK_LEVEL = "black level"
CUT_BLACK = "black cut off"

# flat pairs without which there is no line
MIN_FLAT_PAIRS = 3
# standard deviations that chance hardly ever exceeds in any of the checks
SURE_DEVIATIONS = 6.0
# change of V at the brightest used pair by the term c S^2, as a fraction of V, that is tolerated:
# good sensors deviate from linearity by 1 or 2 %, which bends V two or three times as much
MAX_CURVATURE = 0.05
# deviation of the exponent of S = t^p from 1 that is tolerated: shutters are not exact
MAX_EXPONENT_ERROR = 0.05
# scatter of ln S around t^p beyond which the light was changed as well as the time
MAX_EXPONENT_SCATTER = 0.05
# of the highest used signal: below it, an error of the black level bends S = t^p, too
MIN_EXPONENT_SIGNAL = 0.1
# ratio of the longest to the shortest time without which there is no exponent
MIN_TIME_RATIO = 4.0
# correlation of neighboring pixels that a converter may cause by itself
MAX_CORRELATION = 0.05
# fraction of the expected variance below which a bright pair is full
MAX_FULL_VARIANCE = 0.5
# fraction of the range up to the white level at which full pixels are expected
MIN_FULL_LEVEL = 0.98
# relative difference of the two means of a pair that is tolerated
MAX_LIGHT_CHANGE = 0.02
# variance of the means of rows beyond chance, as a fraction of the variance of the pixels
MAX_BAND_VARIANCE = 0.02
# fraction of the dark variance that photons of a leak may add
MAX_LEAK_VARIANCE = 0.1
# levels: smaller differences of the dark level are not reported
MIN_BLACK_DIFFERENCE = 0.25
# levels by which black may be off where rounding or level 0 hides it
UNCERTAIN_BLACK_LEVELS = 0.5
# variance at no light that the flats show, over that of the darks, beyond which darks are denoised
MAX_INTERCEPT_RATIO = 1.5
# robust standard deviations beyond which a pixel of the darks is defective
DEFECT_DEVIATIONS = 10.0
DEVIATION_PER_MAD = 1.4826


class Interval(NamedTuple):
    """A measured value, and its 95 % interval."""

    value: float
    low: float
    high: float


@dataclass(frozen=True, kw_only=True)
class NoiseWarning:
    """What is wrong with the photos: one of the kinds above, and a sentence."""

    kind: str
    text: str


@dataclass(frozen=True, kw_only=True, eq=False)
class ChannelPhotos:
    """The darks and flats of one color.

    Attributes
    ----------
    name : name of the channel
    dark : (2, K, h, w) levels, with the lens cap on
    flats : (M, 2, K, h, w) levels, of an even surface, in any order
    block_means : (2, K, B, B) mean levels of blocks of the whole darks, (h, w) may be a part of them
    block_pixels : number of pixels of a block
    stated_black : black level that the file states, or None
    white : white level that the file states, or None
    """

    name: str
    dark: Array
    flats: Array
    block_means: F64
    block_pixels: int
    stated_black: float | None = None
    white: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class ChannelNoise:
    """What photon transfer measures of one channel.

    Attributes
    ----------
    name : name of the channel
    gain : electrons per level
    read_noise : electrons; NaN with an interval from 0 where rounding hides it
    full_well : electrons at which a pixel is full; if no flat is full, the value and the lower limit
        are those of the brightest flat, and the upper limit is infinite
    black : level of no light
    full_level : level of full pixels, NaN if no flat is full
    S, V : (M + 1,) levels and levels^2, the photon transfer curve
    used : (M + 1,) bool, pairs that define the gain
    pixel_count : pixels of a pair
    """

    name: str
    gain: Interval
    read_noise: Interval
    full_well: Interval
    black: Interval
    full_level: float
    S: F64
    V: F64
    used: Mask
    pixel_count: int


class MeasuredNoise(NamedTuple):
    """The noise of each channel, and what is wrong with the photos."""

    channels: tuple[ChannelNoise, ...]
    warnings: tuple[NoiseWarning, ...]


def measure_noise(
    photos: Sequence[ChannelPhotos],
    names: Sequence[tuple[str, str]],
    seconds: Sequence[float] | None = None,
) -> MeasuredNoise:
    """Measure gain, read noise, full well and black level of each channel of a sensor.

    Parameters
    ----------
    photos : the darks and flats of each channel
    names : M names of the two files of each flat pair, for messages
    seconds : (M,), exposure times of the flat pairs; None if they are unknown

    Raises
    ------
    CalibrationError
        If the darks are not darker than the flats, fewer than three flat pairs have steady light, or
        the noise does not grow with the light.

    References
    ----------
    Janesick, Photon Transfer: DN -> lambda, SPIE Press 2007.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> N = np.array([0, 500, 1000, 2000, 4000])[:, None, None, None, None] * np.ones((2, 1, 64, 64))
    >>> Z = np.round((rng.poisson(N) + rng.normal(0, 6, N.shape)) / 2 + 100).astype(np.uint16)
    >>> blocks = Z[0].astype(float).reshape(2, 1, 8, 8, 8, 8).mean(axis=(3, 5))
    >>> wall = ChannelPhotos(
    ...     name="gray", dark=Z[0], flats=Z[1:], block_means=blocks, block_pixels=64
    ... )
    >>> (found,), warnings = measure_noise([wall], [("1", "2")] * 4)
    >>> round(found.gain.value, 1), round(found.read_noise.value), warnings
    (2.0, 6, ())
    """
    for channel in photos:
        flat_means = channel.flats.mean(axis=(1, 2, 3, 4))
        if channel.dark.mean() >= np.median(flat_means):
            raise CalibrationError(
                f"half of the flats are no brighter than the darks ({channel.name}); pass the folder "
                "of darks first, then that of flats, and take flats with more light"
            )
    is_steady, warnings = _find_steady_pairs(photos, names)
    if is_steady.sum() < MIN_FLAT_PAIRS:
        reasons = "".join(f"; {warning.text}" for warning in warnings)
        raise CalibrationError(
            f"expected at least {MIN_FLAT_PAIRS} pairs of flats of different brightness with steady "
            f"light, got {is_steady.sum()}{reasons}"
        )
    steady = [replace(channel, flats=channel.flats[is_steady]) for channel in photos]
    times = None if seconds is None else np.asarray(seconds, np.float64)[is_steady]
    channels = tuple(_measure_channel(channel) for channel in steady)
    curve_warnings = [
        [*_check_line(channel, noise, times), *_check_flats(channel, noise)]
        for channel, noise in zip(steady, channels, strict=True)
    ]
    # the line shows something of the darks only if it is one
    has_straight_lines = not any(curve_warnings)
    found: dict[str, tuple[list[str], str]] = {}
    for channel, noise, first in zip(steady, channels, curve_warnings, strict=True):
        more = _check_darks(channel, noise, has_straight_line=has_straight_lines)
        for warning in (*first, *more, *_check_full_level(channel, noise)):
            found.setdefault(warning.kind, ([], warning.text))[0].append(channel.name)
    for kind, (channel_names, text) in found.items():
        is_everywhere = len(channel_names) == len(photos)
        where = "" if is_everywhere else f" ({', '.join(channel_names)})"
        warnings.append(NoiseWarning(kind=kind, text=text + where))
    return MeasuredNoise(channels, tuple(warnings))


def _find_steady_pairs(
    photos: Sequence[ChannelPhotos], names: Sequence[tuple[str, str]]
) -> tuple[Mask, list[NoiseWarning]]:
    """Return which flat pairs (M,) saw the same light twice, and a warning on each other pair."""
    is_steady = np.ones(len(names), bool)
    warnings = []
    for j, (first, second) in enumerate(names):
        changes = [_measure_light_change(channel, j) for channel in photos]
        bands = [_measure_band_variance(channel.flats[j], channel.dark) for channel in photos]
        change = max(changes, key=abs)
        pair = f"the light of {first} and {second}"
        if abs(change) > MAX_LIGHT_CHANGE:
            text = f"{pair} differs by {abs(change):.1%}"
        elif max(bands) > MAX_BAND_VARIANCE:
            text = f"{pair} differs in stripes, as that of a lamp that flickers"
        else:
            continue
        is_steady[j] = False
        advice = "hdrlab left this pair out; use daylight or a lamp that does not flicker"
        warnings.append(NoiseWarning(kind=UNSTEADY_LIGHT, text=f"{text}; {advice}"))
    return is_steady, warnings


def _measure_light_change(channel: ChannelPhotos, j: int) -> float:
    """Return the relative difference of the means of a pair, or 0 if chance explains it."""
    black = channel.dark.mean()
    first, second = channel.flats[j].reshape(2, -1).mean(axis=1) - black
    deviation = np.sqrt(2 * photon_transfer.variance(channel.flats[j]) / channel.flats[j, 0].size)
    difference = second - first
    if abs(difference) <= SURE_DEVIATIONS * deviation:
        return 0.0
    return float(difference / max(first, second))


def _measure_band_variance(pair: Array, dark: Array) -> float:
    """Return the variance of the means of rows or columns, beyond that of noise and of the darks.

    It is a fraction of the variance of the difference of the pair (2, K, h, w).
    """
    D = pair[0].astype(np.float64) - pair[1]
    total = D.var()
    # noise reduction, which _check_flats reports, makes the means of rows differ more, too
    if total == 0 or abs(_find_correlation([pair])) > MAX_CORRELATION:
        return 0.0
    D_dark = dark[0].astype(np.float64) - dark[1]
    excesses = [0.0]
    for axis in (1, 2):
        lines = D.size // D.shape[axis]
        chance = total / D.shape[axis]
        dark_variance = D_dark.mean(axis=axis).var() - D_dark.var() / D.shape[axis]
        excess = D.mean(axis=axis).var() - chance - max(dark_variance, 0.0)
        if excess > SURE_DEVIATIONS * chance * np.sqrt(2 / lines):
            excesses.append(excess / total)
    return float(max(excesses))


def _measure_channel(channel: ChannelPhotos) -> ChannelNoise:
    """Return the noise of one channel from steady flats."""
    is_sound = _find_sound_pixels(channel.dark)
    flats = channel.flats[_sort_flats(channel)]
    pixels = np.concatenate([channel.dark[None], flats])[:, :, is_sound]
    transfer = photon_transfer.calibrate(pixels[:, :, None])
    n = pixels.shape[-1]
    slope = 1 / transfer.gain
    deviation = _slope_deviation(transfer.S, transfer.V, transfer.used, n)
    gain = Interval(
        transfer.gain,
        1 / (slope + DEVIATIONS_OF_95_PERCENT * deviation),
        1 / max(slope - DEVIATIONS_OF_95_PERCENT * deviation, 1e-12),
    )
    noise = ChannelNoise(
        name=channel.name,
        gain=gain,
        read_noise=_read_noise_interval(transfer, deviation / slope),
        full_well=Interval(transfer.full_well, transfer.full_well, np.inf),
        black=_black_interval(transfer, channel.dark, n),
        full_level=np.nan,
        S=transfer.S,
        V=transfer.V,
        used=transfer.used,
        pixel_count=n,
    )
    if _is_full(transfer):
        return _with_full_well(noise, float(np.median(pixels[-1])))
    return noise


def _sort_flats(channel: ChannelPhotos) -> Indices:
    """Return the order of flat pairs from dark to bright."""
    return np.argsort(channel.flats.mean(axis=(1, 2, 3, 4)), kind="stable")


def _find_sound_pixels(dark: Array) -> Mask:
    """Return which pixels (K, h, w) are neither hot nor stuck in the darks (2, K, h, w)."""
    mean = dark.astype(np.float64).mean(axis=0)
    difference = dark[0].astype(np.float64) - dark[1]
    is_sound = np.ones(mean.shape, bool)
    for values in (mean, difference):
        distances = np.abs(values - np.median(values))
        # rounding may make the median of the distances 0
        deviation = max(DEVIATION_PER_MAD * np.median(distances), 1.0)
        is_sound &= distances <= DEFECT_DEVIATIONS * deviation
    return is_sound


def _slope_deviation(S: F64, V: F64, used: Mask, n: int) -> float:
    """Return the standard deviation of the slope of `photon_transfer.line`, from those of V."""
    is_flat = used & (S > 0)
    w = 1 / np.maximum(V[is_flat], photon_transfer.ROUNDING_VARIANCE) ** 2
    wS = w * S[is_flat]
    variances = 2 / n * V[is_flat] ** 2
    dark_variance = 2 / n * V[0] ** 2
    total = (wS**2 * variances).sum() + wS.sum() ** 2 * dark_variance
    return float(np.sqrt(total) / (wS * S[is_flat]).sum())


def _read_noise_interval(
    transfer: photon_transfer.Transfer, relative_gain_error: float
) -> Interval:
    """Return R and its interval in electrons, from the variance of the darks and from the gain."""
    low, high = transfer.read_noise_interval
    R = transfer.read_noise
    if np.isnan(R):
        return Interval(R, low, high)
    gain_error = DEVIATIONS_OF_95_PERCENT * relative_gain_error * R
    return Interval(R, R - np.hypot(R - low, gain_error), R + np.hypot(high - R, gain_error))


def _black_interval(transfer: photon_transfer.Transfer, dark: Array, n: int) -> Interval:
    """Return the level of no light and its interval."""
    error = DEVIATIONS_OF_95_PERCENT * np.sqrt(transfer.V[0] / (2 * n))
    is_cut = (dark == 0).mean() > photon_transfer.MAX_CUT_FRACTION
    if np.isnan(transfer.read_noise) or is_cut:
        error = UNCERTAIN_BLACK_LEVELS
    return Interval(transfer.black, transfer.black - error, transfer.black + error)


def _is_full(transfer: photon_transfer.Transfer) -> bool:
    """Return whether the brightest pair is full: it has no more noise than the darks.

    A tone curve lowers the noise, too, but not as much.
    """
    S = transfer.S[-1]
    V = transfer.V[-1]
    expected = transfer.V[0] + S / transfer.gain
    has_dark_noise = np.sqrt(V) < 2 * np.sqrt(transfer.V[0]) + 1
    return bool(V < MAX_FULL_VARIANCE * expected and has_dark_noise)


def _with_full_well(noise: ChannelNoise, full_level: float) -> ChannelNoise:
    """Return the noise with the full well that belongs to the level of full pixels."""
    signal = full_level - noise.black.value
    full_well = Interval(*(signal * gain for gain in noise.gain))
    return replace(noise, full_well=full_well, full_level=full_level)


def _check_line(
    channel: ChannelPhotos, noise: ChannelNoise, seconds: F64 | None
) -> list[NoiseWarning]:
    """Return a warning if V is no straight line in S, or S is not proportional to the time."""
    is_flat = noise.used & (noise.S > 0)
    S = noise.S[is_flat]
    V = noise.V[is_flat]
    advice = "so gain, read noise and full well are wrong; use RAW photos"
    # V = b + S / K + c S^2, where b is free, because the darks may be denoised
    solution, deviations = _fit_polynomial(S, V, 2, noise.pixel_count)
    unit = S.max() ** 2 / V[-1]
    bend = solution[2] * unit
    if abs(bend) > max(MAX_CURVATURE, SURE_DEVIATIONS * deviations[2] * unit):
        text = f"a tone curve bends the noise of the flats by {abs(bend):.0%}, {advice}"
        return [NoiseWarning(kind=TONE_CURVE, text=text)]
    if seconds is None:
        return []
    is_bright = S >= MIN_EXPONENT_SIGNAL * S.max()
    S = S[is_bright]
    t = seconds[_sort_flats(channel)][is_flat[1:]][is_bright]
    if t.max() < MIN_TIME_RATIO * t.min() or len(t) < MIN_FLAT_PAIRS:
        return []
    exponent, offset = np.polyfit(np.log(t), np.log(S), 1)
    scatter = np.std(np.log(S) - exponent * np.log(t) - offset)
    if scatter < MAX_EXPONENT_SCATTER and abs(exponent - 1) > MAX_EXPONENT_ERROR:
        text = f"a tone curve makes the flats grow as time^{exponent:.2f}, {advice}"
        return [NoiseWarning(kind=TONE_CURVE, text=text)]
    return []


def _fit_polynomial(S: F64, V: F64, degree: int, n: int) -> tuple[F64, F64]:
    """Return the coefficients of V as a polynomial in S, lowest first, and their deviations.

    Fewer points than coefficients give deviations that are infinite.
    """
    powers = S[:, None] ** np.arange(degree + 1)
    if len(S) <= degree:
        return np.zeros(degree + 1), np.full(degree + 1, np.inf)
    scale = powers.max(axis=0)
    deviation = V * np.sqrt(2 / n)
    A = powers / scale / deviation[:, None]
    solution = np.linalg.lstsq(A, V / deviation, rcond=None)[0]
    deviations = np.sqrt(np.diag(np.linalg.pinv(A.T @ A)))
    return solution / scale, deviations / scale


def _find_correlation(pairs: Sequence[Array]) -> float:
    """Return the correlation of neighboring pixels in the differences of pairs (2, K, h, w).

    It is 0 if chance explains it. The means of rows and columns are removed, because the readout of
    a sensor may add a number to each of them.
    """
    correlations = []
    for pair in pairs:
        D = pair[0].astype(np.float64) - pair[1]
        D -= D.mean(axis=2, keepdims=True)
        D -= D.mean(axis=1, keepdims=True)
        limit = DEFECT_DEVIATIONS * max(D.std(), 1e-12)
        D = np.clip(D, -limit, limit)
        total = (D**2).mean()
        if total == 0:
            continue
        for neighbors in ((D[:, 1:], D[:, :-1]), (D[:, :, 1:], D[:, :, :-1])):
            # removed means alone make -1 / size
            expected = -1 / min(D.shape[1:])
            correlation = (neighbors[0] * neighbors[1]).mean() / total - expected
            chance = SURE_DEVIATIONS / np.sqrt(D.size)
            correlations.append(correlation if abs(correlation) > chance else 0.0)
    return float(max(correlations, key=abs, default=0.0))


def _check_flats(channel: ChannelPhotos, noise: ChannelNoise) -> list[NoiseWarning]:
    """Return a warning if the noise of the flats that define the gain is correlated."""
    used = _sort_flats(channel)[noise.used[1:]]
    correlation = _find_correlation(list(channel.flats[used]))
    if abs(correlation) <= MAX_CORRELATION:
        return []
    text = (
        f"neighboring pixels of the flats are alike (correlation {correlation:.2f}): they are denoised "
        "or interpolated, so all figures are wrong; switch noise reduction off and use RAW photos"
    )
    return [NoiseWarning(kind=DENOISED_FLATS, text=text)]


def _check_darks(
    channel: ChannelPhotos, noise: ChannelNoise, *, has_straight_line: bool
) -> list[NoiseWarning]:
    """Return warnings on darks that are denoised, cut off at 0, or not dark."""
    warnings = []
    correlation = _find_correlation([channel.dark])
    advice = (
        "so the read noise is too small; switch noise reduction off, also that of long exposures"
    )
    if abs(correlation) > MAX_CORRELATION:
        text = (
            f"neighboring pixels of the darks are alike (correlation {correlation:.2f}): they are "
            f"denoised, {advice}"
        )
        warnings.append(NoiseWarning(kind=DENOISED_DARKS, text=text))
    elif np.ptp(channel.dark) == 0:
        text = (
            f"all pixels of the darks have the level {channel.dark.flat[0]}: they may be denoised, "
        )
        warnings.append(NoiseWarning(kind=DENOISED_DARKS, text=text + advice))
    elif has_straight_line and _is_dark_variance_too_small(noise):
        text = f"the flats show more noise at no light than the darks do: the darks are denoised, {advice}"
        warnings.append(NoiseWarning(kind=DENOISED_DARKS, text=text))
    if (channel.dark == 0).mean() > photon_transfer.MAX_CUT_FRACTION:
        text = (
            "the darks are cut off at level 0: black and read noise come from their brighter half"
        )
        warnings.append(NoiseWarning(kind=CUT_BLACK, text=text))
    limit = max(MAX_LEAK_VARIANCE * noise.V[0] * noise.gain.value, MIN_BLACK_DIFFERENCE)
    # noise reduction makes the means of blocks differ more, too
    is_denoised = abs(correlation) > MAX_CORRELATION
    unevenness = 0.0 if is_denoised else _measure_unevenness(channel, noise)
    if unevenness > limit:
        text = (
            f"the darks are uneven by {unevenness:.1f} levels: light, or the glow of the camera, reached "
            "them, so the read noise is too large; put the cap on, cover the viewfinder, and use short times"
        )
        warnings.append(NoiseWarning(kind=LIGHT_LEAK, text=text))
    elif channel.stated_black is not None:
        difference = noise.black.value - channel.stated_black
        if difference > limit:
            text = (
                f"the darks are {difference:.1f} levels above the black level that the file states, "
                f"{channel.stated_black:g}: light reached them, so the read noise is too large; put "
                "the cap on, and cover the viewfinder"
            )
            warnings.append(NoiseWarning(kind=LIGHT_LEAK, text=text))
        elif difference < -limit:
            text = (
                f"the darks are {-difference:.1f} levels below the black level that the file states, "
                f"{channel.stated_black:g}"
            )
            warnings.append(NoiseWarning(kind=BLACK_LEVEL, text=text))
    return warnings


def _is_dark_variance_too_small(noise: ChannelNoise) -> bool:
    """Return whether the line through the flats alone begins clearly above the variance of the darks."""
    is_flat = noise.used & (noise.S > 0)
    solution, deviations = _fit_polynomial(noise.S[is_flat], noise.V[is_flat], 1, noise.pixel_count)
    intercept = solution[0]
    excess = intercept - max(noise.V[0], photon_transfer.ROUNDING_VARIANCE)
    is_sure = excess > SURE_DEVIATIONS * deviations[0]
    return bool(is_sure and intercept > MAX_INTERCEPT_RATIO * noise.V[0])


def _measure_unevenness(channel: ChannelPhotos, noise: ChannelNoise) -> float:
    """Return the range of the dark level over the frame in levels, or 0 if chance explains it."""
    # the filters of a mosaic may have different black levels
    means = channel.block_means.mean(axis=0)
    means = (means - means.mean(axis=(1, 2), keepdims=True)).mean(axis=0)
    blocks = channel.block_means.shape[0] * channel.block_means.shape[1] * channel.block_pixels
    deviation = np.sqrt(max(noise.V[0], photon_transfer.ROUNDING_VARIANCE) / blocks)
    unevenness = float(np.ptp(means))
    return unevenness if unevenness > 2 * SURE_DEVIATIONS * deviation else 0.0


def _check_full_level(channel: ChannelPhotos, noise: ChannelNoise) -> list[NoiseWarning]:
    """Return a warning if pixels are full clearly below the white level that the file states."""
    if channel.white is None or np.isnan(noise.full_level):
        return []
    black = noise.black.value
    if noise.full_level - black >= MIN_FULL_LEVEL * (channel.white - black):
        return []
    text = (
        f"pixels are full at level {noise.full_level:.0f}, below the white level {channel.white:.0f} "
        "that the file states: programs that trust the file take full pixels for measured ones"
    )
    return [NoiseWarning(kind=EARLY_CLIPPING, text=text)]
