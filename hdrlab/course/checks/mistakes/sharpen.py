"""Known mistakes in `sharpen`, the task of hdrlab.beyond.flutter.sharpen."""

import numpy as np

from hdrlab.beyond.flutter import matrix
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "sharpen_divided_spectra",
    says="You divide the spectra of y and h, and cut off the end. That amplifies noise, and uses "
    "no least squares: the end must be 0. Solve A x = y.",
)
def divided_spectra(y, h):
    y = np.asarray(y, np.float64)
    columns = y.reshape(len(y), -1)
    H = np.fft.fft(np.asarray(h, np.float64) / len(h), len(y))
    x = np.fft.ifft(np.fft.fft(columns, axis=0) / H[:, None], axis=0).real
    n = len(y) - len(h) + 1
    return x[:n].reshape(n, *y.shape[1:])


@mistake(
    "sharpen_first_rows",
    says="You use only the first n rows of the photo, so errors add up from row to row. Use all "
    "n + m - 1 rows, by least squares.",
)
def first_rows(y, h):
    y = np.asarray(y, np.float64)
    n = len(y) - len(h) + 1
    return np.linalg.solve(matrix(h, n)[:n], y[:n])


@mistake(
    "sharpen_code_reversed",
    says="Your code runs backwards. Column j of A contains h[0] / m in row j, and then h[1] / m "
    "below it.",
)
def code_reversed(y, h):
    y = np.asarray(y, np.float64)
    A = matrix(np.asarray(h)[::-1], len(y) - len(h) + 1)
    return np.linalg.lstsq(A, y)[0]


@mistake(
    "sharpen_open_chops",
    says="You take the columns of A as h divided by the number of open chops. y is the light of "
    "all m chops: divide h by m.",
)
def open_chops(y, h):
    y = np.asarray(y, np.float64)
    A = matrix(h, len(y) - len(h) + 1) * len(h) / np.sum(h)
    return np.linalg.lstsq(A, y)[0]


@mistake(
    "sharpen_ridge",
    says="Your x is smaller than it should be, because you penalize large values. Minimize the "
    "squares of A x - y alone.",
)
def ridge(y, h):
    y = np.asarray(y, np.float64)
    A = matrix(h, len(y) - len(h) + 1)
    return np.linalg.solve(A.T @ A + 1e-2 * np.eye(A.shape[1]), A.T @ y)
