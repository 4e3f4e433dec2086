"""Choose some photos of a large bracket for work whose cost grows faster than their number."""

import numpy as np

from hdrlab.core.arrays import F64, Indices


def choose_spread_frames(times: F64, count: int) -> Indices:
    """Return at most `count` photos that are spread over the exposure times of a bracket.

    The shortest and the longest are among them. A photo that alone has a time far from the others
    is chosen before one of many with similar times.

    Parameters
    ----------
    times : (P,) float
        Exposure times in seconds, from short to long.
    count : int
        At least 2.

    Returns
    -------
    (min(P, count),) int
        Indices of the photos, ascending.

    Examples
    --------
    >>> choose_spread_frames(np.array([1, 2, 4, 4, 4, 4, 4.0]), 4).tolist()
    [0, 1, 2, 6]
    """
    P = len(times)
    if P <= count:
        return np.arange(P)
    B = np.log(times)
    targets = np.linspace(B[0], B[-1], count)
    nearest = np.abs(B - targets[:, None]).argmin(axis=1)
    chosen = np.unique(np.append(nearest, P - 1))[-count:]
    chosen[0] = 0
    others = np.setdiff1d(np.arange(P), chosen)
    missing_count = count - len(chosen)
    even = (np.arange(missing_count) + 0.5) * len(others) // max(missing_count, 1)
    return np.sort(np.append(chosen, others[even.astype(int)]))
