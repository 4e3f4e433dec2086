"""Exposure fusion. Where every photograph is flat or gray all weigh alike: no rounding decides."""

from pairs import photographs


def split(kind, rng):
    return (photographs(kind, rng)[1],), {}


def weighed(kind, rng):
    return (photographs(kind, rng),), {"powers": (0.5, 2, 1)} if kind == "colour" else {}


def fused(kind, rng):
    return (photographs(kind, rng, frames=4),), {"contrast": 0.5, "saturation": 2.0} if kind == "deep" else {}


PAIRS = {
    "split_planes": (split, 1e-6),
    "weights": (weighed, 1e-5),
    "fuse_steps": (fused, 1e-5),
    "fuse": (fused, 1e-5),
}
