"""The Detail Brush over a whole picture."""

from pairs import luminance


def tonemap(kind, rng):
    if kind == "colour":
        return None  # operators get only luminance
    return (luminance(kind, rng),), {"bins": 64, "limit": 1.5} if kind == "gray" else {}


PAIRS = {"tonemap": (tonemap, 1e-5)}
