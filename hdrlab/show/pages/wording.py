"""Format numbers for reports: stops, percentages and offsets, with true minus signs."""

import numpy as np

from hdrlab.core import arrays, colour

# Correct exposure times and a camera on a tripod reach this spread, in stops.
AGREEMENT_STOPS = 0.03
MIN_SHOWN_PERCENT = 0.01
MIN_LUMINANCE = 1e-30


def share(mask: arrays.ArrayLike) -> str:
    """Return how much of a mask is True, in percent; only "0 %" and "100 %" mean none and all.

    Examples
    --------
    >>> [share(np.arange(100_000) < count) for count in (0, 1, 33_333, 99_999, 100_000)]
    ['0 %', '< 0.01 %', '33.33 %', '> 99.99 %', '100 %']
    """
    part = np.count_nonzero(mask)
    whole = np.size(mask)
    percent = 100 * part / whole
    if part in (0, whole):
        return f"{percent:.0f} %"
    if percent < MIN_SHOWN_PERCENT:
        return f"< {MIN_SHOWN_PERCENT} %"
    if percent > 100 - MIN_SHOWN_PERCENT:
        return f"> {100 - MIN_SHOWN_PERCENT} %"
    return f"{percent:.2f} %"


def signed(value: float, digits: int = 0) -> str:
    """Return a number with its sign, for which − is a true minus; zero has no sign.

    Examples
    --------
    >>> signed(-2), signed(0.126, 2), signed(-0.001, 2)
    ('−2', '+0.13', '0.00')
    """
    text = f"{value:+.{digits}f}"
    return text.replace("-", "−") if float(text) else text[1:]


def stops(value: float) -> str:
    """Return a number of stops, or "not known" for NaN."""
    return "not known" if np.isnan(value) else f"{value:.3f} stops"


def offset(pixels: arrays.ArrayLike) -> str:
    """Return (dy, dx) as '(+4, −1)'."""
    dy, dx = np.asarray(pixels).tolist()
    return f"({signed(dy)}, {signed(dx)})"


def verdict(spread: float) -> str:
    """Return in words how well frames agree whose spread is this, in stops."""
    from hdrlab.pipeline.stages import CONTRADICTION  # large, and figures do without it

    if np.isnan(spread):
        return "no pixel value occurs in two frames"
    if spread <= AGREEMENT_STOPS:
        return "they agree"
    if spread <= CONTRADICTION:
        return "they agree roughly"
    return "they contradict each other"


def deviation(E: arrays.F32, s: arrays.F32) -> arrays.F32:
    """Return the standard deviation of each pixel's luminance in stops, (H, W), infinite if unknown.

    This is an upper limit. It assumes that the errors of the channels add up, as they do in a JPEG.

    Examples
    --------
    >>> deviation(np.float32([[1.0, 2.0]]), np.float32([[0.1, np.inf]])).round(3)
    array([[0.144,   inf]], dtype=float32)
    """
    luminance_deviation = s if s.ndim == 2 else s @ colour.LUMINANCE
    L = np.maximum(colour.luminance(E), MIN_LUMINANCE)
    return np.asarray(luminance_deviation / L / np.log(2), np.float32)


def certainty(E: arrays.F32, s: arrays.F32) -> str:
    """Return in words the standard deviation of half and of 95 % of the pixels."""
    deviations = deviation(E, s)
    known = deviations[np.isfinite(deviations)]
    if not known.size:
        return "the uncertainty of the pixels is not known"
    median, quantile95 = np.quantile(known, [0.5, 0.95])
    return f"half of the pixels are known to ± {median:.2g} stops, 95 % to ± {quantile95:.2g}"
