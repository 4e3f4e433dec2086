"""A wrong count: first forgotten."""

import math

TASK = "count"
MISCONCEPTION = (
    "The first photograph holds its whole usable range; only what is beyond that is divided by the step."
)


def count(scene, usable, overlap):
    return max(math.ceil(scene / (usable - overlap)), 1)
