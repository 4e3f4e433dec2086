"""What is left after the last whole step needs a photograph too: round up, not down."""

import math


def count(scene, usable, overlap):
    return max(1 + math.floor((scene - usable) / (usable - overlap)), 1)
