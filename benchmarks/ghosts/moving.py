"""What is left of ghosts, measured by the truth; and that nothing is found where nothing moved.

The error is the root mean square of log2(E / truth), in stops, over the pixels of the regions found
in which somebody's passing changes the radiance by more than 5 % and a frame measures something.
The truth of a region is the moment of its leading frame. The plain map is judged by whichever
moment suits it best, the empty scene among them. Both are first multiplied by the factor that
brings the still pixels to their truth.

"change elsewhere" compares the map with the plain one outside the regions; "left over" is the
median error of those pixels outside that somebody passed, against the empty scene.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.experiments import Experiment, along, at_least, at_most
from benchmarks.ghosts.sequences import SEQUENCES, STILL, sequence, shaken, still
from hdrlab.capture.movers import Moving
from hdrlab.capture.responses import true_g
from hdrlab.core import weights
from hdrlab.core.arrays import Array, ArrayLike, NDArray
from hdrlab.core.bracket import Bracket
from hdrlab.radiance.deghosting import ghosts
from hdrlab.radiance.merge import Merged, merge_with_quality

CHANGE = 0.05  # of the radiance: less than that is hardly a figure's, but the shadow's of one
SEEDS = range(4)
REFERENCE = 3  # the middle frame
G = true_g("film")
W = weights.gaussian()


class Errors(NamedTuple):
    """What became of a sequence: errors in stops, and shares."""

    plain: float
    without: float
    measured: float
    elsewhere: float
    left: float
    regions: int

    @property
    def ratio(self) -> float:
        """How many times smaller the error has become."""
        return self.plain / self.without


def plain(taken: Bracket) -> Merged:
    """Return the plain map."""
    return merge_with_quality(taken.images, taken.times, G, W)


def rid(taken: Bracket, way: str) -> ghosts.Ghosts:
    """Return the map without ghosts: by "regions", "reference", or regions "alone"."""
    reference = REFERENCE if way == "reference" else None
    alone = way == "alone"
    return ghosts.remove_ghosts(taken.images, taken.times, G, W, fixed=reference, alone=alone)


def stops(E: Array, truth: Array, where: NDArray[np.bool_]) -> float:
    """Return the root mean square of log2(E / truth) there."""
    return float(np.sqrt(np.mean(np.log2(E[where] / truth[where]) ** 2)))


def errors(taken: Moving, way: str) -> Errors:
    """Return the Errors of a sequence by one of the ways."""
    merged = plain(taken.bracket)
    corrected = rid(taken.bracket, way)
    scale = np.median((merged.E / taken.still)[~taken.region])
    still = taken.still * scale
    moments = np.maximum(taken.moments * scale, 1e-9)
    passed = taken.region & (np.abs(np.log(moments / still)).max(axis=(0, 3)) > CHANGE)
    inside = passed & (corrected.labels > 0)
    outside = passed & (corrected.labels == 0)
    known = inside & (corrected.quality == 0) & (merged.quality == 0)
    truth = still.copy()
    for r, j in enumerate(corrected.references, start=1):
        truth[corrected.labels == r] = moments[j][corrected.labels == r]
    return Errors(
        plain=min(stops(merged.E, light, known) for light in (truth, still, *moments)),
        without=stops(corrected.E, truth, known),
        measured=known.sum() / inside.sum(),
        elsewhere=float(np.abs(corrected.E / merged.E - 1)[corrected.labels == 0].max()),
        left=float(np.median(np.abs(corrected.E / still - 1)[outside])) if outside.any() else 0.0,
        regions=len(corrected.references),
    )


def of(item: tuple[str, str, str]) -> Errors:
    """Return the Errors of (place, who, way)."""
    return errors(sequence(*item[:2]), item[2])


def removal(way: str) -> Mapping[str, ArrayLike]:
    """Return the figures of all sequences by one way."""
    results = along(of, [(*sequence, way) for sequence in SEQUENCES], f"ghosts, {way}")
    figures: dict[str, ArrayLike] = {
        f"{place}, {who}: stops before and after": (sequence.plain, sequence.without)
        for (place, who), sequence in zip(SEQUENCES, results, strict=True)
    }
    figures["least ratio"] = min(sequence.ratio for sequence in results)
    figures["median ratio"] = float(np.median([sequence.ratio for sequence in results]))
    figures["least share measured"] = min(sequence.measured for sequence in results)
    figures["most change elsewhere"] = max(sequence.elsewhere for sequence in results)
    figures["most left over, median of pixels"] = max(sequence.left for sequence in results)
    return figures


def regions(_: Path) -> Mapping[str, ArrayLike]:
    """Return the figures of regions, each with its best exposure."""
    return removal("regions")


def reference(_: Path) -> Mapping[str, ArrayLike]:
    """Return the figures of one frame that leads everywhere."""
    return removal("reference")


def alone(_: Path) -> Mapping[str, ArrayLike]:
    """Return the figures of the slide's way, where nothing joins the best exposure."""
    return removal("alone")


def found_in_stillness(place: str) -> tuple[int, int, float]:
    """Return in how many brackets of a still place regions are found, of how many, and the map's change."""
    brackets = [
        still(place),
        still(place, (512, 768)),
        *(bracket for s in SEEDS for _, bracket in shaken(place, s)),
    ]
    pairs = [(rid(bracket, "regions"), plain(bracket)) for bracket in brackets]
    change = max(float(np.abs(bracket.E / merged.E - 1).max()) for bracket, merged in pairs)
    return sum(len(bracket.references) > 0 for bracket, _ in pairs), len(pairs), change


def stillness(_: Path) -> Mapping[str, ArrayLike]:
    """Return what is found where nothing moved, on a tripod and in a hand."""
    results = along(found_in_stillness, STILL, "still")
    figures: dict[str, ArrayLike] = {
        place: place_and_seed[:2] for place, place_and_seed in zip(STILL, results, strict=True)
    }
    figures["brackets with a region"] = sum(place_and_seed[0] for place_and_seed in results)
    figures["most change"] = max(place_and_seed[2] for place_and_seed in results)
    return figures


ROWS = (
    Experiment(
        "ghosts",
        "best exposure of each region, joined by what agrees with it; nine sequences, RMS in stops",
        regions,
        (
            at_least("least ratio", 10),
            at_least("least share measured", 0.85),
            at_most("most change elsewhere", 0.01),
            at_most("most left over, median of pixels", 0.02),
        ),
    ),
    Experiment(
        "ghosts-reference",
        "the same, the middle frame leads in every region",
        reference,
        (at_least("least ratio", 10), at_most("most change elsewhere", 0.01)),
    ),
    Experiment(
        "ghosts-alone",
        "the same, as on the slide: the best exposure of each region and no other",
        alone,
        (),
    ),
    Experiment(
        "ghosts-still",
        "four still scenes, on a tripod and with a shake of half a pixel: brackets with regions, of how many",
        stillness,
        (at_most("brackets with a region", 0), at_most("most change", 0)),
    ),
)
