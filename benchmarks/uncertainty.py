"""How true a map's standard deviation is: of 95 % intervals, how many hold the truth, and how wide they are.

inside   share of the measured pixels within 1.96 s of the true radiance, of all brackets together, percent
width    s over the Cramer-Rao bound, 1 / sqrt(sum 1 / V) with V of the true light: median over the brackets
noise    electrons found over those that were: quartiles of the brackets; rounding hides those of some
unsure   noise found: of the pixels that a camera without noise would measure, the share that the map calls
         unmeasured (false alarms); of those that it would clip in every photograph, and of those
         that it would call 0 in every one, the share that the map gives a deviation (misses),
         percent
levels   response found: share of the cameras whose curve lies within 1.96 rho of the true one, by tenths of
         the levels 5 to 250. It is no 95 %, and `hdrlab calibrate` prints no such band
error    root mean square of HDRutils' estimator [Hanji20], sum X / sum t, over that of the mean by inverse
         variance, RAW of 16 bits: median; and the least z of a bracket, by how many standard errors
         its mean square is greater: of 400 equal ones, chance makes one -3

Cameras: all of Grossberg and Nayar's 201 curves, twice; nothing here was fitted to them. Scenes:
the embedded ones, green, at 240 x 360 pixels, in turn. Photographs: three to seven of 8 bits, 1.2
to 2.3 stops apart, a well of 2 000 to 50 000 electrons and read noise of 1 to 20, drawn with the
bracket's number.

chi2     of real brackets, green, by the noise found in them: squares of X / t - E over variance + (rho E)^2,
         per degree of freedom. Asked are flat parts that two frames measure and where nothing
         moved, less the hundredth of the pixels that differs most. 1 is what the model says; a
         camera that smooths or sharpens before it writes JPEG, or a scanned film, need not keep to
         it
chance   the same without rho, where from each photograph its mean over pixels of like light is taken away:
         what differs from pixel to pixel. So chi2 of `window` is no noise that was not found: its
         camera bends the curve a little from photograph to photograph, for all pixels of a light
         alike. What is left of `memorial`, scanned film, is shared by neighbours, a third to a half
         of it over eight pixels

Three ways: the sensor known; its noise found in the photographs; and the response found in them,
too. Figures by decades below the brightest light, 0 to 5.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from benchmarks.experiments import Experiment, Hold, along, at_least, at_most, measured_curves, real
from hdrlab import pipeline, scenes
from hdrlab.capture import camera, responses
from hdrlab.capture.responses import Curve
from hdrlab.cli.brackets import read_bracket
from hdrlab.core import weights
from hdrlab.core.arrays import Array, ArrayLike, Mask, NDArray
from hdrlab.core.bracket import Bracket
from hdrlab.diagnostics.noise import FLAT_FRACTION, GROUP_COUNT, Noise, estimate_noise, slope
from hdrlab.fast.merge import merge_with_quality
from hdrlab.pipeline import recovery
from hdrlab.radiance.uncertainty import merge_with_deviation, variance
from hdrlab.response import families

Float = NDArray[np.float64]
PLACES = (scenes.chapel, scenes.workshop, scenes.street, scenes.room)
WAYS = ("sensor known", "noise found", "response found, too")
DECADES = range(6)
KINDS = ("false alarms", "misses, clipped", "misses, dark")
BRACKETS = ("window", "stlouis_arch", "frobisher", "memorial")
MIN_PIXELS_OF_A_MEDIAN = 200


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


def alarms(E: Float, t: Float, response: Curve, s: Array) -> Float:
    """Return counts (2, 3): of pixels measured, clipped, dark in truth, those the map says so of, and all."""
    Z = 255 * np.asarray(response(E * t[:, None, None]))
    known = np.isfinite(s)
    clipped = E * t.min() >= 1
    dark = np.all(Z < 0.5, axis=0)
    measured = np.any((Z >= 0.5) & (Z < int(0.98 * 255)), axis=0)
    kinds = ((measured, ~known), (clipped, known), (dark, known))
    return np.array(
        [[(kind & wrong).sum() for kind, wrong in kinds], [kind.sum() for kind, _ in kinds]], float
    )


def within(g: Array, true_g: Float, rho: float) -> Float:
    """Return by tenths of the levels the share of g that lies within 1.96 rho of the true one."""
    error = (np.reshape(g, (256, -1))[:, 0] - true_g)[5:251]
    near = np.abs(error - np.median(error)) < 1.96 * rho
    return np.array([part.mean() for part in np.array_split(near, 10)])


def figures(case: tuple[int, Float, Float]) -> tuple[Float, Float, float, Float, Float, Float]:
    """Return counts (2, 3, 6) and widths (3, 6) by way and decade; noise, errors, alarms, levels."""
    i, exposure, brightness = case
    rng = np.random.default_rng((22, i))
    E = np.maximum(PLACES[i % 4]((240, 360))[..., 1].astype(np.float64), 1e-9)
    well, read = np.exp(rng.uniform(np.log([2e3, 1]), np.log([5e4, 20])))
    frames = int(rng.integers(3, 8))
    stops = rng.uniform(1.2, 2.3)
    times = camera.times_around(E, frames, stops=stops)
    own = decade(E)

    def shot(response: Curve | str, bits: int) -> Bracket:
        maker = camera.Camera(response=response, bits=bits, full_well=well, read_noise=read)
        return camera.shoot(E, times, maker, rng=rng)

    def own_curve(X: Float) -> Float:
        return np.asarray(np.interp(X, exposure, brightness), np.float64)

    taken = shot(own_curve, 8)
    Z = taken.images
    t = taken.times
    true_g = families.invert_curves(exposure, brightness)[0]
    whole = float(np.exp(true_g[-1]))  # the exposure of a full well
    known = Noise(*(np.array([value]) for value in (well / whole, read, 0.0)))
    counts = np.zeros((2, len(WAYS), len(DECADES)))
    widths = np.full((len(WAYS), len(DECADES)), np.nan)
    floor = bound(Z, t, true_g, whole * E, known)
    for way in range(len(WAYS)):
        g = true_g
        noise = known
        if way == 2:
            g = recovery.find_response("auto", recovery.choose_response("auto", taken), taken).g
        if way:
            m = merge_with_quality(Z, t, g, weights.gaussian()).E
            noise = estimate_noise(Z, t, g, m)
        map_, s = merge_with_deviation(Z, t, g, *noise)
        if way == 1:
            found_noise = float(noise.N[0] * whole / well)
            unsure = alarms(E, t, own_curve, s)
        sure = np.isfinite(s) & np.isfinite(floor)
        unit = np.median(map_[sure] / (whole * E)[sure]) if way == 2 else 1.0
        inside = np.abs(map_ / unit - whole * E) < 1.96 * s / unit
        for d in DECADES:
            here = sure & (own == d)
            counts[:, way, d] = inside[here].sum(), here.sum()
            if here.sum() >= MIN_PIXELS_OF_A_MEDIAN:
                widths[way, d] = np.median((s / unit)[here] / floor[here])
    errors = raw_errors(shot("linear", 16), E, own, well, read)
    return counts, widths, found_noise, errors, unsure, within(g, true_g, float(noise.rho[0]))


def raw_errors(taken: Bracket, E: Float, own: NDArray[np.intp], well: float, read: float) -> Float:
    """Return by decade how far sum X / sum t errs, over the mean by inverse variance, and z: (2, 6)."""
    g = responses.true_g("linear", 65536)
    whole = float(np.exp(g[-1]))
    Z = taken.images
    t = taken.times
    map_, s = merge_with_deviation(Z, t, g, well / whole, read)
    X = np.exp(g)[Z] * (Z > 0)
    shown = Z < int(0.98 * 65535) + 1
    peer = (X * shown).sum(axis=0) / np.maximum((t[:, None, None] * shown).sum(axis=0), 1e-12)
    errors = np.full((2, len(DECADES)), np.nan)
    for d in DECADES:
        here = np.isfinite(s) & (own == d)
        if here.sum() >= MIN_PIXELS_OF_A_MEDIAN:
            peers = (peer / whole - E)[here] ** 2
            ours = (map_ / whole - E)[here] ** 2
            more = peers - ours
            z = more.mean() / max(more.std(), 1e-30) * np.sqrt(more.size)
            errors[:, d] = np.sqrt(peers.mean() / ours.mean()), z
    return errors


def compared(folder: Path) -> Mapping[str, ArrayLike]:
    """Return inside and width of each way by decade, the noise found, and the errors."""
    exposure, brightness = measured_curves(folder)
    cases = [(i, exposure[i % 201], brightness[i % 201]) for i in range(402)]
    columns = [np.array(values) for values in zip(*along(figures, cases, "brackets"), strict=True)]
    counts, widths, noise, errors, unsure, levels = columns
    inside, pixels = counts.sum(axis=0)
    summary: dict[str, ArrayLike] = {}
    for k, way in enumerate(WAYS):
        summary[f"inside, {way}"] = 100 * inside[k] / np.maximum(pixels[k], 1)
        summary[f"width, {way}"] = np.nanmedian(widths[:, k], axis=0)
    summary["noise"] = np.quantile(noise, [0.25, 0.5, 0.75])
    wrong, all_ = unsure.sum(axis=0)
    for kind, values in zip(
        ("false alarms", "misses, clipped", "misses, dark"), 100 * wrong / all_, strict=True
    ):
        summary[f"unsure, {kind}"] = values
    summary["levels"] = 100 * levels.mean(axis=0)
    for d in DECADES:
        ratio, z = errors[:, :, d].T
        summary[f"error, {d} decades below"] = np.nanmedian(ratio), np.nanmin(z)
    return summary


def chi_square(taken: Bracket) -> Iterator[float]:
    """Yield chi-square per degree of freedom of flat green parts: with all that errs, and by chance."""
    state = pipeline.measure_deviation(pipeline.assemble(taken))
    if state.s is None:
        raise RuntimeError("the standard deviation was not measured")
    images = state.bracket.images[..., 1]
    t = state.bracket.times[:, None, None]
    noise = estimate_noise(state.bracket.images, t.ravel(), state.g, state.E)
    g = np.reshape(state.g, (256, -1))[:, min(1, state.g.ndim - 1)]
    E = state.E[..., 1].astype(np.float64)
    X = np.exp(g)
    N = noise.N[1]
    R = noise.R[1]
    rho = noise.rho[1]
    V = variance(E * t, np.gradient(X)[images], N, R) / t**2
    steep = np.pad(slope(E), 2, constant_values=np.inf)
    flat = (steep <= np.quantile(steep, FLAT_FRACTION)) & np.isfinite(state.s[..., 1])
    measured = (images > 0) & (images < int(0.98 * 255) + 1) & flat
    twice = np.count_nonzero(measured, axis=0) > 1
    measured = measured[:, twice]
    x = (X[images] / t)[:, twice]
    V = V[:, twice]
    E = E[twice]
    yield scattered(x, V + (rho * E) ** 2, measured)
    for alike in np.array_split(np.argsort(E), GROUP_COUNT):
        share = np.where(measured, x / E, np.nan)[:, alike]
        x[:, alike] -= (np.nan_to_num(np.nanmean(share, axis=1, keepdims=True), nan=1.0) - 1) * E[
            alike
        ]
    yield scattered(x, V, measured)


def scattered(x: Float, V: Float, measured: Mask) -> float:
    """Return the mean over the pixels of sum (x - mean)^2 / V over degrees of freedom, less the farthest."""
    w = np.where(measured, 1 / V, 0)
    mean = (w * x).sum(axis=0) / w.sum(axis=0)
    variance = (w * (x - mean) ** 2).sum(axis=0) / (np.count_nonzero(w, axis=0) - 1)
    return float(variance[variance <= np.quantile(variance, 0.99)].mean())


def explained(folder: Path) -> Mapping[str, ArrayLike]:
    """Return chi-square per degree of freedom of each real bracket."""
    summary: dict[str, ArrayLike] = {}
    for name in BRACKETS:
        suffixes = (".jpg", ".jpeg", ".png")
        files = tuple(
            sorted(file for file in real(folder, name).iterdir() if file.suffix in suffixes)
        )
        taken = read_bracket(
            files, "exif", "0000FF" if name == "memorial" else None, None, note=print, detail=print
        )
        summary[f"chi2, {name}"], summary[f"chance, {name}"] = chi_square(taken)
    return summary


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
            *(
                at_most(f"unsure, {kind}", most)
                for kind, most in zip(KINDS, (2.0, 10.0, 10.0), strict=True)
            ),
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
