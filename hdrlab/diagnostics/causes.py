"""Why do the photos contradict each other? Name the cause, or all causes that are about as likely.

tints, corners, regions, stops, cost   see `contradictions`
spread                                 stops, see `consistency`
fraction, bands                        see `motion`

Each cause has a statistic and a limit. The causes are tried in a fixed order, because one of them
also looks like others: light that changed in parts of the image looks like motion, for example.

Another processor or another number of threads rounds differently, and the statistics differ a
little. A verdict must not become its opposite then. So hdrlab decides for all statistics that are
up to MARGIN larger or smaller, too; two of them have a wider margin. If the decision is always the
same, that is the verdict. If not, the warning names each cause that occurs, and says that the
pixels do not show which. Two verdicts of nearly the same statistics therefore have a cause in common,
or one of them names none.
`python -m benchmarks verdicts --rows verdicts-borders` lists the borders, and tries them.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from itertools import product
from typing import Literal

import numpy as np

from hdrlab.core.arrays import F64
from hdrlab.diagnostics.contradictions import (
    MAX_NAMED_PHOTOS,
    MIN_COST_STOPS,
    MIN_LOCAL_STOPS,
    MIN_SIGNIFICANCE,
    MIN_SLIGHT_STOPS,
    MIN_WRONG_STOPS,
    Contradictions,
    TimesSource,
)
from hdrlab.diagnostics.motion import MAX_FLICKER_FRACTION, MIN_BAND_STOPS, MIN_MOVING_FRACTION
from hdrlab.diagnostics.warning_texts import MARGIN, warning_text

# stops of spread; brackets with true times stay below 0.2, those of scanned film included
MAX_EXPLAINED_SPREAD = 0.25
# stops of the map's spread; below, the map explains its photos, and slight differences do not
# matter
MAX_SOUND_SPREAD = 0.1
# stops of the map's spread; below, no time can be wrong that matters
MAX_EXACT_SPREAD = 0.015
# stops of spread where no map was made: enough for every cause but "unexplained"
UNKNOWN_SPREAD = 0.2
# stops by which a photo must deviate to be named in a warning
MIN_NAMED_DEVIATION = 0.1
# Flicker and another cause are equally good explanations if the other one's evidence is between its
# limit divided and multiplied by this factor.
UNDECIDED_FACTOR = 2.0

# The significance depends on the spread within small parts of the image, and changes more than other
# statistics do: by a factor of up to 1.3 if the light changes by a millionth.
SIGNIFICANCE_MARGIN = 1.5
# So does the change of the corners where it counts in part: by a factor of up to 2.7.
CORNERS_MARGIN = 3.0

# Light that changed in parts of the image also shows up as a wrong time, but wrong times hardly as
# light that changed: simulated ones come to 0.02 of their error, and the light to 0.4 and more.
MIN_LOCAL_OVER_TIMES = 0.5

Cause = Literal["white_balance", "corners", "flicker", "local", "times", "moved", "unexplained"]
# the order in which a warning names them
CAUSES: tuple[Cause, ...] = (
    "white_balance",
    "corners",
    "flicker",
    "local",
    "times",
    "moved",
    "unexplained",
)


@dataclass(frozen=True, kw_only=True)
class Evidence:
    """The statistics that decide on a cause. A statistic that is not known is 0.

    Attributes
    ----------
    tint : float
        Largest of `contradictions.Contradictions.tints`, stops.
    corners : float
        Median change from the center to the corners, stops.
    regions, significance : float
        Median disagreement of parts of the image, in stops and in standard errors.
    time_error : float
        Size of the largest error of a time, stops.
    cost : float
        What the errors of times change in the map, stops.
    spread : float
        Spread of the map, stops.
    fraction : float
        Fraction of the image that moved.
    bands : float
        Stops by which the light changes in bands.
    unresolved_fraction : float
        Fraction of the image that seemed to move, but in which no region has ghosts.
    """

    tint: float = 0.0
    corners: float = 0.0
    regions: float = 0.0
    significance: float = 0.0
    time_error: float = 0.0
    cost: float = np.inf
    spread: float = 0.0
    fraction: float = 0.0
    bands: float = 0.0
    unresolved_fraction: float = 0.0


# `decide` does not use `unresolved_fraction`.
DECISIVE_STATISTICS = tuple(
    field.name for field in fields(Evidence) if field.name != "unresolved_fraction"
)


def collect_evidence(
    found: Contradictions,
    spread: float = UNKNOWN_SPREAD,
    *,
    fraction: float = 0.0,
    bands: float = 0.0,
    unresolved_fraction: float = 0.0,
) -> Evidence:
    """Return the Evidence of a bracket and its map."""
    return Evidence(
        tint=float(found.tints.max()),
        corners=_median_of_known(found.corners),
        regions=_median_of_known(found.regions),
        significance=_median_of_known(found.significance),
        time_error=float(np.abs(found.stops[np.isfinite(found.stops)]).max(initial=0.0)),
        cost=found.cost,
        spread=spread,
        fraction=fraction,
        bands=bands,
        unresolved_fraction=unresolved_fraction,
    )


def _median_of_known(values: F64) -> float:
    """Return the median of the values that are not NaN, or 0."""
    known = values[np.isfinite(values)]
    return float(np.median(known)) if len(known) else 0.0


def decide(evidence: Evidence) -> frozenset[Cause]:
    """Return the causes for exactly these statistics; empty if nothing is wrong.

    They are two where flicker and another cause explain the photos about equally well.
    """
    has_bands = evidence.bands > MIN_BAND_STOPS
    has_wrong_time = evidence.time_error > MIN_WRONG_STOPS and evidence.cost > MIN_COST_STOPS
    if evidence.tint > MIN_WRONG_STOPS:
        return frozenset({"white_balance"})
    if evidence.corners > MIN_SLIGHT_STOPS:
        return frozenset({"corners"})
    # Wrong times also look a little like local changes, because they hit dark and bright parts
    # unequally.
    time_error = evidence.time_error if has_wrong_time else 0.0
    if evidence.regions >= MIN_LOCAL_OVER_TIMES * time_error:
        local = _decide_on_local_changes(evidence, has_bands)
        if local:
            return local
    if has_wrong_time and evidence.spread >= MAX_EXACT_SPREAD:
        if has_bands and evidence.time_error < UNDECIDED_FACTOR * MIN_WRONG_STOPS:
            return frozenset({"flicker", "times"})
        return frozenset({"times"})
    is_explained_by_flicker = has_bands and evidence.fraction < MAX_FLICKER_FRACTION
    if evidence.fraction > MIN_MOVING_FRACTION and not is_explained_by_flicker:
        return frozenset({"moved"})
    if has_bands:
        return frozenset({"flicker"})
    if evidence.spread > MAX_EXPLAINED_SPREAD:
        return frozenset({"unexplained"})
    return frozenset()


def _decide_on_local_changes(evidence: Evidence, has_bands: bool) -> frozenset[Cause]:
    """Return "local", with or without "flicker", if the light changed in parts of the image."""
    is_large = evidence.regions > MIN_LOCAL_STOPS
    is_significant = (
        evidence.regions > MIN_SLIGHT_STOPS and evidence.significance > MIN_SIGNIFICANCE
    )
    if not (is_large or is_significant):
        return frozenset()
    if has_bands:
        if evidence.regions < MIN_LOCAL_STOPS / UNDECIDED_FACTOR:
            return frozenset()
        if evidence.regions < MIN_LOCAL_STOPS * UNDECIDED_FACTOR:
            return frozenset({"flicker", "local"})
    if is_large or evidence.spread > MAX_SOUND_SPREAD:
        return frozenset({"local"})
    return frozenset()


def find_causes(evidence: Evidence) -> tuple[Cause, ...]:
    """Return each cause that explains statistics within MARGIN of these; empty if nothing is wrong.

    Examples
    --------
    >>> find_causes(Evidence(regions=0.2, time_error=1.0, spread=0.3))
    ('times',)
    >>> find_causes(Evidence(regions=0.5, time_error=1.0, spread=0.3))
    ('local', 'times')
    >>> find_causes(Evidence(spread=0.1))
    ()
    """
    causes = _find_within_margin(evidence)
    # If something may have moved, the same photos with slightly other numbers may be blamed on motion
    # alone: hdrlab removes ghosts then, and ignores bands.
    motion = _find_within_margin(Evidence(fraction=evidence.fraction, bands=evidence.bands))
    may_have_moved = evidence.unresolved_fraction > 0 or "moved" in motion
    if "flicker" in causes and may_have_moved:
        causes.add("moved")
    return tuple(cause for cause in CAUSES if cause in causes)


def _find_within_margin(evidence: Evidence) -> set[Cause]:
    """Return what `decide` returns for all statistics within MARGIN of these."""
    if not decide(evidence):
        return set()
    known = [name for name in DECISIVE_STATISTICS if getattr(evidence, name) > 0]
    causes: set[Cause] = set()
    wide_margins = {"significance": SIGNIFICANCE_MARGIN, "corners": CORNERS_MARGIN}
    margins = [wide_margins.get(name, MARGIN) for name in known]
    for exponents in product((-1, 1), repeat=len(known)):
        changes = {
            name: margin**exponent * getattr(evidence, name)
            for name, margin, exponent in zip(known, margins, exponents, strict=True)
        }
        causes |= decide(replace(evidence, **changes))
    return causes | decide(evidence)


def is_moving(fraction: float, bands: float) -> bool:
    """Return whether something moved, rather than that lamps flicker; False if either may be true."""
    return find_causes(Evidence(fraction=fraction, bands=bands)) == ("moved",)


def warn_of_contradictions(
    found: Contradictions,
    names: Sequence[str],
    spread: float = UNKNOWN_SPREAD,
    *,
    band_stops: float = 0.0,
    moving_fraction: float = 0.0,
    unresolved_fraction: float = 0.0,
    times: TimesSource = "kept",
    deviations: Sequence[float] = (),
) -> str:
    """Return the warning about what is wrong, in which photo and by how much; "" if nothing is.

    Parameters
    ----------
    found : Contradictions
    names : sequence of str
        Names of the photos.
    spread : float
        The map's spread in stops. If it is small, only wrong times and large differences matter.
    band_stops : float
        Stops by which the light changes in horizontal bands, see `motion.measure_motion`.
    moving_fraction : float
        Fraction of the image in which ghosts are left.
    unresolved_fraction : float
        Fraction of the image that seemed to move, but in which no region has ghosts.
    times : {"kept", "corrected", "relative"}
        Whether the times stayed as stated, whether hdrlab tried to correct them from the pixels, or
        whether they are relative. The advice depends on it.
    deviations : (P,) float, optional
        Stops by which each photo deviates from the map, see `consistency.measure_deviations`.
    """
    evidence = collect_evidence(
        found,
        spread,
        fraction=moving_fraction,
        bands=band_stops,
        unresolved_fraction=unresolved_fraction,
    )
    causes = find_causes(evidence)
    if not causes:
        return ""
    texts = _describe_causes(evidence, found, names, deviations)
    if len(causes) > 1:
        return warning_text(
            "either",
            causes=" or ".join(warning_text(f"{cause}_cause", **texts) for cause in causes),
            evidence=", and ".join(warning_text(f"{cause}_evidence", **texts) for cause in causes),
            advice=", and ".join(warning_text(f"{cause}_advice", **texts) for cause in causes),
        )
    (cause,) = causes
    if cause == "times":
        if np.isfinite(found.stops).sum() == 3:
            texts["off"] += warning_text("of_three")
        if times == "relative":
            return warning_text("relative_times", **texts)
        return warning_text("times", **texts, advice=warning_text(f"{times}_times_advice"))
    return warning_text(cause, **texts)


def _describe_causes(
    evidence: Evidence, found: Contradictions, names: Sequence[str], deviations: Sequence[float]
) -> dict[str, str]:
    """Return what the texts of the causes say: numbers, and names of photos."""
    regions = np.nan_to_num(found.regions, nan=-1.0)
    pair = int(regions.argmax()) if len(regions) else 0
    deviating = [
        f"{name} by {stops:+.2f}"
        for name, stops in zip(names, deviations, strict=False)
        if abs(stops) > MIN_NAMED_DEVIATION
    ]
    return {
        "frame": names[int(found.tints.argmax())] if len(found.tints) == len(names) else "",
        "tint": f"{evidence.tint:.2f}",
        "corners": f"{evidence.corners:.2f}",
        "bands": f"{evidence.bands:.2f}",
        "regions": f"{evidence.regions:.2f}",
        "dark": names[pair],
        "bright": names[min(pair + 1, len(names) - 1)],
        "off": _list_wrong_times(found, names),
        "percent": f"{100 * max(evidence.fraction, evidence.unresolved_fraction):.0f}",
        "ghosts_advice": warning_text(
            "unresolved_ghosts_advice" if evidence.unresolved_fraction > 0 else "ghosts_advice"
        ),
        "spread": f"{evidence.spread:.2f}",
        "deviations": ", ".join(deviating) or "no photo stands out",
    }


def _list_wrong_times(found: Contradictions, names: Sequence[str]) -> str:
    """Return the photos whose times are wrong, and by how many stops.

    Close to the limit none may be wrong; then it is the photo with the largest error.
    """
    sizes = np.nan_to_num(np.abs(found.stops), nan=0.0)
    off = _list_errors(found.wrong or (int(sizes.argmax()),), found.stops, names)
    if len(found.other_stops):
        other = replace(found, stops=found.other_stops).wrong
        if other:
            other_off = _list_errors(other, found.other_stops, names)
            off += warning_text("instead", off=other_off)
    return off


def _list_errors(wrong: Sequence[int], stops: F64, names: Sequence[str]) -> str:
    """Return the names of photos and their errors; of many photos, those with the largest errors."""
    named = sorted(wrong, key=lambda j: -abs(stops[j]))[:MAX_NAMED_PHOTOS]
    off = ", ".join(f"{names[j]} by {stops[j]:+.2f}" for j in sorted(named))
    if len(wrong) > len(named):
        off += f" and {len(wrong) - len(named)} more"
    return off
