"""Backward differences by slices."""


def divergence(G):
    Gy, Gx = G[0].copy(), G[1].copy()
    Gy[-1], Gx[:, -1] = 0, 0
    out = Gy + Gx
    out[1:] -= Gy[:-1]
    out[:, 1:] -= Gx[:, :-1]
    return out
