"""A bracket: one scene, photographed several times with different exposures."""

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any
from zlib import crc32

import numpy as np

from hdrlab.core.arrays import F64, Array, ArrayLike, Indices, Mask, as_mask, as_stack, as_times
from hdrlab.errors import InputError


@dataclass(frozen=True, kw_only=True, eq=False)
class Bracket:
    """Photographs of one scene, sorted from the shortest exposure to the longest.

    Make one with `bracket`, which checks and sorts; change one with `dataclasses.replace`.

    Attributes
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
    times : (P,) float64, seconds of equivalent exposure: shutter time x ISO / f-number squared,
        relative to the first photograph's ISO and f-number
    names : P strings, where each photograph came from
    valid : (P, H, W) bool, or None where every pixel is a photograph's; False at pixels that are
        not (the border of a registered scan)
    linear : True where the values are proportional to exposure (RAW), so that there is no response
        to recover
    luminance_of_unit : cd/m^2 of a surface with E = 1 in the radiance map, by the formula of
        exposure meters; None where the photographs do not state time, ISO and f-number
    max_luminance_of_unit : an upper bound of it where the photographs state a time, but no f-number
        or no ISO; else None
    damaged : sentences that name the photographs that were left out because they are damaged
    has_relative_times : True where only the ratios of the times are known, not their seconds
    """

    images: Array
    times: F64
    names: tuple[str, ...]
    valid: Mask | None = None
    linear: bool = False
    luminance_of_unit: float | None = None
    max_luminance_of_unit: float | None = None
    damaged: tuple[str, ...] = ()
    has_relative_times: bool = False

    # A Bracket was a named tuple of these five fields up to version 0.2: old code may still use it
    # as one, with a warning. New fields do not become part of the tuple.

    def __iter__(self) -> Iterator[Any]:
        """Unpack the five fields of version 0.2. Deprecated: use the attributes."""
        return iter(self._as_tuple("unpacking a Bracket is deprecated; use its attributes"))

    def __getitem__(self, index: int | slice) -> Any:
        """Return the fields of version 0.2 by their place. Deprecated: use the attributes."""
        return self._as_tuple("indexing a Bracket is deprecated; use its attributes")[index]

    def _replace(self, **changes: Any) -> "Bracket":
        """Return a copy with some fields changed. Deprecated: use `dataclasses.replace`."""
        message = "Bracket._replace is deprecated; use dataclasses.replace(bracket, ...)"
        warnings.warn(message, DeprecationWarning, stacklevel=2)
        return replace(self, **changes)

    def _as_tuple(self, message: str) -> tuple[Any, ...]:
        """Return the fields of version 0.2 as a tuple, with a warning where the caller stands."""
        warnings.warn(message, DeprecationWarning, stacklevel=3)
        return self.images, self.times, self.names, self.valid, self.linear


def bracket(
    images: ArrayLike,
    times: ArrayLike,
    names: Sequence[str] | None = None,
    *,
    valid: ArrayLike | None = None,
    linear: bool = False,
    luminance_of_unit: float | None = None,
    max_luminance_of_unit: float | None = None,
    damaged: Sequence[str] = (),
) -> Bracket:
    """Return the Bracket of `images` and `times`, checked and sorted from short to long.

    Photographs take much memory, so they are not copied if they are sorted already. Then the images
    and the masks of the Bracket are your arrays, and a change of yours changes the Bracket. Pass
    copies if you change them afterwards. Times and names are always copied.

    Raises
    ------
    ValueError
        For images, times, names or masks that do not fit together; it says what was expected and
        what came.

    Examples
    --------
    >>> dark, light = np.full((2, 3), 10, np.uint8), np.full((2, 3), 80, np.uint8)
    >>> bracket([light, dark], [1 / 15, 1 / 120]).times.round(4).tolist()
    [0.0083, 0.0667]
    """
    images = as_stack(images)
    times = np.array(as_times(times, len(images)))
    if names is None:
        names = [f"frame {j + 1}" for j in range(len(images))]
    names = tuple(names)
    if len(names) != len(images):
        raise InputError(f"expected {len(images)} names, one per image, got {len(names)}")
    mask = as_mask(valid, images)
    order = short_to_long(images, times)
    if np.any(order != np.arange(len(order))):
        images = images[order]
        times = times[order]
        names = tuple(names[j] for j in order)
        if mask is not None:
            mask = mask[order]
    return Bracket(
        images=images,
        times=times,
        names=names,
        valid=mask,
        linear=linear,
        luminance_of_unit=luminance_of_unit,
        max_luminance_of_unit=max_luminance_of_unit,
        damaged=tuple(damaged),
    )


def short_to_long(images: Array, times: F64) -> Indices:
    """Return the order (P,) of frames by exposure time, whatever the order in which they came.

    Frames of equal times are ordered by their checksums, because even the last bit of a sum depends
    on the order of its terms.
    """
    if len(np.unique(times)) == len(times):
        return np.argsort(times)
    checksums = np.array([crc32(image.tobytes()) for image in images])
    return np.lexsort((checksums, times))
