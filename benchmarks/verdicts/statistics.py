"""How much does a millionth of noise change the statistics that decide on verdicts?

Each bracket is assembled once, and again several times with light that differs by a millionth from
pixel to pixel. Meanwhile, every statistic of `bands.BANDS` with a dead band is recorded where hdrlab
computes it. A bracket that lies in the middle of a dead band leaves it, so that the verdict flips, if
a repetition changes the statistic by more than half of the band's width. A verdict becomes its
opposite if a repetition changes the statistic by more than the whole width.

Statistics far away from their limit decide nothing. So only those count that are between half of the
limit and twice the limit. For some limits there may be none: the table shows the number of values.
"""

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

from benchmarks.experiments import along
from benchmarks.verdicts import borders, brackets, ills
from benchmarks.verdicts.bands import BANDS, Band
from benchmarks.verdicts.brackets import Ill, Plan
from hdrlab import pipeline
from hdrlab.core.arrays import F64, Array, ArrayLike
from hdrlab.core.bracket import Bracket
from hdrlab.diagnostics import (
    causes,
    contradictions,
    motion,
    outlying_frames,
    registration,
    response_steps,
    tones,
)
from hdrlab.diagnostics.causes import Evidence
from hdrlab.diagnostics.response_steps import list_trends
from hdrlab.errors import InputError
from hdrlab.pipeline import rigid_motion

# repetitions of each bracket
REPETITIONS = 5
# A statistic counts if its ratio to the limit is not larger, and not smaller than the inverse.
MAX_RATIO = 2.0
# Errors of alignments in place are compared at this fraction of the resolution of the overview.
COARSE_FACTOR = 8

Record = Callable[[str, float], None]


def show_another_scene(part: float) -> Ill:
    """Return the ill of one photo in which a part of the light is that of the mirrored scene."""

    def light(plan: Plan, j: int, rng: np.random.Generator, E: Array) -> Array:
        return np.asarray((1 - part) * E + part * E[:, ::-1]) if j == plan.one else E

    return Ill("another scene", light=light)


# ills, and the plans of the brackets that have them
CASES: tuple[tuple[Ill, int], ...] = (
    (borders.state_wrong_time(1.4), 3),
    (borders.state_wrong_time(1.25), 5),
    (borders.state_wrong_time(4.0), 5),
    (borders.state_wrong_time(1.3), 4),
    (borders.change_balance(0.27), 2),
    (borders.darken_corners(0.2), 7),
    (borders.darken_corners(0.3), 7),
    (borders.flicker(0.33), 3),
    (borders.blow_leaves(0.45), 3),
    (borders.map_tones(0.2), 2),
    (borders.map_tones(0.4), 2),
    (show_another_scene(0.2), 2),
    (show_another_scene(0.5), 4),
    (show_another_scene(0.8), 3),
    (borders.darken_corners(0.345), 6),
    (borders.darken_corners(0.4), 3),
    (ills.ILLS["wind"], 1),
    (ills.ILLS["wind"], 6),
    (ills.ILLS["people"], 2),
    (ills.ILLS["shake"], 2),
    (ills.ILLS["parallax"], 1),
)


def record_evidence(found: Evidence, record: Record) -> None:
    """Record the statistics of `causes`."""
    record("tint, stops", found.tint)
    record("corners, stops", found.corners)
    record("parts, stops", found.regions)
    record("parts, standard errors", found.significance)
    record("time error, stops", found.time_error)
    record("cost in the map, stops", found.cost)
    record("spread, stops", found.spread)
    if found.time_error > 0:
        record("parts over time error", found.regions / found.time_error)


def record_motion(found: motion.Motion, record: Record) -> None:
    """Record how much moved, and how much the light changed in bands."""
    record("fraction of blocks", found.fraction)
    record("bands, stops", found.band_stops)


def record_parts(parts: Sequence[tones.PartError], record: Record) -> None:
    """Record the largest error of the map in a part of the image that is not the darkest one."""
    errors = [
        abs(part.stops) for part in parts if part.kind != "dark" and not part.is_between_photos
    ]
    record("map against it, stops", max(errors, default=0.0))


@contextmanager
def watch(module: Any, name: str, observe: Callable[..., None]) -> Iterator[None]:
    """Pass the result and the arguments of each call of a function to `observe`."""
    original = getattr(module, name)

    def call(*arguments: Any, **keywords: Any) -> Any:
        result = original(*arguments, **keywords)
        observe(result, *arguments)
        return result

    with mock.patch.object(module, name, call):
        yield


@contextmanager
def watch_errors_in_place(record: Record) -> Iterator[None]:
    """Record the error that photos have without an alignment, at the coarse resolution."""
    validate = registration.validate

    def call(pair: registration.Comparison, *arguments: Any, **keywords: Any) -> Any:
        resolutions = [0]

        def find_differences(H: F64, *resolution: int) -> F64:
            resolutions.append(max(resolution, default=0))
            return pair.differences(H, *resolution)

        def measure_error(differences: F64) -> float:
            error = pair.error(differences)
            if resolutions[-1] >= COARSE_FACTOR * pair.scale:
                record("error in place", error)
            return error

        watched = replace(pair, differences=find_differences, error=measure_error)
        return validate(watched, *arguments, **keywords)

    with mock.patch.object(registration, "validate", call):
        yield


@contextmanager
def watch_confirmations(record: Record) -> Iterator[None]:
    """Record the measures of each alignment about which hdrlab asks whether it is confirmed."""
    decide = vars(rigid_motion.Fit)["is_confirmed"].fget

    def is_confirmed(fit: rigid_motion.Fit) -> bool:
        record("similarity of gradients", fit.similarity)
        if fit.has_enough_blocks:
            record("shift of a block, pixels", fit.scale * fit.median_shift)
        return bool(decide(fit))

    with mock.patch.object(rigid_motion.Fit, "is_confirmed", property(is_confirmed)):
        yield


@contextmanager
def record_statistics(record: Record) -> Iterator[None]:
    """Pass each statistic to `record` when hdrlab computes it."""
    band_sizes: list[float] = []

    def observe_bands(size: float, *_: Any) -> None:
        band_sizes.append(size)
        # the bands of rows come first
        if len(band_sizes) % 2 == 0 and size > 0:
            record("rows over columns", band_sizes[-2] / size)

    def observe_trends(_: Any, x: F64, B: F64) -> None:
        roots = [np.sqrt(np.abs(errors)).sum() for errors in list_trends(x, B, margin=np.inf)]
        record("sum of roots over the least", roots[1] / roots[0])

    def observe_pair_errors(errors: F64, *_: Any) -> None:
        record("the others, stops", float(errors.max(initial=0)))

    def observe_corners(_: Any, explained: float) -> None:
        record("explained by the radius", explained)

    with ExitStack() as stack:
        for module, name, observe in (
            (causes, "collect_evidence", lambda found, *_: record_evidence(found, record)),
            (motion, "measure_motion", lambda found, *_: record_motion(found, record)),
            (motion, "measure_bands", observe_bands),
            (tones, "measure_part_errors", lambda parts, *_: record_parts(parts, record)),
            (response_steps, "list_trends", observe_trends),
            (contradictions, "weigh_corners", observe_corners),
            (outlying_frames, "measure_pair_errors", observe_pair_errors),
        ):
            stack.enter_context(watch(module, name, observe))
        stack.enter_context(watch_errors_in_place(record))
        stack.enter_context(watch_confirmations(record))
        yield


def measure(bracket: Bracket) -> dict[str, list[float]]:
    """Return all values of each statistic of a bracket, from small to large."""
    values = defaultdict(list)
    with record_statistics(lambda name, value: values[name].append(value)), suppress(InputError):
        pipeline.assemble(bracket)
    return {name: sorted(found) for name, found in values.items()}


def measure_changes(item: tuple[int, Path]) -> list[tuple[str, float, float]]:
    """Return each statistic of a case with its value, and with its factor of change by the noise."""
    number, folder = item
    ill, plan_number = CASES[number]
    plan = brackets.plan(folder, plan_number)
    expected = measure(brackets.shoot(plan, ill))
    changes = []
    for seed in range(REPETITIONS):
        found = measure(brackets.shoot(plan, borders.add_noise(ill, seed)))
        for name, values in expected.items():
            others = found.get(name, [])
            if len(others) != len(values):  # a search that took another way
                continue
            for value, other in zip(values, others, strict=True):
                if value > 0 and other > 0:
                    changes.append((name, value, max(value / other, other / value)))
    return changes


def compare_band(band: Band, changes: Sequence[tuple[str, float, float]]) -> tuple[int, int, int]:
    """Print the row of a band, and return how often it was measured, left, and crossed."""
    factors = np.array(
        [
            factor
            for name, value, factor in changes
            if name == band.statistic and band.limit / MAX_RATIO < value < band.limit * MAX_RATIO
        ]
    )
    width = band.high / band.low
    flips = int(np.sum(factors > np.sqrt(width)))
    opposites = int(np.sum(factors > width))
    largest = f"{factors.max():.4f}" if len(factors) else "-"
    print(
        f"  {band.verdict:24} {band.statistic:28} {band.limit:6.3g} {band.low:7.3g} to "
        f"{band.high:<6.3g} {width:5.2f} {largest:>7} {len(factors):6} {flips:5} {opposites:9}",
        flush=True,
    )
    return len(factors), flips, opposites


def compare_bands(folder: Path) -> Mapping[str, ArrayLike]:
    """Return how often noise of a millionth would leave a dead band, and how often cross one."""
    items = [(number, folder) for number in range(len(CASES))]
    changes = [change for found in along(measure_changes, items, "bands") for change in found]
    print(
        f"  {'verdict':24} {'statistic':28} {'limit':>6} {'dead band':^17} {'width':>5} "
        f"{'change':>7} {'values':>6} {'flips':>5} {'opposites':>9}"
    )
    rows = [compare_band(band, changes) for band in BANDS if band.low < band.high]
    counts, flips, opposites = np.array(rows).T
    return {
        "bands": len(rows),
        "bands without a value near the limit": np.sum(counts == 0),
        "values": counts.sum(),
        "flips": flips.sum(),
        "opposite verdicts": opposites.sum(),
    }
