"""Known mistakes in `display`, the task of hdrlab.tonemap.reinhard.display."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "display_held_back_by_itself",
    says="You hold each pixel back by its own luminance; the second argument is what to hold "
    "it back by.",
)
def held_back_by_itself(Lm, adaptation, white=np.inf):
    return np.minimum(Lm * (1 + Lm / white**2) / (1 + Lm), 1)


@mistake(
    "display_not_clipped",
    says="What is brighter than white stays white: clip at 1.",
)
def not_clipped(Lm, adaptation, white=np.inf):
    return Lm * (1 + Lm / white**2) / (1 + adaptation)


@mistake(
    "display_white_not_squared",
    says="White is squared: Lm / white^2. As you have it, Lm = white comes out above 1, and is "
    "clipped long before.",
)
def white_not_squared(Lm, adaptation, white=np.inf):
    return np.minimum(Lm * (1 + Lm / white) / (1 + adaptation), 1)
