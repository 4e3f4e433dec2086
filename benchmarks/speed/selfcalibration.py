"""Self-calibration: response and ratios from rough times, three channels; pfshdrcalibrate merges as well.

It has one order and no search for another. So ours is told the order in one row, and chooses it in
the other.
"""

from pathlib import Path
from typing import Any

from benchmarks import data, peers
from benchmarks.rows import OURS, Case, Row, Run, close, faster
from hdrlab.core.bracket import Bracket
from hdrlab.io.response_files import read_curve
from hdrlab.response import self_calibration


def with_known_order(folder: Path, one_thread: bool) -> Case:
    """Return the work with an order given, as the peer has it."""
    return case(folder, one_thread, order=6)


def chosen(folder: Path, one_thread: bool) -> Case:
    """Return the work with the choice of the order in it."""
    return case(folder, one_thread, order=None)


def case(folder: Path, one_thread: bool, order: int | None) -> Case:
    """Return the work."""
    bracket = data.photographs(folder)
    saved = folder / "mitsunaga.m"
    theirs, missing = peers.present(
        {peers.PFS: lambda: pfstools(bracket, folder, saved, one_thread)}
    )

    def error(who: str, g: Any) -> float:
        return data.curve_error(read_curve(saved) if who == peers.PFS else g)

    return Case(
        {OURS: lambda: self_calibration.find_response(bracket.images, bracket.times, order=order)}
        | theirs,
        missing,
        error,
        bracket.images.nbytes,
    )


def pfstools(bracket: Bracket, folder: Path, saved: Path, one_thread: bool) -> Run:
    """Return pfshdrcalibrate -c mitsunaga, less what it takes to read the same frames and do nothing."""
    frames = peers.pfs_bracket(bracket, folder)
    return peers.pfs_run(
        ["pfshdrcalibrate", "-c", "mitsunaga", "-s", str(saved)], frames, one_thread
    )


WORK = f"self-calibration from {data.FRAMES} photographs, three channels"
ERROR = "error of the curve, % of its top"
ROWS = (
    Row(
        "mitsunaga",
        f"{WORK}, order 6",
        with_known_order,
        (faster(100), close(0.5, "% error of the curve", 0.15)),
        ERROR,
    ),
    Row(
        "mitsunaga-order",
        f"{WORK}, order chosen",
        chosen,
        (faster(30), close(0.5, "% error of the curve")),
        ERROR,
    ),
)
