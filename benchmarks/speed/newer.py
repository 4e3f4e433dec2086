"""What is newer than the slides, beside OpenCV's guided filter, Halide, and colour-science's codes."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import data, peers
from benchmarks.rows import OURS, Case, Hold, Results, Row, Run
from benchmarks.speed.halide_laplacian import Filter
from benchmarks.speed.operators import than
from hdrlab.core.arrays import F32
from hdrlab.core.colour import luminance
from hdrlab.core.filters import guided
from hdrlab.fast import local_laplacian as fast
from hdrlab.tonemap import local_laplacian, transfer
from hdrlab.tonemap.durand import logarithm

COLOUR = "colour-science"
WINDOW = {"radius": 16, "epsilon": 0.04}
KNOBS = {"sigma": 0.92, "alpha": 1.0, "beta": 0.0, "samples": 24}


def agree(limit: float, unit: str) -> Hold:
    """Hold at most this difference between hdrlab's answer and that of any peer."""

    def figure(results: Results) -> float | None:
        return max(
            (result.error for result in results.values() if result.error is not None), default=None
        )

    return Hold(f"{unit} of difference", figure, limit)


def guided_case(folder: Path, one_thread: bool) -> Case:
    """Return the work of the guided filter on log luminance, its own guide; errors are against each other."""
    lL = logarithm(luminance(data.scene(folder)))
    radius = WINDOW["radius"]
    epsilon = WINDOW["epsilon"]

    def ours() -> Any:
        return guided.guided(lL, **WINDOW)  # type: ignore[arg-type]

    def opencv() -> Run:
        cv2 = peers.opencv(one_thread)
        return lambda: cv2.ximgproc.guidedFilter(lL, lL, radius, epsilon)

    def error(who: str, q: Any) -> float | None:
        inside = np.s_[2 * radius : -2 * radius, 2 * radius : -2 * radius]  # borders differ
        return None if who == OURS else float(np.abs(q - ours())[inside].max())

    theirs, missing = peers.present({peers.OPENCV: opencv})
    return Case({OURS: ours} | theirs, missing, error, lL.nbytes)


def laplacian_case(folder: Path, one_thread: bool) -> Case:
    """Return the work of the local Laplacian filter before its answer is fitted to a display."""
    lL = local_laplacian.log_luminance(luminance(data.scene(folder)))

    def ours() -> F32:
        return fast.filtered(lL, **KNOBS)  # type: ignore[arg-type]

    def halide() -> Run:
        answer = Filter(lL.shape, one_thread).filtered(lL, **KNOBS)  # type: ignore[arg-type]
        return lambda: np.asarray(answer.realize([lL.shape[1], lL.shape[0]]))

    def error(who: str, answer: Any) -> float | None:
        return None if who == OURS else float(np.abs(answer - ours()).max())

    theirs, missing = peers.present({peers.HALIDE: halide})
    return Case({OURS: ours} | theirs, missing, error, lL.nbytes)


def codes_case(folder: Path, one_thread: bool) -> Case:
    """Return the work of coding a picture of 2 megapixels by PQ and by HLG."""
    FD = np.clip(100 * data.scene(folder).astype(np.float64), 0, transfer.PEAK_LUMINANCE)
    E = FD / transfer.PEAK_LUMINANCE

    def ours() -> tuple[Any, Any]:
        return transfer.pq(FD), transfer.hlg(E)

    def colour_science() -> Run:
        models = peers.colour_science()
        return lambda: (models.eotf_inverse_ST2084(FD), models.oetf_BT2100_HLG(E))

    def error(who: str, coded: Any) -> float | None:
        return (
            None
            if who == OURS
            else max(float(np.abs(a - b).max()) for a, b in zip(coded, ours(), strict=True))
        )

    theirs, missing = peers.present({COLOUR: colour_science})
    return Case({OURS: ours} | theirs, missing, error, FD.nbytes + E.nbytes)


AWAY = "largest difference from hdrlab"
ROWS = (
    Row(
        "guided",
        "the guided filter of log luminance, windows of 33 x 33",
        guided_case,
        (agree(0.001, "decades"),),
        f"{AWAY}, decades",
    ),
    Row(
        "laplacian",
        "the local Laplacian filter of ln luminance, 24 samples",
        laplacian_case,
        (agree(0.001, "nats"), than(peers.HALIDE, 0.5)),
        f"{AWAY}, nats",
    ),
    Row(
        "codes",
        "PQ and HLG of a picture",
        codes_case,
        (agree(1e-9, "of the signal"),),
        f"{AWAY}, of the signal",
    ),
)
