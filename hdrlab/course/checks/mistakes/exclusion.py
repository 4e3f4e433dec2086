"""Known mistakes in `exclusion`, the task of hdrlab.align.mtb.exclusion."""

from hdrlab.align.mtb import NOISE
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "exclusion_bytes_wrap",
    says="Y contains bytes. Where Y is less than t, Y - t wraps around to a large number. Convert"
    " Y to int first.",
)
def bytes_wrap(Y, t):
    return abs(Y - Y.dtype.type(t)) > NOISE


@mistake(
    "exclusion_four_kept",
    says="The values t - 4 and t + 4 are within the noise too: compare with > 4, not >= 4.",
)
def four_kept(Y, t):
    return (Y >= t + NOISE) | (Y <= t - NOISE)


@mistake(
    "exclusion_inverted",
    says="Your exclusion bitmap is inverted: it keeps only the pixels near the threshold, which "
    "noise decides.",
)
def inverted(Y, t):
    return (Y <= t + NOISE) & (Y >= t - NOISE)


@mistake(
    "exclusion_inverted_and_bytes_wrap",
    says="Your exclusion bitmap is inverted: keep pixels that are far from t. Y - t also wraps "
    "around, because Y contains bytes: convert Y to int first.",
    misses_method=True,
)
def inverted_and_bytes_wrap(Y, t):
    return abs(Y - Y.dtype.type(t)) <= NOISE
