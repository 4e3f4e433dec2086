"""Checks of merge(images, times, g, w), the radiance map: E (H, W[, 3])."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.capture import camera, responses
from hdrlab.core import weights
from hdrlab.course.checks.compare import finite, points, require, same

G = responses.true_g("gamma")
TIMES = np.array([0.25, 0.5, 1.0])


def smooth(rng, shape=(48, 64)):
    """Return radiance (H, W) from about 0.1 to 1, without outlying single pixels."""
    noise = gaussian_filter(rng.standard_normal(shape), 4)
    return np.exp(0.5 * noise / noise.std() - 1).astype(np.float32)


def photographs(rng, E, times=TIMES):
    """Return 8-bit photos (P, H, W) with noise and levels from 20 to 235, so that every frame
    measures every pixel.
    """
    M = responses.RESPONSES["gamma"].f(
        np.clip(0.3 * E * np.reshape(times, (-1,) + (1,) * E.ndim), 0, 1)
    )
    return np.clip(np.round(255 * M + 3 * rng.standard_normal(M.shape)), 20, 235).astype(np.uint8)


def positive(answer, shape):
    """Return a map of this shape as float64, whose values must all be above 0."""
    E = finite(answer, shape, what="E").astype(float)
    message = f"E: expected radiance above 0, got {np.sum(E <= 0)} values that are not"
    require(np.all(E > 0), message, answer=E)
    return E


def map_of(answer, images):
    """Return a map as float64, which must be brighter where the photos are."""
    E = positive(answer, images.shape[1:])
    follows = np.corrcoef(np.log(E).ravel(), images.mean(axis=0).ravel())[0, 1] > 0.5
    require(follows, "E: expected more radiance where the photos are brighter", answer=E)
    return E


def same_map(answer, truth, tolerance=0.01, **options):
    """Compare the logarithms of two maps, because errors of radiance are ratios."""
    E = positive(answer, truth.shape)
    same(np.log(E), np.log(truth), tolerance, what="ln E", picture=truth.ndim == 2, **options)


def get_answer(subject, images, times, g, *w):
    """Return the map of a subject for photos with these times in seconds, passed as on the sheet."""
    exposures = times
    return subject.merge(images, exposures, g, *w)


def solution(images, times, g, w=None):
    """Return the weighted mean of ln E over photos that measure every pixel, as E."""
    if w is None:
        w = weights.hat()
    images = np.asarray(images)
    curve = g[images] if np.ndim(g) == 1 else g[images, np.arange(images.shape[-1])]
    t = np.reshape(times, (-1,) + (1,) * (images.ndim - 1))
    W = w[images]
    return np.exp(np.sum(W * (curve - np.log(t)), axis=0) / np.sum(W, axis=0))


def draw_pixel(*levels):
    """Return photos (P, 1, 1) or (P, 1, 1, 3) of one pixel."""
    return np.array([[[level]] for level in levels], np.uint8)


RAMP = np.linspace(0, 1, 256)
# the times, or the exposures in stops, are 1 and 3
SMALL_INPUTS = [
    (draw_pixel(100), np.array([1.0]), RAMP),
    (draw_pixel(50, 100), np.array([1.0, 3.0]), RAMP),
    (draw_pixel(100, 200), np.array([1.0, 3.0]), RAMP),
    (draw_pixel(0, 2), np.array([1.0, 3.0]), RAMP),
    (draw_pixel(253, 255), np.array([1.0, 3.0]), RAMP),
    (draw_pixel(50, 200), np.array([1.0, 3.0]), RAMP, RAMP),
    (draw_pixel([50, 50, 50]), np.array([1.0]), np.linspace(0, [1.0, 2.0, 4.0], 256)),
]


def check_one_input(subject, images, exposures, g, w=None):
    """Compare the logarithms of the map with those of the solution."""
    times = exposures
    same_map(subject.merge(images, exposures, g, w), solution(images, times, g, w))


def test_every_pixel_has_a_finite_radiance(subject, rng):
    """The map has the size of a photo.

    Sum over the frames, the first axis.

    No value may be NaN, infinite or below 0.
    """
    images = photographs(rng, smooth(rng))
    E = finite(get_answer(subject, images, TIMES, G), images.shape[1:], what="E")
    require(
        (E >= 0).all(), f"E: expected radiance of at least 0, got {float(E.min()):.3g}", answer=E
    )


@points(12)
def test_it_is_the_weighted_mean_of_the_logarithms(subject, rng):
    """Divide by the sum of the weights, not by the number of frames.

    Each frame gives ln E = g(Z) - ln t. Use the natural logarithm, as in g.

    ln E = sum_j w(Z_j) (g(Z_j) - ln t_j) / sum_j w(Z_j), and E = exp(ln E).
    """
    images = photographs(rng, smooth(rng))
    same_map(get_answer(subject, images, TIMES, G), solution(images, TIMES, G))


@points(4)
def test_the_radiance_of_a_simulated_scene_is_recovered(subject, rng):
    """Do not judge your map only by its looks. Compare it with the scene that the photos show.

    A pixel of value 128 in a frame of 2 seconds has the radiance exp(g[128]) / 2.

    Do you subtract the natural logarithm of the exposure time, and the right time from each frame?
    """
    E = np.float32(2.0 ** rng.uniform(-3, 3)) * smooth(rng)
    times = camera.times_around(E, 7, stops=1)
    photos = camera.shoot(E, times, camera.Camera(response="gamma"))
    answer = np.log(
        finite(get_answer(subject, photos.images, photos.times, G), E.shape, what="E").astype(float)
    )
    ratio = answer - np.log(E)
    same(
        ratio - np.median(ratio),
        np.zeros(E.shape),
        0.06,
        what="ln E minus that of the scene",
        picture=True,
    )
    step = np.log(
        finite(get_answer(subject, photos.images, 8 * photos.times, G), E.shape, what="E").astype(
            float
        )
    )
    same(
        step,
        answer - np.log(8),
        1e-3,
        what="ln E with exposure times 8 times as long",
        picture=True,
    )


@points(6)
def test_the_given_weights_are_used(subject, rng):
    """Frames can disagree. The weights decide how much each of them counts.

    The argument w is the table of weights; None means the hat.

    Look up w[Z] for each pixel and frame, in the w that you are given.
    """
    images = photographs(rng, smooth(rng))
    for w in (weights.gaussian(), 0.05 + np.linspace(0, 1, 256) ** 2):
        photo_maps = [
            map_of(get_answer(subject, images[[j]], TIMES[[j]], G, w), images[[j]])
            for j in range(len(images))
        ]
        W = w[images]
        mean = np.average(np.log(photo_maps), axis=0, weights=W)
        same_map(get_answer(subject, images, TIMES, G, w), np.exp(mean))


@points(2)
def test_the_order_of_the_frames_does_not_matter(subject, rng):
    """Does your code assume that the first frame is the shortest?

    times[j] belongs to images[j].

    Sort both together, or neither of them.
    """
    images = photographs(rng, smooth(rng))
    order = [1, 2, 0]
    expected = map_of(get_answer(subject, images, TIMES, G), images)
    same_map(get_answer(subject, images[order], TIMES[order], G), expected)


@points(2)
def test_each_channel_uses_its_own_curve(subject, rng):
    """Color photos have the shape (P, H, W, 3).

    Merge every channel with the same formula. g can be (256, 3), with one curve per channel.

    Look up the curve of the channel: g[Z[..., c], c].
    """
    images = np.stack([photographs(rng, smooth(rng)) for _ in range(3)], axis=-1)
    g = np.stack([G, responses.true_g("linear"), responses.true_g("film")], axis=-1)
    channel_maps = [
        map_of(get_answer(subject, images[..., c], TIMES, g[:, c]), images[..., c])
        for c in range(3)
    ]
    same_map(get_answer(subject, images, TIMES, g), np.stack(channel_maps, axis=-1))


@points(3)
def test_clipped_levels_do_not_count(subject, rng):
    """A pixel is white in one photo and gray in another. Which one measures its light?

    Only the gray one: the hat is 0 at pixel values 0 and 255.

    If no w is given, use w(z) = z below the middle and 255 - z above it. Do not add anything to it.
    """
    images = photographs(rng, smooth(rng))
    part = rng.integers(0, 4, images.shape[1:])
    images[0][part == 0] = 0
    images[2][part == 1] = 255
    same_map(get_answer(subject, images, TIMES, G), solution(images, TIMES, G))
