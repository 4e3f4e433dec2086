"""fast.blur: the kernel of the coarse grid is a Gaussian within 0.2 % of its peak; below sigma = 4
within float32.
"""

from pairs import luminance


def blurred(kind, rng):
    """A narrow blur for some kinds, a wide one for others."""
    if kind == "colour":
        return None  # a blur takes one channel
    return (luminance(kind, rng), {"flat": 6.0, "gray": 9.0, "row": 5.0}.get(kind, 2.5)), {}


PAIRS = {"gaussian": (blurred, 2e-3)}
