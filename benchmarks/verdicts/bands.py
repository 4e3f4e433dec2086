"""Every verdict that `assemble` gives: its statistic, its limit, and the dead band around it.

Between two verdicts that blame different causes, there is a band in which hdrlab claims neither of
them alone. A note or a warning that appears or not contradicts nothing, and needs no band.
"""

from dataclasses import dataclass

from hdrlab.diagnostics import (
    causes,
    contradictions,
    exposure_times,
    motion,
    outlying_frames,
    registration,
    tones,
)
from hdrlab.diagnostics.warning_texts import MARGIN
from hdrlab.pipeline import checks, dark_pixels, recovery, rigid_motion


@dataclass(frozen=True, kw_only=True)
class Band:
    """A verdict: its statistic, its limit, the band around it, and what hdrlab says in the band.

    `low` and `high` are the ends of the band; they are equal where none is needed, because on one
    side of the limit nothing is claimed.
    """

    verdict: str
    statistic: str
    limit: float
    low: float
    high: float
    in_between: str


def with_margin(verdict: str, statistic: str, limit: float, in_between: str) -> Band:
    """Return the Band of a limit with the common MARGIN."""
    return Band(
        verdict=verdict,
        statistic=statistic,
        limit=limit,
        low=limit / MARGIN,
        high=limit * MARGIN,
        in_between=in_between,
    )


def without_band(verdict: str, statistic: str, limit: float, in_between: str) -> Band:
    """Return the Band of a limit beyond which a sentence appears that contradicts no other."""
    return Band(
        verdict=verdict,
        statistic=statistic,
        limit=limit,
        low=limit,
        high=limit,
        in_between=in_between,
    )


EITHER = "names each cause that fits"
APPEARS = "no band: a sentence appears, and contradicts no other"
BANDS = (
    with_margin("white balance", "tint, stops", contradictions.MIN_WRONG_STOPS, EITHER),
    Band(
        verdict="vignetting",
        statistic="corners, stops",
        limit=contradictions.MIN_SLIGHT_STOPS,
        low=contradictions.MIN_SLIGHT_STOPS / causes.CORNERS_MARGIN,
        high=contradictions.MIN_SLIGHT_STOPS * causes.CORNERS_MARGIN,
        in_between=EITHER,
    ),
    Band(
        verdict="vignetting",
        statistic="explained by the radius",
        limit=contradictions.FULL_EXPLAINED_BY_RADIUS,
        low=contradictions.MIN_EXPLAINED_BY_RADIUS,
        high=contradictions.FULL_EXPLAINED_BY_RADIUS,
        in_between="counts the change in part",
    ),
    with_margin("light changed in parts", "parts, stops", contradictions.MIN_LOCAL_STOPS, EITHER),
    Band(
        verdict="the same, if significant",
        statistic="parts, standard errors",
        limit=contradictions.MIN_SIGNIFICANCE,
        low=contradictions.MIN_SIGNIFICANCE / causes.SIGNIFICANCE_MARGIN,
        high=contradictions.MIN_SIGNIFICANCE * causes.SIGNIFICANCE_MARGIN,
        in_between=EITHER,
    ),
    # Both the numerator and the denominator may be larger or smaller.
    Band(
        verdict="parts or times",
        statistic="parts over time error",
        limit=causes.MIN_LOCAL_OVER_TIMES,
        low=causes.MIN_LOCAL_OVER_TIMES / MARGIN**2,
        high=causes.MIN_LOCAL_OVER_TIMES * MARGIN**2,
        in_between=EITHER,
    ),
    with_margin("wrong times", "time error, stops", contradictions.MIN_WRONG_STOPS, EITHER),
    with_margin("wrong times", "cost in the map, stops", contradictions.MIN_COST_STOPS, EITHER),
    Band(
        verdict="which time is wrong",
        statistic="sum of roots over the least",
        limit=1.0,
        low=1.0,
        high=MARGIN,
        in_between="names both photos",
    ),
    with_margin("lamps flicker", "bands, stops", motion.MIN_BAND_STOPS, EITHER),
    Band(
        verdict="flicker or parts",
        statistic="parts, stops",
        limit=contradictions.MIN_LOCAL_STOPS,
        low=contradictions.MIN_LOCAL_STOPS / causes.UNDECIDED_FACTOR,
        high=contradictions.MIN_LOCAL_STOPS * causes.UNDECIDED_FACTOR,
        in_between=EITHER,
    ),
    Band(
        verdict="flicker or times",
        statistic="time error, stops",
        limit=contradictions.MIN_WRONG_STOPS,
        low=contradictions.MIN_WRONG_STOPS,
        high=contradictions.MIN_WRONG_STOPS * causes.UNDECIDED_FACTOR,
        in_between=EITHER,
    ),
    Band(
        verdict="bands of rows only",
        statistic="rows over columns",
        limit=motion.FULL_ROWS_OVER_COLUMNS,
        low=motion.MIN_ROWS_OVER_COLUMNS,
        high=motion.FULL_ROWS_OVER_COLUMNS,
        in_between="counts bands in part",
    ),
    with_margin(
        "flicker or motion",
        "fraction of blocks",
        motion.MAX_FLICKER_FRACTION,
        f"{EITHER}, and removes no ghosts",
    ),
    with_margin("something moved", "fraction of blocks", motion.MIN_MOVING_FRACTION, EITHER),
    with_margin("unexplained", "spread, stops", causes.MAX_EXPLAINED_SPREAD, EITHER),
    Band(
        verdict="which photo is left out",
        statistic="the others, stops",
        limit=outlying_frames.MAX_AGREEING_STOPS,
        low=outlying_frames.MAX_AGREEING_STOPS,
        high=outlying_frames.MAX_AGREEING_STOPS * outlying_frames.RIVAL_MARGIN,
        in_between="names both photos",
    ),
    Band(
        verdict="stated times not used",
        statistic="spread, stops",
        limit=checks.MIN_WORTHLESS_STOPS,
        low=checks.MIN_WORTHLESS_STOPS / MARGIN,
        high=checks.MIN_WORTHLESS_STOPS,
        in_between="uses them, and says that they may be wrong",
    ),
    Band(
        verdict="misaligned, by blocks",
        statistic="similarity of gradients",
        limit=rigid_motion.MIN_SIMILARITY,
        low=rigid_motion.MIN_SIMILARITY / MARGIN,
        high=rigid_motion.MIN_SIMILARITY,
        in_between="may be misaligned; checks all else",
    ),
    Band(
        verdict="misaligned, by blocks",
        statistic="shift of a block, pixels",
        limit=rigid_motion.MAX_BLOCK_SHIFT,
        low=rigid_motion.MAX_BLOCK_SHIFT,
        high=rigid_motion.MAX_BLOCK_SHIFT * MARGIN,
        in_between="may be misaligned; checks all else",
    ),
    Band(
        verdict="misaligned, by bitmaps",
        statistic="error in place",
        limit=registration.MAX_ALIGNED_BITS_ERROR,
        low=registration.MAX_ALIGNED_BITS_ERROR,
        high=registration.MAX_ALIGNED_BITS_ERROR * MARGIN,
        in_between="may be misaligned; checks all else",
    ),
    Band(
        verdict="the map follows the photo",
        statistic="map against it, stops",
        limit=tones.MAX_PART_STOPS,
        low=tones.MAX_FOLLOWING_STOPS,
        high=tones.MAX_PART_STOPS,
        in_between="says only that two photos differ",
    ),
    without_band("map against photos", "median, stops", tones.MAX_PART_STOPS, APPEARS),
    without_band("darkest parts", "median, stops", tones.MAX_DARK_STOPS, APPEARS),
    without_band("black in every photo", "fraction", dark_pixels.MIN_BLACK_FRACTION, APPEARS),
    without_band("one of three times", "correction", exposure_times.MAX_ROUNDING_STOPS, APPEARS),
    without_band("far from stated times", "correction", exposure_times.MAX_ROUGH_STOPS, APPEARS),
    without_band("left out", "contradiction, stops", outlying_frames.MIN_CONTRARY_STOPS, APPEARS),
    without_band(
        "one curve or three",
        "RMS spread over the best",
        1 + recovery.MAX_RELATIVE_LOSS,
        "no band: takes the curve that is tied more",
    ),
)


def print_bands() -> None:
    """Print the table of all bands."""
    print(f"  {'verdict':26} {'statistic':28} {'limit':>7}  {'band':15} in the band")
    for band in BANDS:
        ends = "-" if band.low == band.high else f"{band.low:.3g} to {band.high:.3g}"
        row = f"{band.verdict:26} {band.statistic:28} {band.limit:7.3g}  {ends:15}"
        print(f"  {row} {band.in_between}", flush=True)
