"""Two running sums over the pairs after the dark one."""


def line(S, V):
    above = below = 0.0
    for s, v in zip(S[1:], V[1:]):
        s, v = float(s), float(v)
        above += s * (v - float(V[0])) / v**2
        below += s * s / v**2
    return above / below
