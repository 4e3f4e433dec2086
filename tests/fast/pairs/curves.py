"""fast.curves: the lesson's own curves, to the last bit but for the powers of whole and cut rows."""

from pairs import luminance

CURVES = {"gray": "linear", "flat": "gamma"}


def shown(kind, rng):
    """Luminance, and each of the curves."""
    return (
        None if kind == "colour" else ((luminance(kind, rng),), {"curve": CURVES.get(kind, "log")})
    )


PAIRS = {"tonemap": (shown, 1e-6)}
