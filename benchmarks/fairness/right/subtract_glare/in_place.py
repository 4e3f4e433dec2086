"""Assigned through a mask."""


def subtract_glare(F, G, share):
    E = (F - share * G) / (1 - share)
    low = 0.001 * F / (1 - share)
    E[E < low] = low[E < low]
    return E
