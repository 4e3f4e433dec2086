"""Each further photograph adds only what it does not share with its neighbour: usable less overlap."""

import math


def count(scene, usable, overlap):
    return max(1 + math.ceil((scene - usable) / usable), 1)
