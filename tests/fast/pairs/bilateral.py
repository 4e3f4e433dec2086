"""fast.bilateral: the mean, right to a hundredth of sigma_r (root mean square), and k, to about a tenth."""

import numpy as np

from pairs import luminance


def filtered(kind, rng):
    """Log luminance in decades, and the widths of tone mapping."""
    if kind == "colour":
        return None  # the filter takes one channel
    lL = np.log10(luminance(kind, rng))
    return (lL,), {"sigma_s": 6.0 if kind == "gray" else 3.0, "sigma_r": 0.4}


PAIRS = {"bilateral": (filtered, (0.02, 0.25))}
