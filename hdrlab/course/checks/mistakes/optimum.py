"""Known mistakes in `optimum`, the task of hdrlab.capture.metering.optimum."""

import numpy as np

from hdrlab.capture.metering import MIDDLE_GRAY
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "optimum_wrong_way",
    says="An image that is too bright needs a higher exposure value, which lets in less light. "
    "Yours goes down.",
)
def wrong_way(EV_pre, B_pre, B_opt=MIDDLE_GRAY):
    return EV_pre - np.log2(B_pre) + np.log2(B_opt)


@mistake(
    "optimum_natural_logarithm",
    says="Stops are powers of two. You took the natural logarithm of B; take the logarithm to "
    "base 2.",
)
def natural_logarithm(EV_pre, B_pre, B_opt=MIDDLE_GRAY):
    return EV_pre + np.log(B_pre) - np.log(B_opt)


@mistake(
    "optimum_always_middle_gray",
    says="You always aim at 0.18, whatever B_opt is. 0.18 is only its default.",
)
def always_middle_gray(EV_pre, B_pre, B_opt=MIDDLE_GRAY):
    return EV_pre + np.log2(B_pre) - np.log2(0.18)
