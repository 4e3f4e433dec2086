"""The response by least squares: N pixels of a grid, three channels, lambda = 30, the hat weight."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import data, peers
from benchmarks.rows import OURS, Case, Row, Run, close, faster
from hdrlab.core import weights
from hdrlab.core.arrays import Array
from hdrlab.core.bracket import Bracket
from hdrlab.core.sampling import by_grid
from hdrlab.fast import debevec
from hdrlab.response.debevec import system

SMOOTHNESS = 30.0
HOLDS = {70: (10, 20), 256: (20, 50), 1000: (100, 200)}


def case(N: int, folder: Path, one_thread: bool) -> Case:
    """Return the work at N samples; the dense solution as well where N is large enough to need another."""
    bracket = data.photographs(folder)
    B = np.log(bracket.times)
    w = weights.hat()

    def each_channel(solve: Callable[[Array], Array]) -> Array:
        Z = by_grid(bracket.images, N)
        return np.stack([solve(Z[..., c]) for c in range(3)], axis=-1)

    def ours() -> Array:
        return each_channel(lambda Z: debevec.gsolve(Z, B, SMOOTHNESS, w).g)

    makers: dict[str, Callable[[], Run]] = {peers.OPENCV: lambda: opencv(bracket, N, one_thread)}
    if N == max(HOLDS):
        samples = np.moveaxis(by_grid(bracket.images, N), -1, 0)
        systems = [system(Z, B, SMOOTHNESS, w) for Z in samples]
        makers["dense lstsq"] = lambda: lambda: dense(systems)
    else:
        makers[peers.COLOUR] = lambda: colour_hdri(each_channel, B)
    theirs, missing = peers.present(makers)
    return Case({OURS: ours} | theirs, missing, error, 3 * N * data.FRAMES)


def error(who: str, g: Any) -> float:
    """Return how far the curve is from the camera's own."""
    return data.curve_error(np.log(np.maximum(g, 1e-30)) if who == peers.OPENCV else g)


def opencv(bracket: Bracket, N: int, one_thread: bool) -> Run:
    """Return CalibrateDebevec, which chooses a grid of pixels by itself."""
    cv2 = peers.opencv(one_thread)
    frames = list(bracket.images)
    times = bracket.times.astype(np.float32)
    return lambda: cv2.createCalibrateDebevec(N, SMOOTHNESS).process(frames, times)


def colour_hdri(each_channel: Callable[..., Array], B: Array) -> Run:
    """Return g_solve on the same samples."""
    g_solve = peers.colour_hdri().g_solve
    return lambda: each_channel(lambda Z: g_solve(Z, B, SMOOTHNESS)[0])


def dense(systems: list[tuple[Array, Array]]) -> Array:
    """Return g of each channel by NumPy's least squares, given the matrices, whose filling is not counted."""
    return np.stack([np.linalg.lstsq(A, b, rcond=None)[0][:256] for A, b in systems], axis=-1)


ROWS = tuple(
    Row(
        f"gsolve{N}",
        f"response from {N} pixels in {data.FRAMES} photographs, three channels",
        partial(case, N),
        (faster(*HOLDS[N]),) + ((close(1, "% error of the curve"),) if N >= 256 else ()),
        "error of the curve, % of its top",
    )
    for N in HOLDS
)
