"""Known mistakes in `update`, the task of hdrlab.response.robertson.update."""

import numpy as np

from hdrlab.course.checks.mistakes import Question, mistake


@mistake(
    "update_weighted",
    says="You use weights in the update of f^-1. It is a plain mean over the pixels of one value.",
)
def weighted(Z, t, E, n=256):
    known = ~np.isnan(E)
    X = E[known, None] * t
    with np.errstate(invalid="ignore"):
        return np.bincount(Z[known].ravel(), (X * t).ravel(), n) / np.bincount(
            Z[known].ravel(), np.broadcast_to(t, X.shape).ravel(), n
        )


@mistake(
    "update_by_all_samples",
    says="You divide by the number of all samples. Divide each sum by the number of pixels of "
    "that value.",
)
def by_all_samples(Z, t, E, n=256):
    known = ~np.isnan(E)
    X = E[known, None] * t
    with np.errstate(invalid="ignore"):
        return np.bincount(Z[known].ravel(), X.ravel(), n) / np.where(
            np.bincount(Z[known].ravel(), minlength=n) > 0, len(Z), 0
        )


@mistake(
    "update_nan_taken_for_0",
    says="You count samples of unknown irradiance as 0, which lowers the mean. Leave them out.",
)
def nan_taken_for_0(Z, t, E, n=256):
    known = np.ones(len(E), bool)
    E = np.nan_to_num(E)
    X = E[known, None] * t
    with np.errstate(invalid="ignore"):
        return np.bincount(Z[known].ravel(), X.ravel(), n) / np.bincount(
            Z[known].ravel(), minlength=n
        )


@mistake(
    "update_time_forgotten",
    says="A pixel of value m received the exposure E t. You forgot the exposure time in your mean.",
)
def time_forgotten(Z, t, E, n=256):
    known = ~np.isnan(E)
    X = E[known, None] + 0 * t
    with np.errstate(invalid="ignore"):
        return np.bincount(Z[known].ravel(), X.ravel(), n) / np.bincount(
            Z[known].ravel(), minlength=n
        )


@mistake(
    "update_nan_spreads",
    says="One sample with NaN makes the whole mean NaN. Leave out the samples without irradiance, in "
    "the sum and in the count.",
)
def nan_spreads(Z, t, E, n=256):
    X = E[:, None] * t
    with np.errstate(invalid="ignore"):
        return np.bincount(Z.ravel(), X.ravel(), n) / np.bincount(Z.ravel(), minlength=n)


@mistake(
    "update_empty_is_0",
    says="A pixel value that no pixel has gets 0 in your curve. Nothing is known about it: return "
    "NaN there.",
    questions=(
        Question(
            code="update(np.array([[1]]), np.array([2.0]), np.array([3.0]), 4)[1]",
            why="One pixel has the value 1. Its exposure is 3 times 2 s.",
            because="$$f^{-1}(m)",
        ),
        Question(
            code="update(np.array([[1]]), np.array([2.0]), np.array([3.0]), 4)[2]",
            why="No pixel has the value 2. Nothing is known about it.",
            because="If a value $m$ has no",
        ),
        Question(
            code="update(np.array([[1]]), np.array([2.0]), np.array([np.nan]), 4)[1]",
            why="The irradiance of the only sample is NaN, so the sample is ignored, and no "
            "pixel of the value 1 is left.",
            because="If a value $m$ has no",
        ),
    ),
    fixes=(
        ("np.zeros(n)", "np.full(n, np.nan)"),
        ("np.maximum(count, 1)", "count"),
    ),
)
def empty_is_0(Z, t, E, n=256):
    known = ~np.isnan(E)
    X = E[known, None] * t
    count = np.bincount(Z[known].ravel(), minlength=n)
    return np.bincount(Z[known].ravel(), X.ravel(), n) / np.maximum(count, 1)
