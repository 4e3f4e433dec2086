"""Known mistakes in `exclusion`, the task of hdrlab.align.mtb.exclusion."""

from hdrlab.align.mtb import NOISE
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "exclusion_bytes_wrap",
    says="Y is of one byte: where Y is less than t, Y - t wraps around to a large number. Turn "
    "Y into int first.",
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
    says="Your exclusion bitmap is inverted: it keeps just those pixels near the threshold "
    "that noise decides.",
)
def inverted(Y, t):
    return (Y <= t + NOISE) & (Y >= t - NOISE)
