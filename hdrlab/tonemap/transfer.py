"""Codes for luminance beyond a gamma: PQ (SMPTE ST 2084, 2014) and HLG (ARIB STD-B67); both ITU-R BT.2100.

FD     luminance of a display           cd/m2, 0 to 10,000; any shape
E      light of the scene               0 to 1, 1 = the brightest that is coded; any shape
v      signal, E' in BT.2100            0 to 1, the code over the largest code; same shape
peak   L_W, the largest luminance      cd/m2, of a display

PQ is absolute: a code stands for a luminance in cd/m2, and with 12 bits each step is just below the
threshold of vision. HLG is relative: up to v = 1/2 it is a square root, similar to a gamma, so that
a display without HDR can show it; above that it is a logarithm. Each display scales E to its own
peak.
"""

from collections.abc import Callable

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, describe
from hdrlab.errors import InputError

# cd/m2, of PQ's largest code
PEAK_LUMINANCE = 10_000
# m1, m2, c1, c2, c3 of PQ [BT.2100 table 4]
M1 = 2610 / 16384
M2 = 128 * 2523 / 4096
C1 = 3424 / 4096
C2 = 32 * 2413 / 4096
C3 = 32 * 2392 / 4096
# cd/m2, the peaks for which BT.2100 fitted its line of the system gamma
LINE_PEAKS = (400, 2000)
# a, b, c of HLG [BT.2100 table 5]: square root and logarithm meet at E = 1/12 with the same slope,
# and v = 1 at E = 1
A = 0.17883277
B = 1 - 4 * A
C = 0.5 - A * np.log(4 * A)


def within(values: ArrayLike, high: float) -> F64:
    """Return values as float64, or raise a ValueError if one is not in 0 ... high.

    Values that exceed `high` by rounding are clipped.
    """
    array = np.asarray(values, np.float64)
    if not np.all((array >= 0) & (array <= high * (1 + 1e-6))):
        raise InputError(f"expected values in 0 ... {high}, got {describe(values)}")
    return np.minimum(array, high)


def pq(FD: ArrayLike) -> F64:
    """Return v = ((c1 + c2 Y^m1) / (1 + c3 Y^m1))^m2, Y = FD / 10,000 [BT.2100 table 4, inverse EOTF].

    Examples
    --------
    >>> pq([0.1, 1, 100, 10_000]).round(3)
    array([0.062, 0.15 , 0.508, 1.   ])
    """
    Ym = (within(FD, PEAK_LUMINANCE) / PEAK_LUMINANCE) ** M1
    return ((C1 + C2 * Ym) / (1 + C3 * Ym)) ** M2


def pq_inverse(v: ArrayLike) -> F64:
    """Return FD = 10,000 (max(v^(1/m2) - c1, 0) / (c2 - c3 v^(1/m2)))^(1/m1) [BT.2100 table 4, EOTF]."""
    vm = within(v, 1) ** (1 / M2)
    return PEAK_LUMINANCE * (np.maximum(vm - C1, 0) / (C2 - C3 * vm)) ** (1 / M1)


def hlg(E: ArrayLike) -> F64:
    """Return v = sqrt(3 E) up to E = 1/12, and a ln(12 E - b) + c above it [BT.2100 table 5, OETF].

    Examples
    --------
    >>> hlg([0, 1 / 12, 1]).round(3)
    array([0. , 0.5, 1. ])
    """
    E = within(E, 1)
    return np.where(E <= 1 / 12, np.sqrt(3 * E), A * np.log(np.maximum(12 * E, 1) - B) + C)


def hlg_inverse(v: ArrayLike) -> F64:
    """Return E = v^2 / 3 up to v = 1/2, and (exp((v - c) / a) + b) / 12 above it [BT.2100 table 5]."""
    v = within(v, 1)
    return np.where(v <= 0.5, v**2 / 3, (np.exp((v - C) / A) + B) / 12)


def system_gamma(peak: float) -> float:
    """Return gamma = 1.2 + 0.42 log10(L_W / 1000) for L_W of 400 to 2000 cd/m2 [BT.2100 table 5].

    Beyond this range, the line would fall to 0 and below. There gamma = 1.2 * 1.111^log2(L_W / 1000)
    [BT.2390 sec. 6.2], which is 0.01 above the line where they meet.

    Parameters
    ----------
    peak : L_W, cd/m2

    Returns
    -------
    gamma : the exponent of the light of a scene, larger for a brighter display

    Raises
    ------
    InputError
        For a peak that is not positive and finite.

    Examples
    --------
    >>> [round(system_gamma(peak), 2) for peak in (100, 1000, 10_000)]
    [0.85, 1.2, 1.7]
    """
    if not 0 < peak < np.inf:
        raise InputError(f"expected the display's peak in cd/m2, above 0, got {peak}")
    lowest, highest = LINE_PEAKS
    if lowest <= peak <= highest:
        return float(1.2 + 0.42 * np.log10(peak / 1000))
    return float(1.2 * 1.111 ** np.log2(peak / 1000))


def display_light(E: ArrayLike, *, peak: float = 1000.0) -> F64:
    """Return FD = L_W E^gamma of a gray, with the `system_gamma` of L_W [BT.2100 table 5, OOTF].

    A color's channels are multiplied by L_W Y^(gamma - 1), where Y is the luminance of E.
    """
    return peak * within(E, 1) ** system_gamma(peak)


def codes(
    encode: Callable[[float], ArrayLike], low: float, high: float, *, bits: int = 10
) -> float:
    """Return the number of codes between two luminances, (2^bits - 1) (encode(high) - encode(low)).

    The codes are those of the full range, 0 to 2^bits - 1, as files of photos have them. Films use
    the narrow range, with 10 bits 64 to 940: 876 steps instead of 1023.

    Examples
    --------
    >>> round(codes(pq, 0.1, 1.0)), round(codes(lambda FD: (FD / 10_000) ** (1 / 2.4), 0.1, 1.0))
    (90, 14)
    """
    return (2**bits - 1) * float(np.subtract(encode(high), encode(low)))
