"""Self-calibration: response and ratios from rough times, three channels; pfshdrcalibrate merges as well."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks import data, peers
from benchmarks.measure import process
from benchmarks.rows import OURS, Case, Row, Run, Usage, close, faster
from hdrlab.core.arrays import Array
from hdrlab.core.bracket import Bracket
from hdrlab.response import mitsunaga


def case(folder: Path, one: bool) -> Case:
    """Return the work."""
    bracket = data.photographs(folder)
    saved = folder / "mitsunaga.m"
    theirs, missing = peers.present({peers.PFS: lambda: pfstools(bracket, folder, saved, one)})

    def error(who: str, g: Any) -> float:
        return data.curve_error(pfs_response(saved) if who == peers.PFS else g)

    return Case({OURS: lambda: mitsunaga.recover(bracket.images, bracket.times)} | theirs, missing, error)


def pfstools(bracket: Bracket, folder: Path, saved: Path, one: bool) -> Run:
    """Return pfshdrcalibrate -c mitsunaga, less what it takes to read the same frames and do nothing."""
    calibrate, idle, reader = map(peers.pfstools, ("pfshdrcalibrate", "pfstag", "pfsinhdrgen"))
    frames, listed = folder / "calibration.pfs", folder / "calibration.hdrgen"
    lines = []
    for j, (image, time) in enumerate(zip(bracket.images, bracket.times, strict=True)):
        path = folder / f"calibration-{j}.ppm"
        path.write_bytes(b"P6\n%d %d\n255\n" % image.shape[1::-1] + image.tobytes())
        lines.append(f"{path} {1 / time:.9g} 1 100 0\n")
    listed.write_text("".join(lines), encoding="utf8")
    process([reader, str(listed)], one=one, target=frames)

    def run() -> Usage:
        busy = process([calibrate, "-c", "mitsunaga", "-s", str(saved)], one=one, source=frames)
        return busy.net(process([idle], one=one, source=frames))

    return run


def pfs_response(saved: Path) -> NDArray[np.float64]:
    """Return g (256, 3) from the matrices IR, IG, IB of pfshdrcalibrate: log10, level, exposure."""
    rows = [
        line.split() for line in saved.read_text(encoding="ascii").splitlines() if line and line[0] != "#"
    ]
    table: Array = np.array([row for row in rows if len(row) == 3], float)[: 3 * 256, 2].reshape(3, 256)
    return np.log(np.maximum(table.T, 1e-30))


ROWS = (
    Row(
        "mitsunaga",
        f"self-calibration from {data.FRAMES} photographs, three channels",
        case,
        (faster(100), close(0.5, "% error of the curve", 0.15)),
        "error of the curve, % of its top",
    ),
)
