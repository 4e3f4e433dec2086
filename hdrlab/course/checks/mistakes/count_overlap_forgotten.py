"""A wrong count: overlap forgotten."""

import math

TASK = "count"
MISCONCEPTION = (
    "Each further photograph adds only what it does not share with its neighbour: usable less overlap."
)


def count(scene, usable, overlap):
    return max(1 + math.ceil((scene - usable) / usable), 1)
