"""Known mistakes in `descend`, the task of hdrlab.response.mann.descend."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.response.mann import MIN_LEVEL, MIN_LEVEL_STEP


@mistake(
    "descend_start_left_out",
    says="Your series begins with T(start). The value in the bright photo, start, is its first "
    "value.",
)
def start_left_out(T, start, *, low=MIN_LEVEL):
    known = np.flatnonzero(np.isfinite(T))
    series = [float(start)]
    while len(known) and known[0] <= series[-1] <= known[-1]:
        below = float(np.interp(series[-1], known, T[known]))
        if not low <= below <= series[-1] - MIN_LEVEL_STEP:
            break
        series.append(below)
    return np.array(series[1:] or [float(start)])


@mistake(
    "descend_rounded",
    says="You round to whole pixel values, and the errors add up from step to step. Interpolate "
    "T between two pixel values.",
)
def rounded(T, start, *, low=MIN_LEVEL):
    series = [float(start)]
    while True:
        below = float(T[int(np.round(series[-1]))])
        if not low <= below <= series[-1] - MIN_LEVEL_STEP:
            break
        series.append(below)
    return np.array(series)


@mistake(
    "descend_one_value_too_low",
    says="Your last value is below `low`. Compare the next value with `low` before you append it.",
)
def one_value_too_low(T, start, *, low=MIN_LEVEL):
    known = np.flatnonzero(np.isfinite(T))
    series = [float(start)]
    while len(known) and known[0] <= series[-1] <= known[-1] and series[-1] >= low:
        below = float(np.interp(series[-1], known, T[known]))
        if not below <= series[-1] - MIN_LEVEL_STEP:
            break
        series.append(below)
    return np.array(series)


@mistake(
    "descend_held_beyond_the_ends",
    says="Where T is NaN, you use the value of the nearest known one. End the series there: "
    "nothing is known.",
)
def held_beyond_the_ends(T, start, *, low=MIN_LEVEL):
    known = np.flatnonzero(np.isfinite(T))
    series = [float(start)]
    while True:
        below = float(np.interp(series[-1], known, T[known]))
        if not low <= below <= series[-1] - MIN_LEVEL_STEP:
            break
        series.append(below)
    return np.array(series)
