"""Split the photos of a folder into brackets, by what their EXIF states.

A camera in bracketing mode repeats one series of exposures. A photographer who moves on to the next
scene leaves a pause. Each rule is careful, because one bracket in two halves is worse than a note
too few:

- Where the exposures repeat as equal series, each series is a bracket.
- After a pause, a new bracket begins if its exposures repeat those before the pause, or if the
  pause is very long. A pause between photos of different exposures may be one for thought.
"""

from collections import Counter
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from hdrlab.io.decode import PhotoHeader

MIN_PHOTOS = 2
# seconds without an exposure between two brackets
MIN_PAUSE_SECONDS = 60.0
# seconds after which no photo belongs to the same bracket
MIN_LONG_PAUSE_SECONDS = 600.0
# exposures that differ by less are equal, because a camera rounds what it states
EQUAL_STOPS = 0.15

Headers = list[PhotoHeader]


def split_into_brackets(headers: Sequence[PhotoHeader]) -> list[Headers]:
    """Return the brackets among photos, in the order in which they were taken.

    Parameters
    ----------
    headers
        The photos of a folder, in the order of their names. If all state when they were taken,
        that order is used.

    Returns
    -------
    list of lists
        At least one. Photos that state no exposure and no time are one bracket.
    """
    ordered = list(headers)
    times = [header.taken for header in ordered if header.taken is not None]
    if len(times) == len(ordered):
        ordered = [ordered[j] for j in sorted(range(len(times)), key=times.__getitem__)]
    brackets = []
    for group in _split_at_pauses(ordered):
        brackets += _split_into_series(group)
    return brackets


def find_stops(header: PhotoHeader) -> float | None:
    """Return log2 of the exposure t S / N^2 that a photo states, or None without a time.

    An f-number or an ISO speed that is not stated counts as 1.
    """
    exposure = header.exposure
    if exposure.seconds is None:
        return None
    f_number = exposure.f_number or 1.0
    iso = exposure.iso or 1.0
    return float(np.log2(exposure.seconds * iso / f_number**2))


def _split_at_pauses(headers: Headers) -> list[Headers]:
    """Split photos where the photographer made a pause and then began a new bracket."""
    stretches = [headers[:1]]
    for before, after in pairwise(headers):
        if _pause_seconds(before, after) > MIN_PAUSE_SECONDS:
            stretches.append([])
        stretches[-1].append(after)
    groups = [stretches[0]]
    for stretch in stretches[1:]:
        group = groups[-1]
        is_long = _pause_seconds(group[-1], stretch[0]) > MIN_LONG_PAUSE_SECONDS
        if is_long or _repeats_exposures(group, stretch):
            groups.append(stretch)
        else:
            group += stretch
    return groups


def _pause_seconds(before: PhotoHeader, after: PhotoHeader) -> float:
    """Return the seconds between the end of one exposure and the start of the next; 0 if unknown."""
    if before.taken is None or after.taken is None:
        return 0.0
    return (after.taken - before.taken).total_seconds() - (before.exposure.seconds or 0.0)


def _repeats_exposures(group: Headers, stretch: Headers) -> bool:
    """Return whether a photo of `stretch` has the exposure of one of `group`."""
    first = [find_stops(header) for header in group]
    second = [find_stops(header) for header in stretch]
    return any(_are_equal(a, b) for a in first for b in second)


def _are_equal(first: float | None, second: float | None) -> bool:
    return first is not None and second is not None and abs(first - second) < EQUAL_STOPS


def _split_into_series(headers: Headers) -> list[Headers]:
    """Split photos where an exposure repeats, if most of the series are alike."""
    series: list[Headers] = [[]]
    for header in headers:
        if _repeats_exposures(series[-1], [header]):
            series.append([])
        series[-1].append(header)
    shapes = Counter(_describe_series(photos) for photos in series if len(photos) >= MIN_PHOTOS)
    if not shapes:
        return [headers]
    _, count = shapes.most_common(1)[0]
    if count < 2 or 2 * count < len(series):
        return [headers]
    return series


def _describe_series(headers: Headers) -> tuple[int, ...]:
    """Return the exposures of a series in whole units of EQUAL_STOPS, from low to high."""
    known = [stops for stops in map(find_stops, headers) if stops is not None]
    return tuple(sorted(round(stops / EQUAL_STOPS) for stops in known))
