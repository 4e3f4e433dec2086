"""Sentences of notebooks that state a number: each is in its notebook, and the number is right.

SENTENCES has, for each notebook, a sentence or the part of it that could become false, and a function
that checks it. The function gets the variables of the notebook, in the kernel that ran it (see
support/executed_notebooks.py). A number is right if it rounds to the digits of the sentence.
"""

import contextlib
import io
import json
import warnings
from types import SimpleNamespace

import numpy as np
import pytest
from ipywidgets.widgets import widget
from scipy.ndimage import binary_dilation, distance_transform_edt, uniform_filter
from scipy.stats import chi2, spearmanr
from test_notebooks import NOTEBOOKS

from hdrlab.align import mtb
from hdrlab.capture import camera, ranges, responses
from hdrlab.core import metrics
from hdrlab.fast import debevec as fast_debevec
from hdrlab.radiance import flare
from hdrlab.radiance.merge import Quality
from hdrlab.response import debevec
from hdrlab.show.widgets import Tuner, tune


def off(g, truth):
    """Return how far a response is off, in percent of the exposure of level 250."""
    return metrics.response_rmse(g, truth)[0]


def worst(g, truth, low=5, high=250):
    """Return by how many stops a response is off at most, between two levels."""
    return np.abs(g - truth)[low : high + 1].max() / np.log(2)


def misfit_of_times(n, ln_times):
    """Return how far samples of notebook 04 lie from their curve with these times, as a share of a step."""
    Z = n.sampling.by_grid(n.frames, 400)
    g, lE = n.fast.gsolve(Z, ln_times, 30, n.weights.hat())
    residual = np.abs(g[Z] - lE[:, None] - ln_times)[(Z > 20) & (Z < 235)]
    return np.median(residual) / np.mean(np.diff(ln_times))


def share_of_period(n, g, period):
    """Return which share of the variance of g's error repeats with a period in stops."""
    stops = n.responses.true_g()[10:246] / np.log(2)
    error = g[10:246] / np.log(2) - stops
    phase = np.digitize(stops % period, np.linspace(0, period, 11))
    repeated = np.array([error[phase == k].mean() for k in phase])
    return 1 - np.var(error - repeated) / np.var(error)


def walls_over_glass(n, Ld):
    """Return how bright the walls of the tone-mapped chapel are, as a share of its brightest 3 %."""
    walls = np.median(Ld[np.quantile(n.L, 0.9) > n.L])
    return walls / np.median(Ld[np.quantile(n.L, 0.97) < n.L])


def ripple_kept(n, sigma_r):
    """Return which share of the ripple of notebook 15 the bilateral filter leaves in the base."""
    flat = slice(20, 80)
    base = n.grid.bilateral(n.step, sigma_s=8, sigma_r=sigma_r).mean
    return float(base[25, flat].std() / n.step[25, flat].std())


def ripple_kept_by_guided(n, epsilon):
    """Return which share of the ripple of notebook 15 the guided filter leaves far from the step."""
    flat = slice(30, 70)
    base = n.guided.guided(n.step, radius=8, epsilon=epsilon)
    return float(base[25, flat].std() / n.step[25, flat].std())


def change(n, **widths):
    """Return by how many stops other widths of the filter change the image of page 15, on average."""
    images = (np.maximum(n.tonemapped(**each), 1e-3) for each in (widths, {}))
    return float(np.abs(np.subtract(*map(np.log2, images))).mean())


def darkening_by_blur(n, near, far):
    """Return by how many stops a blur as base darkens the wall of page 15, so far from the window."""
    window = np.zeros(n.lL.shape, bool)
    window[60:130, 122:248] = True
    distance = distance_transform_edt(~window)
    wall = (distance > near) & (distance <= far) & (n.lL < 2.2)
    blurred = n.blur.gaussian(n.lL, n.durand.SIGMA_S_FRACTION * max(n.L.shape))
    images = (np.maximum(n.with_base(each), 1e-3) for each in (n.base, blurred))
    return float(np.subtract(*map(np.log2, images))[wall].mean())


def sweeps_of_a_step(n, width):
    """Return how many sweeps of page 17 spread half of a difference between both sides of a row."""
    solution = np.where(np.arange(width) < width / 2, -1.0, 1.0) * np.ones((2, 1))
    right_side = n.poisson.laplacian(solution)
    u = np.zeros_like(solution)
    count = 0
    while np.std(u - solution) > 0.5 * np.std(solution):
        u = u + (n.poisson.laplacian(u) - right_side) / 5
        count += 1
    return count


def many_samples_change(n, alpha):
    """Return by how much more values of g change the image of page 17 at most, 1 = white."""
    few = n.filtered(alpha=alpha, samples=24)[0]
    return float(np.abs(few - n.filtered(alpha=alpha, samples=96)[0]).max())


def filled_from_reference_alone(n):
    """Return which share of the moving pixels that the reference of notebook 24 lacks nothing else fills."""
    result = n.ghosts.remove_ghosts(n.three, n.times, n.g, fixed=1)
    lacking = (result.labels > 0) & (n.alpha() < 0.01)
    return np.mean(result.used.sum(axis=0)[lacking] == 1)


def percentile_of_darkest(n):
    """Return the percentile of the threshold by which the two darkest photos of notebook 00 are compared."""
    grays = [mtb.gray(image) for image in n.bracket.images[:2]]
    return mtb.percentile(*(np.bincount(Y.ravel(), minlength=256) for Y in grays))


def median_alone_fails(n):
    """Return whether Ward's median shifts the darkest photo of notebook 00 wrongly, and hdrlab does not."""
    offset = n.shaken[0].tolist()
    by_median = mtb.align(n.bracket.images)[0].tolist()
    return by_median != offset and n.aligned.offsets[0].tolist() == offset


def shaken_error(n, radius, count, stops):
    """Return by how many stops the curve of notebook 02 is off without alignment."""
    found = n.shaken(radius, count, stops)
    return worst(found.shot, found.truth, 10)


def few_steps_or_many(n, rng):
    """Return the error of seven photos one stop apart over that of three, three stops apart."""
    E = n.colour.luminance(n.WORKSHOP)
    truth = responses.true_g()
    errors = []
    for count, stops in ((7, 1.0), (3, 3.0)):
        offsets = camera.shake(count, radius=6, rng=rng)
        times = camera.times_around(E, count, stops=stops)
        noisy = camera.Camera(full_well=20_000, read_noise=5)
        shots = camera.shoot(E, times, noisy, offsets=offsets, rng=rng)
        errors.append(
            worst(fast_debevec.recover(shots.images, shots.times, samples=500), truth, 10)
        )
    return errors[0] / errors[1]


def plan_with(n, **changed):
    """Return the plan by noise of page 02 for a ratio of 10, with another camera."""
    return n.planning.plan_by_noise(n.LOW, n.HIGH, 10, n.MAKER._replace(**changed))


def plan_at_iso_800(n):
    """Return the plan by noise of page 02 with ISO 800 alone, where an eighth of the well is full."""
    return plan_with(n, speeds=(800,), full_well=n.MAKER.full_well / 8, gain=n.MAKER.gain / 8)


def matrix_exposure(n, tolerance):
    """Return the exposure value of a matrix meter that distrusts zones beyond a tolerance in stops."""
    EV = 18.0
    for _ in range(8):
        B = n.autoexposure.measure_brightness(n.scene.E, EV)
        EV -= n.metering.correction(B, n.metering.matrix(B, tolerance=tolerance))
    return EV


def drifted(n, camera_number, count):
    """Return the mean error in percent of a camera of page 06 after many iterations."""
    iterations = n.mitsunaga.fit_steps(
        n.means[camera_number], [0.5, 0.5, 0.5], 5, eps=0, max_iterations=count
    )
    return n.ambiguity.mean_error(n.last(iterations).c[0], n.trials[camera_number].c)


def errors_with_and_without_u(n):
    """Return the median error in percent of the cameras of page 06, and that without the error in u."""
    errors = []
    for samples, trial in zip(n.means, n.trials, strict=True):
        fit = n.last(n.mitsunaga.fit_steps(samples, [0.5, 0.5, 0.5], 5))
        u = np.log(fit.R).mean() / np.log(trial.R).mean()
        truth = n.mitsunaga.value(n.z, trial.c)
        found = n.mitsunaga.value(n.z, fit.c[0])
        errors.append([np.abs(found - truth).mean(), np.abs(found - truth**u).mean()])
    return 100 * np.median(errors, axis=0)


def measured_well(n):
    """Return which pixels of the frames of page 06 are neither black nor white."""
    mean = n.still.mean(axis=0)
    return (mean > 0.05) & (mean < 0.98)


def noise_of_frames(n):
    """Return the standard deviation of a frame of page 06, where it is neither black nor white."""
    return n.still.std(axis=0, ddof=1)[measured_well(n)].mean()


def even_patches(frame, sigma):
    """Return where 5 x 5 pixels of a frame differ no more than noise of sigma, by chi-square."""
    mean = uniform_filter(frame, 5)
    squared = 25 * np.maximum(uniform_filter(frame**2, 5) - mean**2, 0)
    return squared <= chi2.isf(0.05, 24) * uniform_filter(sigma**2, 5)


def gray_error(n, falloff):
    """Return the RMSE in percent of the range of the curve from six grays on page 08."""
    found = n.both_ways(falloff)["six grays, one photo"]
    return 100 * n.blends.rmse(found, found._replace(X=n.film.inverse(found.M)))


def halo(n, base):
    """Return by how many stops the walls around the window of page 15 are brighter than Durand's."""
    window = np.zeros(n.lL.shape, bool)
    window[60:130, 122:248] = True
    near, far = (binary_dilation(window, iterations=count) for count in (24, 50))
    walls = far & ~near & (n.lL < 2.2)
    images = (np.maximum(n.with_base(each), 1e-3) for each in (base, n.base))
    return float(np.subtract(*map(np.log2, images))[walls].mean())


def guided_base(n, epsilon):
    """Return the base of the workshop by the guided filter of page 15."""
    return np.float32(n.guided.guided(n.lL, radius=16, epsilon=epsilon))


def patches_of_walker(n, field):
    """Return the share of the walker's patches that match the walker, and their mean distance, on page 24."""
    masks = [n.movers.shift_layer(n.small.mask, place) > 0.5 for place in n.strides]
    here = masks[2][2:-2, 2:-2]
    is_walker = masks[1][field.at[..., 1] + 2, field.at[..., 2] + 2]
    return is_walker[here].mean(), field.d[here].mean()


def rebuilt_from_empty_street(n):
    """Return the mean distance of the walker's patches from those of a photo without her, on page 24."""
    camera = n.camera.Camera(**n.WELL)
    empty = n.camera.shoot(n.small.radiance, n.times, camera, rng=1).images
    values = n.ldr_values.as_values(empty, n.times, n.g).v[1]
    source = n.ldr_values.boost(values, n.times[2] / n.times[1])
    Q = n.patchmatch.make_sources(source[None], 5)
    start = n.patchmatch.start_field(n.P, Q, n.random)
    search = n.patchmatch.search_steps(n.P, Q, start, radius=64, rng=np.random.default_rng(0))
    field = [next(search) for _ in range(5)][-1]
    return patches_of_walker(n, field)[1]


def darkening_by_walkers(n):
    """Return by how many stops each of the three walkers alone darkens the plain merge of page 24."""
    masks = [n.movers.shift_layer(n.small.mask, place) for place in n.strides]
    still = n.camera.shoot(n.small.radiance, n.times, n.camera.Camera(**n.WELL), rng=1).images
    stops = np.log2(n.E3["plain"] / n.merge.merge(still, n.times, n.g)).mean(axis=-1)
    found = []
    for k in range(3):
        others = np.max([mask for j, mask in enumerate(masks) if j != k], axis=0)
        found.append(-np.median(stops[(masks[k] > 0.5) & (others < 0.1)]))
    return found


def differ(n, width):
    """Return which share of the bits differ where levels within a width of the median are left out."""
    return (n.b[0] ^ n.b[1])[(n.far[0] > width) & (n.far[1] > width)].mean()


def quality(n, name):
    return n.quality.tmqi(n.L, n.changed[name])


def scores(n, metric="PU-PSNR", **settings):
    """Return the scores of the maps of notebook 18, best first."""
    return n.scores.score_maps(n.maps, n.truth, metric=metric, **settings)


def order(n, metric="PU-PSNR", **settings):
    """Return the names of the maps of notebook 18, best first."""
    return list(scores(n, metric, **settings))


def stops_until_white(n):
    """Return how many stops above AgX's white of gray the blue lamp of page 18 becomes white."""
    lamp = np.array([0.02, 0.1, 1.0])
    exposures = np.arange(6.5, 16, 0.01)
    light = 0.18 * 2.0 ** exposures[:, None] * lamp
    is_white = np.all(n.agx.view(light) > 1 - 1e-6, axis=-1)
    return float(exposures[np.argmax(is_white)] - 6.5)


def effect_of_padding(n):
    """Return by how much the naturalness of a small image depends on its incomplete blocks."""
    small = n.scenes.chapel((40, 60))
    picture = n.pipeline.develop(small, "reinhard")
    L = n.colour.luminance(small)
    return abs(n.quality.tmqi(L, picture, edge_blocks="pad").N - n.quality.tmqi(L, picture).N)


def fraction_of_the_error(n, mask):
    """Return which fraction of the squared error of the map from five photos is in a mask (h, w)."""
    squared = (n.five.astype(np.float64) - n.truth) ** 2
    return squared[mask].sum() / squared.sum()


def wrong_colors(n, order):
    """Return in which share of the pixels of notebook 26 an order gives a color half a stop off."""
    return np.mean(np.abs(n.errors[n.ORDERS[order]]) > 0.5)


SENTENCES = {
    "00": {
        "Here are seven photos, two stops apart": lambda n: apart(n.times, 7, 2),
        "each stop is a step of the same size, 0.7": lambda n: round(float(np.log(2)), 1) == 0.7,
        "Sky and corners lie about sixteen stops apart": lambda n: round(float(n.stops)) == 16,
        "differs from the ratio above by less than a percent": lambda n: (
            abs(n.high / n.low / 2**n.stops - 1) < 0.01
        ),
        "In the darkest photo half of them are black or nearly black": lambda n: (
            np.median(n.bracket.images[0]) < mtb.NOISE
        ),
        "so hdrlab uses a higher threshold": lambda n: (
            median_alone_fails(n) and percentile_of_darkest(n) > 0.5
        ),
        "In this map, hdrlab finds none": lambda n: flare.remove_glare(n.real.E).spread.share == 0,
    },
    "01": {
        "a read noise of 5 electrons, and a converter of 12 bits with 5 electrons per level": lambda n: (
            (n.GOOD.read_noise, n.GOOD.bits, n.GOOD.gain) == (5, 12, 5)
        ),
        "Give the converter only eight levels": lambda n: 2**n.COARSE.bits == 8,
        "The noise is 5 levels": lambda n: round(n.darkness(64).std()) == 5,
        "8, 12 or 17?": lambda n: round(float(np.log2(n.L.max() / n.L.min()))) == 17,
        "With 10 bits a level is 21 electrons wide, and its rounding error of 6 electrons": lambda n: (
            round(20_000 / (2**10 - 1 - 2**6)) == 21 and round(21 / 12**0.5) == 6
        ),
        "With 12 bits a level is as wide as the read noise": lambda n: (
            round(20_000 / (2**12 - 1 - 2**8)) == round(n.GOOD.read_noise)
        ),
        "The curve crosses 0 just above the noise floor": lambda n: (
            1 < 2 ** np.interp(0, n.ratio, n.depth) * 20_000 / ranges.noise_floor(n.GOOD) < 1.2
        ),
        "but below 0.7 it has only one level": lambda n: (
            round(float(n.across[np.argmax(np.diff(n.levels(0.1).Z) > 0)]), 1) == 0.7
        ),
        "each photo covers only about seven stops": lambda n: 7 <= np.log2(20_000 / 122) < 7.5,
        "5 decades, 16.6 stops, 100 dB": lambda n: np.allclose(
            ranges.dynamic_range(1000, 0.01), (5, 16.6, 100), atol=0.05
        ),
        "A sensor with 3.6 decades": lambda n: round(ranges.sensor_range(n.GOOD)[0], 1) == 3.6,
        "The scene's range is more than a decade larger than the sensor's": lambda n: (
            n.scenes.decades(n.E, tail=0) > 1 + ranges.sensor_range(n.GOOD)[0]
        ),
        "In the long exposure, luminances from 0.3 to 0.6 fall on three levels": lambda n: (
            levels_met(n, 1.0) == 3
        ),
        "In the short one they are all below the first step": lambda n: levels_met(n, 0.1) == 1,
        "With 6 bits a level is 340 electrons wide": lambda n: (
            round(20_000 / (2**6 - 1 - 2**2), -1) == 340
        ),
        "With 8 bits it is 84": lambda n: round(20_000 / (2**8 - 1 - 2**4)) == 84,
        "Each photo holds nearly twelve stops": lambda n: (
            11.5 < ranges.sensor_range(n.GOOD)[1] < 12
        ),
        "Four, at 1/64, 1/4, 4 and 64 s": lambda n: n.enough == 4,
        "With steps of four stops, neighboring photos share three stops": lambda n: (
            int(np.log2(20_000 / 122)) - 4 == 3
        ),
    },
    "02": {
        "1/4, 1/8, 1/15, 1/30, 1/60, 1/125": lambda n: (
            {"1/4", "1/8", "1/15", "1/30", "1/60", "1/125"} <= set(n.full.names)
        ),
        "a sensor of 24 mm by 36 mm": lambda n: np.isclose(n.CORNER, np.hypot(24, 36) / 2),
        "A field of snow reflects 86 % of the light, and a black locomotive 5 %": lambda n: (
            [round(100 * float(n.three[name].rho)) for name in ("snow", "locomotive")] == [86, 5]
        ),
        "a ratio of 10 (3.3 stops)": lambda n: round(float(np.log2(10)), 1) == 3.3,
        "The partial meter needs 8.2 stops": lambda n: (
            round(18 - n.steps(18, "partial")[-1].EV, 1) == 8.2
        ),
        "The lowest belongs to the longest photo, which takes 4 of the 4.5 seconds": lambda n: (
            np.argmin(n.ratios(*n.both(10)["noise"])) == 0
            and n.both(10)["noise"][0].max() == 4
            and round(float(n.both(10)["noise"][0].sum()), 1) == 4.5
        ),
        "as three photos three stops apart, here with half to two thirds of the error": lambda n: (
            all(
                0.45 < shaken_error(n, radius, 7, 1.0) / shaken_error(n, radius, 3, 3.0) < 0.7
                for radius in (6, 12)
            )
        ),
        "It takes 4.5 seconds instead of 34": lambda n: (
            [
                round(float(times.sum()), digits)
                for (times, _), digits in zip(n.both(10).values(), (0, 1), strict=True)
            ]
            == [34, 4.5]
        ),
        "is lowest at the dark end, 28, and about 33 at the other low points": lambda n: (
            np.allclose(sawtooth_lows(n, "stops"), [28, 33, 33, 33], atol=0.6)
        ),
        "Its longest photo alone takes 32 seconds": lambda n: n.both(10)["stops"][0].max() == 32,
        "the lows of the sawtooth lie between 10 and 17": lambda n: (
            10 <= min(sawtooth_lows(n, "noise")) < max(sawtooth_lows(n, "noise")) < 17.5
        ),
        "steps of 2, 1.88 and 2.08": lambda n: (
            [15 / 8, 125 / 60] == [1.875, pytest.approx(2.083, abs=1e-3)]
        ),
        "A chapel ranges over sixteen stops": lambda n: round(float(np.log2(n.HIGH / n.LOW))) == 16,
        "With the spot or the partial meter on her face, the face is about a stop too dark": lambda n: (
            all(round(n.place(mode).off) == -1 for mode in ("spot", "partial"))
        ),
        "Even so, more than half of the image is full": lambda n: n.place("spot").full.mean() > 0.5,
        "the face is four to five stops too dark": lambda n: all(
            -5 < n.place(mode).off < -4 for mode in ("centre", "average", "matrix")
        ),
        "With up to 6 pixels of shake, alignment fixes all of it": lambda n: (
            worst(n.shaken(6).aligned, n.shaken(6).truth, 10) <= 0.05
        ),
        "most modes need two shots": lambda n: (
            {len(n.steps(18, mode)) for mode in n.metering.MODES} == {2, 3}
        ),
        "skin reflects nearly half of the light": lambda n: 0.4 < n.scene.rho < 0.5,
        "changes the exposure by at most eight stops at a time": lambda n: (
            round(float(np.diff([shot.EV for shot in n.steps(18, "partial")]).min()), 2) == -8
        ),
        "nearly three times what you asked for even at its worst place": lambda n: (
            2.5 < sawtooth_lows(n, "stops")[0] / 10 < 3
        ),
        "the plan by noise takes about as long as the plan by stops": lambda n: (
            0.8 < np.divide(*(n.both(28)[way][0].sum() for way in ("noise", "stops"))) < 1.2
        ),
        "Alignment fails for one of the five photos": lambda n: n.shaken(12).wrong == 1,
        "at ISO 800 the converter reaches its top level when the well is only an eighth full": (
            lambda n: n.MAKER.speeds[0] / n.MAKER.speeds[1] == 1 / 8
        ),
        "so the plan would have five photos instead of four": lambda n: (
            len(n.both(10)["noise"][0]) == 4 and len(plan_at_iso_800(n).times) == 5
        ),
        "with ISO 100 alone it would take 8.1 seconds": lambda n: (
            round(float(plan_with(n, speeds=(100,)).times.sum()), 1) == 8.1
        ),
        "hdrlab counts a pause of 0.2 s after each photo": lambda n: n.MAKER.pause == 0.2,
        "That costs the face 0.6 stops": lambda n: (
            round(matrix_exposure(n, 1e9) - matrix_exposure(n, 2.0), 1) == -0.6
        ),
        "it is right if it is as bright as its reflectance, 0.45 of full": lambda n: (
            round(float(n.scene.rho), 2) == 0.45
        ),
        "in the median of twelve, the error is about a third": lambda n: (
            0.25 < np.median([few_steps_or_many(n, rng) for rng in range(12)]) < 0.4
        ),
    },
    "03": {
        "in five hand-held photos two stops apart": lambda n: apart(n.times, 5, 2),
        "you would compare whole bitmaps 16 129 times": lambda n: 127**2 == 16_129,
        "needs 54 comparisons": lambda n: 9 * len(n.levels) == 54,
        "The coarsest level has little more than a hundred pixels": lambda n: (
            100 < n.levels[0].fixed[0].size < 150
        ),
        "more than one bit in a hundred differs": lambda n: 0.01 < differ(n, -1) < 0.02,
        "At width 2, hardly a bit differs, and at Ward's width of 4, none": lambda n: (
            0 == differ(n, 4) < differ(n, 2) < 1e-4
        ),
        "By up to eight pixels to the side, and by one up or down": lambda n: (
            np.abs(n.mtb.align(n.real)).max(axis=0).tolist() == [1, 8]
        ),
        "Below you will see that this is enough here": lambda n: (
            (n.mtb.align(n.images) == n.shaken).all() and np.median(n.Y[-1]) == 255
        ),
        "It returns $(-63, -63)$, as far as it can go": lambda n: n.corner == (-63, -63),
        "each is off in another direction, a corner by 2.4 pixels": lambda n: (
            n.turned(0.5)[0].offset == (5, 10) and round(280 * np.deg2rad(0.5), 1) == 2.4
        ),
        "At two degrees not even the center fits": lambda n: (
            np.linalg.norm(np.subtract(n.turned(2.0)[0].offset, (5, 10))) > 2
        ),
    },
    "04": {
        "photographed seven times from a tripod": lambda n: apart(n.bracket.times, 7, 2),
        "Sixty spots of the scene give 420 points": lambda n: n.Z.size == 420,
        "(25 make 250, not quite)": lambda n: 25 * (11 - 1) == 250 < 255,
        "the middle of 0 ... 255 is 127.5": lambda n: np.mean([0, 255]) == 127.5,
        "with our $P = 7$ for 43": lambda n: n.debevec.samples_needed(7) == 43,
        "For $P = 11$ this asks for $N = 26$": lambda n: n.debevec.samples_needed(11) == 26,
        "$g(127)$ is a little less": lambda n: -0.05 < n.g[127] < 0 and abs(n.g[128]) < 1e-9,
        "half of the points between the levels 64 and 192 lie within a hundredth of a stop": lambda n: (
            np.median(np.abs(n.g[n.Z] - n.lE[:, None] - n.B)[(n.Z >= 64) & (n.Z <= 192)])
            < 0.01 * np.log(2)
        ),
        "becomes a staircase, half a stop off at its steps": lambda n: (
            0.4 < worst(n.solve(smoothness=0.1)[1].g, n.responses.true_g(), 2, 253) < 0.6
        ),
        "With 3 samples it is wrong at both ends: few points lie there, so the smoothness wins": lambda n: (
            min(errors_at_ends(n, 3, smoothness=30)) > 0.1
            and max(errors_at_ends(n, 200, smoothness=30)) < 0.05
            and max(errors_at_ends(n, 3, smoothness=3)) < 0.1
        ),
        "the points show whether all steps are equal, but not how large they are": lambda n: (
            misfit_of_times(n, n.B) < 0.5 * misfit_of_times(n, n.B + 0.1 * (np.arange(7) % 2))
            and misfit_of_times(n, 1.3 * n.B) < 1.5 * misfit_of_times(n, n.B)
        ),
        "so an error of $g$ that repeats every two stops fits as well": lambda n: (
            share_of_period(n, n.solve(smoothness=0.1)[1].g, 2) > 0.5
        ),
        "it reaches level 128 in a hundredth of a second": lambda n: (
            round(float(np.exp(-brightest_spot(n))), 2) == 0.01
        ),
        "40 if you ask for 43": lambda n: len(n.sampling.by_grid(n.frames, 43)) == 40,
    },
    "05": {
        "photographed seven times from a tripod, two stops apart": lambda n: apart(n.times, 7, 2),
        "near the levels 130 and 70": lambda n: (
            [round(0.98 * 255 / ratio ** (1 / 2.2), -1) for ratio in (4, 16)] == [130, 70]
        ),
        "it is 4 % of the full exposure after the first iteration, and stays there": lambda n: (
            {round(off(g, n.truth)) for g in n.found[1:]} == {4}
        ),
        "Three iterations make the change hundreds of times smaller": lambda n: (
            100 < n.change[1] / n.change[3] < 1000
        ),
        "`hat` and `flat` have the largest error at the bright end": lambda n: (
            min(off(n.weighted(w), n.truth) for w in ("hat", "flat"))
            > 2 * off(n.weighted("gaussian"), n.truth)
        ),
        "scallops of up to 0.3 stops": lambda n: (
            round(worst(n.found[1], n.truth), 1) == round(worst(n.found[30], n.truth), 1) == 0.3
        ),
        "At one stop they are small": lambda n: scallops(n, 1) < 0.1,
        "at three stops they reach beyond half a stop": lambda n: scallops(n, 3) > 0.5,
        "A smoothness of 100 removes nearly all of them at two stops": lambda n: (
            scallops(n, 2, 100) < 0.1 * scallops(n, 2)
        ),
        "but not at three": lambda n: scallops(n, 3, 100) > 0.2 * scallops(n, 3),
        "a step multiplies every level by $4^{1/2.2} = 1.88$": lambda n: (
            round(4 ** (1 / 2.2), 2) == 1.88
        ),
        "At 1000 there is a new error": lambda n: scallops(n, 2, 1000) > 2 * scallops(n, 2, 100),
        "with `cut` the error stays near zero": lambda n: off(n.weighted("cut"), n.truth) < 0.2,
        "is at least 16 times that of the exposure that measured the pixel correctly": lambda n: (
            np.diff(np.log2(n.each[2] ** 2)).min() > np.log2(15.9)
        ),
        "it takes about 100,000 iterations to get close to the limit": lambda n: (
            0.001 > limit_of_alternation(n)[0] ** 100_000 > 0.0001
        ),
        "it is between 4 and 5 % off": lambda n: (
            4 < off(np.log(limit_of_alternation(n)[1]), n.truth) < 5
        ),
    },
    "06": {
        "There is another minimum at 0.49": lambda n: round(float(n.second), 2) == 0.49,
        "the curve looks flat from 0.55 to 0.85": lambda n: (
            np.ptp(np.log10(n.errors(0.005)[(n.along > 0.55) & (n.along < 0.85)])) < 0.1
        ),
        "For 27 of the 32 cameras the bottom of the valley leads toward the truth": lambda n: (
            gained(n) == 27
        ),
        "After the tenth iteration the error falls by a fifth": lambda n: (
            round(n.fall.error[299] / n.fall.error[9], 1) == 0.8
        ),
        "more than ten times as far off as after the first": lambda n: (
            n.fall.off[299] > 10 * n.fall.off[0]
        ),
        "they are right within 0.002": lambda n: (
            np.abs(n.R ** (np.log(n.true).sum() / np.log(n.R).sum()) - n.true).max() < 0.0025
        ),
        "the estimated ratios are all a little low": lambda n: np.all(n.R < n.true),
        "The camera stated five stops for the whole bracket, and it was 4.8": lambda n: np.allclose(
            -np.log2([n.stated.prod(), n.true.prod()]), [5, 4.8], atol=0.05
        ),
        "which explains a power of 1.04": lambda n: (
            round(float(np.log(n.stated.prod()) / np.log(n.true.prod())), 2) == 1.04
        ),
        "on average they are the truth to the power of about 1.1": lambda n: all(
            round(np.polyfit(n.truth[20:241], g[20:241], 1)[0], 1) == 1.1 for g in n.green.values()
        ),
        "self-calibration ends at 5.3 stops": lambda n: (
            round(-np.log2(n.self_calibration.calibrate(n.frames, n.bracket.times).R.prod()), 1)
            == 5.3
        ),
        "fewer than 10 iterations": lambda n: len(n.iterations) < 10,
        "below level 13 it is off by more than a stop": lambda n: (
            off_below(n.green["self-calibration"], n.truth, 13) > 1
        ),
        "the error falls more than a thousandfold into a sharp notch at 0.7": lambda n: (
            np.median(n.errors()) > 1000 * n.errors()[np.isclose(n.along, 0.7)]
        ),
        "after 3000 iterations its error is 19 %": lambda n: round(drifted(n, 31, 3000)) == 19,
        "the median of the stopped curves would fall from 0.94 to 0.05 %": lambda n: (
            np.round(errors_with_and_without_u(n), 2).tolist() == [0.94, 0.05]
        ),
        "is one and a half times this camera's noise": lambda n: (
            round(0.01 / float(noise_of_frames(n)), 1) == 1.5
        ),
        "With the true $\\sigma$, 5 % would pass instead of 18 %": lambda n: (
            round(100 * even_patches(n.still[0], n.still.std(axis=0, ddof=1)).mean()) == 5
            and round(100 * n.averaged(1).mean()) == 18
        ),
        "of the patches that pass with 16 frames, 98 % are clipped": lambda n: (
            round(100 * np.mean(~measured_well(n)[n.averaged(16)])) == 98
        ),
        "Noise of a tenth of a level fills the notch": lambda n: (
            np.median(n.errors(0.1 / 255)) < 3 * n.errors(0.1 / 255)[np.isclose(n.along, 0.7)]
        ),
    },
    "07": {
        "six photos two stops apart": lambda n: apart(n.noisy.times, 6, 2),
        "its slope falls from 2.3 in the dark to 0.5 near white": lambda n: (
            [round(slope, 1) for slope in slopes_of_film(n)] == [2.3, 0.5]
        ),
        "have a slope of 1, those of `gamma` 0.45": lambda n: round(1 / 2.2, 2) == 0.45,
        "order 10 is then off by two in a thousand": lambda n: (
            round(off(n.polynomials(10, 0.98)[1], n.cubic), 1) == 0.2
        ),
        "the cut alone does not prevent that": lambda n: (
            off(n.polynomials(10, 0.98)[0], n.cubic) > 5
        ),
        "The true order fits with and without noise": lambda n: (
            max(off(g, n.cubic) for g in n.polynomials(3)) < 0.1
        ),
        "by a quarter of a stop at level 250, and by more above it": lambda n: (
            bend_of_table(n, 250) == 1 < bend_of_table(n, 254)
        ),
        "With noise of four levels, which is a lot, a ratio of 4 comes out 2 % too small": lambda n: (
            round(100 * (1 - n.estimate(4.0, 4.0)[0].k / 4)) == 2
        ),
        "the table and the polynomial are within a few hundredths of a stop": lambda n: (
            max(
                worst(n.three[name], n.responses.true_g("film"), 10, 250)
                for name in ("table", "polynomial")
            )
            < 0.1
        ),
        "is off by more than a stop at both ends": lambda n: all(
            worst(n.three["power law"], n.responses.true_g("film"), level, level) > 1
            for level in (10, 250)
        ),
        "$k$ is 4 to within a few thousandths": lambda n: (
            abs(n.last_round("mid-step")[0].k - 4) < 0.005
        ),
        "so its slope is above 4": lambda n: n.last_round("paper")[0].k > 4.005,
    },
    "08": {
        "The six grays reflect 90, 59, 36, 20, 9 and 3 %": lambda n: (
            np.round(n.chart.LUMINANCE[-1]).tolist() == [90, 59, 36, 20, 9, 3]
        ),
        "only its darkest sample is missing": lambda n: len(n.two_grids[1].I) == 14,
        "the root mean square of the error grows from 0.4 to 2.2 % of the range": lambda n: (
            [round(gray_error(n, falloff), 1) for falloff in (0.0, 0.3)] == [0.4, 2.2]
        ),
        "The screen and the many times are hardly worse than the true curve": lambda n: (
            max(radiance_off(n, "a screen"), radiance_off(n, "a chart"))
            < 0.002 + radiance_off(n, "true")
        ),
        "with degree 2 or 3 the curve is off by more than 4 % of the range somewhere": lambda n: (
            min(spline_off(n, n.simplex(degree)) for degree in (2, 3)) > 4
        ),
        "with 6 by a few tenths, with 9 by less": lambda n: (
            1 > spline_off(n, n.simplex(6)) > spline_off(n, n.simplex(9))
        ),
        "The two errors are about equal, with opposite signs": lambda n: all(
            left > 0 > right and abs(left + right) < 0.1 * left
            for left, right in (edges_off(n, faster) for faster in (0.05, 0.15, 0.3))
        ),
        "at 15 % more speed its RMSE is a third of that of one edge, at 30 % almost half": lambda n: (
            0.3 < both_edges_over_one(n, 0.15) < 0.37 and 0.43 < both_edges_over_one(n, 0.3) < 0.5
        ),
        "at 30 % more speed it is off by only 0.05 %": lambda n: (
            round(mean_of_edges_off(n, 0.3), 2) == 0.05
        ),
        "With only the first three to five samples of the dim grid, it is off by up to 1 %": lambda n: (
            round(max(spline_off(n, n.spline(samples=count)) for count in (3, 4, 5))) == 1
            and spline_off(n, n.spline()) < 0.5
        ),
        "although that curve was right to a tenth of a percent": lambda n: (
            np.abs(spline_error(n, n.by_motion)).max() < 0.1
        ),
        "The radiance from the curve of the motion blur is far off": lambda n: (
            radiance_off(n, "motion") > 0.1
        ),
        "Decoding the photo as sRGB is even worse": lambda n: (
            radiance_off(n, "sRGB") > radiance_off(n, "motion")
        ),
    },
    "09": {
        "use only two of them, noisy and two stops apart": lambda n: apart(n.times, 2, 2),
        "With 4 components the space represents `film` and `srgb` to a few tenths of a percent": lambda n: (
            all(0.1 < off(*n.nearest(name, 4)) < 0.4 for name in ("film", "srgb"))
        ),
        "and with 6 also `mix`": lambda n: off(*n.nearest("mix", 6)) < 0.2,
        "`gsolve` would need 256 pixels": lambda n: debevec.samples_needed(2) == 256,
        "and if the second or the third is 2.5, it falls near white": lambda n: all(
            np.diff(n.walk(**{"first": 0, number: 2.5})["mean + c H"])[-10:].max() < 0
            for number in ("second", "third")
        ),
        "`wig` stays 2 to 3 % off even with all twelve": lambda n: (
            2 < off(*n.nearest("wig", 12)) < 3
        ),
        "as the second does for `srgb`": lambda n: (
            off(*n.nearest("srgb", 2)) > off(*n.nearest("srgb", 1))
        ),
        "The second bends both ends up or down, and the third mostly the darkest levels": lambda n: (
            min(n.full.H[1, 0] / n.full.H[1, 64], n.full.H[1, 255] / n.full.H[1, 64]) < -5
            and n.full.H[1, 0] * n.full.H[1, 255] > 0
            and np.abs(n.full.H[2, 0]) > 3 * np.abs(n.full.H[2, 10:]).max()
        ),
        "With 50 components `wig` would be 0.2 % off": lambda n: (
            round(off_in_space(n, "wig", 50), 1) == 0.2
        ),
        "Below the darkest patch it may be off by 1 %": lambda n: (
            round(100 * worst_below_patches(n, "srgb", 5)) == 1
        ),
        "`film` and `wig` do the same, but `srgb` and `mix` may go either way": lambda n: (
            max(gain(reshot(n, seed), "film") for seed in (5, 6)) < 1
            and min(gain(reshot(n, seed), "wig") for seed in (5, 6)) > 1
            and gain(reshot(n, 5), "srgb") < 1 < gain(reshot(n, 6), "mix")
        ),
        "is on average already below 1 %, with five below 0.2 %": lambda n: all(
            patches_off(n, name, patches) < limit
            for name in ("film", "srgb", "mix")
            for patches, limit in ((3, 1), (5, 0.2))
        ),
        "the space is better for `film` and `srgb`, with half to two thirds of the error": lambda n: (
            all(0.5 <= round(share(n, name, 100), 2) <= 0.67 for name in ("film", "srgb"))
        ),
        "It is worse for `mix`, and much worse for `wig`": lambda n: (
            share(n, "wig", 100) > 5 > share(n, "mix", 100) > 1
        ),
        "With thousands of pixels it also represents `mix` well": lambda n: (
            share(n, "mix", 4000) < 1
        ),
        "`gsolve` gets better for `srgb` and `wig`, and worse for `film` and a little for `mix`": (
            lambda n: gain(n, "film") < gain(n, "mix") < 1 < min(gain(n, "srgb"), gain(n, "wig"))
        ),
        "With a thousand ranks the result for `film` is good from 0.002 to 0.1": lambda n: all(
            off(*n.with_noise(noise, "film")) < 0.25 for noise in (0.002, 0.005, 0.02, 0.05, 0.1)
        ),
        "at 0.05 it is already off by a percent": lambda n: (
            round(off(*n.with_noise(0.05, "mix"))) == 1
        ),
        "at 0.5, three patches hardly move the curve away from the mean of the family": lambda n: (
            all(
                np.abs(n.drawn(3, name, 0.5)["MAP"] - n.tones.mean).mean() < 0.02
                for name in n.CAMERAS
            )
        ),
    },
    "10": {
        "Here are seven photos, two stops apart": lambda n: apart(n.inside.times, 7, 2),
        "Each of the seven photos covers six or seven stops": lambda n: (
            6 < np.log2(n.exp_g[249] / n.exp_g[8]) < 7
        ),
        "gives level 254 more than a third of its largest weight": lambda n: (
            3 * n.pipeline.WEIGHTS["snr"](n.true_g)[254] > n.pipeline.WEIGHTS["snr"](n.true_g).max()
        ),
        "or 1.6 %": lambda n: round(100 / 4000**0.5, 1) == 1.6,
        "or 3.2 %": lambda n: round(100 / 1000**0.5, 1) == 3.2,
        "Fifteen. The last photo reaches twelve stops further down than the first": lambda n: (
            round(float(np.log2(n.light.max() / n.light.min()))) == 15
            and round(float(np.log2(n.inside.times.max() / n.inside.times.min()))) == 12
        ),
        "and the scene has eighteen": lambda n: (
            round(float(np.log2(n.true_L.max() / n.true_L.min()))) == 18
        ),
        "In the green channel, twelve of the sixteen scans show only the floor there": lambda n: (
            np.sum([np.median(image[n.is_dark, 1]) < 20 for image in n.scans.images]) == 12
        ),
        "make the dark more than a stop too bright": lambda n: (
            n.in_the_dark["log"] > 1 and abs(n.in_the_dark["shot"]) < 0.1
        ),
        "For most pixels two to five photos give an estimate": lambda n: (
            np.mean((photos_that_measure(n) >= 2) & (photos_that_measure(n) <= 5)) > 0.9
        ),
        "The brightest pixel is clipped in all seven": lambda n: n.white == 7,
        "here the choice makes a difference of less than one percent": lambda n: (
            np.ptp([errors_of(n, name) for name in n.METHODS], axis=0).max() < 1
        ),
        "a short photo often reaches level 1 there only because of noise": lambda n: (
            errors_of(n, "mean")[0] > errors_of(n, "log")[0] + 0.5
            and abs(np.subtract(*errors_without_level_1(n, ["mean", "log"]))) < 0.2
        ),
        "Its estimate is then several times too large": lambda n: excess_at_level_1(n) > 3,
        "in the channels in which it is clipped, a window is never darker than the stone": lambda n: (
            all(lowest > highest for lowest, highest in bounds_and_measured(n))
        ),
        "So its standard deviation is twice that of the one before": lambda n: 4**0.5 == 2,
        "contributes about three quarters of $\\sum 1 / V$": lambda n: (
            round(4 * np.median(longest_shares(n))) == 3
        ),
        "in the middle it is 63 electrons, and a step has 31": lambda n: (
            [round(4000**0.5), round(n.SENSOR["full_well"] / 255)] == [63, 31]
        ),
        "The fourth photo seems to be off by half a stop": lambda n: (
            round(2 * n.with_wrong_time(2.0)[3]) == 1
        ),
        "the longer neighbor seems to be off by a quarter of a stop": lambda n: (
            round(-4 * n.with_wrong_time(2.0)[4]) == 1
        ),
        "and the shorter one by more than half a stop": lambda n: (
            0.5 < -n.with_wrong_time(2.0)[2] < 0.75
        ),
        "so the top three stops of the scene are missing": lambda n: (
            round(float(np.log2(n.true_L.max() / n.absolute.max()))) == 3
        ),
        "a light of 2 electrons in the longest photo has a mean that is far too large": lambda n: (
            mean_of_cut_counts(2, read_noise=6) > 1.5 * 2
        ),
        "The photos agree to a fiftieth of a stop": lambda n: round(n.real.spread, 2) == 0.02,
        "the well holds four times as many electrons where the hat has its largest weight": lambda n: (
            round(float(np.exp(n.true_g[255])) / 2) == 4
        ),
        "and up to four times where read noise is larger": lambda n: np.allclose(
            n.inside.times[1:] / n.inside.times[:-1], 4
        ),
        "a pixel reaches level 128 at an eighth of the light that fills its well": lambda n: (
            round(float(np.exp(n.true_g[255]))) == 8
        ),
    },
    "11": {
        "three photos of a workshop, two stops apart": lambda n: apart(n.times, 3, 2),
        "A fifth of a degree. It moves a corner by a pixel here": lambda n: (
            round(float(np.abs(n.degrees).max()), 1) == 0.2
        ),
        "and by six pixels at a width of 2000 pixels": lambda n: (
            round(np.deg2rad(np.abs(n.degrees).max()) * np.hypot(1000, 1333)) == 6
        ),
        "Here $g$ comes from the same times": lambda n: (
            round(
                n.light.exposure_ratio(
                    n.dark, n.bright, n.debevec.recover(n.images, n.bracket.times**2)[:, 1]
                )
            )
            == n.k0**2
        ),
        "the photos agree equally well": lambda n: (
            np.ptp([one.spread for one in n.both.values()]) < 0.002
        ),
        "the histograms of the two photos give nearly the same value": lambda n: (
            abs(n.light.exposure_ratio(n.dark, n.bright, n.g[:, 1]) / n.k0 - 1) < 0.01
        ),
    },
    "12": {
        "seven photos of a street at night, two stops apart": lambda n: apart(
            n.moving.bracket.times, 7, 2
        ),
        "the mean difference over 5 × 5 pixels is at most three standard deviations of its noise, plus 5 %": (
            lambda n: (
                (
                    n.reference.BOX_SIDE,
                    n.reference.MAX_STANDARD_DEVIATIONS,
                    n.reference.RELATIVE_TOLERANCE,
                )
                == (5, 3, 0.05)
            )
        ),
        "it has the loss of that photo plus 0.25": lambda n: n.frames.FILLED_LOSS == 0.25,
        "removes glare only where it is more than 2 % of the light": lambda n: (
            n.flare.remove_glare.__kwdefaults__["part"] == 0.02
        ),
        "if you leave out the pixels that stay clipped: two, five, or fifteen?": lambda n: (
            12 < errors_shrink(n) < 19
        ),
        "no other photo may fill these pixels, because the means over 5 × 5 pixels contain a part of him": (
            lambda n: left_clipped_far_from_the_visitor(n) == 0
        ),
        "With `edge` at 0 there are nine regions": lambda n: (
            n.regions.label(moving_pixels(n, edge=0.0)).max() == 9
        ),
        "At 0.8, a piece of the umbrella, the coat and the legs are left": lambda n: (
            n.regions.label(moving_pixels(n, tau=0.8)).max() == 2
            and moving_pixels(n, tau=0.8).mean() < 0.4 * moving_pixels(n).mean()
        ),
        "Once, where he stood in the reference photo": lambda n: len(n.result.references) == 1,
    },
    "13": {
        "230, 89, 15": lambda n: (
            n.rgbe.to_pixels(np.float32([[[0.9, 0.35, 0.06]]]))[0, 0].tolist() == [230, 89, 15, 128]
        ),
        "over far more decades than any scene has (76 in all)": lambda n: (
            int(254 * np.log10(2)) == 76
        ),
        "Float would lie at 0.000006 %": lambda n: round(100 * 2.0**-24, 6) == 0.000006,
        "comes back too small by 0.2 to 0.4 % on average": lambda n: (
            [round(50 / mantissa, 1) for mantissa in (255, 128)] == [0.2, 0.4]
        ),
        "its median error in the worst channel of a pixel is one to two percent": lambda n: (
            1 < np.median(n.worst) < 2
        ),
        "At a tenth of red it is up to 8 %": lambda n: round(blue_off(n, 0.095, 0.105).max()) == 8,
        "up to a half; below $\\frac1{128}$": lambda n: (
            round(blue_off(n, 1 / 128, 1 / 32).max()) == 50 and blue_off(n, 0, 1 / 128).min() == 100
        ),
        "twelve decades, of which nine have their full ten bits": lambda n: (
            [round(float(np.log10(65504 / low))) for low in (2.0**-24, 2.0**-14)] == [12, 9]
        ),
        "numbers end at 65504, and one of 65520 or more becomes infinity": lambda n: (
            [as_half(65519), as_half(65520)] == [65504, np.inf]
        ),
        "Either way, a file does not change when it is read and written again": lambda n: all(
            same_after_decoding(n, part) for part in (0.0, 0.5)
        ),
        "here the 6 bytes of a pixel in halves became about four": lambda n: (
            round(n.each["half .exr"]) == 4
        ),
        "RGBE is flat at 0.8 %, one part in 128": lambda n: round(n.top["RGBE"].max(), 1) == 0.8,
        "Half is flat at 0.05 %": lambda n: (
            round(n.top["half"][(n.decades > -4) & (n.decades < 4)].max(), 2) == 0.05
        ),
    },
    "14": {
        "the mean of both sides, 50.5": lambda n: np.mean([1, 100]) == 50.5,
        "as if its neighborhood were 50 times as bright": lambda n: int(50.5) == 50,
        "the darker half of the pixels shares a handful": lambda n: n.darker_levels("linear") <= 5,
        "With $k = 8$ there is room for three stops above the neighborhood": lambda n: (
            np.log2(8) == 3
        ),
        "A display of 10000 : 1, which is 13.3 stops, lacks about one stop": lambda n: (
            round(float(np.log2(n.high / n.low / 10000))) == 1
            and round(float(np.log2(10000)), 1) == 13.3
        ),
        "The foveal image spans 14.4 stops, and the pixels 17.7": lambda n: (
            [round(robust_stops(n, image), 1) for image in (n.Lf, n.L)] == [14.4, 17.7]
        ),
        "Around candles and spots of sunlight on the floor": lambda n: all(
            np.mean(n.off[200:, columns] <= -3) > 0.4
            for columns in (slice(0, 130), slice(200, 480))
        ),
        "a dark halo of 5.7 stops": lambda n: round(float(np.log2(101 / 2)), 1) == 5.7,
    },
    "16": {
        "paper white reflects about 90 %, only 2.3 stops more than middle gray": lambda n: (
            round(float(np.log2(0.9 / 0.18)), 1) == 2.3
        ),
        "seven in ten belong to the brightest tenth": lambda n: (
            round(np.mean((n.L >= np.quantile(n.L, 0.9))[n.index == 0]), 1) == 0.7
        ),
        "which fill less than a thousandth of the image": lambda n: lamps(n) < 0.001,
        "One pixel nearly doubles the mean": lambda n: 1.8 < n.hot.mean() / n.L.mean() < 2,
        "would show the street five stops too dark": lambda n: (
            round(np.log2(n.hot.max() / n.L.max())) == 5
        ),
        "$L_d = 0.15$ is level 108": lambda n: (
            round(255 * float(n.colour.encode_srgb(0.15))) == 108
        ),
        "nearly straight from a stop below middle gray to three stops above it": lambda n: (
            [-1, 3] == [round(n.ev[steep(n)][k]) for k in (0, -1)]
        ),
        "10 pixels from it at $s = 10.5$, and 20 pixels from it at $s = 26.8$": lambda n: (
            [light_arrives(n, away) for away in (10, 20)] == ["10.5", "26.8"]
        ),
        "it is far above $L_{white}$, so it is white in both images": lambda n: all(
            np.all(Ld[n.Lm > 100] == 1) for Ld in n.both.values()
        ),
        "is back at 16.8, because by then the surround contains a little of the lamp's light": lambda n: (
            inside_band(n, n.Lm) == [0, 1, 2, 3, 4, 6]
            and inside_band(n, np.minimum(n.Lm, 6)) == [0, 1, 2, 3, 4]
        ),
        "The large lamp's own response, the orange in the middle, rises with each width": lambda n: (
            np.all(np.diff(n.V[:, np.argmax(n.L)]) > 0)
        ),
        "The band of the local operator is widest two to four stops above the median": lambda n: (
            all(2 <= stops <= 4 for stops in widest_classes(n, n.both["local"]))
        ),
    },
    "15": {
        "two flat areas, two decades apart": lambda n: np.isclose(np.ptp(n.step), 2.2, atol=0.02),
        "at 0.05, half the amplitude of the ripple, it smooths only a fifth of the ripple": lambda n: (
            round(1 - ripple_kept(n, sigma_r=0.05), 1) == 0.2
        ),
        "This halo reaches about two `sigma_s`, 15 pixels": lambda n: (
            darkening_by_blur(n, 0, 8) > 0.3 > 0.1 > darkening_by_blur(n, 20, 24)
            and round(2 * n.durand.SIGMA_S_FRACTION * max(n.L.shape)) == 15
        ),
        "made wider by the same factor, it changes the image about half as much": lambda n: (
            0.4 < change(n, sigma_s=16.0) / change(n, sigma_r=0.8) < 0.6
            and 0.4 < change(n, sigma_s=32.0) / change(n, sigma_r=1.6) < 0.6
        ),
        "two thirds of the ripple stay even far from the step": lambda n: (
            round(3 * ripple_kept_by_guided(n, 0.0025)) == 2
        ),
        "over 10 pixels, its detail falls by 0.71 decades": lambda n: (
            falls_of_detail(n, 10)[0] == 0.71 and falls_of_detail(n, 1)[0] == 0
        ),
        "at all three edges, by 0.09 to 0.16 decades": lambda n: (
            sorted(falls_of_detail(n, width)[1] for width in (1, 10, 40)) == [0.09, 0.1, 0.16]
        ),
        "is 1.7 in decades, and 3.9 in natural logarithms": lambda n: (
            [round(float(log(50)), 1) for log in (np.log10, np.log)] == [1.7, 3.9]
        ),
        "or 0.92 in natural logarithms": lambda n: round(0.4 * np.log(10), 2) == 0.92,
        "An isolated pixel is its own base. Its detail is zero": lambda n: (
            abs(n.glint - n.alone.mean)[32, 48] < 0.005 and round(float(n.alone.k[32, 48]), 1) == 1
        ),
        "is 0.5 in a filter window that the step divides in half, and lower in all others": lambda n: (
            np.isclose(
                n.guided.lines(n.step, n.step, radius=8, epsilon=1.0).a.max(), 0.5, atol=0.02
            )
        ),
        "the image has halos, as with a blur": lambda n: (
            max(halo(n, guided_base(n, 1.0)), halo(n, n.blur.gaussian(n.lL, 8.0))) < -0.2
            and halo(n, guided_base(n, 0.04)) > -0.1
        ),
        "it has little detail": lambda n: (
            np.std(n.lL - guided_base(n, 0.0025)) < 0.1 * np.std(n.detail)
        ),
        "by a decade on each side": lambda n: (
            round(float(np.abs(n.step - n.blur.gaussian(n.step, 8.0))[25, 90:110].max())) == 1
        ),
    },
    "17": {
        "the levels reduce most slopes (to 0.6 times in the median)": lambda n: (
            round(float(np.median(n.Phi)), 1) == 0.6
        ),
        "In the glass only 0.3 of a slope remains": lambda n: (
            round(float(np.median(n.Phi[np.quantile(n.L, 0.97) < n.L])), 1) == 0.3
        ),
        "over twice the distance they need four times as many sweeps": lambda n: (
            3.5 < sweeps_of_a_step(n, 48) / sweeps_of_a_step(n, 24) < 4.5
        ),
        "gets $r = g + \\sigma = -3.08$": lambda n: np.isclose(
            n.local_laplacian.remap(np.zeros(1), -4.0, sigma=0.92, alpha=1.0, beta=0.0), -3.08
        ),
        "so 24 values of $g$ (`samples`) are too few": lambda n: (
            many_samples_change(n, 0.5) > 2 * many_samples_change(n, 1.0)
        ),
        "It must flatten them most to reduce the range, so its edges are soft": lambda n: (
            fine_detail(n, "finest alone")
            < fine_detail(n, "all levels")
            < fine_detail(n, "coarsest alone")
        ),
        "the large differences are missing for thousands of sweeps": lambda n: (
            np.std(n.guesses[1024] - n.done) > 0.2 * np.std(n.done)
        ),
        "$\\alpha^{1 - \\beta} = 0.1^{0.1} = 0.79$": lambda n: round(0.1**0.1, 2) == 0.79,
        "at 0.8 they are half as bright as the glass": lambda n: (
            round(walls_over_glass(n, n.tonemapped(0.8)[0]), 1) == 0.5
        ),
        "a ramp of 5 nats, a factor of 150": lambda n: round(np.exp(5), -1) == 150,
        "A pattern of 0.1 nats becomes three times as strong with $\\alpha = 0.5$": lambda n: (
            round((0.92 * 0.1) ** 0.5 / 0.1) == 3
        ),
        "with the power alone, it would become twelve times as strong": lambda n: (
            round((0.92 * 0.005 * np.sqrt(2 / np.pi)) ** 0.5 / 0.005) == 12
        ),
        "Noise of 0.005 nats becomes not quite twice as strong": lambda n: (
            1.7 < noise_grows(n, 0.005) < 2
        ),
        "noise of 0.02 nats still becomes five times as strong": lambda n: (
            round(noise_grows(n, 0.02)) == 5
        ),
    },
    "18": {
        "near black, its curve has 0.3 times the slope of a logarithm to base 2": lambda n: (
            round(n.logarithm(1)[0] / n.logarithm(0.5)[0], 1) == 0.3
        ),
        "At 0.5 the curve passes white *before* the brightest luminance": lambda n: (
            n.logarithm(0.5).max() > 1 and np.mean(n.with_bias(0.5) == 1) > 0.01
        ),
        "The blue lamp needs three stops more": lambda n: round(stops_until_white(n)) == 3,
        "two thirds of this scene are below": lambda n: (
            round(3 * np.mean(n.truth < n.truth.max() / 5000)) == 2
        ),
        "in a small image, by as much as 0.3": lambda n: round(effect_of_padding(n), 1) == 0.3,
        "the light is 38 degrees nearer to cyan": lambda n: (
            round(n.hue(n.lamp)[0, 0] - n.halfway["by channel"]) == 38
        ),
        "*Khronos* moves each color straight toward white, so the hue stays": lambda n: (
            abs(n.hue(n.lamp)[0, 0] - n.halfway["khronos"]) < 0.01
        ),
        "*AgX* turns it by 12 degrees": lambda n: (
            round(n.hue(n.lamp)[0, 0] - n.halfway["agx"]) == 12
        ),
        "so that this light turns to cyan as well, and it never becomes white": lambda n: (
            n.halfway["by luminance"] < 205 and n.color(n.by_luminance(n.lamp)).min() > 0.8
        ),
        "but reduces $Q$ by only three hundredths": lambda n: (
            round(quality(n, "unchanged").Q - quality(n, "red and blue exchanged").Q, 2) == 0.03
        ),
        "darkens the left and right edge by almost three stops, costs more": lambda n: (
            2.7 < -np.log2(0.4**2.2) < 3  # it multiplies levels by 0.4
        ),
        "The noise costs about as much; the vignette": lambda n: (
            abs(quality(n, "with noise").Q - quality(n, "red and blue exchanged").Q)
            < 0.015
            < quality(n, "with noise").Q - quality(n, "vignette").Q
        ),
        "S falls with the key, N has a peak, and Q follows N": lambda n: (
            np.argmax(n.three["N"]) == np.argmax(n.three["Q"])
            and n.three["S"][0] > 2 * n.three["S"][-1]
        ),
        "and $S = 0$": lambda n: round(quality(n, "negative").S, 2) == 0,
        "Three sizes, three winners: `reinhard`, `fattal` and `local_laplacian`": lambda n: (
            n.winners == ["reinhard", "fattal", "local_laplacian"]
        ),
        "with 32 pixels per degree": lambda n: 2 * n.quality.FREQUENCIES[0] == 32,
        "order by $S$ is almost the opposite of the order by $N$": lambda n: (
            spearmanr(*([n.boards[letter][name] for name in n.names] for letter in "SN"))[0] < -0.6
        ),
        "its exposure is wrong by half a stop": lambda n: np.allclose(
            np.log2(n.maps["too bright"] / n.maps["five photos"]), 0.5
        ),
        "By PSNR all six maps are within a decibel": lambda n: (
            max(n.by_psnr.values()) - min(n.by_psnr.values()) < 1
        ),
        "more than twenty times as bright as any value": lambda n: (
            n.truth.max() > 20 * n.five.max()
        ),
        "They cover less than one pixel in three hundred": lambda n: (
            np.mean(n.truth.max(axis=-1) > 1.1 * n.five.max()) < 1 / 300
        ),
        "have nearly all of the squared error": lambda n: (
            fraction_of_the_error(n, n.truth.max(axis=-1) > 1.1 * n.five.max()) > 0.98
        ),
        "So a map that is half a stop too bright wins": lambda n: (
            order(n, "PSNR", peak=1000)[0] == "too bright"
        ),
        "at 100 cd/m², most of the chapel is almost black, the flames decide again, and `too bright` "
        "wins": lambda n: (
            order(n, peak=100)[0] == "too bright"
            and 100 * np.median(n.truth) / n.truth.max() < 0.02
        ),
        "At 10,000 cd/m² the eye sees the walls and their noise. `too bright` and `one photo` fall "
        "behind `low contrast`": lambda n: (
            order(n, peak=10000)[1:4] == ["low contrast", "one photo", "too bright"]
        ),
        "With a fitted exposure, `too bright` is equal to `five photos`": lambda n: np.isclose(
            *(scores(n, fit="fitted")[name] for name in ("too bright", "five photos"))
        ),
        "PU-SSIM uses luminance only, so `gray` is as good as the best. In PU-PSNR it is among the "
        "last": lambda n: all(
            np.isclose(
                scores(n, "PU-SSIM", peak=peak)["gray"],
                max(scores(n, "PU-SSIM", peak=peak).values()),
                atol=1e-3,
            )
            and order(n, peak=peak).index("gray") >= 4
            for peak in (100, 1000, 10000)
        ),
        "All three fidelities are near 0.9 at the finest scale": lambda n: all(
            round(each[0][1].mean(), 1) == 0.9 > each[-1][1].mean() for each in n.found.values()
        ),
    },
    "19": {
        "about three quarters of the light face and nine tenths of the dark one": lambda n: (
            round(4 * recall(n, "chrominance", "light")) == 3
            and round(recall(n, "chrominance", "dark"), 1) == 0.9
        ),
        "The locus finds nearly all of both faces": lambda n: (
            min(recall(n, "locus", tone) for tone in ("light", "dark")) > 0.9
        ),
        "nearly one pixel in ten of flag, rocket and wall": lambda n: all(
            0.07 < mistaken(n, "locus", tone) < 0.1 for tone in ("light", "dark")
        ),
        "The mean of the face is within one level of 128 after one round": lambda n: (
            abs(n.states["skin"][1].mean - 128) < 1
        ),
        "hardly anything of flag, rocket and wall": lambda n: all(
            mistaken(n, "chrominance", tone) < 0.02 for tone in ("light", "dark")
        ),
        "so the curve adds only a third of a stop": lambda n: (
            round(3 * list(n.relight.settle_steps(n.relight.shares(n.Y)))[-1].delta) == 1
        ),
        "with 16 in a row a quarter of the selected pixels is sky, with 8 nearly half": lambda n: (
            round(4 * np.mean(n.Y[n.chosen(count=16)] > 130)) == 1
            and 0.4 < np.mean(n.Y[n.chosen(count=8)] > 130) < 0.5
        ),
        "With the three stops that the face lacks, the method would select blocks of the face": lambda n: (
            selected_of_face(n, 0.35) == 0 and selected_of_face(n, 3.3) > 0.5
        ),
        "Up to a reach of 3 the method finds nine tenths of the face, and hardly anything else": lambda n: (
            round(found_of_face(n, reach=3.0), 1) == 0.9 and n.near(3.0).mean() < 0.1
        ),
        "At 4 it finds nearly the whole face, but also the sky at the horizon": lambda n: (
            found_of_face(n, reach=4.0) > 0.95 and n.near(4.0)[140:165, :100].mean() > 0.9
        ),
        "at 6 it finds most of the photo": lambda n: n.near(6.0).mean() > 0.6,
        "But it also finds half of the hair, and specks of the hills": lambda n: (
            round(2 * n.found("locus")[45:70, 150:235].mean()) == 1
            and 0.1 < n.found("locus")[205:250, :60].mean() < 0.2
        ),
        "although it makes up more than half of all pixels that the Gaussian finds": lambda n: all(
            n.skin.find_by_chrominance(n.portrait(tone))[~n.wide & (n.y > 200)].sum()
            > n.skin.find_by_chrominance(n.portrait(tone)).sum() / 2
            for tone in ("light", "dark")
        ),
        "three quarters of a face give its mean within a tenth of a stop": lambda n: all(
            abs(mean_of_skin_off(n, tone, n.face)) < 0.1 for tone in ("light", "dark")
        ),
        "With the suit, the mean is 0.8 stops too low for the light face": lambda n: (
            round(mean_of_skin_off(n, "light", n.y >= 0), 1) == -0.8
        ),
        "pass through $255 / 2^C$ at $q = 0$: 223 for hdrlab's $C$": lambda n: (
            round(255 / 2**0.192) == 223
            and np.allclose([n.relight.f(0, a=a, c=0.192) for a in (0.5, 1.79, 3)], 255 / 2**0.192)
        ),
        "Three stops down the face still has twenty levels of green": lambda n: (
            levels_in_shade(n, -3) == 20
        ),
        "at level 82 instead of 121": lambda n: (
            [round(corrected_shade(n, stops)) for stops in (-3, 0)] == [82, 121]
        ),
        "with the camera's own curve the face would be right": lambda n: all(
            abs(corrected_shade(n, stops, own=True) - 122) < 1 for stops in (-5, -3, 0)
        ),
        "The whole photo is off by two": lambda n: (
            round(128 - n.states["whole photo"][1].mean) == 2
        ),
        "shade are off by nearly forty": lambda n: (
            35 < 128 - n.states["light and shade"][1].mean < 40
        ),
        "within four levels of the sRGB curve between levels 20 and 200": lambda n: (
            np.abs(n.srgb - n.relight.f(n.q, a=1.79, c=0.192))[
                (n.srgb >= 20) & (n.srgb <= 200)
            ].max()
            < 4
        ),
        "medium levels move furthest": lambda n: all(
            80 < np.argmax(n.relight.curve(delta) - np.arange(256)) < 170 for delta in (1, 2, 3)
        ),
        "three stops up": lambda n: round(n.corrected().delta) == 3,
        "The mean of those blocks was 110 before": lambda n: (
            round(n.corrected("blocks").before) == 110
        ),
        "so the correction adds only 0.6 stops": lambda n: (
            round(float(n.corrected("blocks").delta), 1) == 0.6
        ),
        "Five stops down the shade has a handful of levels": lambda n: levels_in_shade(n, -5) < 10,
    },
    "20": {
        "four photos of the workshop, three stops apart": lambda n: apart(n.times, 4, 3),
        "About a third, and half of these by more than 0.15, which is 38 levels": lambda n: (
            round(float(((n.R < 0) | (n.R > 1)).any(axis=-1).mean()), 1) == 0.3
            and np.median(beyond(n.R)[beyond(n.R) > 0]) > 0.15
            and round(255 * 0.15) == 38
        ),
        "In three quarters of the pixels one photo has more than 0.9 of the weight": lambda n: (
            0.7 < np.mean(np.max(n.W, axis=0) > 0.9) < 0.8
        ),
        "few pairs of pixels that are two stops apart are in the wrong order": lambda n: (
            exchanged(n) < 0.01
        ),
        "and low even there, about 0.05 to 0.2": lambda n: (
            np.round(np.quantile(exposedness_in_dark(n), [0.5, 0.9]), 2).tolist() == [0.05, 0.16]
        ),
        "without contrast, the maps are nearly as ragged": lambda n: (
            0.85 < raggedness(n, (0, 1, 1)) / raggedness(n, (1, 1, 1)) < 1
        ),
        "Reinhard's operator is a curve, and yet its band is broad at the bright end": lambda n: (
            max(band_widths(n, n.both["Reinhard"])[-30:]) > 100
            and max(band_widths(n, n.both["Reinhard"])[:-60]) < 20
        ),
    },
    "21": {
        "it has 52 chops, 26 of them open": lambda n: (len(n.CODE), np.sum(n.CODE)) == (52, 26),
        "The smear is 52 pixels long": lambda n: len(n.CODE) == 52,
        "so bright that a fifth of the pixels are full": lambda n: (
            round(np.mean(n.L >= 1), 1) == 0.2
        ),
        "112 waves in 256 pixels become 16 coarse waves at full strength": lambda n: (
            np.argmax(np.abs(np.fft.rfft(n.wave()[1] - n.wave()[1].mean()))) == 16 // 4
        ),
        "17.6 times with the code": lambda n: round(n.flutter.amplification(n.CODE), 1) == 17.6,
        "The noise grows 52 times with one chop": lambda n: (
            round(n.flutter.amplification(n.ONE), 1) == 52
        ),
        "averaged short photos meets the coded one's at nine": lambda n: (
            1 + np.argmin(np.abs(n.short["mean of short photos"] - n.short["one coded photo"])) == 9
        ),
        "$\\log_{10} 64 = 1.8$ decades": lambda n: round(n.assorted.added_decades(n.e), 1) == 1.8,
        "In the dark an error of 10 % takes twice the light, so the loss is 0.3 decades": lambda n: (
            round(light_for_error(n, "assorted", 10) - light_for_error(n, "plain", 10), 1) == 0.3
        ),
        "two and a half times the light": lambda n: (
            round(light_for_error(n, "assorted", 3) - light_for_error(n, "plain", 3), 1) == 0.4
        ),
        "points of a grid in steps of 0.16 decades": lambda n: (
            round(float(np.log10(n.light[1] / n.light[0])), 2) == 0.16
        ),
        "In weak light three quarters of the wave turn into the coarse one, and a fifth remains": (
            lambda n: waves_left(n, 112) == [0.76, 0.21]
        ),
        "one percent shifts its end by half a pixel": lambda n: round(0.01 * len(n.CODE), 1) == 0.5,
    },
    "22": {
        "have lost all sixteen digits, and the SVD still has about nine": lambda n: (
            n.errors[0][-1] > -1 and round(-n.errors[1][-1]) in (9, 10)
        ),
        "A medium smoothness gives the smallest condition number": lambda n: (
            min(condition(n, 0.1), condition(n, 1000)) > 2 * condition(n, 1)
        ),
        "the number of zeros is the number of groups minus one": lambda n: (
            np.sum(n.stiff(0) < 1e-12 * n.stiff(0)[0]) == n.islands - 1
        ),
        "Exactly one is 0 (apart from rounding)": lambda n: (
            np.sum(np.linalg.svd(n.free)[1] < 1e-9) == 1
        ),
        "one line is more than twice as steep as the other": lambda n: (
            2 < np.divide(*(np.polyfit(n.digits[4:13], one[4:13], 1)[0] for one in n.errors)) < 3
        ),
    },
    "23": {
        "at 89 % of its levels, the noise would rise from 0.8 % to 1.2 %": lambda n: (
            np.round(error_with_hat(n, 0.89), 1).tolist() == [0.8, 1.2]
        ),
        "the exposures of the frames are four stops apart": lambda n: np.isclose(
            np.log2(n.turn[0] / n.turn[1]), 4
        ),
        "the first reflects 8 % and lets 92 % through": lambda n: share_of_light(n)[0] == 92,
        "which reflects 6 % of that and lets the rest through: 7.52 %": lambda n: (
            share_of_light(n)[1] == 7.52
        ),
        "to the third sensor: 0.44 %. Only 0.04 % is lost": lambda n: (
            share_of_light(n)[2] == 0.44 and round(100 * (1 - n.shares.sum()), 2) == 0.04
        ),
        "3.6 stops less light than the first, and the third 4.1 stops less": lambda n: (
            np.log2(n.shares[:-1] / n.shares[1:]).round(1).tolist() == [3.6, 4.1]
        ),
        "Ratios of 12 and 17 are large": lambda n: (
            (n.shares[:-1] / n.shares[1:]).round().tolist() == [12, 17]
        ),
        "the brightest sensor keeps 92 % of the light, an eighth of a stop less than all": lambda n: (
            round(-8 * np.log2(n.shares[0])) == 1
        ),
        "so the range would be only 0.8 stops larger": lambda n: (
            round(np.log2(len(n.shares)) / 2, 1) == 0.8
        ),
        "it is 7.7 stops larger": lambda n: round(np.log2(n.shares[0] / n.shares[2]), 1) == 7.7,
    },
    "24": {
        "Three photos of the street are three stops apart": lambda n: apart(n.times, 3, 3),
        "But only about a tenth of her patches come from the walker in the other photo": lambda n: (
            0.05 < patches_of_walker(n, n.fields[-1])[0] < 0.15
        ),
        "Even a photo of the empty street gives nearly the same figure": lambda n: (
            rebuilt_from_empty_street(n) < 1.1 * patches_of_walker(n, n.fields[-1])[1]
        ),
        "at more than half of these pixels nothing does": lambda n: (
            filled_from_reference_alone(n) > 0.5
        ),
        "The plain merge shows two walkers": lambda n: (
            [bool(stops > 0.5) for stops in darkening_by_walkers(n)] == [False, True, True]
        ),
        "The third one is invisible": lambda n: abs(darkening_by_walkers(n)[0]) < 0.1,
        "`ghosts` is about as good here": lambda n: (
            abs(
                np.diff(
                    [n.decibels(n.E3[way], n.taken.moments[1]) for way in ("patches", "ghosts")]
                )[0]
            )
            < 1
        ),
    },
    "25": {
        "Seven pixels in a hundred are beyond white": lambda n: (
            round(100 * np.mean(n.light > 1)) == 7
        ),
        "beyond three stops, eight times white, less than one in a hundred is left": lambda n: (
            np.mean(n.light > 8) < 0.01
        ),
        "in flames, sunlit spots and the brightest panes of glass": lambda n: (
            0.2 < np.sum(n.light[38:122, 195:290] > 8) / np.sum(n.light > 8) < 0.5
        ),
        "far more than the eye needs there, and has few left for the dark": lambda n: (
            n.steps[1] > 2 * n.transfer.codes(n.transfer.pq, 1000, 10_000)
            and n.steps[0] < n.transfer.codes(n.transfer.pq, 0.1, 1) / 5
        ),
        "the operator brightened all of them by about the same factor, a quarter of a stop": lambda n: (
            np.abs(np.quantile(n.mean[n.light < 0.2], [0.1, 0.5, 0.9]) + 0.25).max() < 0.2
        ),
        "with 10 bits they are 0.6 % at 1000 cd/m²": lambda n: (
            round(step_at(n, "gamma", 1000), 1) == 0.6
        ),
        "and 94 % at 0.01": lambda n: round(step_at(n, "gamma", 0.01)) == 94,
        "0.9 % at 1000 cd/m² and 9 % at 0.01": lambda n: (
            round(step_at(n, "PQ", 1000), 1) == 0.9 and round(step_at(n, "PQ", 0.01)) == 9
        ),
        "With 12 bits the steps of PQ": lambda n: bits_without_bands(n, "PQ") == 12,
        "Down to 0.01 cd/m², HLG needs 13 bits to reach the same": lambda n: (
            bits_without_bands(n, "HLG, 1000 cd/m²") == 13
        ),
        "and the gamma 15": lambda n: bits_without_bands(n, "gamma") == 15,
        "$v = 0.58$ in PQ": lambda n: round(float(n.transfer.pq(203)), 2) == 0.58,
        "and 0.75 in HLG": lambda n: (
            round(float(n.transfer.hlg((203 / 1000) ** (1 / 1.2))), 2) == 0.75
        ),
        "1000 / 203 = 4.9 times as bright: a headroom of 2.3 stops": lambda n: (
            round(1000 / 203, 1) == 4.9 and round(np.log2(1000 / 203), 1) == 2.3
        ),
        "the walls then have half a candela": lambda n: 0.4 < np.median(n.candela) < 0.6,
        "whose step is less than a fiftieth of a stop": lambda n: (
            np.max(n.largest - n.lowest) / 255 < 0.02
        ),
        "over eight stops a code is a thirtieth of a stop": lambda n: round(255 / 8) == 32,
        "At 2 it applies a third of the gain": lambda n: round(n.gainmap.weight(2, 8), 3) == 0.333,
        "at 4 two thirds": lambda n: round(n.gainmap.weight(4, 8), 3) == 0.667,
    },
    "26": {
        "Each cell of 2 × 2 pixels has two green filters on one diagonal": lambda n: (
            n.mosaic.BAYER.shape == (2, 2) and np.sum(n.mosaic.BAYER == 1) == 2
        ),
        "Here are three photos, three stops apart.": lambda n: apart(n.TIMES, 3, 3),
        "Without subtracting the black level it would be 6.3 %": lambda n: (
            round(100 * 1024 / n.WHITE, 1) == 6.3
        ),
        "Both estimates come close to the file's gains": lambda n: all(
            np.allclose(n.GAINS[name], n.gains, rtol=0.1) for name in ("gray world", "white patch")
        ),
        r"$\sqrt{1.96^2 + 1.12^2 + 0.16^2} = 2.3$ times as large": lambda n: (
            np.abs(n.C[0]).round(2).tolist() == [1.96, 1.12, 0.16]
            and round(np.linalg.norm(n.C[0]), 1) == 2.3
        ),
        "the curve of sRGB lifts 0.05 to 0.25": lambda n: (
            round(float(n.colour.encode_srgb(0.05)), 2) == 0.25
        ),
        "Only rounding: LibRaw computes in whole numbers": lambda n: (
            n.theirs is None or n.apart <= 12
        ),
        "so here white balance may also come after demosaicing": lambda n: np.allclose(
            np.exp(n.malvar.demosaic(np.log(n.map_of_mosaics / n.gains[n.c]), n.c)) * n.gains,
            n.maps[n.ORDERS[2]],
        ),
        "the brightest place that counts, the ceiling, is nearly white": lambda n: (
            np.median(np.ptp(colors_of_brightest(n), axis=-1)) < 0.3
        ),
        "is only 4.6 higher": lambda n: round(np.log(100), 1) == 4.6,
        "only about half as many colors are wrong": lambda n: (
            0.4 < wrong_colors(n, 2) / wrong_colors(n, 0) < 0.6
            and 0.4 < wrong_colors(n, 2) / wrong_colors(n, 1) < 0.6
        ),
    },
    "27": {
        "The hand moves the whole photo, by up to 11 pixels.": lambda n: np.abs(n.hand).max() == 11,
        "The walker moves by 6 pixels more in each frame": lambda n: n.STEP == 6,
        "a full pixel holds 2000 electrons, and the read noise is 5 electrons": lambda n: (
            (n.FULL_WELL, n.READ_NOISE) == (2000, 5)
        ),
        "The search goes up to 4 pixels in each direction at the coarsest of the four levels": lambda n: (
            n.tile_alignment.SEARCH_RADII == (4, 2, 2, 1)
        ),
        "tiles of 16 × 16 pixels": lambda n: n.tile_alignment.TILE_SIDE == 16,
        "frame 2 must move 2 pixels down and 6 to the left": lambda n: (
            n.search_at("the clock").offset == (2, -6) == tuple(n.hand[1])
        ),
        "6 pixels farther to the left than the hand alone": lambda n: (
            n.search_at("the walker").offset == (2, -12)
        ),
        "On the sky nothing differs but noise, and the search finds the offset": lambda n: (
            n.search_at("the sky").offset != tuple(n.hand[1])
        ),
        "1 - A = 12 / (4 + 12)": lambda n: np.allclose(
            1 - n.temporal_merge.shrinkage(np.full((16, 16), 2 * np.sqrt(2.0) * 16), 1.0, 12.0),
            12 / (4 + 12),
        ),
        "most of their frequencies are averaged": lambda n: (
            np.median(n.weigh_at("the walker").weights[1:]) > 0.7 / 8
        ),
        "lose the coarse frequencies, the ones that make up his shape": lambda n: (
            n.weigh_at("to his right").weights[4:6, 8, 7:10].mean() < 0.3 / 8
            and np.median(n.weigh_at("to his right").weights[4:6]) > 0.7 / 8
        ),
        "The noise falls by a factor of 2.6, and the bound is 2.8": lambda n: (
            round(float(n.factor), 1) == 2.6 and round(np.sqrt(8), 1) == 2.8
        ),
        "8 % more noise is left than in the mean. With $c = 1$ it is 83 %": lambda n: (
            round(100 * (bounds_of_noise(n, 12.0) - 1)) == 8
            and round(100 * (bounds_of_noise(n, 1.0) - 1)) == 83
        ),
        "with the true motion of the hand for all tiles it would be 7 %": lambda n: (
            round(100 * (bounds_with_true_motion(n) - 1)) == 7
        ),
        "$c = 1000$ is no better than $c = 12$": lambda n: (
            bounds_of_noise(n, 1000.0) > bounds_of_noise(n, 12.0)
        ),
        "the street has 13 % to 8 % more noise than the mean": lambda n: (
            round(100 * (bounds_of_noise(n, 8.0) - 1)) == 13
        ),
        "where he walked the result is about as good as one frame, or better": lambda n: all(
            n.error_where_walked(n.merge(8, tuning)) < 1.03 * n.alone for tuning in (8.0, 12.0)
        ),
        "In the dark parts the bracket has the smaller error": lambda n: (
            dark_error(n, "bracket") < dark_error(n, "burst") < dark_error(n, "one frame")
        ),
        "a factor of 2.8 is one and a half stops": lambda n: np.log2(np.sqrt(8)) == 1.5,
    },
}


def bounds_with_true_motion(n):
    """Return `bounds_of_noise` with c = 12 if all tiles move as the hand did."""
    offsets = np.broadcast_to(n.hand[:, None, None], n.offsets.shape)
    merged = n.temporal_merge.merge(n.frames, offsets, tuning=12.0, **n.NOISE)
    return np.sqrt(8) * n.noise_of(merged)


def dark_error(n, name):
    """Return the error of the darkest quarter of a result on page 27, where nobody walked, in percent."""
    X, light, moved = n.results[name]
    L = light.mean(axis=-1)
    return n.percent(X, light, (np.quantile(L, 0.25) > L) & ~moved)


def bounds_of_noise(n, tuning):
    """Return the noise of the merged street on page 27, relative to that of the mean of all frames."""
    return np.sqrt(8) * n.noise_of(n.merge(8, tuning))


def bits_without_bands(n, encoding):
    """Return the fewest bits with which no step is larger than the eye sees, on page 25."""
    visible_percent = {0.01: 3, 1: 1, 900: 0.5}
    for bits in range(8, 17):
        size = n.step_sizes(bits)[encoding]
        steps = [np.interp(np.log10(F), n.DECADES, size) for F in visible_percent]
        if all(np.less(steps, list(visible_percent.values()))):
            return bits
    return None


def off_below(g, truth, level):
    """Return by how many stops a response is off at least, at the levels below one, on page 6."""
    return np.abs(np.ravel(g) - truth)[2:level].min() / np.log(2)


def brightest_spot(n):
    """Return the ln E of the brightest of the three spots of page 4."""
    return n.fast.gsolve(n.sampling.by_rank(n.frames, 3), n.B, 30, n.weights.hat()).lE.max()


def bend_of_table(n, level):
    """Return by how many quarters of a stop page 7's table from pixels is off at a level."""
    return round(4 * worst(n.tables(1.0)[0], n.cubic, level, level))


def errors_at_ends(n, samples, *, smoothness):
    """Return by how many stops g from a few random pixels is off at levels 10 and 250, on page 4.

    The median over many choices of the pixels keeps the error that they share, without their noise.
    """
    rng = np.random.default_rng(0)
    errors = []
    for _ in range(60):
        y, x = (rng.integers(0, size, samples) for size in n.frames.shape[1:])
        g = n.fast.gsolve(n.frames[:, y, x].T.astype(int), n.B, smoothness, n.weights.hat()).g
        errors.append((g - n.responses.true_g())[[10, 250]] / np.log(2))
    return np.abs(np.median(errors, axis=0)).tolist()


def errors_without_level_1(n, names):
    """Return the error of some means in the darkest part of page 10, if level 1 has no weight."""
    w = n.weights.hat()
    w[1] = 0
    images, times = n.inside.images, n.inside.times
    return [
        n.error(n.merge_with_quality(images, times, n.true_g, w, method=name).E)[0]
        for name in names
    ]


def excess_at_level_1(n):
    """Return how many times too large the shortest photo's estimate at level 1 is, in the dark of page 10."""
    Z, exposure = n.inside.images[0], n.full * n.chapel * n.inside.times[0]
    chosen = (Z == 1) & (n.ev < -2)[..., None]
    return np.median(np.exp(n.true_g[1]) / exposure[chosen])


def bounds_and_measured(n):
    """Return for each channel of page 10 the lowest bound, and the highest measured value."""
    is_clipped = (n.inside.images[n.late] >= 250).all(axis=0)
    is_measured = n.bounded.quality == 0
    is_bound = is_clipped & ((n.bounded.quality & n.Quality.CLIPPED) > 0)[..., None]
    return [
        (n.bounded.E[is_bound[..., k], k].min(), n.bounded.E[is_measured, k].max())
        for k in range(3)
    ]


def colors_of_brightest(n):
    """Return true colors of the brightest hundredth of each channel that white patch counts, on page 26."""
    X = n.development.normalize(n.Z, black=n.BLACK, white=n.WHITE)
    counts = n.maximum_filter(X, size=3) < 1
    colors = []
    for k in range(3):
        channel = counts & (n.c == k)
        color = n.E[channel & (np.quantile(X[channel], 0.985) <= X)]
        colors.append(np.median(color / color[:, 1:2], axis=0))
    return np.stack(colors)


def photos_that_measure(n):
    """Return how many photos measure green in each pixel, on page 10."""
    return ((n.images[..., 1] > 0) & (n.images.max(axis=-1) < 250)).sum(axis=0)


def errors_of(n, name):
    """Return the errors of one kind of mean from dark to bright, in percent, on page 10."""
    return n.error(n.merge_with_quality(n.inside.images, n.inside.times, n.true_g, method=name).E)


def mean_of_cut_counts(electrons, read_noise):
    """Return the mean of counts of electrons with read noise, where negative counts become 0."""
    rng = np.random.default_rng(0)
    counts = rng.poisson(electrons, 100_000) + rng.normal(0, read_noise, 100_000)
    return np.maximum(counts, 0).mean()


def apart(times, count, stops):
    """Return whether these are so many exposure times, all so many stops apart."""
    return len(times) == count and np.allclose(np.diff(np.log2(times)), stops)


def error_with_hat(n, level):
    """Return the errors in percent of one sensor and of a mean by hat, on page 23."""
    exposures = level * np.asarray(n.shares) / n.shares[0]
    weights = np.minimum(exposures, 1 - exposures)
    electrons = exposures * n.WELL["full_well"]
    errors = 100 * np.sqrt(electrons + n.WELL["read_noise"] ** 2) / electrons
    return errors[0], np.sqrt(np.sum((weights * errors) ** 2)) / weights.sum()


def as_half(number):
    """Return the half float nearest to a number."""
    with np.errstate(over="ignore"):
        return float(np.float32(number).astype(np.float16))


def levels_in_shade(n, stops):
    """Return how many green levels the face has in a photo that is darker by some stops."""
    shade = n.subjects.backlight((256, 384)).mask
    darker = n.colour.to_8bit(np.minimum(n.linear * 2.0**stops, 1))
    return len(np.unique(darker[shade][:, 1]))


def corrected_shade(n, stops, own=False):
    """Return the mean level of the face in a darker photo that got its light back, on page 19.

    The table that adds the light follows the simulated curve, or the camera's own.
    """
    shade = n.subjects.backlight((256, 384)).mask
    worse = n.colour.to_8bit(np.minimum(n.linear * 2.0**stops, 1))
    table = n.relight.table(3.0 - stops)
    if own:
        light = n.colour.decode_srgb(np.arange(256) / 255)
        table = np.rint(255 * n.colour.encode_srgb(np.minimum(light * 2.0 ** (3 - stops), 1)))
    return float(n.battiato.brightness(table[worse])[shade].mean())


def selected_of_face(n, delta):
    """Return which share of the face lies in relevant blocks if the photo gets more light, on page 19."""
    levels = n.battiato.brightness(n.relight.curve(delta)[n.Z])
    return n.battiato.find_relevant_blocks(levels)[n.subjects.backlight((256, 384)).mask].mean()


def found_of_face(n, reach):
    """Return which share of the face the Gaussian finds up to a distance, on page 19."""
    return float(n.near(reach)[n.subjects.backlight((256, 384)).mask].mean())


def mean_of_skin_off(n, tone, where):
    """Return by how many stops the mean of the skin found there is off that of the face, on page 19."""
    light = n.colour.decode_srgb(n.astronaut / 255)
    light[n.wide] *= n.DARKER if tone == "dark" else 1
    levels = n.battiato.brightness(np.round(255 * n.colour.encode_srgb(light)))
    is_found = n.skin.find_by_chrominance(n.portrait(tone)) & where
    stops = n.relight.f_inv([levels[is_found].mean(), levels[n.face].mean()])
    return float(stops[0] - stops[1])


def longest_shares(n):
    """Return which share of sum 1 / V the longest photo has that is not clipped, on page 10."""
    shares = []
    for light in np.exp(n.true_g[255]) * n.chapel[::16, ::16, 1].ravel():
        X = light * n.inside.times
        X = X[np.exp(n.true_g[250]) > X]
        if not X.size:
            continue
        D = np.interp(X, n.exp_g, n.D)
        # 1 / V is t^2 / variance, and t is proportional to X
        information = X**2 / n.variance(X, D, n.N, n.R)
        shares.append(information[-1] / information.sum())
    return shares


def same_after_decoding(n, part):
    """Return whether a .hdr file is written again as it was, decoded at this part of a mantissa's step."""
    pixels = n.rgbe.to_pixels(n.E)
    mantissas, exponent = pixels[..., :3], pixels[..., 3:].astype(float)
    decoded = ((mantissas + part) / 256 * 2 ** (exponent - 128)).astype(np.float32)
    return np.array_equal(n.rgbe.to_pixels(decoded), pixels)


def light_for_error(n, sensor, percent):
    """Return in how much light, in decades, a sensor of page 21 has this error."""
    errors = np.array(n.errors[sensor])
    dark = np.log10(n.light) < -1
    return np.interp(-percent, -errors[dark], np.log10(n.light[dark]))


def noise_grows(n, size):
    """Return by which factor the remapping of the local Laplacian filter amplifies noise."""
    noise = np.random.default_rng(1).normal(0, size, 100_000)
    r = n.local_laplacian.remap(noise, 0.0, sigma=0.92, alpha=0.5, beta=0.0)
    return r.std() / noise.std()


def waves_left(n, waves):
    """Return which fractions of fine waves in weak light turn into coarse ones, and remain."""
    seen = n.wave(waves, 0.3)[1]
    strength = np.abs(np.fft.rfft(seen)) / (len(seen) / 4)
    places = [round((128 - waves) * len(seen) / 256), round(waves * len(seen) / 256)]
    return strength[places].round(2).tolist()


def falls_of_detail(n, width):
    """Return by how many decades the details of both filters fall at a rising edge, on page 15."""
    rising = 3 * np.clip((np.arange(300) - 150) / width, 0, 1) * np.ones((50, 1))
    compared = n.grid.bilateral(np.float32(rising), sigma_s=12, sigma_r=0.4).mean
    lines = n.guided.guided(rising, radius=16, epsilon=0.04)
    return [round(float(n.falls(rising, base)), 2) for base in (compared, lines)]


def sawtooth_lows(n, way):
    """Return the signal-to-noise ratio at the dark end and at each later low of a plan's sawtooth."""
    ratio = n.ratios(*n.both(10)[way])
    lows = (ratio[1:-1] < ratio[:-2]) & (ratio[1:-1] <= ratio[2:])
    return [float(ratio[0]), *ratio[1:-1][lows].tolist()]


def levels_met(n, time):
    """Return how many levels the luminances of 0.3 to 0.6 get in an exposure."""
    return len(np.unique(n.levels(time).Z[(n.across > 0.3) & (n.across < 0.6)]))


def fine_detail(n, name):
    """Return the strongest fine detail of a solution, in nats."""
    return np.quantile(np.abs(n.three[name] - n.blur.gaussian(n.three[name], 2)), 0.99)


def condition(n, smoothness):
    """Return the condition number of gsolve's matrix."""
    sigma = n.stiff(smoothness)
    return sigma[0] / sigma[-1]


def beyond(R):
    """Return how far each pixel of a fused image is outside 0 to 1, in its worst channel."""
    return np.maximum(R - 1, -R).max(axis=-1)


def exchanged(n):
    """Return the share of pairs two stops apart that fusion brings into the wrong order."""
    y, brighter = n.gray(n.fused), n.L.flat[n.a] > 4 * n.L.flat[n.b]
    return np.mean(y.flat[n.a][brighter] <= y.flat[n.b][brighter])


def edges_off(n, acceleration):
    """Return by how many percent the curves of the left and the right edges are off, at most, with signs."""
    found = n.motion_blur.compare_edges(n.waved(acceleration))
    errors = [spline_error(n, one) for one in (found.left, found.right)]
    return [each[np.argmax(np.abs(each))] for each in errors]


def both_edges_over_one(n, acceleration):
    """Return the RMSE of the curve of both edges of page 08 over that of one edge."""
    image = n.waved(acceleration)
    edges = n.motion_blur.compare_edges(image)
    curves = [n.motion_blur.join(image, n.motion_blur.find_ramps(image)), edges.left, edges.right]
    both, left, right = (np.sqrt(np.mean(spline_error(n, curve) ** 2)) for curve in curves)
    return 2 * both / (left + right)


def mean_of_edges_off(n, acceleration):
    """Return the RMSE in percent of the mean of the curves of both edges of page 08."""
    edges = n.motion_blur.compare_edges(n.waved(acceleration))
    curves = (edges.left, edges.right)
    M = np.linspace(max(c.M[0] for c in curves), min(c.M[-1] for c in curves), 1000)
    errors = [spline_error(n, c._replace(M=M, X=np.interp(M, c.M, c.X))) for c in curves]
    return np.sqrt(np.mean(np.mean(errors, axis=0) ** 2))


def scallops(n, stops, smoothness=0):
    """Return by how many stops the curve of photographs so far apart is off, but for its ends."""
    return worst(n.alternated(stops, smoothness), n.truth, 16, 245)


def radiance_off(n, name):
    """Return by how much radiance read off one photograph is off, in the median."""
    return np.median(
        np.abs(metrics.radiance_errors(np.exp(n.g[name][n.shot]), n.workshop, n.well)[n.well])
    )


def limit_of_alternation(n):
    """Return the ratio of the two largest eigenvalues of an iteration on page 05, and its limit f^-1.

    With D the weighted number of pixels of each level, D^(1/2) M D^(-1/2) is symmetric.
    """
    matrix = n.fast.Joint(n.more, n.shutter, n.w)
    used = np.flatnonzero((n.w > 0) & (matrix.pixels > 0))
    root = np.sqrt(n.w[used] / matrix.pixels[used])
    values, vectors = np.linalg.eigh(root[:, None] * matrix.S[np.ix_(used, used)] * root)
    f_inv = vectors[:, -1] / np.sqrt(n.w[used] * matrix.pixels[used])
    return values[-2] / values[-1], np.interp(np.arange(256), used, np.abs(f_inv))


def off_in_space(n, name, count):
    """Return how far the nearest curve of a space of so many components is off, in percent."""
    part = n.space.fit_space(n.G, count)
    return off(n.space.reconstruct(n.space.project(n.truth[name], part), part), n.truth[name])


def worst_below_patches(n, name, patches):
    """Return the largest error of the MAP curve below the darkest of some gray patches."""
    true, likely, _ = n.drawn(patches, name).values()
    return np.abs(likely - true)[n.x < 0.04].max()


def reshot(n, seed):
    """Return the names of page 09 with photos of other noise."""
    taken = {
        name: n.camera.shoot(
            n.workshop, n.times, n.camera.Camera(response=curve, **n.SENSOR), rng=seed
        ).images
        for name, curve in n.CAMERAS.items()
    }

    def both(name, samples):
        options = dict(samples=samples, choose=n.sampling.by_grid)
        return {"gsolve": n.debevec.recover(taken[name], n.times, **options)}, n.truth[name]

    return SimpleNamespace(both=both)


def robust_stops(n, image):
    """Return the range of an image in stops, without its most extreme pixels."""
    return float(np.log2(n.extremes.robust_maximum(image) / n.extremes.robust_minimum(image)))


def inside_band(n, Lm):
    """Return the widths at which the third pixel of page 16 responds less than the threshold."""
    scales = n.reinhard.scale_steps(n.reinhard.blurs(Lm))
    pixel = n.ranked[len(n.ranked) * 95 // 100]
    return [k for k, scale in enumerate(scales) if abs(scale.response.flat[pixel]) < 0.05]


def widest_classes(n, Ld):
    """Return at how many stops above the median an operator's band is widest, in ten classes."""
    luminance, low, high = n.curves.spread(n.L, Ld, bins=256)
    width = n.colour.encode_srgb(high) - n.colour.encode_srgb(low)
    return np.round(np.log2(luminance / np.median(n.L)))[np.argsort(width)[-10:]]


def exposedness_in_dark(n):
    """Return E of the brightest photo in the darkest tenth of the scene, on page 20."""
    return n.mertens.exposedness(n.F[-1])[np.quantile(n.L, 0.1) > n.L]


def raggedness(n, powers):
    """Return the mean deviation of the maps of weights from their blur by two pixels."""
    maps = n.mertens.weights(n.images, powers)
    return np.mean([np.abs(W - n.gaussian_filter(W, 2)).mean() for W in maps])


def band_widths(n, gray):
    """Return how many levels the pixels of each of 256 classes of luminance span."""
    classes = np.array_split(np.argsort(n.L, axis=None), 256)
    return [np.ptp(gray.flat[pixels]) for pixels in classes]


def patches_off(n, name, patches):
    """Return how far the likeliest curve through some gray patches is off, in percent."""
    true, likely, _ = n.drawn(patches, name).values()
    return 100 * np.abs(likely - true).mean()


def share(n, name, samples):
    """Return the error of the space of responses over that of gsolve."""
    pair, true = n.both(name, samples)
    return off(pair["space"], true) / off(pair["gsolve"], true)


def gain(n, name):
    """Return the error of gsolve of a hundred pixels over that of thousands."""
    few, many = (
        off(pair["gsolve"], true) for pair, true in (n.both(name, 100), n.both(name, 4000))
    )
    return few / many


def errors_shrink(n):
    """Return the error of the plain map in the region over that of the map without ghosts."""
    taken = n.sim.images, n.sim.times, n.curve, n.w
    merged = n.merge_with_quality(*taken)
    clean = n.ghosts.remove_ghosts(*taken, merged=merged)
    where = n.moving.region & (clean.labels > 0) & (clean.quality == 0)
    each = [np.log2(E / np.maximum(n.truth, 1e-9))[where] for E in (merged.E, clean.E)]
    return np.sqrt(np.mean(each[0] ** 2) / np.mean(each[1] ** 2))


def moving_pixels(n, *, tau=0.1, edge=0.35):
    """Return the mask of what moves on page 12, for two settings of the sliders."""
    return n.ghosts.detect_motion(n.contradiction, tau=tau, edge=edge, margin=4)[1]


def left_clipped_far_from_the_visitor(n):
    """Return how many pixels of the region stay clipped farther from the visitor than the means reach."""
    taken = n.sim.images, n.sim.times, n.curve, n.w
    result = n.ghosts.remove_ghosts(*taken, merged=n.merge_with_quality(*taken))
    visitor = n.moving.hidden[int(result.references[0])]
    clipped = n.everywhere & ((result.quality & Quality.CLIPPED) > 0)
    assert clipped.sum() > 200
    return np.sum(clipped & (distance_transform_edt(~visitor) > n.reference.BOX_SIDE))


def blue_off(n, low, high):
    """Return RGBE's errors of blue, in percent, where blue over red lies between two shares."""
    error = 100 * np.abs(n.stored["RGBE"] / n.share - 1)
    return error[(n.share > low) & (n.share < high)]


def step_at(n, coding, light):
    """Return the size of one step of 10 bits at a luminance, in percent."""
    return np.interp(np.log10(light), n.DECADES, n.step_sizes(10)[coding])


def gained(n):
    """Return for how many cameras 300 iterations find a better curve than the scheme that stops."""
    stops = ({"eps": 1e-3}, {"eps": 0, "max_iterations": 300})
    fits = [
        [n.last(n.mitsunaga.fit_steps(M, [0.5] * 3, 5, **how)).c[0] for M in n.means]
        for how in stops
    ]
    ends = [
        [n.ambiguity.mean_error(c, one.c) for c, one in zip(cs, n.trials, strict=True)]
        for cs in fits
    ]
    return int(np.sum(np.less(*ends[::-1])))


def spline_error(n, one):
    """Return how far a joined curve is off along its range, in percent, for the same two ends."""
    two = one.X, n.responses.as_response("film").inverse(one.M)
    found, true = ((X - X[0]) / (X[-1] - X[0]) for X in two)
    return 100 * (found - true)


def spline_off(n, found):
    """Return by how many percent of the range a joined curve is off at most."""
    return max(np.abs(spline_error(n, one)).max() for one in found.values())


def slopes_of_film(n):
    """Return how steeply film's level rises with that of a photo with half the exposure, at both ends."""
    film = n.responses.as_response("film")
    ends = film.inverse(np.array([0.001, 0.002])), np.array([0.498, 0.499])
    return [np.diff(film.f(2 * X))[0] / np.diff(film.f(X))[0] for X in ends]


def lamps(n):
    """Return the share of the brightest pixels that hold half of the light."""
    each = np.sort(n.L, axis=None)[::-1]
    return np.searchsorted(np.cumsum(each), each.sum() / 2) / each.size


def steep(n):
    """Return where a stop brings at least four fifths of what it brings at most, as indices."""
    slope = np.gradient(n.levels)
    return np.flatnonzero(slope >= 0.8 * slope.max())


def light_arrives(n, away):
    """Return the first width whose blur doubles the light so many pixels right of the brightest lamp."""
    y, x = np.unravel_index(np.argmax(n.L), n.L.shape)
    beside = [blur[y, x + away] for blur in n.blurs]
    return f"{n.reinhard.WIDTHS[int(np.argmax(np.greater(beside, 2 * beside[0])))]:.3g}"


def recall(n, way, tone):
    return n.skin.FINDERS[way](n.portrait(tone))[n.face].mean()


def mistaken(n, way, tone):
    return n.skin.FINDERS[way](n.portrait(tone))[~n.wide & (n.y < 140)].mean()


def share_of_light(n):
    return (100 * n.shares).round(2).tolist()


def cells_of(path):
    return json.loads(path.read_text(encoding="utf-8"))["cells"]


def find_false_sentences(stem, names):
    """Return the sentences of a notebook that its variables contradict.

    A sentence whose check raises an error is in the list, too, followed by the error.
    """
    n = SimpleNamespace(**names)
    false_sentences = []
    with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
        warnings.simplefilter("error")
        for sentence, is_true in SENTENCES.get(stem[:2], {}).items():
            try:
                if not is_true(n):
                    false_sentences.append(sentence)
            except Exception as error:
                false_sentences.append(f"{sentence}: {error!r}")
    return false_sentences


def find_broken_sliders():
    """Move each slider of the running notebook by one step and return those that raise an error."""
    broken = []
    tuners = [figure for figure in widget._instances.values() if isinstance(figure, Tuner)]
    for tuner in tuners:
        start = list(tuner.at)
        for k, name in enumerate(tuner.names):
            moved = list(start)
            moved[k] = (start[k] + 1) % len(tuner.values[k])
            tuner.at = moved
            if tuner.problem:
                broken.append(f"{tuner.alt}, {name}: {tuner.problem}")
            tuner.at = start
    return broken


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_each_sentence_of_the_list_is_in_its_notebook(path):
    text = " ".join(" ".join("".join(cell["source"]) for cell in cells_of(path)).split())
    assert [sentence for sentence in SENTENCES.get(path.stem[:2], {}) if sentence not in text] == []


def test_a_false_sentence_is_reported_and_one_that_cannot_be_checked_with_the_error(monkeypatch):
    sentence = "about sixteen stops"
    monkeypatch.setitem(SENTENCES, "00", {sentence: lambda n: round(n.stops) == 16})
    assert find_false_sentences("00_welcome", {"stops": 16.2}) == []
    assert find_false_sentences("00_welcome", {"stops": 15}) == [sentence]
    (report,) = find_false_sentences("00_welcome", {})
    assert report.startswith(f"{sentence}: AttributeError")


def test_a_slider_whose_function_raises_an_error_is_reported(monkeypatch):
    monkeypatch.setattr(widget, "_instances", {})
    names = {"level": 100}
    tune(
        lambda a=0: np.full((4, 4), names["level"] + a, np.uint8),
        lambda x: x,
        alt="A square",
        a=[0, 1],
    )
    assert find_broken_sliders() == []
    names.clear()
    assert find_broken_sliders() == ["A square, a: KeyError: 'level'"]
