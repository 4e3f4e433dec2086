"""k belongs below the fraction: with more headroom the picture becomes darker, so that bright pixels find
room."""

from hdrlab.tonemap import chiu


def scale(L, *, headroom=8.0, sigma=None):
    return headroom * chiu.scale(L, headroom=1.0, sigma=sigma)
