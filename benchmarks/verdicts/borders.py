"""Does hdrlab claim the opposite on the other side of a border between two verdicts?

A series makes brackets that differ in one number, the strength of an ill. Where the blamed causes of
two strengths differ, bisection finds two neighboring strengths whose verdicts differ. There, the
photos are taken again with light that differs by a millionth from pixel to pixel, and each verdict
is compared with the others: `claims.contradict`.

The millionth changes the pixel values, and not the light that the simulated camera receives: the
number of random values that NumPy draws for a Poisson distribution depends on its mean, so the
slightest change of the light would give all following pixels other noise.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.ndimage import gaussian_filter

from benchmarks.experiments import along
from benchmarks.verdicts import brackets, ills
from benchmarks.verdicts.bands import print_bands
from benchmarks.verdicts.brackets import Float, Ill, Plan
from benchmarks.verdicts.claims import blamed_causes, contradict
from hdrlab import pipeline
from hdrlab.core.arrays import Array, ArrayLike
from hdrlab.errors import InputError

# relative noise of the light
NOISE = 1e-6
# Such noise moves a pixel value of 8 bits across a border of rounding with at most this probability.
CHANGED_FRACTION = 255 * NOISE
# steps of the bisection between two strengths, and repetitions on each side of the border
BISECTIONS = 7
REPETITIONS = 3
REFUSED = frozenset({"refused"})
Draw = np.random.Generator


@dataclass(frozen=True, kw_only=True)
class Series:
    """Brackets of one plan, whose ill has a strength from `weak` to `strong`."""

    name: str
    plan: int
    weak: float
    strong: float
    make_ill: Callable[[float], Ill]


def state_wrong_time(factor: float) -> Ill:
    """Return the ill of one time that is stated too long by a factor."""

    def times(plan: Plan, t: Float) -> Float:
        stated = t.copy()
        stated[plan.one] *= factor
        return np.asarray(stated)

    return Ill("one time is wrong", times=times)


def brighten_a_half(stops: float) -> Ill:
    """Return the ill of light that differs by some stops in the right half of one photo."""

    def light(plan: Plan, j: int, rng: Draw, E: Array) -> Array:
        lit = E.copy()
        if j == plan.one:
            lit[:, E.shape[1] // 2 :] *= np.float32(2**stops)
        return lit

    return Ill("the light changed in parts of the image", light=light)


def change_balance(stops: float) -> Ill:
    """Return the ill of another white balance in one photo."""

    def light(plan: Plan, j: int, rng: Draw, E: Array) -> Array:
        gains = np.array([2**stops, 1, 2**-stops], np.float32)
        return np.asarray(E * gains) if j == plan.one else E

    return Ill("white balance", light=light)


def darken_corners(loss: float) -> Ill:
    """Return the ill of corners that lose more light in each photo."""

    def light(plan: Plan, j: int, rng: Draw, E: Array) -> Array:
        y, x = np.indices(E.shape[:2]) / (np.array(E.shape[:2])[:, None, None] - 1) * 2 - 1
        lost = loss * j / (plan.frames - 1) * (x**2 + y**2) / 2
        return np.asarray(E * (1 - lost)[..., None], np.float32)

    return Ill("vignetting", light=light)


def flicker(size: float) -> Ill:
    """Return the ill of lamps that flicker in bands, with a wrong total light."""

    def light(plan: Plan, j: int, rng: Draw, E: Array) -> Array:
        gain = 2 ** (rng.uniform(-1, 1) * size)
        rows = np.sin(2 * np.pi * (np.arange(E.shape[0]) / E.shape[0] * 3 + rng.uniform()))
        return np.asarray(E * gain * (1 + 0.3 * size * rows)[:, None, None], np.float32)

    return Ill("flicker", light=light)


def blow_leaves(size: float) -> Ill:
    """Return the ill of leaves that move, with a part of their contrast, under flickering lamps."""

    def light(plan: Plan, j: int, rng: Draw, E: Array) -> Array:
        moved = ills.blow(plan, j, rng, E)
        changed = E * (moved / np.maximum(E, 1e-9)) ** np.float32(size)
        rows = np.sin(2 * np.pi * (np.arange(E.shape[0]) / E.shape[0] * 3 + j / 3))
        return np.asarray(changed * (1 + 0.12 * rows)[:, None, None], np.float32)

    return Ill("leaves under flickering lamps", light=light)


def map_tones(strength: float) -> Ill:
    """Return the ill of tones that the camera maps by place, and one time that is wrong."""

    def levels(plan: Plan, j: int, rng: Draw, Z: Array) -> Array:
        sigma = Z.shape[1] / 20
        L = gaussian_filter(Z.mean(axis=-1) + 1, (sigma, sigma))
        return np.clip(np.rint(Z * (L[..., None] / 128) ** -strength), 0, 255).astype(np.uint8)

    return Ill("local tone mapping", levels=levels, times=state_wrong_time(1.5).times)


SERIES = (
    Series(name="wrong time", plan=2, weak=1.1, strong=3.0, make_ill=state_wrong_time),
    Series(
        name="wrong time, three photos", plan=4, weak=1.02, strong=3.0, make_ill=state_wrong_time
    ),
    Series(name="a half is brighter", plan=2, weak=0.02, strong=1.0, make_ill=brighten_a_half),
    Series(name="white balance", plan=2, weak=0.05, strong=0.7, make_ill=change_balance),
    Series(name="vignetting", plan=6, weak=0.01, strong=0.5, make_ill=darken_corners),
    Series(name="flicker", plan=3, weak=0.02, strong=0.6, make_ill=flicker),
    Series(name="leaves and flicker", plan=3, weak=0.0, strong=1.0, make_ill=blow_leaves),
    Series(
        name="tones by place and a wrong time", plan=2, weak=0.0, strong=0.4, make_ill=map_tones
    ),
)


def judge(series: Series, strength: float, folder: Path, noise_seed: int | None) -> frozenset[str]:
    """Return the causes that hdrlab blames for a bracket of a series."""
    ill = series.make_ill(strength)
    if noise_seed is not None:
        ill = add_noise(ill, noise_seed)
    taken = brackets.shoot(brackets.plan(folder, series.plan), ill)
    try:
        return blamed_causes(pipeline.assemble(taken))
    except InputError:
        return REFUSED


def add_noise(ill: Ill, seed: int) -> Ill:
    """Return an ill with photos that differ as if the light differed by a millionth."""

    def levels(plan: Plan, j: int, rng: Draw, Z: Array) -> Array:
        noise = np.random.default_rng((seed, j))
        is_changed = noise.random(Z.shape) < CHANGED_FRACTION
        changed = Z + is_changed * noise.choice([-1, 1], Z.shape)
        return ill.levels(plan, j, rng, np.clip(changed, 0, 255).astype(np.uint8))

    return ill._replace(levels=levels)


@dataclass(frozen=True, kw_only=True)
class BorderResult:
    """What hdrlab blames on both sides of a border, and how many repetitions differ."""

    series: str
    strength: float
    below: frozenset[str]
    above: frozenset[str]
    flips: int
    opposites: int


def try_series(item: tuple[int, Path]) -> list[BorderResult]:
    """Return the result at each border of a series that five strengths show."""
    number, folder = item
    series = SERIES[number]
    strengths = np.linspace(series.weak, series.strong, 5)
    blamed = [judge(series, strength, folder, None) for strength in strengths]
    return [
        _try_border(series, strengths[k], strengths[k + 1], blamed[k], folder)
        for k in range(len(strengths) - 1)
        if blamed[k] != blamed[k + 1]
    ]


def _try_border(
    series: Series, low: float, high: float, below: frozenset[str], folder: Path
) -> BorderResult:
    above = judge(series, high, folder, None)
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        found = judge(series, middle, folder, None)
        if found == below:
            low = middle
        else:
            high = middle
            above = found
    repeated = [
        judge(series, strength, folder, seed)
        for strength in (low, high)
        for seed in range(REPETITIONS)
    ]
    expected = [below] * REPETITIONS + [above] * REPETITIONS
    all_blamed = [below, above, *repeated]
    return BorderResult(
        series=series.name,
        strength=(low + high) / 2,
        below=below,
        above=above,
        flips=sum(a != b for a, b in zip(repeated, expected, strict=True)),
        opposites=sum(contradict(a, b) for a in all_blamed for b in all_blamed) // 2,
    )


def try_borders(folder: Path) -> Mapping[str, ArrayLike]:
    """Return how often a verdict flips at a border, and how often into its opposite."""
    print_bands()
    items = [(number, folder) for number in range(len(SERIES))]
    results = [result for found in along(try_series, items, "borders") for result in found]
    for result in results:
        below = " or ".join(sorted(result.below)) or "nothing"
        above = " or ".join(sorted(result.above)) or "nothing"
        print(
            f"  {result.series}, {result.strength:.4g}: {below} | {above}; "
            f"{result.flips} of {2 * REPETITIONS} flip, {result.opposites} opposites",
            flush=True,
        )
    return {
        "borders": len(results),
        "flips": sum(result.flips for result in results),
        "opposite verdicts": sum(result.opposites for result in results),
    }
