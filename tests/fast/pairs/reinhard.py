"""fast.reinhard: float32 compared with float64; rounding may change a response at the neighborhood
threshold.
"""

from hdrlab.tonemap import reinhard
from pairs import luminance


def scene(kind, rng):
    """Luminance."""
    return None if kind == "colour" else ((luminance(kind, rng),), {})


def scaled(kind, rng):
    """Scaled luminance, smooth enough for no response to lie at the threshold."""
    return None if kind == "colour" else ((reinhard.scale_to_key(luminance(kind, rng)),), {})


def held_back(kind, rng):
    """Scaled luminance, the adaptation luminance, and a white for some kinds."""
    if kind == "colour":
        return None
    Lm = reinhard.scale_to_key(luminance(kind, rng))
    return (Lm, Lm[::-1], {"gray": 2.0}.get(kind, float("inf"))), {}


def shown(kind, rng):
    """Luminance, and the modes of the operator."""
    knobs = {
        "gray": {"key": "auto"},
        "clipped": {"local": True},
        "tiny": {"local": True, "white": 2.0},
    }
    return None if kind == "colour" else ((luminance(kind, rng),), knobs.get(kind, {}))


PAIRS = {
    "log_average": (scene, 1e-5),
    "automatic_key": (scene, 1e-4),
    "scale_to_key": (scene, 1e-5),
    "white_point": (scaled, 1e-6),
    "display": (held_back, 0),
    "local_adaptation": (scaled, 1e-4),
    "tonemap": (shown, 1e-4),
}
