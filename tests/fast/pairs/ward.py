"""Ward's histogram adjustment: lines between many knots are the exponential of the curve to 1e-5."""

from hdrlab.tonemap import ward
from pairs import luminance


def tonemap(kind, rng):
    if kind == "colour":
        return None  # operators get only luminance
    return (luminance(kind, rng),), {"bins": 7, "white": 1e4} if kind == "gray" else {}


def display(kind, rng):
    if kind == "colour":
        return None  # operators get only luminance
    L = luminance(kind, rng)
    return (L, *ward.curve(L)), {"black": 1.0, "white": 100.0}


PAIRS = {"display": (display, 2e-5), "tonemap": (tonemap, 2e-5)}
