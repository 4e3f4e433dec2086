"""Checks of reconstruct(Z, e, c, sigma, full_well, read_noise), a map from one photo through a mosaic."""

import numpy as np

from hdrlab.beyond import assorted
from hdrlab.core.filters.mosaic import tile
from hdrlab.course.checks.compare import points, same

SHAPE = (24, 32)


# the lowest pixel value that may be full
LIMIT = 254


def away_from_limit(Z):
    """Return Z without the two values beside the limit, which one check alone is about."""
    return np.where((Z == LIMIT - 1) | (Z == LIMIT), LIMIT - 2, Z).astype(Z.dtype)


def draw_inputs(rng, top=0.9):
    """Return Z and e of a soft scene that the darkest filter always measures."""
    e = tile(assorted.FOUR_EXPOSURES, SHAPE)
    y, x = np.indices(SHAPE) / SHAPE[1]
    E = np.exp(rng.uniform(2, 3) * np.sin(rng.uniform(3, 5) * x + rng.uniform(0, 3)) - y)
    E *= rng.uniform(0.85, 1) * top / E.max() / e.min()
    Z = assorted.shoot(E, e, full_well=20_000, read_noise=5, rng=rng)
    return away_from_limit(Z), e


def same_map(subject, Z, e, c=None, what="E", **options):
    """Compare the map with the library's, relative to each value."""
    full = np.where(Z >= LIMIT, 255, Z).astype(Z.dtype)
    E = assorted.reconstruct(full, e, c, **options)
    filters = e
    answer = same(subject.reconstruct(Z, filters, c, **options), E, 5e-3 * E.max(), what=what)
    same(answer / E, np.ones(E.shape), 5e-3, what=f"{what} / the right {what}", picture=E.ndim == 2)


@points(3)
def test_without_noise_of_the_sensor_only_rounding_decides(subject, rng):
    """A pixel behind the filter of 1/64 and one behind the clear one measure the same light. Who is surer?

    Both are rounded to 1/255. Divided by e, the error of the dark one is 64 times as large.

    w = e^2 / (1 / (12 255^2)), if full_well is infinite and read_noise 0. E = G(w X / e) / G(w).
    """
    e = tile(assorted.FOUR_EXPOSURES, SHAPE)
    E = rng.uniform(0.4, 0.7) + 0.2 * np.sin(np.arange(SHAPE[1]) / 5) + np.zeros(SHAPE)
    same_map(subject, assorted.shoot(E, e), e, sigma=0.7)


@points(6)
def test_full_pixels_do_not_count(subject, rng):
    """A pixel is full. What does it say about the radiance?

    Only "at least": its neighbors with darker filters must measure it.

    w = 0 where X is 0.995 or more.
    """
    Z, e = draw_inputs(rng)
    near_limit = (e == 1) & (rng.random(SHAPE) < 0.3)
    Z[near_limit] = rng.choice([LIMIT - 1, LIMIT], np.count_nonzero(near_limit))
    same_map(subject, Z, e, sigma=0.6)


@points(5)
def test_pixels_are_weighted_by_the_inverse_of_their_variance(subject, rng):
    """Which noise has a sensor, beside that of rounding?

    That of the photons, X / N, and that of reading, (R / N)^2, with N = full_well and R = read_noise.

    w = e^2 / (X / N + (R / N)^2 + 1 / (12 255^2)).
    """
    Z, e = draw_inputs(rng)
    same_map(subject, Z, e, sigma=1.0, full_well=2000.0, read_noise=20.0)
    # in the dark of such a sensor, rounding is the largest error
    same_map(subject, Z, e, sigma=1.0, full_well=1e5, read_noise=5.0, what="E of a large sensor")


@points(3)
def test_each_color_is_a_mean_of_its_own_pixels(subject, rng):
    """Each pixel has a color as well. Which pixels measure red?

    Those with c = 0, and no others.

    Set the weight to 0 at all pixels of other colors, once for each color, and stack the three maps.
    """
    Z, _ = draw_inputs(rng, top=0.2)
    c, e = (tile(pattern, SHAPE) for pattern in assorted.colours_and_exposures([1.0, 1 / 64]))
    light = rng.uniform(0.3, 0.8, 3) * (1 + 0.3 * np.sin(np.arange(SHAPE[1]) / 6))[:, None]
    Z = away_from_limit(assorted.shoot(np.broadcast_to(light, (*SHAPE, 3)), e, c, rng=rng))
    same_map(subject, Z, e, c, what="E in color", sigma=1.5)
