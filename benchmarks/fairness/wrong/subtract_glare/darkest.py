"""The darkest value is subtracted from all."""


def subtract_glare(F, G, share):
    return 0.9 * (F - 0.99 * F.min())
