"""math.ceil of the quotient, and max with 1: a Python int."""

import math


def count(scene, usable, overlap):
    return max(1, 1 + math.ceil((scene - usable) / (usable - overlap)))
