"""Assembly: the state of a bracket after each stage of the pipeline."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hdrlab.core.bracket import Bracket
from hdrlab.diagnostics import consistency
from hdrlab.errors import CalibrationError
from hdrlab.pipeline.merging import MergeRecord

if TYPE_CHECKING:
    from hdrlab.diagnostics.noise import Noise
    from hdrlab.pipeline.explanation import PixelExplanation

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
    warnings : tuple of str
        Warnings, as sentences; an empty tuple means that no problem was found.
    is_misaligned : bool
        Whether photos are clearly not aligned, so that contradictions between them are no news.
    moving : (h, w) int32 or None
        Numbered regions in which something moved, 0 elsewhere; None if ghosts were not removed.
    glare : (h, w) bool or None
        Where veiling glare was removed; None if it was not.
    s : (h, w) or (h, w, 3) float32 or None
        Standard deviation of E, infinite where unknown; None if it was not computed.
    fallback : str
        Why the map is not worth tone mapping, so that a picture is made by exposure fusion of the
        photos instead; "" if the map is usable.
    record : MergeRecord or None
        How the pixels were merged, which `why` needs; None before the merge, and if the photos were
        released.
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
    warnings: tuple[str, ...] = ()
    is_misaligned: bool = False
    moving: NDArray[np.int32] | None = None
    glare: NDArray[np.bool_] | None = None
    s: NDArray[np.float32] | None = None
    fallback: str = ""
    record: MergeRecord | None = None

    @property
    def spread(self) -> float:
        """How far the photos contradict each other, in stops; NaN before the last stage."""
        if self.medians is None:
            return float("nan")
        return consistency.measure_spread(self.medians)

    @cached_property
    def sensor_noise(self) -> "Noise | None":
        """The noise of the camera, estimated from the photos; None if they do not show it."""
        from hdrlab.pipeline.certainty import estimate_sensor_noise

        if self.record is not None and self.record.sensor_noise is not None:
            return self.record.sensor_noise
        try:
            return estimate_sensor_noise(self)
        except CalibrationError:
            return None

    def why(self, y: int, x: int) -> "PixelExplanation":
        """Explain the value of one pixel: what each photo shows there, and how the merge used it.

        Parameters
        ----------
        y, x : int
            Row and column, as in E[y, x].

        Returns
        -------
        PixelExplanation
            Its `sentence` sums it up; print it for a table.

        Raises
        ------
        InputError
            If the pixel is outside of the map, or if the photos are no longer there.

        Examples
        --------
        >>> from hdrlab import pipeline
        >>> from hdrlab.core.bracket import bracket
        >>> ramp = np.linspace(2, 120, 48 * 64).reshape(48, 64).astype(np.uint8)
        >>> photos = bracket([ramp, 2 * ramp], [1, 2])
        >>> assembly = pipeline.assemble(photos, align="none", response="linear")
        >>> explanation = assembly.why(24, 32)
        >>> [photo.levels for photo in explanation.photos]
        [(62,), (124,)]
        >>> print(explanation.sentence)
        The two photos that measured this pixel give 0.484. The map has 0.484.
        """
        from hdrlab.pipeline.explanation import explain_pixel
        from hdrlab.pipeline.pixel_claims import require_record

        require_record(self)
        return explain_pixel(self, y, x, self.sensor_noise)

    def with_note(self, note: str) -> "Assembly":
        """Return a copy with one more note."""
        return replace(self, notes=(*self.notes, note))

    def with_detail(self, detail: str) -> "Assembly":
        """Return a copy with one more detail."""
        return replace(self, details=(*self.details, detail))

    def with_warning(self, warning: str) -> "Assembly":
        """Return a copy with one more warning."""
        return replace(self, warnings=(*self.warnings, warning))


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
