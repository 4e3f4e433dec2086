"""Compare the class with metrics: how often TMQI, PU-SSIM and the votes on pairs prefer the same artifact.

TMQI     of the artifact and the luminance of its radiance map, see `tonemap.quality`
PU-SSIM  of the map and of the light that the artifact shows, fitted to the map's exposure. The brightest
         pixel of the map has 1000 cd/m2, see `radiance.scores`.

Both are computed at the size at which a class sees the artifacts, because they depend on it.
"""

import sqlite3
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np
from skimage import transform

from hdrlab.core.arrays import F64, to_256
from hdrlab.core.colour import decode_srgb, luminance
from hdrlab.course.gallery.bradley_terry import INTERVAL_SIGMAS
from hdrlab.errors import InputError
from hdrlab.io import photos, radiance
from hdrlab.radiance import pu21, scores
from hdrlab.show.plots.figures import fit
from hdrlab.tonemap import quality

MAX_SIDE_PIXELS = 1200
MAX_ASPECT_DIFFERENCE = 0.01  # of width over height, between an artifact and its map
PEAK_LUMINANCE = 1000.0  # cd/m2
CLASS = "the class"
METHOD = (
    "A pair counts if the class has a majority and both artifacts have a radiance map. The 95 % "
    "intervals are for other artifacts of the same kind. TMQI and PU-SSIM of different scenes are "
    "hard to compare, so the figures say most if all artifacts show one scene."
)


@dataclass(frozen=True)
class MetricScores:
    """TMQI (Q) and PU-SSIM of an artifact."""

    tmqi: float
    pu_ssim: float


@dataclass(frozen=True)
class Agreement:
    """On which fraction of the pairs two judges prefer the same artifact.

    Attributes
    ----------
    first, second : names of the judges
    pairs : number of pairs on which both prefer one artifact
    share : fraction of these pairs on which they agree
    low, high : the 95 % interval of `share`
    """

    first: str
    second: str
    pairs: int
    share: float
    low: float
    high: float


def score(picture: Path, radiance_map: Path) -> MetricScores:
    """Return the scores of an artifact against the radiance map of its scene.

    Raises
    ------
    InputError
        For files that cannot be read, a map without light, and one of another aspect ratio.
    """
    shown = fit(to_256(photos.read_photo(picture)), MAX_SIDE_PIXELS)
    height, width = shown.shape[:2]
    E = radiance.read_radiance(radiance_map, clean=True)
    map_height, map_width = E.shape[:2]
    if abs(width / height * map_height / map_width - 1) > MAX_ASPECT_DIFFERENCE:
        raise InputError(
            f"{radiance_map.name}: expected the aspect ratio of the artifact, {width} x {height}, "
            f"got {map_width} x {map_height} pixels"
        )
    reference = transform.resize_local_mean(luminance(E), (height, width))
    if not reference.max() > 0:
        raise InputError(f"{radiance_map.name}: this map has no light")
    light = luminance(decode_srgb(shown / 255))
    light = light * pu21.fit_exposure(light, reference)
    return MetricScores(
        tmqi=quality.tmqi(reference, shown).Q,
        pu_ssim=scores.pu_ssim(light, reference, peak=PEAK_LUMINANCE),
    )


def read_scores(db: sqlite3.Connection) -> dict[str, MetricScores]:
    """Return the scores of the artifacts that have some, by id."""
    rows = db.execute("SELECT artifact, tmqi, pu_ssim FROM scores")
    return {id: MetricScores(tmqi=tmqi, pu_ssim=pu_ssim) for id, tmqi, pu_ssim in rows}


def agreements(
    ids: Sequence[str], wins: F64, scores_of: Mapping[str, MetricScores]
) -> list[Agreement]:
    """Return how often the class and the metrics agree; no entry for judges without a common pair.

    Parameters
    ----------
    ids : the artifacts
    wins : (N, N), number of votes for i on the pair of i and j
    scores_of : the scores of those artifacts that have a radiance map
    """
    rated = [k for k, id in enumerate(ids) if id in scores_of]
    all_scores = [scores_of[ids[k]] for k in rated]
    tmqi = np.array([score.tmqi for score in all_scores])
    pu_ssim = np.array([score.pu_ssim for score in all_scores])
    majority = wins[np.ix_(rated, rated)]
    preferences = {
        CLASS: np.sign(majority - majority.T),
        "TMQI": np.sign(tmqi[:, None] - tmqi[None, :]),
        "PU-SSIM": np.sign(pu_ssim[:, None] - pu_ssim[None, :]),
    }
    upper = np.triu_indices(len(rated), 1)
    results = []
    for first, second in combinations(preferences, 2):
        products = (preferences[first] * preferences[second])[upper]
        decided = products[products != 0]
        if len(decided):
            share = float(np.mean(decided > 0))
            low, high = share_interval(share, len(decided), len(rated))
            results.append(
                Agreement(
                    first=first, second=second, pairs=len(decided), share=share, low=low, high=high
                )
            )
    return results


def share_interval(share: float, pairs: int, artifacts: int) -> tuple[float, float]:
    """Return the 95 % interval of a fraction of pairs that have artifacts in common.

    This is Wilson's interval for the number of independent pairs that would be as precise. For all
    p pairs of n artifacts, that is 9 p / (2 n + 5), from the variance of Kendall's tau of two
    independent orders (Kendall, Biometrika 30, 1938).

    Examples
    --------
    >>> low, high = share_interval(0.7, pairs=190, artifacts=20)
    >>> round(low, 2), round(high, 2)
    (0.54, 0.82)
    """
    independent_pairs = 9 * pairs / (2 * artifacts + 5)
    z = INTERVAL_SIGMAS**2 / independent_pairs
    center = (share + z / 2) / (1 + z)
    margin = np.sqrt(z * share * (1 - share) + z**2 / 4) / (1 + z)
    return float(max(0.0, center - margin)), float(min(1.0, center + margin))
