"""Known mistakes in `quadratic_form`, the task of hdrlab.calibration.wilburn.quadratic_form."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "quadratic_form_no_offset",
    says="Your lines go through the origin. A blend has an offset r as well: fit s I + r.",
)
def no_offset(blends, degree):
    Q = np.zeros((degree + 1, degree + 1))
    for irradiance, brightness in blends:
        V = brightness[:, None] ** np.arange(degree + 1)
        line = np.linalg.qr(irradiance[:, None])[0]
        residual = V - line @ (line.T @ V)
        Q += residual.T @ residual
    return Q


@mistake(
    "quadratic_form_no_scale",
    says="You subtract the mean of each column alone. Subtract a straight line in I: s I + r.",
)
def no_scale(blends, degree):
    Q = np.zeros((degree + 1, degree + 1))
    for _, brightness in blends:
        V = brightness[:, None] ** np.arange(degree + 1)
        residual = V - V.mean(axis=0)
        Q += residual.T @ residual
    return Q


@mistake(
    "quadratic_form_one_line",
    says="You fit one line through all blends together. Each has a scale and an offset of its own.",
)
def one_line(blends, degree):
    irradiance = np.concatenate([blend[0] for blend in blends])
    V = np.concatenate([blend[1] for blend in blends])[:, None] ** np.arange(degree + 1)
    lines = np.linalg.qr(np.column_stack([irradiance, np.ones(len(V))]))[0]
    residual = V - lines @ (lines.T @ V)
    return residual.T @ residual


@mistake(
    "quadratic_form_mean_square",
    says="You divide by the number of samples. E is a sum over all samples: do not divide.",
)
def mean_square(blends, degree):
    Q = np.zeros((degree + 1, degree + 1))
    for irradiance, brightness in blends:
        V = brightness[:, None] ** np.arange(degree + 1)
        lines = np.linalg.qr(np.column_stack([irradiance, np.ones(len(V))]))[0]
        residual = V - lines @ (lines.T @ V)
        Q += residual.T @ residual / len(V)
    return Q
