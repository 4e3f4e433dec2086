"""Assembly: the state of a bracket after each stage of the pipeline."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hdrlab.core.bracket import Bracket
from hdrlab.diagnostics import consistency

# The name of a method, or a function with the same signature.
Method = str | Callable[..., Any]


@dataclass(frozen=True, kw_only=True, eq=False)
class Assembly:
    """What is known of a bracket after a stage. A field that is not known yet is None.

    Attributes
    ----------
    stage : str
        The last stage that is done: one of STAGES, or "ghosts" or "flare" after "merge" where
        these are removed.
    bracket : Bracket
        The aligned photos, cropped to the area that all of them show.
    offsets : (P, 2) int
        (dy, dx) in pixels by which each photo, or its center, was shifted.
    homographies : (P, 3, 3)
        The same as homographies, with rotation, scale and fractions of a pixel.
    g : (n,) or (n, 3)
        Response: ln exposure of each pixel value.
    E : (h, w) or (h, w, 3) float32
        Radiance map.
    quality : (h, w) uint8
        How each pixel was measured: flags of `radiance.merge.Quality`.
    medians : (P, C, 256)
        log2 exposure of each pixel value in each photo, see `diagnostics.consistency`.
    notes : tuple of str
        What users must know about the map although nothing is wrong, as sentences.
    details : tuple of str
        How hdrlab made the map, as sentences. `assemble --verbose` and the report show them.
    doubts : tuple of str
        Warnings, as sentences; an empty tuple means that no problem was found.
    moving : (h, w) int32 or None
        Numbered regions in which something moved, 0 elsewhere; None if ghosts were not removed.
    glare : (h, w) bool or None
        Where veiling glare was removed; None if it was not.
    s : (h, w) or (h, w, 3) float32 or None
        Standard deviation of E, infinite where unknown; None if it was not computed.
    fallback : str
        Why the map is not worth tone mapping, so that a picture is made by exposure fusion of the
        photos instead; "" if the map is usable.
    """

    stage: str
    bracket: Bracket
    offsets: NDArray[np.int64]
    # The following fields are None until their stage is done, and arrays from then on.
    homographies: NDArray[np.float64] = None  # type: ignore[assignment]
    g: NDArray[np.float64] = None  # type: ignore[assignment]
    E: NDArray[np.float32] = None  # type: ignore[assignment]
    quality: NDArray[np.uint8] = None  # type: ignore[assignment]
    medians: NDArray[np.float64] = None  # type: ignore[assignment]
    notes: tuple[str, ...] = ()
    details: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()
    moving: NDArray[np.int32] | None = None
    glare: NDArray[np.bool_] | None = None
    s: NDArray[np.float32] | None = None
    fallback: str = ""

    @property
    def spread(self) -> float:
        """How far the photos contradict each other, in stops; NaN before the last stage."""
        if self.medians is None:
            return float("nan")
        return consistency.measure_spread(self.medians)

    def with_note(self, note: str) -> "Assembly":
        """Return a copy with one more note."""
        return replace(self, notes=(*self.notes, note))

    def with_detail(self, detail: str) -> "Assembly":
        """Return a copy with one more detail."""
        return replace(self, details=(*self.details, detail))

    def with_doubt(self, doubt: str) -> "Assembly":
        """Return a copy with one more warning."""
        return replace(self, doubts=(*self.doubts, doubt))


def select_photos(state: Assembly, order: NDArray[np.intp]) -> Assembly:
    """Return the Assembly of some of its photos, in this order."""
    if np.array_equal(order, np.arange(len(state.offsets))):
        return state
    bracket = state.bracket
    selected = replace(
        bracket,
        images=bracket.images[order],
        times=bracket.times[order],
        names=tuple(bracket.names[j] for j in order),
        valid=None if bracket.valid is None else bracket.valid[order],
    )
    return replace(
        state,
        bracket=selected,
        offsets=state.offsets[order],
        homographies=state.homographies[order],
    )
