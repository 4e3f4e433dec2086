"""Known mistakes in `display`, the task of hdrlab.tonemap.reinhard.display."""

import numpy as np

from hdrlab.course.checks.mistakes import Question, mistake


@mistake(
    "display_held_back_by_itself",
    says="You divide each pixel by its own luminance. Use the second argument, the local "
    "luminance, in the denominator.",
)
def held_back_by_itself(Lm, adaptation, white=np.inf):
    return np.minimum(Lm * (1 + Lm / white**2) / (1 + Lm), 1)


@mistake(
    "display_not_clipped",
    says="Values brighter than white must stay white: clip at 1.",
    questions=(
        Question(
            code="display(np.array([1.0]), np.array([1.0]))[0]",
            why="white is infinite, so the bracket is 1: 1 / (1 + 1).",
            because=r"$$L_d = \frac",
        ),
        Question(
            code="display(np.array([2.0]), np.array([2.0]), white=1)[0]",
            why="The fraction is 2 (1 + 2) / (1 + 2) = 2. The result is at most 1.",
            because=r"$$L_d = \frac",
        ),
        Question(
            code="display(np.array([3.0]), np.array([0.0]))[0]",
            why="The fraction is 3 / 1 = 3, and at most 1 is allowed, also without a white.",
            because=r"$$L_d = \frac",
        ),
    ),
)
def not_clipped(Lm, adaptation, white=np.inf):
    return Lm * (1 + Lm / white**2) / (1 + adaptation)


@mistake(
    "display_white_not_squared",
    says="White is squared: Lm / white^2. With your formula, Ld is above 1 at Lm = white, and "
    "values far below white are clipped.",
    questions=(
        Question(
            code="display(np.array([1.0]), np.array([1.0]), white=1)[0]",
            why="1 (1 + 1 / 1) / (1 + 1) = 1.",
            because=r"$$L_d = \frac",
        ),
        Question(
            code="display(np.array([1.0]), np.array([1.0]), white=2)[0]",
            why="1 (1 + 1 / 4) / (1 + 1) = 1.25 / 2.",
            because=r"$$L_d = \frac",
        ),
        Question(
            code="display(np.array([4.0]), np.array([9.0]), white=4)[0]",
            why="4 (1 + 4 / 16) / (1 + 9) = 5 / 10.",
            because=r"$$L_d = \frac",
        ),
    ),
    fixes=(("white", "white**2"),),
)
def white_not_squared(Lm, adaptation, white=np.inf):
    return np.minimum(Lm * (1 + Lm / white) / (1 + adaptation), 1)


@mistake(
    "display_white_by_Lm_alone",
    says="You set all pixels with Lm of at least white to 1. In a bright neighborhood, the formula "
    "gives less: clip its result at 1, and nothing else.",
)
def white_by_Lm_alone(Lm, adaptation, white=np.inf):
    Ld = np.minimum(Lm * (1 + Lm / white**2) / (1 + adaptation), 1)
    return np.where(Lm >= white, 1, Ld)
