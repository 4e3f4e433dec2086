"""Pairs of neighbouring widths by zip, a tuple class like the sheet's, adaptation by boolean indices."""

import numpy as np


class Scale(tuple):
    """The sheet's five values, with their names, without typing.NamedTuple."""

    width = property(lambda self: self[0])
    centre = property(lambda self: self[1])
    response = property(lambda self: self[2])
    even = property(lambda self: self[3])
    adaptation = property(lambda self: self[4])


def response(centre, surround, s, key, phi):
    return (centre - surround) / (np.exp2(phi) * key / (s * s) + centre)


def scale_steps(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    blurred = list(blurred)
    s = 1.0
    so_far = np.array(blurred[0])
    even = np.full(so_far.shape, True)
    for centre, surround in zip(blurred, blurred[1:]):
        V = response(centre, surround, s, key, phi)
        even = np.logical_and(even, abs(V) < threshold)
        so_far = so_far.copy()
        so_far[even] = centre[even]
        yield Scale((s, centre, V, even, so_far))
        s *= 1.6
