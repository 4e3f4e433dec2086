"""Registration where the truth is known, beside the peers on the same pairs; and real brackets, by sharpness.

error   how far a pair's answer is from the truth at the worst of the four corners, pixels
failed  an error above 1 pixel, or any answer where nothing corresponds
told    of the failures, the share that the validation reports, %
"""

from collections.abc import Mapping
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks import peers
from benchmarks.align import brackets, cases, real, who
from benchmarks.experiments import Experiment, Skipped, along, at_least
from hdrlab.core.arrays import Array, ArrayLike
from hdrlab.core.filters import warp

COUNT = 100  # pairs of a kind
WITHIN = {"shift": 1.0, "turned": 0.3}  # pixels
FAILED = 1.0  # pixels
ANY = -np.inf
WAYS = who.HDRLAB | who.PEERS


def measure_case(name: str, kind: str, i: int) -> tuple[float, bool]:
    """Return the error of one who registers case i, and whether the answer is doubted."""
    case = cases.KINDS[kind](i)
    move, doubted = WAYS[name](case.images, case.times)
    return np.inf if case.truth is None else float(
        warp.corner_distance(move, case.truth, cases.SHAPE)
    ), doubted


def answers(name: str, kind: str, count: int = COUNT) -> tuple[ArrayLike, ArrayLike]:
    """Return errors (count,) and warnings (count,)."""
    try:
        measure_case(name, kind, 0)
    except peers.Missing as reason:
        raise Skipped(str(reason)) from None
    both = along(partial(measure_case, name, kind), range(count), f"{name}, {kind}")
    errors, doubted = zip(*both, strict=True)
    return np.array(errors), np.array(doubted)


def accuracy(
    _: Path, *, kind: str, names: tuple[str, ...], count: int = COUNT
) -> Mapping[str, ArrayLike]:
    """Return of each the share within the limit, %, the median and 95 % of the errors, pixels."""
    summary: dict[str, ArrayLike] = {}
    for name in names:
        errors = np.asarray(answers(name, kind, count)[0])
        right = 100 * np.mean(errors <= WITHIN[kind])
        summary[name] = np.array([right, *np.quantile(errors, (0.5, 0.95))])
    return summary


def share(doubted: Array, among: Array, none: float) -> Array:
    """Return how many of those among which one looks are doubted, %, and how many these are."""
    return np.array(
        [100 * np.mean(doubted[among]) if among.any() else none, np.count_nonzero(among)]
    )


def flagged(_: Path, *, name: str, count: int = COUNT) -> Mapping[str, ArrayLike]:
    """Return of each class the share of failures that is told, %, and how many there are."""
    summary: dict[str, ArrayLike] = {}
    for kind in ("rotation", "motion", "high frequency"):
        errors, doubted = map(np.asarray, answers(name, kind, count))
        failed = errors > FAILED
        summary[kind] = share(doubted, failed, 100.0)
    for kind in WITHIN:  # the price of caution
        errors, doubted = map(np.asarray, answers(name, kind, count))
        right = errors <= FAILED
        summary[f"{kind}: of the right answers doubted"] = share(doubted, right, 0.0)
    return summary


def beside(kind: str, title: str) -> tuple[Experiment, ...]:
    """Return the rows of the peers, one each, for one may be missing."""
    return tuple(
        Experiment(
            f"align-{kind}-{name.split()[0].strip(',').lower()}", f"{title}; {name}", run, ()
        )
        for name in who.PEERS
        for run in [partial(accuracy, kind=kind, names=(name,))]
    )


SHIFT = (
    "shift of up to 32 whole pixels: % of 100 pairs within 1 pixel at the corners, "
    "median and 95th percentile of the errors"
)
TURN = (
    "shift of up to 32 pixels, rotation of up to 3 degrees: % of 100 pairs within 0.3 pixels, "
    "median and 95th percentile of the errors"
)
TOLD = "of 100 pairs of each class of Ward's failures: % of the failures that are told, and their number"
ROWS = (
    Experiment(
        "align-shift",
        SHIFT,
        partial(accuracy, kind="shift", names=("mtb", "cerman, response known")),
        (at_least("mtb", 100, ANY, ANY), at_least("cerman, response known", 100, ANY, ANY)),
    ),
    *beside("shift", SHIFT),
    Experiment(
        "align-turned",
        TURN,
        partial(accuracy, kind="turned", names=tuple(who.HDRLAB)),
        (at_least("cerman, response known", 98, ANY, ANY),),
    ),
    *beside("turned", TURN),
    *(
        Experiment(
            f"align-told-{name.split(',')[0]}",
            f"{name}, {TOLD}",
            partial(flagged, name=name),
            tuple(at_least(kind, 95, ANY) for kind in ("rotation", "motion", "high frequency")),
        )
        for name in ("mtb", "cerman, response known")
    ),
    *real.ROWS,
    *brackets.ROWS,
)
