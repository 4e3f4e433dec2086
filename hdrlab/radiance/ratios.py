"""Exposure ratios of a linear camera (Cerman and Hlavac 2006, sec. 5).

h     histograms        (n,) of a darker frame A and a brighter one B
T     transfer          (n,), the level in B of what has level m in A, and back: see `core.transfer`
k     exposure ratio    t_B / t_A > 1
x, y  equations         y = k x, with weights v: the square roots of the histogram's shares
V     mean square error of the equations in use

A linear camera's level is its exposure, so T is a straight line through 0, and its slope is k. Each
level of A gives an equation k m = T(m), each level of B gives z = k T^-1(z). Ranks alone make T:
the frames need not be aligned, and no time need be known. Rounds throw out equations that miss by
much more than the rest.

Two schemes differ in how they compute ranks. The paper's scheme assigns a cumulative count to the
level itself, though it belongs to the level's upper edge, so that for a true ratio of 4 its pairs
lie on T = 4 m + 1.5. The corrected scheme takes the middle of each step, excludes the noise of the
darkest levels, and keeps more equations, as a limit of 3 V drops good ones.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F64, Array, ArrayLike, Mask, as_stack
from hdrlab.core.steps import last
from hdrlab.core.transfer import brightness_transfer, histograms, literal_transfer
from hdrlab.errors import InputError

# relative to the top level; above it, noise makes clipped pixels look unclipped
SATURATION_LEVEL = 0.98
# of the darker frame, that the brighter frame measures as well
MIN_COMMON_LEVELS = 8


@dataclass(frozen=True)
class Scheme:
    """How ranks become equations.

    Attributes
    ----------
    transfer : function that computes T from two histograms
    min_dark_level, min_bright_level : lowest levels, of 256, of the darker and the brighter frame
    limit : equations with a square error of more than `limit` V are outliers
    """

    transfer: Callable[[ArrayLike, ArrayLike], F64]
    min_dark_level: float
    min_bright_level: float
    limit: float


SCHEMES = {
    "paper": Scheme(literal_transfer, min_dark_level=1, min_bright_level=1, limit=3.0),
    "mid-step": Scheme(brightness_transfer, min_dark_level=16, min_bright_level=64, limit=9.0),
}


class Equations(NamedTuple):
    """y = k x with weights v, each (K,): first those of A's levels, then those of B's."""

    x: F64
    y: F64
    v: F64


class State(NamedTuple):
    """The ratio k after a round, which equations (K,) were in use, and their mean square error V."""

    k: float
    used: Mask
    V: float


def collect_equations(h_A: ArrayLike, h_B: ArrayLike, scheme: str = "mid-step") -> Equations:
    """Return k m = T(m) and z = k T^-1(z), weighted by the square roots of histograms [Cerman06 eq. 4].

    Levels are scaled to 0 ... 255 for every bit depth.
    """
    if scheme not in SCHEMES:
        raise InputError(f"expected one of the schemes {', '.join(SCHEMES)}, got {scheme!r}")
    settings = SCHEMES[scheme]
    h_A = np.asarray(h_A, np.float64)
    h_B = np.asarray(h_B, np.float64)
    n = len(h_A)
    level = np.arange(n) * (255 / (n - 1))
    top = 255 * SATURATION_LEVEL
    T = settings.transfer(h_A, h_B) * (255 / (n - 1))
    T_inv = settings.transfer(h_B, h_A) * (255 / (n - 1))
    # comparisons with NaN, where there is no transfer, are false
    a = (h_A > 0) & (level >= settings.min_dark_level)
    a &= (T >= settings.min_bright_level) & (T < top)
    b = (h_B > 0) & (level >= settings.min_bright_level) & (level < top)
    b &= T_inv >= settings.min_dark_level
    x = np.concatenate([level[a], T_inv[b]])
    y = np.concatenate([T[a], level[b]])
    v = np.sqrt(np.concatenate([h_A[a] / h_A.sum(), h_B[b] / h_B.sum()]))
    return Equations(x, y, v)


def solve_ratio(equations: Equations, used: Mask) -> float:
    """Return k of least squares, sum v^2 x y / sum v^2 x^2, from the equations in use."""
    x, y, v = equations
    x = x[used]
    y = y[used]
    v = v[used]
    return float(np.sum(v**2 * x * y) / np.sum(v**2 * x**2))


def square_errors(equations: Equations, k: float) -> F64:
    """Return (v (y - k x))^2 of all equations."""
    x, y, v = equations
    return (v * (y - k * x)) ** 2


def ratio_steps(
    found: Equations, *, limit: float = 9.0, tolerance: float = 1e-6, rounds: int = 100
) -> Iterator[State]:
    """Yield the State of the solution of all equations, and after each round without outliers."""
    used = np.ones(len(found[0]), bool)
    k = solve_ratio(found, used)
    yield State(k, used, float(np.mean(square_errors(found, k))))
    for _ in range(rounds):
        errors = square_errors(found, k)
        used = errors <= limit * np.mean(errors[used])
        k_before = k
        k = solve_ratio(found, used)
        yield State(k, used, float(np.mean(square_errors(found, k)[used])))
        if abs(k - k_before) < tolerance:
            return


def estimate_ratio(A: ArrayLike, B: ArrayLike, *, scheme: str = "mid-step") -> float:
    """Return the exposure of frame B over that of frame A; the parameters are those of `estimate_ratios`."""
    return float(estimate_ratios(as_stack([A, B]), scheme=scheme)[0])


def estimate_ratios(
    images: ArrayLike, *, scheme: str = "mid-step", valid: ArrayLike | None = None
) -> F64:
    """Return the exposure ratios of a linear camera's photographs from their histograms.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs of the same light, not necessarily aligned, each pixel proportional to exposure.
    scheme : {"mid-step", "paper"}
        The corrected scheme, or Cerman and Hlavac's.
    valid : (P, H, W) bool, optional
        False where a photograph shows nothing of the scene.

    Returns
    -------
    (P - 1,) float64
        Exposure of each frame over that of the frame before: below 1 if it is darker.

    Raises
    ------
    ValueError
        For frames that do not overlap in brightness, and for arrays that are no stack of
        photographs.

    References
    ----------
    Cerman and Hlavac, Exposure time estimation for high dynamic range imaging with hand held
    camera, 2006.

    Examples
    --------
    >>> light = np.random.default_rng(0).uniform(0, 250, (200, 200))
    >>> images = np.round(light * np.array([0.25, 1])[:, None, None]).astype(np.uint8)
    >>> images[1] = images[1, ::-1]  # upside down
    >>> bool(abs(estimate_ratios(images) - 4).max() < 0.01)
    True
    """
    stack = as_stack(images)
    if len(stack) < 2:
        raise InputError(f"expected at least two photographs, got {len(stack)}")
    h = histograms(stack, valid).swapaxes(0, 1)
    return np.array([_estimate_pair(a, b, scheme) for a, b in pairwise(h)])


def _estimate_pair(h_A: Array, h_B: Array, scheme: str) -> float:
    """Return k of two frames from the histograms (C, n) of their channels, which share one k."""
    if _sum_levels(h_A) > _sum_levels(h_B):
        return 1 / _estimate_pair(h_B, h_A, scheme)
    parts = [collect_equations(a, b, scheme) for a, b in zip(h_A, h_B, strict=True)]
    equations = Equations(
        x=np.concatenate([part.x for part in parts]),
        y=np.concatenate([part.y for part in parts]),
        v=np.concatenate([part.v for part in parts]),
    )
    common_levels = len(np.unique(np.round(equations.x)))
    if common_levels < MIN_COMMON_LEVELS:
        raise InputError(
            f"expected frames that overlap in brightness by {MIN_COMMON_LEVELS} levels, "
            f"got {common_levels}"
        )
    return last(ratio_steps(equations, limit=SCHEMES[scheme].limit)).k


def _sum_levels(h: Array) -> float:
    """Return the sum of all pixel levels, from the histograms (C, n) of the channels."""
    return float(np.sum(h, axis=0) @ np.arange(h.shape[1]))
