"""The other operators on luminance, beside pfstools, Luminance HDR, OpenCV's blur and our own Reinhard.

`pfstmo_durand02` of Debian 12 aborts on some machines; where it does not it takes part.
"""

from pathlib import Path
from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter

from benchmarks import data, peers
from benchmarks.rows import OURS, Case, Hold, Results, Row, Run, close, faster
from benchmarks.speed import luminance as lhdr
from benchmarks.speed.tonemapping import pfstools
from hdrlab.core.colour import luminance
from hdrlab.core.filters import poisson
from hdrlab.core.filters.bilateral import bilateral as by_definition
from hdrlab.fast import bilateral, blur, brush, chiu, durand, fattal, reinhard, ward
from hdrlab.tonemap.durand import SIGMA_S_FRACTION, logarithm
from hdrlab.tonemap.fattal import log_luminance

REINHARD = "own Reinhard"
BLUR = 0.02  # of the longer side, a wide Gaussian


def bilateral_case(folder: Path, one_thread: bool) -> Case:
    """Return the work of Durand's operator; its error is that of the base, against the definition."""
    E = data.scene(folder)
    L = luminance(E)
    widths = (
        "--tmoDurSigmaS",
        f"{SIGMA_S_FRACTION * max(L.shape):g}",
        "--tmoDurSigmaR",
        f"{0.4 * np.log(10):g}",
    )
    alike = (*widths, "--tmoDurBase", f"{np.log(50):g}")  # our knobs; theirs are in nats
    theirs, missing = peers.present(
        {
            peers.PFS: lambda: pfstools(E, folder, one_thread, "pfstmo_durand02"),
            lhdr.NAME: lambda: lhdr.operator(E, folder, one_thread, "durand", *alike),
        }
    )

    def error(who: str, _: Any) -> float | None:
        if who != OURS:
            return None
        lL = logarithm(L)[::6, ::6]  # the definition takes minutes on all of it
        sigmas = {"sigma_s": SIGMA_S_FRACTION * max(lL.shape), "sigma_r": 0.4}
        exact = by_definition(lL, **sigmas).mean
        fast = bilateral.bilateral(lL, **sigmas).mean
        return float(np.sqrt(np.mean((fast - exact) ** 2)))

    return Case({OURS: lambda: durand.tonemap(L)} | theirs, missing, error, L.nbytes)


def gradient_case(folder: Path, one_thread: bool) -> Case:
    """Return the work of Fattal's operator; its error is the residual of the Poisson solve."""
    E = data.scene(folder)
    L = luminance(E)
    theirs, missing = peers.present(
        {
            peers.PFS: lambda: pfstools(E, folder, one_thread, "pfstmo_fattal02"),
            lhdr.NAME: lambda: lhdr.operator(E, folder, one_thread, "fattal"),
        }
    )

    def error(who: str, _: Any) -> float | None:
        if who != OURS:
            return None
        f = poisson.laplacian(log_luminance(L))
        return float(np.abs(poisson.laplacian(poisson.solve(f)) - f).max() / np.abs(f).max())

    return Case({OURS: lambda: fattal.tonemap(L)} | theirs, missing, error, L.nbytes)


def histogram_case(folder: Path, one_thread: bool) -> Case:
    """Return the work of Ward's operator beside our own global Reinhard, both on luminance."""
    L = luminance(data.scene(folder))
    return Case(
        {OURS: lambda: ward.tonemap(L), REINHARD: lambda: reinhard.tonemap(L)}, {}, reads=L.nbytes
    )


def blur_case(folder: Path, one_thread: bool) -> Case:
    """Return the work of a wide Gaussian, the cost of Chiu's scale field."""
    L = luminance(data.scene(folder))
    sigma = BLUR * max(L.shape)

    def opencv() -> Run:
        cv2 = peers.opencv(one_thread)
        return lambda: cv2.GaussianBlur(L, (0, 0), sigma)

    theirs, missing = peers.present({peers.OPENCV: opencv})

    def error(who: str, blurred: Any) -> float:
        return float(
            np.abs(blurred / gaussian_filter(L.astype(np.float64), sigma, truncate=6) - 1).max()
        )

    return Case({OURS: lambda: blur.gaussian(L, sigma)} | theirs, missing, error, L.nbytes)


def scale_case(folder: Path, one_thread: bool) -> Case:
    """Return the work of Chiu's whole operator, smoothing passes included, beside our own global Reinhard."""
    L = luminance(data.scene(folder))
    return Case(
        {OURS: lambda: chiu.tonemap(L), REINHARD: lambda: reinhard.tonemap(L)}, {}, reads=L.nbytes
    )


def brush_case(folder: Path, one_thread: bool) -> Case:
    """Return the work of the Detail Brush over a whole picture, beside our own global Reinhard."""
    L = luminance(data.scene(folder))
    return Case(
        {OURS: lambda: brush.tonemap(L), REINHARD: lambda: reinhard.tonemap(L)}, {}, reads=L.nbytes
    )


def than(peer: str, limit: float, goal: float | None = None) -> Hold:
    """Hold at least this ratio to one of the peers."""

    def figure(results: Results) -> float | None:
        return results[peer].seconds / results[OURS].seconds if peer in results else None

    return Hold(f"times as fast as {peer}", figure, limit, goal, least=True)


def slower(results: Results) -> float:
    """Return how many times as long as our own global Reinhard it takes."""
    return results[OURS].seconds / results[REINHARD].seconds


ROWS = (
    Row(
        "durand",
        "Durand's bilateral operator, luminance to luminance",
        bilateral_case,
        (than(lhdr.NAME, 8, 12), close(0.005, "log10 RMS of the base from the definition")),
        "RMS of the base from the definition, log10",
    ),
    Row(
        "fattal",
        "Fattal's gradient operator, luminance to luminance",
        gradient_case,
        (
            than(lhdr.NAME, 4, 8),
            than(peers.PFS, 6, 8),
            close(1e-5, "relative residual of the Poisson equation"),
        ),
        "relative residual of the Poisson equation",
    ),
    Row(
        "ward",
        "Ward's histogram adjustment, luminance to luminance",
        histogram_case,
        (Hold("times our own global Reinhard", slower, 1.3, 1.0),),
    ),
    Row(
        "chiu-blur",
        "a Gaussian of 2 % of the picture, Chiu's scale field",
        blur_case,
        (faster(10, 14), close(0.01, "largest relative difference from the Gaussian to six sigma")),
        "relative difference from the Gaussian",
    ),
    Row(
        "chiu",
        "Chiu's scaling with 16 smoothing passes, luminance to luminance",
        scale_case,
        (Hold("times our own global Reinhard", slower, 16),),
    ),
    Row(
        "brush",
        "the Detail Brush over all of a picture, luminance to luminance",
        brush_case,
        (Hold("times our own global Reinhard", slower, 4),),
    ),
)
