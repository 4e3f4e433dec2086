"""How true a map's standard deviation is: of 95 % intervals, how many hold the truth, and how wide they are.

inside   share of the measured pixels within 1.96 s of the true radiance, of all brackets together, percent
width    s over the Cramer-Rao bound, 1 / sqrt(sum 1 / V) with V of the true light: median over the brackets
noise    electrons found over those that were: quartiles of the brackets; rounding hides those of some
error    root mean square of HDRutils' estimator [Hanji20], sum X / sum t, over that of the mean by inverse
         variance, RAW of 16 bits: median; and the least z of a bracket, by how many standard errors its mean
         square is greater: of 400 equal ones, chance makes one -3

Cameras: all of Grossberg and Nayar's 201 curves, twice; nothing here was fitted to them. Scenes: the embedded
ones, green, at 240 x 360 pixels, in turn. Photographs: three to seven of 8 bits, 1.2 to 2.3 stops apart, a
well of 2 000 to 50 000 electrons and read noise of 1 to 20, drawn with the bracket's number.

chi2     of real brackets, green, by the noise found in them: squares of X / t - E over variance + (rho E)^2,
         per degree of freedom. Asked are flat parts that two frames measure and where nothing moved, less the
         hundredth of the pixels that differs most. 1 is what the model says; a camera that smooths or
         sharpens before it writes JPEG, or a scanned film, need not keep to it

Three ways: the sensor known; its noise found in the photographs; and the response found in them, too.
Figures by decades below the brightest light, 0 to 5.
"""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from benchmarks.experiments import Experiment, Hold, along, at_least, at_most, real
from hdrlab import pipeline, scenes
from hdrlab.capture import camera, responses
from hdrlab.capture.responses import Curve
from hdrlab.cli.photographs import read_bracket
from hdrlab.core import weights
from hdrlab.core.bracket import Bracket
from hdrlab.diagnostics.noise import FLAT, Noise, estimate_noise, slope
from hdrlab.fast.merge import merge_with_quality
from hdrlab.io.emor import read_curves
from hdrlab.pipeline import recovery
from hdrlab.radiance.uncertainty import merge_with_deviation, variance
from hdrlab.response import families

Float = NDArray[np.float64]
PLACES = (scenes.chapel, scenes.workshop, scenes.street, scenes.room)
WAYS = ("sensor known", "noise found", "response found, too")
DECADES = range(6)
BRACKETS = ("window", "stlouis_arch", "frobisher", "memorial")
LEAST = 200  # pixels of a bracket that make a median


def decade(E: Float) -> NDArray[np.intp]:
    """Return how many whole decades each pixel lies below the brightest."""
    return np.floor(np.log10(np.quantile(E, 0.999) / E).clip(0)).astype(np.intp)


def bound(Z: Float, t: Float, g: Float, light: Float, noise: Noise) -> Float:
    """Return the Cramer-Rao bound of each pixel, where a frame measures it: of the true light."""
    D = np.gradient(np.exp(g))[Z.astype(np.intp)]
    t = t[:, None, None]
    measured = (Z > 0) & (Z < int(0.98 * (len(g) - 1)) + 1)
    V = np.where(measured, variance(light * t, D, *noise[:2]) / t**2, np.inf)
    with np.errstate(divide="ignore"):
        return np.asarray(np.sum(1 / V, axis=0) ** -0.5, np.float64)


def figures(case: tuple[int, Float, Float]) -> tuple[Float, Float, float, Float]:
    """Return by way and decade the counts (2, 3, 6) and widths (3, 6); the noise found, and `raw_errors`."""
    i, exposure, brightness = case
    rng = np.random.default_rng((22, i))
    E = np.maximum(PLACES[i % 4]((240, 360))[..., 1].astype(np.float64), 1e-9)
    well, read = np.exp(rng.uniform(np.log([2e3, 1]), np.log([5e4, 20])))
    frames, stops = int(rng.integers(3, 8)), rng.uniform(1.2, 2.3)
    times, own = camera.times_around(E, frames, stops=stops), decade(E)

    def shot(response: Curve | str, bits: int) -> Bracket:
        maker = camera.Camera(response=response, bits=bits, full_well=well, read_noise=read)
        return camera.shoot(E, times, maker, rng=rng)

    taken = shot(lambda X: np.interp(X, exposure, brightness), 8)
    Z, t = taken.images, taken.times
    true_g = families.invert_curves(exposure, brightness)[0]
    whole = float(np.exp(true_g[-1]))  # the exposure of a full well
    known = Noise(*(np.array([one]) for one in (well / whole, read, 0.0)))
    counts, widths = np.zeros((2, len(WAYS), len(DECADES))), np.full((len(WAYS), len(DECADES)), np.nan)
    floor = bound(Z, t, true_g, whole * E, known)
    found_noise = np.nan
    for way in range(len(WAYS)):
        g, noise = true_g, known
        if way == 2:
            g = recovery.find_response("auto", recovery.choose_response("auto", taken), taken)[0]
        if way:
            m = merge_with_quality(Z, t, g, weights.gaussian()).E
            noise = estimate_noise(Z, t, g, m)
            found_noise = float(noise.N[0] * whole / well) if way == 1 else found_noise
        map_, s = merge_with_deviation(Z, t, g, *noise)
        sure = np.isfinite(s) & np.isfinite(floor)
        unit = np.median(map_[sure] / (whole * E)[sure]) if way == 2 else 1.0
        inside = np.abs(map_ / unit - whole * E) < 1.96 * s / unit
        for d in DECADES:
            here = sure & (own == d)
            counts[:, way, d] = inside[here].sum(), here.sum()
            if here.sum() >= LEAST:
                widths[way, d] = np.median((s / unit)[here] / floor[here])
    return counts, widths, found_noise, raw_errors(shot("linear", 16), E, own, well, read)


def raw_errors(taken: Bracket, E: Float, own: NDArray[np.intp], well: float, read: float) -> Float:
    """Return by decade how far sum X / sum t errs, over the mean by inverse variance, and z: (2, 6)."""
    g = responses.true_g("linear", 65536)
    whole = float(np.exp(g[-1]))
    Z, t = taken.images, taken.times
    map_, s = merge_with_deviation(Z, t, g, well / whole, read)
    X, shown = np.exp(g)[Z] * (Z > 0), Z < int(0.98 * 65535) + 1
    peer = (X * shown).sum(axis=0) / np.maximum((t[:, None, None] * shown).sum(axis=0), 1e-12)
    found = np.full((2, len(DECADES)), np.nan)
    for d in DECADES:
        here = np.isfinite(s) & (own == d)
        if here.sum() >= LEAST:
            peers, ours = ((one / whole - E)[here] ** 2 for one in (peer, map_))
            more = peers - ours
            z = more.mean() / max(more.std(), 1e-30) * np.sqrt(more.size)
            found[:, d] = np.sqrt(peers.mean() / ours.mean()), z
    return found


def compared(folder: Path) -> Mapping[str, ArrayLike]:
    """Return inside and width of each way by decade, the noise found, and the errors."""
    exposure, brightness = read_curves(real(folder, "crf_curves") / "dorf_201.npz")
    cases = [(i, exposure[i % 201], brightness[i % 201]) for i in range(402)]
    counts, widths, noise, errors = (
        np.array(one) for one in zip(*along(figures, cases, "brackets"), strict=True)
    )
    inside, pixels = counts.sum(axis=0)
    found: dict[str, ArrayLike] = {}
    for k, way in enumerate(WAYS):
        found[f"inside, {way}"] = 100 * inside[k] / np.maximum(pixels[k], 1)
        found[f"width, {way}"] = np.nanmedian(widths[:, k], axis=0)
    found["noise"] = np.quantile(noise, [0.25, 0.5, 0.75])
    for d in DECADES:
        ratio, z = errors[:, :, d].T
        found[f"error, {d} decades below"] = np.nanmedian(ratio), np.nanmin(z)
    return found


def chi_square(taken: Bracket) -> float:
    """Return chi-square per degree of freedom of the green channel of a bracket's flat parts."""
    state = pipeline.measure_deviation(pipeline.assemble(taken))
    images, t = state.bracket.images[..., 1], state.bracket.times[:, None, None]
    noise = estimate_noise(state.bracket.images, t.ravel(), state.g, state.E)
    g, E = np.reshape(state.g, (256, -1))[:, min(1, state.g.ndim - 1)], state.E[..., 1].astype(np.float64)
    X, N, R, rho = np.exp(g), *(one[1] for one in noise)
    V = variance(E * t, np.gradient(X)[images], N, R) / t**2 + (rho * E) ** 2
    steep = np.pad(slope(E), 2, constant_values=np.inf)
    flat = (steep <= np.quantile(steep, FLAT)) & np.isfinite(state.s[..., 1])
    w = np.where((images > 0) & (images < int(0.98 * 255) + 1) & flat, 1 / V, 0)
    twice = np.count_nonzero(w, axis=0) > 1
    w, x = w[:, twice], (X[images] / t)[:, twice]
    mean = (w * x).sum(axis=0) / w.sum(axis=0)
    each = (w * (x - mean) ** 2).sum(axis=0) / (np.count_nonzero(w, axis=0) - 1)
    return float(each[each <= np.quantile(each, 0.99)].mean())


def explained(folder: Path) -> Mapping[str, ArrayLike]:
    """Return chi-square per degree of freedom of each real bracket."""
    found: dict[str, ArrayLike] = {}
    for name in BRACKETS:
        suffixes = (".jpg", ".jpeg", ".png")
        files = tuple(sorted(one for one in real(folder, name).iterdir() if one.suffix in suffixes))
        taken = read_bracket(files, "exif", "0000FF" if name == "memorial" else None, None)
        found[f"chi2, {name}"] = chi_square(taken)
    return found


def _true(way: str) -> tuple[Hold, Hold]:
    """Hold 93 to 97 % inside, and at most 1.2 times the bound, in every decade."""
    count = len(DECADES)
    inside = Hold(f"inside, {way}", (93.0,) * count, (97.0,) * count, "93 to 97, each")
    return inside, at_most(f"width, {way}", *[1.2] * count)


ROWS = (
    Experiment(
        "uncertainty",
        "95 % intervals of radiance, 402 brackets of measured cameras; by decades below the brightest",
        compared,
        (
            *(hold for way in WAYS for hold in _true(way)),
            *(at_least(f"error, {d} decades below", 1.0, -4.0) for d in DECADES),
        ),
    ),
    Experiment(
        "real",
        "real brackets: what the photographs differ by, over what the noise found in them says",
        explained,
        tuple(Hold(f"chi2, {name}", (0.8,), (1.25,), "0.8 to 1.25") for name in BRACKETS),
    ),
)
