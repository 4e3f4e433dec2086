"""Words for results: numbers with true minus signs, and the summary of a radiance map."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from hdrlab.core import arrays, colour, extremes
from hdrlab.diagnostics.causes import MAX_EXPLAINED_SPREAD

if TYPE_CHECKING:
    from hdrlab.pipeline.assembly import Assembly

# Correct exposure times and a camera on a tripod reach this spread, in stops.
AGREEMENT_STOPS = 0.03
MIN_SHOWN_PERCENT = 0.01
MIN_LUMINANCE = 1e-30
# The range of a larger map is measured in a sample of its pixels.
MAX_SAMPLED_PIXELS = 400_000


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
    if np.isnan(spread):
        return "no pixel value occurs in two frames"
    if spread <= AGREEMENT_STOPS:
        return "they agree"
    if spread <= MAX_EXPLAINED_SPREAD:
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


def describe_map(E: arrays.F32) -> str:
    """Return the size of a radiance map and its range in decades, in words."""
    height, width = E.shape[:2]
    step = max(1, int((height * width / MAX_SAMPLED_PIXELS) ** 0.5))
    sample = E[::step, ::step]
    content = f"{extremes.decades(sample):.1f} decades" if sample.any() else "all black"
    return f"{width} x {height}, {content}"


def describe_agreement(spread: float, count: int) -> str:
    """Return in words how far `count` photos of a map agree; NaN stops stand for "not measured"."""
    if spread != spread:
        return "hdrlab could not measure how far the photos agree"
    return f"the {count} photos agree to {spread:.3f} stops"


def describe_picture(name: str, assembly: "Assembly", operator: str) -> str:
    """Return the name of a tone-mapped image, and that it was kept dark if the scene was dark."""
    from hdrlab.pipeline.photograph import BRIGHT_SCENE_EV, measure_scene_ev
    from hdrlab.pipeline.pictures import AUTO

    is_bound = assembly.bracket.luminance_of_unit is None
    unit = assembly.bracket.luminance_of_unit
    if is_bound:
        unit = assembly.bracket.max_luminance_of_unit
    if unit is None or assembly.fallback or operator != AUTO:
        return name
    scene_ev = measure_scene_ev(assembly.E, unit)
    if scene_ev >= BRIGHT_SCENE_EV:
        return name
    if is_bound:
        reason = f"the exposure times show that the scene had at most EV {scene_ev:z.0f}"
    else:
        reason = f"the scene had EV {scene_ev:z.0f}"
    return f"{name} (kept dark, because {reason})"


def summarize_assembly(assembly: "Assembly", outputs: Sequence[str]) -> str:
    """Return OK or the number of warnings, what was written, and how far the photos agree."""
    count = len(assembly.warnings)
    verdict = "OK" if count == 0 else f"{count} {'warning' if count == 1 else 'warnings'}"
    agreement = describe_agreement(assembly.spread, len(assembly.bracket.times))
    return f"{verdict}: {', '.join(outputs)}; {agreement}"
