"""The listing's digit 1 is a letter: lambda. Your smoothness rows do not hold it, so the knob does
nothing."""

from hdrlab.response import debevec


def gsolve(Z, B, smoothness, w):
    return debevec.gsolve(Z, B, 1.0, w)
