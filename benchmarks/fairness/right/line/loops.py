"""Two sums in a loop over the pairs."""


def line(S, V):
    above = below = 0.0
    for s, v in zip(S, V):
        weight = 1.0 / float(v) ** 2
        above += weight * float(s) * (float(v) - float(V[0]))
        below += weight * float(s) ** 2
    return above / below
