"""What `assemble` says of simulated brackets: false alarms on sound ones, misses on those with an ill.

warned   hdrlab warns, or says that something moved, or the bracket is refused
cost     what the ill changes in the map: mean size of log2 (map / map of the same photographs without it),
         each the mean of 4 x 4 pixels, once one is laid on the other, since a map is as good where
         the camera turned. Pixel by pixel, turning all frames alike, which is no ill, would cost
         0.11 to 0.19 stops by resampling, noise and JPEG alone, and 0.04 to 0.10 in these means
costly   a cost above 0.1 stops; `missed` is the share of these without a warning, %

Sound brackets are of eight kinds, among them photos taken by hand (shifts of up to 8 pixels), lamps
that clip in every photo, and ground in the dark. `--seed N` draws others. A bracket that would leave
more than 3 % of the pixels black in every photo gets longer exposures first, because a warning would
be right.

An ill that costs less may be warned of or not: what the camera and the pipeline make harmless needs
no word.

`verdicts-borders` prints the dead bands of all verdicts, and looks for borders where hdrlab claims the
opposite on the other side. `verdicts-bands` compares the width of each dead band with what a millionth
of noise changes. `verdicts-machines` compares the verdicts on the same photos with other
instruction sets, numbers of threads and memory layouts.

Three rows miss their hold, of 12 brackets each:
curve     5 of 5 costly ones are missed, and will be: a camera of another response, under times that differ
          by a twentieth of a stop or less, takes the same photographs. The maps predict their
          levels as well as the maps of the same photographs unbent do, to 1.1 to 1.9 levels in the
          median, at a spread of 0.006 to 0.027 stops, and sound brackets come to 0.034
parallax  1 of 7: the frames disagree in 1.2 % of the picture, and in 1.15 % of a real, still bracket's
local     2 of 12: three frames, or three that are left, whose curve takes up most of what was done to them
"""

from collections.abc import Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.experiments import Experiment, along, at_most
from benchmarks.peers import opencv
from benchmarks.verdicts import borders, brackets, ills, machines, statistics
from hdrlab import pipeline
from hdrlab.core.arrays import Array, ArrayLike
from hdrlab.core.bracket import Bracket
from hdrlab.core.colour import luminance

# brackets of a row, of each of the sound kinds, and of those that one row distinguishes
COUNT, SOUND = 12, 13
# stops
COSTLY = 0.1
# pixels at the border that do not count, where frames were moved, and of the side of those that are
# compared
BORDER, SIDE = 16, 4


class Verdict(NamedTuple):
    """What was said of a bracket, its warnings in words, and what its ill costs in the map, stops."""

    warnings: tuple[str, ...]
    cost: float


def assembled(taken: Bracket) -> tuple[Array | None, tuple[str, ...]]:
    """Return the luminance of the map, and what is said against it; no map where it is refused."""
    try:
        found = pipeline.assemble(taken)
    except ValueError as reason:
        return None, (f"refused: {reason}",)
    return luminance(found.E), (
        *found.warnings,
        *(note for note in found.notes if "something moved" in note),
    )


def measure_cost(found: Array, sound: Array) -> float:
    """Return the mean size of log2 (found / sound), up to a factor and a motion, over what both maps show."""
    h, w = np.minimum(found.shape, sound.shape)
    a, b = (
        np.log2(np.maximum(_middle(one, h, w), 1e-9)).astype(np.float32) for one in (sound, found)
    )
    cv2, moved = opencv(one_thread=True), np.eye(2, 3, dtype=np.float32)
    with suppress(cv2.error):  # where the two have nothing in common
        _, moved = cv2.findTransformECC(a, b, moved, cv2.MOTION_EUCLIDEAN)
    way = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    laid = cv2.warpAffine(_middle(found, h, w), moved, (w, h), flags=way, borderValue=np.nan)
    one, other = (_means(E[BORDER:-BORDER, BORDER:-BORDER]) for E in (_middle(sound, h, w), laid))
    both = (one > 0) & (other > 1e-8)
    off = np.log2(other[both] / one[both])
    return float(np.mean(np.abs(off - np.median(off))))


def _means(E: Array) -> Array:
    h, w = (n // SIDE for n in E.shape)
    return E[: h * SIDE, : w * SIDE].reshape(h, SIDE, w, SIDE).mean(axis=(1, 3))


def _middle(E: Array, h: int, w: int) -> Array:
    top, left = (E.shape[0] - h) // 2, (E.shape[1] - w) // 2
    return E[top : top + h, left : left + w]


def judge(i: int, folder: Path, name: str, seed: int = 0) -> Verdict:
    """Return the Verdict on bracket i with this ill, or with none."""
    plan = brackets.plan(folder, i, sound=name if name in brackets.SOUND else "", seed=seed)
    if name in brackets.SOUND:
        return Verdict(assembled(brackets.shoot(plan))[1], 0.0)
    ill = ills.ILLS[name]
    E, warnings = assembled(brackets.shoot(plan, ill))
    sound = assembled(
        brackets.shoot(plan, ill, at_rest=True) if ill.moves else brackets.shoot(plan)
    )[0]
    if E is None:
        return Verdict(warnings, np.inf)
    return Verdict(warnings, 0.0 if sound is None else measure_cost(E, sound))


def sound(folder: Path, *, count: int = SOUND, seed: int = 0) -> Mapping[str, ArrayLike]:
    """Return the share of sound brackets that are warned of, %, kind by kind."""
    found: dict[str, ArrayLike] = {}
    alarms = []
    for name in brackets.SOUND:
        said = [
            one.warnings
            for one in along(
                partial(judge, folder=folder, name=name, seed=seed), range(count), name
            )
        ]
        alarms += [bool(one) for one in said]
        found[name] = 100 * np.mean(alarms[-count:])
        for k, one in enumerate(said):
            if one:
                print(f"  false alarm, {name} {k}: {'; '.join(one)}", flush=True)
    return found | {"false alarms": 100 * np.mean(alarms)}


def told(folder: Path, *, name: str, count: int = COUNT) -> Mapping[str, ArrayLike]:
    """Return the share of costly brackets that nothing is said of, %, and how many there are."""
    each = along(partial(judge, folder=folder, name=name), range(count), name)
    cost, warned = (
        np.array([one.cost for one in each]),
        np.array([bool(one.warnings) for one in each]),
    )
    costly = cost > COSTLY
    return {
        "missed": 100 * np.mean(~warned[costly]) if costly.any() else 0.0,
        "costly, warned": [costly.sum(), warned.sum()],
        "cost, median and worst": [np.median(cost), np.max(cost[np.isfinite(cost)], initial=0)],
    }


ROWS = (
    Experiment(
        "verdicts-sound",
        f"sound brackets, {SOUND} of each kind: warned of, %",
        sound,
        (at_most("false alarms", 2),),
        has_seed=True,
    ),
    Experiment(
        "verdicts-borders",
        "borders between two verdicts, and verdicts that are the opposite within a millionth",
        borders.try_borders,
        (at_most("opposite verdicts", 0),),
    ),
    Experiment(
        "verdicts-bands",
        "dead bands that a millionth of noise leaves (flips) or crosses (opposite verdicts)",
        statistics.compare_bands,
        (at_most("opposite verdicts", 0),),
    ),
    Experiment(
        "verdicts-machines",
        "brackets of which another machine or memory layout says something else",
        machines.compare,
        (at_most("opposite verdicts", 0),),
    ),
    *(
        Experiment(
            f"verdicts-{name}",
            f"{ills.ILLS[name].title}: of {COUNT} brackets, those it costs more than {COSTLY} stops",
            partial(told, name=name),
            (at_most("missed", 10),),
        )
        for name in ills.ILLS
    ),
)
