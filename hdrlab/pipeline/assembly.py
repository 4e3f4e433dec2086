"""What is known of a bracket, stage after stage."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hdrlab.core.bracket import Bracket
from hdrlab.diagnostics import consistency

Method = str | Callable[..., Any]
Table = NDArray[np.float64]


class Assembly(NamedTuple):
    """What is known of a bracket after a stage; what is not known yet is None.

    Attributes
    ----------
    stage : the one of STAGES that was done last; "ghosts" or "flare" after "merge" where these are
        removed
    bracket : the photographs, moved and cut to what all of them show
    offsets : (P, 2) int, (dy, dx) pixels, where each photograph, or its middle, was moved
    g : (n,) or (n, 3), response, ln exposure of each level
    E : (h, w) or (h, w, 3) float32, radiance
    quality : (h, w) uint8, how each pixel is known: flags of `radiance.merge.Quality`
    medians : (P, C, 256), log2 exposure of each level by each frame: see `diagnostics.consistency`
    notes : sentences, what to know about this map
    doubts : sentences, reasons not to trust it
    homographies : (P, 3, 3), where each photograph was moved, rotation, scale and fractions
        included
    moving : (h, w) int32, the regions in which something moved, 0 elsewhere; None where nobody
        asked
    glare : (h, w) bool, where veiling glare was removed; None where nobody asked
    s : (h, w) or (h, w, 3) float32, standard deviation of E, infinite where unknown; None where
        nobody asked
    fallback : why the map is not worth a picture, and the photographs are fused instead; "" where
        it is
    """

    stage: str
    bracket: Bracket
    offsets: NDArray[np.int64]
    g: NDArray[np.float64] = None  # type: ignore[assignment]  # typed as what each stage makes of it
    E: NDArray[np.float32] = None  # type: ignore[assignment]
    quality: NDArray[np.uint8] = None  # type: ignore[assignment]
    medians: NDArray[np.float64] = None  # type: ignore[assignment]
    notes: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()
    homographies: NDArray[np.float64] = None  # type: ignore[assignment]
    moving: NDArray[np.int32] | None = None
    glare: NDArray[np.bool_] | None = None
    s: NDArray[np.float32] | None = None
    fallback: str = ""

    @property
    def spread(self) -> float:
        """How far the frames contradict each other, in stops; NaN before the last stage."""
        return (
            consistency.measure_spread(self.medians) if self.medians is not None else float("nan")
        )


def take_frames(state: Assembly, order: NDArray[np.intp]) -> Assembly:
    """Return the Assembly of some frames, in this order."""
    if np.array_equal(order, np.arange(len(state.offsets))):
        return state
    images, times, names, valid, linear = state.bracket
    valid = None if valid is None else valid[order]
    some = Bracket(images[order], times[order], tuple(names[j] for j in order), valid, linear)
    return state._replace(
        bracket=some, offsets=state.offsets[order], homographies=state.homographies[order]
    )
