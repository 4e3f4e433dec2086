"""Known mistakes in `smear`, the task of hdrlab.beyond.flutter.smear."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


def convolve(x, h):
    x = np.asarray(x, np.float64)
    y = np.zeros((len(x) + len(h) - 1, *x.shape[1:]))
    for k, is_open in enumerate(h):
        y[k : k + len(x)] += is_open * x
    return y


@mistake(
    "smear_code_reversed",
    says="Your code runs backwards. In chop k the object is k pixels further down, so y[i] "
    "contains h[k] x[i - k].",
)
def code_reversed(x, h):
    return convolve(x, h[::-1]) / len(h)


@mistake(
    "smear_divided_by_the_open_chops",
    says="You divide by the number of open chops. The whole exposure has m chops: light that "
    "arrives while the shutter is closed is lost.",
)
def divided_by_the_open_chops(x, h):
    return convolve(x, h) / np.sum(h)


@mistake(
    "smear_not_divided",
    says="You add the light of all chops without a factor. Each chop is the m-th part of the "
    "exposure: divide by m.",
)
def not_divided(x, h):
    return convolve(x, h)


@mistake(
    "smear_cut_off",
    says="Your photo is as long as the object. The object moves m - 1 pixels, so the photo has "
    "n + m - 1 rows.",
)
def cut_off(x, h):
    return convolve(x, h)[: len(x)] / len(h)
