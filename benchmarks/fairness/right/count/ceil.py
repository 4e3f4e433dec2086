"""math.ceil and max."""

import math


def count(scene, usable, overlap):
    return max(1, 1 + math.ceil((scene - usable) / (usable - overlap)))
