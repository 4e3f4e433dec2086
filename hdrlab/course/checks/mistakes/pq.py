"""Known mistakes in `pq`, the task of hdrlab.tonemap.transfer.pq."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.tonemap.transfer import C1, C2, C3, M1, M2, PEAK_LUMINANCE, within


@mistake(
    "pq_inverted_first_power",
    says="You raise Y to 1 / m1, as in the inverse function. From luminance to signal, use Y^m1.",
)
def inverted_first_power(FD):
    Ym = (within(FD, PEAK_LUMINANCE) / PEAK_LUMINANCE) ** (1 / M1)
    return ((C1 + C2 * Ym) / (1 + C3 * Ym)) ** M2


@mistake(
    "pq_over_the_brightest_of_the_picture",
    says="You divide by the largest luminance in the image. PQ is absolute: Y is FD / 10,000 "
    "cd/m2.",
)
def over_the_brightest_of_the_picture(FD):
    Ym = (within(FD, PEAK_LUMINANCE) / np.max(FD)) ** M1
    return ((C1 + C2 * Ym) / (1 + C3 * Ym)) ** M2
