"""Checks of a finished radiance map: the warnings and notes of the last stage."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from hdrlab.core.arrays import F64
from hdrlab.core.bracket import Bracket
from hdrlab.core.threads import Task, run_in_background
from hdrlab.diagnostics import causes, consistency, contradictions, tones
from hdrlab.diagnostics.contradictions import Contradictions, TimesSource
from hdrlab.diagnostics.tones import PartError
from hdrlab.diagnostics.warning_texts import warning_text
from hdrlab.pipeline.assembly import Assembly
from hdrlab.pipeline.options import Options

# stops of spread of a map that shows what no photo shows
MIN_WORTHLESS_STOPS = 0.5
# photos that a note names
MAX_NAMED_PHOTOS = 10


def start_finding_contradictions(bracket: Bracket) -> Task[Contradictions]:
    """Start looking for contradictions in a bracket, in the background; no response is needed."""
    find = partial(
        contradictions.find_contradictions, bracket.images, bracket.times, valid=bracket.valid
    )
    return run_in_background(find, pixels=bracket.images[0].size)


def is_worthless(medians: F64) -> bool:
    """Return whether the photos contradict each other so much that the map is of no use."""
    spread = consistency.measure_spread(medians)
    return not spread <= MIN_WORTHLESS_STOPS


def check_map(
    state: Assembly,
    medians: F64,
    found: Contradictions,
    moving_fraction: float,
    band_stops: float,
    part_errors: Sequence[PartError] = (),
    *,
    options: Options,
    unresolved_fraction: float = 0.0,
) -> Assembly:
    """Return the Assembly with `medians`, and with warnings and notes from what the checks found.

    Parameters
    ----------
    state : Assembly
        It has a radiance map.
    medians : (P, C, 256)
        See `diagnostics.consistency.measure_level_exposures`.
    found : Contradictions
        See `diagnostics.contradictions.find_contradictions`.
    moving_fraction : float
        Fraction of the image in which ghosts are left.
    band_stops : float
        Stops by which the light changes in horizontal bands.
    part_errors : sequence of PartError
        Errors in parts of the image, see `diagnostics.tones.measure_part_errors`.
    options : Options
        How the map was made. No warning recommends an option that was used.
    unresolved_fraction : float
        Fraction of the image that seemed to move, but in which no region has ghosts.
    """
    state = replace(state, stage="compare", medians=medians)
    spread = state.spread
    if np.isnan(spread):
        text = warning_text("alone")
        return replace(state.with_warning(text), fallback=text)
    if is_worthless(medians) and not state.fallback:
        reason = f"the photos contradict each other by {spread:.2f} stops"
        state = replace(state, fallback=reason)
    dark_text = "" if state.fallback else tones.warn_of_dark_parts(part_errors, merge=options.merge)
    if dark_text:
        state = state.with_warning(dark_text)
    text = _describe_problem(
        state, found, moving_fraction, band_stops, options, unresolved_fraction=unresolved_fraction
    )
    if text:
        return state.with_warning(text)
    names = state.bracket.names
    if not state.fallback and not dark_text:
        alternatives = _find_alternatives(state, options)
        text = tones.warn_of_parts(part_errors, names, alternatives=alternatives)
        if text:
            return state.with_warning(text)
    unchecked = [name for name, stops in zip(names, found.stops, strict=True) if np.isnan(stops)]
    if unchecked:
        return state.with_detail(
            f"the pixels could not confirm the exposure times of {_list_names(unchecked)}"
        )
    return state


def _find_alternatives(state: Assembly, options: Options) -> list[str]:
    """Return the options that would make a map to compare with this one."""
    alternatives = []
    if options.merge not in tones.MERGES_BY_TIME:
        alternatives.append("--merge shot")
    if state.moving is not None:
        alternatives.append("--ghosts none")
    return alternatives


def _list_names(names: Sequence[str]) -> str:
    """Return the names of photos, or of many the first ones and the number of the others."""
    if len(names) <= MAX_NAMED_PHOTOS:
        return ", ".join(names)
    listed = ", ".join(names[:MAX_NAMED_PHOTOS])
    return f"{listed} and {len(names) - MAX_NAMED_PHOTOS} more"


def _describe_problem(
    state: Assembly,
    found: Contradictions,
    moving_fraction: float,
    band_stops: float,
    options: Options,
    *,
    unresolved_fraction: float,
) -> str:
    """Return the warning about the most likely cause of contradictions, or ""."""
    times: TimesSource = "kept" if options.times == "stated" else "corrected"
    if state.bracket.has_relative_times:
        times = "relative"
    return causes.warn_of_contradictions(
        found,
        state.bracket.names,
        state.spread,
        band_stops=band_stops,
        moving_fraction=moving_fraction,
        unresolved_fraction=unresolved_fraction,
        times=times,
        deviations=consistency.measure_deviations(state.medians).tolist(),
    )
