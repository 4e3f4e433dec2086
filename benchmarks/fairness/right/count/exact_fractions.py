"""Decimal fractions instead of binary ones, so that 1.2 / 0.4 is 3 and not a little above."""

from fractions import Fraction
from math import ceil


def _exact(stops):
    return Fraction(str(float(stops)))


def count(scene, usable, overlap):
    scene, usable, overlap = map(_exact, (scene, usable, overlap))
    n = 1 + ceil((scene - usable) / (usable - overlap))
    return n if n > 1 else 1
