"""Known mistakes in `offset`, the task of hdrlab.enhance.relight.offset."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.enhance.relight import DELTA_LIMIT, A, C, f_inv


@mistake(
    "offset_wrong_way",
    says="You subtract the light of the target from that of the average. A dark photo needs more "
    "light: a positive offset.",
)
def wrong_way(average, target=128.0, *, a=A, c=C):
    delta = f_inv(average, a=a, c=c) - f_inv(target, a=a, c=c)
    return float(np.clip(delta, -DELTA_LIMIT, DELTA_LIMIT))


@mistake(
    "offset_quotient_of_values",
    says="You take the logarithm of target / average, as if pixel values were proportional to the "
    "light. Invert the curve f first.",
)
def quotient_of_values(average, target=128.0, *, a=A, c=C):
    delta = np.log2(np.float64(target) / average)
    return float(np.clip(delta, -DELTA_LIMIT, DELTA_LIMIT))


@mistake(
    "offset_not_limited",
    says="Your offset is larger than 8 stops. Clip it to -8 ... 8.",
)
def not_limited(average, target=128.0, *, a=A, c=C):
    return float(f_inv(target, a=a, c=c) - f_inv(average, a=a, c=c))


@mistake(
    "offset_always_the_default_curve",
    says="You always use the default A and C. Use the arguments `a` and `c`.",
)
def always_the_default_curve(average, target=128.0, *, a=A, c=C):
    delta = f_inv(target) - f_inv(average)
    return float(np.clip(delta, -DELTA_LIMIT, DELTA_LIMIT))
