"""Planning a bracket: how many photographs a scene takes, and which.

L_low, L_high  luminances of the scene that the photographs shall hold, cd/m^2
R  usable range    stops of one photograph, from where it clips down to where noise and rounding take over
O  overlap         stops that two neighbours hold both, for the calibration needs them
T  shutter time    s, of powers of two: what the dial's names really are

The first photograph clips above L_high, each next one lies R - O stops below, the last holds L_low:

    n = 1 + ceil((log2(L_high / L_low) - R) / (R - O)),  at least 1
"""

import math
from typing import NamedTuple

import numpy as np

from hdrlab.capture import exposure
from hdrlab.core.types import F64


class Plan(NamedTuple):
    """Photographs to take, from the shortest: what the dial says, what it does, and what each holds."""

    names: tuple[str, ...]  # (n,) as on the dial; a time beyond it is in seconds
    times: F64  # (n,) s, true
    holds: F64  # (n, 2) cd/m^2, lowest and highest luminance of each photograph
    step: float  # stops from one to the next


def count(scene: float, usable: float, overlap: float) -> int:
    """Return n = 1 + ceil((scene - R) / (R - O)), all in stops, and at least 1."""
    return max(1 + math.ceil((scene - usable) / (usable - overlap) - 1e-9), 1)


def plan(
    L_low: float,
    L_high: float,
    *,
    aperture: float = 8.0,
    iso: float = 100.0,
    usable: float = 7.0,
    overlap: float = 3.0,
    per_stop: int = 1,
) -> Plan:
    """Plan a bracket that covers a scene.

    Parameters
    ----------
    L_low, L_high : cd/m^2, the darkest and brightest luminance to hold: spot-metered, or of a radiance map
    aperture : F, f-number; it stays the same in all, for it changes the depth of field
    iso : S, speed; it stays the same, for it changes the noise
    usable : R, stops of one photograph. An 8-bit sRGB picture has 11.7 stops from its first level to its
        last; in the upper 7 of them a level is finer than a tenth of a stop.
    overlap : O, stops of agreement between neighbours
    per_stop : settings of the dial per stop, 1 or 3

    Returns
    -------
    plan : Plan

    Raises
    ------
    ValueError
        For luminances that are not positive and rising, or an overlap that leaves no step.

    Examples
    --------
    >>> bracket = plan(0.01, 1000)
    >>> bracket.names, bracket.step
    (('1/15', '1', '15', '256'), 4.0)
    """
    if not 0 < L_low <= L_high < math.inf:
        raise ValueError(f"expected luminances 0 < low <= high, got {L_low} and {L_high} cd/m^2")
    if not 0 <= overlap < usable < math.inf:
        raise ValueError(f"expected an overlap from 0 to below the {usable} usable stops, got {overlap}")
    dial = exposure.shutter_series(per_stop)
    step = math.floor((usable - overlap) * per_stop + 1e-9) / per_stop
    if step <= 0:
        raise ValueError(f"expected a step of at least 1/{per_stop} stop, got {usable - overlap:.2f}")
    fills = exposure.saturating_luminance(1.0, F=aperture, S=iso)  # cd/m^2, in one second
    first = math.floor(math.log2(fills / L_high) * per_stop + 1e-9) / per_stop
    reach = math.log2(fills / 2.0**first / L_low)
    times = np.exp2(first + step * np.arange(count(reach, usable, usable - step)))
    holds = np.stack([fills / times * 2.0**-usable, fills / times], axis=1).astype(np.float64)
    return Plan(tuple(_name(t, dial) for t in times), times, holds, step)


def _name(time: float, dial: exposure.Dial) -> str:
    """Return what the dial says for a true time, or the seconds themselves beyond its ends."""
    found = np.flatnonzero(np.abs(np.log2(dial.values / time)) < 0.01)
    return dial.names[found[0]] if len(found) else f"{time:g}" if time >= 1 else f"1/{1 / time:g}"
