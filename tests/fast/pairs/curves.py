"""fast.curves: the lesson's own curves, equal to the last bit except for powers of whole and cut
rows.
"""

from pairs import luminance

CURVES = {"gray": "linear", "flat": "gamma"}


def shown(kind, rng):
    """Luminance, and each of the curves."""
    return (
        None if kind == "colour" else ((luminance(kind, rng),), {"curve": CURVES.get(kind, "log")})
    )


PAIRS = {"tonemap": (shown, 1e-6)}
