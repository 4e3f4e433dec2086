"""Known mistakes in `threshold`, the task of hdrlab.align.mtb.threshold."""

import numpy as np

from hdrlab.course.checks.mistakes import Question, mistake


@mistake(
    "threshold_always_half",
    says="You always take the median. Take the quantile q.",
    questions=(
        Question(
            code="h = np.bincount([10, 20, 30], minlength=256)\nthreshold(h, 0.5)",
            why="2 of 3 pixels lie at or below 20, and only 1 of 3 at or below 10.",
            because="The threshold is the lowest",
        ),
        Question(
            code="h = np.bincount([10, 20, 30], minlength=256)\nthreshold(h, 0.9)",
            why="2 of 3 pixels are too few for the fraction 0.9. All 3 lie at or below 30.",
            because="The threshold is the lowest",
        ),
        Question(
            code="h = np.bincount([10, 20, 30], minlength=256)\nthreshold(h, 0.1)",
            why="1 of 3 pixels lies at or below 10. That is enough for the fraction 0.1.",
            because="For $q = 1/2$ that is the median",
        ),
    ),
    fixes=(
        ("/ 2", "* q"),
        ("// 2", "* q"),
        ("0.5", "q"),
    ),
)
def always_half(h, q):
    below = np.cumsum(h)
    return np.searchsorted(below, 0.5 * below[-1])


@mistake(
    "threshold_mean",
    says="This is the mean, not the median. A few bright pixels raise it, so fewer than half "
    "of the pixels are above it.",
    misses_method=True,
)
def mean(h, q):
    return int(np.sum(np.arange(256) * h) / np.sum(h))


@mistake(
    "threshold_goes_on",
    says="Where the cumulative count is exactly q, you go on to the next pixel value. At least q is "
    "enough: use side='left', or >= in place of >.",
    questions=(
        Question(
            code="h = np.bincount([10, 10, 10, 200], minlength=256)\nthreshold(h, 0.5)",
            why="3 of 4 pixels lie at or below 10. That is more than half.",
            because="The threshold is the lowest",
        ),
        Question(
            code="h = np.bincount([10, 10, 200, 200], minlength=256)\nthreshold(h, 0.5)",
            why="2 of 4 pixels lie at or below 10. That is exactly half, and at least half "
            "is enough.",
            because="The threshold is the lowest",
        ),
        Question(
            code="h = np.bincount([7], minlength=256)\nthreshold(h, 1.0)",
            why="The only pixel lies at 7, so the fraction 1 lies at or below 7.",
            because="The threshold is the lowest",
        ),
    ),
    fixes=((">", ">="),),
)
def goes_on(h, q):
    below = np.cumsum(h)
    return np.searchsorted(below, np.asarray(q) * below[-1], side="right")
