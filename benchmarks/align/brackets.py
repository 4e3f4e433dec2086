"""Whole brackets from a hand that turns the camera, where the truth is known: hdrlab and its peers.

A bracket has four photographs of about 640 x 384 pixels, 1 to 2.2 stops apart, shifted by up to 10
pixels each way. The camera turns by up to 0, 0.1, 0.3, 0.7, 1.5 and 2 degrees. With a rotation,
shifts are fractions of pixels; without one they are whole pixels. Other rows have larger photographs,
and 100 brackets, of which `--seed` draws others.

misregistration  pixels    distance from the truth that 95 % of the pixels do not exceed, of the
                           worst pair of neighbours
silent           count     brackets that are off by more than 1 pixel without a warning
CPU              seconds   of registration and, in hdrlab, resampling
"""

import os
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cache, partial
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy.ndimage import gaussian_filter, zoom

from benchmarks import peers
from benchmarks.align import who
from benchmarks.experiments import Experiment, Skipped, at_least, at_most
from hdrlab import scenes
from hdrlab.align.mtb import by_brightness
from hdrlab.capture import camera, hand_motion
from hdrlab.core.arrays import F32, F64, ArrayLike
from hdrlab.core.bracket import Bracket
from hdrlab.core.filters import warp
from hdrlab.pipeline import registration

PLACES = ("chapel", "street", "workshop", "room")
DEGREES = (0.0, 0.1, 0.3, 0.7, 1.5, 2.0)
SHAPE = (410, 670)
# of about 2 and 12 megapixels
LARGER_SHAPES = {"2mp": (1260, 1740), "12mp": (2880, 4280)}
LARGER_PLACES = ("chapel", "street")
LARGER_DEGREES = (0.0, 0.3, 2.0)
MIN_RADIANCE = 1e-6
# ln of the contrast of the texture of a magnified place, and the sizes of its grains
MAX_TEXTURE_CONTRAST = 0.1
TEXTURE_SIGMAS_PIXELS = (1, 2, 4)
FRESH_COUNT = 100
PHOTOS = 4
RADIUS_PIXELS = 10
FULL_WELL_ELECTRONS = 20_000.0
READ_NOISE_ELECTRONS = 5.0
GOOD_PIXELS = 0.3
WRONG_PIXELS = 1.0
GRID_POINTS = 24


@dataclass(frozen=True, kw_only=True, eq=False)
class HandheldBracket:
    """A bracket, by how many degrees its camera turned, and its true homographies (P, 3, 3)."""

    degrees: float
    taken: Bracket
    truth: F64


@dataclass(frozen=True, kw_only=True, eq=False)
class Answer:
    """The homographies (P, 3, 3) that a program found, and whether it warned."""

    homographies: F64
    has_warning: bool


Program = Callable[[Bracket], Answer]


@cache
def make_scene(place: str, shape: tuple[int, int]) -> F32:
    """Return the radiance (H, W, 3) of a place.

    A large one is magnified, with fine texture where the place has structure, not in its sky.
    """
    if shape == SHAPE:
        return np.asarray(getattr(scenes, place)(SHAPE), np.float32)
    small = np.asarray(getattr(scenes, place)(), np.float32)
    factors = (shape[0] / small.shape[0], shape[1] / small.shape[1])
    log_E = np.log(np.maximum(small, MIN_RADIANCE))
    structure = np.abs(log_E[..., 1] - gaussian_filter(log_E[..., 1], 2))
    contrast = np.minimum(gaussian_filter(structure, 2), MAX_TEXTURE_CONTRAST)
    rng = np.random.default_rng(PLACES.index(place))
    texture = np.zeros(shape, np.float32)
    for sigma in TEXTURE_SIGMAS_PIXELS:
        octave = gaussian_filter(rng.standard_normal(shape, np.float32), sigma)
        texture += octave / octave.std()
    texture *= zoom(contrast, factors, order=1)
    large = zoom(log_E, (*factors, 1), order=1)
    return np.exp(large + texture[..., None]).astype(np.float32)


def shoot_bracket(
    place: str, degrees: float, *, draw: tuple[int, ...] = (), shape: tuple[int, int] = SHAPE
) -> HandheldBracket:
    """Return a bracket of a place; the same one in every run. Another `draw` gives another one."""
    rng = np.random.default_rng((PLACES.index(place), round(10 * degrees), *draw))
    E = make_scene(place, shape)
    moves = []
    for _ in range(PHOTOS):
        offset = rng.uniform(-RADIUS_PIXELS, RADIUS_PIXELS, 2)
        angle = degrees * rng.uniform(0.7, 1) * rng.choice([-1, 1])
        moves.append(warp.turn(E.shape, angle, offset if degrees else np.rint(offset)))
    moves[PHOTOS // 2] = np.eye(3)
    times = camera.times_around(E, PHOTOS, stops=rng.uniform(1, 2.2))
    settings = camera.Camera(
        full_well=FULL_WELL_ELECTRONS, read_noise=READ_NOISE_ELECTRONS, response="film"
    )
    taken = camera.shoot(E, times, settings, offsets=np.array(moves), rng=rng)
    truth = hand_motion.frame_homographies(np.array(moves), E.shape)
    return HandheldBracket(degrees=degrees, taken=taken, truth=truth)


def misregistration(bracket: HandheldBracket, homographies: F64) -> float:
    """Return the misregistration of the worst pair, in pixels."""
    height, width = bracket.taken.images.shape[1:3]
    y, x = np.mgrid[0 : height - 1 : GRID_POINTS * 1j, 0 : width - 1 : GRID_POINTS * 1j]
    points = np.stack([x.ravel(), y.ravel()], axis=-1)
    errors = []
    for moving, fixed in pairwise(by_brightness(bracket.taken.images)):
        own = np.linalg.inv(homographies[fixed]) @ homographies[moving]
        true = np.linalg.inv(bracket.truth[fixed]) @ bracket.truth[moving]
        off = warp.apply(own, points) - warp.apply(true, points)
        errors.append(np.quantile(np.hypot(off[:, 0], off[:, 1]), 0.95))
    return float(max(errors))


def align_with_hdrlab(taken: Bracket, *, method: str) -> Answer:
    """Align a bracket with a method of hdrlab, as `assemble` does."""
    state = registration.align_bracket(taken, method)
    return Answer(homographies=state.homographies, has_warning=bool(state.warnings))


def align_pairs(taken: Bracket, *, way: who.Way) -> Answer:
    """Align the neighbours in brightness with a program for pairs."""
    order = by_brightness(taken.images)
    answers = [way(taken.images[[a, b]], taken.times[[a, b]]) for a, b in pairwise(order)]
    homographies = warp.chain_homographies(order, [H for H, _ in answers])
    return Answer(homographies=homographies, has_warning=any(doubted for _, doubted in answers))


def align_by_ecc(images: ArrayLike, _: F64) -> who.Answer:
    """Align a pair by OpenCV's enhanced correlation coefficient, with rotation and shift."""
    cv2 = peers.opencv(True)
    dark, bright = np.ascontiguousarray(np.asarray(images)[..., 1])
    try:
        _, back = cv2.findTransformECC(
            bright, dark, np.eye(2, 3, dtype=np.float32), cv2.MOTION_EUCLIDEAN
        )
    except cv2.error:
        return np.eye(3), True  # it says that it did not converge
    return np.linalg.inv(np.vstack([back, [0, 0, 1]])), False


PROGRAMS: dict[str, Program] = {
    "auto": partial(align_with_hdrlab, method="auto"),
    "mtb": partial(align_with_hdrlab, method="mtb"),
    "cerman": partial(align_with_hdrlab, method="cerman"),
    "OpenCV AlignMTB": partial(align_pairs, way=who.by_opencv),
    "OpenCV ECC": partial(align_pairs, way=align_by_ecc),
    who.HUGIN: partial(align_pairs, way=who.by_hugin),
}


def measure_cpu_seconds() -> float:
    """Return the CPU time of this process and of the programs that it has run."""
    # os.times has ticks of 10 ms, too coarse for this process.
    children = os.times()
    return time.process_time() + children.children_user + children.children_system


WITHIN = f"% of brackets within {GOOD_PIXELS} pixels"
SILENT = f"brackets off by more than {WRONG_PIXELS:g} pixel without a warning"
ERRORS = "misregistration: median, 95 %, worst, pixels"
CPU = "CPU of a bracket: median, worst, s"
STILL_CPU = "CPU where nothing turned / that of mtb"


def measure_brackets(
    _: Path,
    *,
    name: str,
    degrees: tuple[float, ...] = DEGREES,
    places: tuple[str, ...] = PLACES,
    shape: tuple[int, int] = SHAPE,
) -> Mapping[str, ArrayLike]:
    """Return how well a program aligns the brackets of these places, angles and size."""
    brackets = (shoot_bracket(place, angle, shape=shape) for angle in degrees for place in places)
    return measure_program(name, brackets)


def measure_fresh_brackets(_: Path, *, seed: int, name: str) -> Mapping[str, ArrayLike]:
    """Return how well a program aligns FRESH_COUNT brackets that a seed draws."""
    kinds = [(place, angle) for angle in DEGREES for place in PLACES]
    brackets = (
        shoot_bracket(*kinds[number % len(kinds)], draw=(seed, number))
        for number in range(FRESH_COUNT)
    )
    return measure_program(name, brackets)


def measure_program(name: str, brackets: Iterable[HandheldBracket]) -> Mapping[str, ArrayLike]:
    """Return how well a program aligns brackets, and print each of them when it is done."""
    errors = []
    silent = 0
    seconds = []
    still_seconds = 0.0
    still_mtb_seconds = 0.0
    for bracket in brackets:
        if not bracket.degrees:
            # The first run of a program is slower, and mtb is the shorter of the two.
            PROGRAMS["mtb"](bracket.taken)
            start = measure_cpu_seconds()
            PROGRAMS["mtb"](bracket.taken)
            still_mtb_seconds += measure_cpu_seconds() - start
        start = measure_cpu_seconds()
        try:
            answer = PROGRAMS[name](bracket.taken)
        except peers.Missing as reason:
            raise Skipped(str(reason)) from None
        seconds.append(measure_cpu_seconds() - start)
        errors.append(misregistration(bracket, answer.homographies))
        silent += errors[-1] > WRONG_PIXELS and not answer.has_warning
        warning = "a warning" if answer.has_warning else "no warning"
        print(
            f"  {name}, up to {bracket.degrees:g} degrees: {errors[-1]:.3g} pixels, {warning}, "
            f"{seconds[-1]:.3g} s",
            flush=True,
        )
        if not bracket.degrees:
            still_seconds += seconds[-1]
    return {
        WITHIN: 100 * np.mean(np.array(errors) <= GOOD_PIXELS),
        SILENT: silent,
        ERRORS: [*np.quantile(errors, [0.5, 0.95]), max(errors)],
        CPU: [np.median(seconds), max(seconds)],
        STILL_CPU: still_seconds / still_mtb_seconds if still_mtb_seconds else np.nan,
    }


TITLE = f"{len(PLACES) * len(DEGREES)} brackets from a hand that turns by 0 to 2 degrees"
GOALS = (at_least(WITHIN, 95), at_most(SILENT, 0), at_most(STILL_CPU, 1.5))
ROWS = (
    *(
        Experiment(
            f"align-brackets-{name.split()[-1].lower()}",
            f"{TITLE}; {name}",
            partial(measure_brackets, name=name),
            GOALS if name == "auto" else (),
        )
        for name in PROGRAMS
    ),
    Experiment(
        "align-brackets-third-of-a-degree",
        "4 brackets from a hand that turns by 0.3 degrees; auto",
        partial(measure_brackets, name="auto", degrees=(0.3,)),
        (at_least(WITHIN, 95), at_most(SILENT, 0)),
    ),
    Experiment(
        "align-brackets-fresh",
        f"{FRESH_COUNT} brackets that --seed draws; auto",
        partial(measure_fresh_brackets, name="auto"),
        GOALS,
        has_seed=True,
    ),
    *(
        Experiment(
            f"align-brackets-{size}",
            f"{len(LARGER_PLACES) * len(LARGER_DEGREES)} brackets of {shape[0] * shape[1] / 1e6:.0f} "
            "megapixels; auto",
            partial(
                measure_brackets,
                name="auto",
                degrees=LARGER_DEGREES,
                places=LARGER_PLACES,
                shape=shape,
            ),
            GOALS,
        )
        for size, shape in LARGER_SHAPES.items()
    ),
)
