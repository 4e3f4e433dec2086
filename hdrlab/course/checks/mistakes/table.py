"""Known mistakes in `table`, the task of hdrlab.enhance.relight.table."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.enhance.relight import LEVELS, A, C, f, f_inv


@mistake(
    "table_factor",
    says="You multiply the pixel values by 2^delta, as if they were proportional to the light, "
    "and so clip the highlights. Move along the curve f.",
)
def factor(delta, *, a=A, c=C):
    return np.clip(np.floor(LEVELS * 2.0**delta + 0.5), 0, 255).astype(np.uint8)


@mistake(
    "table_wrong_way",
    says="Your table darkens where it should brighten. Add delta to f^-1(Y).",
)
def wrong_way(delta, *, a=A, c=C):
    return np.floor(f(f_inv(LEVELS, a=a, c=c) - delta, a=a, c=c) + 0.5).astype(np.uint8)


@mistake(
    "table_cut_off",
    says="You cut the fractions off, which makes each value half a step too dark on average. "
    "Round to the nearest value.",
)
def cut_off(delta, *, a=A, c=C):
    return np.floor(f(f_inv(LEVELS, a=a, c=c) + delta, a=a, c=c)).astype(np.uint8)


@mistake(
    "table_not_rounded",
    says="Your table holds fractions. A look-up table holds pixel values: round them.",
)
def not_rounded(delta, *, a=A, c=C):
    return f(f_inv(LEVELS, a=a, c=c) + delta, a=a, c=c)


@mistake(
    "table_always_the_default_curve",
    says="You always use the default A and C. Use the arguments `a` and `c`, in f and in f^-1.",
)
def always_the_default_curve(delta, *, a=A, c=C):
    return np.floor(f(f_inv(LEVELS) + delta) + 0.5).astype(np.uint8)
