"""Samples and photographs for Robertson's iterations."""

from hdrlab.core import sampling, weights
from pairs import photographs


def samples(kind, rng):
    """Return Z, times and w; `deep` has all pixels, `clipped` a cut."""
    choose = sampling.every_pixel if kind == "deep" else sampling.by_grid
    Z = choose(photographs("gray" if kind == "colour" else kind, rng), 60)
    w = weights.cut(weights.hat(), below=0.02) if kind == "clipped" else weights.gaussian()
    return (Z, [0.25, 1, 4], w), {"max_iterations": 9}


def bracket(kind, rng):
    """Return photographs whose levels rise with the times."""
    return (photographs(kind, rng), [0.25, 1, 4]), {"samples": 60}


PAIRS = {"recover_steps": (samples, 1e-8), "recover": (bracket, 1e-8)}
