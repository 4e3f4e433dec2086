"""You multiplied by L already: s = 1 / (k blur(L)) is the scale alone. A further factor L, where it is
printed, is a misprint, and makes L^2 of the picture."""

from hdrlab.tonemap import chiu


def scale(L, *, headroom=8.0, sigma=None):
    return L * chiu.scale(L, headroom=headroom, sigma=sigma)
