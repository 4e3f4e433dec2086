"""Planning a bracket: how many photographs a scene takes, and which.

L_low, L_high  luminances of the scene that the photographs shall hold, cd/m^2
U  usable range    stops of one photograph, from where it clips down to where noise and rounding take over
O  overlap         stops that two neighbours hold both, for the calibration needs them
T  shutter time    s, of powers of two: what the dial's names really are

The first photograph clips above L_high, each next one lies U - O stops below, the last holds L_low:

    n = 1 + ceil((D - U) / (U - O)),  at least 1,  D = log2(L_high / L_low)

Which photographs take the least time, if all of the scene must reach some signal-to-noise ratio? In
the mean by inverse variance the squares of SNR add over the photographs, so their numbers n_j solve an
integer program (Hasinoff, Durand and Freeman, CVPR 2010):

    least sum_j n_j (t_j + pause)   with   sum_j n_j SNR_j(L)^2 >= SNR^2   for all L from L_low to L_high

Each SNR_j rises with L until its photograph is full. So it is enough to check at L_low, and just above
each luminance that fills a photograph.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp

from hdrlab.capture import exposure
from hdrlab.core.arrays import F64, ArrayLike, NDArray
from hdrlab.core.silence import silence
from hdrlab.errors import InputError

# A plan has at most this many photographs of one setting.
MAX_PHOTOGRAPHS_PER_SETTING = 1000
# A plan may take this fraction longer than the shortest one, which saves much of the search.
_MAX_EXCESS_TIME_FRACTION = 0.01
# The search gives up after this many nodes, and returns the best plan so far.
_MAX_SEARCH_NODES = 1000
# Two times are one setting of the dial if they differ by less than this.
_SAME_TIME_STOPS = 0.01


@dataclass(frozen=True, kw_only=True, eq=False)
class Plan:
    """Photographs to take, from the shortest to the longest.

    Attributes
    ----------
    names : (n,) times as on the dial; a time beyond its ends is in seconds
    times : (n,) true times, seconds
    holds : (n, 2) lowest and highest luminance that each photograph holds, cd/m^2
    step : stops from one photograph to the next
    """

    names: tuple[str, ...]
    times: F64
    holds: F64
    step: float


class Model(NamedTuple):
    """A camera's noise. The defaults are those of a good camera; photon transfer measures them.

    Attributes
    ----------
    full_well : electrons of a full pixel at the lowest speed; half of it at twice the speed
    read_noise : R, electrons, before the amplifier
    gain : K, electrons per level at the lowest speed; half of it at twice the speed
    converter_noise : q, levels, after the amplifier
    speeds : S, ISO
    pause : seconds after each photograph
    aperture : F, f-number
    """

    full_well: float = 20_000.0
    read_noise: float = 5.0
    gain: float = 5.0
    converter_noise: float = 0.0
    speeds: tuple[float, ...] = (100.0,)
    pause: float = 0.2
    aperture: float = 8.0


class Shots(NamedTuple):
    """Photographs to take, from the shortest: what the dial says, true seconds, and ISO speeds."""

    names: tuple[str, ...]
    times: F64
    speeds: F64


def count(scene: float, usable: float, overlap: float) -> int:
    """Return n = 1 + ceil((D - U) / (U - O)), all in stops, and at least 1."""
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
    L_low, L_high : cd/m^2, the darkest and brightest luminance to hold: spot-metered, or of a
        radiance map
    aperture : F, f-number; it stays the same in all, for it changes the depth of field
    iso : S, speed; it stays the same, for it changes the noise
    usable : U, stops of one photograph. An 8-bit sRGB picture has 11.7 stops from its first level
        to its
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
        raise InputError(f"expected luminances 0 < low <= high, got {L_low} and {L_high} cd/m^2")
    if not 0 <= overlap < usable < math.inf:
        raise InputError(
            f"expected an overlap from 0 to below the {usable} usable stops, got {overlap}"
        )
    dial = exposure.shutter_series(per_stop)
    step = math.floor((usable - overlap) * per_stop + 1e-9) / per_stop
    if step <= 0:
        raise InputError(
            f"expected a step of at least 1/{per_stop} stop, got {usable - overlap:.2f}"
        )
    fills = exposure.saturating_luminance(1.0, F=aperture, S=iso)  # cd/m^2, in one second
    first = math.floor(math.log2(fills / L_high) * per_stop + 1e-9) / per_stop
    reach = math.log2(fills / 2.0**first / L_low)
    times = np.exp2(first + step * np.arange(count(reach, usable, usable - step)))
    holds = np.stack([fills / times * 2.0**-usable, fills / times], axis=1).astype(np.float64)
    names = tuple(_name(time, dial) for time in times)
    return Plan(names=names, times=times, holds=holds, step=step)


def around(middle: float, times: F64, frames: int, stops: float) -> NDArray[np.intp]:
    """Return which of a camera's times (K,) are nearest to T 2^(j stops), j = -(n - 1) / 2, ..., (n - 1) / 2.

    Where the camera's times end on one side, all move to the other.

    Raises
    ------
    ValueError
        Where two of the photographs would have the same time.

    Examples
    --------
    >>> around(1 / 60, exposure.shutter_series().values, 3, 2.0).tolist()
    [13, 11, 9]
    """
    known = np.log2(times)
    wanted = np.log2(middle) + stops * (np.arange(frames) - (frames - 1) / 2)
    wanted += max(known.min() - wanted[0], 0) + min(known.max() - wanted[-1], 0)
    chosen = np.abs(known[:, None] - wanted).argmin(axis=0)
    if len(set(chosen)) < frames:
        has = f"{len(times)} over {np.ptp(known):.1f} stops"
        raise InputError(
            f"expected {frames} times {stops:g} stops apart, but the camera has only {has}"
        )
    return chosen


def squared_snr(L: ArrayLike, times: F64, speeds: F64, camera: Model) -> F64:
    """Return N^2 / (N + R^2 + K^2 (q^2 + 1 / 12)) of luminances (K,) in photographs (n,); 0 where full."""
    share = np.asarray(L)[:, None] / exposure.saturating_luminance(
        times, F=camera.aperture, S=speeds
    )
    N = share * camera.full_well * min(camera.speeds) / speeds
    K = camera.gain * min(camera.speeds) / speeds
    noise = N + camera.read_noise**2 + K**2 * (camera.converter_noise**2 + 1 / 12)
    return np.where(share <= 1, N**2 / noise, 0.0)


def settings(L_low: float, L_high: float, snr: float, camera: Model) -> tuple[F64, F64]:
    """Return times and speeds (n,) to choose from: no shorter than photons allow, none full everywhere."""
    fills = np.array(
        [exposure.saturating_luminance(1, F=camera.aperture, S=speed) for speed in camera.speeds]
    )
    first = fills.min() / L_high * min(snr**2 / camera.full_well, 1)
    last = fills.max() / L_low
    stops = np.arange(np.floor(np.log2(first)), np.ceil(np.log2(last)) + 1)
    t, S = np.meshgrid(2.0**stops, camera.speeds, indexing="ij")
    return t.ravel(), S.ravel()


def hardest(L_low: float, L_high: float, times: F64, speeds: F64, camera: Model) -> F64:
    """Return the luminances where SNR is least: L_low, and just above those that fill a photograph."""
    full = np.asarray(exposure.saturating_luminance(times, F=camera.aperture, S=speeds))
    return np.append(L_low, full[(full >= L_low) & (full < L_high)] * (1 + 1e-9))


def worst_snr(L_low: float, L_high: float, times: F64, speeds: F64, camera: Model) -> float:
    """Return the least signal over noise from L_low to L_high, in the mean by inverse variance."""
    L = hardest(L_low, L_high, times, speeds, camera)
    return float(np.sqrt(squared_snr(L, times, speeds, camera).sum(axis=1).min()))


def plan_by_noise(L_low: float, L_high: float, snr: float, camera: Model = Model()) -> Shots:  # noqa: B008
    """Plan the photographs that show all of a scene at some signal-to-noise ratio in the least time.

    Parameters
    ----------
    L_low, L_high : cd/m^2, the darkest and brightest luminance
    snr : signal-to-noise ratio that each luminance between them must reach in the mean by inverse
        variance
    camera : Model of the camera's noise; each photograph takes the best of its speeds

    Returns
    -------
    shots : Shots
        Times are powers of two, as on the dial and beyond. No other such photographs take a
        hundredth less time, unless those are hard to find.

    Raises
    ------
    ValueError
        For luminances, a ratio or a camera that mean nothing, and for a ratio that
        `MAX_PHOTOGRAPHS_PER_SETTING` photographs of each setting do not reach.

    References
    ----------
    Hasinoff, Durand and Freeman, Noise-optimal capture for high dynamic range photography, CVPR
    2010.

    Examples
    --------
    >>> shots = plan_by_noise(0.1, 3000, 20)
    >>> shots.names, float(shots.times.sum())
    (('1/125', '1/60', '1', '15'), 17.0234375)
    """
    positive = [L_low, snr, camera.full_well, camera.gain]
    rest = [L_high - L_low, camera.read_noise, camera.converter_noise, camera.pause]
    if not (min(positive) > 0 <= min(rest) and np.isfinite(positive + rest).all()):
        raise InputError(
            f"expected 0 < low <= high, a ratio, a camera, got {L_low, L_high, snr, camera}"
        )
    t, S = settings(L_low, L_high, snr, camera)
    L = hardest(L_low, L_high, t, S, camera)
    A = np.minimum(squared_snr(L, t, S, camera) / snr**2, 1)
    with silence(1):  # the solver HiGHS prints notes on its rounding
        result = milp(
            t + camera.pause,
            constraints=LinearConstraint(A, 1),
            integrality=np.ones(t.size),
            bounds=Bounds(0, MAX_PHOTOGRAPHS_PER_SETTING),
            options={"mip_rel_gap": _MAX_EXCESS_TIME_FRACTION, "node_limit": _MAX_SEARCH_NODES},
        )
    if result.x is None:
        most = MAX_PHOTOGRAPHS_PER_SETTING
        raise InputError(
            f"expected a signal-to-noise ratio that {most} photos of each setting reach, got {snr:g}"
        )
    counts = np.rint(result.x).astype(int)
    times = t.repeat(counts)
    speeds = S.repeat(counts)
    dial = exposure.shutter_series()
    return Shots(tuple(_name(time, dial) for time in times), times, speeds)


def _name(time: float, dial: exposure.Dial) -> str:
    """Return the dial's name of a true time, or the seconds themselves beyond its ends."""
    same = np.abs(np.log2(dial.values / time)) < _SAME_TIME_STOPS
    if same.any():
        return dial.names[int(np.argmax(same))]
    return f"{time:g}" if time >= 1 else f"1/{1 / time:g}"
