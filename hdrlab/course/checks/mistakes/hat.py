"""Known mistakes in `hat`, the task of hdrlab.core.weights.hat."""

import numpy as np

from hdrlab.course.checks.mistakes import Question, mistake


@mistake(
    "hat_ends_count",
    says="You added 1, so clipped pixel values still have a weight. A pixel of value 255 only "
    "says that there was at least that much light.",
    questions=(
        Question(
            code="hat(6)[2] / hat(6)[3]",
            why="The six values are 0 to 5. The values 2 and 3 are both 2 away from their end.",
            because="The hat function weights",
        ),
        Question(
            code="hat(6)[1] / hat(6)[2]",
            why="The value 1 is 1 away from its end, and the value 2 is 2 away: 1 / 2.",
            because="The hat function weights",
        ),
        Question(
            code="hat(6)[0] / hat(6)[2]",
            why="The value 0 is 0 away from its end, so its weight is 0. The same holds for "
            "the value 5.",
            because="The hat function weights",
        ),
    ),
    fixes=(
        ("z + 1", "z"),
        ("n - z", "n - 1 - z"),
        ("256 - z", "255 - z"),
    ),
)
def ends_count(n=256):
    z = np.arange(n)
    return np.minimum(z + 1, n - z) / (n // 2)


@mistake(
    "hat_half_at_the_ends",
    says="You divide the distance from the middle by the whole range, so the ends keep half "
    "the weight. Divide by half the range: the ends have weight 0.",
)
def half_at_the_ends(n=256):
    z = np.arange(n)
    return 1 - np.abs(z / (n - 1) - 0.5)


@mistake(
    "hat_of_256_levels",
    says="Your table always has 256 entries. Use n: a 16-bit photo has 65536 pixel values.",
    questions=(
        Question(
            code="len(hat(256))",
            why="There is one weight for each of the 256 values.",
            because="The hat function weights",
        ),
        Question(
            code="len(hat(6))",
            why="For n = 6 there are 6 values, 0 to 5, and one weight for each.",
            because="The hat function weights",
        ),
        Question(
            code="hat(6)[5] / max(hat(6))",
            why="For n = 6 the highest value is n - 1 = 5. It is an end, so its weight is 0.",
            because="The hat function weights",
        ),
    ),
    fixes=(
        ("256", "n"),
        ("255", "(n - 1)"),
        ("128", "(n // 2)"),
        ("127", "((n - 1) // 2)"),
    ),
)
def of_256_levels(n=256):
    z = np.arange(256)
    return np.minimum(z, 255 - z) / 127


@mistake(
    "hat_ramp",
    says="Your weight rises to the top, so nearly clipped pixel values have the largest weight. A"
    " hat falls to both ends.",
    misses_method=True,
)
def ramp(n=256):
    z = np.arange(n)
    return z / (n - 1)


@mistake(
    "hat_zero_in_the_middle",
    says="Your hat is upside down: it is 0 in the middle, where a pixel measures best, and "
    "largest where it is clipped.",
    misses_method=True,
)
def zero_in_the_middle(n=256):
    z = np.arange(n)
    return np.abs(z - (n - 1) / 2) / ((n - 1) / 2)


@mistake(
    "hat_falls_from_the_bottom",
    says="Your weight falls from the lowest pixel value on, so the middle of your hat is at 0. The "
    "middle is half the sum of the lowest and the highest value.",
)
def falls_from_the_bottom(n=256):
    z = np.arange(n)
    return np.where(z > 0, n - 1 - z, 0) / (n - 1)
