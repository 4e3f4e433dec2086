"""Reinhard's operator: a radiance map to 8 bits, and dodge and burn."""

from pathlib import Path
from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter

from benchmarks import data, peers
from benchmarks.measure import process
from benchmarks.rows import OURS, Case, Row, Run, close, faster
from hdrlab import pipeline
from hdrlab.core.arrays import Array
from hdrlab.core.colour import encode_srgb, luminance, recolour
from hdrlab.core.steps import last
from hdrlab.fast import reinhard as fast
from hdrlab.io.maps import pfm
from hdrlab.tonemap import reinhard


def develop(folder: Path, one_thread: bool) -> Case:
    """Return the work of the global operator, colours and 8 bits included."""
    E = data.scene(folder)
    plain = plain_picture(E)
    theirs, missing = peers.present(
        {peers.OPENCV: lambda: opencv(E, one_thread), peers.COLOUR: lambda: colour_hdri(E)}
    )

    def error(who: str, picture: Any) -> float | None:
        # the others' formulas are not this one
        return float(np.abs(picture - plain).max()) if who == OURS else None

    return Case(
        {OURS: lambda: pipeline.develop(E, "reinhard", way="ratio")} | theirs,
        missing,
        error,
        E.nbytes,
    )


def plain_picture(E: Array) -> Array:
    """Return the global operator written plainly in float64, as codes that are not rounded."""
    L = luminance(E).astype(np.float64)
    Lm = 0.18 * L / np.exp(np.log(L).mean())
    Ld = np.minimum(Lm * (1 + Lm / fast.white_point(Lm.astype(np.float32)) ** 2) / (1 + Lm), 1)
    return 255 * encode_srgb(np.clip(E * (Ld / L)[..., None], 0, 1))


def opencv(E: Array, one_thread: bool) -> Run:
    """Return TonemapReinhard; it changes its own parameters, so each run takes a new one."""
    cv2 = peers.opencv(one_thread)
    bgr = np.ascontiguousarray(E[..., ::-1])
    return lambda: cv2.convertScaleAbs(cv2.createTonemapReinhard(2.2).process(bgr), alpha=255)


def colour_hdri(E: Array) -> Run:
    """Return tonemapping_operator_Reinhard2004 and the simplest way on to 8 bits."""
    operator = peers.colour_hdri().tonemapping_operator_Reinhard2004
    return lambda: (np.clip(operator(E), 0, 1) ** (1 / 2.2) * 255 + 0.5).astype(np.uint8)


def dodge(folder: Path, one_thread: bool) -> Case:
    """Return the work of dodge and burn, radiance to linear display RGB."""
    E = data.scene(folder)
    truth = true_gaussians(luminance(E))
    theirs, missing = peers.present(
        {peers.PFS: lambda: pfstools(E, folder, one_thread, "pfstmo_reinhard02", "-s")}
    )

    def ours() -> Array:
        L = luminance(E)
        return recolour(E, L, fast.tonemap(L, local=True, white=np.inf))

    def error(who: str, result: Any) -> float | None:
        if who != OURS:
            return None
        V1 = fast.local_adaptation(fast.scale_to_key(luminance(E)))
        return float(np.quantile(np.abs(V1 / truth - 1), 0.999))

    return Case({OURS: ours} | theirs, missing, error, E.nbytes)


def true_gaussians(L: Array) -> Array:
    """Return V1 at each pixel's own width, with SciPy's Gaussians in float64 and to six sigma."""
    Lm = fast.scale_to_key(L).astype(np.float64)
    blurred = (gaussian_filter(Lm, s / 4, truncate=6) for s in reinhard.WIDTHS)
    return last(reinhard.scale_steps(blurred)).adaptation


def pfstools(E: Array, folder: Path, one_thread: bool, operator: str, *options: str) -> Run:
    """Return an operator of pfstools, less what it takes to read and write the same frame and do nothing."""
    pfm.write(folder / "scene.pfm", E)
    frame = folder / "scene.pfs"
    process(
        [peers.pfstools("pfsinpfm"), str(folder / "scene.pfm")], one_thread=one_thread, target=frame
    )
    return peers.pfs_run([operator, *options], frame, one_thread)


ROWS = (
    Row(
        "reinhard",
        "Reinhard's global operator, radiance to 8 bits",
        develop,
        (faster(1.8, 3), close(1, "codes from the formula in float64")),
        "largest difference from the formula, codes",
    ),
    Row(
        "reinhard-local",
        "Reinhard's dodge and burn, radiance to display RGB",
        dodge,
        (faster(3, 5), close(0.01, "from true Gaussians, 999 of 1000 pixels")),
        "relative difference from true Gaussians",
    ),
)
