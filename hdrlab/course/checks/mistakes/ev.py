"""Known mistakes in `ev`, the task of hdrlab.capture.exposure.ev."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "ev_aperture_once",
    says="The light is proportional to the area of the aperture, 1 / F squared, so the "
    "f-number counts twice: 2 log2 F.",
)
def aperture_once(F, T, *, S=100.0):
    return np.log2(F) - np.log2(T) - np.log2(S / 100)


@mistake(
    "ev_natural_logarithm",
    says="Stops are powers of two. You took the natural logarithm; take the logarithm to base 2.",
)
def natural_logarithm(F, T, *, S=100.0):
    return 2 * np.log(F) - np.log(T) - np.log(S / 100)


@mistake(
    "ev_speed_added",
    says="A higher ISO speed needs less light, so it lowers the exposure value: subtract "
    "log2(S / 100).",
)
def speed_added(F, T, *, S=100.0):
    return 2 * np.log2(F) - np.log2(T) + np.log2(S / 100)
