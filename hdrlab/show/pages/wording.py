"""Numbers in a reader's words: stops, shares and offsets, with true minus signs and no false rounding."""

import numpy as np

from hdrlab.core import arrays, colour
from hdrlab.pipeline.stages import CONTRADICTION

CLOSE = 0.03  # stops of spread: what true exposure times and a camera at rest reach


def share(mask: arrays.ArrayLike) -> str:
    """Return how much of a mask is True, in percent; rounding makes neither nothing nor everything of it.

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
    return "< 0.01 %" if percent < 0.01 else "> 99.99 %" if percent > 99.99 else f"{percent:.2f} %"


def signed(value: float, digits: int = 0) -> str:
    """Return a number with its sign, a true minus; zero has none.

    Examples
    --------
    >>> signed(-2), signed(0.126, 2), signed(-0.001, 2)
    ('−2', '+0.13', '0.00')
    """
    text = f"{value:+.{digits}f}"
    return text.replace("-", "−") if float(text) else text[1:]


def stops(value: float) -> str:
    """Return a number of stops, or that it is not known."""
    return "not known" if np.isnan(value) else f"{value:.3f} stops"


def offset(pixels: arrays.ArrayLike) -> str:
    """Return (dy, dx) as '(+4, −1)'."""
    dy, dx = np.asarray(pixels).tolist()
    return f"({signed(dy)}, {signed(dx)})"


def verdict(spread: float) -> str:
    """Return what a spread in stops says of the map."""
    if np.isnan(spread):
        return "no level stands in two frames"
    if spread <= CLOSE:
        return "they agree"
    return "they agree roughly" if spread <= CONTRADICTION else "they contradict each other"


def deviation(E: arrays.F32, s: arrays.F32) -> arrays.F32:
    """Return one standard deviation of each pixel's luminance in stops, (H, W); infinite where unknown.

    The channels are taken to err together, as they do in a JPEG: it is not more than this.

    Examples
    --------
    >>> deviation(np.float32([[1.0, 2.0]]), np.float32([[0.1, np.inf]])).round(3)
    array([[0.144,   inf]], dtype=float32)
    """
    of_L = s if s.ndim == 2 else s @ colour.LUMINANCE
    return np.asarray(of_L / np.maximum(colour.luminance(E), 1e-30) / np.log(2), np.float32)


def certainty(E: arrays.F32, s: arrays.F32) -> str:
    """Return how sure half and most of the pixels are, in words: E and its standard deviation."""
    known = deviation(E, s)
    known = known[np.isfinite(known)]
    if not known.size:
        return "how sure each pixel is, is not known"
    half, most = np.quantile(known, [0.5, 0.95])
    return f"half of the pixels are sure to ± {half:.2g} stops, 95 % to ± {most:.2g}"
