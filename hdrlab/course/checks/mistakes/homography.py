"""Known mistakes in `homography`, the task of hdrlab.calibration.chart.homography."""

import numpy as np

from hdrlab.core.filters import warp
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "homography_inverse",
    says="Your H takes the targets to the sources. Exchange the two.",
)
def inverse(source, target):
    return warp.through(np.asarray(target, float), np.asarray(source, float))


@mistake(
    "homography_affine",
    says="Your last row is (0, 0, 1), so parallel lines stay parallel. A photo of a chart has "
    "perspective: h31 and h32 are unknown, too.",
)
def affine(source, target):
    rows = np.column_stack([source, np.ones(4)])
    solution = np.linalg.lstsq(rows, np.asarray(target, float), rcond=None)[0]
    return np.vstack([solution.T, [0, 0, 1]])


@mistake(
    "homography_rows_first",
    says="Your H moves (y, x). The points are (x, y): the column comes first.",
)
def rows_first(source, target):
    return warp.through(np.asarray(source, float)[:, ::-1], np.asarray(target, float)[:, ::-1])


@mistake(
    "homography_of_length_1",
    says="Your H has length 1, as a singular vector. Divide it by H[2, 2].",
)
def of_length_1(source, target):
    H = warp.through(np.asarray(source, float), np.asarray(target, float))
    return H / np.linalg.norm(H)


@mistake(
    "homography_transposed",
    says="Your H acts on rows, (x, y, 1) H. It must act on columns, H (x, y, 1): transpose it.",
)
def transposed(source, target):
    return warp.through(np.asarray(source, float), np.asarray(target, float)).T
